#include "libcore/tiling/tile/contour.h"

#include <math.h>
#include <stdlib.h>

#include "libcore/tiling/tile/clipper_adapter.h"

/*
 * Integer units an edge length. 2^24 leaves room for drawings of 32 edge
 * lengths in Clipper's fast range, at a sixteen-millionth of an edge.
 */
static const double SCALE = 1 << 24;
static const double REACH = 32;

enum { MAX_POINTS = 1 << 20, MAX_CONTOURS = 1024, MIN_DISC_POINTS = 8 };

/* Points closer than this, in edge lengths, are one: Clipper cuts leave such slivers. */
static const double WELD = 1e-6;

/* A drawing as a program for the clipper. */
typedef struct Program {
    MesoClipStep *steps;
    uint32_t step_count;
    MesoIntPoint *points;
    uint32_t point_count;
} Program;

/* The drawing's coordinates: the height of the shell is half an edge length. */
static MesoVec2 domain_point(MesoVec2 unit)
{
    return (MesoVec2){unit.x, 0.5f * unit.y};
}

/*
 * Centre of a drawing: of a union the mean of its operands', of a difference
 * the left one's. Long unions lean to the left, so that side is a loop.
 */
static MesoVec2 csg_center(const MesoTileSet *set, uint32_t node)
{
    double x = 0, y = 0, weight = 1;
    const MesoCsgNode *n = &set->csg[node];
    while (n->kind == MESO_CSG_DIFFERENCE || n->kind == MESO_CSG_UNION) {
        if (n->kind == MESO_CSG_UNION) {
            MesoVec2 right = csg_center(set, n->right);
            weight /= 2;
            x += weight * (double)right.x;
            y += weight * (double)right.y;
        }
        n = &set->csg[n->left];
    }
    return (MesoVec2){(float)(x + weight * (double)n->center.x), (float)(y + weight * (double)n->center.y)};
}

/* Samples a disc by its root-mean-square radius, so that an ellipse gets as many as a like circle. */
static uint32_t disc_point_count(const MesoCsgNode *disc, float step)
{
    double rx = 0.5 * (double)disc->size.x, ry = 0.5 * (double)disc->size.y;
    double count = floor(2 * MESO_PI * sqrt((rx * rx + ry * ry) / 2) / (double)step);
    return count < MIN_DISC_POINTS ? MIN_DISC_POINTS
         : count > MAX_POINTS ? MAX_POINTS + 1 : (uint32_t)count;
}

static uint32_t outline_point_count(const MesoCsgNode *node, float step)
{
    return node->kind == MESO_CSG_DISC ? disc_point_count(node, step) : 4;
}

static MesoIntPoint outline_point(const MesoCsgNode *node, uint32_t i, uint32_t count)
{
    static const double box_x[4] = {-0.5, 0.5, 0.5, -0.5}, box_y[4] = {-0.5, -0.5, 0.5, 0.5};
    bool disc = node->kind == MESO_CSG_DISC;
    double angle = 2 * MESO_PI * i / count;
    double x = (double)node->size.x * (disc ? 0.5 * cos(angle) : box_x[i]);
    double y = (double)node->size.y * (disc ? 0.5 * sin(angle) : box_y[i]);
    double c = cos((double)node->angle), s = sin((double)node->angle);
    MesoVec2 center = domain_point(node->center);
    double px = (double)center.x + c * x - s * y, py = (double)center.y + s * x + c * y;
    return (MesoIntPoint){llrint(fmax(-REACH, fmin(REACH, px)) * SCALE),
                          llrint(fmax(-REACH, fmin(REACH, py)) * SCALE)};
}

static int compare_indices(const void *a, const void *b)
{
    uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
    return x < y ? -1 : x > y;
}

/*
 * Collects the nodes under `root`, ascending; operands come before their
 * operations because of the order of the nodes. `step_of` [csg_count] is
 * scratch, all zero before and after; returns the number of nodes.
 */
static uint32_t collect_nodes(const MesoTileSet *set, uint32_t root, uint32_t *nodes, uint32_t *step_of)
{
    uint32_t count = 1;
    nodes[0] = root;
    step_of[root] = 1;
    for (uint32_t next = 0; next < count; next++) {
        const MesoCsgNode *n = &set->csg[nodes[next]];
        if (n->kind != MESO_CSG_UNION && n->kind != MESO_CSG_DIFFERENCE)
            continue;
        uint32_t operands[2] = {n->left, n->right};
        for (int k = 0; k < 2; k++)
            if (!step_of[operands[k]]) {
                step_of[operands[k]] = 1;
                nodes[count++] = operands[k];
            }
    }
    qsort(nodes, count, sizeof *nodes, compare_indices);
    for (uint32_t i = 0; i < count; i++)
        step_of[nodes[i]] = i;
    return count;
}

