#include <string.h>

#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/phase/phase_plane.h"
#include "libcore/quilt/phase/weave_pitch.h"

static double wrapped(double phase)
{
    return remainder(phase, 2 * MESO_PI);
}

static double phase_of(const double wave[2])
{
    return atan2(wave[1], wave[0]);
}

/* Guides that point along x or y, as the triangle's number has it. */
static MesoVec3 *mixed_guides(MesoArena *arena, const MesoTriangulation *mesh)
{
    MesoError error;
    MesoVec3 *guides = MESO_NEW(arena, MesoVec3, mesh->triangle_count, &error);
    CHECK(guides);
    const MesoVec3 ways[4] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        guides[t] = ways[t * 7 % 4];
    return guides;
}

/* On a plane stripes fit, whatever turns guides take, and grow by a pitch. */
static void check_sheet(bool diagonal)
{
    MesoArena arena;
    MesoError error;
    MesoStripePhases phases;
    meso_arena_init(&arena);
    MesoTriangulation mesh = meso_fixture_sheet(24, 20, 0.3f);
    const double pitches[2] = {1, 1};
    MesoVec3 *guides = mixed_guides(&arena, &mesh);
    CHECK(meso_stripe_phases(&phases, &arena, &mesh, guides,
                             &(MesoStripeOptions){4, {pitches[0], pitches[1]}, diagonal, 0.3, 2}, &error) == MESO_OK);
    CHECK(phases.strain < 1e-3);
    CHECK(fabs(phases.pitches[0] - (diagonal ? sqrt(2) : 1)) < 1e-6);
    uint32_t turned = 0;
    for (uint32_t h = 0; h < 3 * mesh.triangle_count; h++) {
        uint32_t across = meso_frame_across(&mesh, h);
        if (across == MESO_NO_INDEX)
            continue;
        MesoStripeStep step = meso_stripe_step(&phases, h, across);
        double there[4], more[2];
        turned += step.quarters != 0;
        meso_stripe_turn_waves(there, phases.waves[across / 3], step.quarters);
        meso_stripe_excess(more, &phases, h, across, &step);
        for (int k = 0; k < 2; k++) {
            double grown = phase_of(&there[2 * k]) - phase_of(&phases.waves[h / 3][2 * k]);
            CHECK(fabs(wrapped(grown - 2 * MESO_PI * step.ways[k] / phases.pitches[k])) < 0.02);
            CHECK(fabs(more[k]) < 0.01);
        }
    }
    CHECK(turned > mesh.triangle_count);
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
}

/* Guides of a plane that swing to and fro: stripes would be bent, and so are not a pitch apart; guides are turned. */
static void check_turning(void)
{
    MesoArena arena;
    MesoError error;
    MesoStripePhases phases;
    meso_arena_init(&arena);
    MesoTriangulation mesh = meso_fixture_sheet(40, 30, 0.2f);
    MesoVec3 *guides = MESO_NEW(&arena, MesoVec3, mesh.triangle_count, &error);
    CHECK(guides);
    double swing = 0, left = 0;
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        MesoVec3 p = mesh.positions[mesh.corners[3 * (size_t)t]];
        float angle = 0.12f * sinf(1.5f * p.x) * sinf(1.5f * p.y);
        guides[t] = (MesoVec3){cosf(angle), sinf(angle), 0};
        swing += (double)(angle * angle) / mesh.triangle_count;
    }
    const double pitches[2] = {1, 1};
    CHECK(meso_stripe_phases(&phases, &arena, &mesh, guides,
                             &(MesoStripeOptions){4, {pitches[0], pitches[1]}, false, 0.3, 2}, &error) == MESO_OK);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        double angle = atan2((double)phases.directions[t].y, (double)phases.directions[t].x);
        left += angle * angle / mesh.triangle_count;
    }
    CHECK(left < 0.25 * swing && phases.strain < 0.5 * sqrt(swing));
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
}

enum { AROUND = 60 };

static MesoVec3 on_cylinder(const MesoFixtureSquares *squares, uint32_t column, uint32_t row)
{
    double angle = 2 * MESO_PI * column / AROUND;
    return (MesoVec3){squares->size[1] * (float)cos(angle), squares->size[1] * (float)sin(angle),
                      squares->size[0] * (float)row};
}

/* Places of a chart along its first triangle's guide, in phase. `chart_triangles` gets the chart's own. */
static MesoVec2 *place_in_phase(MesoArena *arena, const MesoChart *chart, const MesoStripePhases *phases,
                                const MesoVec3 *guides, uint32_t *chart_triangles)
{
    MesoError error;
    MesoVec2 guide = meso_chart_direction(chart, phases->mesh, 0, guides[chart->triangles[0]]);
    float angle = atan2f(guide.y, guide.x);
    MesoVec2 *spots = MESO_NEW(arena, MesoVec2, chart->vertex_count, &error);
    CHECK(spots);
    for (uint32_t v = 0; v < chart->vertex_count; v++) {
        MesoVec2 p = chart->places[v];
        spots[v] = (MesoVec2){cosf(angle) * p.x + sinf(angle) * p.y, cosf(angle) * p.y - sinf(angle) * p.x};
    }
    for (uint32_t t = 0; t < chart->triangle_count; t++)
        chart_triangles[chart->triangles[t]] = t;
    CHECK(meso_phase_plane(spots, arena, chart, chart_triangles, phases, guides, angle, 1, &error) == MESO_OK);
    return spots;
}

