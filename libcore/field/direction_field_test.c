#include "libcore/chart/chart_fixture.h"
#include "libcore/field/direction_field.h"

static MesoArena arena;

static MesoDirectionField smooth(const MesoTriangulation *mesh, uint32_t symmetry, const MesoVec3 *guides,
                                 const float *weights)
{
    MesoDirectionField field;
    CHECK(meso_direction_field_smooth(&field, &arena, mesh, symmetry, guides, weights, NULL) == MESO_OK);
    CHECK(field.symmetry == symmetry);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = &mesh->corners[3 * t];
        MesoVec3 p = meso_vec3_sub(mesh->positions[c[1]], mesh->positions[c[0]]);
        MesoVec3 q = meso_vec3_sub(mesh->positions[c[2]], mesh->positions[c[0]]);
        MesoVec3 none = {0, 0, 0}, normal = meso_vec3_direction(meso_vec3_cross(p, q), none);
        CHECK(fabsf(meso_vec3_length(field.directions[t]) - 1) < 1e-5f);
        CHECK(fabsf(meso_vec3_dot(field.directions[t], normal)) < 1e-3f);
    }
    return field;
}

static float index_sum(const MesoDirectionField *field)
{
    float sum = 0;
    for (uint32_t i = 0; i < field->singularity_count; i++) {
        CHECK(i == 0 || field->singularities[i] > field->singularities[i - 1]);
        sum += field->indices[i];
    }
    return sum;
}

/* On a plane the field is one direction: the longest side of the box. */
static void test_plane(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(20, 12, 0.1f);
    meso_fixture_flip_sides(&mesh, 3, 2);
    for (uint32_t symmetry = 1; symmetry <= 4; symmetry *= 2) {
        MesoDirectionField field = smooth(&mesh, symmetry, NULL, NULL);
        CHECK(field.singularity_count == 0);
        for (uint32_t t = 0; t < mesh.triangle_count; t++) {
            MesoVec3 d = field.directions[t];
            CHECK(meso_vec3_dot(d, field.directions[0]) > 0.99999f);
            CHECK(fmaxf(fabsf(d.x), symmetry == 4 ? fabsf(d.y) : 0) > 0.99999f && (symmetry > 1 || d.x > 0));
        }
    }
    meso_triangulation_release(&mesh);
}

/* On a tube it is the same along the axis everywhere, or across it. */
static void test_tube(void)
{
    MesoTriangulation mesh = meso_fixture_cylinder(24, 40, 0.1f, true);
    for (uint32_t symmetry = 1; symmetry <= 4; symmetry *= 2) {
        MesoDirectionField field = smooth(&mesh, symmetry, NULL, NULL);
        CHECK(field.singularity_count == 0);
        for (uint32_t t = 0; t < mesh.triangle_count; t++) {
            float along = fabsf(field.directions[t].z);
            CHECK(along > 0.999f || (symmetry == 4 && along < 0.03f));
            CHECK(fabsf(along - fabsf(field.directions[0].z)) < 1e-3f);
        }
    }
    meso_triangulation_release(&mesh);
}

/* Guides that are a sixth of a turn apart become one direction. */
static void test_combed(void)
{
    MesoTriangulation mesh = meso_fixture_cylinder(24, 40, 0.1f, true);
    MesoVec3 *guides = MESO_NEW(&arena, MesoVec3, mesh.triangle_count, NULL);
    float *weights = MESO_NEW(&arena, float, mesh.triangle_count, NULL);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {    /* a sixth of a turn more, from one to the next */
        MesoVec3 a = mesh.positions[mesh.corners[3 * (size_t)t]], across = {-a.y, a.x, 0};
        double angle = MESO_PI / 3 * (t % 6);
        guides[t] = meso_vec3_scale(meso_vec3_unit(across, (MesoVec3){1, 0, 0}), (float)sin(angle));
        guides[t].z = (float)cos(angle);
        weights[t] = 1;
    }
    MesoDirectionField field = smooth(&mesh, 6, guides, weights);
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        CHECK(fabsf(field.directions[t].z - field.directions[0].z) < 0.2f);
    meso_triangulation_release(&mesh);
}

