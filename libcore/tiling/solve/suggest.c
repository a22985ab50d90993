#include "libcore/tiling/solve/suggest.h"

#include <assert.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/tiling/propagate/initial_states.h"
#include "libcore/tiling/propagate/propagate.h"

/*
 * A configuration's key is its label codes, side 0 first, as digits to the base
 * of the number of codes: keys order as configurations do lexicographically.
 *
 * Only fits are counted: fits(i) is the number of dead ends that configuration i
 * fits as it is. Its votes are the sum of fits(p i) over the permitted transforms p,
 * each element once, and fits(i) of them are identity votes. Configurations
 * that a permitted transform turns into each other so get the same votes.
 */
typedef struct Ballot {
    uint32_t code_count;
    bool dense;             /* every configuration has the place of its key */
    uint64_t *keys;         /* [mask + 1] key + 1, or 0 */
    uint32_t *fits;         /* [mask + 1] */
    uint64_t mask;
    uint64_t count;
} Ballot;

/* A dense ballot of 2^20 places is 12 MiB; a hashed one may take 2^24 configurations. */
enum { DENSE_LIMIT = 1 << 20, FIRST_PLACES = 1 << 12, CONFIGURATION_LIMIT = 1 << 24 };

typedef struct Group {
    uint32_t count;
    struct {
        bool flips;
        uint32_t source[4];
    } element[MESO_TRANSFORM_COUNT];
} Group;

/* A dead end for all that are alike. */
typedef struct Neighbourhood {
    const uint64_t *labels;     /* [4 * label words] after border rules */
    uint32_t count;
} Neighbourhood;

/* --- the symmetry group --- */

static MesoTile default_tile(const MesoTileSet *set)
{
    return (MesoTile){.side_count = 4, .rotation = set->default_rotation,
                      .flip_x = set->default_flip_x, .flip_y = set->default_flip_y};
}

static Group permitted_transforms(const MesoTile *tile)
{
    Group group = {0};
    for (MesoTransform p = 0; p < MESO_TRANSFORM_COUNT; p++) {
        if (!meso_tile_allows(tile, p))
            continue;
        group.element[group.count].flips = meso_transform_flips(p);
        for (uint32_t k = 0; k < 4; k++)
            group.element[group.count].source[k] = meso_transform_source(p, k);
        group.count++;
    }
    return group;
}

static uint64_t key_of(const Ballot *ballot, const uint32_t codes[4])
{
    uint64_t key = 0;
    for (uint32_t k = 0; k < 4; k++)
        key = key * ballot->code_count + codes[k];
    return key;
}

static void codes_of(const Ballot *ballot, uint64_t key, uint32_t codes[4])
{
    for (uint32_t k = 4; k-- > 0; key /= ballot->code_count)
        codes[k] = (uint32_t)(key % ballot->code_count);
}

/* Key of what `codes` show under element `p`. */
static uint64_t transformed_key(const Ballot *ballot, const Group *group, uint32_t p,
                                const uint32_t codes[4])
{
    uint32_t turned[4];
    for (uint32_t k = 0; k < 4; k++)
        turned[k] = codes[group->element[p].source[k]] ^ group->element[p].flips;
    return key_of(ballot, turned);
}

/* --- counting fits --- */

static uint64_t place_of(const Ballot *ballot, uint64_t key)
{
    if (ballot->dense)
        return key;
    uint64_t hash = key * 0x9e3779b97f4a7c15u;
    for (uint64_t i = hash ^ (hash >> 32);; i++)
        if (ballot->keys[i & ballot->mask] == 0 || ballot->keys[i & ballot->mask] == key + 1)
            return i & ballot->mask;
}

static uint32_t fits_of(const Ballot *ballot, uint64_t key)
{
    return ballot->fits[place_of(ballot, key)];
}

