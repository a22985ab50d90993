/*
 * Rules that choose by themselves: a group grammar, after "gTangle: A Grammar
 * for the Procedural Generation of Tangle Patterns" (Santoni and Pellacini
 * 2016) and DecoSurf, section 3.5.
 */
#include <stdlib.h>
#include <string.h>

#include "libcore/base/random.h"
#include "libcore/decor/decor_work.h"
#include "libcore/mesh/point/surface_point.h"

/* A leaf that may be expanded, with what groups and rules ask. */
typedef struct Bud {
    uint32_t region, scope;
    uint64_t key;
    uint32_t rule;              /* chosen, or MESO_NO_INDEX */
    MesoRegionShape shape;
} Bud;

typedef struct Growing {
    MesoDecorWork *work;
    const MesoGrowth *growth;
    Bud *buds;
    uint32_t count;
    uint32_t round;
} Growing;

/* ---- rules and regions ---- */

static bool is_in(MesoRange range, double value)
{
    return value >= (double)range.low && value <= (double)range.high;
}

/* How often a rule has been at work on the way up to the scope. */
static uint32_t uses_above(const Growing *g, const Bud *bud, uint32_t rule)
{
    const MesoRegionTree *tree = &g->work->decor->tree;
    uint32_t uses = 0;
    for (uint32_t r = bud->region; r != bud->scope && r != MESO_NO_INDEX; r = tree->regions[r].parent)
        uses += tree->regions[r].rule == rule + 1;
    return uses;
}

static bool rule_fits(const Growing *g, const Bud *bud, uint32_t number)
{
    const MesoRule *rule = &g->growth->rules[number];
    const MesoRegionTree *tree = &g->work->decor->tree;
    const MesoRegion *region = &tree->regions[bud->region];
    double share = region->area / tree->regions[bud->scope].area;
    bool tagged = rule->where.tag_count == 0;
    for (uint32_t i = 0; i < rule->where.tag_count && !tagged; i++)
        tagged = strcmp(rule->where.tags[i], region->tag) == 0;
    return tagged && is_in(rule->where.borders, bud->shape.borders) && is_in(rule->where.corners, bud->shape.corners) &&
           is_in(rule->where.aspect, bud->shape.aspect) && is_in(rule->where.area, region->area) &&
           is_in(rule->where.area_share, share) &&
           (!rule->where.path || meso_region_fits_path(tree, bud->scope, bud->region, rule->where.path)) &&
           (rule->most == 0 || uses_above(g, bud, number) < rule->most);
}

/* ---- groups ---- */

static uint64_t mixed(uint64_t hash, uint64_t value)
{
    MesoRandom random;
    meso_random_init(&random, hash, value);
    return meso_random_next(&random);
}

static uint64_t text_key(const char *text)
{
    uint64_t key = 1469598103934665603u;    /* FNV-1a */
    for (; *text; text++)
        key = (key ^ (uint8_t)*text) * 1099511628211u;
    return key;
}

static uint64_t group_key(const Growing *g, const Bud *bud)
{
    const MesoRegion *region = &g->work->decor->tree.regions[bud->region];
    uint64_t key = mixed(text_key(region->tag), bud->scope);
    if (g->growth->grouping == MESO_GROUP_NONE)
        return mixed(key, bud->region);
    if (g->growth->grouping == MESO_GROUP_SHAPE)
        return mixed(mixed(key, bud->shape.borders), bud->shape.corners);
    if (g->growth->grouping == MESO_GROUP_CYCLIC)
        return mixed(key, region->number % (g->growth->cycle ? g->growth->cycle : 2));
    return key;
}

static int by_key(const void *a, const void *b)
{
    const Bud *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->region < y->region ? -1 : x->region > y->region;
}

/* A number in [0, 1) of a group and a round. */
static double drawn(const Growing *g, uint64_t key)
{
    MesoRandom random;
    meso_random_init(&random, mixed(g->work->options->seed, key), g->round);
    return (double)(meso_random_next(&random) >> 11) * 0x1p-53;
}

/* A rule that fits the first of the group, by weight; MESO_NO_INDEX: it rests. */
static uint32_t choose_rule(const Growing *g, const Bud *bud)
{
    double total = (double)g->growth->rest, at = 0;
    for (uint32_t i = 0; i < g->growth->rule_count; i++)
        total += rule_fits(g, bud, i) ? (double)g->growth->rules[i].weight : 0;
    double draw = drawn(g, bud->key) * total;
    uint32_t last = MESO_NO_INDEX;
    for (uint32_t i = 0; i < g->growth->rule_count; i++) {
        if (!rule_fits(g, bud, i) || !(g->growth->rules[i].weight > 0))
            continue;
        at += (double)g->growth->rules[i].weight;
        last = i;
        if (draw < at)
            return i;
    }
    return g->growth->rest > 0 ? MESO_NO_INDEX : last;
}

