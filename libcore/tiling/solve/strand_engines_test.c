/*
 * Random tile sets with sweeps of every kind, on random gluings, under random rules on strands: the check, the cuts and
 * every engine against all assignments, whose strands are told apart by means of this file alone.
 *
 * strand_engines_test [CASES [SEED]]
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/tiling/fixture/brute_force.h"
#include "libcore/tiling/fixture/random_case.h"

enum { MOST_SLOTS = 5, MOST_ASSIGNMENTS = 2000, MOST_SWEEPS = 4 * MOST_SLOTS, RULES = 3 };

typedef struct Case {
    MesoTileSet set;
    MesoSlotGraph graph;
    MesoVariantSet variants;
    uint32_t count;             /* assignments that match */
    uint32_t (*variant)[MOST_SLOTS];
    bool *good;                 /* [count] keeps to the constraints at hand */
    MesoRestriction region;
    MesoQuota quota;
    MesoConstraints constraints;
    uint32_t keep[MOST_SLOTS];
} Case;

/* Counts of what was met, so that no kind of case goes missing. */
typedef struct Tally {
    uint32_t cases, possible, impossible, undecided, cuts, fewest;
} Tally;

/* A sweep as it lies: a joint is four times the lower half-edge of its edge, or a number beyond, plus the section. */
typedef struct Link {
    uint32_t joint[2];
    uint32_t strand, piece;
} Link;

static uint32_t joint_of(const Case *c, uint32_t slot, MesoTransform transform, uint32_t side, uint32_t section)
{
    uint32_t place = meso_transform_side(transform, side);
    uint32_t at = place < 4 ? 4 * slot + place : 4 * c->graph.slot_count + 2 * slot + place - 4;
    if (place < 4 && c->graph.twin[at] < at)
        at = c->graph.twin[at];
    return 4 * at + section - c->set.interfaces[c->set.sections[section].interface].section_begin;
}

/* The slot with the least number that edges lead to. */
static uint32_t piece_of(const MesoSlotGraph *graph, uint32_t slot)
{
    uint32_t reached = 1u << slot;
    for (uint32_t i = 0; i < graph->slot_count; i++)
        for (uint32_t h = 0; h < 4 * graph->slot_count; h++)
            if (reached >> h / 4 & 1 && graph->twin[h] != MESO_NO_INDEX)
                reached |= 1u << graph->twin[h] / 4;
    return (uint32_t)__builtin_ctz(reached);
}

static bool touch(const Link *a, const Link *b)
{
    return a->joint[0] == b->joint[0] || a->joint[0] == b->joint[1] || a->joint[1] == b->joint[0] ||
           a->joint[1] == b->joint[1];
}

/* Lists the links; those of one strand get the number of its first. */
static uint32_t list_links(const Case *c, const uint32_t *variant, Link *links)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < c->graph.slot_count; s++) {
        const MesoTile *tile = &c->set.tiles[c->variants.tile[variant[s]]];
        MesoTransform transform = c->variants.transform[variant[s]];
        for (uint32_t i = 0; i < tile->sweep_count; i++, count++) {
            const MesoSweep *sweep = &c->set.sweeps[tile->sweep_begin + i];
            links[count] = (Link){{joint_of(c, s, transform, sweep->from_side, sweep->from_section),
                                   joint_of(c, s, transform, sweep->to_side, sweep->to_section)},
                                  count, piece_of(&c->graph, s)};
        }
    }
    for (bool changed = true; changed;) {
        changed = false;
        for (uint32_t i = 0; i < count; i++)
            for (uint32_t j = 0; j < count; j++)
                if (touch(&links[i], &links[j]) && links[j].strand < links[i].strand) {
                    links[i].strand = links[j].strand;
                    changed = true;
                }
    }
    return count;
}

/* Whether strand `strand` of the links by itself keeps to the rule. */
static bool strand_keeps(const MesoStrandRule *rule, const Link *links, uint32_t count, uint32_t strand)
{
    uint32_t length = 0, joints = 0, ends[8 * 4 * MOST_SLOTS] = {0};
    bool ring = true;
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t e = 0; e < 2 && links[i].strand == strand; e++) {
            length += e;
            joints += ends[links[i].joint[e]]++ == 0;
        }
    for (uint32_t i = 0; i < 8 * 4 * MOST_SLOTS; i++)
        ring &= ends[i] == 0 || ends[i] == 2;
    return !(rule->acyclic && length >= joints) && !(rule->no_loops && ring) &&
           !(rule->max_length && length > rule->max_length);
}

