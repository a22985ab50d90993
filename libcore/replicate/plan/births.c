/* Where details are born, of which, and how they become part of the web. */
#include "libcore/base/grow.h"
#include "libcore/field/triangle_frames.h"
#include "libcore/replicate/plan/replicate_work.h"
#include "libcore/replicate/plan/surface_foot.h"
#include "libcore/replicate/web/web_edit.h"

enum { CHOICES = 6, CHOICES_OF_FEW = 64, AROUND = 48 };

/* What corners that are not alike count, beside distances that are not. */
static const double UNLIKE = 0.15;

/* ---- choice ---- */

/* Places of details around a triangle. */
typedef struct Around {
    uint32_t count;
    MesoVec3 heading;   /* of details that have one, at the corners */
    float x[AROUND + MESO_EXEMPLAR_INSIDE], y[AROUND + MESO_EXEMPLAR_INSIDE], z[AROUND + MESO_EXEMPLAR_INSIDE];
} Around;

static void add_place(Around *around, MesoVec3 place)
{
    around->x[around->count] = place.x;
    around->y[around->count] = place.y;
    around->z[around->count++] = place.z;
}

static void add_around(Around *around, uint32_t nodes[AROUND], const MesoWeb *web, uint32_t node)
{
    if (node < web->fixed_count || around->count == AROUND)
        return;
    for (uint32_t i = 0; i < around->count; i++)
        if (nodes[i] == node)
            return;
    nodes[around->count] = node;
    add_place(around, web->positions[node]);
}

static void look_around(Around *around, const MesoWeb *web, uint32_t triangle)
{
    uint32_t nodes[AROUND], ring[AROUND];
    around->count = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t corner = web->corners[3 * triangle + k], count = meso_web_ring(web, corner, ring, AROUND);
        add_around(around, nodes, web, corner);
        for (uint32_t i = 0; i < count && i < AROUND; i++)
            add_around(around, nodes, web, ring[i]);
    }
}

/* Those of corners, as one: a half turn is none. */
static MesoVec3 heading_around(const MesoReplication *r, uint32_t triangle)
{
    MesoVec3 sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t node = r->web.corners[3 * triangle + k];
        if (node < r->web.fixed_count)
            continue;
        MesoVec3 heading = meso_heading(r, r->now.positions, node - r->web.fixed_count);
        sum = meso_vec3_mad(sum, meso_vec3_dot(sum, heading) < 0 ? -1 : 1, heading);
    }
    return meso_vec3_unit(sum, (MesoVec3){0, 0, 0});
}

/* How far the nearest distances at a place are from those that a detail has at rest; and how far others push it. */
static double misfit(const MesoOriginal *original, const MesoEdgePush *edges, const Around *around, MesoVec3 place)
{
    float squares[AROUND + MESO_EXEMPLAR_INSIDE], near[MESO_ORIGINAL_NEAR], pushed = 0;
    for (uint32_t k = 0; k < MESO_ORIGINAL_NEAR; k++)
        near[k] = INFINITY;
    float aspect = original->aspect, across = 1 / aspect - aspect;
    for (uint32_t i = 0; i < around->count; i++) {
        float x = around->x[i] - place.x, y = around->y[i] - place.y, z = around->z[i] - place.z;
        squares[i] = x * x + y * y + z * z;
    }
    for (uint32_t i = 0; i < around->count; i++)
        pushed += meso_push_at(edges, squares[i]);
    for (uint32_t i = 0; i < around->count && aspect != 1; i++) {
        float along = (around->x[i] - place.x) * around->heading.x + (around->y[i] - place.y) * around->heading.y
                      + (around->z[i] - place.z) * around->heading.z;
        squares[i] = squares[i] * aspect + along * along * across;
    }
    for (uint32_t i = 0; i < around->count; i++) {
        float d2 = squares[i];
        for (uint32_t k = 0; k < MESO_ORIGINAL_NEAR; k++) {     /* no branches: what comes next cannot be foreseen */
            float further = d2 < near[k] ? near[k] : d2;
            near[k] = d2 < near[k] ? d2 : near[k];
            d2 = further;
        }
    }
    double sum = (double)pushed;
    for (uint32_t k = 0; k < MESO_ORIGINAL_NEAR; k++)
        if (original->near[k] > 0 && original->near[k] < INFINITY && near[k] < INFINITY) {
            double ratio = sqrt((double)near[k]) / (double)original->near[k] - 1;
            sum += ratio * ratio;
        }
    return sum;
}

