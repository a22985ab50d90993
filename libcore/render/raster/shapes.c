#include "libcore/render/raster/shapes.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/sweep.h"

/* ---- sweeps ---- */

static MesoStatus measure_kinds(MesoShapes *shapes, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = shapes->scene;
    shapes->details = MESO_NEW(arena, MesoKindDetail, scene->kind_count, error);
    shapes->scales = MESO_NEW(arena, float, scene->kind_count, error);
    shapes->columns = MESO_NEW(arena, MesoShapeColumns,
                               (size_t)scene->kind_count * MESO_SHAPE_LEVELS * MESO_SHAPE_USES, error);
    if (!shapes->details || !shapes->scales || !shapes->columns)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < scene->kind_count; k++) {
        shapes->details[k] = meso_kind_detail(scene, &scene->kinds[k]);
        shapes->scales[k] = scene->section_scale * meso_scene_kind_size(scene, &scene->kinds[k]) *
                            shapes->details[k].stretch.most;
    }
    return MESO_OK;
}

MesoStatus meso_shapes_ready(MesoShapes *shapes, MesoArena *arena, MesoShapeUse use, float low, float high,
                             MesoError *error)
{
    const MesoLevelRange range = {use, low, high, shapes->finest};
    return meso_shape_levels(shapes->columns, arena, shapes->scene, shapes->scales, &range, error);
}

/* ---- bodies ---- */

static MesoStatus make_runs(MesoShapes *shapes, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = shapes->scene;
    uint64_t count = 0;
    for (uint32_t i = 0; i < scene->placed_count; i++)
        count += ((uint64_t)scene->bodies[scene->placed[i].body].face_count + MESO_SHAPE_FACES - 1) / MESO_SHAPE_FACES;
    if (count + scene->sweep_count > UINT32_MAX - 1)
        return meso_fail(error, MESO_ERR_LIMIT, "the scene has too many parts to draw");
    shapes->count = scene->sweep_count + (uint32_t)count;
    shapes->runs = MESO_NEW(arena, MesoShapeRun, count, error);
    if (!shapes->runs)
        return MESO_ERR_MEMORY;
    uint32_t next = 0;
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        uint32_t faces = scene->bodies[scene->placed[i].body].face_count;
        for (uint32_t f = 0; f < faces; f += MESO_SHAPE_FACES)
            shapes->runs[next++] = (MesoShapeRun){
                .placed = i, .face_begin = f,
                .face_count = faces - f < MESO_SHAPE_FACES ? faces - f : MESO_SHAPE_FACES};
    }
    return MESO_OK;
}

/* ---- bounds ---- */

static const uint32_t *face_of(const MesoBody *body, uint32_t face, uint32_t *sides)
{
    const uint32_t *v = body->corners + (size_t)body->face_width * face;
    *sides = body->face_width == 4 && v[3] != MESO_NO_INDEX ? 4 : 3;
    return v;
}

static MesoBox run_box(const MesoShapes *shapes, const MesoShapeRun *run)
{
    const MesoBody *body = &shapes->scene->bodies[shapes->scene->placed[run->placed].body];
    MesoBox box = meso_box_empty();
    for (uint32_t f = run->face_begin; f < run->face_begin + run->face_count; f++) {
        uint32_t sides;
        const uint32_t *v = face_of(body, f, &sides);
        for (uint32_t k = 0; k < sides; k++)
            meso_box_add(&box, meso_vec3_sub(shapes->bodies.positions[run->placed][v[k]], shapes->anchor));
    }
    return box;
}

/* How far from the hull of the trajectory a sweep lies at most. */
static float sweep_reach(const MesoShapes *shapes, uint32_t kind, const MesoSweepInstance *sweep)
{
    const MesoKindDetail *detail = &shapes->details[kind];
    float rise = MESO_CAP_RISE * shapes->scene->section_scale * sweep->size[0];
    float radius = detail->radius / detail->stretch.most;
    return radius > rise ? radius : rise;
}

