/*
 * What every cut must keep, checked without looking at how it is done; random lines, and meshes that are hard to cut.
 * For tests and fuzz entries.
 */
#ifndef MESO_MESH_CUT_FIXTURE_H
#define MESO_MESH_CUT_FIXTURE_H

#include <string.h>

#include "libcore/base/random.h"
#include "libcore/mesh/cut/mesh_cut.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

/* ---- what to choose from: bytes, and when they are used up, nothing more; without bytes, random numbers ---- */

typedef struct MesoChoices {
    const uint8_t *bytes;
    size_t left;
    MesoRandom random;
} MesoChoices;

static inline uint32_t meso_choose(MesoChoices *choices, uint32_t bound)
{
    if (!choices->bytes)
        return meso_random_below(&choices->random, bound);
    uint32_t number = 0;
    for (uint32_t most = bound - 1; most > 0; most >>= 8) {
        number = number << 8 | (choices->left ? *choices->bytes : 0);
        choices->bytes += choices->left > 0;
        choices->left -= choices->left > 0;
    }
    return number % bound;
}

/* From 0 to 1; often a small fraction, so that nodes meet, or one near to another or to an end. */
static inline float meso_choose_share(MesoChoices *choices)
{
    switch (meso_choose(choices, 4)) {
    case 0: return (float)meso_choose(choices, 9) / 8;
    case 1: return (float)meso_choose(choices, 13) / 12 + ((float)meso_choose(choices, 9) - 4) * 0.001f;
    case 2: return (float)meso_choose(choices, 256) / 255;
    default: return (float)meso_choose(choices, 1 << 16) / (1 << 16);
    }
}

static inline float meso_clamp_share(float share, float most)
{
    return share < 0 ? 0 : share > most ? most : share;
}

static inline MesoCutNode meso_choose_node(MesoChoices *choices, uint32_t triangle, const MesoTriangulation *mesh)
{
    uint32_t kind = meso_choose(choices, 8), k = meso_choose(choices, 3);
    float s = meso_clamp_share(meso_choose_share(choices), 1);
    if (kind == 0)
        return (MesoCutNode){MESO_AT_VERTEX, mesh->corners[3 * triangle + k], {0, 0}};
    if (kind < 5) {
        uint32_t h = 3 * triangle + k, twin = mesh->twins[h];
        bool by_twin = twin != MESO_NO_INDEX && meso_choose(choices, 2);
        return (MesoCutNode){MESO_ON_EDGE, by_twin ? twin : h, {s, 0}};
    }
    return (MesoCutNode){MESO_IN_TRIANGLE, triangle, {s, meso_clamp_share(meso_choose_share(choices), 1 - s)}};
}

/* Chains of segments in up to so many triangles. */
static inline void meso_choose_lines(MesoCutLines *lines, MesoArena *arena, MesoChoices *choices,
                                     const MesoTriangulation *mesh, uint32_t triangle_count)
{
    *lines = (MesoCutLines){0};
    for (uint32_t i = 0; i < triangle_count; i++) {
        uint32_t t = meso_choose(choices, mesh->triangle_count), count = 1 + meso_choose(choices, 8);
        uint32_t last = 0, first = 0;
        for (uint32_t n = 0; n < count; n++) {
            uint32_t node;
            CHECK(meso_cut_add_node(lines, arena, meso_choose_node(choices, t, mesh), &node, NULL) == MESO_OK);
            first = n == 0 ? node : first;
            if (n > 0)
                CHECK(meso_cut_add_segment(lines, arena, (MesoCutSegment){{last, node}, t, i}, NULL) == MESO_OK);
            last = node;
        }
        if (meso_choose(choices, 2))
            CHECK(meso_cut_add_segment(lines, arena, (MesoCutSegment){{last, first}, t, i}, NULL) == MESO_OK);
    }
}

/* ---- meshes ---- */

/* A band of n triangles with a half turn, n odd; every triangle is wound against one of its neighbours somewhere. */
static inline MesoTriangulation meso_fixture_moebius(uint32_t n)
{
    MesoVec3 positions[64];
    uint32_t corners[192];
    CHECK(n >= 5 && n <= 64);
    for (uint32_t v = 0; v < n; v++) {
        float a = 6.2831853f * (float)v / (float)n;
        float r = 1 + 0.3f * cosf(a * (float)n / 2);
        positions[v] = (MesoVec3){r * cosf(a), r * sinf(a), 0.3f * sinf(a * (float)n / 2)};
        corners[3 * v] = v;
        corners[3 * v + 1] = (v + 1) % n;
        corners[3 * v + 2] = (v + 2) % n;
    }
    return meso_fixture_triangulation(positions, n, corners, n);
}