static MesoStatus allocate_places(Ballot *ballot, MesoArena *arena, uint64_t places, MesoError *error)
{
    ballot->keys = MESO_NEW(arena, uint64_t, places, error);
    ballot->fits = MESO_NEW(arena, uint32_t, places, error);
    ballot->mask = places - 1;
    return ballot->keys && ballot->fits ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus ballot_init(Ballot *ballot, MesoArena *arena, uint32_t code_count, MesoError *error)
{
    *ballot = (Ballot){.code_count = code_count};
    uint64_t square = (uint64_t)code_count * code_count;
    if (square > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "too many interfaces to suggest from: %u", code_count / 2);
    ballot->dense = square * square <= DENSE_LIMIT;
    return allocate_places(ballot, arena, ballot->dense ? square * square : FIRST_PLACES, error);
}

static MesoStatus ballot_grow(Ballot *ballot, MesoArena *arena, MesoError *error)
{
    Ballot old = *ballot;
    if (old.count >= CONFIGURATION_LIMIT)
        return meso_fail(error, MESO_ERR_LIMIT, "too many configurations to suggest from: over %u",
                         (unsigned)CONFIGURATION_LIMIT);
    if (allocate_places(ballot, arena, 2 * (old.mask + 1), error))
        return MESO_ERR_MEMORY;
    for (uint64_t i = 0; i <= old.mask; i++)
        if (old.keys[i]) {
            uint64_t place = place_of(ballot, old.keys[i] - 1);
            ballot->keys[place] = old.keys[i];
            ballot->fits[place] = old.fits[i];
        }
    return MESO_OK;
}

static MesoStatus add_fit(Ballot *ballot, MesoArena *arena, uint64_t key, uint32_t count, MesoError *error)
{
    if (!ballot->dense && 2 * (ballot->count + 1) > ballot->mask) {
        MesoStatus status = ballot_grow(ballot, arena, error);
        if (status)
            return status;
    }
    uint64_t place = place_of(ballot, key);
    ballot->count += ballot->keys[place] == 0;
    ballot->keys[place] = key + 1;
    ballot->fits[place] += count;
    return MESO_OK;
}

/* Counts every configuration that fits `end`: the product of its sides' labels. */
static MesoStatus count_neighbourhood(Ballot *ballot, MesoArena *arena, const Neighbourhood *end,
                                      uint32_t *lists, MesoError *error)
{
    uint32_t words = meso_bits_words(ballot->code_count);
    uint32_t count[4] = {0};
    uint64_t product = 1;
    for (uint32_t k = 0; k < 4; k++) {
        for (uint32_t c = 0; c < ballot->code_count; c++)
            if (meso_bits_test(end->labels + k * words, c))
                lists[k * ballot->code_count + count[k]++] = c;
        if (count[k] == 0)
            return MESO_OK;
        product *= count[k];
        if (product > MESO_SUGGEST_PRODUCT)
            return meso_fail(error, MESO_ERR_LIMIT, "too many configurations to suggest from: "
                             "a dead end leaves more than %u", (unsigned)MESO_SUGGEST_PRODUCT);
    }
    for (uint64_t i = 0; i < product; i++) {
        uint32_t codes[4];
        uint64_t rest = i;
        for (uint32_t k = 0; k < 4; k++, rest /= count[k - 1])
            codes[k] = lists[k * ballot->code_count + rest % count[k]];
        MesoStatus status = add_fit(ballot, arena, key_of(ballot, codes), end->count, error);
        if (status)
            return status;
    }
    return MESO_OK;
}

/* Dead ends with border rules applied, equal ones together, in the order of their first. */
static MesoStatus gather_neighbourhoods(Neighbourhood *ends, MesoInterner *unique, MesoArena *arena,
                                        const MesoTileSet *set, uint32_t dead_end_count,
                                        const MesoDeadEnd *dead_ends, MesoError *error)
{
    uint32_t words = meso_bits_words(2 * set->interface_count);
    uint64_t *rules = MESO_NEW(arena, uint64_t, 2 * (size_t)words, error);
    uint64_t *labels = MESO_NEW(arena, uint64_t, 4 * (size_t)words, error);
    if (!rules || !labels)
        return MESO_ERR_MEMORY;
    meso_border_labels(set, false, rules);
    meso_border_labels(set, true, rules + words);

    *unique = (MesoInterner){.word_count = 4 * words};
    for (uint32_t d = 0; d < dead_end_count; d++) {
        for (uint32_t k = 0; k < 4; k++)
            for (uint32_t w = 0; w < words; w++)
                labels[k * words + w] = dead_ends[d].labels[k][w] & rules[dead_ends[d].border[k] * words + w];
        uint32_t number = meso_interner_add(unique, arena, labels, error);
        if (number == MESO_NO_INDEX)
            return MESO_ERR_MEMORY;
        ends[number].count++;
    }
    for (uint32_t i = 0; i < unique->count; i++)
        ends[i].labels = meso_interner_bits(unique, i);
    return MESO_OK;
}

static MesoStatus count_fits(Ballot *ballot, MesoArena *arena, const MesoTileSet *set,
                             uint32_t dead_end_count, const MesoDeadEnd *dead_ends, MesoError *error)
{
    MesoInterner unique;
    Neighbourhood *ends = MESO_NEW(arena, Neighbourhood, dead_end_count, error);
    uint32_t *lists = MESO_NEW(arena, uint32_t, 8 * (size_t)set->interface_count, error);
    if (!ends || !lists)
        return MESO_ERR_MEMORY;
    MesoStatus status = gather_neighbourhoods(ends, &unique, arena, set, dead_end_count, dead_ends, error);
    if (!status)
        status = ballot_init(ballot, arena, 2 * set->interface_count, error);
    for (uint32_t i = 0; !status && i < unique.count; i++)
        status = count_neighbourhood(ballot, arena, &ends[i], lists, error);
    return status;
}

/* --- the election --- */

static int compare_keys(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return (x > y) - (x < y);
}

/* Sorted keys of what the set's tiles show under the transforms that they allow. */
static uint64_t *existing_keys(const Ballot *ballot, MesoArena *arena, const MesoTileSet *set,
                               uint32_t *count, MesoError *error)
{
    uint64_t *keys = MESO_NEW(arena, uint64_t, (size_t)set->tile_count * MESO_TRANSFORM_COUNT, error);
    *count = 0;
    if (!keys)
        return NULL;
    for (uint32_t t = 0; t < set->tile_count; t++) {
        const MesoTile *tile = &set->tiles[t];
        for (MesoTransform p = 0; !tile->ignored && p < MESO_TRANSFORM_COUNT; p++) {
            if (!meso_tile_allows(tile, p))
                continue;
            uint32_t codes[4];
            for (uint32_t k = 0; k < 4; k++)
                codes[k] = meso_label_code(meso_tile_label(tile, p, k));
            keys[(*count)++] = key_of(ballot, codes);
        }
    }
    qsort(keys, *count, sizeof *keys, compare_keys);
    return keys;
}

static bool better(const MesoSuggestion *best, uint64_t best_key, uint64_t votes,
                   uint64_t identity_votes, uint64_t key)
{
    if (votes != best->votes)
        return votes > best->votes;
    if (identity_votes != best->identity_votes)
        return identity_votes > best->identity_votes;
    return key < best_key;
}

/*
 * Looks at the configurations that `key` becomes under the group, all with the
 * same votes. An orbit is met once for each of its members that fit; only
 * the smallest of these counts it.
 */
static void hold_orbit(MesoSuggestion *best, uint64_t *best_key, const Ballot *ballot,
                       const Group *group, uint64_t key, const uint64_t *existing,
                       uint32_t existing_count)
{
    uint32_t codes[4];
    uint64_t orbit[MESO_TRANSFORM_COUNT], votes = 0;
    codes_of(ballot, key, codes);
    for (uint32_t p = 0; p < group->count; p++) {
        orbit[p] = transformed_key(ballot, group, p, codes);
        uint32_t fits = fits_of(ballot, orbit[p]);
        if (fits && orbit[p] < key)
            return;
        votes += fits;
    }
    qsort(orbit, group->count, sizeof *orbit, compare_keys);
    for (uint32_t p = 0; p < group->count; p++) {
        if ((p > 0 && orbit[p] == orbit[p - 1]) ||
            bsearch(&orbit[p], existing, existing_count, sizeof *existing, compare_keys))
            continue;
        best->candidate_count++;
        uint64_t identity_votes = fits_of(ballot, orbit[p]);
        if (better(best, *best_key, votes, identity_votes, orbit[p])) {
            best->votes = votes;
            best->identity_votes = identity_votes;
            *best_key = orbit[p];
        }
    }
}

static MesoStatus elect(MesoSuggestion *best, const Ballot *ballot, MesoArena *arena,
                        const MesoTileSet *set, MesoError *error)
{
    MesoTile tile = default_tile(set);
    Group group = permitted_transforms(&tile);
    uint64_t best_key = UINT64_MAX;
    uint32_t existing_count;
    uint64_t *existing = existing_keys(ballot, arena, set, &existing_count, error);
    if (!existing)
        return MESO_ERR_MEMORY;
    for (uint64_t i = 0; i <= ballot->mask && ballot->count; i++)
        if (ballot->keys[i])
            hold_orbit(best, &best_key, ballot, &group, ballot->keys[i] - 1, existing, existing_count);
    if (!best->votes)
        return MESO_ERR_NO;

    uint32_t codes[4];
    codes_of(ballot, best_key, codes);
    for (uint32_t k = 0; k < 4; k++)
        best->labels[k] = codes[k] % 2 ? -(int32_t)(codes[k] / 2 + 1) : (int32_t)(codes[k] / 2 + 1);
    return MESO_OK;
}

/* Why there is no candidate: most often because the border rules leave none. */
static MesoStatus say_no(const MesoTileSet *set, uint32_t dead_end_count, const MesoDeadEnd *dead_ends,
                         MesoError *error)
{
    bool border_possible = false, border_met = false;
    for (uint32_t i = 0; i < set->interface_count; i++)
        border_possible |= !set->interfaces[i].border_exempt;
    for (uint32_t d = 0; d < dead_end_count; d++)
        for (uint32_t k = 0; k < 4; k++)
            border_met |= dead_ends[d].border[k];
    if (border_met && !border_possible)
        return meso_fail(error, MESO_ERR_NO, "nothing to suggest: dead ends lie on the border, and every "
                         "interface is border exempt");
    return meso_fail(error, MESO_ERR_NO, "nothing to suggest: no new tile fits a dead end");
}

MesoStatus meso_suggest(MesoSuggestion *suggestion, MesoArena *arena, const MesoTileSet *set,
                        uint32_t dead_end_count, const MesoDeadEnd *dead_ends, MesoError *error)
{
    *suggestion = (MesoSuggestion){0};
    if (dead_end_count == 0 || set->interface_count == 0)
        return meso_fail(error, MESO_ERR_NO, "nothing to suggest: no dead end");

    Ballot ballot;
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoStatus status = count_fits(&ballot, arena, set, dead_end_count, dead_ends, error);
    if (!status)
        status = elect(suggestion, &ballot, arena, set, error);
    meso_arena_rewind(arena, mark);
    return status == MESO_ERR_NO ? say_no(set, dead_end_count, dead_ends, error) : status;
}

/* --- the new tile --- */

static bool name_taken(const MesoTileSet *set, const char *name)
{
    for (uint32_t t = 0; t < set->tile_count; t++)
        if (strcmp(set->tiles[t].name, name) == 0)
            return true;
    return false;
}

MesoStatus meso_suggestion_append(MesoTileSet *extended, MesoArena *arena, const MesoTileSet *set,
                                  const MesoSuggestion *suggestion, MesoError *error)
{
    MesoTile tile = default_tile(set);
    char name[32];
    uint32_t number = 0;
    do
        snprintf(name, sizeof name, "suggested-%u", ++number);
    while (name_taken(set, name));
    tile.name = meso_arena_copy_text(arena, name, error);
    MesoTile *tiles = MESO_NEW(arena, MesoTile, (size_t)set->tile_count + 1, error);
    if (!tile.name || !tiles)
        return MESO_ERR_MEMORY;

    memcpy(tile.labels, suggestion->labels, sizeof suggestion->labels);
    tile.sweep_begin = set->sweep_count;
    tile.inner_begin = set->inner_count;
    memcpy(tiles, set->tiles, set->tile_count * sizeof *tiles);
    tiles[set->tile_count] = tile;
    *extended = *set;
    extended->tiles = tiles;
    extended->tile_count++;
    return MESO_OK;
}