static MesoBox sweep_box(const MesoShapes *shapes, uint32_t kind, const MesoSweepInstance *sweep)
{
    MesoBox box = meso_box_empty();
    float reach = sweep_reach(shapes, kind, sweep);
    for (uint32_t k = 0; k < 4 && shapes->scene->deform == MESO_SWEEP_CURVES; k++)
        meso_box_add(&box, meso_vec3_sub(sweep->p[k], shapes->anchor));
    if (shapes->scene->deform == MESO_SWEEP_CURVES)
        return meso_box_wider(box, reach);
    MesoSweepHull hull = meso_sweep_hull(shapes->scene, sweep, reach);
    for (uint32_t k = 0; k < hull.count; k++)
        meso_box_add(&box, meso_vec3_sub(hull.points[k], shapes->anchor));
    return meso_box_wider(box, hull.reach);
}

static uint32_t kind_of(const MesoShapes *shapes, uint32_t sweep)
{
    return shapes->kind_of ? shapes->kind_of[sweep] : meso_scene_kind(shapes->scene, sweep);
}

MesoBox meso_shape_bounds(const MesoShapes *shapes, uint32_t shape)
{
    if (shape >= shapes->made)
        return shapes->bounds[shape - shapes->made];
    MesoSweepInstance sweep = meso_scene_sweep(shapes->scene, shape);
    return sweep_box(shapes, kind_of(shapes, shape), &sweep);
}

static MesoSweepInstance anchored(const MesoShapes *shapes, MesoSweepInstance instance)
{
    for (uint32_t i = 0; i < 4 && shapes->scene->deform == MESO_SWEEP_CURVES; i++)
        instance.p[i] = meso_vec3_sub(instance.p[i], shapes->anchor);
    return instance;
}

static void bound_sweep(MesoShapes *shapes, uint32_t sweep)
{
    uint32_t k = shapes->kind_of[sweep];
    const MesoSweepInstance *given = &shapes->scene->sweeps[sweep], instance = anchored(shapes, *given);
    shapes->bounds[sweep] = sweep_box(shapes, k, given);
    shapes->bends[sweep] = meso_detail_bend(&shapes->scene->kinds[k], &shapes->details[k], &instance);
}

static void bound(void *context, uint64_t begin, uint64_t end)
{
    MesoShapes *shapes = context;
    uint32_t sweeps = shapes->scene->sweep_count;
    for (uint64_t i = shapes->made + begin; i < shapes->made + end; i++)
        if (i < sweeps)
            bound_sweep(shapes, (uint32_t)i);
        else
            shapes->bounds[i - shapes->made] = run_box(shapes, &shapes->runs[i - sweeps]);
}

static MesoStatus bound_all(MesoShapes *shapes, MesoArena *arena, uint32_t thread_count, MesoError *error)
{
    const MesoScene *scene = shapes->scene;
    uint32_t stored = shapes->count - shapes->made;
    if (!shapes->made) {
        shapes->kind_of = MESO_NEW(arena, uint32_t, scene->sweep_count, error);
        shapes->bends = MESO_NEW(arena, MesoSweepBend, scene->sweep_count, error);
    }
    shapes->bounds = MESO_NEW(arena, MesoBox, stored, error);
    if ((!shapes->made && (!shapes->kind_of || !shapes->bends)) || !shapes->bounds)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < scene->kind_count && !shapes->made; k++)
        for (uint32_t i = 0; i < scene->kinds[k].instance_count; i++)
            shapes->kind_of[scene->kinds[k].instance_begin + i] = k;
    meso_parallel_for(thread_count, stored, 1024, bound, shapes);
    return MESO_OK;
}

/* ---- bundles ---- */

static uint32_t made_bundles(const MesoShapes *shapes)
{
    return shapes->made ? shapes->scene->maker->bundle_count : 0;
}

void meso_shape_bundle(const MesoShapes *shapes, uint32_t bundle, MesoShapeBundle *out)
{
    const MesoSweepMaker *maker = shapes->scene->maker;
    uint32_t made = made_bundles(shapes);
    out->made = bundle < made;
    if (out->made) {
        out->count = maker->make_hulls(maker->context, bundle, out->sweeps);
        for (uint32_t i = 0; i < out->count; i++) {
            out->shapes[i] = out->sweeps[i].sweep;
            out->bounds[i] = sweep_box(shapes, out->sweeps[i].kind, &out->sweeps[i].instance);
        }
        return;
    }
    uint32_t first = shapes->made + (bundle - made) * MESO_SHAPE_BUNDLE, left = shapes->count - first;
    out->count = left < MESO_SHAPE_BUNDLE ? left : MESO_SHAPE_BUNDLE;
    for (uint32_t i = 0; i < out->count; i++) {
        out->shapes[i] = first + i;
        out->bounds[i] = shapes->bounds[first + i - shapes->made];
    }
}

