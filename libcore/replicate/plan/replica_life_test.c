/* Details that grow, shrink and merge: none pops, and density keeps, also where a surface shrinks. */
#include "libcore/replicate/plan/clip_stage_fixture.h"

/* ---- motions ---- */

static MesoVec3 halve(MesoVec3 p, float time)
{
    return meso_vec3_scale(p, 1 - 0.5f * time);
}

/* Twice as long, and back. */
static MesoVec3 breathe(MesoVec3 p, float time)
{
    return (MesoVec3){p.x * (1 + 4 * time * (1 - time)), p.y, p.z};
}

/* The left half becomes as much shorter as the right one longer. */
static MesoVec3 shift(MesoVec3 p, float time)
{
    float x = p.x < 0.5f ? p.x * (1 - 0.6f * time) : 0.5f * (1 - 0.6f * time) + (p.x - 0.5f) * (1 + 0.6f * time);
    return (MesoVec3){x, p.y, p.z};
}

/* A part in the middle is pressed together. */
static MesoVec3 press(MesoVec3 p, float time)
{
    float x = p.x < 0.4f ? p.x : p.x < 0.6f ? 0.4f + (p.x - 0.4f) * (1 - 0.7f * time) : p.x - 0.2f * 0.7f * time;
    return (MesoVec3){x, p.y, p.z};
}

/* ---- what a frame changes ---- */

typedef struct Seen {
    uint32_t count;
    float *grown;
    MesoVec3 *places;       /* at rest: where a detail is on the surface, whatever that does */
} Seen;

static void see(Seen *seen, const Stage *s)
{
    const MesoDetail *details = meso_replicate_details(s->replication, &seen->count);
    seen->grown = realloc(seen->grown, seen->count * sizeof *seen->grown);
    seen->places = realloc(seen->places, seen->count * sizeof *seen->places);
    CHECK(seen->grown && seen->places);
    memcpy(seen->grown, meso_replicate_grown(s->replication), seen->count * sizeof *seen->grown);
    for (uint32_t i = 0; i < seen->count; i++)
        seen->places[i] = meso_detail_position(&s->mesh, s->mesh.positions, &details[i].point);
}

typedef struct Change {
    double size, place;
} Change;

/* Those that were not there before come from nothing. */
static Change change_of(const Seen *before, const Seen *now)
{
    Change change = {0, 0};
    for (uint32_t i = 0; i < now->count; i++) {
        double was = i < before->count ? (double)before->grown[i] : 0;
        change.size = fmax(change.size, fabs((double)now->grown[i] - was));
        if (i < before->count)
            change.place = fmax(change.place, (double)meso_vec3_length(meso_vec3_sub(now->places[i],
                                                                                     before->places[i])));
    }
    return change;
}

/* The largest of a run. */
static Change largest_change(Stage *s)
{
    Seen seen[2] = {{0}, {0}};
    Change largest = {0, 0};
    for (uint32_t f = 0; f <= s->frames; f++) {
        CHECK(meso_replicate_step(s->replication, f, NULL) == MESO_OK);
        see(&seen[f % 2], s);
        Change change = f ? change_of(&seen[(f + 1) % 2], &seen[f % 2]) : largest;
        largest = (Change){fmax(largest.size, change.size), fmax(largest.place, change.place)};
    }
    for (int i = 0; i < 2; i++) {
        free(seen[i].grown);
        free(seen[i].places);
    }
    return largest;
}

static const double RATE = 0.15, ATTRACTION = 0.1;

enum { FEW = 120 };

static Change change_at(MesoReplicateMode mode, Motion motion, uint32_t frames)
{
    Stage s;
    set_stage(&s, meso_fixture_sheet(20, 20, 0.05f), FEW, motion);
    s.frames = frames;
    s.options.mode = mode;
    s.options.mu = RATE * FRAMES / frames;
    s.options.gamma = ATTRACTION * FRAMES / frames;
    CHECK(meso_replicate_begin(&s.replication, &s.options, NULL) == MESO_OK);
    Change change = largest_change(&s);
    end(&s);
    return change;
}

/* No size changes faster than its rate, and none moves over the surface that does not merge; half of it in half the
   time. */
static void test_no_pop(void)
{
    for (uint32_t times = 1; times <= 4; times *= 2) {
        Change plan = change_at(MESO_REPLICATE_LIVE, breathe, FRAMES * times);
        Change paper = change_at(MESO_REPLICATE_PAPER, press, FRAMES * times);
        CHECK(plan.size > 0 && plan.size <= RATE / times + 1e-6 && plan.place == 0);
        CHECK(paper.size > 0 && paper.size <= RATE / times + 1e-6);
        /* edges that merge are no longer than two of the mean spacing */
        CHECK(paper.place > 0 && paper.place <= ATTRACTION / times * 2 / sqrt(FEW));
    }
}

/* One that is there at once, and one that jumps, are seen. */
static void test_planted_pop(void)
{
    Stage s;
    Seen before = {0}, now = {0};
    start(&s, meso_fixture_sheet(20, 20, 0.05f), 300, breathe, 1);
    for (uint32_t f = 0; f <= 8; f++) {
        CHECK(meso_replicate_step(s.replication, f, NULL) == MESO_OK);
        see(f == 7 ? &before : &now, &s);
    }
    CHECK(change_of(&before, &now).size <= 0.1 + 1e-6);
    now.grown[now.count - 1] = 1;
    CHECK(change_of(&before, &now).size > 0.5);
    now.places[3].x += 0.01f;
    CHECK(change_of(&before, &now).place > 0.009);
    free(before.grown);
    free(before.places);
    free(now.grown);
    free(now.places);
    end(&s);
}

