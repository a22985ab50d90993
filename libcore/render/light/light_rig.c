#include "libcore/render/light/light_rig.h"

static const float PI = 3.14159265f, GOLDEN_ANGLE = 2.39996323f;

static const MesoLightColors COLORS = {.key = {3.3f, 3, 2.58f}, .rim = {0.62f, 0.7f, 0.8f},
                                       .sky = {0.4f, 0.47f, 0.56f}, .ground = {0.23f, 0.2f, 0.17f},
                                       .window = {0.8f, 0.74f, 0.65f}};

/* How fast light of a map fades to directions around it: the one next to it gets a fifth. */
static const float SKY_SHARPNESS = 3;

/* Of the key light's disc, as the tangent of half its angle. A wider one has as many more places. */
static const float KEY_EXTENT = 0.07f;

MesoLightQuality meso_light_quality(uint32_t samples)
{
    return samples == 1 ? (MesoLightQuality){12, 192, 1, 1024, 0.5f}
         : samples == 4 ? (MesoLightQuality){40, 320, 8, 1024, 0.125f}
                        : (MesoLightQuality){64, 288, 16, 768, 0.125f};
}

static float smoothstep(float low, float high, float x)
{
    float t = (x - low) / (high - low);
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    return t * t * (3 - 2 * t);
}

/* Radiance of the sky and the ground, as a surface of that roughness reflects it. */
static void sky_at(const MesoLightRig *rig, MesoVec3 direction, float roughness, float color[3])
{
    float width = 0.25f + 0.75f * roughness, dome = smoothstep(-width, width, meso_vec3_dot(direction, rig->up));
    float window = smoothstep(0.55f - 0.5f * roughness, 0.95f, meso_vec3_dot(direction, rig->to_key));
    float glow = window * (1 - 0.8f * roughness);
    const MesoLightColors *of = &rig->colors;
    for (int c = 0; c < 3; c++)
        color[c] = of->ground[c] + (of->sky[c] - of->ground[c]) * dome + of->window[c] * glow;
}

static MesoVec3 in_view(const MesoView *view, float right, float up, float back)
{
    MesoVec3 v = meso_vec3_mad(meso_vec3_scale(view->right, right), up, view->up);
    return meso_vec3_unit(meso_vec3_mad(v, -back, view->forward), view->up);
}

/* Direction i of `count` over the sphere: a spiral of equal areas about `up`. */
static MesoVec3 spread(const MesoLightRig *rig, uint32_t i, uint32_t count)
{
    float z = 1 - (2 * (float)i + 1) / (float)count, r = sqrtf(1 - z * z), a = GOLDEN_ANGLE * (float)i;
    MesoVec3 across = fabsf(rig->up.y) < 0.9f ? (MesoVec3){0, 1, 0} : (MesoVec3){0, 0, 1};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(across, rig->up), (MesoVec3){1, 0, 0}), y = meso_vec3_cross(rig->up, x);
    MesoVec3 d = meso_vec3_mad(meso_vec3_scale(x, r * cosf(a)), r * sinf(a), y);
    return meso_vec3_unit(meso_vec3_mad(d, z, rig->up), rig->up);
}

/* Place i of `count` on the key light's disc. */
static MesoVec3 on_key(const MesoLightRig *rig, const MesoView *view, uint32_t i, uint32_t count)
{
    float r = count == 1 ? 0 : rig->key_extent * sqrtf(((float)i + 0.5f) / (float)count), a = GOLDEN_ANGLE * (float)i;
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(rig->environment ? rig->up : view->forward, rig->to_key), view->right);
    MesoVec3 y = meso_vec3_cross(rig->to_key, x);
    MesoVec3 d = meso_vec3_mad(meso_vec3_scale(x, r * cosf(a)), r * sinf(a), y);
    return meso_vec3_unit(meso_vec3_add(rig->to_key, d), rig->to_key);
}

