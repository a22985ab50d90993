#include "libcore/render/picture/painter.h"

#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/render/gl/gl_visibility.h"
#include "libcore/render/light/ground_shadow.h"
#include "libcore/render/light/vary.h"
#include "libcore/render/picture/covered.h"
#include "libcore/render/picture/motion.h"
#include "libcore/render/raster/raster_tiles.h"
#include "libcore/sketch/id_color.h"

/*
 * How far thinned geometry may lie from its own, in pixels. Of few samples each shows one thing or another, whatever is
 * moved; of many, a picture is to be within a step of 8 bits of what it is without thinning, in the mean of squares.
 */
static const float TOLERANCE_PIXELS = 0.25f, TOLERANCE_OF_MANY = 0.01f, LEAST_TOLERANCE = 5e-5f;
static const float USUAL_PIXELS = 1280.f * 720, SMALL_SHARE = 0.3f;

enum { MOST_SAMPLES = 16 };

typedef struct MesoPainter Picture;

struct MesoPainter {
    MesoImage *image;           /* the band */
    uint32_t first_row;         /* of it in the picture */
    bool things_only;           /* nothing but mattes and alpha */
    uint32_t thread_count;
    const MesoRenderOptions *options;
    const MesoScene *scene;
    MesoShapes shapes;
    MesoView view;
    MesoRasterView raster;
    MesoLightRig rig;
    MesoGroundShadow ground;    /* where one is asked for */
    uint32_t varied;            /* channel whose things differ in colour, or MESO_NO_INDEX */
    MesoRasterJob job;
    MesoRasterBins *bins;
    MesoGlVisibility *gl;       /* in their place, or NULL */
    MesoMotion motion;          /* where it is asked for */
};

/* A window of the picture in which somebody has found what is seen. */
typedef struct Seen {
    MesoWindow window;
    bool (*sample)(const struct Seen *seen, uint32_t x, uint32_t y, uint32_t sample, MesoSurfaceSample *out);
    MesoRasterTile *tile;
    const MesoGlVisibility *gl;
} Seen;

/* Half of the way to the nearest thing, but a share of the way to the farthest; the eye's plane of a parallel view. */
static float near_depth_of(const MesoView *view, const MesoBox *box)
{
    float nearest = INFINITY, farthest = 0;
    if (view->parallel)
        return 0;
    for (uint32_t i = 0; i < 8; i++) {
        MesoVec3 corner = meso_box_corner(box->low, box->high, i);
        float depth = meso_vec3_dot(meso_vec3_sub(corner, view->eye), view->forward);
        nearest = fminf(nearest, depth);
        farthest = fmaxf(farthest, depth);
    }
    float depth = fmaxf(0.5f * nearest, 1e-5f * farthest);
    return depth > 0 && isfinite(depth) ? depth : 1e-3f;
}

/* ---- samples ---- */

/* Samples of a pixel that are lit as one. */
typedef struct Group {
    MesoSurfaceSample sample;   /* the first of them */
    MesoVec3 position, normal;  /* sums */
    uint32_t count;
} Group;

static float smooth_blend(float x)
{
    float t = x < 0 ? 0 : x > 1 ? 1 : x;
    return t * t * (3 - 2 * t);
}

/* What is to be known of the surface at a sample to light it. */
typedef struct Look {
    MesoMaterial material;
    uint32_t ids;               /* row of the scene's ids */
} Look;

static MesoMaterial material_of(const Picture *p, const MesoSurfaceSample *sample, const MesoShapeLook *of)
{
    MesoShapeLook look = *of;
    const MesoMaterial *a = &p->scene->materials[look.start_material], *b = &p->scene->materials[look.end_material];
    float share = look.start_material == look.end_material ? 0 : smooth_blend(sample->along);
    MesoMaterial m;
    for (int c = 0; c < 3; c++)
        m.albedo[c] = (a->albedo[c] + (b->albedo[c] - a->albedo[c]) * share) * sample->color[c];
    m.roughness = a->roughness + (b->roughness - a->roughness) * share;
    m.metallic = a->metallic + (b->metallic - a->metallic) * share;
    if (p->options->color_ids) {
        meso_id_color(m.albedo, meso_scene_id(p->scene, look.ids, p->options->color_ids - 1));
        m.metallic = 0;
    }
    return m;
}