/* Poincare and Hopf: indices add up to Euler's number, whatever the guides. */
static void check_closed(const MesoTriangulation *mesh, float euler, uint32_t most)
{
    static const uint32_t symmetries[] = {1, 2, 3, 4, 6};
    MesoRandom random;
    MesoVec3 *guides = MESO_NEW(&arena, MesoVec3, mesh->triangle_count, NULL);
    float *weights = MESO_NEW(&arena, float, mesh->triangle_count, NULL);
    meso_random_init(&random, 9, 0);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        guides[t] = (MesoVec3){meso_fixture_signed(&random), meso_fixture_signed(&random),
                               meso_fixture_signed(&random)};
        weights[t] = meso_random_below(&random, 4) ? 0 : 2;
    }
    for (size_t i = 0; i < sizeof symmetries / sizeof *symmetries; i++) {
        uint32_t symmetry = symmetries[i];
        float rounding = symmetry % 3 ? 0 : 1e-3f;      /* of sums of thirds */
        MesoDirectionField field = smooth(mesh, symmetry, NULL, NULL);
        CHECK(fabsf(index_sum(&field) - euler) <= rounding);
        CHECK(symmetry > 4 || field.singularity_count <= most * symmetry);
        field = smooth(mesh, symmetry, guides, weights);
        CHECK(fabsf(index_sum(&field) - euler) <= rounding && field.singularity_count > most * symmetry);
    }
}

/* Both of two meshes, apart from each other. */
static MesoTriangulation both(const MesoTriangulation *a, const MesoTriangulation *b)
{
    uint32_t vertex_count = a->vertex_count + b->vertex_count, triangle_count = a->triangle_count + b->triangle_count;
    MesoVec3 *positions = MESO_NEW(&arena, MesoVec3, vertex_count, NULL);
    uint32_t *corners = MESO_NEW(&arena, uint32_t, 3 * triangle_count, NULL);
    for (uint32_t v = 0; v < vertex_count; v++)
        positions[v] = v < a->vertex_count ? a->positions[v] : b->positions[v - a->vertex_count];
    for (uint32_t c = 0; c < 3 * triangle_count; c++)
        corners[c] = c < 3 * a->triangle_count ? a->corners[c]
                                               : a->vertex_count + b->corners[c - 3 * a->triangle_count];
    return meso_fixture_triangulation(positions, vertex_count, corners, triangle_count);
}

static void test_closed(void)
{
    MesoTriangulation sphere = meso_fixture_sphere(6, 0.3f, 3), torus = meso_fixture_torus(24, 12, 0.4f);
    check_closed(&sphere, 2, 2);
    check_closed(&torus, 0, 2);
    MesoTriangulation pair = both(&sphere, &torus);
    check_closed(&pair, 2, 4);
    /* each part has the field that it has by itself, as far as that is told apart from others */
    CHECK(smooth(&torus, 1, NULL, NULL).singularity_count == 0);
    MesoDirectionField field = smooth(&torus, 2, NULL, NULL), of_pair = smooth(&pair, 2, NULL, NULL);
    for (uint32_t t = 0; t < torus.triangle_count; t++) {
        MesoVec3 a = field.directions[t], b = of_pair.directions[sphere.triangle_count + t];
        CHECK(fabsf(meso_vec3_dot(a, b)) > 0.99f);
    }
    meso_triangulation_release(&sphere);
    meso_triangulation_release(&torus);
    meso_triangulation_release(&pair);
}

