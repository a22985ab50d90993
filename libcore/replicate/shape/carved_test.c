/* Surfaces with bumps and holes: faces that fit, rims that close, and places that follow. */
#include <stdlib.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/mesh/point/vertex_normals.h"
#include "libcore/replicate/shape/carved_shape.h"

#define CHECK_NEAR(value, expected, tolerance) CHECK(fabs((double)(value) - (double)(expected)) <= (double)(tolerance))

enum { SIDE = 6 };

/* A plate of SIDE x SIDE squares of size 1, from the origin. */
typedef struct Plate {
    MesoTriangulation mesh;
    MesoVec3 *normals;
    MesoCarvedMesh carved;
    MesoDetail details[3];
    MesoPlacedDetail placed[3];
    MesoVec3 *positions;
    uint32_t *under;
} Plate;

static void make_plate(Plate *p)
{
    static MesoVec3 positions[(SIDE + 1) * (SIDE + 1)];
    static uint32_t corners[6 * SIDE * SIDE];
    MesoError error = {0};
    for (uint32_t v = 0; v < (SIDE + 1) * (SIDE + 1); v++)
        positions[v] = (MesoVec3){(float)(v % (SIDE + 1)), (float)(v / (SIDE + 1)), 0};
    for (uint32_t f = 0; f < SIDE * SIDE; f++) {
        uint32_t a = f / SIDE * (SIDE + 1) + f % SIDE, d = a + SIDE + 1;
        const uint32_t two[6] = {a, a + 1, d + 1, a, d + 1, d};
        for (uint32_t k = 0; k < 6; k++)
            corners[6 * f + k] = two[k];
    }
    MesoPolygonMesh polygons = {.vertex_count = (SIDE + 1) * (SIDE + 1), .face_count = 2 * SIDE * SIDE,
                                .corner_count = 6 * SIDE * SIDE, .side_count = 3, .positions = positions,
                                .corners = corners};
    MesoArena arena;
    MesoSurface surface;
    meso_arena_init(&arena);
    CHECK(meso_surface_build(&surface, &arena, &polygons, 1, &error) == MESO_OK);
    CHECK(meso_triangulation_init(&p->mesh, &surface, 0, 0, &error) == MESO_OK);
    meso_arena_release(&arena);
    p->normals = calloc(p->mesh.vertex_count, sizeof *p->normals);
    CHECK(p->normals);
    meso_vertex_normals(p->normals, &p->mesh);
    CHECK(meso_carved_init(&p->carved, &p->mesh, &error) == MESO_OK);
    CHECK(meso_carved_check(&p->carved, &error) == MESO_OK);
    /* in the middle, beside it, and over the border */
    p->details[0] = (MesoDetail){.point = {36, {0.2f, 0.3f, 0.5f}}, .size = 1, .width = 1};
    p->details[1] = (MesoDetail){.point = {40, {0.4f, 0.3f, 0.3f}}, .size = 1, .width = 0.5f, .kind = 1};
    p->details[2] = (MesoDetail){.point = {0, {0.4f, 0.59f, 0.01f}}, .size = 1, .width = 1};
}

static void free_plate(Plate *p)
{
    meso_carved_release(&p->carved);
    meso_triangulation_release(&p->mesh);
    free(p->normals);
    free(p->positions);
    free(p->under);
}

static const MesoCarvedKind kinds[] = {{.carving = MESO_CARVE_HOLE},
                                       {.carving = MESO_CARVE_BUMP, .height = 0.5f}};

static void carve_all(Plate *p)
{
    MesoError error = {0};
    for (uint32_t i = 0; i < 3; i++) {
        CHECK(meso_carve(&p->carved, &p->details[i], kinds[p->details[i].kind].carving, 0.1f, &error) == MESO_OK);
        CHECK(meso_carved_check(&p->carved, &error) == MESO_OK);
    }
}

static void place(Plate *p, const float *grown, uint32_t threads)
{
    MesoError error = {0};
    p->positions = realloc(p->positions, p->carved.vertex_count * sizeof *p->positions);
    p->under = realloc(p->under, p->carved.vertex_count * sizeof *p->under);
    CHECK(p->positions && p->under);
    meso_details_place(p->placed, &p->mesh, p->mesh.positions, p->normals, p->details, grown, 3, 1);
    const MesoCarvedFrame frame = {kinds, p->details, p->placed, 3, p->mesh.positions, p->normals, threads};
    CHECK(meso_carved_place(p->positions, p->under, &p->carved, &frame, &error) == MESO_OK);
}

