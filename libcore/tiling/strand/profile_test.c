/*
 * Profiles: where a ring is round is the ring's own affair, whatever it is swept to; and where a section that turns is
 * turned inside out on the way, its normals are, too.
 */
#include "libcore/base/check.h"
#include "libcore/tiling/strand/profile.h"

static const MesoMaterial GREY = {{0.5f, 0.5f, 0.5f}, 0.5f, 0};

enum { ROUND, SQUARE };

static MesoCsgNode csg[2] = {{MESO_CSG_DISC, 0, 0, {0.5f, 0.5f}, {0.3f, 0.3f}, 0},
                             {MESO_CSG_BOX, 0, 0, {0.5f, 0.5f}, {0.3f, 0.2f}, 0}};

/* A disc from side to side, and to a box on a third. */
static MesoTileSet make_tile_set(MesoSection *sections, MesoInterface *interfaces, MesoSweep *sweeps, MesoTile *tile)
{
    sections[ROUND] = (MesoSection){"disc", ROUND, 0, GREY};
    sections[SQUARE] = (MesoSection){"box", SQUARE, 1, GREY};
    interfaces[ROUND] = (MesoInterface){"round", 0, 1, {0, 0, 0}, false, false};
    interfaces[SQUARE] = (MesoInterface){"square", 1, 1, {0, 0, 0}, false, false};
    sweeps[0] = (MesoSweep){.from_side = 0, .to_side = 2, .from_section = ROUND, .to_section = ROUND};
    sweeps[1] = (MesoSweep){.from_side = 0, .to_side = 1, .from_section = ROUND, .to_section = SQUARE};
    *tile = (MesoTile){.name = "t", .side_count = 4, .labels = {1, 2, -1, -2}, .sweep_count = 2};
    return (MesoTileSet){.interface_count = 2, .section_count = 2, .csg_count = 2, .tile_count = 1, .sweep_count = 2,
                         .interfaces = interfaces, .sections = sections, .csg = csg, .tiles = tile,
                         .sweeps = sweeps};
}

static uint32_t find_kind(const MesoProfileSet *profiles, uint32_t sweep)
{
    for (uint32_t k = 0; k < profiles->kind_count; k++)
        if (profiles->origins[k].sweep == sweep && !profiles->origins[k].mirrored)
            return k;
    CHECK(false);   /* there is one */
    return MESO_NO_INDEX;
}

static bool same(MesoVec2 a, MesoVec2 b)
{
    return a.x == b.x && a.y == b.y;
}

static bool same_direction(MesoVec2 a, MesoVec2 b)
{
    float lengths = meso_vec2_length(a) * meso_vec2_length(b);
    return fabsf(meso_vec2_cross(a, b)) < 1e-6f * lengths && a.x * b.x + a.y * b.y > 0;
}

/* Every column of `kind` has the normal that `other` has at the same point of the ring that both start on. */
static uint32_t compare_starts(const MesoProfileSet *profiles, uint32_t kind, uint32_t other)
{
    const MesoSweptKind *a = &profiles->kinds[kind], *b = &profiles->kinds[other];
    uint32_t met = 0;
    for (uint32_t i = a->column_begin; i < a->column_begin + a->column_count; i++)
        for (uint32_t k = b->column_begin; k < b->column_begin + b->column_count; k++)
            if (same(profiles->columns[i].start, profiles->columns[k].start)) {
                CHECK(same_direction(profiles->columns[i].start_normal, profiles->columns[k].start_normal));
                met++;
            }
    return met;
}

/* Corners of a ring have two columns each, the first one the last of all. */
static uint32_t count_sharp_ends(const MesoProfileSet *profiles, uint32_t kind)
{
    const MesoSweptKind *swept = &profiles->kinds[kind];
    uint32_t sharp = 0;
    for (uint32_t i = swept->column_begin; i + 1 < swept->column_begin + swept->column_count; i++) {
        const MesoSweepColumn *a = &profiles->columns[i], *b = &profiles->columns[i + 1];
        sharp += same(a->end, b->end) && !same_direction(a->end_normal, b->end_normal);
    }
    return sharp;
}

static void test_round_end_of_a_sharp_sweep(void)
{
    MesoError error;
    MesoArena arena;
    meso_arena_init(&arena);
    MesoSection sections[2];
    MesoInterface interfaces[2];
    MesoSweep sweeps[2];
    MesoTile tile;
    MesoTileSet set = make_tile_set(sections, interfaces, sweeps, &tile);
    MesoContourSet contours;
    MesoProfileSet profiles;
    CHECK(meso_contour_set_build(&contours, &arena, &set, 0.05f, &error) == MESO_OK);
    CHECK(meso_profile_set_build(&profiles, &arena, &set, &contours, 8, (MesoColumnLimits){0}, &error) == MESO_OK);

    uint32_t straight = find_kind(&profiles, 0), bent = find_kind(&profiles, 1);
    CHECK(compare_starts(&profiles, bent, straight) >= profiles.kinds[bent].column_count);
    CHECK(count_sharp_ends(&profiles, straight) == 0);
    CHECK(count_sharp_ends(&profiles, bent) >= 3);
    meso_arena_release(&arena);
}

/* ---- inside out ---- */

static MesoVec2 turned_back(MesoVec2 p, float angle)
{
    float c = cosf(angle), s = sinf(angle);
    return (MesoVec2){c * p.x + s * p.y, c * p.y - s * p.x};
}

