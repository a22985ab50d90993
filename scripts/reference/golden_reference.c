/*
 * Compares our geometry with the golden data of the MesoGen prototype, from
 * its own assignment:
 *
 *     golden_reference GOLDEN.json TILES.json SURFACE.obj
 *
 * 1. contours: its sampled points against our outlines; 2e-4 of a side. The other
 *    way only 1e-3: on its grid of 1e-4 it drops points of narrow notches
 * 2. control points of every sweep in slots whose tile is not mirrored; 1e-4 of
 *    an edge (mirrored slots carry the prototype's defect 1)
 * 3. its mesh samples at their (u, v): our sweep, frames and alignment over its
 *    own contours, resampled so finely that their points do not matter; 1e-4 of an edge
 * 4. the same samples against the surface that we tessellate with its contours;
 *    our rings are aligned to whole points so that corners and neighbours agree,
 *    which turns a profile by up to half a point, that is one step: 1e-2 of an edge
 *
 * Slots in which a section turns are left out of 3 and 4: there the prototype pinches it. Bends are as drawn
 * (meso-map --bends drawn): its tubes fold back on themselves in narrow ones.
 *
 * Prints the largest deviation of each beside its bound; exit 0 if all hold.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_text.h"
#include "formats/mesh/surface_read.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/scene/parts.h"
#include "libcore/scene/sweep.h"
#include "libcore/tiling/strand/expansion.h"

/* Points of a finely resampled contour: half of one is 2e-5 of an edge for the longest. */
enum { FINE = 1 << 16 };

typedef struct Reference {
    MesoArena arena;
    json_t *golden;
    MesoModel model;
    MesoContourSet theirs;      /* contours of the golden data */
    double edge;
    bool same_set;              /* TILES.json is the golden data's own set */
    int failures;
} Reference;

typedef struct Expanded {
    MesoScene scene;
    MesoExpansion expansion;
} Expanded;

static void die(const MesoError *error)
{
    fprintf(stderr, "golden_reference: %s\n", error->message);
    exit(error->status);
}

static void report(Reference *r, const char *what, uint64_t count, double worst, double bound)
{
    bool good = count > 0 && worst <= bound;
    printf("  %-44s %7llu compared, worst %.2e (bound %.0e)%s\n", what, (unsigned long long)count, worst, bound,
           good ? "" : "  FAILED");
    r->failures += !good;
}

/* ---- loading ---- */

static double number_at(const json_t *array, size_t i)
{
    return json_number_value(json_array_get(array, i));
}

static MesoVec3 vector_at(const json_t *array, size_t i)
{
    const json_t *v = json_array_get(array, i);
    return (MesoVec3){(float)number_at(v, 0), (float)number_at(v, 1), (float)number_at(v, 2)};
}

static void load_assignment(Reference *r)
{
    const json_t *slots = json_object_get(r->golden, "slots");
    uint32_t count = (uint32_t)json_array_size(slots);
    MesoAssignment *a = &r->model.assignment;
    MesoError error;
    *a = (MesoAssignment){count, MESO_NEW(&r->arena, uint32_t, count, NULL),
                          MESO_NEW(&r->arena, MesoTransform, count, NULL)};
    for (uint32_t s = 0; s < count; s++) {
        const json_t *row = json_array_get(slots, s);   /* variant, tile, flip x, flip y, orientation, labels */
        a->tile[s] = (uint32_t)number_at(row, 1);
        a->transform[s] = meso_transform_make(number_at(row, 2) != 0, number_at(row, 3) != 0,
                                              (uint32_t)number_at(row, 4));
        for (uint32_t side = 0; side < 4; side++)
            if (meso_tile_label(&r->model.tile_set.tiles[a->tile[s]], a->transform[s], side) !=
                (int32_t)number_at(json_array_get(row, 5), side)) {
                meso_fail(&error, MESO_ERR_NO, "slot %u shows another label on side %u than the golden one", s, side);
                die(&error);
            }
    }
    if (meso_slot_graph_build(&r->model.graph, &r->arena, &r->model.surface, &error) ||
        meso_assignment_check(a, &r->model.tile_set, &r->model.graph, &error))
        die(&error);
}