static bool strands_keep(const Case *c, const MesoStrandRule *rule, const uint32_t *variant)
{
    Link links[MOST_SWEEPS];
    uint32_t count = list_links(c, variant, links);
    for (uint32_t i = 0; i < count; i++) {
        if (links[i].strand == i && !strand_keeps(rule, links, count, i))
            return false;
        for (uint32_t j = 0; j < i && rule->connected; j++)
            if (links[i].piece == links[j].piece && links[i].strand != links[j].strand)
                return false;
    }
    return true;
}

/* The other constraints, looked at as plainly. */
static bool others_hold(const Case *c, const uint32_t *variant)
{
    uint32_t used = 0;
    for (uint32_t s = 0; s < c->graph.slot_count; s++)
        used += c->constraints.quota_count && meso_bits_test(c->quota.variants, variant[s]);
    if (c->constraints.quota_count && (used < c->quota.least || used > c->quota.most))
        return false;
    return !c->constraints.restriction_count || meso_bits_test(c->region.allowed, variant[c->region.places[0]]);
}

static void unpack(const Case *c, uint64_t number, uint32_t *variant)
{
    for (uint32_t s = 0; s < c->graph.slot_count; s++, number /= c->variants.count)
        variant[s] = (uint32_t)(number % c->variants.count);
}

static bool draw_case(Case *c, MesoArena *arena, MesoRandom *random)
{
    *c = (Case){.set = random_strand_set(arena, random)};
    c->graph = random_graph(arena, random);
    BruteForce force = brute_force(arena, &c->set, &c->graph, MOST_ASSIGNMENTS, true);
    c->variants = force.variants;
    c->count = (uint32_t)force.count;
    if (force.count == 0 || force.count == MOST_ASSIGNMENTS)
        return false;
    c->variant = meso_arena_alloc(arena, c->count, sizeof *c->variant, NULL);
    c->good = MESO_NEW(arena, bool, c->count, NULL);
    CHECK(c->variant && c->good);
    for (uint32_t n = 0; n < c->count; n++)
        unpack(c, force.numbers[n], c->variant[n]);
    return true;
}

static MesoStrandRule draw_rule(MesoRandom *random)
{
    uint32_t bits = 1 + meso_random_below(random, 15);
    return (MesoStrandRule){.connected = bits & 1, .acyclic = bits & 2, .no_loops = bits & 4,
                            .max_length = bits & 8 ? 1 + meso_random_below(random, 5) : 0};
}

static uint64_t *draw_variants(const Case *c, MesoArena *arena, MesoRandom *random)
{
    uint64_t *bits = MESO_NEW(arena, uint64_t, meso_bits_words(c->variants.count), NULL);
    CHECK(bits);
    for (uint32_t v = 0; v < c->variants.count; v++)
        if (meso_random_below(random, 2))
            meso_bits_set(bits, v);
    return bits;
}

/* A rule on strands, and at times a quota, a region of one slot, or what is to be kept. */
static void draw_constraints(Case *c, MesoArena *arena, MesoRandom *random)
{
    uint32_t slots = c->graph.slot_count;
    uint32_t *place = MESO_NEW(arena, uint32_t, 1, NULL);
    CHECK(place);
    *place = meso_random_below(random, slots);
    c->region = (MesoRestriction){.name = "regions[0]", .place_count = 1, .places = place,
                                  .allowed = draw_variants(c, arena, random)};
    c->quota = (MesoQuota){.name = "quotas[0]", .variants = draw_variants(c, arena, random),
                           .least = meso_random_below(random, slots)};
    c->quota.most = c->quota.least + meso_random_below(random, slots);
    for (uint32_t s = 0; s < slots; s++)
        c->keep[s] = meso_random_below(random, c->variants.count);
    c->constraints = (MesoConstraints){.strands = draw_rule(random),
                                       .quota_count = meso_random_below(random, 4) == 0, .quotas = &c->quota,
                                       .restriction_count = meso_random_below(random, 4) == 0,
                                       .restrictions = &c->region,
                                       .keep = meso_random_below(random, 4) ? NULL : c->keep};
}

static void read_assignment(const Case *c, uint32_t n, uint32_t *tile, MesoTransform *transform)
{
    CHECK(c->graph.slot_count <= MOST_SLOTS);
    for (uint32_t s = 0; s < c->graph.slot_count; s++) {
        tile[s] = c->variants.tile[c->variant[n][s]];
        transform[s] = c->variants.transform[c->variant[n][s]];
    }
}

/* No assignment that keeps to the rule has all that a cut forbids to stand together. */
static void check_cuts(const Case *c, MesoArena *arena, const MesoAssignment *assignment, uint32_t number, bool kept,
                       Tally *tally)
{
    const MesoStrandRule *rule = &c->constraints.strands;
    MesoStrandCuts cuts;
    CHECK(meso_strands_cuts(&cuts, arena, rule, assignment, &c->set, &c->graph, 100, NULL) == MESO_OK);
    CHECK((cuts.count == 0) == kept);
    tally->cuts += cuts.count;
    for (uint32_t i = 0; i < cuts.count; i++)
        for (uint32_t n = 0; n < c->count; n++) {
            bool same = true;
            for (uint32_t j = cuts.begin[i]; j < cuts.begin[i + 1]; j++)
                same &= c->variant[n][cuts.slots[j]] == c->variant[number][cuts.slots[j]];
            CHECK(!same || !strands_keep(c, rule, c->variant[n]));
        }
}