/* At a blend between the ends: a column's normal, in the frame that turns along. */
static MesoVec2 normal_at(const MesoSweptKind *kind, const MesoSweepColumn *column, float w)
{
    bool own = column->own && w > 0 && w < 1;
    MesoVec2 start = own ? column->own_normals[0] : column->start_normal;
    MesoVec2 end = own ? column->own_normals[1] : column->end_normal;
    MesoVec2 n = meso_vec2_lerp(start, turned_back(end, kind->turn), w);
    float length = meso_vec2_length(n);
    return meso_vec2_scale(n, length > 0 ? 1 / length : 0);
}

static MesoVec2 place_at(const MesoSweptKind *kind, const MesoSweepColumn *column, float w)
{
    MesoVec2 end = turned_back(meso_vec2_sub(column->end, kind->middle[1]), kind->turn);
    return meso_vec2_lerp(meso_vec2_sub(column->start, kind->middle[0]), end, w);
}

static float along(MesoVec2 a, MesoVec2 b)
{
    return a.x * b.x + a.y * b.y;
}

/* Whether each normal lies across the joint, where that is no point. */
static bool are_across(MesoVec2 n, MesoVec2 normal, MesoVec2 other)
{
    float length = meso_vec2_length(n);
    return length < 1e-3f || fminf(along(n, normal), along(n, other)) > 0.999f * length;
}

/*
 * Joints against which the sum of both columns' normals is, somewhere on the way, or which are reversed then and have a
 * normal between the ends that is not across them; and those that are reversed.
 */
static uint32_t count_inverted(const MesoProfileSet *profiles, uint32_t kind, uint32_t *reversed)
{
    const MesoSweptKind *swept = &profiles->kinds[kind];
    uint32_t inverted = 0;
    *reversed = 0;
    for (uint32_t i = swept->column_begin; i + 1 < swept->column_begin + swept->column_count; i++) {
        const MesoSweepColumn *a = &profiles->columns[i], *b = a + 1;
        MesoVec2 first = meso_vec2_sub(place_at(swept, b, 0), place_at(swept, a, 0));
        MesoVec2 last = meso_vec2_sub(place_at(swept, b, 1), place_at(swept, a, 1));
        bool against = false;
        for (uint32_t step = 0; step <= 32 && a->joins_next; step++) {
            float w = (float)step / 32;
            MesoVec2 chord = meso_vec2_lerp(first, last, w), n = {-chord.y, chord.x};
            MesoVec2 normal = normal_at(swept, a, w), other = normal_at(swept, b, w);
            against |= along(n, normal) + along(n, other) < -1e-6f * along(n, n);
            against |= along(first, last) < 0 && step > 0 && step < 32 && !are_across(n, normal, other);
        }
        inverted += against;
        *reversed += a->joins_next && along(first, last) < 0;
    }
    return inverted;
}

/* A bar with a notch that becomes a shorter one with its notch elsewhere, while it turns by half a turn or so. */
static void test_notched_bars(void)
{
    static const struct {
        MesoVec2 notch, notch_size, size, other_notch, other_notch_size;
        float turn, step;
    } bars[] = {{{0.77f, 0.6f}, {0.295f, 0.15f}, {0.38f, 0.16f}, {0.38f, 0.48f}, {0.19f, 0.135f}, 0.55f, 0.032f},
                {{0.74f, 0.6f}, {0.19f, 0.105f}, {0.59f, 0.19f}, {0.26f, 0.54f}, {0.28f, 0.105f}, 0.4f, 0.04f},
                {{0.68f, 0.6f}, {0.28f, 0.17f}, {0.62f, 0.155f}, {0.53f, 0.43f}, {0.26f, 0.15f}, 0.5f, 0.052f}};
    for (uint32_t i = 0; i < 3; i++) {
        MesoError error;
        MesoArena arena;
        meso_arena_init(&arena);
        MesoCsgNode nodes[6] = {{MESO_CSG_BOX, 0, 0, {0.5f, 0.5f}, {0.8f, 0.1f}, 0},
                                {MESO_CSG_DISC, 0, 0, bars[i].notch, bars[i].notch_size, 0},
                                {MESO_CSG_DIFFERENCE, 0, 1, {0, 0}, {0, 0}, 0},
                                {MESO_CSG_BOX, 0, 0, {0.5f, 0.5f}, bars[i].size, 0},
                                {MESO_CSG_DISC, 0, 0, bars[i].other_notch, bars[i].other_notch_size, 0},
                                {MESO_CSG_DIFFERENCE, 3, 4, {0, 0}, {0, 0}, 0}};
        MesoSection sections[2];
        MesoInterface interfaces[2];
        MesoSweep sweeps[2];
        MesoTile tile;
        MesoTileSet set = make_tile_set(sections, interfaces, sweeps, &tile);
        MesoContourSet contours;
        MesoProfileSet profiles;
        set.csg = nodes;
        set.csg_count = 6;
        sections[ROUND].csg_root = 2;
        sections[SQUARE].csg_root = 5;
        sweeps[1].turn = bars[i].turn;
        CHECK(meso_contour_set_build(&contours, &arena, &set, bars[i].step, &error) == MESO_OK);
        CHECK(meso_profile_set_build(&profiles, &arena, &set, &contours, 8, (MesoColumnLimits){0}, &error) == MESO_OK);
        uint32_t reversed, kind = find_kind(&profiles, 1);
        CHECK(profiles.kinds[kind].turn != 0);
        CHECK(count_inverted(&profiles, kind, &reversed) == 0 && reversed > 5);
        meso_arena_release(&arena);
    }
}

int main(void)
{
    test_round_end_of_a_sharp_sweep();
    test_notched_bars();
    return 0;
}