/* Our contour set with the golden points in it, relative to our centres. */
static void load_contours(Reference *r)
{
    const MesoTileSet *set = &r->model.tile_set;
    const json_t *interfaces = json_object_get(r->golden, "contours");
    MesoContourSet *c = &r->theirs;
    uint32_t capacity = 1 << 20;
    *c = (MesoContourSet){.section_begin = MESO_NEW(&r->arena, uint32_t, set->section_count + 1, NULL),
                          .center = MESO_NEW(&r->arena, MesoVec2, set->section_count, NULL),
                          .contours = MESO_NEW(&r->arena, MesoContour, set->section_count, NULL),
                          .points = MESO_NEW(&r->arena, MesoVec2, capacity, NULL)};
    for (uint32_t s = 0; s < set->section_count; s++) {
        uint32_t interface = set->sections[s].interface;
        const json_t *shape = json_array_get(json_object_get(json_array_get(interfaces, interface), "shapes"),
                                             s - set->interfaces[interface].section_begin);
        const json_t *points = json_object_get(shape, "points"), *center = json_object_get(shape, "center");
        c->section_begin[s] = c->contour_count;
        c->center[s] = (MesoVec2){(float)number_at(center, 0), (float)number_at(center, 1)};
        uint32_t count = (uint32_t)json_array_size(points);
        c->contours[c->contour_count++] = (MesoContour){c->point_count, count, false};
        for (uint32_t i = 0; i < count && c->point_count < capacity; i++) {
            const json_t *p = json_array_get(points, i);
            c->points[c->point_count++] = (MesoVec2){(float)number_at(p, 0) - c->center[s].x,
                                                     (float)number_at(p, 1) - 0.5f * c->center[s].y};
        }
    }
    c->section_begin[set->section_count] = c->contour_count;
}

static void load(Reference *r, char **argv)
{
    MesoInput golden, tiles, surface;
    MesoQuadSurface quads;
    MesoError error;
    meso_arena_init(&r->arena);
    if (meso_input_open(&golden, argv[1], &error) || meso_json_parse(&r->golden, &golden, &error) ||
        meso_input_open(&tiles, argv[2], &error) ||
        meso_tiles_read(&r->model.tile_set, &r->arena, &tiles, &error) ||
        meso_input_open(&surface, argv[3], &error) ||
        meso_quad_surface_read(&quads, &r->arena, &surface, 0, &error))
        die(&error);
    r->model.surface = quads.mesh;
    meso_input_close(&golden);
    meso_input_close(&tiles);
    meso_input_close(&surface);

    const json_t *options = json_object_get(r->golden, "options");
    r->edge = json_number_value(json_object_get(options, "thickness"));
    r->model.options = (MesoMapOptions){.bends = MESO_BENDS_DRAWN,
        .thickness = (float)r->edge,
        .offset = (float)json_number_value(json_object_get(options, "offset")),
        .section_scale = (float)json_number_value(json_object_get(options, "profileScale")),
        .tangent_scale = (float)json_number_value(json_object_get(options, "tangentMultiplier")),
        .section_step = (float)json_number_value(json_object_get(r->golden, "max_segment")),
        .divisions = (uint32_t)json_number_value(json_object_get(options, "sweepDivisions"))};
    r->model.inner_meshes = MESO_NEW(&r->arena, MesoTriangleMesh, r->model.tile_set.inner_count, NULL);
    const char *name = strrchr(argv[2], '/');
    const char *golden_name = json_string_value(json_object_get(r->golden, "tileset"));
    r->same_set = golden_name && strcmp(name ? name + 1 : argv[2], golden_name) == 0;
    load_assignment(r);
    load_contours(r);
}

/* ---- 1. contours ---- */

static double distance_to_segment(MesoVec2 p, MesoVec2 a, MesoVec2 b)
{
    double dx = (double)(b.x - a.x), dy = (double)(b.y - a.y), l = dx * dx + dy * dy;
    double t = l > 0 ? ((double)(p.x - a.x) * dx + (double)(p.y - a.y) * dy) / l : 0;
    t = fmax(0, fmin(1, t));
    return hypot((double)(p.x - a.x) - t * dx, (double)(p.y - a.y) - t * dy);
}

/* Furthest point of one section's contours from another's polygons; all loops count. */
static double one_way(const MesoContourSet *from, const MesoContourSet *to, uint32_t section, uint64_t *count)
{
    double worst = 0;
    for (uint32_t c = from->section_begin[section]; c < from->section_begin[section + 1]; c++)
        for (uint32_t i = 0; i < from->contours[c].point_count; i++, ++*count) {
            double best = INFINITY;
            MesoVec2 p = from->points[from->contours[c].point_begin + i];
            for (uint32_t d = to->section_begin[section]; d < to->section_begin[section + 1]; d++)
                for (uint32_t k = 0; k < to->contours[d].point_count; k++) {
                    const MesoVec2 *q = to->points + to->contours[d].point_begin;
                    best = fmin(best, distance_to_segment(p, q[k], q[(k + 1) % to->contours[d].point_count]));
                }
            worst = fmax(worst, best);
        }
    return worst;
}

