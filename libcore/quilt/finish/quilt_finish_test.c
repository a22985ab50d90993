#include "libcore/quilt/finish/finish_work.h"

#include <string.h>

#include "libcore/mesh/cut/triangulation_fixture.h"

/* A bar along x of square section, open at its ends, and a higher octahedron: what the quilts here are made of. */
enum { RINGS = 41 };
#define BAR_LENGTH 8.0f
#define BAR_SIDE 0.2f

static MesoSwatch make_swatch(MesoArena *arena)
{
    MesoError error;
    MesoPolygonMesh mesh = {.vertex_count = 4 * RINGS + 6, .face_count = 8 * (RINGS - 1) + 8, .side_count = 3};
    mesh.corner_count = 3 * mesh.face_count;
    mesh.positions = MESO_NEW(arena, MesoVec3, mesh.vertex_count, &error);
    mesh.corners = MESO_NEW(arena, uint32_t, mesh.corner_count, &error);
    mesh.attributes = MESO_NEW(arena, MesoAttribute, 0, &error);
    CHECK(mesh.positions && mesh.corners && mesh.attributes);
    const float s = BAR_SIDE / 2, square[4][2] = {{-s, -s}, {s, -s}, {s, s}, {-s, s}};
    uint32_t n = 0;
    for (uint32_t i = 0; i < RINGS; i++)
        for (uint32_t k = 0; k < 4; k++)
            mesh.positions[4 * i + k] = (MesoVec3){BAR_LENGTH * (float)i / (RINGS - 1), 2 + square[k][0],
                                                   square[k][1]};
    for (uint32_t i = 0; i + 1 < RINGS; i++)
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t a = 4 * i + k, b = 4 * i + (k + 1) % 4, quad[6] = {a, a + 4, b + 4, a, b + 4, b};
            memcpy(&mesh.corners[n], quad, sizeof quad);
            n += 6;
        }
    uint32_t first = 4 * RINGS;
    for (uint32_t k = 0; k < 6; k++) {
        float r = k % 2 ? -0.1f : 0.1f;
        uint32_t axis = k / 2;
        mesh.positions[first + k] = (MesoVec3){axis == 0 ? 4 + r : 4, axis == 1 ? 3 + r : 3,
                                                axis == 2 ? 0.3f + r : 0.3f};
    }
    for (uint32_t k = 0; k < 8; k++) {
        uint32_t x = first + (k & 1), y = first + 2 + (k >> 1 & 1), z = first + 4 + (k >> 2 & 1);
        bool even = ((k & 1) + (k >> 1 & 1) + (k >> 2 & 1)) % 2 == 0;
        uint32_t face[3] = {x, even ? y : z, even ? z : y};
        memcpy(&mesh.corners[n], face, sizeof face);
        n += 3;
    }
    MesoSwatch swatch;
    CHECK(meso_polygon_mesh_check(&mesh, 1, NULL, &error) == MESO_OK);
    CHECK(meso_swatch_build(&swatch, arena, &mesh, &(MesoSwatchOptions){.up = 2}, &error) == MESO_OK);
    CHECK(swatch.element_count == 2 && swatch.kinds[0] == MESO_ELEMENT_STRAND && swatch.loop_count == 2);
    return swatch;
}

/* ---- quilts by hand ---- */

/* The place under a point of a flat base. */
static MesoQuiltVertex place_at(const MesoTriangulation *mesh, MesoVec3 p)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = &mesh->corners[3 * (size_t)t];
        MesoVec3 o = mesh->positions[c[0]], a = meso_vec3_sub(mesh->positions[c[1]], o);
        MesoVec3 b = meso_vec3_sub(mesh->positions[c[2]], o), q = meso_vec3_sub(p, o);
        float area = a.x * b.y - a.y * b.x, u = (q.x * b.y - q.y * b.x) / area, v = (a.x * q.y - a.y * q.x) / area;
        if (u >= -1e-5f && v >= -1e-5f && u + v <= 1.00002f)
            return (MesoQuiltVertex){t, u, v, p.z};
    }
    fprintf(stderr, "a point is off the base\n");
    exit(1);
}