static Look look_of(const Picture *p, const MesoSurfaceSample *sample)
{
    MesoShapeLook look = meso_shape_look(&p->shapes, sample->shape);
    return (Look){material_of(p, sample, &look), look.ids};
}

static bool belongs(const MesoView *view, const Group *group, const MesoSurfaceSample *sample)
{
    float depth = view->parallel ? view->half_height : sample->depth;
    return group->sample.shape == sample->shape && meso_vec3_dot(group->sample.normal, sample->normal) > 0.9f &&
           fabsf(group->sample.depth - sample->depth) < 0.01f * depth;
}

static void add_sample(const MesoView *view, Group *groups, uint32_t *count, const MesoSurfaceSample *sample)
{
    uint32_t g = 0;
    while (g < *count && !belongs(view, &groups[g], sample))
        g++;
    if (g == *count) {
        groups[g] = (Group){.sample = *sample};
        ++*count;
    }
    groups[g].position = meso_vec3_add(groups[g].position, sample->position);
    groups[g].normal = meso_vec3_add(groups[g].normal, sample->normal);
    groups[g].count++;
}

/* `look`: that of its sample. Returns how open the place is to the sky. */
static float light_group(const Picture *p, const Group *group, const Look *look, float color[4], float samples)
{
    MesoMaterial m = look->material;
    MesoLitSurface s = {.position = meso_vec3_scale(group->position, 1 / (float)group->count),
                        .normal = meso_vec3_unit(group->normal, group->sample.normal),
                        .albedo = {m.albedo[0], m.albedo[1], m.albedo[2]},
                        .roughness = fminf(fmaxf(m.roughness, 0.08f), 1), .metallic = m.metallic};
    if (p->varied != MESO_NO_INDEX)
        meso_vary(s.albedo, meso_scene_id(p->scene, look->ids, p->varied), p->options->vary);
    s.to_eye = p->view.parallel ? meso_vec3_scale(p->view.forward, -1)
                                : meso_vec3_unit(meso_vec3_sub(p->raster.eye, s.position), p->view.up);
    float radiance[3], openness, weight = (float)group->count / samples;
    meso_light_on(&p->rig, &s, radiance, &openness);
    for (int c = 0; c < 3; c++)
        color[c] += weight * radiance[c];
    color[3] += weight;
    return openness;
}

/* Where nothing is, the ground has what shadow falls on it. */
static void shade_ground(const Picture *p, float x, float y, float share, float color[4])
{
    const MesoRasterView *v = &p->raster;
    MesoRasterRay ray = meso_raster_ray(v, x, y);
    if (!v->parallel)       /* rounded so that pictures stay as they were */
        ray.direction = meso_vec3_mad(meso_vec3_mad(v->forward, (x - v->middle_x) / v->focal, v->right),
                                      (y - v->middle_y) / v->focal, v->down);
    float height = meso_vec3_dot(ray.origin, p->rig.up) - p->rig.ground, fall = meso_vec3_dot(ray.direction, p->rig.up);
    if (!(height > 0 && fall < 0))
        return;
    color[3] += share * meso_ground_shadow_at(&p->ground, meso_vec3_mad(ray.origin, -height / fall, ray.direction));
}

/* The variables of the pixel's middle. */
static void put_middle(const Picture *p, const MesoSurfaceSample *sample, const Look *look, size_t pixel)
{
    MesoImage *image = p->image;
    const float normal[3] = {sample->normal.x, sample->normal.y, sample->normal.z};
    MesoMaterial m = look->material;
    image->depth[pixel] = sample->depth;
    for (size_t c = 0; c < 3; c++) {
        image->normal[3 * pixel + c] = normal[c];
        image->albedo[3 * pixel + c] = m.albedo[c];
    }
    for (uint32_t c = 0; c < image->channel_count; c++)
        image->ids[c][pixel] = meso_scene_id(p->scene, look->ids, c) + 1;
    MesoVec3 at = meso_vec3_add(sample->position, p->shapes.anchor);
    if (image->position) {
        image->position[3 * pixel] = at.x;
        image->position[3 * pixel + 1] = at.y;
        image->position[3 * pixel + 2] = at.z;
    }
    if (image->motion)
        meso_motion_at(&p->motion, sample, image->motion + 2 * pixel);
    if (image->uv) {
        image->uv[2 * pixel] = sample->uv.x;
        image->uv[2 * pixel + 1] = sample->uv.y;
    }
    if (image->material) {
        image->material[2 * pixel] = m.roughness;
        image->material[2 * pixel + 1] = m.metallic;
    }
}

