#include "cmd/replicate/replicate_places.h"

#include <string.h>

#include "cmd/common/scene_input.h"
#include "libcore/base/index.h"
#include "libcore/base/parallel.h"
#include "libcore/base/random.h"
#include "libcore/growth/ground/growth_seeds.h"
#include "libcore/growth/language/grammar_read.h"
#include "libcore/mesh/cut/triangle_area.h"
#include "libcore/mesh/point/surface_point.h"
#include "libcore/scene/parts.h"

static const MesoDetailPoint nothing = {.size = NAN, .aspect = NAN, .kind = MESO_NO_INDEX};

static MesoStatus make_room(MesoDetailPlaces *out, const MesoReplicateGround *g, uint32_t count)
{
    *out = (MesoDetailPlaces){count, MESO_NEW(&g->tool->arena, MesoDetailPlace, count, &g->tool->error)};
    return out->places ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- points ---- */

typedef struct Putting {
    MesoDetailPlaces *places;
    const MesoTriangulation *mesh;
    MesoDomain domain;
} Putting;

static void put_range(void *context, uint64_t begin, uint64_t end)
{
    const Putting *p = context;
    for (uint64_t i = begin; i < end; i++)
        p->places->places[i].point = meso_surface_point(p->mesh, &p->domain, p->places->places[i].said.position);
}

static MesoStatus put_down(MesoDetailPlaces *places, const MesoReplicateGround *g)
{
    const MesoTriangulation *mesh = g->ground.mesh;
    uint32_t *all = MESO_NEW(&g->tool->arena, uint32_t, mesh->triangle_count, &g->tool->error);
    if (!all)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        all[t] = t;
    Putting putting = {places, mesh, {NULL, mesh->triangle_count, all}};
    meso_parallel_for(g->tool->threads, places->count, 16, put_range, &putting);
    return MESO_OK;
}

static MesoStatus places_of_points(MesoDetailPlaces *out, const MesoReplicateGround *g,
                                   const MesoDetailDistribution *d)
{
    MesoStatus status = make_room(out, g, d->point_count);
    for (uint32_t i = 0; i < d->point_count && !status; i++)
        out->places[i].said = d->points[i];
    return status ? status : put_down(out, g);
}

/* ---- Poisson ---- */

/* The area that details share, each part by its density. */
static double dense_area(const MesoReplicateGround *g, const MesoGrowthMap *density)
{
    static const double corners[3][3] = {{0.5, 0.5, 0}, {0, 0.5, 0.5}, {0.5, 0, 0.5}};
    double area = 0;
    for (uint32_t t = 0; t < g->ground.mesh->triangle_count; t++)
        for (uint32_t k = 0; k < 3; k++)
            area += meso_triangle_area(g->ground.mesh, t) / 3 * meso_map_value(&g->ground, density, t, corners[k]);
    return area;
}

/* Discs that keep a distance r until none fits any more are some 0.7 in r^2; more are made, and the first taken. */
static double radius_of(const MesoReplicateGround *g, const MesoDetailDistribution *d, const MesoGrowthMap *density)
{
    return d->radius > 0 ? (double)d->radius : sqrt(0.64 * dense_area(g, density) / d->count);
}

/* Growth knows how to strew its seeds: a grammar of one seed and no growth. */
static MesoStatus strew(MesoGrowthStarts *starts, const MesoReplicateGround *g, const MesoDetailDistribution *d,
                        const MesoGrowthMap *density, uint64_t seed)
{
    MesoTool *tool = g->tool;
    MesoGrammar grammar;
    MesoGrammarOptions options = {.extent = g->ground.extent};
    double share = radius_of(g, d, density) / g->ground.extent;
    char count[32] = "";
    if (d->count)
        snprintf(count, sizeof count, " count %u", d->count);
    const char *text = d->density.given
        ? meso_arena_print(&tool->arena, &tool->error, "meso-grow 1\nmap dense = attribute(\"dense\")\n"
                           "seed Dot() on poisson(%.12g extent / sqrt(max(dense, 0.0001))) where dense > 0%s\n"
                           "rule Dot() -> stop\n", share, count)
        : meso_arena_print(&tool->arena, &tool->error, "meso-grow 1\nseed Dot() on poisson(%.12g extent)%s\n"
                           "rule Dot() -> stop\n", share, count);
    if (!text)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_grammar_read(&grammar, &tool->arena, tool->operands[0], text, strlen(text), &options,
                                          &tool->error);
    const uint32_t none[2] = {0, 0};
    const MesoGrowthContexts contexts = {.ground = &g->ground, .map_count = d->density.given, .maps = density};
    const MesoGrowthPlaces places = {0, NULL, NULL, none};
    return status ? status : meso_growth_seeds(starts, &tool->arena, &grammar, &contexts, &places, seed, tool->threads,
                                               &tool->error);
}

static MesoStatus places_of_poisson(MesoDetailPlaces *out, const MesoReplicateGround *g,
                                    const MesoDetailDistribution *d, const MesoGrowthMap *density, uint64_t seed)
{
    MesoGrowthStarts starts;
    MesoStatus status = strew(&starts, g, d, density, seed);
    if (status == MESO_ERR_LIMIT)
        return meso_fail(&g->tool->error, status, "%s: \"poisson\": the radius is too small for so much surface",
                         g->tool->operands[0]);
    if (!status)
        status = make_room(out, g, starts.count);
    for (uint32_t i = 0; i < starts.count && !status; i++) {
        const MesoTip *tip = &starts.starts[i].tip;
        float v = (float)tip->weight[1], w = (float)tip->weight[2];
        out->places[i] = (MesoDetailPlace){{tip->triangle, {fmaxf(1 - v - w, 0), v, w}}, nothing};
    }
    return status;
}

/* ---- scattered ---- */

/* Draws for each that is wanted, where the density lets only a few stay; and for the first of all. */
enum { DRAWS_EACH = 1000, DRAWS_FOR_FIRST = 1 << 20 };

static double share_of(MesoRandom *random)
{
    return (double)(meso_random_next(random) >> 11) * 0x1p-53;
}

/* Of the surface's area; `sums` [triangle_count + 1]. */
static MesoMeshPoint point_in(const MesoTriangulation *mesh, const double *sums, MesoRandom *random)
{
    double at = share_of(random) * sums[mesh->triangle_count], v = share_of(random), w = share_of(random);
    uint32_t low = 0, high = mesh->triangle_count;
    while (high - low > 1) {
        uint32_t middle = (low + high) / 2;
        *(sums[middle] <= at ? &low : &high) = middle;
    }
    if (v + w > 1) {
        v = 1 - v;
        w = 1 - w;
    }
    return (MesoMeshPoint){low, {(float)(1 - v - w), (float)v, (float)w}};
}

static MesoStatus places_scattered(MesoDetailPlaces *out, const MesoReplicateGround *g,
                                   const MesoDetailDistribution *d, const MesoGrowthMap *density, uint64_t seed)
{
    const MesoTriangulation *mesh = g->ground.mesh;
    double *sums = MESO_NEW(&g->tool->arena, double, (size_t)mesh->triangle_count + 1, &g->tool->error);
    MesoStatus status = sums ? make_room(out, g, d->count) : MESO_ERR_MEMORY;
    MesoRandom random;
    if (status)
        return status;
    meso_random_init(&random, seed, 0);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        sums[t + 1] = sums[t] + meso_triangle_area(mesh, t);
    out->count = 0;
    for (uint64_t n = 0; out->count < d->count && n < DRAWS_EACH * (uint64_t)d->count; n++) {
        if (n == DRAWS_FOR_FIRST && out->count == 0)
            break;
        MesoMeshPoint point = point_in(mesh, sums, &random);
        const double weight[3] = {(double)point.weight[0], (double)point.weight[1], (double)point.weight[2]};
        if (share_of(&random) < meso_map_value(&g->ground, density, point.triangle, weight))
            out->places[out->count++] = (MesoDetailPlace){point, nothing};
    }
    if (out->count < d->count)
        meso_tool_say(g->tool, "%u of %u details are scattered: the density is too low for more", out->count, d->count);
    return MESO_OK;
}

/* ---- scenes ---- */

/* The parts of one id: where they are, how far they reach, and along what. */
typedef struct Cloud {
    uint64_t count;
    double sum[3], square[6];
    MesoBox box;
} Cloud;

static void add_vertex(Cloud *c, MesoVec3 p)
{
    const double x[3] = {(double)p.x, (double)p.y, (double)p.z};
    if (c->count++ == 0)
        c->box = (MesoBox){p, p};
    c->box.low = (MesoVec3){fminf(c->box.low.x, p.x), fminf(c->box.low.y, p.y), fminf(c->box.low.z, p.z)};
    c->box.high = (MesoVec3){fmaxf(c->box.high.x, p.x), fmaxf(c->box.high.y, p.y), fmaxf(c->box.high.z, p.z)};
    for (int i = 0, k = 0; i < 3; i++) {
        c->sum[i] += x[i];
        for (int j = i; j < 3; j++)
            c->square[k++] += x[i] * x[j];
    }
}

/* The direction in which it is longest, by repeated multiplication. */
static MesoVec3 long_axis(const Cloud *c)
{
    double m[3][3], v[3] = {0.61, 0.53, 0.59}, n = (double)c->count;
    for (int i = 0, k = 0; i < 3; i++)
        for (int j = i; j < 3; j++, k++)
            m[i][j] = m[j][i] = c->square[k] / n - c->sum[i] / n * (c->sum[j] / n);
    for (int step = 0; step < 60; step++) {
        double w[3], length = 0;
        for (int i = 0; i < 3; i++) {
            w[i] = m[i][0] * v[0] + m[i][1] * v[1] + m[i][2] * v[2];
            length = fmax(length, fabs(w[i]));
        }
        for (int i = 0; i < 3 && length > 0; i++)
            v[i] = w[i] / length;
    }
    return (MesoVec3){(float)v[0], (float)v[1], (float)v[2]};
}

static MesoDetailPoint point_of(const Cloud *c)
{
    double n = (double)c->count;
    MesoVec3 sides = meso_vec3_sub(c->box.high, c->box.low);
    MesoDetailPoint point = nothing;
    point.position = (MesoVec3){(float)(c->sum[0] / n), (float)(c->sum[1] / n), (float)(c->sum[2] / n)};
    point.size = fmaxf(sides.x, fmaxf(sides.y, sides.z));
    point.size = point.size > 0 ? point.size : NAN;
    point.direction = long_axis(c);
    point.headed = true;
    return point;
}

static MesoStatus choose_channel(const MesoReplicateGround *g, const MesoDetailDistribution *d, const MesoScene *scene,
                                 uint32_t *channel)
{
    for (*channel = 0; *channel < scene->channel_count; ++*channel)
        if (d->channel ? strcmp(scene->channels[*channel].name, d->channel) == 0 : !scene->channels[*channel].names)
            return MESO_OK;
    return meso_fail(&g->tool->error, MESO_ERR_INPUT, "%s: '%s' has no ids%s%s%s", g->tool->operands[0], d->scene,
                     d->channel ? " by the name '" : "", d->channel ? d->channel : "", d->channel ? "'" : "");
}

static MesoStatus gather(Cloud *clouds, const MesoReplicateGround *g, const MesoScene *scene, uint32_t channel)
{
    MesoTool *tool = g->tool;
    MesoSceneParts parts;
    MesoStatus status = meso_scene_parts_init(&parts, &tool->arena, scene, &tool->error);
    for (uint32_t i = 0; !status && i < parts.part_count; i++) {
        MesoArenaMark mark = meso_arena_mark(&tool->arena);
        uint64_t count = parts.vertex_begin[i + 1] - parts.vertex_begin[i];
        MesoMeshVertex *vertices = MESO_NEW(&tool->arena, MesoMeshVertex, count, &tool->error);
        if (!vertices)
            return MESO_ERR_MEMORY;
        meso_scene_vertices(&parts, i, i + 1, vertices);
        Cloud *cloud = &clouds[meso_scene_id(scene, meso_scene_part(&parts, i).ids, channel)];
        for (uint64_t v = 0; v < count; v++)
            add_vertex(cloud, vertices[v].position);
        meso_arena_rewind(&tool->arena, mark);
    }
    return status;
}

static MesoStatus places_of_scene(MesoDetailPlaces *out, const MesoReplicateGround *g, const MesoDetailDistribution *d)
{
    MesoTool *tool = g->tool;
    MesoScene scene;
    MesoInput input;
    MesoSceneReading reading = {.thread_count = tool->threads};
    uint32_t channel = 0, count = 0;
    const char *path = meso_replicate_file_path(g->files, d->scene);
    MesoStatus status = path ? meso_tool_read_scene(tool, &scene, &input, path, &reading) : MESO_ERR_MEMORY;
    if (status)
        return status;
    status = choose_channel(g, d, &scene, &channel);
    uint32_t ids = status ? 0 : scene.channels[channel].count;
    Cloud *clouds = status ? NULL : MESO_NEW(&tool->arena, Cloud, ids, &tool->error);
    if (!status)
        status = clouds ? gather(clouds, g, &scene, channel) : MESO_ERR_MEMORY;
    meso_input_close(&input);
    if (!status)
        status = make_room(out, g, ids);
    for (uint32_t i = 0; i < ids && !status; i++)
        if (clouds[i].count)
            out->places[count++].said = point_of(&clouds[i]);
    out->count = count;
    return status ? status : put_down(out, g);
}

MesoStatus meso_replicate_places(MesoDetailPlaces *out, const MesoReplicateGround *g, const MesoDetailDistribution *d,
                                 const MesoGrowthMap *density, uint64_t seed)
{
    *out = (MesoDetailPlaces){0};
    switch (d->source) {
    case MESO_DETAILS_POISSON: return places_of_poisson(out, g, d, density, seed);
    case MESO_DETAILS_SCATTERED: return places_scattered(out, g, d, density, seed);
    case MESO_DETAILS_OF_SCENE: return places_of_scene(out, g, d);
    default: return places_of_points(out, g, d);
    }
}