static MesoStatus compile(Program *program, MesoArena *arena, const MesoTileSet *set, uint32_t root,
                          float step, uint32_t *nodes, uint32_t *step_of, MesoError *error)
{
    uint32_t count = collect_nodes(set, root, nodes, step_of);
    uint64_t points = 0;
    for (uint32_t i = 0; i < count; i++)
        points += outline_point_count(&set->csg[nodes[i]], step);
    if (points > MAX_POINTS)
        return meso_fail(error, MESO_ERR_LIMIT, "a drawing needs over %d points; a larger section step would help",
                         MAX_POINTS);

    *program = (Program){.step_count = count};
    program->steps = MESO_NEW(arena, MesoClipStep, count, error);
    program->points = MESO_NEW(arena, MesoIntPoint, points, error);
    if (!program->steps || !program->points)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        const MesoCsgNode *n = &set->csg[nodes[i]];
        MesoClipStep *s = &program->steps[i];
        if (n->kind == MESO_CSG_UNION || n->kind == MESO_CSG_DIFFERENCE) {
            *s = (MesoClipStep){n->kind == MESO_CSG_UNION ? MESO_CLIP_UNION : MESO_CLIP_DIFFERENCE,
                                step_of[n->left], step_of[n->right], 0, 0};
        } else {
            uint32_t n_points = outline_point_count(n, step);
            *s = (MesoClipStep){MESO_CLIP_PATH, 0, 0, program->point_count, n_points};
            for (uint32_t k = 0; k < n_points; k++)
                program->points[program->point_count++] = outline_point(n, k, n_points);
        }
    }
    for (uint32_t i = 0; i < count; i++)
        step_of[nodes[i]] = 0;
    return MESO_OK;
}

static double doubled_area(const MesoIntPoint *p, uint32_t count)
{
    double area = 0;
    for (uint32_t i = 0; i < count; i++) {
        const MesoIntPoint *a = &p[i], *b = &p[(i + 1) % count];
        area += (double)a->x * (double)b->y - (double)b->x * (double)a->y;
    }
    return area / (SCALE * SCALE);
}

/* Pieces that the segment from a to b is cut into; none where the two are one point. */
static uint32_t segment_pieces(const MesoIntPoint *a, const MesoIntPoint *b, float step)
{
    double length = hypot((double)(b->x - a->x), (double)(b->y - a->y)) / SCALE;
    return length < WELD ? 0 : 1 + (uint32_t)(length / (2 * (double)step));
}

static uint32_t path_sample_count(const MesoIntPoint *p, uint32_t count, float step)
{
    uint32_t samples = 0;
    for (uint32_t i = 0; i < count; i++)
        samples += segment_pieces(&p[i], &p[(i + 1) % count], step);
    return samples;
}

/* Each segment gives its inner points and its end, so that the list ends at the path's start. */
static void sample_path(MesoVec2 *out, const MesoIntPoint *p, uint32_t count, float step, MesoVec2 center)
{
    MesoVec2 c = domain_point(center);
    for (uint32_t i = 0; i < count; i++) {
        const MesoIntPoint *a = &p[i], *b = &p[(i + 1) % count];
        uint32_t pieces = segment_pieces(a, b, step);
        for (uint32_t k = 1; k <= pieces; k++) {
            double t = (double)k / pieces;
            *out++ = (MesoVec2){
                (float)(((double)a->x + t * (double)(b->x - a->x)) / SCALE - (double)c.x),
                (float)(((double)a->y + t * (double)(b->y - a->y)) / SCALE - (double)c.y)};
        }
    }
}

typedef struct RankedPath {
    double area;
    uint32_t path;
} RankedPath;

static int compare_ranked(const void *a, const void *b)
{
    const RankedPath *x = a, *y = b;
    double difference = fabs(y->area) - fabs(x->area);
    if (difference != 0)
        return difference < 0 ? -1 : 1;
    return x->path < y->path ? -1 : x->path > y->path;
}

/* Contours that are kept, largest first; slivers without area or with under three points are not. */
static uint32_t rank_paths(RankedPath *ranked, const MesoIntPolygons *polygons, float step)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < polygons->path_count; i++) {
        const MesoIntPoint *p = polygons->points + polygons->path_begin[i];
        uint32_t n = polygons->path_begin[i + 1] - polygons->path_begin[i];
        double area = doubled_area(p, n);
        if (fabs(area) > WELD * WELD && path_sample_count(p, n, step) >= 3)
            ranked[count++] = (RankedPath){area, i};
    }
    qsort(ranked, count, sizeof *ranked, compare_ranked);
    return count;
}

/* Contours of one cross-section; results are chained in `arena` until they are put together. */
typedef struct SectionContours {
    MesoIntPolygons polygons;
    RankedPath *ranked;
    uint32_t count, point_count;
} SectionContours;