/* Things of each matte at a sample: the ids of its row, and the material, of two the one that is more of it. */
static void note_things(const Picture *p, const MesoSurfaceSample *sample, uint32_t i, uint32_t (*things)[MOST_SAMPLES])
{
    uint32_t channels = p->image->channel_count;
    MesoShapeLook look = {0};
    if (sample)
        look = meso_shape_look(&p->shapes, sample->shape);
    for (uint32_t m = 0; m < p->image->matte_count; m++)
        things[m][i] = !sample ? MESO_NO_INDEX
                     : m < channels ? meso_scene_id(p->scene, look.ids, m)
                     : sample->along < 0.5f ? look.start_material : look.end_material;
}

/* The variables of pixels that follow one another. */
static inline void put_nothing(MesoImage *image, size_t pixel, size_t count)
{
    for (size_t i = 0; i < count; i++)
        image->depth[pixel + i] = INFINITY;
    memset(image->normal + 3 * pixel, 0, 3 * count * sizeof *image->normal);
    memset(image->albedo + 3 * pixel, 0, 3 * count * sizeof *image->albedo);
    for (uint32_t c = 0; c < image->channel_count; c++)
        memset(image->ids[c] + pixel, 0, count * sizeof *image->ids[c]);
    for (size_t i = 0; image->openness && i < count; i++)
        image->openness[pixel + i] = 1;
    if (image->position)
        memset(image->position + 3 * pixel, 0, 3 * count * sizeof *image->position);
    if (image->uv)
        memset(image->uv + 2 * pixel, 0, 2 * count * sizeof *image->uv);
    if (image->material)
        memset(image->material + 2 * pixel, 0, 2 * count * sizeof *image->material);
    if (image->motion)
        memset(image->motion + 2 * pixel, 0, 2 * count * sizeof *image->motion);
}

static void put_mattes(const Picture *p, size_t pixel, uint32_t (*things)[MOST_SAMPLES])
{
    for (uint32_t m = 0; m < p->image->matte_count; m++)
        meso_matte_put(&p->image->mattes[m], pixel, things[m], p->options->samples);
}

/* `pixel` is its number in the band. */
static void take_pixel(const Picture *p, const Seen *from, uint32_t x, uint32_t y, size_t pixel)
{
    Group groups[MOST_SAMPLES];
    MesoSurfaceSample sample;
    uint32_t samples = p->options->samples, count = 0, seen = 0, things[MESO_ID_CHANNELS + 1][MOST_SAMPLES];
    MesoWindow window = from->window;
    Look first;                 /* of the first sample, where it is there: the first group is of it then */
    bool middle = false;
    float *color = p->image->color + 4 * pixel;
    color[0] = color[1] = color[2] = color[3] = 0;
    for (uint32_t i = 0; i < samples; i++) {
        bool there = from->sample(from, x, y, i, &sample);
        if (i == 0 && there) {
            first = look_of(p, &sample);
            put_middle(p, &sample, &first, pixel);
        } else if (i == 0) {
            put_nothing(p->image, pixel, 1);
        }
        middle |= i == 0 && there;
        if (p->image->matte_count)
            note_things(p, there ? &sample : NULL, i, things);
        if (!there)
            continue;
        add_sample(&p->view, groups, &count, &sample);
        seen++;
    }
    for (uint32_t g = 0; g < count; g++) {
        Look look = g == 0 && middle ? first : look_of(p, &groups[g].sample);
        float openness = light_group(p, &groups[g], &look, color, (float)samples);
        if (p->image->openness && g == 0 && middle)
            p->image->openness[pixel] = openness;
    }
    put_mattes(p, pixel, things);
    if (p->options->ground && seen < samples)
        shade_ground(p, (float)(window.x + x) + 0.5f, (float)(window.y + y) + 0.5f,
                     (float)(samples - seen) / (float)samples, color);
}