MesoRasterRect meso_shape_rect(const MesoShapes *shapes, const MesoShapeBundle *bundle, uint32_t i,
                               const MesoRasterView *view)
{
    const MesoMadeSweep *made = &bundle->sweeps[i];
    MesoVec3 points[4];
    if (!bundle->made)
        return meso_raster_rect(view, &bundle->bounds[i]);
    for (uint32_t k = 0; k < 4; k++)
        points[k] = meso_vec3_sub(made->instance.p[k], shapes->anchor);
    return meso_raster_rect_around(view, points, 4, sweep_reach(shapes, made->kind, &made->instance));
}

/* Around what bundles of sweeps are known to lie in, and others are. */
static MesoBox bundle_box(const MesoShapes *shapes, uint32_t b)
{
    MesoBox box = meso_box_empty();
    uint32_t made = made_bundles(shapes);
    if (b < made) {
        box = meso_scene_bundle_box(shapes->scene, b);
        return (MesoBox){meso_vec3_sub(box.low, shapes->anchor), meso_vec3_sub(box.high, shapes->anchor)};
    }
    uint32_t first = (b - made) * MESO_SHAPE_BUNDLE, left = shapes->count - shapes->made - first;
    for (uint32_t i = 0; i < MESO_SHAPE_BUNDLE && i < left; i++)
        meso_box_join(&box, &shapes->bounds[first + i]);
    return box;
}

static MesoStatus make_bundles(MesoShapes *shapes, MesoArena *arena, MesoError *error)
{
    uint32_t made = made_bundles(shapes);
    uint64_t count = made + ((uint64_t)shapes->count - shapes->made + MESO_SHAPE_BUNDLE - 1) / MESO_SHAPE_BUNDLE;
    if (count > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "the scene has too many parts to draw");
    shapes->bundle_count = (uint32_t)count;
    if (!shapes->made)
        return MESO_OK;
    shapes->bundle_bounds = MESO_NEW(arena, MesoBox, count, error);
    if (!shapes->bundle_bounds)
        return MESO_ERR_MEMORY;
    for (uint32_t b = 0; b < shapes->bundle_count; b++)
        shapes->bundle_bounds[b] = bundle_box(shapes, b);
    return MESO_OK;
}

static void join_bundle(MesoBox *box, const MesoShapes *shapes, uint32_t b)
{
    MesoShapeBundle bundle;
    meso_shape_bundle(shapes, b, &bundle);
    for (uint32_t i = 0; i < bundle.count; i++)
        meso_box_join(box, &bundle.bounds[i]);
}

/* Of those that are not made, and of few others: those that may reach farthest, and then those that may stick out. */
MesoBox meso_shapes_box(const MesoShapes *shapes)
{
    MesoBox box = meso_box_empty();
    uint32_t made = made_bundles(shapes), farthest[6] = {0};
    const MesoBox *b = shapes->bundle_bounds;
    for (uint32_t i = 0; i < shapes->count - shapes->made; i++)
        meso_box_join(&box, &shapes->bounds[i]);
    for (uint32_t i = 0; i < made; i++) {
        if (!(b[i].low.x <= b[i].high.x))       /* of nothing */
            continue;
        farthest[0] = b[i].low.x < b[farthest[0]].low.x ? i : farthest[0];
        farthest[1] = b[i].low.y < b[farthest[1]].low.y ? i : farthest[1];
        farthest[2] = b[i].low.z < b[farthest[2]].low.z ? i : farthest[2];
        farthest[3] = b[i].high.x > b[farthest[3]].high.x ? i : farthest[3];
        farthest[4] = b[i].high.y > b[farthest[4]].high.y ? i : farthest[4];
        farthest[5] = b[i].high.z > b[farthest[5]].high.z ? i : farthest[5];
    }
    for (uint32_t k = 0; k < 6 && made > 0; k++)
        join_bundle(&box, shapes, farthest[k]);
    for (uint32_t i = 0; i < made; i++)
        if (b[i].low.x <= b[i].high.x && meso_box_sticks_out(&b[i], &box))
            join_bundle(&box, shapes, i);
    return box;
}