/*
 * Around a cylinder there is room for 10.3 stripes: there are ten, and so phases are off by three parts of ten and
 * three. A chart of it has stripes that are a pitch apart in its plane, at whole pitches.
 */
static void check_cylinder(void)
{
    MesoArena arena;
    MesoError error;
    MesoStripePhases phases;
    meso_arena_init(&arena);
    const float length = 10.3f;
    MesoTriangulation mesh = meso_fixture_squares(&(MesoFixtureSquares){
        .columns = AROUND, .rows = 40, .around = MESO_SEAM_JOINED, .place = on_cylinder,
        .size = {length / AROUND, length / (2 * (float)MESO_PI)}});
    MesoVec3 *guides = MESO_NEW(&arena, MesoVec3, mesh.triangle_count, &error);
    uint32_t *chart_triangles = MESO_NEW(&arena, uint32_t, mesh.triangle_count, &error);
    CHECK(guides && chart_triangles);
    for (uint32_t t = 0; t < mesh.triangle_count; t++) {
        guides[t] = (MesoVec3){0, 0, 1};
        chart_triangles[t] = MESO_NO_INDEX;
    }
    const double pitches[2] = {1, 1};
    CHECK(meso_stripe_phases(&phases, &arena, &mesh, guides,
                             &(MesoStripeOptions){4, {pitches[0], pitches[1]}, false, 0.3, 2}, &error) == MESO_OK);
    CHECK(phases.strain > 0.01 && phases.strain < 0.04);

    MesoChartMaker maker;
    MesoChart chart;
    CHECK(meso_chart_maker_init(&maker, &mesh, &error) == MESO_OK);
    CHECK(meso_chart_grow(&chart, &arena, &maker, mesh.triangle_count / 2, &(MesoChartOptions){.radius = 2.5f},
                          &error) == MESO_OK);
    MesoVec2 *spots = place_in_phase(&arena, &chart, &phases, guides, chart_triangles);
    double largest = 0;
    for (uint32_t t = 0; t < chart.triangle_count; t++) {
        MesoVec2 sum = {0, 0};
        for (uint32_t k = 0; k < 3; k++)
            sum = meso_vec2_add(sum, spots[chart.corners[3 * (size_t)t + k]]);
        const double places[2] = {(double)sum.x / 3, (double)sum.y / 3};
        for (int k = 0; k < 2; k++)
            largest = fmax(largest, fabs(wrapped(2 * MESO_PI * places[k] -
                                                 phase_of(&phases.waves[chart.triangles[t]][2 * k]))));
    }
    CHECK(largest < 0.05);
    meso_chart_maker_release(&maker);
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
}

/*
 * Phases of a sheet that sway, and crowd where `steep` so much that triangles there would be turned over. What is a
 * pitch away from there comes to be in phase all the same.
 */
static double largest_miss(bool steep)
{
    MesoArena arena;
    MesoError error;
    MesoStripePhases phases;
    MesoChartMaker maker;
    MesoChart chart;
    meso_arena_init(&arena);
    MesoTriangulation mesh = meso_fixture_sheet(30, 30, 0.2f);
    const uint32_t count = mesh.triangle_count, middle = count / 2 + 30;
    MesoVec3 *guides = MESO_NEW(&arena, MesoVec3, count, &error);
    uint32_t *chart_triangles = MESO_NEW(&arena, uint32_t, count, &error);
    CHECK(guides && chart_triangles);
    for (uint32_t t = 0; t < count; t++) {
        guides[t] = (MesoVec3){1, 0, 0};
        chart_triangles[t] = MESO_NO_INDEX;
    }
    const double pitches[2] = {1, 1};
    CHECK(meso_stripe_phases(&phases, &arena, &mesh, guides,
                             &(MesoStripeOptions){1, {pitches[0], pitches[1]}, false, 0.3, 2}, &error) == MESO_OK);
    MesoVec3 core = mesh.positions[mesh.corners[3 * middle]];
    double *away = MESO_NEW(&arena, double, count, &error);
    CHECK(away);
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *v = &mesh.corners[3 * (size_t)t];
        MesoVec3 sum = meso_vec3_add(meso_vec3_add(mesh.positions[v[0]], mesh.positions[v[1]]), mesh.positions[v[2]]);
        double x = (double)(sum.x / 3 - core.x), y = (double)(sum.y / 3 - core.y);
        away[t] = sqrt(x * x + y * y);
        double sway = 0.3 * sin(0.7 * y) + (steep ? 0.5 * exp(-away[t] * away[t] / 0.09) : 0);
        phases.waves[t][0] = cos(2 * MESO_PI * (x + sway));
        phases.waves[t][1] = sin(2 * MESO_PI * (x + sway));
        phases.waves[t][2] = cos(2 * MESO_PI * y);
        phases.waves[t][3] = sin(2 * MESO_PI * y);
    }
    CHECK(meso_chart_maker_init(&maker, &mesh, &error) == MESO_OK);
    CHECK(meso_chart_grow(&chart, &arena, &maker, middle, &(MesoChartOptions){.radius = 2}, &error) == MESO_OK);
    MesoVec2 *spots = place_in_phase(&arena, &chart, &phases, guides, chart_triangles);
    double largest = 0;
    for (uint32_t t = 0; t < chart.triangle_count; t++) {
        const uint32_t *v = &chart.corners[3 * (size_t)t];
        MesoVec2 a = meso_vec2_sub(spots[v[1]], spots[v[0]]), b = meso_vec2_sub(spots[v[2]], spots[v[0]]);
        CHECK(meso_vec2_cross(a, b) > 0);
        double x = (double)(spots[v[0]].x + spots[v[1]].x + spots[v[2]].x) / 3;
        const double *wave = phases.waves[chart.triangles[t]];
        if (away[chart.triangles[t]] > 1 && away[chart.triangles[t]] < 1.8)
            largest = fmax(largest, fabs(wrapped(2 * MESO_PI * x - phase_of(wave))) / (2 * MESO_PI));
    }
    meso_chart_maker_release(&maker);
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
    return largest;
}

