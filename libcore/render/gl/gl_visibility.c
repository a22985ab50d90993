#include "libcore/render/gl/gl_visibility.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/large_pages.h"
#include "libcore/render/gl/draw_batch.h"
#include "libcore/render/gl/draw_lists.h"

/* What shaders/seen_fragment.glsl writes: a target each, of four words. */
enum { SEEN, DETAILS, TARGETS, WORDS = 4 };

/* What OpenGL promises. */
enum { LEAST_SUBPIXEL_BITS = 4 };

/* Pixels a side of the framebuffer at most, in which the window has a place for each sample. */
enum { FRAME_SIDE = 1024 };

struct MesoGlVisibility {
    MesoGl gl;
    bool loaded;                /* it is */
    MesoRasterJob job;
    MesoRasterLanes lanes;
    MesoView view;
    bool bends;                 /* the lists are drawn, and else batches */
    MesoDrawLists lists;
    MesoDrawPrograms programs;
    MesoDrawBatch batch;
    float end_depth;
    bool detailed;
    uint32_t target_count, thread_count;
    uint32_t subpixel_bits;     /* of a pixel, to which the driver rounds corners */
    uint32_t frame_width, frame_height;
    GLuint targets[TARGETS], depth, frame;
    uint32_t *words[TARGETS];   /* [4 * pixels of the window * samples] row by row of the framebuffer */
    size_t sizes[TARGETS];      /* of them, from the system */
    MesoWindow window;          /* drawn last */
    MesoMatrix clips[MESO_RASTER_LANES];    /* of its samples */
    bool empty;                 /* nothing is in it */
};

/* Places of samples beside each other in the framebuffer; as many are below each other. */
static uint32_t places_across(uint32_t samples)
{
    return samples == 1 ? 1 : samples == 4 ? 2 : 4;
}

uint32_t meso_gl_window_side(uint32_t samples)
{
    return FRAME_SIDE / places_across(samples);
}

/* Pixels of the framebuffer along a side of the picture. */
static uint32_t frame_side(uint32_t pixels, uint32_t samples)
{
    uint32_t side = meso_gl_window_side(samples);
    return places_across(samples) * (pixels < side ? pixels : side);
}

size_t meso_gl_window_bytes(uint32_t width, uint32_t height, uint32_t samples)
{
    size_t pixels = (size_t)frame_side(width, samples) * frame_side(height, samples);
    return (2 * TARGETS * WORDS + 1) * sizeof(uint32_t) * pixels;
}

/* The near plane of a perspective, the far one of a parallel view (projection.h). */
static float end_depth_of(const MesoView *view, const MesoBox *box)
{
    float nearest = INFINITY, farthest = 0;
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec3 corner = meso_box_corner(box->low, box->high, i);
        float depth = meso_vec3_dot(meso_vec3_sub(corner, view->eye), view->forward);
        nearest = fminf(nearest, depth);
        farthest = fmaxf(farthest, depth);
    }
    float depth = view->parallel ? 1.001f * farthest : fmaxf(0.5f * nearest, 1e-5f * farthest);
    return depth > 0 && isfinite(depth) ? depth : 1e-3f;
}

static GLuint make_texture(const MesoGlVisibility *v, GLenum format)
{
    GLuint texture = 0;
    v->gl.CreateTextures(GL_TEXTURE_2D, 1, &texture);
    v->gl.TextureStorage2D(texture, 1, format, (GLsizei)v->frame_width, (GLsizei)v->frame_height);
    return texture;
}