/* Rings `from` to `to` of the bar, or (to 0) the octahedron, moved. */
typedef struct Copy {
    uint32_t from, to;
    MesoVec3 move;
} Copy;

static MesoQuilt lay_out(MesoArena *arena, const MesoSwatch *swatch, const MesoTriangulation *mesh, const Copy *copies,
                         uint32_t count)
{
    MesoError error;
    MesoQuilt q = {.element_count = count};
    uint32_t room = 12 * RINGS * count;
    q.vertices = MESO_NEW(arena, MesoQuiltVertex, room, &error);
    q.origins = MESO_NEW(arena, uint32_t, room, &error);
    q.corners = MESO_NEW(arena, uint32_t, 3 * (size_t)room, &error);
    q.triangle_origins = MESO_NEW(arena, uint32_t, room, &error);
    q.patches = MESO_NEW(arena, uint32_t, room, &error);
    q.vertex_begin = MESO_NEW(arena, uint32_t, count + 1, &error);
    q.triangle_begin = MESO_NEW(arena, uint32_t, count + 1, &error);
    q.element_origins = MESO_NEW(arena, uint32_t, count, &error);
    for (uint32_t e = 0; e < count; e++) {
        uint32_t from = copies[e].to ? 4 * copies[e].from : 4 * RINGS;
        uint32_t to = copies[e].to ? 4 * copies[e].to + 4 : 4 * RINGS + 6, first = q.vertex_count;
        for (uint32_t v = from; v < to; v++) {
            MesoVec3 p = meso_vec3_add(swatch->positions[v], copies[e].move);
            q.origins[q.vertex_count] = v;
            q.vertices[q.vertex_count++] = place_at(mesh, p);
        }
        for (uint32_t t = 0; t < swatch->triangle_count; t++) {
            const uint32_t *c = &swatch->corners[3 * (size_t)t];
            if (c[0] < from || c[1] < from || c[2] < from || c[0] >= to || c[1] >= to || c[2] >= to)
                continue;
            for (uint32_t k = 0; k < 3; k++)
                q.corners[3 * q.triangle_count + k] = c[k] - from + first;
            q.triangle_origins[q.triangle_count] = t;
            q.patches[q.triangle_count++] = e;
        }
        q.element_origins[e] = copies[e].to ? 0 : 1;
        q.vertex_begin[e + 1] = q.vertex_count;
        q.triangle_begin[e + 1] = q.triangle_count;
    }
    return q;
}

/* ---- what comes out ---- */

/* Open half-edges; no edge is used twice in one direction, and elements own what they use. */
static uint32_t count_open(const MesoQuilt *q)
{
    uint32_t open = 0;
    for (uint32_t e = 0; e < q->element_count; e++) {
        uint32_t begin = 3 * q->triangle_begin[e], end = 3 * q->triangle_begin[e + 1];
        for (uint32_t h = begin; h < end; h++) {
            uint32_t a = q->corners[h], b = q->corners[meso_next_corner(h)], along = 0, against = 0;
            CHECK(a >= q->vertex_begin[e] && a < q->vertex_begin[e + 1]);
            for (uint32_t g = begin; g < end; g++) {
                along += q->corners[g] == a && q->corners[meso_next_corner(g)] == b;
                against += q->corners[g] == b && q->corners[meso_next_corner(g)] == a;
            }
            CHECK(along == 1 && against <= 1);
            open += against == 0;
        }
    }
    return open;
}

static MesoVec3 point_of(const MesoTriangulation *original, MesoQuiltVertex v)
{
    const uint32_t *c = &original->corners[3 * (size_t)v.triangle];
    MesoVec3 p = meso_vec3_scale(original->positions[c[0]], 1 - v.b1 - v.b2);
    p = meso_vec3_mad(p, v.b1, original->positions[c[1]]);
    p = meso_vec3_mad(p, v.b2, original->positions[c[2]]);
    p.z += v.height;    /* of flat ones alone */
    return p;
}

