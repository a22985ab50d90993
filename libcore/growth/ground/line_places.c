/* Places for seeds at vertices and points, along borders and curves. */
#include <stdlib.h>

#include "libcore/growth/ground/growth_snap.h"
#include "libcore/growth/ground/seed_places.h"

/* ---- points ---- */

static MesoSurfacePlace place_of(const MesoMeshPoint *point)
{
    double a = fmax((double)point->weight[0], 0), b = fmax((double)point->weight[1], 0);
    double c = fmax((double)point->weight[2], 0), sum = a + b + c;
    return (MesoSurfacePlace){point->triangle, {a / sum, b / sum, c / sum}};
}

MesoStatus meso_places_points(MesoSeedWork *work)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < work->point_count && !status; i++) {
        MesoSurfacePlace at = place_of(&work->points[i]);
        status = meso_place_add(work, &at, i);
    }
    return status;
}

MesoStatus meso_places_at(MesoSeedWork *work)
{
    const MesoGrammarValue *values = work->seed->places.values;
    MesoSurfacePlace at = {0, {1, 0, 0}};
    float p[3];
    for (uint32_t i = 0; i < 3; i++) {
        double x = meso_place_number(work, &values[i], &at, 0);
        if (!(fabs(x) <= (double)MESO_COORDINATE_LIMIT))
            return meso_place_fault(work, &values[i], "a coordinate");
        p[i] = (float)x;
    }
    MesoMeshPoint point;
    MesoVec3 from = {p[0], p[1], p[2]};
    MesoStatus status = meso_growth_snap(work->contexts->ground->mesh, work->arena, &from, 1, &point, 1, work->error);
    if (status)
        return status;
    at = place_of(&point);
    return meso_place_add(work, &at, 0);
}

/* ---- vertices ---- */

typedef struct Chosen {
    uint64_t order, number;
    uint32_t vertex;
} Chosen;

static int compare_chosen(const void *a, const void *b)
{
    const Chosen *x = a, *y = b;
    if (x->order != y->order)
        return x->order < y->order ? -1 : 1;
    return (x->vertex > y->vertex) - (x->vertex < y->vertex);
}

static MesoSurfacePlace place_at_vertex(const MesoTriangulation *mesh, uint32_t vertex)
{
    uint32_t corner = mesh->vertex_corner[vertex];
    MesoSurfacePlace at = {corner / 3, {0, 0, 0}};
    at.weight[corner % 3] = 1;
    return at;
}

/* In an order that is drawn, too. */
MesoStatus meso_places_vertices(MesoSeedWork *work)
{
    const MesoTriangulation *mesh = work->contexts->ground->mesh;
    const MesoGrammarValue *value = &work->seed->places.values[0];
    MesoArena scratch;
    uint32_t count = 0;
    meso_arena_init(&scratch);
    Chosen *chosen = MESO_NEW(&scratch, Chosen, mesh->vertex_count, work->error);
    MesoStatus status = chosen ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < mesh->vertex_count && !status; v++) {
        if (mesh->vertex_corner[v] == MESO_NO_INDEX)
            continue;
        uint64_t number = meso_place_hash(mesh->positions[v]), order = meso_draw_key(work->job, number, 0);
        MesoSurfacePlace at = place_at_vertex(mesh, v);
        double share = meso_place_number(work, value, &at, number);
        if (isnan(share))
            status = meso_place_fault(work, value, "the share");
        else if (meso_draw_share(order) < share)
            chosen[count++] = (Chosen){order, number, v};
    }
    qsort(chosen, status ? 0 : count, sizeof *chosen, compare_chosen);
    for (uint32_t i = 0; i < count && !status; i++) {
        MesoSurfacePlace at = place_at_vertex(mesh, chosen[i].vertex);
        status = meso_place_add(work, &at, chosen[i].number);
    }
    meso_arena_release(&scratch);
    return status;
}

/* ---- along lines ---- */

/* A straight part of a line. */
typedef struct Part {
    MesoSurfacePlace ends[2];
    double length;
    double count;           /* how many places the line so far has room for, before this part */
    double slope[2];        /* places a unit at its ends */
} Part;