/* ---- rounds ---- */

static MesoStatus add_bud(Growing *g, uint32_t region, uint32_t scope, MesoError *error)
{
    const MesoRegionTree *tree = &g->work->decor->tree;
    double least = (double)g->growth->smallest * tree->regions[scope].area;
    if (tree->regions[region].area < least || tree->regions[region].rested)
        return MESO_OK;
    Bud *bud = &g->buds[g->count++];
    *bud = (Bud){.region = region, .scope = scope, .rule = MESO_NO_INDEX};
    MesoStatus status = meso_decor_shape(g->work, region, &bud->shape, error);
    bud->key = group_key(g, bud);
    return status;
}

static MesoStatus add_leaves(Growing *g, uint32_t region, uint32_t scope, MesoError *error)
{
    const MesoRegionTree *tree = &g->work->decor->tree;
    if (meso_region_is_leaf(tree, region))
        return add_bud(g, region, scope, error);
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < tree->regions[region].child_count && !status; i++)
        status = add_leaves(g, tree->regions[region].child_begin + i, scope, error);
    return status;
}

/* All of a group whose shape the rule fits go with its first; others stay for the next round. */
static void choose(Growing *g)
{
    MesoRegion *regions = g->work->decor->tree.regions;
    qsort(g->buds, g->count, sizeof *g->buds, by_key);
    uint32_t chosen = MESO_NO_INDEX;
    for (uint32_t i = 0; i < g->count; i++) {
        if (i == 0 || g->buds[i].key != g->buds[i - 1].key)
            chosen = choose_rule(g, &g->buds[i]);
        if (chosen != MESO_NO_INDEX && rule_fits(g, &g->buds[i], chosen))
            g->buds[i].rule = chosen;
        else if (chosen == MESO_NO_INDEX)
            regions[g->buds[i].region].rested = true;
    }
}

/* What a rule has made remembers it, for rules that may come only so often. */
static void mark_rule(Growing *g, uint32_t rule, const uint32_t *scopes, uint32_t count)
{
    MesoRegionTree *tree = &g->work->decor->tree;
    for (uint32_t i = 0; i < count; i++)
        tree->regions[scopes[i]].rule = rule + 1;
}

static MesoStatus expand(Growing *g, uint32_t rule, bool *grown, MesoError *error)
{
    uint32_t count = 0, before = g->work->decor->tree.region_count;
    /* not from the scratch: steps rewind theirs */
    uint32_t *scopes = malloc((g->count + 1) * sizeof *scopes);
    if (!scopes)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %u regions", g->count);
    for (uint32_t i = 0; i < g->count; i++)
        if (g->buds[i].rule == rule)
            scopes[count++] = g->buds[i].region;
    qsort(scopes, count, sizeof *scopes, meso_by_number);
    mark_rule(g, rule, scopes, count);
    const MesoMacro *macro = &g->growth->rules[rule].macro;
    MesoStatus status = count == 0 ? MESO_OK
        : meso_decor_run_steps(g->work, macro->steps, macro->step_count, scopes, count, error);
    free(scopes);
    *grown |= g->work->decor->tree.region_count > before;
    return status;
}

static MesoStatus run_round(Growing *g, const MesoTargets *targets, bool *grown, MesoError *error)
{
    MesoStatus status = MESO_OK;
    g->count = 0;
    for (uint32_t i = 0; i < targets->count && !status; i++)
        status = add_leaves(g, targets->targets[i].region, targets->targets[i].region, error);
    if (status)
        return status;
    choose(g);
    for (uint32_t rule = 0; rule < g->growth->rule_count && !status; rule++)
        status = expand(g, rule, grown, error);
    return status;
}

MesoStatus meso_decor_grow(MesoDecorWork *work, const MesoStep *step, const MesoTargets *targets, MesoError *error)
{
    Growing g = {.work = work, .growth = &step->growth};
    MesoStatus status = MESO_OK;
    bool grown = true;
    for (g.round = 0; g.round < step->growth.depth && grown && !status; g.round++) {
        grown = false;
        g.buds = malloc((work->decor->tree.region_count + (size_t)1) * sizeof *g.buds);
        if (!g.buds)
            return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %u regions", work->decor->tree.region_count);
        status = run_round(&g, targets, &grown, error);
        free(g.buds);
    }
    return status;
}
