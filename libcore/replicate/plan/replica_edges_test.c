/* Details that are round, in groups and evenly: edges of their web, and how near they are, keep on a way that is long. */
#include "libcore/replicate/plan/clip_stage_fixture.h"

enum { SIDE = 20 };

static MesoVec3 halve(MesoVec3 p, float time)
{
    return meso_vec3_scale(p, 1 - 0.5f * time);
}

static MesoVec3 stretch_up(MesoVec3 p, float time)
{
    return (MesoVec3){p.x, p.y, p.z * (1 + time)};
}

/* All alike, of those that are strewn. */
static void set_round(Stage *s, MesoTriangulation mesh, MesoMeshPoint *points, uint32_t count, Motion motion)
{
    set_stage(s, mesh, count, motion);
    free(s->points);
    free(s->originals);
    s->points = points;
    s->originals = calloc(count, sizeof *s->originals);
    CHECK(s->originals);
    for (uint32_t i = 0; i < count; i++)
        s->originals[i] = (MesoDetail){.point = points[i], .size = 1, .width = 1};
    s->count = s->options.original_count = count;
    s->options.originals = s->originals;
    s->options.births = MESO_BIRTHS_STATISTICS;
    CHECK(meso_replicate_begin(&s->replication, &s->options, NULL) == MESO_OK);
}

/* Steps through all, and checks edges after each of them, in shares of what they are at rest. */
static void keep_edges(Stage *s, double mean, double deviation)
{
    MesoWebEdges rest = meso_web_edges(meso_replicate_web(s->replication));
    for (uint32_t f = 0; f <= s->frames; f++) {
        CHECK(meso_replicate_step(s->replication, f, NULL) == MESO_OK);
        MesoWebEdges now = meso_web_edges(meso_replicate_web(s->replication));
        CHECK(fabs(now.mean / rest.mean - 1) < mean);
        CHECK(fabs(now.deviation / rest.deviation - 1) < deviation);
    }
}

/* Of any seed, though there are few: none of what chance makes adds up. */
static void test_groups(void)
{
    for (uint64_t seed = 40; seed < 48; seed++) {
        Stage s;
        MesoTriangulation mesh = meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE);
        set_round(&s, mesh, meso_strew_groups(SIDE, 200, 6, 0.4 / sqrt(200), seed), 200, stretch);
        s.frames = 40;
        keep_edges(&s, 0.025, 0.1);
        end(&s);
    }
}

/* The distance of the two that are nearest to each other, of those that live. */
static double nearest_two(const Stage *s)
{
    uint32_t count;
    double least = INFINITY;
    const MesoDetail *details = meso_replicate_details(s->replication, &count);
    const MesoDetailFate *fates = meso_replicate_fates(s->replication);
    MesoVec3 *places = malloc(count * sizeof *places);
    CHECK(places);
    for (uint32_t i = 0; i < count; i++)
        places[i] = meso_detail_position(&s->mesh, s->moved, &details[i].point);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < i; k++)
            if (fates[i].died == MESO_DETAIL_LIVES && fates[k].died == MESO_DETAIL_LIVES)
                least = fmin(least, (double)meso_vec3_length(meso_vec3_sub(places[i], places[k])));
    free(places);
    return least;
}

/* None is born on another, or nearer than they are at rest: not at a border, and not on what is round. */
static void test_apart(void)
{
    for (int round = 0; round < 2; round++) {
        Stage s;
        uint32_t count = 300;
        MesoTriangulation mesh = round ? meso_fixture_tube(40, 20, 3) : meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE);
        double each = sqrt(meso_surface_area(&mesh, mesh.positions) / count);
        MesoMeshPoint *points = meso_strew_discs(&mesh, &count, 0.7, 4);
        set_round(&s, mesh, points, count, round ? stretch_up : stretch);
        keep_edges(&s, 0.025, 0.1);
        CHECK(living(&s) > 1.9 * count && nearest_two(&s) > 0.8 * 0.7 * each);
        end(&s);
    }
}

/* Three of four die, and the others lie as evenly. */
static void test_shrunk(void)
{
    Stage s;
    uint32_t count = 900;
    MesoTriangulation mesh = meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE);
    MesoMeshPoint *points = meso_strew_discs(&mesh, &count, 0.75, 4);
    set_round(&s, mesh, points, count, halve);
    keep_edges(&s, 0.03, 0.1);
    CHECK(fabs(living(&s) - 0.25 * count) < 0.01 * count);
    end(&s);
}

/*
 * Where a part has shrunk and none dies, for it is to be played, the other parts are as if it had not: what is too
 * crowded there is not made up for by what is born elsewhere.
 */
static MesoVec3 shift(MesoVec3 p, float time)
{
    float x = p.x < 0.5f ? p.x * (1 - 0.8f * time) : 0.5f * (1 - 0.8f * time) + (p.x - 0.5f) * (1 + 2 * time);
    return (MesoVec3){x, p.y, p.z};
}

static void test_crowded_beside(void)
{
    Stage s;
    uint32_t count = 600, all, near = 0, born = 0;
    MesoTriangulation mesh = meso_fixture_sheet(SIDE, SIDE, 1.0f / SIDE);
    MesoMeshPoint *points = meso_strew_discs(&mesh, &count, 0.7, 4);
    set_round(&s, mesh, points, count, shift);
    meso_replicate_release(s.replication);
    s.options.mode = MESO_REPLICATE_PLAN;
    CHECK(meso_replicate_begin(&s.replication, &s.options, NULL) == MESO_OK);
    all = run(&s);
    const MesoDetail *details = meso_replicate_details(s.replication, &all);
    double least = 0.7 / sqrt(count);
    for (uint32_t i = count; i < all; i++) {
        MesoVec3 p = meso_detail_position(&s.mesh, s.moved, &details[i].point);
        born += p.x > 0.2f;
        for (uint32_t k = 0; k < i && p.x > 0.2f; k++) {
            MesoVec3 q = meso_detail_position(&s.mesh, s.moved, &details[k].point);
            if ((double)meso_vec3_length(meso_vec3_sub(q, p)) < 0.8 * least) {
                near++;
                break;
            }
        }
    }
    CHECK(born > 0.7 * count && near < 0.03 * born);
    end(&s);
}

int main(void)
{
    test_groups();
    test_apart();
    test_shrunk();
    test_crowded_beside();
    return 0;
}
