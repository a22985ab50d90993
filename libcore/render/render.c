/*
 * Deferred: one pass over the geometry finds the surface at each pixel's
 * centre, which gives the AOVs and the ambient occlusion; one more finds it at
 * each sample of the antialiased colour; a third the key light's shadows.
 * Light is computed on the picture. Large images are drawn window by window,
 * so that the driver's memory is bounded.
 */
#include "libcore/render/render.h"

#include "libcore/render/draw_lists.h"
#include "libcore/render/targets.h"

extern const char meso_shader_screen_vertex[], meso_shader_occlusion_fragment[];
extern const char meso_shader_occlusion_blur_fragment[], meso_shader_shade_fragment[];

enum { MAX_SIZE = 16384, WINDOW_SIZE = 2560, MIN_SHADOW = 1024, MAX_SHADOW = 4096 };

/* Uniforms by the locations that the shaders give them. */
enum {
    RAY_ORIGIN, RAY_RIGHT, RAY_DOWN, RAY_AXIS = 14,
    OCCLUSION_RADIUS = 3, PIXELS_AT_ONE, RADIUS_PIXELS, TARGET_ORIGIN, OCCLUSION_COUNT,
    LIGHT_FROM_EYE = 3, TO_KEY = 7, TO_RIM, SKY_UP, SHADOW_TEXEL, END_DEPTH, SAMPLE_COUNT, SHADOW_SIDE
};

/* How far thinned geometry may lie from the kind's own, in pixels. */
static const float TOLERANCE_PIXELS = 0.25f;

/* Places that the occlusion of a pixel looks at; taps a side of the shadow's filter. */
enum { OCCLUSION_SAMPLES = 20, SHADOW_TAPS = 4 };

/* Occlusion reaches over the scene's layer and a share of the whole, at most so many pixels of a window. */
static const float OCCLUSION_LAYERS = 0.9f, OCCLUSION_SHARE = 0.015f;
static const uint32_t MAX_OCCLUSION_PIXELS = 256;

typedef struct Renderer {
    MesoGl gl;
    const MesoRenderOptions *options;
    MesoView view;
    const MesoScene *scene;
    MesoBox box;                /* around the scene, relative to the view's anchor */
    MesoDrawLists lists;
    MesoDrawPrograms surface, packed, depth;
    GLuint occlusion, blur, shade, empty_array;
    MesoTargets targets;
    MesoMatrix light;
    MesoVec3 to_key, to_rim;
    float end_depth, shadow_texel, occlusion_radius;
    uint32_t margin;            /* pixels around a window that its occlusion looks at */
} Renderer;

static MesoStatus check_options(const MesoRenderOptions *options, MesoError *error)
{
    if (options->width < 1 || options->width > MAX_SIZE || options->height < 1
        || options->height > MAX_SIZE)
        return meso_fail(error, MESO_ERR_LIMIT, "image of %u x %u is not between 1 x 1 and %u x %u",
                         options->width, options->height, MAX_SIZE, MAX_SIZE);
    if (options->samples != 1 && options->samples != 4 && options->samples != 16)
        return meso_fail(error, MESO_ERR_USAGE, "%u samples a pixel (1, 4 or 16)", options->samples);
    return MESO_OK;
}

/* Bytes a pixel of the arrays, in the order of their places, each a multiple of 64 from the first. */
enum { COLOR_BYTES = 16, DEPTH_BYTES = 4, NORMAL_BYTES = 12, ALBEDO_BYTES = 12, ID_BYTES = 4 };

static size_t array_bytes(const MesoRenderOptions *options, size_t pixel_bytes)
{
    return (pixel_bytes * options->width * options->height + 63) & ~(size_t)63;
}

void meso_image_place(MesoImage *image, void *memory, const MesoScene *scene, const MesoRenderOptions *options)
{
    unsigned char *next = memory;
    *image = (MesoImage){.width = options->width, .height = options->height, .camera = options->camera};
    image->color = (float *)next;
    next += array_bytes(options, COLOR_BYTES);
    image->depth = (float *)next;
    next += array_bytes(options, DEPTH_BYTES);
    image->normal = (float *)next;
    next += array_bytes(options, NORMAL_BYTES);
    image->albedo = (float *)next;
    next += array_bytes(options, ALBEDO_BYTES);
    image->channel_count = scene->channel_count;
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        image->channels[c] = scene->channels[c];
        image->ids[c] = (uint32_t *)next;
        next += array_bytes(options, ID_BYTES);
    }
}