static double area_of(const MesoQuilt *q, const MesoTriangulation *original, uint32_t element, double *volume)
{
    double area = 0;
    *volume = 0;
    for (uint32_t t = q->triangle_begin[element]; t < q->triangle_begin[element + 1]; t++) {
        MesoVec3 a = point_of(original, q->vertices[q->corners[3 * t]]);
        MesoVec3 b = point_of(original, q->vertices[q->corners[3 * t + 1]]);
        MesoVec3 c = point_of(original, q->vertices[q->corners[3 * t + 2]]);
        MesoVec3 n = meso_vec3_cross(meso_vec3_sub(b, a), meso_vec3_sub(c, a));
        area += 0.5 * meso_vec3_length(n);
        *volume += meso_vec3_dot(n, a) / 6;
    }
    return area;
}

/* Over a plane of 4 by 4 with the bar from -2 to 6. */
static void test_plane(bool open_borders)
{
    MesoArena arena;
    MesoError error = {0};
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena);
    for (uint32_t squares = 1; squares <= 4; squares *= 2) {
        MesoTriangulation plane = meso_fixture_sheet(squares, squares, 4 / (float)squares);
        MesoQuiltBase base;
        CHECK(meso_quilt_base_build(&base, &arena, &plane, NULL, 0.5f, 2.5f, &error) == MESO_OK);
        float x = swatch.positions[0].x, y = swatch.positions[0].y + BAR_SIDE / 2;  /* where the bar is */
        float ox = 0.5f * (swatch.positions[4 * RINGS].x + swatch.positions[4 * RINGS + 1].x);
        float oy = 0.5f * (swatch.positions[4 * RINGS + 2].y + swatch.positions[4 * RINGS + 3].y);
        Copy copies[] = {
            {0, RINGS - 1, {-2 - x, 1.3f - y, 0}},      /* across both borders */
            {0, 0, {2 - ox, 3 - oy, 0}},                /* inside, across one, and beyond */
            {0, 0, {2 - ox, 4.05f - oy, 0}},
            {0, 0, {2 - ox, 5 - oy, 0}},
            {10, 20, {1 - x - 2, 2.2f - y, 0}},         /* inside, with ragged ends */
            {0, 9, {3.92f - x, 3.3f - y, 0}},           /* beyond but for a stub */
        };
        MesoQuilt q = lay_out(&arena, &swatch, &base.mesh, copies, 6);
        MesoFinishOptions options = {.scale = 1, .open_borders = open_borders};
        CHECK(meso_quilt_finish(&q, &arena, &base, &swatch, &options, &error) == MESO_OK);
        CHECK(q.element_count == 3 && q.report.debris_count == 1 && q.report.border_removed_count == 1);
        CHECK(q.element_origins[0] == 0 && q.element_origins[1] == 1 && q.element_origins[2] == 0);
        CHECK(q.report.border_count == 3 && q.report.closed_count == (open_borders ? 3 : 6));
        CHECK(q.report.open_count == (open_borders ? 3 : 0));
        uint32_t open = count_open(&q);
        CHECK(open_borders ? open >= 8 : open == 0);
        double volume, section = BAR_SIDE * BAR_SIDE, area = area_of(&q, &plane, 0, &volume);
        CHECK(fabs(area - 4 * (4 * BAR_SIDE) - (open_borders ? 0 : 2 * section)) < 1e-3);
        CHECK(open_borders || fabs(volume - 4 * section) < 1e-3);
        area = area_of(&q, &plane, 2, &volume);
        CHECK(fabs(area - 2 * (4 * BAR_SIDE) - 2 * section) < 1e-3 && fabs(volume - 2 * section) < 1e-3);
        for (uint32_t v = 0; v < q.vertex_count; v++) {
            MesoQuiltVertex p = q.vertices[v];
            CHECK(p.triangle < plane.triangle_count && p.b1 > -1e-5f && p.b2 > -1e-5f && p.b1 + p.b2 < 1.00001f);
        }
        meso_quilt_base_release(&base);
        meso_triangulation_release(&plane);
    }
    meso_arena_release(&arena);
}