static void check_steep(void)
{
    double even = largest_miss(false), steep = largest_miss(true);
    CHECK(even < 0.03 && steep < 0.05);
}

/* Strands of a cloth, some off by a few parts of a hundred; floats: crossings that a strand stays above. */
static uint32_t make_cloth(MesoVec3 *middles, MesoVec3 *axes, uint32_t floats)
{
    uint32_t count = 0;
    for (int side = 0; side < 2; side++)
        for (int i = 0; i < 6; i++)
            for (int k = 0; k < 60; k++) {
                double along = 0.1 * k, across = 0.4 + i + 0.04 * (i % 3 - 1);
                double up = cos(MESO_PI * ((along - 0.4) / floats + i + side));
                middles[count] = side ? (MesoVec3){(float)along, (float)across, (float)up}
                                      : (MesoVec3){(float)across, (float)along, (float)up};
                axes[count++] = side ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
            }
    return count;
}

static void check_pitch(void)
{
    static MesoVec3 middles[720], axes[720];
    MesoWeavePitch pitch;
    uint32_t count = make_cloth(middles, axes, 1);
    CHECK(meso_weave_pitch(&pitch, middles, axes, count, (MesoVec2){6, 6}));
    CHECK(pitch.alike && pitch.chequered);
    for (int k = 0; k < 2; k++) {
        CHECK(fabs(pitch.pitches[k] - 1) < 0.02);
        CHECK(fabs(remainder(pitch.offsets[k] - 0.4, 1)) < 0.06);
    }
    make_cloth(middles, axes, 2);
    CHECK(meso_weave_pitch(&pitch, middles, axes, count, (MesoVec2){6, 6}) && !pitch.chequered);
    for (uint32_t r = 0; r < count; r++)
        axes[r] = (MesoVec3){0.7f, 0.7f, 0};    /* along neither side */
    CHECK(!meso_weave_pitch(&pitch, middles, axes, count, (MesoVec2){6, 6}));
    count = make_cloth(middles, axes, 1);
    for (uint32_t r = 0; r < count; r++)
        middles[r].x = fmodf(3.708204f * (float)(r / 60), 6);       /* anywhere */
    CHECK(!meso_weave_pitch(&pitch, middles, axes, count, (MesoVec2){6, 6}));
}

static void check_threads(void)
{
    MesoArena arena;
    MesoError error;
    MesoStripePhases one, some;
    meso_arena_init(&arena);
    MesoTriangulation mesh = meso_fixture_sheet(30, 30, 0.2f);
    const uint32_t count = mesh.triangle_count;
    MesoVec3 *guides = MESO_NEW(&arena, MesoVec3, count, &error);
    CHECK(guides && count > 1024);
    for (uint32_t t = 0; t < count; t++)
        guides[t] = (MesoVec3){1, 0.001f * (float)(t % 97), 0};
    MesoStripeOptions options = {4, {0.7, 0.7}, false, 0.3, 1};
    CHECK(meso_stripe_phases(&one, &arena, &mesh, guides, &options, &error) == MESO_OK);
    for (options.thread_count = 2; options.thread_count < 8; options.thread_count += 5) {
        CHECK(meso_stripe_phases(&some, &arena, &mesh, guides, &options, &error) == MESO_OK);
        CHECK(memcmp(some.waves, one.waves, count * sizeof *one.waves) == 0);
        CHECK(memcmp(some.directions, one.directions, count * sizeof *one.directions) == 0);
    }
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
}

int main(void)
{
    check_sheet(false);
    check_sheet(true);
    check_turning();
    check_cylinder();
    check_steep();
    check_pitch();
    check_threads();
    return 0;
}