static MesoStatus make_programs(Renderer *r, MesoError *error)
{
    const char *screen = meso_shader_screen_vertex;
    const char *samples = r->options->samples == 4 ? "#define SAMPLES 4\n" : "#define SAMPLES 1\n";
    MesoStatus status = meso_draw_programs_init(&r->surface, &r->gl, MESO_DRAW_SURFACE, r->scene, error);
    if (!status && r->options->samples > 1)
        status = meso_draw_programs_init(&r->packed, &r->gl, MESO_DRAW_PACKED, r->scene, error);
    if (!status)
        status = meso_draw_programs_init(&r->depth, &r->gl, MESO_DRAW_DEPTH, r->scene, error);
    if (!status)
        status = meso_gl_program(&r->occlusion, &r->gl, "", screen, meso_shader_occlusion_fragment, error);
    if (!status)
        status = meso_gl_program(&r->blur, &r->gl, "", screen, meso_shader_occlusion_blur_fragment, error);
    if (!status)
        status = meso_gl_program(&r->shade, &r->gl, samples, screen, meso_shader_shade_fragment, error);
    return status;
}

static MesoVec3 in_view(const MesoView *view, float right, float up, float back)
{
    MesoVec3 v = meso_vec3_mad(meso_vec3_scale(view->right, right), up, view->up);
    return meso_vec3_unit(meso_vec3_mad(v, -back, view->forward), view->up);
}

/* Near plane, lights and occlusion from the box around the scene. */
static void measure(Renderer *r)
{
    MesoBox box = r->box;
    float nearest = INFINITY, farthest = 0;
    MesoVec3 eye = meso_vec3_sub(r->view.eye, r->view.anchor);
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec3 corner = meso_box_corner(box.low, box.high, i);
        float depth = meso_vec3_dot(meso_vec3_sub(corner, eye), r->view.forward);
        nearest = fminf(nearest, depth);
        farthest = fmaxf(farthest, depth);
    }
    r->end_depth = r->view.parallel ? 1.001f * farthest : fmaxf(0.5f * nearest, 1e-5f * farthest);
    if (!(r->end_depth > 0 && isfinite(r->end_depth)))
        r->end_depth = 1e-3f;

    r->to_key = in_view(&r->view, -0.55f, 0.8f, 0.7f);
    r->to_rim = in_view(&r->view, 0.75f, 0.35f, -0.55f);
    float extent, size = meso_vec3_length(meso_vec3_sub(box.high, box.low));
    r->light = meso_light_clip_from_world(meso_vec3_scale(r->to_key, -1), box.low, box.high,
                                          &extent);
    r->shadow_texel = extent / (float)r->targets.shadow_size;
    r->occlusion_radius = OCCLUSION_LAYERS * r->scene->thickness + OCCLUSION_SHARE * size;
    if (!(r->occlusion_radius > 0 && isfinite(r->occlusion_radius)))
        r->occlusion_radius = 1;
}