/* Of what stands at the corners: how large, with how much room, of which kind. NULL: no detail does. */
static double unlike(const MesoOriginal *as, const MesoOriginal *like)
{
    return as ? fabs((double)as->log_size - (double)like->log_size) + (as->kind != like->kind)
                + 0.5 * fabs((double)as->log_area - (double)like->log_area) : 0;
}

/* An exemplar's corners from those of a triangle, in three turns. */
static void unlike_corners(const MesoReplication *r, const MesoOriginal *as[3], const MesoExemplar *exemplar,
                           double costs[3])
{
    costs[0] = costs[1] = costs[2] = 0;
    for (uint32_t k = 0; k < 3; k++) {
        const MesoOriginal *like = &r->exemplars.originals[exemplar->corners[k]];
        for (uint32_t turn = 0; turn < 3; turn++)
            costs[turn] += unlike(as[(k + 3 - turn) % 3], like);
    }
}

static void transfer(const MesoReplication *r, const uint32_t nodes[3], const MesoExemplar *exemplar, uint32_t turn,
                     MesoBirth *births)
{
    const MesoWeb *web = &r->web;
    for (uint32_t i = 0; i < exemplar->inside_count; i++) {
        uint32_t nearest = 0;
        float most = -1;
        MesoVec3 place = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++) {
            float w = exemplar->weights[i][(k + turn) % 3];
            place = meso_vec3_mad(place, w, web->positions[nodes[k]]);
            if (nodes[k] >= web->fixed_count && w > most) {
                most = w;
                nearest = nodes[k] - web->fixed_count;
            }
        }
        births[i] = (MesoBirth){exemplar->inside[i], place, nearest, r->blocks[nearest]};
    }
}

/* Each beside the others that are born with it; or something that is more than `most`. */
static double misfit_of_all(const MesoReplication *r, Around *around, const MesoBirth *births, uint32_t count,
                            double most)
{
    double sum = 0;
    uint32_t before = around->count;
    for (uint32_t i = 0; i < count && sum <= most * count; i++) {
        around->count = before;
        for (uint32_t k = 0; k < count; k++)
            if (k != i)
                add_place(around, births[k].place);
        sum += MESO_COPY_COST * r->copies[births[i].copied]
               + misfit(&r->exemplars.originals[births[i].copied], &r->tolerance.edges, around, births[i].place);
    }
    around->count = before;
    return sum / count;
}

/*
 * Each is moved a little, while it has no size yet, to where its distances fit better: by so much of the nearest.
 * Returns what they cost where that is most.
 */
static double relax(const MesoReplication *r, const uint32_t nodes[3], Around *around, MesoBirth *births,
                    uint32_t count)
{
    double worst = 0;
    static const float ways[6][2] = {{1, 0}, {0.5f, 0.866f}, {-0.5f, 0.866f},
                                     {-1, 0}, {-0.5f, -0.866f}, {0.5f, -0.866f}};
    static const float reaches[3] = {0.15f, 0.08f, 0.04f};
    const MesoVec3 *p = r->web.positions;
    MesoVec3 side = meso_vec3_sub(p[nodes[1]], p[nodes[0]]), other = meso_vec3_sub(p[nodes[2]], p[nodes[0]]);
    MesoVec3 x = meso_vec3_unit(side, (MesoVec3){1, 0, 0});
    MesoVec3 y = meso_vec3_cross(meso_vec3_unit(meso_vec3_cross(side, other), (MesoVec3){0, 0, 1}), x);
    uint32_t before = around->count, rounds = r->detail_count < MESO_FEW_DETAILS ? 3 : 1;
    for (uint32_t i = 0; i < count; i++) {
        const MesoOriginal *as = &r->exemplars.originals[births[i].copied];
        around->count = before;
        for (uint32_t k = 0; k < count; k++)
            if (k != i)
                add_place(around, births[k].place);
        double least = misfit(as, &r->tolerance.edges, around, births[i].place);
        for (uint32_t n = 0; n < rounds && as->near[0] < INFINITY; n++) {
            MesoVec3 from = births[i].place;
            for (uint32_t w = 0; w < 6; w++) {
                MesoVec3 place = meso_vec3_mad(from, reaches[n] * as->near[0] * ways[w][0], x);
                place = meso_vec3_mad(place, reaches[n] * as->near[0] * ways[w][1], y);
                double cost = misfit(as, &r->tolerance.edges, around, place);
                if (cost < least) {
                    least = cost;
                    births[i].place = place;
                }
            }
        }
        worst = fmax(worst, least);
    }
    around->count = before;
    return worst;
}