/* What is there, without light. */
static void take_things(const Picture *p, const Seen *from, uint32_t x, uint32_t y, size_t pixel)
{
    MesoSurfaceSample sample;
    MesoWindow window = from->window;
    uint32_t samples = p->options->samples, seen = 0, things[MESO_ID_CHANNELS + 1][MOST_SAMPLES];
    float *color = p->image->color + 4 * pixel;
    for (uint32_t i = 0; i < samples; i++) {
        bool there = from->sample(from, x, y, i, &sample);
        note_things(p, there ? &sample : NULL, i, things);
        seen += there;
    }
    put_mattes(p, pixel, things);
    color[3] = (float)seen;
    if (p->options->ground && seen == 0)
        shade_ground(p, (float)(window.x + x) + 0.5f, (float)(window.y + y) + 0.5f, 1, color);
}

/* Row by row, where nothing is and nothing is to be known of that but how it looks. */
static bool take_nothing(const Picture *p, const MesoWindow *window)
{
    if (p->things_only || p->image->matte_count || p->options->ground)
        return false;
    for (uint32_t row = window->y; row < window->y + window->height; row++) {
        if (row < p->first_row || row - p->first_row >= p->image->height)
            continue;
        size_t pixel = (size_t)(row - p->first_row) * p->image->width + window->x;
        memset(p->image->color + 4 * pixel, 0, 4 * (size_t)window->width * sizeof *p->image->color);
        put_nothing(p->image, pixel, window->width);
    }
    return true;
}

/* Rows [begin, end) of the window, as far as the band has them. */
static void take_rows(const Picture *p, const Seen *from, uint32_t begin, uint32_t end)
{
    for (uint32_t y = begin; y < end; y++) {
        uint32_t row = from->window.y + y;
        if (row < p->first_row || row - p->first_row >= p->image->height)
            continue;
        size_t pixel = (size_t)(row - p->first_row) * p->image->width + from->window.x;
        for (uint32_t x = 0; x < from->window.width; x++, pixel++)
            if (p->things_only)
                take_things(p, from, x, y, pixel);
            else
                take_pixel(p, from, x, y, pixel);
    }
}

static bool sample_tile(const Seen *from, uint32_t x, uint32_t y, uint32_t sample, MesoSurfaceSample *out)
{
    return meso_raster_tile_sample(from->tile, x, y, sample, out);
}

static void take_tile(void *context, MesoRasterTile *tile)
{
    const Seen from = {.window = meso_raster_tile_window(tile), .sample = sample_tile, .tile = tile};
    if (!meso_raster_tile_empty(tile) || !take_nothing(context, &from.window))
        take_rows(context, &from, 0, from.window.height);
}

/* ---- by GL ---- */

static bool sample_gl(const Seen *from, uint32_t x, uint32_t y, uint32_t sample, MesoSurfaceSample *out)
{
    return meso_gl_visibility_sample(from->gl, x, y, sample, out);
}

typedef struct GlRows {
    const Picture *picture;
    Seen from;
} GlRows;

static void take_gl_rows(void *context, uint64_t begin, uint64_t end)
{
    const GlRows *rows = context;
    take_rows(rows->picture, &rows->from, (uint32_t)begin, (uint32_t)end);
}

static MesoStatus paint_by_gl(const Picture *p, MesoError *error)
{
    MesoStatus status = MESO_OK;
    uint32_t side = meso_gl_window_side(p->options->samples), end = p->first_row + p->image->height;
    for (uint32_t y = p->first_row; y < end && !status; y += side)
        for (uint32_t x = 0; x < p->image->width && !status; x += side) {
            MesoWindow window = {x, y, p->image->width - x < side ? p->image->width - x : side,
                                 end - y < side ? end - y : side};
            GlRows rows = {p, {.window = window, .sample = sample_gl, .gl = p->gl}};
            status = meso_gl_visibility_draw(p->gl, window, error);
            if (!status)
                meso_parallel_for(p->thread_count, window.height, 4, take_gl_rows, &rows);
        }
    return status;
}

/* ---- all of it, or bands ---- */

/* A tile that more than one band has rows of is drawn for each of them. */
uint32_t meso_paint_band_rows(const MesoScene *scene, const MesoRenderOptions *options)
{
    enum { LEAST = 16 };
    uint32_t tile = meso_raster_tile_rows(options->samples);
    size_t rows = MESO_BAND_BYTES / (options->width * meso_image_pixel_bytes(scene, options));
    if (options->band_rows)
        rows = (options->band_rows + LEAST - 1) / LEAST * LEAST;
    else if (rows >= tile)
        rows -= rows % tile;
    else
        for (size_t most = rows, half = rows = tile; half >= LEAST && rows > most; half /= 2)
            rows = half;
    return rows < options->height ? (uint32_t)rows : options->height;
}