/* Without borders nothing is cut; with overhang whole elements may stand across one. */
static void test_wholes(void)
{
    MesoArena arena;
    MesoError error = {0};
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena);
    MesoTriangulation plane = meso_fixture_sheet(1, 1, 4);
    MesoQuiltBase base;
    CHECK(meso_quilt_base_build(&base, &arena, &plane, NULL, 0.5f, 2, &error) == MESO_OK);
    float ox = 0.5f * (swatch.positions[4 * RINGS].x + swatch.positions[4 * RINGS + 1].x);
    float oy = 0.5f * (swatch.positions[4 * RINGS + 2].y + swatch.positions[4 * RINGS + 3].y);
    Copy copies[] = {{0, 0, {2 - ox, 3.95f - oy, 0}}, {0, 0, {1 - ox, 3.85f - oy, 0}}};
    for (int overhang = 0; overhang < 2; overhang++) {
        MesoQuilt q = lay_out(&arena, &swatch, &base.mesh, copies, 2);
        MesoFinishOptions options = {.overhang = overhang ? 0.06f : 0};
        CHECK(meso_quilt_finish(&q, &arena, &base, &swatch, &options, &error) == MESO_OK);
        CHECK(q.element_count == 1 + (uint32_t)overhang && q.report.border_removed_count == 1 - (uint32_t)overhang);
        for (uint32_t e = 0; e < q.element_count; e++) {
            double volume;
            area_of(&q, &plane, e, &volume);
            CHECK(fabs(volume - 4.0 / 3 * 0.001) < 1e-5);
        }
    }
    MesoQuilt none = lay_out(&arena, &swatch, &base.mesh, copies, 0);
    CHECK(meso_quilt_finish(&none, &arena, &base, &swatch, &(MesoFinishOptions){0}, &error) == MESO_OK);
    CHECK(none.element_count == 0 && none.triangle_count == 0);
    meso_quilt_base_release(&base);
    meso_triangulation_release(&plane);
    meso_arena_release(&arena);
}

/* A base or a surface that is flat comes to have borders that bend. */
static void bend_borders(MesoTriangulation *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float x = mesh->positions[v].x - 2;
        mesh->positions[v].y += 0.2f * x * x;
    }
}

/* Edges between triangles of different patches. */
static uint32_t count_seams(const MesoQuilt *q)
{
    uint32_t count = 0;
    for (uint32_t h = 0; h < 3 * q->triangle_count; h++)
        for (uint32_t g = 0; g < h; g++) {
            uint32_t h_next = h % 3 == 2 ? h - 2 : h + 1, g_next = g % 3 == 2 ? g - 2 : g + 1;
            count += q->corners[h] == q->corners[g_next] && q->corners[h_next] == q->corners[g] &&
                     q->patches[h / 3] != q->patches[g / 3];
        }
    return count;
}

/* A bar that lies along a border, half of it outside: what is left has a cap that follows the border. */
static void test_along_border(void)
{
    MesoArena arena;
    MesoError error = {0};
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena);
    MesoTriangulation plane = meso_fixture_sheet(16, 16, 0.25f);
    MesoQuiltBase base;
    CHECK(meso_quilt_base_build(&base, &arena, &plane, NULL, 0.5f, 2.5f, &error) == MESO_OK);
    const Copy bar = {0, RINGS - 1, {-2 - swatch.positions[0].x, 3.9f - swatch.positions[0].y, 0}};
    MesoQuilt q = lay_out(&arena, &swatch, &base.mesh, &bar, 1);
    for (uint32_t t = 0; t < q.triangle_count; t++)     /* of three patches, one after the other */
        q.patches[t] = 3 * t / q.triangle_count;
    uint32_t seams = count_seams(&q);
    bend_borders(&plane);
    bend_borders(&base.mesh);
    CHECK(meso_quilt_finish(&q, &arena, &base, &swatch, &(MesoFinishOptions){0}, &error) == MESO_OK);
    CHECK(q.element_count == 1 && count_open(&q) == 0);
    CHECK(seams > 0 && count_seams(&q) <= seams + 4);   /* the cap goes on as the bar does */
    double volume, area = area_of(&q, &plane, 0, &volume), length = 0;
    for (uint32_t i = 0; i < 16; i++)
        length += hypot(0.25, 0.2 * (pow(0.25 * i - 1.75, 2) - pow(0.25 * i - 2, 2)));
    CHECK(fabs(volume - 4 * BAR_SIDE * BAR_SIDE / 2) < 0.005);      /* rings and borders bend at other places */
    CHECK(fabs(area - length * 3 * BAR_SIDE) < 0.1 * area);     /* two sides half as wide, one, the cap, and ends */
    meso_quilt_base_release(&base);
    meso_triangulation_release(&plane);
    meso_arena_release(&arena);
}

