/*
 * How far a model's sweeps lie from the polygons that a tolerance makes of them:
 *
 *     map_error_bench MODEL.meso TOLERANCE
 *
 * Places of some hundred sweeps, as a sixteenth of the tolerance has their columns, are looked for in the polygons. A
 * sweep is the same one in both: its mitre, and its twist, which follow from its columns, are those of the polygons.
 * Prints, in tolerances, the mean over all places, what is the worst of a sweep for half of the sweeps, for nine in
 * ten, and for all, and which share of the places is over.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/model/model_scene.h"
#include "libcore/scene/sweep.h"

enum { SWEEPS = 300, COLUMNS = 60, PLACES = 24, FINER = 16 };

typedef struct Mapped {
    MesoInput input;
    MesoArena arena;
    MesoScene scene;
    float tolerance, length;    /* in mean edge lengths, and in scene units */
} Mapped;

static void set_tolerance(void *context, MesoMapOptions *options)
{
    options->tolerance = *(float *)context;
    options->tolerance_in = MESO_TOLERANCE_EDGE;
}

static MesoStatus map_model(Mapped *m, const char *path, float tolerance, MesoError *error)
{
    m->tolerance = tolerance;
    MesoSceneReading reading = {.thread_count = 2, .remap = set_tolerance, .context = &m->tolerance};
    MesoStatus status = meso_input_open(&m->input, path, error);
    if (status)
        return status;
    meso_arena_init(&m->arena);
    status = meso_scene_read(&m->scene, &m->arena, &m->input, &reading, error);
    if (!status && !reading.tiling)
        status = meso_fail(error, MESO_ERR_INPUT, "'%s' is no model of tiles", path);
    if (!status)
        m->length = tolerance * reading.tiling->surface.mean_edge_length;
    return status;
}

static void release(Mapped *m)
{
    meso_arena_release(&m->arena);
    meso_input_close(&m->input);
}

/* ---- polygons of one sweep ---- */

typedef struct Polygons {
    uint64_t face_count;
    MesoMeshVertex *vertices;
    MesoMeshFace *faces;
    MesoBox *boxes;     /* of the faces */
} Polygons;

static Polygons make_polygons(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    Polygons p = {.face_count = meso_sweep_face_count(kind)};
    p.vertices = malloc(meso_sweep_vertex_count(kind) * sizeof *p.vertices);
    p.faces = malloc(p.face_count * sizeof *p.faces);
    p.boxes = malloc(p.face_count * sizeof *p.boxes);
    if (!p.vertices || !p.faces || !p.boxes)
        exit(MESO_ERR_MEMORY);
    meso_sweep_vertices(scene, kind, sweep, p.vertices);
    meso_sweep_faces(scene, kind, sweep, 0, p.faces);
    for (uint64_t f = 0; f < p.face_count; f++) {
        p.boxes[f] = meso_box_empty();
        for (uint32_t k = 0; k < 4 && p.faces[f].v[k] != MESO_NO_INDEX; k++)
            meso_box_add(&p.boxes[f], p.vertices[p.faces[f].v[k]].position);
    }
    return p;
}

static void free_polygons(Polygons *p)
{
    free(p->vertices);
    free(p->faces);
    free(p->boxes);
}

static float to_line(MesoVec3 p, MesoVec3 a, MesoVec3 b)
{
    MesoVec3 d = meso_vec3_sub(b, a), q = meso_vec3_sub(p, a);
    float square = meso_vec3_dot(d, d), t = square > 0 ? fmaxf(0, fminf(1, meso_vec3_dot(q, d) / square)) : 0;
    return meso_vec3_length(meso_vec3_mad(q, -t, d));
}

static float to_triangle(MesoVec3 p, MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    MesoVec3 ab = meso_vec3_sub(b, a), ac = meso_vec3_sub(c, a), n = meso_vec3_cross(ab, ac), ap = meso_vec3_sub(p, a);
    float square = meso_vec3_dot(n, n);
    float w = meso_vec3_dot(meso_vec3_cross(ab, ap), n), v = meso_vec3_dot(meso_vec3_cross(ap, ac), n);
    if (square > 0 && v >= 0 && w >= 0 && v + w <= square)
        return fabsf(meso_vec3_dot(ap, n)) / sqrtf(square);
    return fminf(to_line(p, a, b), fminf(to_line(p, b, c), to_line(p, c, a)));
}

