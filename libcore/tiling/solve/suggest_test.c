/* Suggestion: votes counted by hand and by brute force, ties, limits, and that it helps. */
#include <string.h>

#include "libcore/base/random.h"
#include "libcore/tiling/fixture/solve_fixture.h"
#include "libcore/tiling/solve/suggest.h"

/* A dead end without borders that allows the label codes in `masks`. */
static MesoDeadEnd dead_end(MesoArena *arena, const uint64_t masks[4])
{
    MesoDeadEnd end = {.slot = 0, .attempt = 1};
    for (uint32_t k = 0; k < 4; k++) {
        end.labels[k] = MESO_NEW(arena, uint64_t, 1, NULL);
        CHECK(end.labels[k]);
        *end.labels[k] = masks[k];
    }
    return end;
}

static uint64_t only(int32_t label)
{
    return (uint64_t)1 << meso_label_code(label);
}

static bool shows(const MesoSuggestion *s, int32_t a, int32_t b, int32_t c, int32_t d)
{
    return s->labels[0] == a && s->labels[1] == b && s->labels[2] == c && s->labels[3] == d;
}

/* One dead end, one fitting configuration (a b b b): each of its transforms has one vote. */
static void test_one(void)
{
    static const int32_t tile[1][4] = {{1, 1, 1, 1}};
    MesoArena arena;
    MesoSuggestion s;
    MesoError error;
    meso_arena_init(&arena);
    uint64_t masks[4] = {only(1), only(2), only(2), only(2)};
    MesoDeadEnd end = dead_end(&arena, masks);

    /* Without transforms there is one candidate; with rotations four, the one that fits as it is first. */
    MesoTileSet set = fixture_set(&arena, 2, 1, tile, false, false, false);
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_OK);
    CHECK(shows(&s, 1, 2, 2, 2) && s.votes == 1 && s.identity_votes == 1 && s.candidate_count == 1);
    set.default_rotation = true;
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_OK);
    CHECK(shows(&s, 1, 2, 2, 2) && s.votes == 1 && s.identity_votes == 1 && s.candidate_count == 4);
    set.default_flip_x = true;
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_OK);
    CHECK(shows(&s, 1, 2, 2, 2) && s.votes == 1 && s.candidate_count == 8);

    /* Two dead ends alike vote twice. */
    MesoDeadEnd two[2] = {end, end};
    CHECK(meso_suggest(&s, &arena, &set, 2, two, &error) == MESO_OK);
    CHECK(shows(&s, 1, 2, 2, 2) && s.votes == 2 && s.identity_votes == 2);
    meso_arena_release(&arena);
}

/*
 * (a a a a) is its own image under every rotation: it fits under four elements
 * of the group, so four votes; under all eight it still has four, for flips
 * turn a into a'.
 */
static void test_symmetric(void)
{
    static const int32_t tile[1][4] = {{2, 2, 2, 2}};
    MesoArena arena;
    MesoSuggestion s;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 1, tile, true, true, false);
    uint64_t masks[4] = {only(1), only(1), only(1), only(1)};
    MesoDeadEnd end = dead_end(&arena, masks);
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, NULL) == MESO_OK);
    CHECK(shows(&s, 1, 1, 1, 1) && s.votes == 4 && s.identity_votes == 1 && s.candidate_count == 2);
    meso_arena_release(&arena);
}

static void test_rules(void)
{
    static const int32_t tile[2][4] = {{1, 1, 1, 1}, {1, -1, 1, -1}};
    MesoArena arena;
    MesoSuggestion s;
    MesoError error;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 2, 2, tile, true, true, false);
    uint64_t masks[4] = {0xf, only(1), only(1), only(1)};
    MesoDeadEnd end = dead_end(&arena, masks);

    CHECK(meso_suggest(&s, &arena, &set, 0, NULL, &error) == MESO_ERR_NO);

    /* What the set has is passed over, under its transforms too. */
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_OK);
    CHECK(shows(&s, -1, 1, 1, 1) && s.votes == 1 && s.candidate_count == 24);
    set.tiles[0].ignored = true;
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_OK);
    CHECK(shows(&s, 1, 1, 1, 1) && s.votes == 4 && s.candidate_count == 26);

    /* Border rules hold, on the border and within. */
    set.interfaces[0].border_exempt = true;
    end.border[0] = true;
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_OK);
    CHECK(shows(&s, 2, 1, 1, 1));
    set.interfaces[0].border_only = true;
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_ERR_NO);

    /* A side that allows nothing leaves nothing to vote for. */
    uint64_t none[4] = {0xf, 0, 0xf, 0xf};
    end = dead_end(&arena, none);
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_ERR_NO);
    CHECK(strstr(error.message, "nothing to suggest"));
    meso_arena_release(&arena);
}