/* How far vertices are from the heights of the swatch, on the mean. */
static double mean_rise(const MesoQuilt *q, const MesoSwatch *swatch)
{
    double sum = 0;
    for (uint32_t v = 0; v < q->vertex_count; v++)
        sum += fabs((double)q->vertices[v].height - (double)swatch->positions[q->origins[v]].z);
    return sum / q->vertex_count;
}

/* A bar that rises along its way, as over many patches, comes back down; and one in waves, as long as patches. */
static void test_level(void)
{
    MesoArena arena;
    MesoError error = {0};
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena);
    MesoTriangulation plane = meso_fixture_sheet(2, 2, 4);
    MesoQuiltBase base;
    CHECK(meso_quilt_base_build(&base, &arena, &plane, NULL, 0.5f, 2.5f, &error) == MESO_OK);
    const Copy bar = {0, RINGS - 1, {-2 - swatch.positions[0].x, 1.3f - swatch.positions[0].y, 0}};
    for (int i = 0; i < 4; i++) {
        bool level = i % 2, waves = i / 2;
        MesoQuilt q = lay_out(&arena, &swatch, &base.mesh, &bar, 1);
        for (uint32_t v = 0; v < q.vertex_count; v++) {
            float along = (float)v / (float)q.vertex_count;
            q.vertices[v].height += waves ? 0.5f * sinf(4 * (float)MESO_PI * along) : 0.5f * along;
        }
        const MesoFinishOptions options = {.scale = level ? 1 : 0};
        CHECK(meso_quilt_finish(&q, &arena, &base, &swatch, &options, &error) == MESO_OK);
        CHECK(!level || mean_rise(&q, &swatch) < (waves ? 0.12 : 0.05));
        CHECK(level || mean_rise(&q, &swatch) > 0.2);
    }
    meso_quilt_base_release(&base);
    meso_triangulation_release(&plane);
    meso_arena_release(&arena);
}

/* An element that stands too high beside a bar comes down as it is. */
static void test_whole_level(void)
{
    MesoArena arena;
    MesoError error = {0};
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena);
    MesoTriangulation plane = meso_fixture_sheet(2, 2, 4);
    MesoQuiltBase base;
    CHECK(meso_quilt_base_build(&base, &arena, &plane, NULL, 0.5f, 2.5f, &error) == MESO_OK);
    const MesoVec3 move = {-2 - swatch.positions[0].x, 1.3f - swatch.positions[0].y, 0};
    const Copy copies[2] = {{0, RINGS - 1, move}, {0, 0, move}};
    MesoQuilt q = lay_out(&arena, &swatch, &base.mesh, copies, 2);
    const float middle = swatch.centres[1].z;
    for (uint32_t v = q.vertex_begin[1]; v < q.vertex_count; v++)
        q.vertices[v].height += 0.2f + 0.1f * (swatch.positions[q.origins[v]].z - middle);
    CHECK(meso_quilt_finish(&q, &arena, &base, &swatch, &(MesoFinishOptions){.scale = 1}, &error) == MESO_OK);
    CHECK(q.element_count == 2);
    for (uint32_t v = q.vertex_begin[1]; v < q.vertex_count; v++) {
        float above = swatch.positions[q.origins[v]].z - middle;
        CHECK(fabsf(q.vertices[v].height - middle - 1.1f * above) < 1e-5f);
    }
    meso_quilt_base_release(&base);
    meso_triangulation_release(&plane);
    meso_arena_release(&arena);
}

/* The mean place of an element's vertices within a distance of a point. */
static MesoVec3 middle_near(const MesoQuilt *q, const MesoTriangulation *plane, uint32_t element, MesoVec3 near,
                            float most)
{
    MesoVec3 sum = {0, 0, 0};
    float count = 0;
    for (uint32_t v = q->vertex_begin[element]; v < q->vertex_begin[element + 1]; v++) {
        MesoVec3 p = point_of(plane, q->vertices[v]);
        if (hypotf(p.x - near.x, p.y - near.y) > most)
            continue;
        sum = meso_vec3_add(sum, p);
        count++;
    }
    CHECK(count > 0);
    return meso_vec3_scale(sum, 1 / count);
}

