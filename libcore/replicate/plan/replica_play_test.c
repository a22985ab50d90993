/* Playing: against the formula term by term; forwards, backwards, alone; on any number of threads. */
#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/replicate/plan/replica_play.h"
#include "libcore/replicate/statistics/points_fixture.h"

enum { COUNT = 30000, SIDE = 30, NEAR = 12, BLOCKS = 600 };

typedef struct Stage {
    MesoArena arena;
    MesoTriangulation mesh;
    MesoVec3 *moved;
    MesoReplicaPlan plan;
    MesoPlayer *player;
} Stage;

static MesoVec3 place_of(const Stage *s, const MesoVec3 *positions, uint32_t k)
{
    return meso_detail_position(&s->mesh, positions, &s->plan.details[k].point);
}

/* Details strewn freely in ranks that are not their order; pairs of those that are near in it. */
static void start(Stage *out)
{
    static MesoDetail details[COUNT];
    static uint32_t begin[COUNT + 1];
    static MesoReplicaPair pairs[COUNT * NEAR];
    static MesoReplicaRoom rooms[COUNT];
    Stage s = {.mesh = meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE), .plan = {COUNT, details, begin, pairs, rooms}};
    meso_arena_init(&s.arena);
    s.moved = MESO_NEW(&s.arena, MesoVec3, s.mesh.vertex_count, NULL);
    MesoMeshPoint *points = meso_strew_freely(&s.mesh, COUNT, 4);
    MesoRandom random;
    meso_random_init(&random, 1, 1);
    for (uint32_t k = 0; k < COUNT; k++)
        details[k] = (MesoDetail){.point = points[k], .size = 1, .width = 1,
                                  .rank = (uint32_t)((uint64_t)k * 7919 % COUNT),
                                  .born = k % 3 ? MESO_DETAIL_ORIGINAL : 1};
    for (uint32_t k = 0; k < COUNT; k++)
        rooms[k] = (MesoReplicaRoom){meso_random_below(&random, BLOCKS), k % 5 ? 0.5f : 1.1f,
                                     k % 50 ? 1.2f + 0.5f * (float)meso_fixture_share(&random) : INFINITY};
    for (uint32_t k = 0; k < COUNT; k++) {
        begin[k + 1] = begin[k];
        for (uint32_t i = 0; i < NEAR; i++) {
            uint32_t other = meso_random_below(&random, COUNT);
            if (details[other].rank >= details[k].rank)
                continue;
            float d = meso_vec3_length(meso_vec3_sub(place_of(&s, s.mesh.positions, k),
                                                     place_of(&s, s.mesh.positions, other)));
            float to = d * (float)(0.9 + 0.6 * meso_fixture_share(&random));
            pairs[begin[k + 1]++] = (MesoReplicaPair){other, 0.8f * to, to};
        }
    }
    free(points);
    *out = s;
    CHECK(s.moved && meso_player_build(&out->player, &out->arena, &out->mesh, &out->plan, NULL) == MESO_OK);
}

static void stretch(Stage *s, float x, float y)
{
    for (uint32_t v = 0; v < s->mesh.vertex_count; v++) {
        MesoVec3 p = s->mesh.positions[v];
        s->moved[v] = (MesoVec3){x * p.x, y * p.y, 0.1f * (x - 1) * sinf(9 * p.x)};
    }
}

static double step(double x)
{
    x = fmin(fmax(x, 0), 1);
    return x * x * (3 - 2 * x);
}

static double area_of(const Stage *s, const MesoVec3 *positions, uint32_t triangle)
{
    const uint32_t *c = s->mesh.corners + 3 * (size_t)triangle;
    MesoVec3 u = meso_vec3_sub(positions[c[1]], positions[c[0]]), v = meso_vec3_sub(positions[c[2]], positions[c[0]]);
    return 0.5 * (double)meso_vec3_length(meso_vec3_cross(u, v));
}

/* Of each part: by how much its originals' triangles have grown, in the mean. */
static void find_extents(const Stage *s, double extents[BLOCKS])
{
    uint32_t counts[BLOCKS] = {0};
    memset(extents, 0, BLOCKS * sizeof *extents);
    for (uint32_t k = 0; k < COUNT; k++) {
        uint32_t triangle = s->plan.details[k].point.triangle, block = s->plan.rooms[k].block;
        if (s->plan.details[k].born != MESO_DETAIL_ORIGINAL)
            continue;
        extents[block] += area_of(s, s->moved, triangle) / area_of(s, s->mesh.positions, triangle);
        counts[block]++;
    }
    for (uint32_t b = 0; b < BLOCKS; b++)
        extents[b] /= counts[b] ? counts[b] : 1;
}