typedef struct Line {
    Part *parts;            /* [count] */
    uint32_t count;
    bool closed;
    uint64_t number;        /* of its first place */
    MesoVec3 *curve;        /* [place_count] places on a curve of space, before they are brought to the surface; NULL:
                             * the line runs in triangles */
    uint32_t place_count;
} Line;

enum { MOST_PLACES = 1 << 30 };

static double density_at(const MesoSeedWork *work, const MesoGrammarValue *spacing, const MesoSurfacePlace *at,
                         MesoStatus *status)
{
    double each = meso_place_number(work, spacing, at, 0);
    if (!isfinite(each) && !*status)
        *status = meso_place_fault(work, spacing, "the spacing");
    return each > 0 ? 1 / each : 0;
}

/* Where in a part the n-th place of the line is: between its ends the density of places is linear. */
static double share_of(const Part *part, double n)
{
    double want = n - part->count, a = part->length * part->slope[0];
    double b = part->length * (part->slope[1] - part->slope[0]);
    double root = sqrt(fmax(a * a + 2 * b * want, 0)), t = a + root > 0 ? 2 * want / (a + root) : 0;
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

static MesoVec3 position_of(const MesoSeedWork *work, const MesoSurfacePlace *at)
{
    return meso_growth_position(work->contexts->ground, at->triangle, at->weight);
}

/* At a share of a part. */
static MesoStatus add_on_line(MesoSeedWork *work, Line *line, const Part *part, double share, uint64_t number)
{
    if (line->curve) {
        line->curve[line->place_count++] = meso_vec3_lerp(position_of(work, &part->ends[0]),
                                                          position_of(work, &part->ends[1]), (float)share);
        return MESO_OK;
    }
    MesoSurfacePlace at = part->ends[0];
    for (uint32_t k = 0; k < 3; k++)
        at.weight[k] = (1 - share) * part->ends[0].weight[k] + share * part->ends[1].weight[k];
    return meso_place_add(work, &at, number);
}

/* Puts places along a line: closed ones get a whole number evenly, at least one; open ones begin half a spacing in. */
static MesoStatus place_along(MesoSeedWork *work, const MesoGrammarValue *spacing, Line *line, MesoArena *scratch)
{
    double all = 0;
    MesoStatus status = MESO_OK;
    if (spacing->index == MESO_NO_INDEX && !(spacing->number > 0))
        return meso_fail(work->error, MESO_ERR_INPUT, "line %u: the spacing is not above 0",
                         work->grammar->lines[work->seed->entry]);
    for (uint32_t i = 0; i < line->count; i++) {
        Part *part = &line->parts[i];
        part->count = all;
        for (uint32_t k = 0; k < 2; k++)
            part->slope[k] = density_at(work, spacing, &part->ends[k], &status);
        all += 0.5 * part->length * (part->slope[0] + part->slope[1]);
    }
    if (status || !(all > 0))
        return status;
    if (all > MOST_PLACES)
        return meso_fail(work->error, MESO_ERR_LIMIT, "more than %d places for seeds along a line", (int)MOST_PLACES);
    uint32_t count = all < 1 ? 1 : (uint32_t)(all + 0.5), at = 0;
    if (!line->closed && !(line->curve = MESO_NEW(scratch, MesoVec3, count, work->error)))
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count && !status; i++) {
        double n = all * (line->closed ? i : i + 0.5) / count;
        while (at + 1 < line->count && line->parts[at + 1].count <= n)
            at++;
        status = add_on_line(work, line, &line->parts[at], share_of(&line->parts[at], n), line->number + i);
    }
    return status;
}

/* ---- borders ---- */

/* The next half-edge of a border; turned ones are gone along from their end. */
static uint32_t next_on_border(const MesoTriangulation *mesh, uint32_t half_edge, bool turned, bool *next_turned)
{
    /* the fan around the end vertex, from this triangle away from the border */
    uint32_t corner = turned ? half_edge : meso_next_corner(half_edge);
    MesoFan fan = {corner, !turned};
    while (meso_fan_next(mesh, &fan))
        continue;
    *next_turned = !fan.turned;
    return meso_fan_exit(fan);
}

static MesoVec3 border_begin(const MesoTriangulation *mesh, uint32_t half_edge, bool turned)
{
    return mesh->positions[mesh->corners[turned ? meso_next_corner(half_edge) : half_edge]];
}