/* Turns an element by a quarter about a point. */
static void turn(MesoQuilt *q, const MesoTriangulation *mesh, uint32_t element, MesoVec3 about)
{
    for (uint32_t v = q->vertex_begin[element]; v < q->vertex_begin[element + 1]; v++) {
        MesoVec3 p = meso_vec3_sub(point_of(mesh, q->vertices[v]), about);
        q->vertices[v] = place_at(mesh, meso_vec3_add(about, (MesoVec3){-p.y, p.x, p.z}));
    }
}

/* Bars through each other go over and under; bars in each other lie side by side. Elsewhere they stay. */
static void test_part(void)
{
    MesoArena arena;
    MesoError error = {0};
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena);
    MesoTriangulation plane = meso_fixture_sheet(2, 2, 4);
    MesoQuiltBase base;
    CHECK(meso_quilt_base_build(&base, &arena, &plane, NULL, 0.5f, 2.5f, &error) == MESO_OK);
    MesoVec3 at = meso_vec3_add(swatch.positions[0], (MesoVec3){0, BAR_SIDE / 2, BAR_SIDE / 2});
    const MesoFinishOptions options = {.scale = 1, .offset = -1};
    const MesoVec3 middle = {2, 2, 0}, move = {-2 - at.x, 2 - at.y, -0.7f};
    const Copy across[] = {{0, RINGS - 1, move}, {0, RINGS - 1, move}};
    MesoQuilt q = lay_out(&arena, &swatch, &base.mesh, across, 2);
    turn(&q, &base.mesh, 1, middle);
    CHECK(meso_quilt_finish(&q, &arena, &base, &swatch, &options, &error) == MESO_OK && q.element_count == 2);
    MesoVec3 a = middle_near(&q, &plane, 0, middle, 0.25f);
    MesoVec3 b = middle_near(&q, &plane, 1, middle, 0.25f);
    MesoVec3 far = middle_near(&q, &plane, 0, (MesoVec3){0.5f, 2, 0}, 0.3f);
    CHECK(fabsf(a.z - b.z) > 0.16f && fabsf(far.z + 0.9f) < 0.02f);
    const Copy beside[] = {{0, RINGS - 1, move}, {0, RINGS - 1, meso_vec3_add(move, (MesoVec3){0, 0.1f, 0})}};
    q = lay_out(&arena, &swatch, &base.mesh, beside, 2);
    CHECK(meso_quilt_finish(&q, &arena, &base, &swatch, &options, &error) == MESO_OK && q.element_count == 2);
    a = middle_near(&q, &plane, 0, middle, 0.4f);
    b = middle_near(&q, &plane, 1, (MesoVec3){2, 2.1f, 0}, 0.4f);
    CHECK(b.y - a.y > 0.18f && fabsf(a.y + b.y - 4.1f) < 0.02f && fabsf(a.z - b.z) < 0.01f);
    meso_quilt_base_release(&base);
    meso_triangulation_release(&plane);
    meso_arena_release(&arena);
}

/*
 * A bar that rises under another one, whose middle is clear of it:
 *
 *        +---+
 *        |   |/      the side of the upper one is not, and comes to be
 *        +---/
 *           /
 */
