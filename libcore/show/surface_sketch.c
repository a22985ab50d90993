#include "libcore/show/surface_sketch.h"

#include "libcore/base/index.h"
#include "libcore/sketch/sketch.h"

/* In mean edge lengths; the length of an arrow in that of its quad. */
static const float EDGE_RADIUS = 0.016f, BORDER_RADIUS = 0.03f, ARROW_RADIUS = 0.014f, HEAD_RADIUS = 0.05f,
                   BALL_RADIUS = 0.2f, ARROW_LENGTH = 0.5f, HEAD_LENGTH = 0.2f;

static const float INK[3] = {0.03f, 0.03f, 0.035f}, BORDER[3] = {0.02f, 0.1f, 0.35f}, ARROW[3] = {0.01f, 0.22f, 0.1f},
                   THREE[3] = {0.75f, 0.03f, 0.02f}, FIVE[3] = {0.02f, 0.12f, 0.8f}, OTHER[3] = {0.45f, 0.02f, 0.6f};

static MesoVec3 position_at(const MesoPolygonMesh *mesh, uint32_t corner)
{
    return mesh->positions[mesh->corners[corner]];
}

/* Corner after this one in its face. */
static uint32_t next_corner(uint32_t begin, uint32_t sides, uint32_t corner)
{
    return corner + 1 < begin + sides ? corner + 1 : begin;
}

/* By the sums of Newell, which hold for polygons that are not flat. */
static MesoVec3 face_normal(const MesoPolygonMesh *mesh, uint32_t begin, uint32_t sides)
{
    MesoVec3 sum = {0, 0, 0}, first = position_at(mesh, begin);
    for (uint32_t k = 1; k + 1 < sides; k++)
        sum = meso_vec3_add(sum, meso_vec3_cross(meso_vec3_sub(position_at(mesh, begin + k), first),
                                                 meso_vec3_sub(position_at(mesh, begin + k + 1), first)));
    return meso_vec3_direction(sum, (MesoVec3){0, 0, 1});
}

static float mean_edge(const MesoPolygonMesh *mesh)
{
    double sum = 0;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        for (uint32_t c = begin; c < begin + sides; c++)
            sum += (double)meso_vec3_length(meso_vec3_sub(position_at(mesh, next_corner(begin, sides, c)),
                                                          position_at(mesh, c)));
    }
    return (float)(sum / mesh->corner_count);
}

static void draw_faces(MesoSketch *sketch, const MesoSurfaceSketch *look, uint32_t number)
{
    enum { SIDES = 64 };
    const MesoPolygonMesh *mesh = look->mesh;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        MesoVec3 positions[SIDES], normals[SIDES];
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        if ((look->face_class ? look->face_class[f] : 0) != number)
            continue;
        MesoVec3 normal = face_normal(mesh, begin, sides);
        for (uint32_t k = 0; k < SIDES; k++)
            normals[k] = normal;
        positions[0] = position_at(mesh, begin);
        /* What has more sides comes in several fans about its first corner. */
        for (uint32_t k = 1; k + 1 < sides; k += SIDES - 2) {
            uint32_t count = 1;
            for (; count < SIDES && k + count - 1 < sides; count++)
                positions[count] = position_at(mesh, begin + k + count - 1);
            meso_sketch_face(sketch, count, positions, normals);
        }
    }
}

/* Each edge once: from its half-edge of the lower number. */
static void draw_edges(MesoSketch *sketch, const MesoSurfaceSketch *look, bool borders, float radius)
{
    const MesoPolygonMesh *mesh = look->mesh;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        for (uint32_t c = begin; c < begin + sides; c++) {
            uint32_t twin = look->twin[c];
            if (borders ? twin == MESO_NO_INDEX : twin != MESO_NO_INDEX && twin > c)
                meso_sketch_bar(sketch, position_at(mesh, c), position_at(mesh, next_corner(begin, sides, c)), radius);
        }
    }
}

