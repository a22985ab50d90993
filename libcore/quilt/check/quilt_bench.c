/*
 * Table 1 of "Mesh Quilting for Geometric Texture Synthesis" (Zhou et al. 2006) again, with swatches of ours and
 * surfaces that have the shapes and the numbers of triangles of the paper's: the swatch is as large as gives about as
 * many triangles. Each row by a process of its own, on all cores; of each, in a line, what came out beside what the
 * paper has, times, stages, memory; then the total.
 *
 *   quilt_bench [--check] [ROW...]
 *
 * --check adds a line for each row: how good it is. Rows are named by how they begin: "plane", "plane + wire".
 */
#include <stdio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "libcore/base/clock.h"
#include "libcore/base/lean_memory.h"
#include "libcore/field/direction_field.h"
#include "libcore/quilt/base/quilt_base.h"
#include "libcore/quilt/check/bench_surfaces_fixture.h"
#include "libcore/quilt/check/quilt_check.h"
#include "libcore/quilt/embed/quilt_embed.h"
#include "libcore/quilt/finish/quilt_finish.h"
#include "libcore/quilt/settle/quilt_settle.h"
#include "libcore/quilt/swatch/swatch_make.h"
#include "libcore/shell/prisms.h"

/* What the paper says. */
typedef struct Published {
    uint32_t triangles, vertices, elements;
    double minutes;
} Published;

typedef struct Row {
    const char *name;
    void (*surface)(BenchShape *shape);
    MesoSwatchRecipe recipe;
    uint32_t turns;             /* that a field leaves the swatch; 0: its x axis is everywhere that of space */
    Published published;
} Row;

/*
 * The paper's ivy has 700 triangles, which are two stems of ours with four leaves each: patches of so little are
 * hardly more than seams. Ours is four times that. Its chair has two swatches: two rows of ours, whose figures are
 * shared out by their triangles.
 */
static const Row ROWS[] = {
    {"plane", bench_plane, {.name = "wire", .jitter = 0.05f}, 0, {74792, 37839, 27, 3}},
    {"plane", bench_plane, {.name = "apples", .jitter = 0.05f}, 0, {321046, 160736, 86, 3}},
    {"bunny", bench_bunny, {.name = "weave", .jitter = 0.05f}, 4, {700815, 353123, 117, 86}},
    {"bunny", bench_bunny, {.name = "mail", .jitter = 0.05f}, 2, {940622, 471263, 1676, 80}},
    {"cup", bench_cup, {.name = "weave", .jitter = 0.05f, .columns = 5, .rows = 4}, 4, {371011, 186866, 150, 45}},
    {"venus", bench_venus, {.name = "nuts", .jitter = 0.05f}, 6, {553158, 277375, 446, 59}},
    {"armour", bench_armour, {.name = "armour", .jitter = 0.05f}, 4, {1361726, 701833, 1965, 75}},
    {"chair seat", bench_chair_seat, {.name = "weave", .jitter = 0.05f, .columns = 5, .rows = 4}, 4,
     {240394, 123230, 241, 40.5}},
    {"chair frame", bench_chair_frame, {.name = "wire", .jitter = 0.05f, .columns = 3, .rows = 3}, 4,
     {80131, 41077, 80, 13.5}},
    {"david", bench_david, {.name = "ivy", .jitter = 0.05f, .columns = 4, .rows = 4}, 4, {74780, 44591, 81, 16}},
    {"wall", bench_wall, {.name = "ivy", .jitter = 0.05f, .columns = 4, .rows = 4}, 0, {916620, 542520, 962, 45}},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

/* Windows that likeness is measured by: so many that its error is a twentieth or so. */
enum { WINDOWS = 256 };

/* What a process tells of its row. */
typedef struct Outcome {
    bool done;
    char failure[sizeof ((MesoError *)0)->message];
    uint32_t base_triangles, base_vertices, swatch_triangles, swatch_vertices, triangles, vertices, elements;
    double preparation, base, field, growth, finish, settling, prisms, embedding;   /* seconds */
    double cores;               /* seconds of all cores, before the check */
    MesoPrismReport layer;
    double bytes;               /* of the process at its largest, before the check */
    MesoQuiltReport report;
    MesoQuiltCheck check;
} Outcome;

static double seconds_of(const Outcome *o)
{
    return o->base + o->field + o->growth + o->finish + o->settling + o->prisms + o->embedding;
}

typedef struct Run {
    const Row *row;
    Outcome *outcome;
    MesoArena arena;
    MesoSwatch swatch;
    MesoTriangulation surface;
    MesoQuiltBase base;
    MesoQuilt quilt;
    MesoQuiltRoom room;
    MesoVec3 *guide, *positions;
    float scale;
    double since;
    MesoError error;
} Run;

/* Seconds since the last call. */
static double lap(Run *run)
{
    double now = meso_seconds(), seconds = now - run->since;
    run->since = now;
    return seconds;
}

static MesoStatus make_swatch(Run *run)
{
    MesoPolygonMesh mesh;
    MesoStatus status = meso_swatch_make(&mesh, &run->arena, &run->row->recipe, &run->error);
    if (!status)
        status = meso_swatch_build(&run->swatch, &run->arena, &mesh, &(MesoSwatchOptions){.up = 2, .periodic = -1},
                                   &run->error);
    run->outcome->preparation = lap(run);
    return status;
}

static double area_of(const MesoTriangulation *mesh)
{
    double area = 0;
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *v = &mesh->corners[3 * (size_t)t];
        MesoVec3 a = mesh->positions[v[0]];
        area += 0.5 * (double)meso_vec3_length(meso_vec3_cross(meso_vec3_sub(mesh->positions[v[1]], a),
                                                               meso_vec3_sub(mesh->positions[v[2]], a)));
    }
    return area;
}