MesoStatus meso_shapes_begin(MesoShapes *shapes, MesoArena *arena, const MesoScene *scene, MesoVec3 anchor,
                             uint32_t thread_count, MesoError *error)
{
    float size = meso_vec3_length(meso_vec3_sub(scene->box.high, scene->box.low));
    *shapes = (MesoShapes){.scene = scene, .near = *scene, .anchor = anchor, .finest = 1e-6f * size,
                            .made = scene->maker ? scene->sweep_count : 0};
    MesoStatus status = make_runs(shapes, arena, error);
    if (!status && scene->deform == MESO_SWEEP_SHAPE) {
        shapes->near.cages = meso_cages_from(scene, anchor, arena, error);
        status = shapes->near.cages ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (!status)
        status = meso_shape_bodies(&shapes->bodies, arena, scene, thread_count, error);
    if (!status)
        status = measure_kinds(shapes, arena, error);
    if (!status)
        status = bound_all(shapes, arena, thread_count, error);
    return status ? status : make_bundles(shapes, arena, error);
}

MesoStatus meso_shapes_init(MesoShapes *shapes, MesoArena *arena, const MesoScene *scene, MesoVec3 anchor,
                            uint32_t thread_count, MesoError *error)
{
    MesoStatus status = meso_shapes_begin(shapes, arena, scene, anchor, thread_count, error);
    for (int use = 0; use < MESO_SHAPE_USES && !status; use++)
        status = meso_shapes_ready(shapes, arena, (MesoShapeUse)use, 0, INFINITY, error);
    return status;
}

/* ---- meshes ---- */

static bool grow(void **array, size_t count, size_t size)
{
    void *grown = realloc(*array, (count ? count : 1) * size);
    if (grown)
        *array = grown;
    return grown != NULL;
}

static bool make_room(MesoShapeMesh *mesh, uint64_t vertices, uint64_t triangles)
{
    if (vertices > UINT32_MAX / 2 || triangles > UINT32_MAX / 2)
        return false;
    if (vertices > mesh->vertex_room) {
        if (!grow((void **)&mesh->vertices, 2 * vertices, sizeof *mesh->vertices) ||
            !grow((void **)&mesh->color_room, 2 * vertices, sizeof *mesh->color_room) ||
            !grow((void **)&mesh->wanted, 2 * vertices, sizeof *mesh->wanted))
            return false;
        mesh->vertex_room = 2 * (uint32_t)vertices;
    }
    mesh->vertex_count = (uint32_t)vertices;
    mesh->triangle_count = (uint32_t)triangles;
    mesh->colors = NULL;
    return true;
}

void meso_shape_mesh_release(MesoShapeMesh *mesh)
{
    free(mesh->vertices);
    free(mesh->color_room);
    free(mesh->wanted);
    free(mesh->run_corners);
    free(mesh->points);
    for (uint32_t i = 0; i < MESO_SHAPE_CORNERS; i++)
        free(mesh->sets[i].corners);
    *mesh = (MesoShapeMesh){0};
}

static void put_corners(const MesoShapeColumns *columns, uint32_t begin, uint32_t end, uint32_t *out)
{
    for (uint32_t r = begin; r < end; r++)
        for (uint32_t j = 0; j < columns->side_count; j++, out += 6) {
            uint32_t here = r * columns->count, ahead = here + columns->count;
            MesoColumnSide side = columns->sides[j];
            const uint32_t quad[6] = {here + side.from, ahead + side.from, ahead + side.to,
                                      here + side.from, ahead + side.to, here + side.to};
            memcpy(out, quad, sizeof quad);
        }
}

/* Sweeps of few kinds follow one another: their corners are the same. */
static bool make_corners(const MesoShapes *shapes, const MesoShapeColumns *columns, uint32_t rings, MesoShapeMesh *mesh)
{
    MesoShapeCorners *set = &mesh->sets[(size_t)(columns - shapes->columns) % MESO_SHAPE_CORNERS];
    uint64_t sides = columns->side_count, quads = sides * (rings - 1);
    if (quads > UINT32_MAX / 2)
        return false;
    if (quads > set->quad_room) {
        if (!grow((void **)&set->corners, 2 * quads, 6 * sizeof *set->corners))
            return false;
        set->quad_room = 2 * (uint32_t)quads;
    }
    uint32_t first = set->columns == columns ? set->ring_count : 1;
    if (rings > first)
        put_corners(columns, first - 1, rings - 1, set->corners + 6 * sides * (first - 1));
    set->columns = columns;
    set->ring_count = rings > first ? rings : first;
    mesh->corners = set->corners;
    return true;
}

/* Vertices of triangles that have been seen. */
static void find_wanted(MesoShapeMesh *mesh, const uint8_t *seen)
{
    memset(mesh->wanted, 0, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (uint32_t k = 0; seen[t] && k < 3; k++)
            mesh->wanted[mesh->corners[3 * (size_t)t + k]] = 1;
}

/* How a sweep is wanted. */
typedef struct Wanted {
    float tolerance;
    MesoShapeUse use;
    const uint8_t *seen;        /* triangles; NULL: all */
    bool placed;
} Wanted;

static bool place_sweep(const MesoShapes *shapes, const MesoSweptKind *kind, const MesoSweepInstance *instance,
                        MesoShapeMesh *mesh)
{
    const MesoSweepPlaces *places = &mesh->columns->on_ring;
    uint64_t count = (uint64_t)places->count * mesh->ring_count + MESO_SWEEP_LANES;
    if (count > UINT32_MAX / 2)
        return false;
    if (count > mesh->point_room) {
        if (!grow((void **)&mesh->points, 3 * (2 * count), sizeof *mesh->points))
            return false;
        mesh->point_room = 2 * (uint32_t)count;
    }
    float *x = mesh->points, *y = x + mesh->point_room, *z = y + mesh->point_room;
    meso_sweep_points(&shapes->near, kind, instance, places, mesh->ring_count, x, y, z);
    return true;
}

static bool make_sweep(const MesoShapes *shapes, uint32_t number, uint32_t k, const MesoSweepInstance *sweep,
                       const Wanted *wanted, MesoShapeMesh *mesh)
{
    const MesoScene *scene = &shapes->near;
    const MesoSweptKind *kind = &scene->kinds[k];
    float tolerance = wanted->tolerance;
    const MesoShapeColumns *columns = meso_shape_level(shapes->columns, shapes->finest, k, tolerance, wanted->use);
    MesoSweepInstance instance = anchored(shapes, *sweep);
    MesoSweepBend bend = shapes->bends ? shapes->bends[number] : meso_detail_bend(kind, &shapes->details[k], &instance);
    bool seen = wanted->use != MESO_SHAPE_SHADOW;
    uint32_t rings = meso_detail_bend_rings(kind, &shapes->details[k], bend, tolerance, seen);
    if (!make_room(mesh, (uint64_t)columns->count * rings, 2 * (uint64_t)columns->side_count * (rings - 1)))
        return false;
    mesh->closed = columns->closed;
    mesh->reach = columns->reach;
    mesh->columns = columns;
    mesh->ring_count = rings;
    mesh->placed = wanted->placed && scene->deform == MESO_SWEEP_CURVES;
    if (mesh->placed)
        return place_sweep(shapes, kind, &instance, mesh);
    if (!make_corners(shapes, columns, rings, mesh))
        return false;
    if (wanted->seen)
        find_wanted(mesh, wanted->seen);
    const MesoSweepGrid grid = {.columns = columns->kept, .stand_ins = columns->stand_ins,
                                .column_count = columns->count, .ring_count = rings,
                                .bare = wanted->use != MESO_SHAPE_WHOLE, .wanted = wanted->seen ? mesh->wanted : NULL};
    meso_sweep_grid(scene, kind, &instance, &grid, mesh->vertices);
    return true;
}

/* Corners of both halves of a face, of which those of a triangle's second have no area. */
static void cut_face(uint32_t corners[6], uint32_t first, uint32_t sides, bool mirrored)
{
    uint32_t b = mirrored ? first + 2 : first + 1, c = mirrored ? first + 1 : first + 2;
    uint32_t last = sides == 4 ? first + 3 : first;
    const uint32_t halves[6] = {first, b, c, first, mirrored ? last : first + 2, mirrored ? first + 2 : last};
    memcpy(corners, halves, sizeof halves);
}

/* Each corner is a vertex of its own: faces share few where they lie in any order. */
static bool make_run(const MesoShapes *shapes, const MesoShapeRun *run, MesoShapeMesh *mesh)
{
    const MesoBody *body = &shapes->scene->bodies[shapes->scene->placed[run->placed].body];
    const MesoVec3 *positions = shapes->bodies.positions[run->placed], *normals = shapes->bodies.normals[run->placed];
    bool mirrored = shapes->bodies.mirrored[run->placed];
    if (!make_room(mesh, 4 * (uint64_t)run->face_count, 2 * (uint64_t)run->face_count))
        return false;
    if (run->face_count > mesh->run_room) {
        if (!grow((void **)&mesh->run_corners, run->face_count, 6 * sizeof *mesh->run_corners))
            return false;
        mesh->run_room = run->face_count;
    }
    mesh->corners = mesh->run_corners;
    mesh->colors = body->colors ? mesh->color_room : NULL;
    mesh->closed = mesh->placed = false;
    mesh->reach = 0;
    mesh->columns = NULL;
    uint32_t vertex = 0;
    for (uint32_t f = 0; f < run->face_count; f++) {
        uint32_t sides, *corners = mesh->run_corners + 6 * (size_t)f;
        const uint32_t *v = face_of(body, run->face_begin + f, &sides);
        for (uint32_t k = 0; k < sides; k++) {
            if (mesh->colors)
                mesh->colors[vertex + k] = body->colors[v[k]];
            mesh->vertices[vertex + k] = (MesoMeshVertex){meso_vec3_sub(positions[v[k]], shapes->anchor), normals[v[k]],
                                                          body->uvs ? body->uvs[v[k]] : (MesoVec2){0, 0}};
        }
        cut_face(corners, vertex, sides, mirrored);
        vertex += sides;
    }
    mesh->vertex_count = vertex;
    return true;
}

static bool make(const MesoShapes *shapes, uint32_t shape, const Wanted *wanted, MesoShapeMesh *mesh)
{
    uint32_t sweeps = shapes->scene->sweep_count;
    if (shape >= sweeps)
        return make_run(shapes, &shapes->runs[shape - sweeps], mesh);
    MesoSweepInstance sweep = meso_scene_sweep(shapes->scene, shape);
    return make_sweep(shapes, shape, kind_of(shapes, shape), &sweep, wanted, mesh);
}

static bool make_bundled(const MesoShapes *shapes, const MesoShapeBundle *bundle, uint32_t i, const Wanted *wanted,
                         MesoShapeMesh *mesh)
{
    if (!bundle->made)
        return make(shapes, bundle->shapes[i], wanted, mesh);
    const MesoSweepMaker *maker = shapes->scene->maker;
    MesoMadeSweep made = bundle->sweeps[i];
    maker->add_turns(maker->context, &made);
    return make_sweep(shapes, made.sweep, made.kind, &made.instance, wanted, mesh);
}

bool meso_shape_make(const MesoShapes *shapes, uint32_t shape, float tolerance, MesoShapeUse use, MesoShapeMesh *mesh)
{
    return make(shapes, shape, &(Wanted){.tolerance = tolerance, .use = use}, mesh);
}

bool meso_shape_make_bundled(const MesoShapes *shapes, const MesoShapeBundle *bundle, uint32_t i, float tolerance,
                             MesoShapeUse use, MesoShapeMesh *mesh)
{
    return make_bundled(shapes, bundle, i, &(Wanted){.tolerance = tolerance, .use = use}, mesh);
}

bool meso_shape_place(const MesoShapes *shapes, uint32_t shape, float tolerance, MesoShapeUse use, MesoShapeMesh *mesh)
{
    return make(shapes, shape, &(Wanted){.tolerance = tolerance, .use = use, .placed = true}, mesh);
}

bool meso_shape_place_bundled(const MesoShapes *shapes, const MesoShapeBundle *bundle, uint32_t i, float tolerance,
                              MesoShapeUse use, MesoShapeMesh *mesh)
{
    return make_bundled(shapes, bundle, i, &(Wanted){.tolerance = tolerance, .use = use, .placed = true}, mesh);
}

bool meso_shape_make_seen(const MesoShapes *shapes, uint32_t shape, float tolerance, const uint8_t *seen,
                          MesoShapeMesh *mesh)
{
    return make(shapes, shape, &(Wanted){.tolerance = tolerance, .use = MESO_SHAPE_WHOLE, .seen = seen}, mesh);
}

/* ---- corners ---- */

static void sweep_corners(const MesoShapes *shapes, uint32_t sweep, float tolerance, uint32_t triangle,
                          MesoShapeCorner corners[3])
{
    static const uint32_t sides[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};   /* of ring and column */
    uint32_t k = kind_of(shapes, sweep), quad = triangle / 2;
    const MesoShapeColumns *columns = meso_shape_level(shapes->columns, shapes->finest, k, tolerance, MESO_SHAPE_SEEN);
    MesoSweepInstance instance = anchored(shapes, meso_scene_sweep(shapes->scene, sweep));
    uint32_t rings = meso_detail_instance_rings(&shapes->scene->kinds[k], &shapes->details[k], &instance, tolerance,
                                                true);
    for (uint32_t i = 0; i < 3; i++) {
        const uint32_t *at = sides[3 * (triangle % 2) + i];
        MesoColumnSide side = columns->sides[quad % columns->side_count];
        corners[i] = (MesoShapeCorner){.column = columns->kept[at[1] ? side.to : side.from],
                                       .ring = quad / columns->side_count + at[0], .ring_count = rings};
    }
}

static void run_corners(const MesoShapes *shapes, const MesoShapeRun *run, uint32_t triangle,
                        MesoShapeCorner corners[3])
{
    uint32_t sides, halves[6];
    const MesoBody *body = &shapes->scene->bodies[shapes->scene->placed[run->placed].body];
    const uint32_t *v = face_of(body, run->face_begin + triangle / 2, &sides);
    cut_face(halves, 0, sides, shapes->bodies.mirrored[run->placed]);
    for (uint32_t i = 0; i < 3; i++)
        corners[i] = (MesoShapeCorner){.vertex = v[halves[3 * (triangle % 2) + i]]};
}

void meso_shape_corners(const MesoShapes *shapes, uint32_t shape, float tolerance, uint32_t triangle,
                        MesoShapeCorner corners[3])
{
    uint32_t sweeps = shapes->scene->sweep_count;
    if (shape < sweeps)
        sweep_corners(shapes, shape, tolerance, triangle, corners);
    else
        run_corners(shapes, &shapes->runs[shape - sweeps], triangle, corners);
}

MesoVec3 meso_shape_corner_at(const MesoShapes *shapes, uint32_t shape, const MesoShapeCorner *corner)
{
    const MesoScene *scene = &shapes->near;
    if (shape >= scene->sweep_count) {
        const MesoShapeRun *run = &shapes->runs[shape - scene->sweep_count];
        return meso_vec3_sub(shapes->bodies.positions[run->placed][corner->vertex], shapes->anchor);
    }
    const MesoSweptKind *kind = &scene->kinds[kind_of(shapes, shape)];
    MesoSweepInstance instance = anchored(shapes, meso_scene_sweep(shapes->scene, shape));
    float v = (float)corner->ring / (float)(corner->ring_count - 1);
    return meso_sweep_point(scene, kind, &instance, &scene->columns[kind->column_begin + corner->column], v);
}

MesoShapeLook meso_shape_look(const MesoShapes *shapes, uint32_t shape)
{
    const MesoScene *scene = shapes->scene;
    if (shape < scene->sweep_count) {
        const MesoSweptKind *kind = &scene->kinds[kind_of(shapes, shape)];
        return (MesoShapeLook){meso_scene_sweep_ids(scene, shape), kind->start_material, kind->end_material};
    }
    const MesoPlacedBody *placed = &scene->placed[shapes->runs[shape - scene->sweep_count].placed];
    return (MesoShapeLook){placed->ids, placed->material, placed->material};
}