/* One guide turns a plane; two at its ends are met, and between them lies what is between. */
static void test_guides(void)
{
    MesoTriangulation mesh = meso_fixture_sheet(40, 6, 0.1f);
    MesoVec3 *guides = MESO_NEW(&arena, MesoVec3, mesh.triangle_count, NULL);
    float *weights = MESO_NEW(&arena, float, mesh.triangle_count, NULL);
    guides[100] = (MesoVec3){-0.3f, 0.4f, 7};
    weights[100] = 1e-3f;
    for (uint32_t symmetry = 1; symmetry <= 4; symmetry *= 2) {
        MesoDirectionField field = smooth(&mesh, symmetry, guides, weights);
        for (uint32_t t = 0; t < mesh.triangle_count; t++)
            CHECK(fabsf(field.directions[t].x + 0.6f) < 1e-3f && fabsf(field.directions[t].y - 0.8f) < 1e-3f);
    }
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        uint32_t column = t / 2 % 40;
        weights[t] = column == 0 || column == 39 ? 1000 : 0;
        guides[t] = column == 0 ? (MesoVec3){1, 0, 0} : (MesoVec3){0.6f, 0.8f, 0};
    }
    MesoDirectionField field = smooth(&mesh, 1, guides, weights);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        float x = mesh.positions[mesh.corners[3 * t]].x / 4;
        float angle = atan2f(field.directions[t].y, field.directions[t].x);
        CHECK(fabsf(angle - 0.9273f * x) < 0.06f);
    }
    weights[5] = NAN;
    MesoError error;
    CHECK(meso_direction_field_smooth(&field, &arena, &mesh, 1, guides, weights, &error) == MESO_ERR_INPUT);
    meso_triangulation_release(&mesh);
}

/* No direction depends on the unit. */
static void test_sizes(void)
{
    MesoTriangulation mesh = meso_fixture_bumpy(12, 12, 0.5f);
    MesoDirectionField field = smooth(&mesh, 4, NULL, NULL);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        mesh.positions[v] = meso_vec3_scale(mesh.positions[v], 0x1p-60f);
    MesoDirectionField small = smooth(&mesh, 4, NULL, NULL);
    for (uint32_t t = 0; t < mesh.triangle_count; t++)
        CHECK(meso_vec3_dot(field.directions[t], small.directions[t]) > 0.9999f);
    meso_triangulation_release(&mesh);
}

/* A triangle alone, one without area, a band with half a turn, nothing. */
static void test_least(void)
{
    const uint32_t corners[3] = {0, 1, 2};
    MesoVec3 positions[5] = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    MesoTriangulation mesh = meso_fixture_triangulation(positions, 3, corners, 1);
    CHECK(smooth(&mesh, 1, NULL, NULL).directions[0].y > 0.9999f);
    mesh.positions[2] = mesh.positions[1];
    smooth(&mesh, 4, NULL, NULL);
    mesh.positions[1] = mesh.positions[2] = mesh.positions[0];
    smooth(&mesh, 4, NULL, NULL);
    mesh.triangle_count = 0;
    CHECK(smooth(&mesh, 4, NULL, NULL).singularity_count == 0);
    meso_triangulation_release(&mesh);
    uint32_t band_corners[15];
    for (uint32_t v = 0; v < 5; v++) {
        float a = 6.2831853f * (float)v / 5;
        positions[v] = (MesoVec3){cosf(2 * a), sinf(2 * a), 0.3f * (float)v};
        for (uint32_t k = 0; k < 3; k++)
            band_corners[3 * v + k] = (v + k) % 5;
    }
    MesoTriangulation band = meso_fixture_triangulation(positions, 5, band_corners, 5);
    CHECK(smooth(&band, 2, NULL, NULL).singularity_count == 0);
    meso_triangulation_release(&band);
}

/* ---- curvature ---- */

typedef struct Principal {
    MesoVec3 *directions;
    float *weights;
} Principal;

static Principal principal(const MesoTriangulation *mesh)
{
    Principal p = {MESO_NEW(&arena, MesoVec3, mesh->triangle_count, NULL),
                   MESO_NEW(&arena, float, mesh->triangle_count, NULL)};
    CHECK(meso_principal_directions(p.directions, p.weights, &arena, mesh, NULL) == MESO_OK);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        CHECK(fabsf(meso_vec3_length(p.directions[t]) - 1) < 1e-5f);
        CHECK(p.weights[t] >= 0 && p.weights[t] <= 1);
    }
    return p;
}