static MesoStatus clip_section(SectionContours *out, MesoArena *arena, const MesoTileSet *set,
                               uint32_t section, float step, uint32_t *nodes, uint32_t *step_of,
                               MesoError *error)
{
    Program program = {0};
    MesoStatus status = compile(&program, arena, set, set->sections[section].csg_root, step, nodes,
                                step_of, error);
    if (!status)
        status = meso_clip(&out->polygons, arena, program.steps, program.step_count, program.points, error);
    if (status)
        return status;
    out->ranked = MESO_NEW(arena, RankedPath, out->polygons.path_count, error);
    if (!out->ranked)
        return MESO_ERR_MEMORY;
    out->count = rank_paths(out->ranked, &out->polygons, step);
    if (out->count > MAX_CONTOURS)
        return meso_fail(error, MESO_ERR_LIMIT, "a drawing has %u contours; %d are the most in one cross-section",
                         out->count, MAX_CONTOURS);
    uint64_t points = 0;
    for (uint32_t i = 0; i < out->count; i++) {
        uint32_t path = out->ranked[i].path, begin = out->polygons.path_begin[path];
        points += path_sample_count(out->polygons.points + begin,
                                    out->polygons.path_begin[path + 1] - begin, step);
    }
    if (points > MAX_POINTS)
        return meso_fail(error, MESO_ERR_LIMIT, "a drawing needs over %d points; a larger section step would help",
                         MAX_POINTS);
    out->point_count = (uint32_t)points;
    return MESO_OK;
}

static MesoStatus clip_all(SectionContours *all, MesoArena *arena, const MesoTileSet *set, float step,
                           MesoError *error)
{
    uint32_t *nodes = MESO_NEW(arena, uint32_t, set->csg_count, error);
    uint32_t *step_of = MESO_NEW(arena, uint32_t, set->csg_count, error);
    if (!nodes || !step_of)
        return MESO_ERR_MEMORY;
    uint64_t points = 0;
    for (uint32_t s = 0; s < set->section_count; s++) {
        MesoStatus status = clip_section(&all[s], arena, set, s, step, nodes, step_of, error);
        if (status)
            return status;
        points += all[s].point_count;
    }
    if (points > UINT32_MAX / 4)
        return meso_fail(error, MESO_ERR_LIMIT, "drawings need %llu points; a larger section step would help",
                         (unsigned long long)points);
    return MESO_OK;
}

static MesoStatus allocate(MesoContourSet *contours, MesoArena *arena, const MesoTileSet *set,
                           const SectionContours *all, MesoError *error)
{
    uint32_t contour_count = 0, point_count = 0;
    for (uint32_t s = 0; s < set->section_count; s++) {
        contour_count += all[s].count;
        point_count += all[s].point_count;
    }
    *contours = (MesoContourSet){
        .section_begin = MESO_NEW(arena, uint32_t, (size_t)set->section_count + 1, error),
        .center = MESO_NEW(arena, MesoVec2, set->section_count, error),
        .contours = MESO_NEW(arena, MesoContour, contour_count, error),
        .points = MESO_NEW(arena, MesoVec2, point_count, error)};
    return contours->section_begin && contours->center && contours->contours && contours->points
               ? MESO_OK : MESO_ERR_MEMORY;
}

static void sample_section(MesoContourSet *contours, const SectionContours *in, MesoVec2 center, float step)
{
    for (uint32_t i = 0; i < in->count; i++) {
        uint32_t path = in->ranked[i].path, begin = in->polygons.path_begin[path];
        uint32_t n = in->polygons.path_begin[path + 1] - begin;
        const MesoIntPoint *p = in->polygons.points + begin;
        uint32_t samples = path_sample_count(p, n, step);
        sample_path(contours->points + contours->point_count, p, n, step, center);
        contours->contours[contours->contour_count++] =
            (MesoContour){contours->point_count, samples, in->ranked[i].area < 0};
        contours->point_count += samples;
    }
}

MesoStatus meso_contour_set_build(MesoContourSet *contours, MesoArena *arena,
                                  const MesoTileSet *set, float step, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    SectionContours *all = MESO_NEW(&scratch, SectionContours, set->section_count, error);
    MesoStatus status = all ? clip_all(all, &scratch, set, step, error) : MESO_ERR_MEMORY;
    if (!status)
        status = allocate(contours, arena, set, all, error);
    if (!status) {
        for (uint32_t s = 0; s < set->section_count; s++) {
            contours->section_begin[s] = contours->contour_count;
            contours->center[s] = csg_center(set, set->sections[s].csg_root);
            sample_section(contours, &all[s], contours->center[s], step);
        }
        contours->section_begin[set->section_count] = contours->contour_count;
    }
    meso_arena_release(&scratch);
    return status;
}