/* Counts votes as the header says, for every configuration and every transform. */
static MesoSuggestion count_all(const MesoTileSet *set, uint32_t end_count, const MesoDeadEnd *ends)
{
    MesoSuggestion best = {0};
    uint32_t codes = 2 * set->interface_count;
    for (uint32_t key = 0; key < codes * codes * codes * codes; key++) {
        MesoTile tile = {.side_count = 4, .rotation = set->default_rotation,
                         .flip_x = set->default_flip_x, .flip_y = set->default_flip_y};
        uint32_t rest = key;
        for (uint32_t k = 4; k-- > 0; rest /= codes)
            tile.labels[k] = (rest % codes) % 2 ? -(int32_t)(rest % codes / 2 + 1)
                                                : (int32_t)(rest % codes / 2 + 1);
        uint64_t votes = 0, identity = 0;
        for (MesoTransform p = 0; p < MESO_TRANSFORM_COUNT; p++)
            for (uint32_t d = 0; meso_tile_allows(&tile, p) && d < end_count; d++) {
                bool fits = true;
                for (uint32_t k = 0; k < 4; k++)
                    fits &= (ends[d].labels[k][0] >> meso_label_code(meso_tile_label(&tile, p, k))) & 1;
                votes += fits;
                identity += fits && p == 0;
            }
        best.candidate_count += votes > 0;
        if (votes > best.votes || (votes == best.votes && identity > best.identity_votes)) {
            best.votes = votes;
            best.identity_votes = identity;
            memcpy(best.labels, tile.labels, sizeof best.labels);
        }
    }
    return best;
}

/* 26 interfaces are counted by hashing, few in a dense array: the same result. */
static void compare_with_count(MesoArena *arena, MesoRandom *random, uint32_t interfaces)
{
    MesoDeadEnd ends[6];
    uint32_t end_count = 1 + meso_random_below(random, 6);
    for (uint32_t d = 0; d < end_count; d++) {
        uint64_t masks[4];
        for (uint32_t k = 0; k < 4; k++)
            masks[k] = meso_random_next(random) & meso_random_next(random) & ((1u << 6) - 1);
        ends[d] = dead_end(arena, masks);
    }
    /* An ignored tile, so that none is passed over. */
    static const int32_t tile[1][4] = {{1, 1, 1, 1}};
    MesoTileSet set = fixture_set(arena, 3, 1, tile, meso_random_below(random, 2), false, false);
    set.default_flip_x = meso_random_below(random, 2);
    set.default_flip_y = meso_random_below(random, 2);
    set.tiles[0].ignored = true;

    MesoSuggestion expected = count_all(&set, end_count, ends), s;
    MesoTileSet more = fixture_set(arena, interfaces, 1, tile, set.default_rotation, false, false);
    more.default_flip_x = set.default_flip_x;
    more.default_flip_y = set.default_flip_y;
    more.tiles[0].ignored = true;
    MesoStatus status = meso_suggest(&s, arena, &more, end_count, ends, NULL);
    CHECK(status == (expected.votes ? MESO_OK : MESO_ERR_NO));
    if (!expected.votes)
        return;
    CHECK(s.votes == expected.votes && s.identity_votes == expected.identity_votes);
    CHECK(s.candidate_count == expected.candidate_count);
    CHECK(memcmp(s.labels, expected.labels, sizeof s.labels) == 0);
}

static void test_brute_force(void)
{
    MesoArena arena;
    MesoRandom random;
    meso_arena_init(&arena);
    meso_random_init(&random, 11, 0);
    for (uint32_t i = 0; i < 200; i++) {
        MesoArenaMark mark = meso_arena_mark(&arena);
        compare_with_count(&arena, &random, i % 2 ? 3 : 26);
        meso_arena_rewind(&arena, mark);
    }
    meso_arena_release(&arena);
}