static MesoVec3 centre_of(const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *c = &mesh->corners[3 * triangle];
    MesoVec3 sum = meso_vec3_add(meso_vec3_add(mesh->positions[c[0]], mesh->positions[c[1]]), mesh->positions[c[2]]);
    return meso_vec3_scale(sum, 1.0f / 3);
}

/* Around a tube, and marked as nothing can be more. */
static void test_curved_tube(void)
{
    MesoTriangulation mesh = meso_fixture_cylinder(48, 30, 0.1f, false);
    Principal p = principal(&mesh);
    double sum = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        bool inside = t / 96 > 1 && t / 96 < 28;
        CHECK(!inside || (fabsf(p.directions[t].z) < 0.15f && p.weights[t] > 0.7f));
        sum += fabs(p.directions[t].z);
    }
    CHECK(sum / mesh.triangle_count < 0.03);
    meso_triangulation_release(&mesh);
}

/* Around the tube of a torus: 1 / r there, cos a / (1 + r cos a) across. */
static void test_curved_torus(void)
{
    const float r = 0.3f;
    MesoTriangulation mesh = meso_fixture_torus(120, 48, r);
    Principal p = principal(&mesh);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        MesoVec3 c = centre_of(&mesh, t);
        float ring = sqrtf(c.x * c.x + c.y * c.y);
        MesoVec3 around = {-c.y / ring, c.x / ring, 0};
        float other = fabsf((ring - 1) / r / ring);
        CHECK(fabsf(meso_vec3_dot(p.directions[t], around)) < 0.05f);
        CHECK(fabsf(p.weights[t] - (1 / r - other) / (1 / r + other)) < 0.05f);
    }
    meso_triangulation_release(&mesh);
}

/* Nothing is marked on planes and spheres, nor where a saddle bends alike both ways. */
static void test_unmarked(void)
{
    MesoTriangulation plane = meso_fixture_flat(12, 12, 0.1f), sphere = meso_fixture_sphere(16, 0.2f, 4);
    Principal p = principal(&plane);
    for (uint32_t t = 0; t < plane.triangle_count; t++)
        CHECK(p.weights[t] == 0);
    p = principal(&sphere);
    double sum = 0;
    for (uint32_t t = 0; t < sphere.triangle_count; t++)
        sum += p.weights[t];
    CHECK(sum / sphere.triangle_count < 0.05);
    MesoTriangulation saddle = meso_fixture_sheet(20, 20, 0.1f);
    for (uint32_t v = 0; v < saddle.vertex_count; v++) {
        MesoVec3 *at = &saddle.positions[v];
        at->z = 0.3f * ((at->x - 1) * (at->x - 1) - (at->y - 1) * (at->y - 1));
    }
    p = principal(&saddle);
    CHECK(p.weights[2 * (20 * 10 + 10)] < 0.1f);
    meso_triangulation_release(&plane);
    meso_triangulation_release(&sphere);
    meso_triangulation_release(&saddle);
}

/* What curvature marks guides a field: around the tube, combed, without a singularity. */
static void test_guided_by_curvature(void)
{
    MesoTriangulation mesh = meso_fixture_torus(60, 24, 0.3f);
    Principal p = principal(&mesh);
    MesoDirectionField field = smooth(&mesh, 2, p.directions, p.weights);
    CHECK(field.singularity_count == 0);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        CHECK(fabsf(meso_vec3_dot(field.directions[t], p.directions[t])) > 0.98f);
        for (uint32_t k = 0; k < 3; k++)
            CHECK(meso_vec3_dot(field.directions[t], field.directions[mesh.twins[3 * t + k] / 3]) > 0.5f);
    }
    meso_triangulation_release(&mesh);
}

int main(void)
{
    meso_arena_init(&arena);
    test_plane();
    test_tube();
    test_combed();
    test_closed();
    test_guides();
    test_sizes();
    test_least();
    test_curved_tube();
    test_curved_torus();
    test_unmarked();
    test_guided_by_curvature();
    meso_arena_release(&arena);
    return 0;
}
