/*
 * How few triangles a model's sweeps could do with at a tolerance, whatever the mesh:
 *
 *     map_bound_bench MODEL.meso TOLERANCE
 *
 * A triangle that is within e of a surface with the principal curvatures a and b, its corners as far outside as it lies
 * inside, has an area of 3 sqrt(3) e / sqrt(|a b|) at most (Pottmann et al. 2000, "On piecewise linear approximation of
 * quadratic functions"; where a b < 0 it has less). The sum of sqrt(|a b|) over the surface, from differences on a fine
 * grid, therefore bounds the count from below; what only bends one way counts as none. Caps are left out.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "formats/model/model_scene.h"
#include "libcore/scene/sweep.h"

enum { DIVISIONS = 80, SWEEPS_A_KIND = 100 };

static void make_fine(void *context, MesoMapOptions *options)
{
    (void)context;
    options->tolerance = 0;
    options->divisions = DIVISIONS;
    options->section_step = 0.003f;
}

/* sqrt(|a b|) times the area, of a place of the grid. */
static double bent_area(const MesoMeshVertex *v, uint32_t width)
{
    MesoVec3 here = v->position, left = v[-1].position, right = v[1].position;
    MesoVec3 below = (v - width)->position, above = (v + width)->position;
    MesoVec3 normal = meso_vec3_direction(meso_vec3_cross(meso_vec3_sub(right, left), meso_vec3_sub(above, below)),
                                          (MesoVec3){0, 0, 0});
    MesoVec3 mixed = meso_vec3_sub(meso_vec3_add(v[width + 1].position, (v - width)[-1].position),
                                   meso_vec3_add(v[width - 1].position, (v - width)[1].position));
    double around = (double)meso_vec3_dot(normal, meso_vec3_mad(meso_vec3_add(left, right), -2, here));
    double along = (double)meso_vec3_dot(normal, meso_vec3_mad(meso_vec3_add(below, above), -2, here));
    double both = (double)meso_vec3_dot(normal, mixed) / 4;
    return sqrt(fabs(around * along - both * both));
}

static double bent_sweep(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                         MesoMeshVertex *vertices)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t width = kind->column_count;
    double sum = 0;
    meso_sweep_vertices(scene, kind, sweep, vertices);
    for (uint32_t r = 1; r + 1 < kind->division_count; r++)
        for (uint32_t c = 1; c + 1 < width; c++)
            sum += columns[c].joins_next && columns[c - 1].joins_next ? bent_area(vertices + r * width + c, width) : 0;
    return sum;
}

static double bent_kind(const MesoScene *scene, const MesoSweptKind *kind)
{
    MesoMeshVertex *vertices = malloc(meso_sweep_vertex_count(kind) * sizeof *vertices);
    uint32_t stride = 1 + kind->instance_count / SWEEPS_A_KIND, count = 0;
    double sum = 0;
    for (uint32_t i = 0; i < kind->instance_count && vertices; i += stride, count++)
        sum += bent_sweep(scene, kind, &scene->sweeps[kind->instance_begin + i], vertices);
    free(vertices);
    return count > 0 ? sum / count * kind->instance_count : 0;
}

static MesoStatus measure(const char *path, double tolerance, double *triangles, MesoError *error)
{
    MesoArena arena;
    MesoInput input;
    MesoScene scene;
    MesoSceneReading reading = {.thread_count = 2, .remap = make_fine};
    MesoStatus status = meso_input_open(&input, path, error);
    if (status)
        return status;
    meso_arena_init(&arena);
    status = meso_scene_read(&scene, &arena, &input, &reading, error);
    if (!status && !reading.tiling)
        status = meso_fail(error, MESO_ERR_INPUT, "'%s' is no model of tiles", path);
    double sum = 0;
    for (uint32_t k = 0; k < scene.kind_count && !status; k++)
        sum += scene.kinds[k].cap ? 0 : bent_kind(&scene, &scene.kinds[k]);
    if (!status)
        *triangles = sum / (3 * sqrt(3) * tolerance * (double)reading.tiling->surface.mean_edge_length);
    meso_arena_release(&arena);
    meso_input_close(&input);
    return status;
}

int main(int argc, char **argv)
{
    MesoError error;
    double triangles;
    if (argc != 3) {
        fprintf(stderr, "usage: map_bound_bench MODEL.meso TOLERANCE\n");
        return MESO_ERR_USAGE;
    }
    MesoStatus status = measure(argv[1], strtod(argv[2], NULL), &triangles, &error);
    if (status)
        fprintf(stderr, "map_bound_bench: %s\n", error.message);
    else
        printf("%.3f\n", triangles / 1e6);
    return status;
}