/* Spheres: an octahedron, and two triangles back to back, whose sides are all shared. */
static inline MesoTriangulation meso_fixture_octahedron(void)
{
    const MesoVec3 positions[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    const uint32_t corners[24] = {0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5};
    return meso_fixture_triangulation(positions, 6, corners, 8);
}

static inline MesoTriangulation meso_fixture_pillow(void)
{
    const MesoVec3 positions[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const uint32_t corners[6] = {0, 1, 2, 0, 2, 1};
    return meso_fixture_triangulation(positions, 3, corners, 2);
}

/* A sheet with what is hard to cut: vertices that coincide, triangles without area, needles, large coordinates. */
static inline MesoTriangulation meso_fixture_crumpled(MesoChoices *choices, uint32_t side)
{
    MesoTriangulation mesh = meso_fixture_sheet(side, side, 1);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        uint32_t how = meso_choose(choices, 8), other = meso_choose(choices, mesh.vertex_count);
        MesoVec3 *p = &mesh.positions[v];
        if (how == 0)
            *p = mesh.positions[other];
        else if (how == 1 && v > 0 && v + 1 < mesh.vertex_count)
            *p = meso_vec3_lerp(mesh.positions[v - 1], mesh.positions[v + 1], 0.5f);
        else if (how == 2)
            p->y = 1e-7f * (float)other;
        else if (how == 3)
            p->z = 1e5f;
    }
    return mesh;
}

/* ---- what a cut keeps ---- */

static inline void *meso_fixture_copy(const void *array, size_t count, size_t size)
{
    void *copy = malloc(count * size + 1);
    CHECK(copy);
    if (count > 0 && size > 0)
        memcpy(copy, array, count * size);
    return copy;
}

static inline MesoTriangulation meso_fixture_copy_mesh(const MesoTriangulation *mesh)
{
    MesoTriangulation copy = *mesh;
    size_t corner_count = 3 * (size_t)mesh->triangle_count;
    copy.positions = meso_fixture_copy(mesh->positions, mesh->vertex_count, sizeof *mesh->positions);
    copy.vertex_corner = meso_fixture_copy(mesh->vertex_corner, mesh->vertex_count, sizeof *mesh->vertex_corner);
    copy.corners = meso_fixture_copy(mesh->corners, corner_count, sizeof *mesh->corners);
    copy.twins = meso_fixture_copy(mesh->twins, corner_count, sizeof *mesh->twins);
    copy.labels = meso_fixture_copy(mesh->labels, mesh->triangle_count, sizeof *mesh->labels);
    copy.faces = meso_fixture_copy(mesh->faces, mesh->triangle_count, sizeof *mesh->faces);
    copy.walls = meso_fixture_copy(mesh->walls, mesh->triangle_count, sizeof *mesh->walls);
    copy.origins = meso_fixture_copy(mesh->origins, mesh->vertex_count, sizeof *mesh->origins);
    copy.vertex_values = meso_fixture_copy(mesh->vertex_values, (size_t)mesh->vertex_width * mesh->vertex_count,
                                           sizeof *mesh->vertex_values);
    copy.corner_values = meso_fixture_copy(mesh->corner_values, mesh->corner_width * corner_count,
                                           sizeof *mesh->corner_values);
    return copy;
}

/* V - E + F, of vertices that have triangles. */
static inline int64_t meso_fixture_euler(const MesoTriangulation *mesh)
{
    int64_t twice = 2 * (int64_t)mesh->triangle_count;
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        twice += mesh->vertex_corner[v] != MESO_NO_INDEX ? 2 : 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        twice -= mesh->twins[h] == MESO_NO_INDEX ? 2 : 1;
    CHECK(twice % 2 == 0);
    return twice / 2;
}

static inline double meso_fixture_border_length(const MesoTriangulation *mesh)
{
    double length = 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (mesh->twins[h] == MESO_NO_INDEX)
            length += meso_vec3_length(meso_vec3_sub(mesh->positions[mesh->corners[meso_next_corner(h)]],
                                                     mesh->positions[mesh->corners[h]]));
    return length;
}

/* Weights of a vertex in the corners of a triangle before, times 2^24. */
static inline void meso_fixture_weights(const MesoTriangulation *before, const MesoCutReport *report, uint32_t triangle,
                                        uint32_t vertex, int64_t weight[3])
{
    const uint32_t *corners = &before->corners[3 * triangle];
    int64_t sum = 0;
    memset(weight, 0, 3 * sizeof *weight);
    for (uint32_t k = 0; k < 3; k++) {
        if (vertex < report->first_vertex) {
            weight[k] = corners[k] == vertex ? 1 << 24 : 0;
        } else {
            const MesoCutOrigin *origin = &report->origins[vertex - report->first_vertex];
            for (uint32_t i = 0; i < 3; i++)
                weight[k] += origin->vertex[i] == corners[k] ? (int64_t)(origin->weight[i] * (1 << 24)) : 0;
        }
        sum += weight[k];
    }
    CHECK(sum == 1 << 24);
}

/* Twice the area, as a vector. */
static inline void meso_fixture_area(const MesoTriangulation *mesh, uint32_t triangle, double area[3])
{
    double p[3][3];
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 at = mesh->positions[mesh->corners[3 * triangle + k]];
        p[k][0] = at.x;
        p[k][1] = at.y;
        p[k][2] = at.z;
    }
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t a = (k + 1) % 3, b = (k + 2) % 3;
        area[k] = (p[1][a] - p[0][a]) * (p[2][b] - p[0][b]) - (p[1][b] - p[0][b]) * (p[2][a] - p[0][a]);
    }
}