/* Of all faces but those that a hole has taken, seen from above; the least is told, too. */
static double area_above(const Plate *p, double *least)
{
    double area = 0;
    *least = INFINITY;
    for (uint32_t t = 0; t < p->carved.triangle_count; t++) {
        const MesoCarvedTriangle *triangle = &p->carved.triangles[t];
        const uint32_t *v = triangle->corners;
        if (triangle->hole != MESO_NO_INDEX)
            continue;
        MesoVec3 a = meso_vec3_sub(p->positions[v[1]], p->positions[v[0]]);
        double twice = (double)meso_vec3_cross(a, meso_vec3_sub(p->positions[v[2]], p->positions[v[0]])).z;
        area += 0.5 * twice;
        *least = fmin(*least, twice);
    }
    return area;
}

/* A hole takes as much of the plate as its disc, a closed one nothing; nothing folds, and the border stays. */
static void test_hole(void)
{
    Plate p = {0};
    double least;
    uint32_t rims[2] = {0, 0};
    make_plate(&p);
    carve_all(&p);
    for (uint32_t v = 0; v < p.carved.vertex_count; v++)
        if (p.carved.vertices[v].rim != MESO_NO_INDEX)
            rims[p.carved.vertices[v].rim == 2]++;
    CHECK(rims[0] >= 12 && rims[1] == 0 && p.carved.uncut_count == 1);      /* at the border there is none */
    place(&p, (const float[]){1, 0, 1}, 1);
    CHECK_NEAR(area_above(&p, &least), SIDE * SIDE - 3.14159 * 0.25, 0.03);
    CHECK(least >= -1e-6);
    place(&p, (const float[]){0.5f, 0, 1}, 1);
    CHECK_NEAR(area_above(&p, &least), SIDE * SIDE - 3.14159 * 0.0625, 0.01);
    CHECK(least >= -1e-6);
    place(&p, (const float[]){0, 0, 0}, 1);
    CHECK_NEAR(area_above(&p, &least), SIDE * SIDE, 1e-4);
    CHECK(least >= -1e-6);
    for (uint32_t v = 0; v < p.carved.vertex_count; v++)
        if (p.carved.vertices[v].rim == 0)
            CHECK_NEAR(meso_vec3_length(meso_vec3_sub(p.positions[v], p.placed[0].position)), 0, 1e-5);
    free_plate(&p);
}

/* As high in the middle as it says, over an ellipse; none of size 0; the same for any number of threads. */
static void test_bump(void)
{
    Plate p = {0};
    make_plate(&p);
    carve_all(&p);
    place(&p, (const float[]){0, 1, 0}, 1);
    float high = 0;
    for (uint32_t v = 0; v < p.carved.vertex_count; v++) {
        MesoVec3 d = meso_vec3_sub(p.carved.vertices[v].rest, p.placed[1].position);
        float along = meso_vec3_dot(d, p.placed[1].tangent);
        float across = sqrtf(fmaxf(0, meso_vec3_dot(d, d) - along * along));
        bool inside = along * along / 0.25f + across * across / 0.0625f < 1;
        CHECK(inside == (p.under[v] == 1));
        CHECK(inside || fabsf(p.positions[v].z) < 1e-6f);
        high = fmaxf(high, p.positions[v].z);
    }
    CHECK_NEAR(high, 0.5f * sqrtf(0.5f), 0.02f);
    CHECK_NEAR(meso_bump_height(&kinds[1], 0, 0), 0.5f, 1e-6f);
    CHECK_NEAR(meso_bump_height(&kinds[1], 0.6f, 0.8f), 0, 1e-6f);
    MesoVec3 *alone = p.positions;
    p.positions = NULL;
    place(&p, (const float[]){0, 1, 0}, 7);
    for (uint32_t v = 0; v < p.carved.vertex_count; v++)
        CHECK(memcmp(&alone[v], &p.positions[v], sizeof alone[v]) == 0);
    free(alone);
    place(&p, (const float[]){0, 0, 0}, 1);
    for (uint32_t v = 0; v < p.carved.vertex_count; v++)
        CHECK(p.positions[v].z == 0 && p.under[v] == MESO_NO_INDEX);
    free_plate(&p);
}

int main(void)
{
    test_hole();
    test_bump();
    return 0;
}