static uint32_t smaller(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

/* A texel of the shadow is about half a pixel of the image, up to a size that is still quick. */
static uint32_t shadow_size(const MesoRenderOptions *options)
{
    uint32_t wanted = 2 * (options->width > options->height ? options->width : options->height);
    uint32_t size = MIN_SHADOW;
    while (size < wanted && size < MAX_SHADOW)
        size *= 2;
    return size;
}

/* The targets of `options`, whose pixels reach `margin` beyond a window. */
static MesoTargets plan_targets(const MesoRenderOptions *options, uint32_t *margin)
{
    *margin = smaller(options->height / 12 + 2, MAX_OCCLUSION_PIXELS);
    uint32_t most = WINDOW_SIZE + 2 * *margin;
    return (MesoTargets){.width = smaller(options->width, most), .height = smaller(options->height, most),
                         .sample_side = options->samples == 4 ? 2 : 1, .shadow_size = shadow_size(options)};
}

static MesoStatus make_targets(Renderer *r, MesoError *error)
{
    MesoTargets plan = plan_targets(r->options, &r->margin);
    return meso_targets_init(&r->targets, &r->gl, plan.width, plan.height, plan.sample_side,
                             plan.shadow_size, error);
}

static void draw_shadow(Renderer *r)
{
    const MesoGl *gl = &r->gl;
    meso_targets_begin_shadow(&r->targets);
    gl->Enable(GL_POLYGON_OFFSET_FILL);
    gl->PolygonOffset(-1.5f, -4);
    meso_draw_lists_draw(&r->lists, &r->depth, &r->light, NULL);
    gl->Disable(GL_POLYGON_OFFSET_FILL);
}

/* Rays of the target's pixels; its row 0 is the top. */
static void set_rays(const Renderer *r, GLuint program, MesoWindow window)
{
    const MesoView *view = &r->view;
    float pixel = 2 * view->half_height / (float)r->options->height;
    MesoVec3 right = meso_vec3_scale(view->right, pixel);
    MesoVec3 down = meso_vec3_scale(view->up, -pixel);
    MesoVec3 middle = view->parallel ? (MesoVec3){0, 0, 0} : view->forward;
    MesoVec3 axis = view->parallel ? view->forward : (MesoVec3){0, 0, 0};
    MesoVec3 origin = meso_vec3_mad(middle, (float)window.x - 0.5f * (float)r->options->width,
                                    right);
    origin = meso_vec3_mad(origin, (float)window.y - 0.5f * (float)r->options->height, down);
    r->gl.ProgramUniform3f(program, RAY_ORIGIN, origin.x, origin.y, origin.z);
    r->gl.ProgramUniform3f(program, RAY_RIGHT, right.x, right.y, right.z);
    r->gl.ProgramUniform3f(program, RAY_DOWN, down.x, down.y, down.z);
    r->gl.ProgramUniform4f(program, RAY_AXIS, axis.x, axis.y, axis.z, view->parallel ? 1 : 0);
}

static void draw_screen(const Renderer *r, GLuint frame, GLuint program)
{
    r->gl.BindFramebuffer(GL_FRAMEBUFFER, frame);
    r->gl.UseProgram(program);
    r->gl.BindVertexArray(r->empty_array);
    r->gl.DrawArrays(GL_TRIANGLES, 0, 3);
}

static void draw_occlusion(const Renderer *r, MesoWindow window)
{
    const MesoGl *gl = &r->gl;
    const MesoTargets *targets = &r->targets;
    set_rays(r, r->occlusion, window);
    gl->ProgramUniform1f(r->occlusion, OCCLUSION_RADIUS, r->occlusion_radius);
    gl->ProgramUniform1f(r->occlusion, PIXELS_AT_ONE,
                         (float)r->options->height / (2 * r->view.half_height));
    gl->ProgramUniform1f(r->occlusion, RADIUS_PIXELS, (float)(r->margin - 2));
    gl->ProgramUniform2i(r->occlusion, TARGET_ORIGIN, (GLint)window.x, (GLint)window.y);
    gl->ProgramUniform1i(r->occlusion, OCCLUSION_COUNT, OCCLUSION_SAMPLES);
    gl->BindTextureUnit(0, targets->center[MESO_TARGET_DEPTH]);
    gl->BindTextureUnit(1, targets->center[MESO_TARGET_NORMAL]);
    draw_screen(r, targets->openness_raw_frame, r->occlusion);

    gl->ProgramUniform1f(r->blur, OCCLUSION_RADIUS, r->occlusion_radius);
    gl->BindTextureUnit(1, targets->openness_raw);
    draw_screen(r, targets->openness_frame, r->blur);
}

static void draw_light(const Renderer *r, MesoWindow window)
{
    const MesoGl *gl = &r->gl;
    const MesoTargets *targets = &r->targets;
    MesoMatrix light = r->light;
    MesoVec3 eye = meso_vec3_sub(r->view.eye, r->view.anchor);
    for (uint32_t row = 0; row < 4; row++)
        light.m[12 + row] += light.m[row] * eye.x + light.m[4 + row] * eye.y + light.m[8 + row] * eye.z;

    set_rays(r, r->shade, window);
    gl->ProgramUniformMatrix4fv(r->shade, LIGHT_FROM_EYE, 1, GL_FALSE, light.m);
    gl->ProgramUniform3f(r->shade, TO_KEY, r->to_key.x, r->to_key.y, r->to_key.z);
    gl->ProgramUniform3f(r->shade, TO_RIM, r->to_rim.x, r->to_rim.y, r->to_rim.z);
    gl->ProgramUniform3f(r->shade, SKY_UP, r->view.up.x, r->view.up.y, r->view.up.z);
    gl->ProgramUniform1f(r->shade, SHADOW_TEXEL, r->shadow_texel);
    gl->ProgramUniform1f(r->shade, END_DEPTH, r->end_depth);
    gl->ProgramUniform1i(r->shade, SAMPLE_COUNT, (GLint)r->options->samples);
    gl->ProgramUniform1i(r->shade, SHADOW_SIDE, SHADOW_TAPS);
    if (targets->sample_side > 1) {
        gl->BindTextureUnit(0, targets->multi_z);
        gl->BindTextureUnit(1, targets->multi);
    } else {
        gl->BindTextureUnit(0, targets->center[MESO_TARGET_DEPTH]);
        gl->BindTextureUnit(1, targets->center[MESO_TARGET_NORMAL]);
        gl->BindTextureUnit(2, targets->center[MESO_TARGET_ALBEDO]);
    }
    gl->BindTextureUnit(3, targets->center[MESO_TARGET_DEPTH]);
    gl->BindTextureUnit(4, targets->openness);
    gl->BindTextureUnit(5, targets->shadow);
    draw_screen(r, targets->color_frame, r->shade);
}

/* The part `inner` of the target, whose corner is at `outer` of the image, to the image's arrays. */
static void read_back(const Renderer *r, MesoImage *image, MesoWindow inner, MesoWindow outer)
{
    const MesoGl *gl = &r->gl;
    GLint x = (GLint)(inner.x - outer.x), y = (GLint)(inner.y - outer.y);
    GLsizei w = (GLsizei)inner.width, h = (GLsizei)inner.height;
    size_t first = (size_t)inner.y * image->width + inner.x;

    gl->PixelStorei(GL_PACK_ALIGNMENT, 4);
    gl->PixelStorei(GL_PACK_ROW_LENGTH, (GLint)image->width);
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, r->targets.color_frame);
    gl->ReadPixels(x, y, w, h, GL_RGBA, GL_FLOAT, image->color + 4 * first);

    GLuint center = r->targets.center_frame;
    gl->BindFramebuffer(GL_READ_FRAMEBUFFER, center);
    gl->NamedFramebufferReadBuffer(center, GL_COLOR_ATTACHMENT0 + MESO_TARGET_DEPTH);
    gl->ReadPixels(x, y, w, h, GL_RED, GL_FLOAT, image->depth + first);
    gl->NamedFramebufferReadBuffer(center, GL_COLOR_ATTACHMENT0 + MESO_TARGET_NORMAL);
    gl->ReadPixels(x, y, w, h, GL_RGB, GL_FLOAT, image->normal + 3 * first);
    gl->NamedFramebufferReadBuffer(center, GL_COLOR_ATTACHMENT0 + MESO_TARGET_ALBEDO);
    gl->ReadPixels(x, y, w, h, GL_RGB, GL_FLOAT, image->albedo + 3 * first);
    if (image->channel_count == 0)
        return;
    gl->NamedFramebufferReadBuffer(center, GL_COLOR_ATTACHMENT0 + MESO_TARGET_IDS);
    gl->ReadPixels(x, y, w, h, GL_RED_INTEGER, GL_UNSIGNED_INT, image->ids[0] + first);
}