static void measure(MesoLightRig *rig, const MesoShapes *shapes)
{
    MesoBox box = meso_shapes_box(shapes);
    if (shapes->count == 0)
        meso_box_add(&box, (MesoVec3){0, 0, 0});
    rig->middle = meso_vec3_lerp(box.low, box.high, 0.5f);
    rig->radius = fmaxf(0.5f * meso_vec3_length(meso_vec3_sub(box.high, box.low)), 1e-30f);
    rig->ground = INFINITY;
    for (uint32_t i = 0; i < 8; i++)
        rig->ground = fminf(rig->ground, meso_vec3_dot(meso_box_corner(box.low, box.high, i), rig->up));
}

/* ---- an environment ---- */

static MesoVec3 to_map(const MesoLightRig *rig, MesoVec3 d)
{
    return (MesoVec3){meso_vec3_dot(d, rig->axes[0]), meso_vec3_dot(d, rig->axes[1]), meso_vec3_dot(d, rig->axes[2])};
}

static MesoVec3 from_map(const MesoLightRig *rig, MesoVec3 d)
{
    MesoVec3 v = meso_vec3_mad(meso_vec3_scale(rig->axes[0], d.x), d.y, rig->axes[1]);
    return meso_vec3_unit(meso_vec3_mad(v, d.z, rig->axes[2]), rig->up);
}

static void take_environment(MesoLightRig *rig, const MesoEnvironment *environment)
{
    rig->environment = environment;
    meso_environment_axes(environment, rig->up, rig->axes);
    rig->to_key = from_map(rig, environment->to_key);
    rig->key_extent = environment->key_extent;
    rig->colors = (MesoLightColors){.key = {environment->key[0], environment->key[1], environment->key[2]}};
}

/* Places on the key light: more on a wider one, none where there is none. */
static uint32_t key_places(const MesoLightRig *rig, uint32_t usual)
{
    if (rig->key_extent == 0 || usual <= 1)
        return rig->key_extent == 0 ? 0 : usual;
    return (uint32_t)fminf((float)usual * fmaxf(rig->key_extent / KEY_EXTENT, 1), MESO_KEY_MOST);
}

/*
 * Light of the map goes to the sky's directions around it, to each the more the nearer it is: what falls between two
 * comes from both, and what is small and bright casts more than one hard shadow.
 */
static void color_sky(MesoLightRig *rig, const MesoVec3 *towards, uint32_t count)
{
    enum { WIDTH = 64, HEIGHT = 32 };
    float texels[3 * WIDTH * HEIGHT], shares[MESO_SKY_MOST];
    double sums[MESO_SKY_MOST][4] = {{0}};
    MesoVec3 toward[MESO_SKY_MOST];
    MesoLatLong map = {WIDTH, HEIGHT, texels};
    float sharpness = SKY_SHARPNESS * (float)count / (4 * PI);      /* by the square of their distance */
    meso_lat_long_resample(&rig->environment->glossy[MESO_LIGHT_REST][0], &map);
    for (uint32_t i = 0; i < count; i++)
        toward[i] = to_map(rig, towards[i]);
    for (uint32_t k = 0; k < WIDTH * HEIGHT; k++) {
        MesoVec3 d = meso_lat_long_direction(&map, k % WIDTH, k / WIDTH);
        float whole = 0, solid_angle = meso_lat_long_solid_angle(&map, k / WIDTH);
        for (uint32_t i = 0; i < count; i++)
            whole += shares[i] = expf(sharpness * (meso_vec3_dot(d, toward[i]) - 1));
        for (uint32_t i = 0; i < count; i++) {
            double weight = (double)(solid_angle * shares[i] / whole);
            for (uint32_t c = 0; c < 3; c++)
                sums[i][c] += weight * (double)texels[3 * k + c];
            sums[i][3] += weight;
        }
    }
    for (size_t i = 0; i < count; i++)
        for (size_t c = 0; c < 3; c++)
            rig->sky_colors[3 * i + c] = (float)(sums[i][c] / sums[i][3]);
}

