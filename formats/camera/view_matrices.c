#include "formats/camera/view_matrices.h"

#include <string.h>

enum { MATRIX_BYTES = 64, MOST_FRAMES = 1 << 20 };

/* How far axes may be from orthonormal; the prototype's are from it by 1e-6. */
static const float TOLERANCE = 1e-3f, FARTHEST = 1e18f;

static bool is_rigid(const float m[16], const MesoVec3 axes[3])
{
    bool rigid = m[3] == 0 && m[7] == 0 && m[11] == 0 && m[15] == 1;
    for (int a = 0; a < 3; a++) {
        rigid = rigid && fabsf(meso_vec3_dot(axes[a], axes[a]) - 1) < TOLERANCE;
        rigid = rigid && fabsf(meso_vec3_dot(axes[a], axes[(a + 1) % 3])) < TOLERANCE && fabsf(m[12 + a]) <= FARTHEST;
    }
    return rigid && meso_vec3_dot(meso_vec3_cross(axes[0], axes[1]), axes[2]) > 0;
}

static bool read_matrix(MesoCamera *camera, const uint8_t *bytes)
{
    float m[16];
    memcpy(m, bytes, sizeof m);
    const MesoVec3 axes[3] = {{m[0], m[4], m[8]}, {m[1], m[5], m[9]}, {m[2], m[6], m[10]}};
    if (!is_rigid(m, axes))
        return false;
    MesoVec3 eye = {0, 0, 0};
    for (int a = 0; a < 3; a++)
        eye = meso_vec3_mad(eye, -m[12 + a], axes[a]);
    camera->eye = eye;
    camera->target = meso_vec3_mad(eye, -fmaxf(meso_vec3_length(eye), 1), axes[2]);
    camera->up = axes[1];
    return true;
}

MesoStatus meso_view_matrices_read(MesoCameraKey **keys, uint32_t *count, MesoArena *arena, const MesoInput *input,
                                   const MesoCamera *usual, MesoError *error)
{
    size_t frames = input->size / MATRIX_BYTES;
    if (frames == 0 || frames > MOST_FRAMES || input->size % MATRIX_BYTES)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %zu bytes are not 1 to %d view matrices of 64", input->path,
                         input->size, MOST_FRAMES);
    *count = (uint32_t)frames;
    *keys = MESO_NEW(arena, MesoCameraKey, frames, error);
    if (!*keys)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < *count; i++) {
        (*keys)[i] = (MesoCameraKey){(int32_t)i + 1, *usual};
        if (!read_matrix(&(*keys)[i].camera, input->data + (size_t)i * MATRIX_BYTES))
            return meso_fail(error, MESO_ERR_INPUT, "%s: frame %u is not a view matrix: its axes are not orthonormal, "
                             "or its last row is not 0, 0, 0, 1", input->path, i + 1);
    }
    return MESO_OK;
}
