#include "libcore/quilt/check/check_sections.h"

enum {
    SAMPLES = 4000,
    DIRECTIONS = 12,        /* the best is within 7.5 degrees of the one across: a hundredth of the area */
    LONGEST = 512           /* edges around a section; what is longer runs along a strand */
};

#define CHANGED 0.75

/* An edge that is so much sharper than in the swatch, by the cosine of its angle, is not of the strand's side. */
#define SHARPER 0.3

typedef struct Plane {
    MesoVec3 origin, normal;
} Plane;

static MesoVec3 corner_at(const MesoCheckMesh *mesh, uint32_t corner)
{
    return mesh->positions[mesh->corners[corner]];
}

static bool is_above(const MesoCheckMesh *mesh, uint32_t corner, const Plane *plane)
{
    return meso_vec3_dot(meso_vec3_sub(corner_at(mesh, corner), plane->origin), plane->normal) > 0;
}

/* The half-edge of a triangle that goes up through the plane, or down; MESO_NO_INDEX: none. */
static uint32_t crossing_edge(const MesoCheckMesh *mesh, uint32_t triangle, const Plane *plane, bool up)
{
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        bool from = is_above(mesh, h, plane), to = is_above(mesh, meso_next_corner(h), plane);
        if (from != to && to == up)
            return h;
    }
    return MESO_NO_INDEX;
}

static MesoVec3 crossing_point(const MesoCheckMesh *mesh, uint32_t half_edge, const Plane *plane)
{
    MesoVec3 a = meso_vec3_sub(corner_at(mesh, half_edge), plane->origin);
    MesoVec3 b = meso_vec3_sub(corner_at(mesh, meso_next_corner(half_edge)), plane->origin);
    float from = meso_vec3_dot(a, plane->normal), to = meso_vec3_dot(b, plane->normal);
    return meso_vec3_lerp(a, b, from / (from - to));
}

/* The area of the section that begins in a triangle; INFINITY where it is not closed, or too long. */
static double section_area(const MesoCheckMesh *mesh, uint32_t triangle, const Plane *plane)
{
    MesoVec3 area = {0, 0, 0}, last = {0, 0, 0};
    uint32_t at = triangle;
    for (uint32_t i = 0; i <= LONGEST; i++) {
        uint32_t h = crossing_edge(mesh, at, plane, true);
        if (h == MESO_NO_INDEX || mesh->twins[h] == MESO_NO_INDEX)
            return INFINITY;
        MesoVec3 point = crossing_point(mesh, h, plane);
        area = i ? meso_vec3_add(area, meso_vec3_cross(last, point)) : area;
        if (i && at == triangle)
            return fabs(0.5 * (double)meso_vec3_dot(area, plane->normal));
        last = point;
        at = mesh->twins[h] / 3;
    }
    return INFINITY;
}

static MesoVec3 normal_of(const MesoCheckMesh *mesh, uint32_t triangle)
{
    MesoVec3 a = corner_at(mesh, 3 * triangle), b = meso_vec3_sub(corner_at(mesh, 3 * triangle + 1), a);
    MesoVec3 area = meso_vec3_cross(b, meso_vec3_sub(corner_at(mesh, 3 * triangle + 2), a));
    return meso_vec3_direction(area, (MesoVec3){0, 0, 0});
}

/* The cosine of the sharpest angle to a neighbour; -1 at an open edge. */
static double sharpest_edge(const MesoCheckMesh *mesh, uint32_t triangle)
{
    double least = 1;
    MesoVec3 normal = normal_of(mesh, triangle);
    for (uint32_t h = 3 * triangle; h < 3 * triangle + 3; h++) {
        if (mesh->twins[h] == MESO_NO_INDEX)
            return -1;
        least = fmin(least, (double)meso_vec3_dot(normal, normal_of(mesh, mesh->twins[h] / 3)));
    }
    return least;
}

static double smallest_section(const MesoCheckMesh *mesh, uint32_t triangle)
{
    MesoVec3 a = corner_at(mesh, 3 * triangle), b = corner_at(mesh, 3 * triangle + 1);
    MesoVec3 c = corner_at(mesh, 3 * triangle + 2), normal = normal_of(mesh, triangle);
    MesoVec3 x = meso_vec3_direction(meso_vec3_sub(b, a), (MesoVec3){1, 0, 0}), y = meso_vec3_cross(normal, x);
    Plane plane = {.origin = meso_vec3_scale(meso_vec3_add(a, meso_vec3_add(b, c)), 1.0f / 3)};
    double least = INFINITY;
    for (int i = 0; i < DIRECTIONS; i++) {
        double angle = MESO_PI * i / DIRECTIONS;
        plane.normal = meso_vec3_mad(meso_vec3_scale(x, (float)cos(angle)), (float)sin(angle), y);
        least = fmin(least, section_area(mesh, triangle, &plane));
    }
    return least;
}

static void compare_at(MesoSections *sections, const MesoCheckMesh *mesh, const MesoCheckMesh *sample,
                       uint32_t triangle, uint32_t origin, double area_scale)
{
    if (sharpest_edge(mesh, triangle) < sharpest_edge(sample, origin) - SHARPER)
        return;
    double area = smallest_section(sample, origin) * area_scale;
    if (!isfinite(area) || !(area > 0))
        return;
    double share = smallest_section(mesh, triangle) / area;
    if (!isfinite(share))
        return;
    bool first = sections->count++ == 0;
    sections->changed_count += share < CHANGED || share > 1 / CHANGED;
    sections->least = first || share < sections->least ? share : sections->least;
    sections->largest = first || share > sections->largest ? share : sections->largest;
    sections->rms += (share - 1) * (share - 1);
}

void meso_check_sections(MesoSections *sections, const MesoCheckMesh *mesh, const MesoCheckMesh *sample,
                         const MesoQuilt *quilt, const MesoSwatch *swatch, double area_scale)
{
    *sections = (MesoSections){.least = 1, .largest = 1};
    uint64_t strand_triangles = 0, seen = 0;
    for (uint32_t e = 0; e < mesh->element_count; e++)
        if (swatch->kinds[quilt->element_origins[e]] == MESO_ELEMENT_STRAND)
            strand_triangles += mesh->triangle_begin[e + 1] - mesh->triangle_begin[e];
    /* an odd stride: triangles come in pairs, of which both kinds are wanted */
    uint64_t stride = strand_triangles / SAMPLES | 1;
    for (uint32_t e = 0; e < mesh->element_count; e++) {
        if (swatch->kinds[quilt->element_origins[e]] != MESO_ELEMENT_STRAND)
            continue;
        for (uint32_t t = mesh->triangle_begin[e]; t < mesh->triangle_begin[e + 1]; t++)
            if (seen++ % stride == 0)
                compare_at(sections, mesh, sample, t, quilt->triangle_origins[t], area_scale);
    }
    sections->rms = sections->count ? sqrt(sections->rms / sections->count) : 0;
}