/* The part, `share` of its parent, faces where that does, as far as rounded coordinates can tell. */
static inline void meso_fixture_check_facing(const MesoTriangulation *before, const MesoTriangulation *mesh,
                                             const MesoCutPart *part, double share)
{
    double old[3], new[3], size = 0, length = 0;
    meso_fixture_area(before, part->parent, old);
    meso_fixture_area(mesh, part->triangle, new);
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 a = mesh->positions[mesh->corners[3 * part->triangle + k]];
        MesoVec3 b = mesh->positions[mesh->corners[3 * part->triangle + (k + 1) % 3]];
        size = fmax(size, fabs((double)a.x) + fabs((double)a.y) + fabs((double)a.z));
        length = fmax(length, (double)meso_vec3_length(meso_vec3_sub(b, a)));
    }
    double area = sqrt(old[0] * old[0] + old[1] * old[1] + old[2] * old[2]);
    if (area * share > 1e-6 * size * length)
        CHECK(old[0] * new[0] + old[1] * new[1] + old[2] * new[2] > 0);
}

/* Twice the part's area as a share of its parent's, times 2^48; and that centre and what is inherited are right. */
static inline int64_t meso_fixture_check_part(const MesoTriangulation *before, const MesoTriangulation *mesh,
                                              const MesoCutReport *report, const MesoCutPart *part)
{
    int64_t w[3][3];
    for (uint32_t k = 0; k < 3; k++)
        meso_fixture_weights(before, report, part->parent, mesh->corners[3 * part->triangle + k], w[k]);
    int64_t area = (w[1][1] - w[0][1]) * (w[2][2] - w[0][2]) - (w[1][2] - w[0][2]) * (w[2][1] - w[0][1]);
    CHECK(area > 0);
    meso_fixture_check_facing(before, mesh, part, (double)area / 0x1p48);
    for (uint32_t k = 0; k < 3; k++)
        CHECK(fabs(part->centre[k] - (double)(w[0][k] + w[1][k] + w[2][k]) / (3 << 24)) < 1e-6);
    CHECK(mesh->labels[part->triangle] == before->labels[part->parent]);
    CHECK(mesh->faces[part->triangle] == before->faces[part->parent]);
    for (uint32_t k = 0; k < 3; k++)
        for (uint32_t c = 0; c < mesh->corner_width; c++) {
            const float *from = &before->corner_values[3 * (size_t)mesh->corner_width * part->parent + c];
            double value = 0, is = mesh->corner_values[mesh->corner_width * (3 * (size_t)part->triangle + k) + c];
            for (uint32_t i = 0; i < 3; i++)
                value += (double)w[k][i] / (1 << 24) * (double)from[i * mesh->corner_width];
            CHECK(fabs(value - is) < 1e-5);
        }
    return area;
}

/* Parts cover their parents, without holes and without overlap; all other triangles are as they were. */
static inline void meso_fixture_check_parts(const MesoTriangulation *before, const MesoTriangulation *mesh,
                                            const MesoCutReport *report)
{
    uint8_t *seen = calloc(mesh->triangle_count + 1, 1);
    CHECK(seen);
    for (uint32_t i = 0; i < report->part_count;) {
        uint32_t parent = report->parts[i].parent;
        int64_t area = 0;
        CHECK(report->parts[i].triangle == parent && !seen[parent]);
        for (; i < report->part_count && report->parts[i].parent == parent; i++) {
            uint32_t t = report->parts[i].triangle;
            CHECK(t < mesh->triangle_count && !seen[t] && (t == parent || t >= report->first_triangle));
            seen[t] = 1;
            area += meso_fixture_check_part(before, mesh, report, &report->parts[i]);
        }
        CHECK(area == (int64_t)1 << 48);
        CHECK(i == report->part_count || report->parts[i].parent > parent);
    }
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        CHECK(seen[t] || (t < report->first_triangle && mesh->walls[t] == before->walls[t] &&
                          memcmp(&mesh->corners[3 * t], &before->corners[3 * t], 12) == 0));
    free(seen);
}