/* What the details at the corners are copies of. */
static void know_corners(const MesoReplication *r, const uint32_t nodes[3], const MesoOriginal *as[3])
{
    for (uint32_t k = 0; k < 3; k++) {
        bool fixed = nodes[k] < r->web.fixed_count;
        as[k] = fixed ? NULL : &r->exemplars.originals[r->details[nodes[k] - r->web.fixed_count].copied];
    }
}

uint32_t meso_choose_births(const MesoReplication *r, uint32_t triangle, uint32_t limit,
                            MesoBirth births[MESO_EXEMPLAR_INSIDE], double *cost)
{
    const MesoWeb *web = &r->web;
    const uint32_t *c = web->corners + 3 * (size_t)triangle;
    const MesoExemplar *similar[CHOICES_OF_FEW];
    const MesoOriginal *as[3];
    double angle = meso_smallest_angle(meso_web_length2(web, c[0], c[1]), meso_web_length2(web, c[1], c[2]),
                                       meso_web_length2(web, c[2], c[0]));
    uint32_t room = r->detail_count < MESO_FEW_DETAILS ? CHOICES_OF_FEW : CHOICES, made = 0;
    uint32_t count = meso_exemplars_near(&r->exemplars, meso_web_area(web, triangle), angle, limit, similar, room);
    double least = INFINITY;
    Around around;
    look_around(&around, web, triangle);
    around.heading = heading_around(r, triangle);
    know_corners(r, c, as);
    for (uint32_t i = 0; i < count; i++) {
        double unlike[3];
        unlike_corners(r, as, similar[i], unlike);
        for (uint32_t turn = 0; turn < 3; turn++) {
            MesoBirth tried[MESO_EXEMPLAR_INSIDE];
            double sum = UNLIKE * unlike[turn];
            if (!(sum < least))
                continue;
            transfer(r, c, similar[i], turn, tried);
            sum += misfit_of_all(r, &around, tried, similar[i]->inside_count, least - sum);
            if (!(sum < least))
                continue;
            least = sum;
            made = similar[i]->inside_count;
            memcpy(births, tried, made * sizeof *births);
        }
    }
    *cost = relax(r, c, &around, births, made);
    return made;
}

/* ---- into the web ---- */

static float copied_angle(const MesoReplication *r, const MesoBirth *birth, uint32_t triangle)
{
    const MesoDetail *beside = &r->details[birth->beside];
    MesoTriangleFrame there = meso_frame(r->rest, beside->point.triangle), here = meso_frame(r->rest, triangle);
    MesoVec3 heading = meso_frame_out(&there, (MesoComplex){cos((double)beside->angle), sin((double)beside->angle)});
    MesoComplex direction = meso_frame_in(&here, heading);
    return (float)atan2(direction.im, direction.re) + r->exemplars.originals[birth->copied].turn;
}

static MesoStatus make_room(MesoReplication *r, MesoError *error)
{
    uint32_t n = r->detail_count;
    if (n == r->detail_room) {
        size_t room = 2 * (size_t)n + 16;
        MesoDetail *details = meso_arena_enlarge(&r->arena, r->details, n, room, sizeof *details, error);
        uint32_t *blocks = meso_arena_enlarge(&r->arena, r->blocks, n, room, sizeof *blocks, error);
        float *areas = meso_arena_enlarge(&r->arena, r->areas, n, room, sizeof *areas, error);
        float *grown = meso_arena_enlarge(&r->arena, r->grown, n, room, sizeof *grown, error);
        MesoDetailFate *fates = meso_arena_enlarge(&r->arena, r->fates, n, room, sizeof *fates, error);
        uint32_t *begin = meso_arena_enlarge(&r->arena, r->near_begin, n + 1, room + 1, sizeof *begin, error);
        if (!details || !blocks || !areas || !grown || !fates || !begin)
            return MESO_ERR_MEMORY;
        r->details = details;
        r->blocks = blocks;
        r->areas = areas;
        r->grown = grown;
        r->fates = fates;
        r->near_begin = begin;
        r->detail_room = (uint32_t)room;
    }
    uint32_t used = r->near_begin[n];
    if (used + MESO_BIRTH_NEAR > r->near_room) {
        size_t room = 2 * ((size_t)used + MESO_BIRTH_NEAR);
        MesoNeighbour *near = meso_arena_enlarge(&r->arena, r->near, used, room, sizeof *near, error);
        if (!near)
            return MESO_ERR_MEMORY;
        r->near = near;
        r->near_room = (uint32_t)room;
    }
    return MESO_OK;
}

