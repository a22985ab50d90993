#include "libcore/render/raster/shapes.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/placed.h"
#include "libcore/scene/sweep.h"

/* ---- levels of detail ---- */

static MesoStatus make_levels(MesoShapes *shapes, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = shapes->scene;
    MesoStatus status = MESO_OK;
    size_t count = (size_t)scene->kind_count * MESO_SHAPE_LEVELS;
    shapes->details = MESO_NEW(arena, MesoKindDetail, scene->kind_count, error);
    shapes->columns = MESO_NEW(arena, MesoShapeColumns, count * MESO_SHAPE_USES, error);
    if (!shapes->details || !shapes->columns)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < scene->kind_count && !status; k++) {
        const MesoSweptKind *kind = &scene->kinds[k];
        shapes->details[k] = meso_kind_detail(scene, kind);
        float scale = scene->section_scale * meso_scene_kind_size(scene, kind) * shapes->details[k].stretch.most;
        for (uint32_t i = 0; i < MESO_SHAPE_LEVELS * MESO_SHAPE_USES && !status; i++) {
            uint32_t level = i / MESO_SHAPE_USES;
            float tolerance = level == 0 ? 0 : shapes->finest * exp2f(0.5f * (float)level);
            status = meso_shape_columns(&shapes->columns[(size_t)k * MESO_SHAPE_LEVELS * MESO_SHAPE_USES + i], arena,
                                        scene, kind, scale, tolerance, i % MESO_SHAPE_USES, error);
        }
    }
    return status;
}

static uint32_t level_for(const MesoShapes *shapes, float tolerance)
{
    if (!(tolerance > shapes->finest))
        return 0;
    float level = floorf(2 * log2f(tolerance / shapes->finest));
    return level < MESO_SHAPE_LEVELS - 1 ? (uint32_t)level : MESO_SHAPE_LEVELS - 1;
}

static const MesoShapeColumns *columns_for(const MesoShapes *shapes, uint32_t kind, float tolerance, MesoShapeUse use)
{
    size_t level = (size_t)kind * MESO_SHAPE_LEVELS + level_for(shapes, tolerance);
    return &shapes->columns[level * MESO_SHAPE_USES + use];
}

/* ---- bodies ---- */


typedef struct Moving {
    const MesoScene *scene;
    const uint32_t *which;
    MesoVec3 **positions, **normals;
    bool failed;
} Moving;

static void move_bodies(void *context, uint64_t begin, uint64_t end)
{
    Moving *m = context;
    for (uint64_t i = begin; i < end; i++) {
        const MesoPlacedBody *placed = &m->scene->placed[m->which[i]];
        uint32_t count = m->scene->bodies[placed->body].vertex_count;
        MesoMeshVertex *vertices = malloc((count ? count : 1) * sizeof *vertices);
        if (!vertices) {
            __atomic_store_n(&m->failed, true, __ATOMIC_RELAXED);
            continue;
        }
        meso_placed_vertices(m->scene, placed, vertices);
        for (uint32_t v = 0; v < count; v++) {
            m->positions[i][v] = vertices[v].position;
            m->normals[i][v] = vertices[v].normal;
        }
        free(vertices);
    }
}

static MesoStatus place_bodies(MesoShapes *shapes, MesoArena *arena, uint32_t thread_count, MesoError *error)
{
    const MesoScene *scene = shapes->scene;
    uint32_t *which = MESO_NEW(arena, uint32_t, scene->placed_count, error), moved = 0;
    MesoVec3 **positions = MESO_NEW(arena, MesoVec3 *, scene->placed_count, error);
    MesoVec3 **normals = MESO_NEW(arena, MesoVec3 *, scene->placed_count, error);
    shapes->positions = MESO_NEW(arena, const MesoVec3 *, scene->placed_count, error);
    shapes->normals = MESO_NEW(arena, const MesoVec3 *, scene->placed_count, error);
    shapes->mirrored = MESO_NEW(arena, bool, scene->placed_count, error);
    if (!which || !positions || !normals || !shapes->positions || !shapes->normals || !shapes->mirrored)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < scene->placed_count; i++) {
        const MesoPlacedBody *placed = &scene->placed[i];
        const MesoBody *body = &scene->bodies[placed->body];
        shapes->positions[i] = body->positions;
        shapes->normals[i] = body->normals;
        if (placed->place == MESO_PLACED_HERE)
            continue;
        shapes->mirrored[i] = meso_placed_is_mirrored(scene, placed);
        positions[moved] = MESO_NEW(arena, MesoVec3, body->vertex_count, error);
        normals[moved] = MESO_NEW(arena, MesoVec3, body->vertex_count, error);
        if (!positions[moved] || !normals[moved])
            return MESO_ERR_MEMORY;
        shapes->positions[i] = positions[moved];
        shapes->normals[i] = normals[moved];
        which[moved++] = i;
    }
    Moving m = {scene, which, positions, normals, false};
    meso_parallel_for(thread_count, moved, 16, move_bodies, &m);
    return m.failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for the bodies") : MESO_OK;
}

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
            meso_box_add(&box, meso_vec3_sub(shapes->positions[run->placed][v[k]], shapes->anchor));
    }
    return box;
}