/* ---- density ---- */

static double spacing_of(const Stage *s)
{
    return meso_web_edges(meso_replicate_web(s->replication)).deviation
           / meso_web_edges(meso_replicate_web(s->replication)).mean;
}

/* As many for the area as at rest, at all times; there and back. The web stays one. */
static void test_density(void)
{
    const Motion motions[3] = {halve, breathe, shift};
    for (int m = 0; m < 3; m++) {
        Stage s;
        MesoError error;
        start(&s, meso_fixture_sheet(50, 50, 0.02f), 2000, motions[m], 1);
        double spread = spacing_of(&s);
        for (uint32_t f = 0; f <= FRAMES; f++) {
            CHECK(meso_replicate_step(s.replication, f, NULL) == MESO_OK);
            double area = meso_surface_area(&s.mesh, s.moved);
            CHECK(fabs(living(&s) / (area * s.count) - 1) < 0.02);
            CHECK(meso_web_check(meso_replicate_web(s.replication), 1, &error) == MESO_OK);
        }
        CHECK(spacing_of(&s) < 1.5 * spread);
        uint32_t count, gone = 0;
        meso_replicate_details(s.replication, &count);
        const MesoDetailFate *fates = meso_replicate_fates(s.replication);
        for (uint32_t i = 0; i < count; i++) {
            gone += fates[i].died != MESO_DETAIL_LIVES;
            CHECK(fates[i].into == MESO_NO_INDEX || (fates[i].into < count && fates[i].into != i));
        }
        CHECK(gone > s.count / 5);
        end(&s);
    }
}

/* The paper's own: what is pressed together merges there, and nowhere else. */
static void test_paper_merges(void)
{
    Stage s;
    MesoError error;
    start_in(&s, MESO_REPLICATE_PAPER, meso_fixture_sheet(20, 20, 0.05f), 200, press);
    uint32_t count = run(&s), gone = 0;
    const MesoDetail *details = meso_replicate_details(s.replication, &count);
    const MesoDetailFate *fates = meso_replicate_fates(s.replication);
    for (uint32_t i = 0; i < count; i++) {
        if (fates[i].died == MESO_DETAIL_LIVES)
            continue;
        MesoVec3 p = meso_detail_position(&s.mesh, s.mesh.positions, &details[i].point);
        CHECK(p.x > 0.3f && p.x < 0.7f && details[fates[i].into].rank < details[i].rank);
        gone++;
    }
    CHECK(gone > 2 && gone < 50);
    CHECK(meso_web_check(meso_replicate_web(s.replication), 1, &error) == MESO_OK);
    end(&s);
}

/* Substeps go the same way as frames between would: as many, at the same places where the way is straight. */
static void test_substeps(void)
{
    Stage s[2];
    uint32_t count[2];
    for (int i = 0; i < 2; i++) {
        set_stage(&s[i], meso_fixture_sheet(20, 20, 0.05f), 300, stretch);
        s[i].frames = i ? FRAMES : 4 * FRAMES;
        s[i].options.substeps = i ? 4 : 1;
        s[i].options.mu = i ? 0.2 : 0.05;
        CHECK(meso_replicate_begin(&s[i].replication, &s[i].options, NULL) == MESO_OK);
        run(&s[i]);
        meso_replicate_details(s[i].replication, &count[i]);
    }
    CHECK(count[0] == count[1]);
    end(&s[0]);
    end(&s[1]);
}

/* Cut at every frame, while some die and merge, and gone on from what was stored. */
static void resume_everywhere(MesoReplicateMode mode, Motion motion, uint32_t substeps)
{
    Stage s, cut;
    uint32_t count, again;
    Stage *both[2] = {&s, &cut};
    for (int i = 0; i < 2; i++) {
        set_stage(both[i], meso_fixture_sheet(20, 20, 0.05f), FEW, motion);
        both[i]->options.mode = mode;
        both[i]->options.substeps = substeps;
        CHECK(meso_replicate_begin(&both[i]->replication, &both[i]->options, NULL) == MESO_OK);
    }
    run(&s);
    for (uint32_t f = 0; f <= FRAMES; f++) {
        MesoReplication *next;
        CHECK(meso_replicate_step(cut.replication, f, NULL) == MESO_OK);
        CHECK(meso_replicate_begin(&next, &cut.options, NULL) == MESO_OK);
        MesoReplicaState state = meso_replicate_state(cut.replication);
        CHECK(meso_replicate_resume(next, &state, NULL) == MESO_OK);
        meso_replicate_release(cut.replication);
        cut.replication = next;
    }
    const MesoDetail *details = meso_replicate_details(s.replication, &count);
    CHECK(memcmp(details, meso_replicate_details(cut.replication, &again), count * sizeof *details) == 0);
    CHECK(count == again);
    CHECK(memcmp(meso_replicate_grown(s.replication), meso_replicate_grown(cut.replication), count * sizeof(float))
          == 0);
    CHECK(memcmp(meso_replicate_fates(s.replication), meso_replicate_fates(cut.replication),
                 count * sizeof(MesoDetailFate)) == 0);
    end(&s);
    end(&cut);
}

int main(void)
{
    test_no_pop();
    test_planted_pop();
    test_density();
    test_paper_merges();
    test_substeps();
    resume_everywhere(MESO_REPLICATE_LIVE, breathe, 1);
    resume_everywhere(MESO_REPLICATE_LIVE, breathe, 3);
    resume_everywhere(MESO_REPLICATE_PAPER, press, 1);
    return 0;
}
