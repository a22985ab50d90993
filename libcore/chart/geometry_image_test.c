/*
 * Texels lie in the triangles that hold their centres, by a search of all; charts keep their distance; pointers lead
 * across and back, and turn directions as the side that they lead over has them; coordinates that are none are refused.
 */
#include "libcore/chart/atlas.h"
#include "libcore/chart/chart_fixture.h"
#include "libcore/chart/geometry_image.h"
#include "libcore/geodesic/transport/walk_fixture.h"

static MesoArena arena;

/* ---- texels ---- */

static bool holds(const MesoVec2 *uv, double x, double y, double depth)
{
    double area = meso_turn(uv[0], uv[1], uv[2]), sign = area < 0 ? -1 : 1;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec2 a = uv[k], b = uv[(k + 1) % 3];
        double cross = ((double)b.x - a.x) * (y - a.y) - ((double)b.y - a.y) * (x - a.x);
        if (!(sign * cross > depth * hypot((double)b.x - a.x, (double)b.y - a.y)))
            return false;
    }
    return true;
}

/* By all triangles, for a part of the texels. */
static void check_texels(const MesoGeometryImage *image, const MesoTriangulation *mesh, uint32_t step)
{
    for (uint32_t i = 0; i < image->size * image->size; i += step) {
        const MesoTexel *texel = &image->texels[i];
        double x = i % image->size + 0.5, y = i / image->size + 0.5;
        uint32_t holder = MESO_NO_INDEX;
        for (uint32_t t = 0; t < mesh->triangle_count; t++)
            if (holds(&image->uv[3 * t], x, y, 1e-4))
                holder = t;
        CHECK(holder == MESO_NO_INDEX || texel->triangle == holder);
        if (texel->triangle == MESO_NO_INDEX)
            continue;
        double place[2];
        meso_texel_place(image, i, place);
        CHECK(fmax(fabs(place[0] - x), fabs(place[1] - y)) < (holder == MESO_NO_INDEX ? 0.708 : 0) + 1e-3);
        MesoVec3 sum = {0, 0, 0};
        for (uint32_t k = 0; k < 3; k++) {
            CHECK(texel->weight[k] >= -1e-6f);
            sum = meso_vec3_mad(sum, texel->weight[k], mesh->positions[mesh->corners[3 * texel->triangle + k]]);
        }
        CHECK(meso_vec3_length(meso_vec3_sub(sum, texel->position)) < 1e-6f);
        CHECK(fabsf(meso_vec3_length(texel->normal) - 1) < 1e-5f);
        CHECK(fabsf(meso_vec3_length(texel->tangent) - 1) < 1e-5f);
        CHECK(fabsf(meso_vec3_dot(texel->normal, texel->tangent)) < 1e-4f);
    }
}

/* No texel of a chart has one of another beside it. */
static void check_gutters(const MesoGeometryImage *image)
{
    for (uint32_t y = 1; y + 1 < image->size; y++)
        for (uint32_t x = 1; x + 1 < image->size; x++) {
            uint32_t i = y * image->size + x, chart = meso_texel_chart(image, i);
            const uint32_t others[4] = {i + 1, i + image->size - 1, i + image->size, i + image->size + 1};
            for (uint32_t k = 0; k < 4 && chart != MESO_NO_INDEX; k++) {
                uint32_t other = meso_texel_chart(image, others[k]);
                CHECK(other == chart || other == MESO_NO_INDEX);
            }
        }
}

/* ---- pointers ---- */

static bool has_pointer(const MesoGeometryImage *image, uint32_t from, uint32_t to, uint32_t half_edge)
{
    for (uint32_t i = image->texels[from].pointer; i < image->pointer_count && image->pointers[i].from == from; i++)
        if (image->pointers[i].to == to && image->pointers[i].half_edge == half_edge)
            return true;
    return false;
}

static MesoComplex uv_along(const MesoGeometryImage *image, uint32_t from, uint32_t to)
{
    return meso_complex_unit((MesoComplex){(double)image->uv[to].x - image->uv[from].x,
                                           (double)image->uv[to].y - image->uv[from].y});
}

/* The side's own direction, and one out of the chart, which must lead into the other. */
static void check_turn(const MesoGeometryImage *image, const MesoTriangulation *mesh, const MesoTexelPointer *p)
{
    uint32_t h = p->half_edge, t = mesh->twins[h];
    bool alike = mesh->corners[h] != mesh->corners[t];
    MesoComplex along = uv_along(image, h, meso_next_corner(h)), out = uv_along(image, meso_previous_corner(h), h);
    MesoComplex there = uv_along(image, t, meso_next_corner(t)), in = uv_along(image, t, meso_previous_corner(t));
    MesoComplex turn = {p->turn[0], p->turn[1]};
    if (p->mirrored) {
        along = meso_complex_conjugate(along);
        out = meso_complex_conjugate(out);
    }
    along = meso_complex_times(along, turn);
    out = meso_complex_times(out, turn);
    CHECK(fabs(along.re * there.re + along.im * there.im - (alike ? -1 : 1)) < 1e-5);
    CHECK((there.re * out.im - there.im * out.re) * (there.re * in.im - there.im * in.re) >= -1e-5);
}