static inline void meso_fixture_check_origins(const MesoTriangulation *before, const MesoTriangulation *mesh,
                                              const MesoCutReport *report)
{
    for (uint32_t v = report->first_vertex; v < mesh->vertex_count; v++) {
        const MesoCutOrigin *origin = &report->origins[v - report->first_vertex];
        MesoVec3 p = {0, 0, 0};
        float size = 0;
        for (uint32_t k = 0; k < 3; k++) {
            MesoVec3 from = before->positions[origin->vertex[k]];
            p = meso_vec3_mad(p, origin->weight[k], from);
            size = fmaxf(size, fabsf(from.x) + fabsf(from.y) + fabsf(from.z));
        }
        CHECK(origin->weight[0] + origin->weight[1] + origin->weight[2] == 1);
        CHECK(meso_vec3_length(meso_vec3_sub(p, mesh->positions[v])) <= 1e-6f * size);
        for (uint32_t c = 0; c < mesh->vertex_width; c++) {
            double value = 0;
            for (uint32_t k = 0; k < 3; k++)
                value += (double)origin->weight[k] *
                         (double)before->vertex_values[(size_t)mesh->vertex_width * origin->vertex[k] + c];
            CHECK(fabs(value - (double)mesh->vertex_values[(size_t)mesh->vertex_width * v + c]) < 1e-5);
        }
    }
}

/* Marks what walls of the parts [first, end) lead to from marked vertices, until nothing more comes. */
static inline void meso_fixture_follow_walls(const MesoTriangulation *mesh, const MesoCutReport *report, uint32_t first,
                                             uint32_t end, uint8_t *marked)
{
    for (bool again = true; again;) {
        again = false;
        for (uint32_t h = 3 * first; h < 3 * end; h++) {
            uint32_t half_edge = 3 * report->parts[h / 3].triangle + h % 3;
            uint32_t a = mesh->corners[half_edge], b = mesh->corners[meso_next_corner(half_edge)];
            if (!meso_side_is_wall(mesh, half_edge) || marked[a] == marked[b])
                continue;
            marked[a] = marked[b] = 1;
            again = true;
        }
    }
}

/* From one end of each segment walls lead to the other, through parts of its triangle. */
static inline void meso_fixture_check_walls(const MesoTriangulation *mesh, const MesoCutLines *lines,
                                            const MesoCutReport *report)
{
    for (uint32_t s = 0; s < lines->segment_count; s++) {
        const MesoCutSegment *segment = &lines->segments[s];
        uint32_t a = report->node_vertex[segment->node[0]], b = report->node_vertex[segment->node[1]];
        if (a == b)
            continue;
        uint8_t *marked = calloc(mesh->vertex_count, 1);
        uint32_t first = 0, end;
        CHECK(marked);
        while (first < report->part_count && report->parts[first].parent != segment->triangle)
            first++;
        for (end = first; end < report->part_count && report->parts[end].parent == segment->triangle;)
            end++;
        marked[a] = 1;
        meso_fixture_follow_walls(mesh, report, first, end, marked);
        CHECK(marked[b]);
        free(marked);
    }
}

/* Cuts, and checks all that is promised. */
static inline void meso_fixture_cut(MesoTriangulation *mesh, const MesoCutLines *lines, MesoCutReport *report,
                                    MesoArena *arena)
{
    MesoError error = {0};
    MesoTriangulation before = meso_fixture_copy_mesh(mesh);
    MesoStatus status = meso_mesh_cut(mesh, lines, report, arena, &error);
    if (status)
        fprintf(stderr, "%s\n", error.message);
    CHECK(status == MESO_OK);
    status = meso_triangulation_check(mesh, &error);
    if (status)
        fprintf(stderr, "%s\n", error.message);
    CHECK(status == MESO_OK);
    CHECK(meso_fixture_euler(mesh) == meso_fixture_euler(&before));
    CHECK(report->first_vertex == before.vertex_count && report->first_triangle == before.triangle_count);
    meso_fixture_check_parts(&before, mesh, report);
    meso_fixture_check_origins(&before, mesh, report);
    meso_fixture_check_walls(mesh, lines, report);
    meso_triangulation_release(&before);
}

#endif