static void compare_contours(Reference *r)
{
    MesoContourSet ours;
    MesoError error;
    uint64_t count = 0, reverse_count = 0, same = 0;
    double to_ours = 0, to_theirs = 0, centers = 0;
    if (meso_contour_set_build(&ours, &r->arena, &r->model.tile_set, r->model.options.section_step, &error))
        die(&error);
    for (uint32_t s = 0; s < r->model.tile_set.section_count; s++) {
        to_ours = fmax(to_ours, one_way(&r->theirs, &ours, s, &count));
        to_theirs = fmax(to_theirs, one_way(&ours, &r->theirs, s, &reverse_count));
        centers = fmax(centers, (double)meso_vec2_length(meso_vec2_sub(ours.center[s], r->theirs.center[s])));
        same += ours.contours[ours.section_begin[s]].point_count == r->theirs.contours[s].point_count;
    }
    report(r, "contours: golden points to ours", count, to_ours, 2e-4);
    report(r, "contours: our points to golden", reverse_count, to_theirs, 1e-3);
    if (r->same_set)
        report(r, "centres of cross-sections", r->model.tile_set.section_count, centers, 2e-4);
    else
        printf("  the golden tile set is '%s', another one: centres are not compared\n",
               json_string_value(json_object_get(r->golden, "tileset")));
    printf("  %-44s %7llu of %u\n", "contours with the same number of points", (unsigned long long)same,
           r->model.tile_set.section_count);
}

/* ---- 2. control points ---- */

/* Golden sweeps number the sweeps of a tile; caps and mirrored slots are left out. */
static bool is_comparable(const Reference *r, const json_t *sweep, uint32_t *slot, uint32_t *sweep_index)
{
    *slot = (uint32_t)number_at(sweep, 0);
    const MesoTile *tile = &r->model.tile_set.tiles[r->model.assignment.tile[*slot]];
    uint32_t path = (uint32_t)number_at(sweep, 1);
    *sweep_index = tile->sweep_begin + path;
    return path < tile->sweep_count && !json_is_null(json_array_get(sweep, 6)) &&
           !meso_transform_flips(r->model.assignment.transform[*slot]);
}

static const MesoSweepInstance *find_instance(const Expanded *e, uint32_t slot, uint32_t sweep)
{
    for (uint32_t k = 0; k < e->scene.kind_count; k++) {
        const MesoSweepInstance *instances = &e->scene.sweeps[e->scene.kinds[k].instance_begin];
        if (e->expansion.origins[k].sweep == sweep)
            for (uint32_t i = 0; i < e->scene.kinds[k].instance_count; i++)
                if (instances[i].ids == slot)
                    return &instances[i];
    }
    return NULL;
}

static double apart(MesoVec3 a, MesoVec3 b)
{
    return (double)meso_vec3_length(meso_vec3_sub(a, b));
}

static void compare_controls(Reference *r, const Expanded *expanded)
{
    const json_t *sweeps = json_object_get(r->golden, "sweeps");
    double worst = 0;
    uint64_t count = 0;
    for (size_t i = 0; i < json_array_size(sweeps); i++) {
        const json_t *sweep = json_array_get(sweeps, i);
        uint32_t slot, index;
        if (!is_comparable(r, sweep, &slot, &index))
            continue;
        const MesoSweepInstance *ours = find_instance(expanded, slot, index);
        MesoVec3 p0 = vector_at(sweep, 3), p3 = vector_at(sweep, 6);
        MesoVec3 golden[4] = {p0, meso_vec3_add(p0, vector_at(sweep, 4)),
                              meso_vec3_add(p3, vector_at(sweep, 5)), p3};
        for (int k = 0; k < 4; k++)
            worst = fmax(worst, ours ? apart(ours->p[k], golden[k]) / r->edge : INFINITY);
        count++;
    }
    report(r, "control points of unmirrored sweeps", count, worst, 1e-4);
}

/* ---- 3. samples at their parameters ---- */

/* A repeating linear texture: the middle of point i lies at (i + 1/2) / n. */
static MesoVec2 sample_contour(const MesoContourSet *set, uint32_t section, double u)
{
    const MesoContour *c = &set->contours[set->section_begin[section]];
    double x = (u - floor(u)) * c->point_count - 0.5, i = floor(x);
    uint32_t a = (uint32_t)((int64_t)i + c->point_count) % c->point_count;
    return meso_vec2_lerp(set->points[c->point_begin + a],
                          set->points[c->point_begin + (a + 1) % c->point_count], (float)(x - i));
}