/* The pixels have rows of the scene's ids in the first channel's place, which is filled last. */
static void look_up_ids(const MesoScene *scene, MesoImage *image)
{
    size_t count = image->channel_count ? (size_t)image->width * image->height : 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t row = image->ids[0][i];
        for (uint32_t c = image->channel_count; row > 0 && c-- > 0;)
            image->ids[c][i] = meso_scene_id(scene, row - 1, c) + 1;
    }
}

/* Where the target's pixels lie so that it holds `inner` with as much around it as the image has. */
static MesoWindow surround(const Renderer *r, MesoWindow inner)
{
    uint32_t w = r->targets.width, h = r->targets.height;
    uint32_t x = inner.x > r->margin ? inner.x - r->margin : 0;
    uint32_t y = inner.y > r->margin ? inner.y - r->margin : 0;
    return (MesoWindow){smaller(x, r->options->width - w), smaller(y, r->options->height - h), w, h};
}

static void draw_window(Renderer *r, MesoImage *image, MesoWindow inner)
{
    MesoWindow outer = surround(r, inner);
    MesoMatrix clip = meso_view_clip_from_world(&r->view, r->end_depth, r->options->width,
                                                r->options->height, outer);
    meso_draw_lists_select(&r->lists, &clip);
    meso_targets_begin_center(&r->targets);
    meso_draw_lists_draw(&r->lists, &r->surface, &clip, &r->view);
    if (r->targets.sample_side > 1) {
        meso_targets_begin_multi(&r->targets);
        meso_draw_lists_draw(&r->lists, &r->packed, &clip, &r->view);
    }
    r->gl.Disable(GL_DEPTH_TEST);
    draw_occlusion(r, outer);
    draw_light(r, outer);
    r->gl.Enable(GL_DEPTH_TEST);
    read_back(r, image, inner, outer);
}

