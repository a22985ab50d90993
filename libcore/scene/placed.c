#include "libcore/scene/placed.h"

#include "libcore/scene/cell.h"

MesoVec3 meso_frame_point(const MesoFrame *frame, MesoVec3 p)
{
    const float *m = frame->m;
    return (MesoVec3){m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3], m[4] * p.x + m[5] * p.y + m[6] * p.z + m[7],
                      m[8] * p.x + m[9] * p.y + m[10] * p.z + m[11]};
}

MesoVec3 meso_placed_point(const MesoScene *scene, const MesoPlacedBody *placed, MesoVec3 p)
{
    if (placed->place == MESO_PLACED_HERE)
        return p;
    MesoVec3 q = meso_frame_point(&scene->frames[placed->frame], p);
    if (placed->place == MESO_PLACED_IN_FRAME)
        return q;
    const MesoCage *cage = &scene->cages[placed->cage];
    MesoVec2 at = meso_transform_point(placed->turn, (MesoVec2){q.x, q.y});
    return scene->deform == MESO_SWEEP_SHAPE ? meso_cell_body_point(cage, (MesoVec3){at.x, at.y, q.z})
                                              : meso_cage_point(cage, at.x, at.y, 2 * q.z);
}

static MesoVec3 frame_axis(const MesoFrame *frame, uint32_t axis)
{
    return (MesoVec3){frame->m[axis], frame->m[4 + axis], frame->m[8 + axis]};
}

static float frame_determinant(const MesoFrame *frame)
{
    return meso_vec3_dot(meso_vec3_cross(frame_axis(frame, 0), frame_axis(frame, 1)), frame_axis(frame, 2));
}

bool meso_placed_is_mirrored(const MesoScene *scene, const MesoPlacedBody *placed)
{
    if (placed->place == MESO_PLACED_HERE)
        return false;
    bool negative = frame_determinant(&scene->frames[placed->frame]) < 0;
    return negative != (placed->place == MESO_PLACED_IN_CAGE && meso_transform_flips(placed->turn));
}

/* Normals follow the cofactors of the map's derivative, whose columns are `d`. */
static MesoVec3 map_normal(const MesoVec3 d[3], MesoVec3 n, bool mirrored)
{
    MesoVec3 x = meso_vec3_scale(meso_vec3_cross(d[1], d[2]), n.x);
    MesoVec3 y = meso_vec3_scale(meso_vec3_cross(d[2], d[0]), n.y);
    MesoVec3 z = meso_vec3_scale(meso_vec3_cross(d[0], d[1]), n.z);
    MesoVec3 mapped = meso_vec3_add(x, meso_vec3_add(y, z));
    return meso_vec3_direction(mirrored ? meso_vec3_scale(mapped, -1) : mapped, (MesoVec3){0, 0, 1});
}

/*
 * A cage's map is smooth, so its derivative along the body's axes is taken by
 * central differences of a thousandth of the cage.
 */
static void derive(const MesoScene *scene, const MesoPlacedBody *placed, MesoVec3 p, MesoVec3 d[3])
{
    static const MesoVec3 steps[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const MesoFrame *frame = &scene->frames[placed->frame];
    for (uint32_t k = 0; k < 3; k++) {
        if (placed->place == MESO_PLACED_IN_FRAME) {
            d[k] = frame_axis(frame, k);
            continue;
        }
        float length = meso_vec3_length(frame_axis(frame, k));
        float h = length > 0 ? 1e-3f / length : 0;
        MesoVec3 a = meso_placed_point(scene, placed, meso_vec3_mad(p, -h, steps[k]));
        MesoVec3 b = meso_placed_point(scene, placed, meso_vec3_mad(p, h, steps[k]));
        d[k] = meso_vec3_scale(meso_vec3_sub(b, a), length);
    }
}

void meso_placed_vertices(const MesoScene *scene, const MesoPlacedBody *placed, MesoMeshVertex *out)
{
    const MesoBody *body = &scene->bodies[placed->body];
    bool mirrored = meso_placed_is_mirrored(scene, placed);
    for (uint32_t i = 0; i < body->vertex_count; i++) {
        MesoVec3 p = body->positions[i], n = body->normals[i], d[3];
        if (placed->place != MESO_PLACED_HERE) {
            derive(scene, placed, p, d);
            n = map_normal(d, n, mirrored);
        }
        MesoVec2 uv = body->uvs ? body->uvs[i] : (MesoVec2){0, 0};
        out[i] = (MesoMeshVertex){meso_placed_point(scene, placed, p), n, uv};
    }
}

/* The other way round: the first corner stays. */
static MesoMeshFace reversed(MesoMeshFace face)
{
    uint32_t last = face.v[3] == MESO_NO_INDEX ? 2 : 3, second = face.v[1];
    face.v[1] = face.v[last];
    face.v[last] = second;
    return face;
}

void meso_placed_faces(const MesoScene *scene, const MesoPlacedBody *placed, uint32_t base, MesoMeshFace *out)
{
    const MesoBody *body = &scene->bodies[placed->body];
    bool mirrored = meso_placed_is_mirrored(scene, placed);
    for (uint32_t i = 0; i < body->face_count; i++) {
        const uint32_t *v = &body->corners[(size_t)body->face_width * i];
        bool quad = body->face_width == 4 && v[3] != MESO_NO_INDEX;
        MesoMeshFace face = {{base + v[0], base + v[1], base + v[2], quad ? base + v[3] : MESO_NO_INDEX}};
        out[i] = mirrored ? reversed(face) : face;
    }
}