static MesoStatus make_band(MesoImage *band, MesoArena *arena, const MesoScene *scene, const MesoRenderOptions *options,
                            MesoError *error)
{
    MesoRenderOptions rows = *options;
    MesoStatus status = meso_render_check(options, error);
    if (status)
        return status;
    rows.height = meso_paint_band_rows(scene, options);
    unsigned char *memory = MESO_NEW(arena, unsigned char, meso_image_bytes(scene, &rows) + 64, error);
    if (!memory)
        return MESO_ERR_MEMORY;
    meso_image_place(band, memory + (64 - (size_t)(uintptr_t)memory % 64) % 64, scene, &rows);
    return MESO_OK;
}

static MesoStatus paint(MesoPainter *p, MesoImage *band, uint32_t first_row, MesoError *error)
{
    uint32_t left = p->options->height - first_row;
    band->height = band->height < left ? band->height : left;
    p->image = band;
    p->first_row = first_row;
    if (p->gl)
        return paint_by_gl(p, error);
    return meso_raster_rows(p->bins, first_row, first_row + band->height, p->thread_count, take_tile, p, error);
}

MesoStatus meso_paint(MesoPainter *p, MesoImage *band, uint32_t first_row, MesoError *error)
{
    MesoStatus status = paint(p, band, first_row, error);
    if (!status && p->options->find_covered && band->height == p->options->height)
        meso_covered_add(&band->covered, band, 0);
    return status;
}

static MesoStatus look_through(MesoPainter *p, MesoImage *band, MesoError *error)
{
    MesoStatus status = MESO_OK;
    uint32_t rows = band->height;
    p->things_only = true;
    for (uint32_t row = 0; row < p->options->height && !status; row += rows) {
        status = paint(p, band, row, error);
        if (!status)
            meso_covered_add(&band->covered, band, row);
    }
    p->things_only = false;
    band->height = rows;
    return status;
}

/* In pixels. Of many samples few may see one thread in another's place, so that in a small picture, which shows more
 * threads a pixel, they stay where they are in a large one; and in one that is smaller yet, where every sample lies
 * next to a thread's side, nearer still. */
static float tolerance_of(const MesoRenderOptions *options)
{
    if (options->full_detail || options->samples <= 4)
        return options->full_detail ? 0 : TOLERANCE_PIXELS;
    float smaller = sqrtf((float)options->width * (float)options->height / USUAL_PIXELS);
    float nearer = smaller * fminf(smaller / SMALL_SHARE, 1);
    return fminf(fmaxf(TOLERANCE_OF_MANY * nearer, LEAST_TOLERANCE), TOLERANCE_OF_MANY);
}

/* For what may be seen: shapes begin between the near plane and what is farthest. */
static MesoStatus get_shapes_ready(MesoPainter *p, MesoArena *arena, MesoError *error)
{
    const MesoRasterView *view = &p->raster;
    float farthest = meso_raster_from_eye(view, p->rig.middle).z + 1.01f * p->rig.radius;
    float low = p->job.tolerance * meso_raster_pixel(view, view->near_depth);
    float high = p->job.tolerance * meso_raster_pixel(view, fmaxf(farthest, view->near_depth));
    MesoStatus status = meso_shapes_ready(&p->shapes, arena, MESO_SHAPE_SEEN, low, high, error);
    return status ? status : meso_shapes_ready(&p->shapes, arena, MESO_SHAPE_WHOLE, low, high, error);
}

/* Of what is seen, and of light. */
static MesoStatus get_ready(MesoPainter *p, MesoArena *arena, MesoError *error)
{
    const MesoRenderOptions *options = p->options;
    const MesoScene *scene = p->scene;
    MesoStatus status = meso_view_build(&p->view, &options->camera, error);
    if (status)
        return status;
    p->view.anchor = meso_box_anchor(scene->box.low, scene->box.high);
    status = meso_shapes_begin(&p->shapes, arena, scene, p->view.anchor, p->thread_count, error);
    MesoLightQuality quality = meso_light_quality(options->samples);
    if (options->full_detail)
        quality.tolerance = 0;
    if (!status)
        status = meso_light_rig_init(&p->rig, arena, &p->shapes, &p->view,
                                     meso_vec3_unit(options->up, meso_vec3_unit(options->camera.up, p->view.up)),
                                     options->environment, &quality, p->thread_count, error);
    if (!status && options->ground)
        status = meso_ground_shadow_init(&p->ground, arena, &p->rig, p->thread_count, error);
    p->raster = meso_raster_view(&p->view, options->width, options->height, near_depth_of(&p->view, &scene->box));
    p->job = (MesoRasterJob){
        .shapes = &p->shapes, .view = p->raster, .width = options->width, .height = options->height,
        .samples = options->samples,
        .tolerance = tolerance_of(options)};
    return status ? status : get_shapes_ready(p, arena, error);
}