/* ---- maps ---- */

static MesoStatus make_sky(MesoLightRig *rig, MesoArena *arena, const MesoLightQuality *quality, MesoError *error)
{
    MesoVec3 towards[MESO_SKY_MOST];
    uint32_t count = quality->sky_count;
    rig->sky_colors = MESO_NEW(arena, float, 3 * (size_t)count, error);
    if (!rig->sky_colors)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        towards[i] = spread(rig, i, count);
        sky_at(rig, towards[i], 0.5f, &rig->sky_colors[3 * (size_t)i]);
    }
    if (rig->environment)
        color_sky(rig, towards, count);
    for (uint32_t i = 0; i < count; i++) {
        const float *color = &rig->sky_colors[3 * (size_t)i];
        float facing = meso_vec3_dot(towards[i], rig->up);
        for (int c = 0; c < 3 && facing > 0; c++)
            rig->open_sky[c] += 4 / (float)count * facing * color[c];
    }
    return meso_light_maps_init(&rig->sky, arena, towards, count, rig->middle, rig->radius, quality->sky_size, error);
}

static MesoStatus make_key(MesoLightRig *rig, MesoArena *arena, const MesoView *view, const MesoLightQuality *quality,
                           MesoError *error)
{
    MesoVec3 towards[MESO_KEY_MOST];
    uint32_t count = key_places(rig, quality->key_count), size = quality->key_size;
    if (count > quality->key_count)     /* as many texels in all: a wide light's shadows have no fine edges */
        size = 4 * (uint32_t)(0.25f * (float)size * sqrtf((float)quality->key_count / (float)count));
    for (uint32_t i = 0; i < count; i++)
        towards[i] = on_key(rig, view, i, count);
    return count == 0 ? MESO_OK : meso_light_maps_init(&rig->key, arena, towards, count, rig->middle, rig->radius,
                                                       size, error);
}

MesoStatus meso_light_rig_init(MesoLightRig *rig, MesoArena *arena, MesoShapes *shapes, const MesoView *view,
                               MesoVec3 up, const MesoEnvironment *environment, const MesoLightQuality *quality,
                               uint32_t thread_count, MesoError *error)
{
    *rig = (MesoLightRig){.colors = COLORS, .up = up, .to_key = in_view(view, -0.55f, 0.8f, 0.7f),
                          .to_rim = in_view(view, 0.75f, 0.35f, -0.55f), .key_extent = KEY_EXTENT};
    if (environment)
        take_environment(rig, environment);
    measure(rig, shapes);
    MesoStatus status = make_sky(rig, arena, quality, error);
    if (!status)
        status = make_key(rig, arena, view, quality, error);
    rig->sky.tolerance = quality->tolerance * rig->sky.texel;
    rig->key.tolerance = quality->tolerance * rig->key.texel;
    MesoLightMaps *const sets[] = {&rig->sky, &rig->key};
    uint32_t count = rig->key.count ? 2 : 1;
    for (uint32_t i = 0; i < count && !status; i++)
        status = meso_shapes_ready(shapes, arena, MESO_SHAPE_SHADOW, sets[i]->tolerance, sets[i]->tolerance, error);
    return status ? status : meso_light_maps_draw(sets, count, shapes, thread_count, error);
}

/* ---- light on a surface ---- */

/* What the microfacets reflect to the eye of light from all sides, by Karis ("Physically Based Shading on Mobile"). */
static void reflect_all(const MesoLitSurface *s, float nv, const float f0[3], float out[3])
{
    float r0 = 1 - s->roughness, r1 = 0.0425f - 0.0275f * s->roughness, r2 = 1.04f - 0.572f * s->roughness;
    float r3 = 0.022f * s->roughness - 0.04f, a = fminf(r0 * r0, exp2f(-9.28f * nv)) * r0 + r1;
    float scale = r2 - 1.04f * a, offset = r3 + 1.04f * a;
    for (int c = 0; c < 3; c++)
        out[c] = f0[c] * scale + offset;
}