static MesoStatus make_surface(Run *run)
{
    static BenchShape shape;
    run->row->surface(&shape);
    run->surface = bench_finish(&shape);
    double tiles = (double)run->row->published.triangles / run->swatch.triangle_count;
    const MesoVec3 size = run->swatch.size;
    run->scale = (float)sqrt(area_of(&run->surface) / (tiles * (double)size.x * (double)size.y));
    lap(run);
    return MESO_OK;
}

static MesoStatus make_guide(Run *run)
{
    MesoStatus status = MESO_OK;
    if (run->row->turns) {
        MesoDirectionField field;
        status = meso_direction_field_smooth(&field, &run->arena, &run->surface, run->row->turns, NULL, NULL,
                                             &run->error);
        run->guide = field.directions;
    } else {
        run->guide = MESO_NEW(&run->arena, MesoVec3, run->surface.triangle_count, &run->error);
        if (!run->guide)
            return MESO_ERR_MEMORY;
        for (uint32_t t = 0; t < run->surface.triangle_count; t++)
            run->guide[t] = (MesoVec3){1, 0, 0};
    }
    run->outcome->field = lap(run);
    return status;
}

static MesoStatus make_base(Run *run)
{
    const MesoVec3 size = run->swatch.size;
    MesoStatus status = meso_quilt_base_build(&run->base, &run->arena, &run->surface, run->guide,
                                              0.1f * run->scale * fminf(size.x, size.y),
                                              0.5f * run->scale * hypotf(size.x, size.y), &run->error);
    run->outcome->base = lap(run);
    return status;
}

static MesoStatus grow(Run *run)
{
    uint32_t turns = run->row->turns ? run->row->turns : 1;
    MesoStatus status = meso_quilt_grow(&run->quilt, &run->room.arenas[0], &run->base.mesh, &run->swatch,
                                        &(MesoQuiltOptions){.scale = run->scale, .turn_count = turns,
                                                            .guide = run->base.guide, .guide_turn = 0.3f}, &run->error);
    run->outcome->growth = lap(run);
    return status;
}

static MesoStatus finish(Run *run)
{
    const MesoQuiltVertex *before = run->quilt.vertices;
    MesoStatus status = meso_quilt_finish(&run->quilt, meso_quilt_room_free(&run->room), &run->base, &run->swatch,
                                          &(MesoFinishOptions){.scale = run->scale,
                                                               .spent = meso_quilt_room_used(&run->room),
                                                               .overhang = 0.5f * run->scale * run->swatch.mean_edge},
                                          &run->error);
    if (!status)
        meso_quilt_room_turn(&run->room, &run->quilt, before);
    run->outcome->finish = lap(run);
    return status;
}

static MesoStatus settle(Run *run)
{
    const MesoQuiltVertex *before = run->quilt.vertices;
    MesoStatus status = meso_quilt_settle(&run->quilt, meso_quilt_room_free(&run->room), &run->surface, &run->swatch,
                                          &(MesoSettleOptions){.scale = run->scale,
                                                               .overhang = 0.5f * run->scale * run->swatch.mean_edge},
                                          &run->error);
    if (!status)
        meso_quilt_room_turn(&run->room, &run->quilt, before);
    run->outcome->settling = lap(run);
    return status;
}

static MesoStatus embed(Run *run)
{
    MesoVec3 *directions = MESO_NEW(&run->arena, MesoVec3, run->surface.vertex_count, &run->error);
    run->positions = MESO_NEW(&run->arena, MesoVec3, run->quilt.vertex_count, &run->error);
    if (!directions || !run->positions)
        return MESO_ERR_MEMORY;
    MesoQuiltHeights heights = meso_quilt_heights(&run->quilt);
    MesoStatus status = meso_prisms_build(directions, &run->outcome->layer, &run->arena, &run->surface,
                                          &(MesoPrismOptions){heights.low, heights.high, true, 0}, &run->error);
    run->outcome->prisms = lap(run);
    meso_quilt_embed(run->positions, &run->quilt, &run->surface, directions, 0);
    run->outcome->embedding = lap(run);
    return status;
}