/* Its contours again, each of FINE points spread as its texture spreads them: the steps of our alignment vanish. */
static MesoContourSet refine(Reference *r)
{
    uint32_t sections = r->model.tile_set.section_count;
    MesoContourSet fine = r->theirs;
    fine.section_begin = MESO_NEW(&r->arena, uint32_t, sections + 1, NULL);
    fine.contours = MESO_NEW(&r->arena, MesoContour, sections, NULL);
    fine.points = MESO_NEW(&r->arena, MesoVec2, (size_t)sections * FINE, NULL);
    fine.contour_count = fine.point_count = 0;
    for (uint32_t s = 0; s < sections; s++) {
        fine.section_begin[s] = fine.contour_count;
        fine.contours[fine.contour_count++] = (MesoContour){fine.point_count, FINE, false};
        for (uint32_t i = 0; i < FINE; i++)
            fine.points[fine.point_count++] = sample_contour(&r->theirs, s, (i + 0.5) / FINE);
    }
    fine.section_begin[sections] = fine.contour_count;
    return fine;
}

/* The column of our own at u around. Columns are in the order of u. */
static const MesoSweepColumn *column_at(const MesoScene *s, const MesoSweptKind *kind, double u)
{
    const MesoSweepColumn *columns = s->columns + kind->column_begin;
    double wanted = u - 0.5 / FINE;
    uint32_t low = 0, high = kind->column_count - 1;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if ((double)columns[middle].u <= wanted)
            low = middle;
        else
            high = middle;
    }
    return &columns[wanted - (double)columns[low].u < (double)columns[high].u - wanted ? low : high];
}

static double compare_at_parameters(const Reference *r, const Expanded *expanded, const json_t *sample)
{
    uint32_t slot = (uint32_t)number_at(sample, 0);
    const MesoTile *tile = &r->model.tile_set.tiles[r->model.assignment.tile[slot]];
    MesoVec3 golden = {(float)number_at(sample, 1), (float)number_at(sample, 2), (float)number_at(sample, 3)};
    double best = INFINITY;
    for (uint32_t i = 0; i < tile->sweep_count; i++) {
        const MesoSweepInstance *instance = find_instance(expanded, slot, tile->sweep_begin + i);
        float v = (float)number_at(sample, 8);
        if (!instance)
            continue;
        const MesoScene *s = &expanded->scene;
        const MesoSweptKind *kind = &s->kinds[meso_scene_kind(s, (uint32_t)(instance - s->sweeps))];
        const MesoSweepColumn *column = column_at(s, kind, number_at(sample, 7));
        best = fmin(best, apart(meso_sweep_point(s, kind, instance, column, v), golden));
    }
    return best / r->edge;
}

/* ---- 4. samples against the tessellation ---- */

static double distance_to_triangle(MesoVec3 p, MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    MesoVec3 ab = meso_vec3_sub(b, a), ac = meso_vec3_sub(c, a), n = meso_vec3_cross(ab, ac);
    double nn = (double)meso_vec3_dot(n, n);
    MesoVec3 ap = meso_vec3_sub(p, a);
    if (nn > 0) {
        double w = (double)meso_vec3_dot(meso_vec3_cross(ab, ap), n) / nn;
        double v = (double)meso_vec3_dot(meso_vec3_cross(ap, ac), n) / nn;
        if (v >= 0 && w >= 0 && v + w <= 1)
            return fabs((double)meso_vec3_dot(ap, n)) / sqrt(nn);
    }
    MesoVec3 ends[3][2] = {{a, b}, {b, c}, {c, a}};
    double best = INFINITY;
    for (int k = 0; k < 3; k++) {
        MesoVec3 d = meso_vec3_sub(ends[k][1], ends[k][0]), q = meso_vec3_sub(p, ends[k][0]);
        float l = meso_vec3_dot(d, d), t = l > 0 ? fmaxf(0, fminf(1, meso_vec3_dot(q, d) / l)) : 0;
        best = fmin(best, (double)meso_vec3_length(meso_vec3_mad(q, -t, d)));
    }
    return best;
}

typedef struct Window {
    MesoMeshVertex *vertices;
    MesoMeshFace *faces;
} Window;