/* The library's check says of every assignment what this file says; marks the good ones. */
static uint32_t check_assignments(Case *c, MesoArena *arena, Tally *tally)
{
    uint32_t tile[MOST_SLOTS], possible = 0;
    MesoTransform transform[MOST_SLOTS];
    const MesoAssignment assignment = {c->graph.slot_count, tile, transform};
    for (uint32_t n = 0; n < c->count; n++) {
        bool kept = strands_keep(c, &c->constraints.strands, c->variant[n]);
        read_assignment(c, n, tile, transform);
        CHECK((meso_strands_check(&c->constraints.strands, &assignment, &c->set, &c->graph, NULL) == MESO_OK) == kept);
        if (n % (1 + c->count / 16) == 0)
            check_cuts(c, arena, &assignment, n, kept, tally);
        c->good[n] = kept && others_hold(c, c->variant[n]);
        possible += c->good[n];
    }
    return possible;
}

static uint32_t changes(const Case *c, const uint32_t *variant)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < c->graph.slot_count; s++)
        count += variant[s] != c->keep[s];
    return count;
}

/* What is solved is one of the good assignments, and changes the fewest where it says so. */
static void check_solution(const Case *c, const MesoSolveResult *result, Tally *tally)
{
    uint32_t variant[MOST_SLOTS], fewest = MOST_SLOTS, found = 0;
    for (uint32_t s = 0; s < c->graph.slot_count; s++)
        variant[s] = meso_variant_find(&c->variants, &c->set, result->assignment.tile[s],
                                       result->assignment.transform[s]);
    for (uint32_t n = 0; n < c->count; n++) {
        if (!c->good[n])
            continue;
        found += memcmp(variant, c->variant[n], c->graph.slot_count * sizeof *variant) == 0;
        fewest = changes(c, c->variant[n]) < fewest ? changes(c, c->variant[n]) : fewest;
    }
    CHECK(found == 1);
    if (c->constraints.keep && result->changes_fewest) {
        CHECK(changes(c, variant) == fewest);
        tally->fewest++;
    }
}

static void check_engines(const Case *c, MesoArena *arena, uint64_t seed, bool possible, Tally *tally)
{
    for (MesoEngine engine = MESO_ENGINE_AUTO; engine <= MESO_ENGINE_EXACT; engine++) {
        MesoSolveResult result;
        MesoError error;
        const MesoSolveOptions options = {.seed = seed, .engine = engine, .max_attempts = 5};
        CHECK(meso_solve(&result, arena, &(MesoTilingProblem){&c->set, &c->variants, &c->graph, &c->constraints},
                         &options, &error) == MESO_OK);
        if (result.verdict == MESO_VERDICT_GAVE_UP) {
            CHECK(engine == MESO_ENGINE_WFC);
            tally->undecided++;
            continue;
        }
        CHECK((result.verdict == MESO_VERDICT_SOLVED) == possible);
        if (possible)
            check_solution(c, &result, tally);
    }
}

int main(int argc, char **argv)
{
    uint32_t cases = argc > 1 ? (uint32_t)strtoul(argv[1], NULL, 10) : 500;
    uint64_t seed = argc > 2 ? strtoull(argv[2], NULL, 10) : 1;
    MesoArena arena;
    MesoRandom random;
    Tally tally = {0};
    meso_arena_init(&arena);
    meso_random_init(&random, seed, 0);
    while (tally.cases < cases) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        Case c;
        if (draw_case(&c, &arena, &random)) {
            for (uint32_t r = 0; r < RULES; r++) {
                draw_constraints(&c, &arena, &random);
                bool possible = check_assignments(&c, &arena, &tally) > 0;
                tally.possible += possible;
                tally.impossible += !possible;
                check_engines(&c, &arena, tally.cases, possible, &tally);
            }
            tally.cases++;
        }
        meso_arena_rewind(&arena, mark);
    }
    if (argc > 1)
        printf("%u cases: %u can be solved, %u cannot; %u cuts, %u with the fewest changes, %u undecided\n",
               tally.cases, tally.possible, tally.impossible, tally.cuts, tally.fewest, tally.undecided);
    CHECK(argc > 1 || (tally.possible > cases && tally.impossible > cases && tally.cuts > cases));
    meso_arena_release(&arena);
    return 0;
}