/* Nearest first, as many as there is room for. */
static void remember(MesoReplication *r, uint32_t detail, MesoVec3 heading, uint32_t other)
{
    uint32_t begin = r->near_begin[detail], *end = &r->near_begin[detail + 1], at = *end;
    float d = meso_distance(r, r->web.positions + r->web.fixed_count, detail, heading, other);
    for (uint32_t i = begin; i < *end; i++)
        if (r->near[i].detail == other)
            return;
    if (at - begin == MESO_BIRTH_NEAR) {
        at--;
        if (!(d < r->near[at].distance))
            return;
    } else {
        ++*end;
    }
    for (; at > begin && d < r->near[at - 1].distance; at--)
        r->near[at] = r->near[at - 1];
    r->near[at] = (MesoNeighbour){other, d};
}

/* What is joined to it, and what lies across the sides around that: enough where no plan is made to be played. */
static void remember_next(MesoReplication *r, uint32_t detail, MesoVec3 heading)
{
    const MesoWeb *web = &r->web;
    MesoSpokes s = meso_spokes(web, web->fixed_count + detail);
    r->near_begin[detail + 1] = r->near_begin[detail];
    do {
        uint32_t side = meso_next_corner(s.now), across = web->twins[side];
        uint32_t nodes[2] = {web->corners[side], across == MESO_NO_INDEX ? 0 : meso_web_apex(web, across)};
        for (uint32_t k = 0; k < 2; k++)
            if (nodes[k] >= web->fixed_count && nodes[k] != web->fixed_count + detail)
                remember(r, detail, heading, nodes[k] - web->fixed_count);
    } while (meso_spokes_next(web, &s));
}

static void remember_near(MesoReplication *r, uint32_t detail, MesoVec3 heading)
{
    const MesoWeb *web = &r->web;
    uint32_t ring[AROUND], second[AROUND];
    uint32_t count = meso_web_ring(web, web->fixed_count + detail, ring, AROUND);
    r->near_begin[detail + 1] = r->near_begin[detail];
    for (uint32_t i = 0; i < count && i < AROUND; i++) {
        uint32_t more = meso_web_ring(web, ring[i], second, AROUND);
        if (ring[i] >= web->fixed_count)
            remember(r, detail, heading, ring[i] - web->fixed_count);
        for (uint32_t k = 0; k < more && k < AROUND; k++)
            if (second[k] >= web->fixed_count && second[k] != web->fixed_count + detail)
                remember(r, detail, heading, second[k] - web->fixed_count);
    }
}

MesoStatus meso_give_birth(MesoReplication *r, uint32_t triangle, const MesoBirth *birth, int32_t frame,
                           MesoError *error)
{
    MesoWeb *web = &r->web;
    const MesoVec3 *positions = r->now.positions;
    MesoMeshPoint point = meso_point_towards(r->rest, positions, r->details[birth->beside].point, birth->place);
    MesoVec3 position = meso_detail_position(r->rest, positions, &point);
    MesoVec3 normal = meso_vec3_unit(meso_detail_position(r->rest, r->normals, &point), (MesoVec3){0, 0, 1});
    MesoStatus status = make_room(r, error);
    bool beyond;    /* does not matter: the point is on the surface */
    triangle = meso_web_triangle(web, triangle, position, &beyond);
    if (status == MESO_OK)
        status = meso_web_insert(web, triangle, point, position, normal, error);
    if (status != MESO_OK)
        return status;
    uint32_t detail = r->detail_count++;
    const MesoDetail *copied = &r->details[birth->copied];
    r->details[detail] = (MesoDetail){.point = point, .angle = copied_angle(r, birth, point.triangle),
                                      .size = copied->size, .width = copied->width, .kind = copied->kind,
                                      .copied = birth->copied, .rank = detail, .radius = INFINITY, .born = frame};
    r->areas[detail] = r->areas[birth->copied];
    r->grown[detail] = 0;
    r->fates[detail] = (MesoDetailFate){MESO_DETAIL_LIVES, MESO_NO_INDEX};
    r->blocks[detail] = birth->block;
    r->due[r->blocks[detail]]--;
    r->copies[birth->copied]++;
    MesoVec3 heading = meso_heading(r, positions, detail);
    if (r->options.mode == MESO_REPLICATE_PLAN)
        remember_near(r, detail, heading);
    else
        remember_next(r, detail, heading);
    if (r->near_begin[detail + 1] > r->near_begin[detail])
        r->details[detail].radius = r->near[r->near_begin[detail]].distance;
    return MESO_OK;
}
