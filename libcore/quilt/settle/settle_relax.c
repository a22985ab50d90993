/* Bodies move towards the places that they have around each other in the swatch. */
#include "libcore/quilt/settle/settle_work.h"

/* Lengths as shares of the spacing: a place of the swatch that a body may be meant to have; what a round moves at most. */
#define MEANT 0.4f
#define LARGEST_MOVE 0.1f

/* Bodies nearer than that, and not meant to be, move apart. */
#define TOO_NEAR 0.85f

/* Of what is wanted, a round does so much. */
#define SHARE 0.5f

MesoVec2 meso_settle_offset(const MesoSettleBody *from, const MesoSettleBody *to)
{
    MesoVec3 d = meso_vec3_sub(to->root, from->root), p = meso_settle_from_space(&from->pose, d);
    float flat = meso_vec2_length((MesoVec2){p.x, p.y}), stretch = flat > 0 ? meso_vec3_length(d) / flat : 0;
    return (MesoVec2){p.x * stretch, p.y * stretch};
}

/* What neighbours want of a body. */
typedef struct Wish {
    MesoVec3 move;
    float along, across;        /* where they are by where it has them: what makes its turn */
    uint32_t count;
} Wish;

/*
 * The way in which `from` would have something that it has a relation to; added with a sign. With -1 it is `from` itself
 * that wishes: it also turns to what is around it. Did it turn to how its neighbours are turned, all would chase each
 * other.
 */
static bool wish_by(Wish *wish, const MesoSettleWork *work, const MesoSettleBody *from, const MesoSettleBody *to,
                    float sign)
{
    MesoVec2 at = meso_settle_offset(from, to);
    MesoSettleSpread spread = meso_settle_spread(work, to, &from->pose);
    uint32_t r = meso_settle_relation(work, from->kind, &spread, at, MEANT * work->spacing);
    if (r == MESO_NO_INDEX)
        return false;
    MesoVec3 offset = work->relations[r].offset, miss = {sign * (offset.x - at.x), sign * (offset.y - at.y), 0};
    wish->move = meso_vec3_add(wish->move, meso_settle_to_space(&from->pose, miss));
    wish->count++;
    if (sign < 0) {
        wish->along += offset.x * at.x + offset.y * at.y;
        wish->across += offset.x * at.y - offset.y * at.x;
    }
    return true;
}

bool meso_settle_is_meant(const MesoSettleWork *work, const MesoSettleBody *from, const MesoSettleBody *to, float most)
{
    MesoSettleSpread spread = meso_settle_spread(work, to, &from->pose);
    return meso_settle_relation(work, from->kind, &spread, meso_settle_offset(from, to), most * work->spacing) !=
           MESO_NO_INDEX;
}

static void add_wishes(Wish *wish, const MesoSettleWork *work, const MesoSettleBody *a, const MesoSettleBody *b)
{
    MesoVec3 d = meso_vec3_sub(a->root, b->root);
    float distance = meso_vec3_length(d);
    bool meant = wish_by(wish, work, b, a, 1);
    meant |= wish_by(wish, work, a, b, -1);
    if (!meant && distance < TOO_NEAR * work->spacing && distance > 0) {
        wish->move = meso_vec3_mad(wish->move, (TOO_NEAR * work->spacing - distance) / distance, d);
        wish->count++;
    }
}

void meso_settle_turn(MesoSettleBody *body, float sine)
{
    MesoVec3 x = meso_vec3_unit(meso_vec3_mad(body->pose.x, sine, body->pose.y), body->pose.x);
    body->pose.y = meso_vec3_cross(body->pose.z, x);
    body->pose.x = x;
}

MesoVec3 meso_settle_along(const MesoSettleWork *work, const MesoSettleBody *body, MesoVec3 way)
{
    MesoVec3 up = meso_settle_up(work, body->place);
    return meso_vec3_mad(way, -meso_vec3_dot(way, up), up);
}

bool meso_settle_relax_body(const MesoSettleWork *work, MesoSettleBody *body, uint32_t itself)
{
    uint32_t near[MESO_SETTLE_NEAR], count = meso_settle_near(near, MESO_SETTLE_NEAR, work, body->pose.origin);
    Wish wish = {0};
    for (uint32_t i = 0; i < count; i++) {
        const MesoSettleBody *other = &work->bodies[near[i]];
        float apart = meso_vec3_length(meso_vec3_sub(other->root, body->root));
        if (near[i] != itself && meso_settle_same_side(body, other) && apart < 2 * work->spacing)
            add_wishes(&wish, work, body, other);
    }
    if (!wish.count)
        return false;
    MesoVec3 move = meso_settle_along(work, body, meso_vec3_scale(wish.move, SHARE / (float)wish.count));
    float length = meso_vec3_length(move), most = LARGEST_MOVE * work->spacing;
    if (length > most)
        move = meso_vec3_scale(move, most / length);
    bool moved = meso_settle_move(work, body, meso_vec3_add(body->root, move));
    if (wish.along > 0)
        meso_settle_turn(body, SHARE * wish.across / hypotf(wish.along, wish.across));
    return moved;
}

void meso_settle_relax(MesoSettleWork *work, uint32_t rounds)
{
    for (uint32_t round = 0; round < rounds; round++)
        for (uint32_t b = 0; b < work->body_count; b++)
            if (!work->bodies[b].gone && !work->bodies[b].stays &&
                meso_settle_relax_body(work, &work->bodies[b], b))
                meso_settle_list(work, b);
}