static MesoPainter *new_painter(MesoArena *arena, const MesoScene *scene, const MesoRenderOptions *options,
                                uint32_t thread_count, MesoError *error)
{
    MesoPainter *p = MESO_NEW(arena, MesoPainter, 1, error);
    if (p)
        *p = (MesoPainter){.options = options, .scene = scene, .varied = meso_vary_channel(scene),
                           .thread_count = thread_count};
    return p;
}

MesoStatus meso_painter_init(MesoPainter **painter, MesoImage *band, MesoArena *arena, const MesoScene *scene,
                             const MesoRenderOptions *options, uint32_t thread_count, MesoError *error)
{
    MesoPainter *p = *painter = new_painter(arena, scene, options, thread_count, error);
    if (!p)
        return MESO_ERR_MEMORY;
    MesoStatus status = make_band(band, arena, scene, options, error);
    if (!status)
        status = get_ready(p, arena, error);
    if (!status)
        status = meso_raster_bins_init(&p->bins, arena, &p->job, thread_count, error);
    if (!status && options->extras & MESO_EXTRA_MOTION)
        status = meso_motion_init(&p->motion, arena, &p->job, options, thread_count, error);
    bool in_bands = band->height < options->height;
    bool wanted = band->matte_count || options->find_covered;
    return !status && in_bands && wanted ? look_through(p, band, error) : status;
}

MesoStatus meso_tile_picture(MesoImage *image, MesoArena *arena, const MesoScene *scene,
                             const MesoRenderOptions *options, uint32_t thread_count, MesoError *error)
{
    MesoPainter *painter;
    MesoRenderOptions whole = *options;
    whole.band_rows = options->height;
    MesoStatus status = meso_painter_init(&painter, image, arena, scene, &whole, thread_count, error);
    return status ? status : meso_paint(painter, image, 0, error);
}

bool meso_gl_is_detailed(const MesoScene *scene, const MesoRenderOptions *options)
{
    return options->extras & MESO_EXTRA_UV || meso_scene_is_colored(scene);
}

MesoStatus meso_gl_painter_init(MesoPainter **painter, MesoArena *arena, const MesoScene *scene,
                                const MesoRenderOptions *options, uint32_t thread_count, MesoError *error)
{
    *painter = NULL;
    if (options->extras & MESO_EXTRA_MOTION)
        return meso_fail(error, MESO_ERR_USAGE, "GL finds no motion");
    MesoPainter *p = *painter = new_painter(arena, scene, options, thread_count, error);
    return p ? get_ready(p, arena, error) : MESO_ERR_MEMORY;
}

MesoStatus meso_gl_paint(MesoPainter *p, MesoImage *image, MesoArena *arena, MesoGlVisibility *gl, MesoError *error)
{
    p->gl = gl;
    MesoStatus status = meso_gl_visibility_begin(gl, arena, &p->job, &p->view, p->thread_count, error);
    return status ? status : meso_paint(p, image, 0, error);
}

MesoStatus meso_gl_picture(MesoImage *image, MesoArena *arena, const MesoGlContext *context, const MesoScene *scene,
                           const MesoRenderOptions *options, uint32_t thread_count, MesoError *error)
{
    MesoPainter *painter;
    MesoGlVisibility *gl = NULL;
    MesoRenderOptions whole = *options;
    whole.band_rows = options->height;
    MesoStatus status = make_band(image, arena, scene, &whole, error);
    if (!status)
        status = meso_gl_painter_init(&painter, arena, scene, options, thread_count, error);
    if (!status)
        status = meso_gl_visibility_init(&gl, context, options->width, options->height, options->samples,
                                         meso_gl_is_detailed(scene, options), error);
    if (!status)
        status = meso_gl_paint(painter, image, arena, gl, error);
    meso_gl_visibility_release(gl);
    return status;
}