static void fill_outcome(Run *run)
{
    struct rusage usage;
    CHECK(getrusage(RUSAGE_SELF, &usage) == 0);
    Outcome *o = run->outcome;
    o->done = true;
    o->base_triangles = run->surface.triangle_count;
    o->base_vertices = run->surface.vertex_count;
    o->swatch_triangles = run->swatch.triangle_count;
    o->swatch_vertices = run->swatch.vertex_count;
    o->triangles = run->quilt.triangle_count;
    o->vertices = run->quilt.vertex_count;
    o->elements = run->quilt.element_count;
    o->report = run->quilt.report;
    o->cores = (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec;
    o->bytes = 1024 * (double)usage.ru_maxrss;
}

static void run_row(const Row *row, Outcome *outcome, bool check)
{
    MesoStatus (*const steps[])(Run *) = {make_swatch, make_surface, make_guide, make_base, grow, finish, settle, embed};
    Run run = {.row = row, .outcome = outcome, .since = meso_seconds()};
    meso_arena_init(&run.arena);
    MesoStatus status = MESO_OK;
    for (size_t i = 0; i < sizeof steps / sizeof *steps && !status; i++)
        status = steps[i](&run);
    if (!status)
        fill_outcome(&run);
    if (!status && check)
        status = meso_quilt_check(&outcome->check, &run.arena, &run.quilt, &run.swatch, run.positions, &run.surface,
                                  &(MesoQuiltCheckOptions){.scale = run.scale, .window_count = WINDOWS}, &run.error);
    if (status) {
        outcome->done = false;
        snprintf(outcome->failure, sizeof outcome->failure, "%s", run.error.message);
    }
}

/* By a process of its own, so that memory is that of the row, and one row's end is not that of the others. */
static void run_apart(const Row *row, Outcome *outcome, bool check)
{
    int ends[2];
    fflush(stdout);
    CHECK(pipe(ends) == 0);
    pid_t child = fork();
    CHECK(child >= 0);
    if (child == 0) {
        close(ends[0]);
        run_row(row, outcome, check);
        _exit(write(ends[1], outcome, sizeof *outcome) == (ssize_t)sizeof *outcome ? 0 : 1);
    }
    close(ends[1]);
    *outcome = (Outcome){.failure = "it did not come to its end"};
    for (size_t got = 0; got < sizeof *outcome;) {
        ssize_t part = read(ends[0], (char *)outcome + got, sizeof *outcome - got);
        if (part <= 0)
            break;
        got += (size_t)part;
    }
    close(ends[0]);
    waitpid(child, NULL, 0);
}

/* ---- what is said of it ---- */

/* Laid over its surface anew, as where that was edited, against all that it takes to grow. */
static double embedding_share(const Outcome *o)
{
    return (o->prisms + o->embedding) / (seconds_of(o) + o->preparation);
}

enum { NAME_SIZE = 32 };

static void name_row(char name[NAME_SIZE], const Row *row)
{
    snprintf(name, NAME_SIZE, "%s + %s", row->name, row->recipe.name);
}

static void print_row(const Row *row, const Outcome *o)
{
    char name[NAME_SIZE];
    name_row(name, row);
    const Published *p = &row->published;
    if (!o->done) {
        printf("%-20s failed: %s\n", name, o->failure);
        return;
    }
    printf("%-20s %6u %6u | %6u %6u | %8u (%8u) %7u (%7u) %5u (%5u) | %7.3f s (%5.1f min) %6.0fx | %5.3f + %5.3f %5.3f "
           "%6.3f %5.3f %6.3f %5.3f %5.3f %4.1f%% | %5.3f -> %5.3f | %5.1f\n", name, o->base_triangles,
           o->base_vertices, o->swatch_triangles, o->swatch_vertices, o->triangles, p->triangles, o->vertices,
           p->vertices, o->elements, p->elements, seconds_of(o), p->minutes, 60 * p->minutes / seconds_of(o),
           o->preparation, o->field, o->base, o->growth, o->finish, o->settling, o->prisms, o->embedding,
           100 * embedding_share(o), o->layer.stretch_before, o->layer.stretch_after, o->bytes / o->triangles);
}

static void print_check(const Outcome *o)
{
    const MesoQuiltReport *r = &o->report;
    const MesoQuiltCheck *k = &o->check;
    const MesoMeshFaults *f = &k->faults;
    printf("  patches %u, joins %u, caps %u, closed %u, debris %u, removed %u, skipped %u, retries %u, shrunk %u\n",
           r->patch_count, r->join_count, r->cap_count, r->closed_count, r->debris_count, r->removed_count,
           r->skipped_count, r->retry_count, r->shrunk_count);
    printf("  settled %u, added %u\n", r->settled_count, r->added_count);
    printf("  cores %.2f s; charts %.2f, matching %.2f, seams %.2f, wholes %.2f, strands %.2f, adding %.2f\n", o->cores,
           r->seconds[0], r->seconds[1], r->seconds[2], r->seconds[3], r->seconds[4], r->seconds[5]);
    printf("  mesh: unplaced %u, open %u, crowded %u, reversed %u, collapsed %u, pinched %u\n", f->unplaced_count,
           f->open_count, f->crowded_count, f->reversed_count, f->collapsed_count, f->pinched_count);
    printf("  elements: whole %u of %.0f by area, changed %u, squeezed %u (volumes %.3f to %.3f), strands %u, "
           "merged %u, apart %u; triangles %.3f and area %.3f of those by area\n", k->whole_count,
           k->expected_whole_count, k->changed_count, k->squeezed_count, k->least_volume, k->largest_volume,
           k->strand_count, k->merged_count, k->apart_count, o->triangles / k->expected_triangle_count, k->area_share);
    printf("  sections: %u of %u changed, areas %.3f to %.3f, rms %.3f\n", k->sections.changed_count, k->sections.count,
           k->sections.least, k->sections.largest, k->sections.rms);
    printf("  crossings: %llu between elements, %llu within, %llu of one patch, in %u elements; swatch %.0f\n",
           (unsigned long long)k->crossings.between_count, (unsigned long long)k->crossings.within_count,
           (unsigned long long)k->crossings.one_patch_count, k->crossings.element_count, k->expected_crossings);
    printf("  likeness: %.4f from the swatch, worst %.4f, within it %.4f, bent %.4f: ratio %.3f +- %.3f of %u; ",
           k->likeness.distance, k->likeness.largest_distance, k->likeness.swatch_distance, k->likeness.laid_distance,
           k->likeness.ratio, k->likeness.ratio_error, k->likeness.window_count);
    printf("KS at seams: lengths %.3f, angles %.3f; against the same places: %.3f, %.3f\n", k->seams.length_distance,
           k->seams.angle_distance, k->seams.placed_length_distance, k->seams.placed_angle_distance);
    printf("  cover: %u of %u places empty, widest %.3f, in the swatch %.3f; check", k->cover.empty_count,
           k->cover.place_count, k->cover.widest, k->cover.swatch_widest);
    for (size_t i = 0; i < sizeof k->seconds / sizeof *k->seconds; i++)
        printf(" %.2f", k->seconds[i]);
    printf(" s\n");
}

static bool is_wanted(const Row *row, int count, char **names)
{
    char name[NAME_SIZE];
    name_row(name, row);
    for (int i = 0; i < count; i++)
        if (strncmp(name, names[i], strlen(names[i])) == 0)
            return true;
    return count == 0;
}

int main(int argc, char **argv)
{
    static Outcome outcome;
    bool check = argc > 1 && strcmp(argv[1], "--check") == 0;
    uint64_t triangles = 0, published_triangles = 0;
    double seconds = 0, preparation = 0, minutes = 0, share = 0;
    uint32_t failed_count = 0;
    meso_lean_memory();
    printf("%-20s %13s | %13s | %19s %17s %13s | %32s | %5s + %5s %5s %6s %5s %6s %5s %5s %5s | %14s | bytes a triangle\n",
           "surface + swatch", "surface f v", "swatch f v", "faces (paper)", "vertices (paper)", "elements",
           "seconds (paper) faster", "prep", "field", "base", "growth", "end", "settle", "prism", "embed", "anew",
           "stretch");
    for (size_t r = 0; r < ROW_COUNT; r++) {
        const Row *row = &ROWS[r];
        if (!is_wanted(row, argc - 1 - check, argv + 1 + check))
            continue;
        run_apart(row, &outcome, check);
        print_row(row, &outcome);
        failed_count += !outcome.done;
        if (!outcome.done)
            continue;
        if (check)
            print_check(&outcome);
        triangles += outcome.triangles;
        published_triangles += row->published.triangles;
        seconds += seconds_of(&outcome);
        preparation += outcome.preparation;
        minutes += row->published.minutes;
        share = fmax(share, embedding_share(&outcome));
    }
    printf("all: %.2f M triangles (paper: %.2f M) in %.2f s (paper: %.1f min), swatches %.3f s; laid anew in at most "
           "%.1f %% of it\n", 1e-6 * (double)triangles, 1e-6 * (double)published_triangles, seconds, minutes, preparation,
           100 * share);
    return failed_count != 0;
}