static MesoStatus draw_windows(Renderer *r, MesoImage *image, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t y = 0; !status && y < image->height; y += WINDOW_SIZE)
        for (uint32_t x = 0; !status && x < image->width; x += WINDOW_SIZE) {
            draw_window(r, image, (MesoWindow){x, y, smaller(image->width - x, WINDOW_SIZE),
                                               smaller(image->height - y, WINDOW_SIZE)});
            status = meso_gl_check(&r->gl, "drawing", error);
        }
    return status;
}

static void set_state(const MesoGl *gl)
{
    gl->ClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    gl->Enable(GL_DEPTH_TEST);
    gl->DepthFunc(GL_GREATER);
    gl->Disable(GL_CULL_FACE);
    gl->FrontFace(GL_CW);       /* rows run downwards, which mirrors the picture */
}

static void release(Renderer *r)
{
    const MesoGl *gl = &r->gl;
    meso_targets_release(&r->targets);
    meso_draw_lists_release(&r->lists);
    meso_draw_programs_release(&r->surface, gl);
    meso_draw_programs_release(&r->packed, gl);
    meso_draw_programs_release(&r->depth, gl);
    gl->DeleteProgram(r->occlusion);
    gl->DeleteProgram(r->blur);
    gl->DeleteProgram(r->shade);
    gl->DeleteVertexArrays(1, &r->empty_array);
}

static MesoStatus draw(Renderer *r, MesoImage *image, MesoArena *arena, MesoError *error)
{
    const MesoRenderOptions *options = r->options;
    MesoStatus status = make_programs(r, error);
    if (!status)
        status = make_targets(r, error);
    if (!status)
        status = meso_draw_lists_init(&r->lists, arena, &r->gl, r->scene, &r->view, options->height,
                                      options->full_detail ? 0 : TOLERANCE_PIXELS, error);
    if (status)
        return status;

    r->gl.CreateVertexArrays(1, &r->empty_array);
    set_state(&r->gl);
    measure(r);
    draw_shadow(r);
    status = meso_gl_check(&r->gl, "shadow", error);
    if (!status)
        status = draw_windows(r, image, error);
    if (!status)
        look_up_ids(r->scene, image);
    return status;
}

MesoStatus meso_render_memory(const MesoScene *scene, const MesoRenderOptions *options, size_t *image_bytes,
                              size_t *least_bytes, MesoError *error)
{
    static const size_t arrays[] = {COLOR_BYTES, DEPTH_BYTES, NORMAL_BYTES, ALBEDO_BYTES};
    MesoStatus status = check_options(options, error);
    if (status)
        return status;
    uint32_t margin;
    MesoTargets plan = plan_targets(options, &margin);
    *least_bytes = meso_targets_bytes(plan.width, plan.height, plan.sample_side, plan.shadow_size);
    *image_bytes = scene->channel_count * array_bytes(options, ID_BYTES);
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        *image_bytes += array_bytes(options, arrays[i]);
    return MESO_OK;
}

MesoStatus meso_render_placed(MesoImage *image, MesoArena *arena, MesoGlContext *context,
                              const MesoScene *scene, const MesoRenderOptions *options,
                              MesoError *error)
{
    Renderer r = {.options = options, .scene = scene};
    MesoStatus status = meso_view_build(&r.view, &options->camera, error);
    if (!status)
        status = meso_gl_load(&r.gl, context, error);
    if (status)
        return status;
    r.view.anchor = meso_box_anchor(scene->box.low, scene->box.high);
    r.box = (MesoBox){meso_vec3_sub(scene->box.low, r.view.anchor), meso_vec3_sub(scene->box.high, r.view.anchor)};
    status = draw(&r, image, arena, error);
    release(&r);
    return status;
}

MesoStatus meso_render(MesoImage *image, MesoArena *arena, MesoGlContext *context,
                       const MesoScene *scene, const MesoRenderOptions *options,
                       MesoError *error)
{
    size_t bytes, least;
    MesoStatus status = meso_render_memory(scene, options, &bytes, &least, error);
    if (status)
        return status;
    unsigned char *memory = MESO_NEW(arena, unsigned char, bytes, error);
    if (!memory)
        return MESO_ERR_MEMORY;
    meso_image_place(image, memory, scene, options);
    return meso_render_placed(image, arena, context, scene, options, error);
}
