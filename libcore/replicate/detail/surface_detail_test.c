/* Details on surfaces that move: turned with them, never stretched. */
#include "libcore/base/check.h"
#include "libcore/geodesic/geodesic_fixture.h"
#include "libcore/mesh/point/vertex_normals.h"
#include "libcore/replicate/detail/surface_detail.h"

enum { COUNT = 200 };

typedef struct Scene {
    MesoTriangulation rest, moved;
    MesoVec3 *normals;
    MesoDetail details[COUNT];
    MesoPlacedDetail before[COUNT], after[COUNT];
} Scene;

static void start(Scene *s)
{
    MesoRandom random;
    meso_random_init(&random, 11, 0);
    s->rest = meso_fixture_sphere(12, 0.2f, 3);
    s->moved = meso_fixture_sphere(12, 0.2f, 3);
    s->normals = malloc(s->rest.vertex_count * sizeof *s->normals);
    CHECK(s->normals);
    for (uint32_t i = 0; i < COUNT; i++) {
        float a = 0.5f + 0.5f * meso_fixture_signed(&random);
        float b = (1 - a) * (0.5f + 0.5f * meso_fixture_signed(&random));
        s->details[i] = (MesoDetail){.point = {meso_random_below(&random, s->rest.triangle_count), {1 - a - b, a, b}},
                                     .angle = 3 * meso_fixture_signed(&random), .size = 2, .width = 1};
    }
}

static void place(Scene *s, const MesoTriangulation *mesh, MesoPlacedDetail *out)
{
    meso_vertex_normals(s->normals, mesh);
    meso_details_place(out, &s->rest, mesh->positions, s->normals, s->details, NULL, COUNT, 2);
    for (uint32_t i = 0; i < COUNT; i++) {
        CHECK(fabsf(meso_vec3_length(out[i].tangent) - 1) < 1e-5f);
        CHECK(fabsf(meso_vec3_length(out[i].normal) - 1) < 1e-5f);
        CHECK(fabsf(meso_vec3_dot(out[i].tangent, out[i].normal)) < 1e-5f);
        CHECK(out[i].size == 2 && out[i].width == 1);
    }
}

static void end(Scene *s)
{
    free(s->normals);
    meso_triangulation_release(&s->rest);
    meso_triangulation_release(&s->moved);
}

static MesoVec3 quarter_turn(MesoVec3 p)
{
    return (MesoVec3){-p.y, p.x, p.z};
}

/* A turn of the whole, and a scale, turn details, and nothing more. */
static void test_rigid(void)
{
    Scene s;
    start(&s);
    place(&s, &s.rest, s.before);
    for (uint32_t v = 0; v < s.rest.vertex_count; v++)
        s.moved.positions[v] = meso_vec3_scale(quarter_turn(s.rest.positions[v]), 3);
    place(&s, &s.moved, s.after);
    for (uint32_t i = 0; i < COUNT; i++) {
        CHECK(meso_vec3_length(meso_vec3_sub(s.after[i].tangent, quarter_turn(s.before[i].tangent))) < 1e-4f);
        CHECK(meso_vec3_length(meso_vec3_sub(s.after[i].normal, quarter_turn(s.before[i].normal))) < 1e-4f);
        CHECK(fabs(meso_stretch_of_area(&s.rest, s.moved.positions, s.details[i].point.triangle) - 9) < 1e-4);
    }
    end(&s);
}

static MesoVec3 flat(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    return (MesoVec3){(float)column / (float)squares->columns, (float)row / (float)squares->rows, 0};
}

/* A pure stretch turns no heading; a shear by half its angle: x + 2 k y turns by atan(k). */
static void test_flat(void)
{
    const MesoFixtureSquares squares = {.columns = 6, .rows = 6, .place = flat};
    const MesoVec3 up[4] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    MesoTriangulation mesh = meso_fixture_squares(&squares);
    MesoVec3 *moved = malloc(mesh.vertex_count * sizeof *moved), *normals = malloc(mesh.vertex_count * sizeof *moved);
    CHECK(moved && normals);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        normals[v] = up[0];
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        const MesoDetail detail = {.point = {t, {0.2f, 0.3f, 0.5f}}, .angle = 0.7f, .size = 1, .width = 1};
        MesoPlacedDetail rest, stretched, sheared;
        meso_details_place(&rest, &mesh, mesh.positions, normals, &detail, NULL, 1, 1);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            moved[v] = (MesoVec3){5 * mesh.positions[v].x, mesh.positions[v].y, 0};
        meso_details_place(&stretched, &mesh, moved, normals, &detail, NULL, 1, 1);
        CHECK(meso_vec3_length(meso_vec3_sub(rest.tangent, stretched.tangent)) < 1e-5f);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            moved[v] = (MesoVec3){mesh.positions[v].x + 1.2f * mesh.positions[v].y, mesh.positions[v].y, 0};
        meso_details_place(&sheared, &mesh, moved, normals, &detail, NULL, 1, 1);
        double turn = atan2((double)rest.tangent.x * sheared.tangent.y - (double)rest.tangent.y * sheared.tangent.x,
                            meso_vec3_dot(rest.tangent, sheared.tangent));
        CHECK(fabs(turn + atan(0.6)) < 1e-5);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            moved[v] = (MesoVec3){0, 0, 0};
        meso_details_place(&sheared, &mesh, moved, normals, &detail, NULL, 1, 1);
        CHECK(sheared.size == 0 && sheared.width == 0 && fabsf(meso_vec3_length(sheared.tangent) - 1) < 1e-6f);
    }
    free(moved);
    free(normals);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    test_rigid();
    test_flat();
    return 0;
}