static MesoStatus make_frame(MesoGlVisibility *v, MesoError *error)
{
    static const GLenum buffers[TARGETS] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    const MesoGl *gl = &v->gl;
    gl->CreateFramebuffers(1, &v->frame);
    for (uint32_t i = 0; i < v->target_count; i++) {
        v->targets[i] = make_texture(v, GL_RGBA32UI);
        gl->NamedFramebufferTexture(v->frame, buffers[i], v->targets[i], 0);
    }
    v->depth = make_texture(v, GL_DEPTH_COMPONENT32F);
    gl->NamedFramebufferTexture(v->frame, GL_DEPTH_ATTACHMENT, v->depth, 0);
    gl->NamedFramebufferDrawBuffers(v->frame, (GLsizei)v->target_count, buffers);
    MesoStatus status = meso_gl_check(gl, "framebuffer", error);
    if (!status && gl->CheckNamedFramebufferStatus(v->frame, GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        status = meso_fail(error, MESO_ERR_LIMIT, "GL driver has no framebuffer of %u x %u",
                           v->frame_width, v->frame_height);
    return status;
}

static uint32_t find_subpixel_bits(const MesoGl *gl)
{
    GLint bits = 0;
    gl->GetIntegerv(GL_SUBPIXEL_BITS, &bits);
    return bits < LEAST_SUBPIXEL_BITS ? LEAST_SUBPIXEL_BITS : (uint32_t)bits;
}

static void set_state(const MesoGl *gl)
{
    gl->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_GREATER);
    gl->Disable(GL_CULL_FACE);
    gl->FrontFace(GL_CW);       /* rows run downwards, which mirrors the picture */
}

static MesoStatus make_words(MesoGlVisibility *v, MesoError *error)
{
    for (uint32_t i = 0; i < v->target_count; i++) {
        v->sizes[i] = sizeof(uint32_t) * WORDS * v->frame_width * v->frame_height;
        v->words[i] = meso_large_take(&v->sizes[i]);
        if (!v->words[i])
            return meso_fail(error, MESO_ERR_MEMORY, "out of memory for drawing");
    }
    return MESO_OK;
}

static void clear_window(MesoGlVisibility *v);

/* Draws a triangle of no area with all that batches are drawn with: drivers compile that when they first meet it. */
static MesoStatus draw_nothing(MesoGlVisibility *v, MesoError *error)
{
    static const MesoMatrix as_it_is = {{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    static const MesoView no_view;
    MesoSiftVertex corners[3] = {0};
    uint32_t indices[3] = {0, 1, 2};
    const MesoSiftBatch batch = {.vertex_count = 3, .vertices = corners, .index_counts = {3}, .indices = {indices}};
    clear_window(v);
    v->gl.Viewport(0, 0, 1, 1);
    meso_draw_batch_take(&v->batch, &v->gl, &batch);
    meso_draw_batch_sample(&v->batch, &v->gl, &batch, 0, &as_it_is, &no_view);
    return meso_gl_check(&v->gl, "drawing", error);
}

static MesoStatus make_ready(MesoGlVisibility *v, const MesoGlContext *context, MesoError *error)
{
    MesoStatus status = meso_gl_load(&v->gl, context, error);
    if (status)
        return status;
    v->loaded = true;
    status = make_words(v, error);
    if (!status)
        status = make_frame(v, error);
    if (status)
        return status;
    set_state(&v->gl);
    v->subpixel_bits = find_subpixel_bits(&v->gl);
    if (v->bends)
        return MESO_OK;
    status = meso_draw_batch_init(&v->batch, &v->gl, v->detailed, error);
    return status ? status : draw_nothing(v, error);
}

MesoStatus meso_gl_visibility_init(MesoGlVisibility **out, const MesoGlContext *context, uint32_t width,
                                   uint32_t height, uint32_t samples, bool detailed, MesoError *error)
{
    MesoGlVisibility *v = *out = calloc(1, sizeof *v);
    if (!v)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for drawing");
    *v = (MesoGlVisibility){.bends = context->bends, .detailed = detailed, .target_count = detailed ? TARGETS : 1,
                            .frame_width = frame_side(width, samples), .frame_height = frame_side(height, samples)};
    MesoStatus status = make_ready(v, context, error);
    if (status) {
        meso_gl_visibility_release(v);
        *out = NULL;
    }
    return status;
}

MesoStatus meso_gl_visibility_begin(MesoGlVisibility *v, MesoArena *arena, const MesoRasterJob *job,
                                    const MesoView *view, uint32_t thread_count, MesoError *error)
{
    const MesoScene *scene = job->shapes->scene;
    v->job = *job;
    v->lanes = meso_raster_lanes(job->samples);
    v->view = *view;
    v->end_depth = end_depth_of(view, &scene->box);
    v->thread_count = thread_count;
    if (!v->bends)
        return MESO_OK;
    if (scene->maker)
        return meso_fail(error, MESO_ERR_LIMIT, "a scene whose sweeps are not held is not for a GPU");
    MesoStatus status = meso_draw_programs_init(&v->programs, &v->gl, scene, v->detailed, error);
    return status ? status : meso_draw_lists_init(&v->lists, arena, &v->gl, job->shapes, view, job->height,
                                                  job->tolerance, error);
}

static void release_drawing(MesoGlVisibility *v)
{
    meso_draw_lists_release(&v->lists);
    meso_draw_programs_release(&v->programs, &v->gl);
    meso_draw_batch_release(&v->batch, &v->gl);
    v->gl.DeleteFramebuffers(1, &v->frame);
    v->gl.DeleteTextures(TARGETS, v->targets);
    v->gl.DeleteTextures(1, &v->depth);
}

void meso_gl_visibility_release(MesoGlVisibility *v)
{
    if (!v)
        return;
    if (v->loaded)
        release_drawing(v);
    for (uint32_t i = 0; i < TARGETS; i++)
        meso_large_give(v->words[i], v->sizes[i]);
    free(v);
}

/* ---- a window ---- */

/* Moves the picture so that the place (x, y), in units from the pixel's middle, comes to lie there. */
static MesoMatrix moved(MesoMatrix clip, MesoWindow window, int32_t x, int32_t y)
{
    float right = -2 * (float)x / (MESO_RASTER_UNIT * (float)window.width);
    float down = -2 * (float)y / (MESO_RASTER_UNIT * (float)window.height);
    for (uint32_t column = 0; column < 4; column++) {
        float *m = clip.m + 4 * column;
        m[0] += right * m[3];
        m[1] += down * m[3];
    }
    return clip;
}

/* The first pixel of a sample's place in the framebuffer. */
static void find_place(const MesoGlVisibility *v, uint32_t sample, uint32_t *x, uint32_t *y)
{
    uint32_t across = places_across(v->job.samples);
    *x = sample % across * v->window.width;
    *y = sample / across * v->window.height;
}

static void clear_window(MesoGlVisibility *v)
{
    static const GLuint nothing[4] = {0};
    static const float farthest = 0;
    const MesoGl *gl = &v->gl;
    gl->BindFramebuffer(GL_FRAMEBUFFER, v->frame);
    gl->ClearNamedFramebufferfv(v->frame, GL_DEPTH, 0, &farthest);
    gl->ClearNamedFramebufferuiv(v->frame, GL_COLOR, SEEN, nothing);    /* the details of nothing are not looked at */
    v->empty = false;
}

static void look_at_sample(const MesoGlVisibility *v, uint32_t sample)
{
    uint32_t x, y;
    find_place(v, sample, &x, &y);
    v->gl.Viewport((GLint)x, (GLint)y, (GLsizei)v->window.width, (GLsizei)v->window.height);
}

static MesoStatus draw_batch(void *context, const MesoSiftBatch *batch, MesoError *error)
{
    MesoGlVisibility *v = context;
    if (v->empty)
        clear_window(v);
    meso_draw_batch_take(&v->batch, &v->gl, batch);
    for (uint32_t i = 0; i < v->job.samples; i++) {
        look_at_sample(v, i);
        meso_draw_batch_sample(&v->batch, &v->gl, batch, i, &v->clips[i], &v->view);
    }
    v->gl.Flush();              /* else triangles are held until there are very many, and drawn at last */
    return meso_gl_check(&v->gl, "drawing", error);
}

static void draw_lists(MesoGlVisibility *v, const MesoMatrix *clip)
{
    meso_draw_lists_select(&v->lists, clip);
    clear_window(v);
    for (uint32_t i = 0; i < v->job.samples; i++) {
        look_at_sample(v, i);
        meso_draw_lists_draw(&v->lists, &v->programs, &v->clips[i], &v->view);
    }
}

static void read_window(MesoGlVisibility *v)
{
    const MesoGl *gl = &v->gl;
    uint32_t across = places_across(v->job.samples);
    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    for (uint32_t i = 0; i < v->target_count; i++) {
        gl->NamedFramebufferReadBuffer(v->frame, GL_COLOR_ATTACHMENT0 + i);
        gl->ReadPixels(0, 0, (GLsizei)(across * v->window.width), (GLsizei)(across * v->window.height),
                       GL_RGBA_INTEGER, GL_UNSIGNED_INT, v->words[i]);
    }
}

MesoStatus meso_gl_visibility_draw(MesoGlVisibility *v, MesoWindow window, MesoError *error)
{
    MesoMatrix clip = meso_view_clip_from_world(&v->view, v->end_depth, v->job.width, v->job.height, window);
    MesoStatus status = MESO_OK;
    int32_t middle = MESO_RASTER_UNIT / 2;
    v->window = window;
    v->empty = true;
    for (uint32_t i = 0; i < v->job.samples; i++)
        v->clips[i] = moved(clip, window, v->lanes.x[i] - middle, v->lanes.y[i] - middle);
    if (v->bends)
        draw_lists(v, &clip);
    else
        status = meso_sift(&v->job, window, v->subpixel_bits, v->thread_count, draw_batch, v, error);
    if (!status && !v->empty)
        read_window(v);
    return status ? status : meso_gl_check(&v->gl, "drawing", error);
}

/* ---- samples ---- */

static float float_of(uint32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* "A Survey of Efficient Representations for Independent Unit Vectors" (Cigolle and others 2014). */
static MesoVec3 unpack_normal(uint32_t bits)
{
    float x = (float)(int16_t)(bits & 0xffff) / 32767, y = (float)(int16_t)(bits >> 16) / 32767;
    float z = 1 - fabsf(x) - fabsf(y);
    MesoVec3 n = {x, y, z};
    if (z < 0)
        n = (MesoVec3){copysignf(1 - fabsf(y), x), copysignf(1 - fabsf(x), y), z};
    return meso_vec3_unit(n, (MesoVec3){0, 0, 1});
}

bool meso_gl_visibility_sample(const MesoGlVisibility *v, uint32_t x, uint32_t y, uint32_t sample,
                               MesoSurfaceSample *out)
{
    const float unit = 1.f / MESO_RASTER_UNIT;
    uint32_t left, top;
    find_place(v, sample, &left, &top);
    size_t at = (size_t)(top + y) * places_across(v->job.samples) * v->window.width + left + x;
    const uint32_t *seen = v->words[SEEN] + WORDS * at;
    if (v->empty || seen[0] == 0)
        return false;
    MesoRasterRay ray = meso_raster_ray(&v->job.view, (float)(v->window.x + x) + (float)v->lanes.x[sample] * unit,
                                        (float)(v->window.y + y) + (float)v->lanes.y[sample] * unit);
    float depth = float_of(seen[1]);
    *out = (MesoSurfaceSample){.shape = seen[0] - 1, .position = meso_vec3_mad(ray.origin, depth, ray.direction),
                               .normal = unpack_normal(seen[2]), .depth = depth, .along = float_of(seen[3]),
                               .color = {1, 1, 1}};
    if (v->target_count == 1)
        return true;
    const uint32_t *details = v->words[DETAILS] + WORDS * at;
    out->uv = (MesoVec2){float_of(details[0]), float_of(details[1])};
    for (int c = 0; c < 3; c++)
        out->color[c] = (float)(details[2] >> 8 * c & 255) / 255;
    return true;
}