/* f times the cosine. The base gets what microfacets do not reflect, of all light together. */
static void reflect_light(const MesoLitSurface *s, MesoVec3 to_light, const float f0[3], const float reflected[3],
                          float out[3])
{
    float nl = meso_vec3_dot(s->normal, to_light);
    out[0] = out[1] = out[2] = 0;
    if (nl <= 0)
        return;
    float nv = fmaxf(meso_vec3_dot(s->normal, s->to_eye), 1e-3f);
    MesoVec3 halfway = meso_vec3_unit(meso_vec3_add(to_light, s->to_eye), s->normal);
    float nh = fmaxf(meso_vec3_dot(s->normal, halfway), 0), vh = fmaxf(meso_vec3_dot(s->to_eye, halfway), 0);
    float a = s->roughness * s->roughness, a2 = a * a, d = nh * nh * (a2 - 1) + 1;
    float ndf = a2 / (PI * d * d);
    float smith = 0.5f / (nl * sqrtf(nv * nv * (1 - a2) + a2) + nv * sqrtf(nl * nl * (1 - a2) + a2));
    float grazing = 1 - vh, grazing2 = grazing * grazing, schlick = grazing2 * grazing2 * grazing;
    for (int c = 0; c < 3; c++) {
        float fresnel = f0[c] + (1 - f0[c]) * schlick;
        float diffuse = (1 - reflected[c]) * (1 - s->metallic) * s->albedo[c] / PI;
        out[c] = (diffuse + ndf * smith * fresnel) * nl;
    }
}

static float key_light(const MesoLightRig *rig, const MesoLitSurface *s)
{
    if (rig->key.count == 0)
        return 0;
    float facing[MESO_KEY_MOST], lit[MESO_KEY_MOST], sum = 0;
    meso_light_maps_lit(&rig->key, s->position, s->normal, facing, lit);
    for (uint32_t i = 0; i < rig->key.count; i++)
        sum += lit[i];
    return sum / (float)rig->key.count;
}

/* Irradiance / pi from the sky, and the share of it that comes through. `open`, which may be NULL, gets what there
 * would be without anything in the way. */
static float sky_light(const MesoLightRig *rig, const MesoLitSurface *s, float light[3], float open[3])
{
    float facing[MESO_SKY_MOST], lit[MESO_SKY_MOST], whole = 0, seen = 0;
    meso_light_maps_lit(&rig->sky, s->position, s->normal, facing, lit);
    light[0] = light[1] = light[2] = 0;
    for (int c = 0; c < 3 && open; c++)
        open[c] = 0;
    uint32_t which[MESO_SKY_MOST], faced = 0;
    for (uint32_t i = 0; i < rig->sky.count; i++) {     /* the others add nothing */
        which[faced] = i;
        faced += facing[i] > 0;
    }
    for (uint32_t k = 0; k < faced; k++) {
        uint32_t i = which[k];
        float share = facing[i] * lit[i];
        whole += facing[i];
        seen += share;
        for (int c = 0; c < 3; c++)
            light[c] += share * rig->sky_colors[3 * (size_t)i + (size_t)c];
        for (int c = 0; c < 3 && open; c++)
            open[c] += facing[i] * rig->sky_colors[3 * (size_t)i + (size_t)c];
    }
    for (int c = 0; c < 3; c++)
        light[c] *= 4 / (float)rig->sky.count;
    for (int c = 0; c < 3 && open; c++)
        open[c] *= 4 / (float)rig->sky.count;
    return whole > 0 ? seen / whole : 1;
}

/* The side that a mirror would show is open to this share, where so much of the sky is. */
static float open_side(float nv, float open, float roughness)
{
    float reach = powf(nv + open, exp2f(-16 * roughness - 1)) - 1 + open;
    return fminf(fmaxf(reach, 0), 1);
}