static MesoSurfacePlace on_side(uint32_t half_edge, bool turned, double share)
{
    uint32_t k = half_edge % 3, next = k == 2 ? 0 : k + 1;
    MesoSurfacePlace at = {half_edge / 3, {0, 0, 0}};
    at.weight[turned ? next : k] = 1 - share;
    at.weight[turned ? k : next] = share;
    return at;
}

static double apart(MesoVec3 a, MesoVec3 b)
{
    double x = (double)a.x - b.x, y = (double)a.y - b.y, z = (double)a.z - b.z;
    return sqrt(x * x + y * y + z * z);
}

static MesoStatus walk_border(MesoSeedWork *work, const MesoGrammarValue *spacing, uint32_t begin, uint8_t *met,
                              MesoArena *scratch)
{
    const MesoTriangulation *mesh = work->contexts->ground->mesh;
    uint32_t first = begin, h = begin, count = 0;
    bool turned = false, first_turned = false;
    do {
        if (meso_place_compare(border_begin(mesh, h, turned), border_begin(mesh, first, first_turned)) < 0) {
            first = h;
            first_turned = turned;
        }
        met[h] = 1;
        count++;
        h = next_on_border(mesh, h, turned, &turned);
    } while (h != begin);
    Line line = {.count = count, .closed = true,
                 .number = meso_place_hash(border_begin(mesh, first, first_turned))};
    line.parts = MESO_NEW(scratch, Part, count, work->error);
    if (!line.parts)
        return MESO_ERR_MEMORY;
    h = first;
    turned = first_turned;
    for (uint32_t i = 0; i < count; i++) {
        line.parts[i] = (Part){.ends = {on_side(h, turned, 0), on_side(h, turned, 1)},
                               .length = apart(mesh->positions[mesh->corners[h]],
                                               mesh->positions[mesh->corners[meso_next_corner(h)]])};
        h = next_on_border(mesh, h, turned, &turned);
    }
    return place_along(work, spacing, &line, scratch);
}

MesoStatus meso_places_border(MesoSeedWork *work)
{
    const MesoTriangulation *mesh = work->contexts->ground->mesh;
    MesoArena scratch;
    meso_arena_init(&scratch);
    uint8_t *met = MESO_NEW(&scratch, uint8_t, 3 * (size_t)mesh->triangle_count, work->error);
    MesoStatus status = met ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count && !status; h++)
        if (mesh->twins[h] == MESO_NO_INDEX && !met[h])
            status = walk_border(work, &work->seed->places.values[0], h, met, &scratch);
    meso_arena_release(&scratch);
    return status;
}

/* ---- curves ---- */

/* From their places in space to the surface. */
static MesoStatus snap_curve(MesoSeedWork *work, const Line *line, MesoArena *scratch)
{
    MesoMeshPoint *points = MESO_NEW(scratch, MesoMeshPoint, line->place_count, work->error);
    MesoStatus status = points ? meso_growth_snap(work->contexts->ground->mesh, scratch, line->curve, line->place_count,
                                                  points, work->thread_count, work->error) : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < line->place_count && !status; i++) {
        MesoSurfacePlace at = place_of(&points[i]);
        status = meso_place_add(work, &at, line->number + i);
    }
    return status;
}

MesoStatus meso_places_curve(MesoSeedWork *work)
{
    MesoArena scratch;
    if (work->point_count < 2)
        return meso_places_points(work);
    meso_arena_init(&scratch);
    Line line = {.count = 0};
    line.parts = MESO_NEW(&scratch, Part, work->point_count, work->error);
    MesoStatus status = line.parts ? MESO_OK : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i + 1 < work->point_count && !status; i++) {
        if (work->breaks && work->breaks[i + 1])
            continue;
        Part *part = &line.parts[line.count++];
        part->ends[0] = place_of(&work->points[i]);
        part->ends[1] = place_of(&work->points[i + 1]);
        part->length = apart(position_of(work, &part->ends[0]), position_of(work, &part->ends[1]));
    }
    if (!status)
        status = place_along(work, &work->seed->places.values[1], &line, &scratch);
    if (!status)
        status = snap_curve(work, &line, &scratch);
    meso_arena_release(&scratch);
    return status;
}
