#include "libcore/render/targets.h"

#include <math.h>
#include <stddef.h>

static const GLenum SURFACE_FORMATS[MESO_SURFACE_TARGETS] = {
    [MESO_TARGET_NORMAL] = GL_RGBA16F,
    [MESO_TARGET_ALBEDO] = GL_RGBA16F,
    [MESO_TARGET_DEPTH] = GL_R32F,
    [MESO_TARGET_IDS] = GL_R32UI,
};

static GLuint make_texture(const MesoGl *gl, GLenum format, uint32_t width, uint32_t height)
{
    GLuint texture = 0;
    gl->CreateTextures(GL_TEXTURE_2D, 1, &texture);
    gl->TextureStorage2D(texture, 1, format, (GLsizei)width, (GLsizei)height);
    gl->TextureParameteri(texture, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    gl->TextureParameteri(texture, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

static GLuint make_frame(const MesoGl *gl, const GLuint *colors, GLsizei color_count, GLuint z)
{
    static const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                     GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3};
    GLuint frame = 0;
    gl->CreateFramebuffers(1, &frame);
    for (GLsizei i = 0; i < color_count; i++)
        gl->NamedFramebufferTexture(frame, buffers[i], colors[i], 0);
    if (z)
        gl->NamedFramebufferTexture(frame, GL_DEPTH_ATTACHMENT, z, 0);
    gl->NamedFramebufferDrawBuffers(frame, color_count, buffers);
    return frame;
}

static void make_surface(MesoTargets *targets)
{
    const MesoGl *gl = targets->gl;
    uint32_t w = targets->width, h = targets->height, n = targets->sample_side;
    for (uint32_t i = 0; i < MESO_SURFACE_TARGETS; i++)
        targets->center[i] = make_texture(gl, SURFACE_FORMATS[i], w, h);
    targets->center_z = make_texture(gl, GL_DEPTH_COMPONENT32F, w, h);
    targets->center_frame = make_frame(gl, targets->center, MESO_SURFACE_TARGETS, targets->center_z);
    if (n > 1) {
        targets->multi = make_texture(gl, GL_RGBA32UI, n * w, n * h);
        targets->multi_z = make_texture(gl, GL_DEPTH_COMPONENT32F, n * w, n * h);
        targets->multi_frame = make_frame(gl, &targets->multi, 1, targets->multi_z);
    }
}

static void make_shadow(MesoTargets *targets)
{
    const MesoGl *gl = targets->gl;
    targets->shadow = make_texture(gl, GL_DEPTH_COMPONENT32F, targets->shadow_size,
                                   targets->shadow_size);
    gl->TextureParameteri(targets->shadow, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    gl->TextureParameteri(targets->shadow, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    gl->TextureParameteri(targets->shadow, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    gl->TextureParameteri(targets->shadow, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    gl->TextureParameteri(targets->shadow, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    gl->TextureParameteri(targets->shadow, GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
    targets->shadow_frame = make_frame(gl, NULL, 0, targets->shadow);
}

static MesoStatus check_frames(const MesoTargets *targets, MesoError *error)
{
    const GLuint frames[] = {targets->center_frame, targets->multi_frame,
                             targets->openness_raw_frame, targets->openness_frame,
                             targets->color_frame, targets->shadow_frame};
    MesoStatus status = meso_gl_check(targets->gl, "framebuffers", error);
    for (size_t i = 0; !status && i < sizeof frames / sizeof *frames; i++)
        if (frames[i] && targets->gl->CheckNamedFramebufferStatus(frames[i], GL_FRAMEBUFFER)
                             != GL_FRAMEBUFFER_COMPLETE)
            status = meso_fail(error, MESO_ERR_LIMIT, "GL driver has no framebuffer of %u x %u",
                               targets->sample_side * targets->width,
                               targets->sample_side * targets->height);
    return status;
}

MesoStatus meso_targets_init(MesoTargets *targets, const MesoGl *gl, uint32_t width, uint32_t height,
                             uint32_t sample_side, uint32_t shadow_size, MesoError *error)
{
    *targets = (MesoTargets){.gl = gl, .width = width, .height = height, .sample_side = sample_side,
                             .shadow_size = shadow_size};
    make_surface(targets);
    make_shadow(targets);
    targets->openness_raw = make_texture(gl, GL_R16F, width, height);
    targets->openness = make_texture(gl, GL_R16F, width, height);
    targets->color = make_texture(gl, GL_RGBA32F, width, height);
    targets->openness_raw_frame = make_frame(gl, &targets->openness_raw, 1, 0);
    targets->openness_frame = make_frame(gl, &targets->openness, 1, 0);
    targets->color_frame = make_frame(gl, &targets->color, 1, 0);

    MesoStatus status = check_frames(targets, error);
    if (status)
        meso_targets_release(targets);
    return status;
}

size_t meso_targets_bytes(uint32_t width, uint32_t height, uint32_t sample_side, uint32_t shadow_size)
{
    /* normal and albedo of 8, depth 4, ids 4, z 4; openness twice 2; color 16 */
    size_t pixel_bytes = 2 * 8 + 4 + 4 + 4 + 2 * 2 + 16;
    if (sample_side > 1)
        pixel_bytes += (size_t)sample_side * sample_side * (16 + 4);
    return pixel_bytes * width * height + (size_t)4 * shadow_size * shadow_size;
}

void meso_targets_release(MesoTargets *targets)
{
    const MesoGl *gl = targets->gl;
    if (!gl)
        return;
    const GLuint frames[] = {targets->center_frame, targets->multi_frame,
                             targets->openness_raw_frame, targets->openness_frame,
                             targets->color_frame, targets->shadow_frame};
    const GLuint textures[] = {targets->multi, targets->center_z, targets->multi_z, targets->openness_raw,
                               targets->openness, targets->color, targets->shadow};
    gl->DeleteFramebuffers(sizeof frames / sizeof *frames, frames);
    gl->DeleteTextures(sizeof textures / sizeof *textures, textures);
    gl->DeleteTextures(MESO_SURFACE_TARGETS, targets->center);
    *targets = (MesoTargets){0};
}

static void begin(const MesoTargets *targets, GLuint frame, uint32_t side)
{
    static const float z = 0;
    const MesoGl *gl = targets->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, frame);
    gl->Viewport(0, 0, (GLsizei)(side * targets->width), (GLsizei)(side * targets->height));
    gl->ClearNamedFramebufferfv(frame, GL_DEPTH, 0, &z);
}

void meso_targets_begin_center(const MesoTargets *targets)
{
    static const float nothing[4] = {0}, farthest[4] = {INFINITY, 0, 0, 0};
    static const GLuint nobody[4] = {0};
    const MesoGl *gl = targets->gl;
    GLuint frame = targets->center_frame;
    begin(targets, frame, 1);
    gl->ClearNamedFramebufferfv(frame, GL_COLOR, MESO_TARGET_NORMAL, nothing);
    gl->ClearNamedFramebufferfv(frame, GL_COLOR, MESO_TARGET_ALBEDO, nothing);
    gl->ClearNamedFramebufferfv(frame, GL_COLOR, MESO_TARGET_DEPTH, farthest);
    gl->ClearNamedFramebufferuiv(frame, GL_COLOR, MESO_TARGET_IDS, nobody);
}

/* Its depth buffer tells what is empty. */
void meso_targets_begin_multi(const MesoTargets *targets)
{
    begin(targets, targets->multi_frame, targets->sample_side);
}

void meso_targets_begin_shadow(const MesoTargets *targets)
{
    static const float z = 0;
    const MesoGl *gl = targets->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, targets->shadow_frame);
    gl->Viewport(0, 0, (GLsizei)targets->shadow_size, (GLsizei)targets->shadow_size);
    gl->ClearNamedFramebufferfv(targets->shadow_frame, GL_DEPTH, 0, &z);
}