static void draw_direction(MesoSketch *sketch, const MesoPolygonMesh *mesh, uint32_t begin, float edge)
{
    MesoVec3 p[4];
    for (uint32_t k = 0; k < 4; k++)
        p[k] = position_at(mesh, begin + k);
    MesoVec3 ahead = meso_vec3_lerp(p[0], p[1], 0.5f), behind = meso_vec3_lerp(p[2], p[3], 0.5f);
    MesoVec3 lift = meso_vec3_scale(face_normal(mesh, begin, 4), HEAD_RADIUS * edge);
    MesoVec3 middle = meso_vec3_add(meso_vec3_lerp(ahead, behind, 0.5f), lift), way = meso_vec3_sub(ahead, behind);
    MesoVec3 tip = meso_vec3_mad(middle, ARROW_LENGTH / 2, way), neck = meso_vec3_mad(tip, -HEAD_LENGTH, way);
    float scale = fminf(edge, meso_vec3_length(way));
    meso_sketch_bar(sketch, meso_vec3_mad(middle, -ARROW_LENGTH / 2, way), neck, ARROW_RADIUS * scale);
    meso_sketch_point(sketch, neck, tip, HEAD_RADIUS * scale);
}

/* Faces around each vertex; MESO_NO_INDEX for those on a border. */
static uint32_t *count_faces(const MesoSurfaceSketch *look, MesoArena *arena, MesoError *error)
{
    const MesoPolygonMesh *mesh = look->mesh;
    uint32_t *counts = MESO_NEW(arena, uint32_t, mesh->vertex_count, error);
    for (uint32_t c = 0; counts && c < mesh->corner_count; c++)
        counts[mesh->corners[c]]++;
    for (uint32_t f = 0; counts && f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        for (uint32_t c = begin; c < begin + sides; c++)
            if (look->twin[c] == MESO_NO_INDEX)
                counts[mesh->corners[c]] = counts[mesh->corners[next_corner(begin, sides, c)]] = MESO_NO_INDEX;
    }
    return counts;
}

static bool is_singular(uint32_t faces)
{
    return faces != 0 && faces != 4 && faces != MESO_NO_INDEX;
}

static MesoStatus draw_corners(MesoSketch *sketch, MesoSurfaceMarks *marks, const MesoSurfaceSketch *look, float radius,
                               MesoArena *arena, MesoError *error)
{
    static const char *const names[3] = {"corners of 3", "corners of 5", "other corners"};
    static const float *const colors[3] = {THREE, FIVE, OTHER};
    uint32_t *counts = count_faces(look, arena, error), *numbers[3] = {&marks->three, &marks->five, &marks->others};
    for (uint32_t kind = 0; counts && kind < 3; kind++) {
        meso_sketch_part(sketch, names[kind], colors[kind]);
        for (uint32_t v = 0; v < look->mesh->vertex_count; v++) {
            uint32_t own = counts[v] == 3 ? 0 : counts[v] == 5 ? 1 : 2;
            if (!is_singular(counts[v]) || own != kind)
                continue;
            meso_sketch_ball(sketch, look->mesh->positions[v], radius);
            ++*numbers[kind];
        }
    }
    return counts ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_surface_sketch(MesoScene *scene, MesoSurfaceMarks *marks, MesoArena *arena,
                               const MesoSurfaceSketch *look, MesoError *error)
{
    const MesoPolygonMesh *mesh = look->mesh;
    MesoSketch sketch = {0};
    MesoSurfaceMarks none;
    MesoStatus status = MESO_OK;
    float edge = mean_edge(mesh);
    marks = marks ? marks : &none;
    *marks = (MesoSurfaceMarks){0};
    for (uint32_t i = 0; i < look->class_count; i++) {
        meso_sketch_part(&sketch, look->classes[i].name, look->classes[i].color);
        draw_faces(&sketch, look, i);
    }
    meso_sketch_part(&sketch, "edges", INK);
    draw_edges(&sketch, look, false, EDGE_RADIUS * edge);
    meso_sketch_part(&sketch, "borders", BORDER);
    draw_edges(&sketch, look, true, BORDER_RADIUS * edge);
    meso_sketch_part(&sketch, "directions", ARROW);
    for (uint32_t f = 0; look->directions && f < mesh->face_count; f++)
        if (meso_polygon_sides(mesh, f) == 4)
            draw_direction(&sketch, mesh, meso_polygon_begin(mesh, f), edge);
    if (look->corners)
        status = draw_corners(&sketch, marks, look, BALL_RADIUS * edge, arena, error);
    *scene = (MesoScene){0};
    MesoStatus finished = meso_sketch_finish(&sketch, scene, arena, status ? NULL : error);
    return status ? status : finished;
}