/* All light comes from the map. */
static float light_from_map(const MesoLightRig *rig, const MesoLitSurface *s, float radiance[3])
{
    const MesoEnvironment *e = rig->environment;
    float light[3], whole[3], diffuse[3], glossy[3], shine[3], f0[3], reflected[3];
    float open = sky_light(rig, s, light, whole), lit = key_light(rig, s);
    float facing = meso_vec3_dot(s->normal, rig->to_key);
    for (int c = 0; c < 3; c++)
        f0[c] = 0.04f + (s->albedo[c] - 0.04f) * s->metallic;
    float nv = fmaxf(meso_vec3_dot(s->normal, s->to_eye), 1e-3f), glossy_open = open_side(nv, open, s->roughness);
    reflect_all(s, nv, f0, reflected);
    MesoVec3 mirrored = meso_vec3_mad(meso_vec3_scale(s->to_eye, -1), 2 * meso_vec3_dot(s->normal, s->to_eye),
                                      s->normal);
    MesoVec3 toward = to_map(rig, meso_vec3_unit(mirrored, s->normal));
    meso_environment_diffuse(e, to_map(rig, s->normal), diffuse);
    meso_environment_glossy(e, MESO_LIGHT_REST, toward, s->roughness, glossy);
    shine[0] = shine[1] = shine[2] = 0;
    if (lit > 0)
        meso_environment_glossy(e, MESO_LIGHT_KEY, toward, s->roughness, shine);
    for (int c = 0; c < 3; c++) {
        float base = s->albedo[c] * (1 - s->metallic) * (1 - reflected[c]);
        float bounced = 1 / (1 - 0.9f * s->albedo[c] * (1 - open)), share = whole[c] > 0 ? light[c] / whole[c] : open;
        radiance[c] = diffuse[c] * share * base * bounced + glossy[c] * reflected[c] * glossy_open;
        radiance[c] += (rig->colors.key[c] * fmaxf(facing, 0) / PI * base + shine[c] * reflected[c]) * lit;
    }
    return open;
}

void meso_light_on(const MesoLightRig *rig, const MesoLitSurface *s, float radiance[3], float *openness)
{
    if (rig->environment) {
        float open_map = light_from_map(rig, s, radiance);
        if (openness)
            *openness = open_map;
        return;
    }
    float sky[3], glossy[3], key[3], rim[3], f0[3], reflected[3];
    float open = sky_light(rig, s, sky, NULL);
    for (int c = 0; c < 3; c++)
        f0[c] = 0.04f + (s->albedo[c] - 0.04f) * s->metallic;
    float nv = fmaxf(meso_vec3_dot(s->normal, s->to_eye), 1e-3f);
    reflect_all(s, nv, f0, reflected);
    MesoVec3 away = meso_vec3_scale(s->to_eye, -1);
    MesoVec3 mirrored = meso_vec3_mad(away, 2 * meso_vec3_dot(s->normal, s->to_eye), s->normal);
    float glossy_open = open_side(nv, open, s->roughness);
    sky_at(rig, mirrored, s->roughness, glossy);
    reflect_light(s, rig->to_key, f0, reflected, key);
    reflect_light(s, rig->to_rim, f0, reflected, rim);
    float lit = key[0] + key[1] + key[2] > 0 ? key_light(rig, s) : 0;
    for (int c = 0; c < 3; c++) {
        float base = s->albedo[c] * (1 - s->metallic) * (1 - reflected[c]);
        float bounced = 1 / (1 - 0.9f * s->albedo[c] * (1 - open));
        radiance[c] = sky[c] * base * bounced + glossy[c] * reflected[c] * glossy_open;
        radiance[c] += rig->colors.key[c] * key[c] * lit + rig->colors.rim[c] * rim[c] * open;
    }
    if (openness)
        *openness = open;
}