static void test_part_sides(void)
{
    MesoArena arena;
    MesoError error = {0};
    meso_arena_init(&arena);
    MesoSwatch swatch = make_swatch(&arena);
    MesoTriangulation plane = meso_fixture_sheet(2, 2, 4);
    MesoQuiltBase base;
    CHECK(meso_quilt_base_build(&base, &arena, &plane, NULL, 0.5f, 2.5f, &error) == MESO_OK);
    MesoVec3 at = meso_vec3_add(swatch.positions[0], (MesoVec3){0, BAR_SIDE / 2, BAR_SIDE / 2});
    const MesoVec3 middle = {2, 2, 0}, beside = {2, 2.1f, 0}, move = {-2 - at.x, 2 - at.y, -0.7f};
    const Copy across[] = {{0, RINGS - 1, move}, {0, RINGS - 1, move}};
    MesoQuilt q = lay_out(&arena, &swatch, &base.mesh, across, 2);
    turn(&q, &base.mesh, 1, middle);
    for (uint32_t v = 0; v < q.vertex_begin[1]; v++)
        q.vertices[v].height += 0.25f;
    for (uint32_t v = q.vertex_begin[1]; v < q.vertex_count; v++) {     /* with rings nearer to each other */
        MesoVec3 p = point_of(&base.mesh, q.vertices[v]);
        p.y = 2 + 0.25f * (p.y - 2);
        p.z += fmaxf(fminf(1.5f * (p.y - 2), 0.2f), -0.2f);
        q.vertices[v] = place_at(&base.mesh, p);
    }
    const MesoFinishOptions options = {.scale = 1, .offset = -1};
    MesoFinishWork work = {.base = &base, .swatch = &swatch, .options = &options, .arena = &arena,
                           .vertex_count = q.vertex_count, .triangle_count = q.triangle_count, .vertices = q.vertices,
                           .origins = q.origins, .corners = q.corners,
                           .at_border = MESO_NEW(&arena, uint8_t, q.vertex_count, &error)};
    float upper = middle_near(&q, &base.mesh, 0, middle, 0.25f).z;
    float lower = middle_near(&q, &base.mesh, 1, beside, 0.14f).z;
    CHECK(upper - lower > 0 && upper - lower < 0.12f);
    CHECK(work.at_border && meso_finish_part(&work, &error) == MESO_OK);
    upper = middle_near(&q, &base.mesh, 0, middle, 0.25f).z;
    lower = middle_near(&q, &base.mesh, 1, beside, 0.14f).z;
    CHECK(upper - lower > 0.15f);
    meso_quilt_base_release(&base);
    meso_triangulation_release(&plane);
    meso_arena_release(&arena);
}

/* The quilt's own memory goes when it is of no use: what comes out is the same, whatever the number of threads. */
static void test_spent(void)
{
    MesoArena arena, own, fresh;
    MesoError error = {0};
    meso_arena_init(&arena);
    meso_arena_init(&own);
    meso_arena_init(&fresh);
    MesoSwatch swatch = make_swatch(&arena);
    MesoTriangulation plane = meso_fixture_sheet(2, 2, 2);
    MesoQuiltBase base;
    CHECK(meso_quilt_base_build(&base, &arena, &plane, NULL, 0.5f, 2.5f, &error) == MESO_OK);
    const Copy bar = {0, RINGS - 1, {-2 - swatch.positions[0].x, 1.3f - swatch.positions[0].y, 0}};
    MesoQuilt kept = lay_out(&arena, &swatch, &base.mesh, &bar, 1), spent = lay_out(&own, &swatch, &base.mesh, &bar, 1);
    const MesoFinishOptions options = {.scale = 1, .thread_count = 1};
    const MesoFinishOptions spending = {.scale = 1, .thread_count = 7, .spent = &own};
    CHECK(meso_quilt_finish(&kept, &arena, &base, &swatch, &options, &error) == MESO_OK);
    CHECK(meso_quilt_finish(&spent, &fresh, &base, &swatch, &spending, &error) == MESO_OK);
    CHECK(own.used == 0 && !own.head);
    CHECK(kept.vertex_count && spent.vertex_count == kept.vertex_count && spent.element_count == kept.element_count);
    CHECK(memcmp(spent.vertices, kept.vertices, kept.vertex_count * sizeof *kept.vertices) == 0);
    CHECK(spent.triangle_count == kept.triangle_count &&
          memcmp(spent.corners, kept.corners, 3 * kept.triangle_count * sizeof *kept.corners) == 0);
    CHECK(spent.report.closed_count == kept.report.closed_count && spent.report.closed_count == 2);
    meso_quilt_base_release(&base);
    meso_triangulation_release(&plane);
    meso_arena_release(&arena);
    meso_arena_release(&own);
    meso_arena_release(&fresh);
}

int main(void)
{
    test_spent();
    test_along_border();
    test_level();
    test_whole_level();
    test_part();
    test_part_sides();
    test_plane(false);
    test_plane(true);
    test_wholes();
    return 0;
}