/* Returns the number of those that lead somewhere. `apart`: as many texels, at least, between the ends of none. */
static uint32_t check_pointers(const MesoGeometryImage *image, const MesoTriangulation *mesh, double apart)
{
    uint32_t count = 0;
    uint8_t *met = calloc(3 * mesh->triangle_count, 1);
    CHECK(met);
    for (uint32_t i = 0; i < image->pointer_count; i++) {
        const MesoTexelPointer *p = &image->pointers[i];
        CHECK(image->seams[p->half_edge / 3] >> p->half_edge % 3 & 1);
        CHECK(meso_texel_chart(image, p->from) == image->triangle_chart[p->half_edge / 3]);
        CHECK((p->to == MESO_NO_INDEX) == (mesh->twins[p->half_edge] == MESO_NO_INDEX));
        met[p->half_edge] = 1;
        if (p->to == MESO_NO_INDEX)
            continue;
        count++;
        CHECK(has_pointer(image, p->to, p->from, mesh->twins[p->half_edge]));
        MesoVec3 way = meso_vec3_sub(image->texels[p->to].position, image->texels[p->from].position);
        CHECK(meso_vec3_length(way) * image->texels_per_unit < apart);
        check_turn(image, mesh, p);
    }
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        CHECK(met[h] == (image->seams[h / 3] >> h % 3 & 1));
    free(met);
    return count;
}

/* ---- surfaces ---- */

static MesoGeometryImage image_of(const MesoTriangulation *mesh, uint32_t size, float radius)
{
    MesoAtlas atlas;
    MesoGeometryImage image;
    CHECK(meso_atlas_build(&atlas, &arena, mesh, &(MesoChartOptions){radius, 4, 4}, NULL) == MESO_OK);
    CHECK(meso_geometry_image_build(&image, &arena, mesh, atlas.corner_uv, NULL, size, NULL) == MESO_OK);
    CHECK(image.chart_count == atlas.chart_count);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        CHECK(image.triangle_chart[t] == image.triangle_chart[atlas.charts[atlas.triangle_chart[t]].triangles[0]]);
    return image;
}

static void test_atlases(void)
{
    MesoTriangulation meshes[4] = {meso_fixture_sphere(8, 0.3f, 3), meso_fixture_torus(40, 16, 0.3f),
                                   meso_fixture_cylinder(24, 30, 0.1f, false), meso_fixture_moebius()};
    for (uint32_t m = 0; m < 4; m++)
        for (uint32_t few = 0; few < 2; few++) {
            MesoGeometryImage image = image_of(&meshes[m], 1024, few ? 0 : 0.2f);
            check_texels(&image, &meshes[m], 997);
            check_gutters(&image);
            CHECK(check_pointers(&image, &meshes[m], 4) > 100);
        }
    for (uint32_t m = 0; m < 4; m++)
        meso_triangulation_release(&meshes[m]);
}

/* Charts of one triangle each, most of them smaller than a texel: all are there, and all can be left. */
static void test_small_charts(void)
{
    MesoTriangulation mesh = meso_fixture_sphere(10, 0.3f, 3);
    MesoGeometryImage image = image_of(&mesh, 2048, 1e-4f);
    CHECK(image.chart_count == mesh.triangle_count);
    check_pointers(&image, &mesh, 4);
    meso_triangulation_release(&mesh);
}

/* Two squares side by side, the second one's coordinates beside the first one's, mirrored, or on them. */
static void test_own_coordinates(void)
{
    MesoTriangulation mesh = meso_fixture_flat(2, 1, 1);
    MesoVec2 *uv = MESO_NEW(&arena, MesoVec2, 3 * mesh.triangle_count, NULL);
    MesoGeometryImage image;
    MesoError error;
    CHECK(uv && mesh.triangle_count == 4);
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        for (uint32_t c = 0; c < 12; c++) {
            uint32_t vertex = mesh.corners[c], row = vertex / 3;
            bool second = c >= 6;
            float x = (float)(vertex % 3) - (second ? 1 : 0);
            uv[c] = (MesoVec2){7 + (second ? 1.5f : 0) + (second && mirrored ? 1 - x : x), (float)row};
        }
        CHECK(meso_geometry_image_build(&image, &arena, &mesh, uv, NULL, 128, &error) == MESO_OK);
        CHECK(image.chart_count == 2);
        check_texels(&image, &mesh, 1);
        CHECK(check_pointers(&image, &mesh, 3) > 20);
        for (uint32_t i = 0; i < image.pointer_count; i++)
            CHECK(image.pointers[i].to == MESO_NO_INDEX || image.pointers[i].mirrored == mirrored);
    }
    for (uint32_t c = 6; c < 12; c++)
        uv[c].x -= 1.3f;
    CHECK(meso_geometry_image_build(&image, &arena, &mesh, uv, NULL, 128, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "have the same coordinates within"));
    uv[4].y = NAN;
    CHECK(meso_geometry_image_build(&image, &arena, &mesh, uv, NULL, 128, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "has coordinates that are no numbers"));
    CHECK(meso_geometry_image_build(&image, &arena, &mesh, uv, NULL, 15, &error) == MESO_ERR_USAGE);
    mesh.triangle_count = 0;
    CHECK(meso_geometry_image_build(&image, &arena, &mesh, uv, NULL, 16, &error) == MESO_OK);
    CHECK(image.chart_count == 0 && image.pointer_count == 0 && image.texels[0].triangle == MESO_NO_INDEX);
    meso_triangulation_release(&mesh);
}

int main(void)
{
    meso_arena_init(&arena);
    test_own_coordinates();
    test_atlases();
    test_small_charts();
    meso_arena_release(&arena);
    return 0;
}