/* 2 * 46 labels on each side are 92^4 > 2^26 configurations. */
static void test_limit(void)
{
    static const int32_t tile[1][4] = {{1, 1, 1, 1}};
    MesoArena arena;
    MesoSuggestion s;
    MesoError error;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 1, 1, tile, true, true, false);
    set.interface_count = 46;
    set.interfaces = MESO_NEW(&arena, MesoInterface, set.interface_count, NULL);
    CHECK(set.interfaces);
    MesoDeadEnd end = {0};
    for (uint32_t k = 0; k < 4; k++) {
        end.labels[k] = MESO_NEW(&arena, uint64_t, 2, NULL);
        CHECK(end.labels[k]);
        memset(end.labels[k], 0xff, 16);
    }
    CHECK(meso_suggest(&s, &arena, &set, 1, &end, &error) == MESO_ERR_LIMIT);
    meso_arena_release(&arena);
}

/* Take a tile from a set that tiles a torus, follow the suggestions, and it tiles again. */
static void test_helps(void)
{
    static const int32_t labels[3][4] = {{1, 2, -1, -2}, {1, 2, -1, -3}, {3, 2, -1, -2}};
    MesoArena arena;
    meso_arena_init(&arena);
    for (uint32_t count = 1; count <= 3; count++) {
        /* The last tile alone can be missing where it is the only one that shows c. */
        MesoTileSet set = fixture_set(&arena, 3, count, labels, true, true, false);
        MesoSlotGraph graph = fixture_grid(&arena, 12, 12, count > 1, count > 2, true);
        set.interfaces[1].border_exempt = true;
        MesoSolveResult result = fixture_solve(&arena, &set, &graph, 1, 10);
        uint32_t added = 0;
        for (; result.verdict != MESO_VERDICT_SOLVED && added < 10; added++) {
            MesoSuggestion s;
            CHECK(meso_suggest(&s, &arena, &set, result.dead_end_count, result.dead_ends, NULL) == MESO_OK);
            CHECK(meso_suggestion_append(&set, &arena, &set, &s, NULL) == MESO_OK);
            CHECK(set.tile_count == count + added + 1);
            result = fixture_solve(&arena, &set, &graph, 1, 10);
        }
        CHECK(result.verdict == MESO_VERDICT_SOLVED);
    }
    meso_arena_release(&arena);
}

/* The tile that is missing in the middle of a row is exactly the one suggested. */
static void test_append(void)
{
    static const int32_t labels[2][4] = {{2, 1, 3, 1}, {3, 1, 1, 1}};
    MesoArena arena;
    MesoSuggestion s;
    meso_arena_init(&arena);
    MesoTileSet set = fixture_set(&arena, 3, 2, labels, false, false, false), extended;
    set.interfaces[2].border_only = true;
    set.tiles[0].name = "suggested-1";
    MesoSlotGraph graph = fixture_grid(&arena, 3, 1, false, false, false);
    MesoSolveResult result = fixture_solve(&arena, &set, &graph, 0, 5);
    CHECK(result.verdict == MESO_VERDICT_UNSOLVABLE);
    CHECK(meso_suggest(&s, &arena, &set, result.dead_end_count, result.dead_ends, NULL) == MESO_OK);
    CHECK(shows(&s, -1, 1, -2, 1) && s.candidate_count == 36);

    CHECK(meso_suggestion_append(&extended, &arena, &set, &s, NULL) == MESO_OK);
    CHECK(extended.tile_count == 3 && set.tile_count == 2);
    CHECK(strcmp(extended.tiles[2].name, "suggested-2") == 0);
    CHECK(!extended.tiles[2].rotation && extended.tiles[2].sweep_count == 0);
    result = fixture_solve(&arena, &extended, &graph, 0, 5);
    CHECK(result.verdict == MESO_VERDICT_SOLVED && result.assignment.tile[1] == 2);
    meso_arena_release(&arena);
}

int main(void)
{
    test_one();
    test_symmetric();
    test_rules();
    test_brute_force();
    test_limit();
    test_helps();
    test_append();
    return 0;
}