static float to_box(MesoVec3 p, const MesoBox *box)
{
    MesoVec3 d = {fmaxf(0, fmaxf(box->low.x - p.x, p.x - box->high.x)),
                  fmaxf(0, fmaxf(box->low.y - p.y, p.y - box->high.y)),
                  fmaxf(0, fmaxf(box->low.z - p.z, p.z - box->high.z))};
    return meso_vec3_length(d);
}

static float to_polygons(MesoVec3 p, const Polygons *in)
{
    float best = INFINITY;
    for (uint64_t f = 0; f < in->face_count; f++) {
        const uint32_t *v = in->faces[f].v;
        if (to_box(p, &in->boxes[f]) >= best)
            continue;
        for (uint32_t k = 2; k < 4 && v[k] != MESO_NO_INDEX; k++)
            best = fminf(best, to_triangle(p, in->vertices[v[0]].position, in->vertices[v[k - 1]].position,
                                           in->vertices[v[k]].position));
    }
    return best;
}

/* ---- all of them ---- */

typedef struct Errors {
    double sum;
    uint64_t count, over;
    float worst[SWEEPS + 1];
    uint32_t sweep_count;
} Errors;

/* The kind that the same sweep has in another scene of the model; NULL: it is not there. */
static const MesoSweptKind *same_kind(const MesoScene *in, const MesoSweepInstance *sweep)
{
    for (uint32_t i = 0; i < in->sweep_count; i++)
        if (in->sweeps[i].ids == sweep->ids && memcmp(in->sweeps[i].p, sweep->p, sizeof sweep->p) == 0 &&
            memcmp(in->sweeps[i].up, sweep->up, sizeof sweep->up) == 0)
            return &in->kinds[meso_scene_kind(in, i)];
    return NULL;
}

static void measure_sweep(Errors *errors, const Mapped *exact, const Mapped *coarse, uint32_t i)
{
    const MesoSweepInstance *sweep = &coarse->scene.sweeps[i];
    const MesoSweptKind *kind = same_kind(&exact->scene, sweep);
    if (!kind)
        return;
    const MesoSweepColumn *columns = exact->scene.columns + kind->column_begin;
    Polygons polygons = make_polygons(&coarse->scene, &coarse->scene.kinds[meso_scene_kind(&coarse->scene, i)], sweep);
    float worst = 0;
    for (uint32_t c = 0; c < kind->column_count; c += 1 + kind->column_count / COLUMNS)
        for (uint32_t k = 0; k < PLACES; k++) {
            float v = ((float)k + (float)((7 * c + 3 * i) % 10) / 10) / PLACES;
            float off = to_polygons(meso_sweep_point(&exact->scene, kind, sweep, &columns[c], v), &polygons) /
                        coarse->length;
            worst = fmaxf(worst, off);
            errors->sum += (double)off;
            errors->over += off > 1;
            errors->count++;
        }
    errors->worst[errors->sweep_count++] = worst;
    free_polygons(&polygons);
}

static int compare_floats(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

static MesoStatus measure(Errors *errors, const char *path, float tolerance, MesoError *error)
{
    static Mapped exact, coarse;
    MesoStatus status = map_model(&coarse, path, tolerance, error);
    if (!status)
        status = map_model(&exact, path, tolerance / FINER, error);
    uint32_t stride = coarse.scene.sweep_count / SWEEPS + 1;
    for (uint32_t i = stride / 2; i < coarse.scene.sweep_count && !status; i += stride)
        measure_sweep(errors, &exact, &coarse, i);
    if (!status && errors->sweep_count == 0)
        status = meso_fail(error, MESO_ERR_INPUT, "'%s' has no sweeps", path);
    release(&exact);
    release(&coarse);
    return status;
}

int main(int argc, char **argv)
{
    static Errors errors;
    MesoError error;
    if (argc != 3) {
        fprintf(stderr, "usage: map_error_bench MODEL.meso TOLERANCE\n");
        return MESO_ERR_USAGE;
    }
    MesoStatus status = measure(&errors, argv[1], strtof(argv[2], NULL), &error);
    if (status) {
        fprintf(stderr, "map_error_bench: %s\n", error.message);
        return status;
    }
    uint32_t n = errors.sweep_count;
    qsort(errors.worst, n, sizeof *errors.worst, compare_floats);
    printf("%.2f %.2f %.2f %.2f %.3f\n", errors.sum / (double)errors.count, (double)errors.worst[n / 2],
           (double)errors.worst[9 * n / 10], (double)errors.worst[n - 1],
           100 * (double)errors.over / (double)errors.count);
    return MESO_OK;
}
