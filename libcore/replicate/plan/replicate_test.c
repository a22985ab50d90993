/* Plans of clips, and what comes out when they are played. */
#include "libcore/replicate/plan/clip_stage_fixture.h"
#include "libcore/replicate/plan/replicate_work.h"

/* Twice the area, twice the details; twice the size, four times; bent, none. Each is a copy, where it was born. */
static void test_counts(void)
{
    const struct {
        Motion motion;
        double times;
    } cases[] = {{stretch, 2}, {scale, 4}, {bend, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        Stage s;
        start(&s, meso_fixture_sheet(50, 50, 0.02f), 1500, cases[i].motion, 1);
        uint32_t count = run(&s), kinds[3] = {0};
        CHECK(fabs(count - cases[i].times * s.count) <= (i == 2 ? 0 : 0.02 * count));
        const MesoDetail *details = meso_replicate_details(s.replication, &count);
        for (uint32_t k = s.count; k < count; k++) {
            CHECK(details[k].rank == k && details[k].copied < s.count && details[k].born >= 0);
            CHECK(details[k].kind == details[details[k].copied].kind && details[k].radius > 0);
            CHECK(details[k].size == details[details[k].copied].size);
            kinds[details[k].kind]++;
        }
        for (int k = 0; k < 3; k++)
            CHECK(fabs(kinds[k] - (count - s.count) / 3.0) <= 0.06 * count);
        MesoError error;
        CHECK(meso_web_check(meso_replicate_web(s.replication), 1, &error) == MESO_OK);
        end(&s);
    }
}

static MesoVec3 inflate(MesoVec3 p, float time)
{
    return meso_vec3_scale(p, 1 + time * fmaxf(0, p.z));
}

/* Closed surfaces, of which a part grows: details are born there, and the web stays what it is. */
static void test_closed(void)
{
    for (int shape = 0; shape < 2; shape++) {
        Stage s;
        start(&s, shape ? meso_fixture_torus(80, 30, 0.4f) : meso_fixture_ball(24), 2000, inflate, 1);
        double before = meso_surface_area(&s.mesh, s.mesh.positions);
        uint32_t count = run(&s), below = 0;
        double after = meso_surface_area(&s.mesh, s.moved);
        CHECK(fabs(count / (double)s.count - after / before) < 0.02 * after / before);
        const MesoDetail *details = meso_replicate_details(s.replication, &count);
        for (uint32_t k = s.count; k < count; k++)
            below += meso_detail_position(&s.mesh, s.mesh.positions, &details[k].point).z < -0.25f;
        CHECK(below < (count - s.count) / 50);
        MesoError error;
        CHECK(meso_web_check(meso_replicate_web(s.replication), shape ? 0 : 2, &error) == MESO_OK);
        end(&s);
    }
}

static double apart(const float *a, const float *b, uint32_t count)
{
    double most = 0;
    for (uint32_t i = 0; i < count; i++)
        most = fmax(most, fabs((double)a[i] - (double)b[i]));
    return most;
}

/* At rest the originals alone are there, all of them; nothing pops; density is kept all the way, and back. */
static void test_played(void)
{
    Stage s;
    MesoArena arena;
    MesoReplicaPlan plan;
    MesoPlayer *player;
    start_in(&s, MESO_REPLICATE_PLAN, meso_fixture_sheet(50, 50, 0.02f), 1500, stretch);
    meso_arena_init(&arena);
    run(&s);
    CHECK(meso_replicate_plan(&plan, &arena, s.replication, NULL) == MESO_OK);
    CHECK(meso_player_build(&player, &arena, &s.mesh, &plan, NULL) == MESO_OK);
    float *shares[3];
    for (int i = 0; i < 3; i++)
        CHECK(shares[i] = MESO_NEW(&arena, float, plan.detail_count, NULL));
    meso_player_play(player, shares[0], move(&s, 0, NULL), 1);
    for (uint32_t i = 0; i < plan.detail_count; i++)
        CHECK(shares[0][i] == (i < s.count));
    for (uint32_t f = 1; f <= FRAMES; f++) {
        meso_player_play(player, shares[f % 2], move(&s, f, NULL), 1);
        double sum = 0;
        for (uint32_t i = 0; i < plan.detail_count; i++)
            sum += (double)shares[f % 2][i];
        CHECK(fabs(sum / (s.count * (1 + (double)f / FRAMES)) - 1) < 0.1);
    }
    /* quarters of a frame */
    for (int step = 1; step <= 2; step++) {
        double most = 0;
        for (int k = 0; k <= 8; k++) {
            for (uint32_t v = 0; v < s.mesh.vertex_count; v++)
                s.moved[v] = stretch(s.mesh.positions[v], 0.5f + 0.0025f * (float)(k * step));
            meso_player_play(player, shares[k % 2], s.moved, 1);
            most = k ? fmax(most, apart(shares[0], shares[1], plan.detail_count)) : 0;
        }
        CHECK(most > 0 && most < 0.08 * step);
    }
    meso_player_play(player, shares[2], move(&s, 0, NULL), 2);
    for (uint32_t i = 0; i < plan.detail_count; i++)
        CHECK(shares[2][i] == (i < s.count));
    meso_arena_release(&arena);
    end(&s);
}

static MesoVec3 shrink(MesoVec3 p, float time)
{
    return meso_vec3_scale(p, 1 - 0.5f * time);
}

/* Half the size, a quarter of them. */
static void test_shrunk(void)
{
    Stage s;
    MesoArena arena;
    MesoReplicaPlan plan;
    MesoPlayer *player;
    start_in(&s, MESO_REPLICATE_PLAN, meso_fixture_sheet(50, 50, 0.02f), 3000, shrink);
    meso_arena_init(&arena);
    CHECK(run(&s) == s.count);
    CHECK(meso_replicate_plan(&plan, &arena, s.replication, NULL) == MESO_OK);
    CHECK(meso_player_build(&player, &arena, &s.mesh, &plan, NULL) == MESO_OK);
    float *grown = MESO_NEW(&arena, float, s.count, NULL);
    for (uint32_t f = 0; f <= FRAMES; f += 5) {
        double sum = 0, left = 1 - 0.5 * f / FRAMES;
        meso_player_play(player, grown, move(&s, f, NULL), 1);
        for (uint32_t i = 0; i < s.count; i++)
            sum += (double)grown[i];
        CHECK(fabs(sum / s.count - left * left) < 0.06);
    }
    meso_arena_release(&arena);
    end(&s);
}

/* The same bytes for any number of threads, and again. */
static void test_threads(void)
{
    const uint32_t threads[4] = {1, 2, 7, 1};
    Stage s[4];
    for (int i = 0; i < 4; i++) {
        start(&s[i], meso_fixture_torus(80, 30, 0.4f), 3000, scale, threads[i]);
        uint32_t count = run(&s[i]), first;
        const MesoDetail *details = meso_replicate_details(s[0].replication, &first);
        CHECK(count == first);
        CHECK(memcmp(details, meso_replicate_details(s[i].replication, &count), first * sizeof *details) == 0);
    }
    for (int i = 0; i < 4; i++)
        end(&s[i]);
}

/* Cut after every frame, and gone on from what was stored: the same bytes. What is no state is refused. */
static void test_resumed(void)
{
    Stage s, cut;
    MesoError error;
    uint32_t count, again;
    start(&s, meso_fixture_torus(60, 24, 0.4f), 900, scale, 1);
    run(&s);
    start(&cut, meso_fixture_torus(60, 24, 0.4f), 900, scale, 2);
    const MesoReplicateOptions options = cut.options;
    for (uint32_t f = 0; f <= FRAMES; f++) {
        MesoReplication *next;
        CHECK(meso_replicate_step(cut.replication, f, NULL) == MESO_OK);
        CHECK(meso_replicate_begin(&next, &options, NULL) == MESO_OK);
        MesoReplicaState state = meso_replicate_state(cut.replication);
        state.grown = f % 2 ? state.grown : NULL;       /* who does without, need not store them */
        state.fates = f % 2 ? state.fates : NULL;
        CHECK(meso_replicate_resume(next, &state, NULL) == MESO_OK);
        meso_replicate_release(cut.replication);
        cut.replication = next;
    }
    const MesoDetail *details = meso_replicate_details(s.replication, &count);
    const MesoDetail *others = meso_replicate_details(cut.replication, &again);
    CHECK(count == again && count > 3 * s.count && memcmp(details, others, count * sizeof *details) == 0);

    MesoReplicaState state = meso_replicate_state(s.replication);
    uint32_t *twins = malloc(3 * sizeof *twins * state.triangle_count);
    CHECK(twins);
    for (int lie = 0; lie < 4; lie++) {
        MesoReplication *next;
        MesoReplicaState other = state;
        memcpy(twins, state.twins, 3 * sizeof *twins * state.triangle_count);
        twins[7] = lie == 0 ? 3 * state.triangle_count : lie == 1 ? 5 : twins[7];
        other.twins = twins;
        other.detail_count -= lie == 2;
        other.power = lie == 3 ? NAN : other.power;
        CHECK(meso_replicate_begin(&next, &options, NULL) == MESO_OK);
        CHECK(meso_replicate_resume(next, &other, &error) == MESO_ERR_INPUT);
        meso_replicate_release(next);
    }
    free(twins);
    end(&s);
    end(&cut);
}

/* The paper's rule bears fewer than are due, inside what has grown beyond the largest triangle; and is for 500. */
static void test_paper(void)
{
    Stage s;
    MesoError error;
    MesoReplication *r, *none;
    uint32_t count;
    start(&s, meso_fixture_sheet(20, 20, 0.05f), 200, stretch, 1);
    MesoReplicateOptions options = {.clip = &s.clip, .originals = s.originals, .original_count = s.count,
                                    .mode = MESO_REPLICATE_PAPER};
    CHECK(meso_replicate_begin(&r, &options, &error) == MESO_OK);
    CHECK(meso_replicate_step(r, 0, &error) == MESO_OK);
    meso_replicate_details(r, &count);
    CHECK(count == s.count);
    for (uint32_t f = 1; f <= FRAMES; f++)
        CHECK(meso_replicate_step(r, f, &error) == MESO_OK);
    meso_replicate_details(r, &count);
    CHECK(count > s.count + 10 && count < 2 * s.count - 40);
    CHECK(meso_web_check(meso_replicate_web(r), 1, &error) == MESO_OK);
    meso_replicate_release(r);
    MesoDetail many[501];
    for (uint32_t i = 0; i < 501; i++)
        many[i] = s.originals[i % s.count];
    options.originals = many;
    options.original_count = 501;
    CHECK(meso_replicate_begin(&none, &options, &error) == MESO_ERR_LIMIT);
    end(&s);
}

static MesoVec3 torn(MesoVec3 p, float time)
{
    return time > 0.3f && p.x > 0.5f ? (MesoVec3){NAN, p.y, p.z} : p;
}

static MesoVec3 folded(MesoVec3 p, float time)
{
    return time > 0.5f ? (MesoVec3){0, 0, 0} : (MesoVec3){fabsf(p.x - time) * 3, p.y, 0};
}

static MesoVec3 explode(MesoVec3 p, float time)
{
    return meso_vec3_scale(p, time < 0.5f ? 1 : time < 0.75f ? 1e4f : 1e30f);
}

/* Frames that are none are refused by name; folds and what collapses are gone through. */
static void test_odd(void)
{
    Stage s;
    MesoError error;
    start(&s, meso_fixture_sheet(10, 10, 0.1f), 200, torn, 1);
    CHECK(meso_replicate_step(s.replication, 0, &error) == MESO_OK);
    CHECK(meso_replicate_step(s.replication, 12, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "frame 12: vertex 6"));
    s.originals[7].point.weight[0] = -1;
    MesoReplicateOptions options = {.clip = &s.clip, .originals = s.originals, .original_count = s.count};
    MesoReplication *none;
    CHECK(meso_replicate_begin(&none, &options, &error) == MESO_ERR_INPUT && strstr(error.message, "detail 7"));
    end(&s);
    start(&s, meso_fixture_sheet(10, 10, 0.1f), 200, folded, 1);
    run(&s);
    CHECK(meso_web_check(meso_replicate_web(s.replication), 1, &error) == MESO_OK);
    end(&s);
    start(&s, meso_fixture_sheet(10, 10, 0.1f), 200, explode, 1);
    CHECK(meso_replicate_step(s.replication, 12, &error) == MESO_ERR_LIMIT && strstr(error.message, "frame 12"));
    CHECK(meso_replicate_step(s.replication, FRAMES, &error) == MESO_ERR_LIMIT);
    end(&s);
    start(&s, meso_fixture_ball(6), 3, scale, 1);
    run(&s);
    end(&s);
}

/* ---- exemplars ---- */

typedef struct Shape {
    double area, angle;
} Shape;

static double twice_area(const MesoVec3 *a, const MesoVec3 *b, const MesoVec3 *c)
{
    return (double)meso_vec3_cross(meso_vec3_sub(*b, *a), meso_vec3_sub(*c, *a)).z;
}

static double length2(const MesoVec3 *a, const MesoVec3 *b)
{
    MesoVec3 d = meso_vec3_sub(*b, *a);
    return (double)meso_vec3_dot(d, d);
}

static Shape shape_of(const MesoVec3 *a, const MesoVec3 *b, const MesoVec3 *c)
{
    return (Shape){fabs(twice_area(a, b, c)) / 2, meso_smallest_angle(length2(a, b), length2(b, c), length2(c, a))};
}

static uint32_t count_inside(const MesoVec3 *p, uint32_t count, const MesoVec3 *a, const MesoVec3 *b, const MesoVec3 *c)
{
    double turn = twice_area(a, b, c) < 0 ? -1 : 1;
    uint32_t inside = 0;
    for (uint32_t i = 0; i < count; i++)
        inside += turn * twice_area(a, b, &p[i]) > 0 && turn * twice_area(b, c, &p[i]) > 0
                  && turn * twice_area(c, a, &p[i]) > 0;
    return inside;
}

/* Equation 3. */
static double unlike(const MesoExemplars *e, Shape a, Shape b)
{
    return fmax(fabs(a.area - b.area) / e->area, fabs(a.angle - b.angle) / e->angle);
}

/* Of all triangles of details with others inside, the most similar. */
static double search_all(const MesoExemplars *e, const MesoVec3 *p, uint32_t n, Shape wanted)
{
    double least = INFINITY;
    for (uint32_t i = 0; i < n; i++)
        for (uint32_t j = i + 1; j < n; j++)
            for (uint32_t k = j + 1; k < n; k++) {
                double error = unlike(e, shape_of(&p[i], &p[j], &p[k]), wanted);
                uint32_t inside = error < least ? count_inside(p, n, &p[i], &p[j], &p[k]) : 0;
                if (inside > 0 && inside <= MESO_EXEMPLAR_INSIDE)
                    least = error;
            }
    return least;
}

/* Those near each other, in bins of limited size, are as similar as the best of all that there are. */
static void test_exemplars(void)
{
    Stage s;
    double all = 0, ours = 0;
    start(&s, meso_fixture_sheet(20, 20, 0.05f), 40, stretch, 1);
    const MesoWeb *web = meso_replicate_web(s.replication);
    const MesoExemplars *e = &s.replication->exemplars;
    for (uint32_t t = 0; t < web->triangle_count; t++) {
        MesoVec3 corners[3];
        const MesoExemplar *found[8];
        bool inner = true;
        for (uint32_t k = 0; k < 3; k++) {
            inner = inner && web->corners[3 * t + k] >= web->fixed_count;
            corners[k] = stretch(web->positions[web->corners[3 * t + k]], 0.6f);
        }
        Shape wanted = shape_of(&corners[0], &corners[1], &corners[2]);
        if (!inner)
            continue;
        CHECK(meso_exemplars_near(e, wanted.area, wanted.angle, MESO_EXEMPLAR_INSIDE, found, 8) == 8);
        ours += unlike(e, (Shape){(double)found[0]->area, (double)found[0]->angle}, wanted);
        all += search_all(e, web->positions + web->fixed_count, s.count, wanted);
    }
    CHECK(ours > 0 && ours < 1.01 * all);
    end(&s);
}

int main(void)
{
    test_exemplars();
    test_counts();
    test_closed();
    test_played();
    test_shrunk();
    test_threads();
    test_resumed();
    test_paper();
    test_odd();
    return 0;
}