static double compare_with_mesh(const Reference *r, const MesoSceneParts *t, Window *w, const json_t *sample)
{
    uint32_t slot = (uint32_t)number_at(sample, 0);
    MesoVec3 p = {(float)number_at(sample, 1), (float)number_at(sample, 2), (float)number_at(sample, 3)};
    double best = INFINITY;
    for (uint32_t part = 0; part < t->scene->sweep_count; part++) {
        if (t->scene->sweeps[part].ids != slot)
            continue;
        meso_scene_vertices(t, part, part + 1, w->vertices);
        meso_scene_faces(t, part, part + 1, 0, w->faces);
        for (uint64_t f = 0; f < t->face_begin[part + 1] - t->face_begin[part]; f++) {
            const uint32_t *v = w->faces[f].v;
            for (int k = 2; k < 4 && v[k] != MESO_NO_INDEX; k++)
                best = fmin(best, distance_to_triangle(p, w->vertices[v[0]].position,
                                                       w->vertices[v[k - 1]].position,
                                                       w->vertices[v[k]].position));
        }
    }
    return best / r->edge;
}

/* The prototype blends from point to point where we turn the section: that slot cannot be compared. */
static bool turns_in(const Expanded *e, uint32_t slot)
{
    const MesoScene *s = &e->scene;
    for (uint32_t k = 0; k < s->kind_count; k++)
        for (uint32_t i = 0; s->kinds[k].turn != 0 && i < s->kinds[k].instance_count; i++)
            if (s->sweeps[s->kinds[k].instance_begin + i].ids == slot)
                return true;
    return false;
}

static void compare_samples(Reference *r, const Expanded *expanded, const Expanded *fine)
{
    const json_t *samples = json_object_get(r->golden, "samples");
    double at_parameters = 0, with_mesh = 0;
    uint64_t count = 0, close = 0, turning = 0;
    MesoSceneParts t;
    MesoError error;
    if (meso_scene_parts_init(&t, &r->arena, &expanded->scene, &error))
        die(&error);
    uint64_t most_vertices = 0, most_faces = 0;
    for (uint32_t part = 0; part < t.part_count; part++) {
        most_vertices = t.vertex_begin[part + 1] - t.vertex_begin[part] > most_vertices
                            ? t.vertex_begin[part + 1] - t.vertex_begin[part] : most_vertices;
        most_faces = t.face_begin[part + 1] - t.face_begin[part] > most_faces
                         ? t.face_begin[part + 1] - t.face_begin[part] : most_faces;
    }
    Window window = {MESO_NEW(&r->arena, MesoMeshVertex, most_vertices, NULL),
                     MESO_NEW(&r->arena, MesoMeshFace, most_faces, NULL)};
    for (size_t i = 0; i < json_array_size(samples); i++) {
        const json_t *sample = json_array_get(samples, i);
        if (meso_transform_flips(r->model.assignment.transform[(uint32_t)number_at(sample, 0)]))
            continue;
        if (turns_in(fine, (uint32_t)number_at(sample, 0))) {
            turning++;
            continue;
        }
        at_parameters = fmax(at_parameters, compare_at_parameters(r, fine, sample));
        double distance = compare_with_mesh(r, &t, &window, sample);
        with_mesh = fmax(with_mesh, distance);
        close += distance <= 1e-4;
        count++;
    }
    report(r, "mesh samples at their (u, v)", count, at_parameters, 1e-4);
    report(r, "mesh samples to our tessellated surface", count, with_mesh, 1e-2);
    printf("  %-44s %7llu of %llu\n", "of these within 1e-4", (unsigned long long)close, (unsigned long long)count);
    printf("  %-44s %7llu\n", "left out, in slots with sections that turn", (unsigned long long)turning);
}

int main(int argc, char **argv)
{
    if (argc != 4) {
        fprintf(stderr, "usage: golden_reference GOLDEN.json TILES.json SURFACE.obj\n");
        return MESO_ERR_USAGE;
    }
    Reference r = {0};
    load(&r, argv);
    printf("%s: %u slots\n", argv[1], r.model.assignment.slot_count);
    compare_contours(&r);

    Expanded expanded, fine_expanded;
    MesoError error;
    MesoContourSet fine = refine(&r);
    if (meso_model_expand_over(&expanded.scene, &expanded.expansion, &r.arena, &r.model, &r.theirs, 0, &error) ||
        meso_model_expand_over(&fine_expanded.scene, &fine_expanded.expansion, &r.arena, &r.model, &fine, 0, &error))
        die(&error);
    compare_controls(&r, &expanded);
    compare_samples(&r, &expanded, &fine_expanded);
    json_decref(r.golden);
    meso_arena_release(&r.arena);
    return r.failures ? MESO_ERR_NO : MESO_OK;
}