/* Within the hull of the sweep, as wide as what the kind's profiles reach. */
static MesoBox sweep_box(const MesoShapes *shapes, uint32_t sweep)
{
    const MesoScene *scene = shapes->scene;
    MesoBox box = meso_box_empty();
    const MesoKindDetail *detail = &shapes->details[shapes->kind_of[sweep]];
    float rise = MESO_CAP_RISE * scene->section_scale * scene->sweeps[sweep].size[0];
    MesoSweepHull hull = meso_sweep_hull(scene, &scene->sweeps[sweep],
                                         fmaxf(detail->radius / detail->stretch.most, rise));
    for (uint32_t k = 0; k < hull.count; k++)
        meso_box_add_around(&box, meso_vec3_sub(hull.points[k], shapes->anchor), hull.reach);
    return box;
}

static void bound(void *context, uint64_t begin, uint64_t end)
{
    MesoShapes *shapes = context;
    uint32_t sweeps = shapes->scene->sweep_count;
    for (uint64_t i = begin; i < end; i++)
        shapes->bounds[i] = i < sweeps ? sweep_box(shapes, (uint32_t)i) : run_box(shapes, &shapes->runs[i - sweeps]);
}

MesoStatus meso_shapes_init(MesoShapes *shapes, MesoArena *arena, const MesoScene *scene, MesoVec3 anchor,
                            uint32_t thread_count, MesoError *error)
{
    float size = meso_vec3_length(meso_vec3_sub(scene->box.high, scene->box.low));
    *shapes = (MesoShapes){.scene = scene, .near = *scene, .anchor = anchor, .finest = 1e-6f * size};
    MesoStatus status = make_runs(shapes, arena, error);
    if (!status && scene->deform == MESO_SWEEP_SHAPE) {
        shapes->near.cages = meso_cages_from(scene, anchor, arena, error);
        status = shapes->near.cages ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (!status)
        status = place_bodies(shapes, arena, thread_count, error);
    if (!status)
        status = make_levels(shapes, arena, error);
    if (status)
        return status;
    shapes->kind_of = MESO_NEW(arena, uint32_t, scene->sweep_count, error);
    shapes->bounds = MESO_NEW(arena, MesoBox, shapes->count, error);
    if (!shapes->kind_of || !shapes->bounds)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < scene->kind_count; k++)
        for (uint32_t i = 0; i < scene->kinds[k].instance_count; i++)
            shapes->kind_of[scene->kinds[k].instance_begin + i] = k;
    meso_parallel_for(thread_count, shapes->count, 1024, bound, shapes);
    return MESO_OK;
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
    if (triangles > mesh->triangle_room) {
        if (!grow((void **)&mesh->corners, 2 * triangles, 3 * sizeof *mesh->corners))
            return false;
        mesh->triangle_room = 2 * (uint32_t)triangles;
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
    free(mesh->corners);
    *mesh = (MesoShapeMesh){0};
}

static MesoSweepInstance anchored(const MesoShapes *shapes, uint32_t sweep)
{
    MesoSweepInstance instance = shapes->scene->sweeps[sweep];
    for (uint32_t i = 0; i < 4 && shapes->scene->deform == MESO_SWEEP_CURVES; i++)
        instance.p[i] = meso_vec3_sub(instance.p[i], shapes->anchor);
    return instance;
}

/* Sweeps of a kind often follow one another: their corners are the same. */
static void make_corners(const MesoShapeColumns *columns, uint32_t rings, MesoShapeMesh *mesh)
{
    uint32_t first = mesh->corners_of == columns ? mesh->ring_room : 1;
    uint32_t *out = mesh->corners + 6 * (size_t)columns->side_count * (first - 1);
    for (uint32_t r = first - 1; r + 1 < rings; r++)
        for (uint32_t j = 0; j < columns->side_count; j++) {
            uint32_t here = r * columns->count, ahead = here + columns->count;
            MesoColumnSide side = columns->sides[j];
            const uint32_t quad[6] = {here + side.from, ahead + side.from, ahead + side.to,
                                      here + side.from, ahead + side.to, here + side.to};
            memcpy(out, quad, sizeof quad);
            out += 6;
        }
    mesh->corners_of = columns;
    mesh->ring_room = rings > first ? rings : first;
}

/* Vertices of triangles that have been seen. */
static void find_wanted(MesoShapeMesh *mesh, const uint8_t *seen)
{
    memset(mesh->wanted, 0, mesh->vertex_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (uint32_t k = 0; seen[t] && k < 3; k++)
            mesh->wanted[mesh->corners[3 * (size_t)t + k]] = 1;
}

static bool make_sweep(const MesoShapes *shapes, uint32_t sweep, float tolerance, MesoShapeUse use,
                       const uint8_t *seen, MesoShapeMesh *mesh)
{
    const MesoScene *scene = &shapes->near;
    uint32_t k = shapes->kind_of[sweep];
    const MesoSweptKind *kind = &scene->kinds[k];
    const MesoShapeColumns *columns = columns_for(shapes, k, tolerance, use);
    MesoSweepInstance instance = anchored(shapes, sweep);
    uint32_t rings = meso_detail_instance_rings(kind, &shapes->details[k], &instance, tolerance,
                                                use != MESO_SHAPE_SHADOW);
    if (!make_room(mesh, (uint64_t)columns->count * rings, 2 * (uint64_t)columns->side_count * (rings - 1)))
        return false;
    mesh->closed = columns->closed;
    mesh->reach = columns->reach;
    make_corners(columns, rings, mesh);
    if (seen)
        find_wanted(mesh, seen);
    const MesoSweepGrid grid = {.columns = columns->kept, .column_count = columns->count, .ring_count = rings,
                                .bare = use != MESO_SHAPE_WHOLE, .wanted = seen ? mesh->wanted : NULL};
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
    const MesoVec3 *positions = shapes->positions[run->placed], *normals = shapes->normals[run->placed];
    bool mirrored = shapes->mirrored[run->placed];
    if (!make_room(mesh, 4 * (uint64_t)run->face_count, 2 * (uint64_t)run->face_count))
        return false;
    mesh->colors = body->colors ? mesh->color_room : NULL;
    mesh->closed = false;
    mesh->reach = 0;
    mesh->corners_of = NULL;
    uint32_t vertex = 0;
    for (uint32_t f = 0; f < run->face_count; f++) {
        uint32_t sides, *corners = mesh->corners + 6 * (size_t)f;
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

bool meso_shape_make(const MesoShapes *shapes, uint32_t shape, float tolerance, MesoShapeUse use, MesoShapeMesh *mesh)
{
    uint32_t sweeps = shapes->scene->sweep_count;
    return shape < sweeps ? make_sweep(shapes, shape, tolerance, use, NULL, mesh)
                          : make_run(shapes, &shapes->runs[shape - sweeps], mesh);
}

bool meso_shape_make_seen(const MesoShapes *shapes, uint32_t shape, float tolerance, const uint8_t *seen,
                          MesoShapeMesh *mesh)
{
    uint32_t sweeps = shapes->scene->sweep_count;
    return shape < sweeps ? make_sweep(shapes, shape, tolerance, MESO_SHAPE_WHOLE, seen, mesh)
                          : make_run(shapes, &shapes->runs[shape - sweeps], mesh);
}

/* ---- corners ---- */

static void sweep_corners(const MesoShapes *shapes, uint32_t sweep, float tolerance, uint32_t triangle,
                          MesoShapeCorner corners[3])
{
    static const uint32_t sides[6][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 0}, {1, 1}, {0, 1}};   /* of ring and column */
    uint32_t k = shapes->kind_of[sweep], quad = triangle / 2;
    const MesoShapeColumns *columns = columns_for(shapes, k, tolerance, MESO_SHAPE_SEEN);
    MesoSweepInstance instance = anchored(shapes, sweep);
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
    cut_face(halves, 0, sides, shapes->mirrored[run->placed]);
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
        return meso_vec3_sub(shapes->positions[run->placed][corner->vertex], shapes->anchor);
    }
    const MesoSweptKind *kind = &scene->kinds[shapes->kind_of[shape]];
    MesoSweepInstance instance = anchored(shapes, shape);
    float v = (float)corner->ring / (float)(corner->ring_count - 1);
    return meso_sweep_point(scene, kind, &instance, &scene->columns[kind->column_begin + corner->column], v);
}

MesoShapeLook meso_shape_look(const MesoShapes *shapes, uint32_t shape)
{
    const MesoScene *scene = shapes->scene;
    if (shape < scene->sweep_count) {
        const MesoSweptKind *kind = &scene->kinds[shapes->kind_of[shape]];
        return (MesoShapeLook){scene->sweeps[shape].ids, kind->start_material, kind->end_material};
    }
    const MesoPlacedBody *placed = &scene->placed[shapes->runs[shape - scene->sweep_count].placed];
    return (MesoShapeLook){placed->ids, placed->material, placed->material};
}