static void test_formula(Stage *s)
{
    static double extents[BLOCKS];
    static float grown[COUNT];
    static double expected[COUNT];
    static uint32_t by_rank[COUNT];
    stretch(s, 1.2f, 1.05f);
    meso_player_play(s->player, grown, s->moved, 1);
    find_extents(s, extents);
    for (uint32_t k = 0; k < COUNT; k++)
        by_rank[s->plan.details[k].rank] = k;
    uint32_t between = 0;
    for (uint32_t r = 0; r < COUNT; r++) {
        uint32_t k = by_rank[r];
        expected[k] = step((extents[s->plan.rooms[k].block] - (double)s->plan.rooms[k].from)
                           / ((double)s->plan.rooms[k].to - (double)s->plan.rooms[k].from));
        for (uint32_t i = s->plan.pair_begin[k]; i < s->plan.pair_begin[k + 1]; i++) {
            const MesoReplicaPair *pair = &s->plan.pairs[i];
            MesoVec3 apart = meso_vec3_sub(place_of(s, s->moved, k), place_of(s, s->moved, pair->other));
            double x = (meso_vec3_length(apart) - (double)pair->from) / ((double)pair->to - (double)pair->from);
            expected[k] = fmin(expected[k], 1 - expected[pair->other] * (1 - step(x)));
        }
        CHECK(fabs(expected[k] - (double)grown[k]) < 1e-3);
        between += grown[k] > 0.01f && grown[k] < 0.99f;
    }
    CHECK(between > COUNT / 20);
}

/* There and back, in any order, on any number of threads: the same bytes. */
static void test_reversible(Stage *s)
{
    static float first[11][COUNT], again[COUNT];
    for (int f = 0; f <= 10; f++) {
        stretch(s, 1 + 0.1f * (float)f, 1);
        meso_player_play(s->player, first[f], s->moved, 1);
    }
    const uint32_t threads[] = {2, 7, 1};
    for (int f = 10; f >= 0; f--) {
        stretch(s, 1 + 0.1f * (float)f, 1);
        meso_player_play(s->player, again, s->moved, threads[f % 3]);
        CHECK(memcmp(first[f], again, sizeof again) == 0);
    }
}

/* Half the step, half of the largest change: nothing pops. */
static double largest_change(Stage *s, int frames)
{
    static float shares[2][COUNT];
    double most = 0;
    for (int f = 0; f <= frames; f++) {
        stretch(s, 1 + 0.05f * (float)f / (float)frames, 1);
        meso_player_play(s->player, shares[f % 2], s->moved, 2);
        for (uint32_t k = 0; k < COUNT && f > 0; k++)
            most = fmax(most, fabs((double)shares[0][k] - (double)shares[1][k]));
    }
    return most;
}

static void test_no_pop(Stage *s)
{
    double coarse = largest_change(s, 32), fine = largest_change(s, 64);
    CHECK(coarse > 0.005 && coarse < 0.5 && fine < 0.56 * coarse);
}

static void test_refused(Stage *s)
{
    MesoPlayer *player;
    MesoError error;
    MesoReplicaPair *pair = &s->plan.pairs[s->plan.pair_begin[COUNT] - 1], kept = *pair;
    pair->from = pair->to;
    CHECK(meso_player_build(&player, &s->arena, &s->mesh, &s->plan, &error) == MESO_ERR_INPUT);
    *pair = kept;
    pair->other = COUNT;
    CHECK(meso_player_build(&player, &s->arena, &s->mesh, &s->plan, &error) == MESO_ERR_INPUT);
    *pair = kept;
    MesoReplicaRoom *room = &s->plan.rooms[7], whole = *room;
    room->to = room->from;
    CHECK(meso_player_build(&player, &s->arena, &s->mesh, &s->plan, &error) == MESO_ERR_INPUT);
    *room = whole;
    room->block = COUNT;
    CHECK(meso_player_build(&player, &s->arena, &s->mesh, &s->plan, &error) == MESO_ERR_INPUT);
    *room = whole;
    s->plan.details[5].rank = s->plan.details[6].rank;
    CHECK(meso_player_build(&player, &s->arena, &s->mesh, &s->plan, &error) == MESO_ERR_INPUT);
    uint32_t none = 0;
    CHECK(meso_player_build(&player, &s->arena, &s->mesh, &(MesoReplicaPlan){.pair_begin = &none}, &error) == MESO_OK);
    meso_player_play(player, NULL, s->moved, 1);
}

int main(void)
{
    Stage s;
    start(&s);
    test_formula(&s);
    test_reversible(&s);
    test_no_pop(&s);
    test_refused(&s);
    meso_triangulation_release(&s.mesh);
    meso_arena_release(&s.arena);
    return 0;
}
