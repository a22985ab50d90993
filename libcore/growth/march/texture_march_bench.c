/*
 * How far marches through texels stray over a turn around a sphere, and what jumps over seams cost, beside straightest
 * walks over the same triangles: by six charts of a cube, equiangular and gnomonic, and by an atlas; and over a torus.
 */
#include <stdio.h>
#include <time.h>

#include "libcore/chart/chart_fixture.h"
#include "libcore/growth/march/march_fixture.h"

enum { SIDE = 64, FACE_TRIANGLES = 2 * SIDE * SIDE, COUNT = 200, STEPS = 314 };
static const double step = 0.02;

static double cpu_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* ---- a cube blown up to a sphere ---- */

/* Face `face` of a cube at -1 to 1: its two coordinates first, then the one that is constant. */
static MesoVec3 cube_place(uint32_t face, double a, double b)
{
    double sign = face & 1 ? -1 : 1, v[3];
    uint32_t axis = face / 2;
    v[axis] = sign;
    v[(axis + 1) % 3] = a;
    v[(axis + 2) % 3] = sign * b;
    double length = sqrt(1 + a * a + b * b);
    return (MesoVec3){(float)(v[0] / length), (float)(v[1] / length), (float)(v[2] / length)};
}

static double grid_at(uint32_t i)
{
    return tan(MESO_PI / 4 * (2.0 * i / SIDE - 1));
}

/* The number of a vertex that its face may share with others: by its place on the cube's grid. */
static uint32_t vertex_at(uint32_t *numbers, uint32_t *count, MesoVec3 *positions, const uint32_t cell[3],
                          MesoVec3 place)
{
    uint32_t *number = &numbers[(cell[0] * (SIDE + 1) + cell[1]) * (SIDE + 1) + cell[2]];
    if (*number == MESO_NO_INDEX) {
        *number = *count;
        positions[(*count)++] = place;
    }
    return *number;
}

static MesoTriangulation cube_sphere(void)
{
    size_t cells = (SIDE + 1) * (SIDE + 1) * (SIDE + 1);
    uint32_t *numbers = malloc(cells * sizeof *numbers), *corners = malloc(18 * FACE_TRIANGLES * sizeof *corners);
    MesoVec3 *positions = malloc(6 * (SIDE + 1) * (SIDE + 1) * sizeof *positions);
    uint32_t count = 0, n = 0;
    CHECK(numbers && corners && positions);
    memset(numbers, 0xff, cells * sizeof *numbers);
    for (uint32_t face = 0; face < 6; face++)
        for (uint32_t square = 0; square < SIDE * SIDE; square++) {
            uint32_t at[4];
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t i = square % SIDE + (k == 1 || k == 2), j = square / SIDE + (k >= 2), cell[3];
                cell[face / 2] = face & 1 ? 0 : SIDE;
                cell[(face / 2 + 1) % 3] = i;
                cell[(face / 2 + 2) % 3] = face & 1 ? SIDE - j : j;
                at[k] = vertex_at(numbers, &count, positions, cell, cube_place(face, grid_at(i), grid_at(j)));
            }
            const uint32_t two[6] = {at[0], at[1], at[2], at[0], at[2], at[3]};
            memcpy(&corners[n], two, sizeof two);
            n += 6;
        }
    MesoTriangulation mesh = meso_fixture_triangulation(positions, count, corners, n / 3);
    free(numbers);
    free(corners);
    free(positions);
    return mesh;
}

/* Of each face a square, three beside each other in two rows, a sixteenth apart. */
static MesoVec2 *cube_coordinates(const MesoTriangulation *mesh, bool gnomonic)
{
    MesoVec2 *uv = malloc(3 * mesh->triangle_count * sizeof *uv);
    CHECK(uv);
    for (uint32_t c = 0; c < 3 * mesh->triangle_count; c++) {
        uint32_t face = mesh->faces[c / 3] / FACE_TRIANGLES, axis = face / 2;
        MesoVec3 place = mesh->positions[mesh->corners[c]];
        const double v[3] = {place.x, place.y, place.z};
        double a = v[(axis + 1) % 3] / fabs(v[axis]), b = v[(axis + 2) % 3] / v[axis];
        if (!gnomonic) {
            a = 4 / MESO_PI * atan(a);
            b = 4 / MESO_PI * atan(b);
        }
        uv[c] = (MesoVec2){(float)(face % 3 + 0.47 * (a + 1)), (float)(face / 3 + 0.47 * (b + 1))};
    }
    return uv;
}

/* ---- marches ---- */

typedef struct Drift {
    double worst, mean;         /* of the walks' worst distances from where they should be */
    double shortest, longest;   /* step really taken */
    double seconds;
} Drift;

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* How far from the great circle of its first heading a walk comes, on a unit sphere. */
static double stray(const MesoMarchScene *scene, MesoTip tip, Drift *drift)
{
    double at[3], heading[3], axis[3], worst = 0;
    meso_fixture_place(&scene->walk.mesh, &tip, at, heading);
    for (uint32_t i = 0; i < 3; i++)
        axis[i] = at[(i + 1) % 3] * heading[(i + 2) % 3] - at[(i + 2) % 3] * heading[(i + 1) % 3];
    double size = length_of(axis);
    for (uint32_t s = 0; s < STEPS; s++) {
        MesoWalk walk = {.tip = tip, .length = step};
        double to[3], start = cpu_seconds();
        if (scene->march.image)
            meso_texture_walks(&scene->march, &walk, 1, NULL);
        else
            meso_walks(&scene->walk.ground, &walk, 1, NULL);
        drift->seconds += cpu_seconds() - start;
        CHECK(walk.stop == MESO_WALK_DONE);
        meso_tip_position(&scene->walk.mesh, &walk.tip, to);
        double taken = meso_fixture_apart(at, to);
        drift->shortest = fmin(drift->shortest, taken);
        drift->longest = fmax(drift->longest, taken);
        memcpy(at, to, sizeof at);
        tip = walk.tip;
        double height = (at[0] * axis[0] + at[1] * axis[1] + at[2] * axis[2]) / (size * length_of(at));
        worst = fmax(worst, fabs(asin(fmin(1, fabs(height)))));
    }
    return worst;
}

static void print_drift(const char *what, MesoMarchScene *scene)
{
    MesoJumpErrors errors = {.scene = scene};
    Drift drift = {.shortest = INFINITY};
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    scene->march.context = &errors;
    scene->march.jump = meso_fixture_tell_jump;
    for (uint32_t i = 0; i < COUNT; i++) {
        double worst = stray(scene, meso_fixture_tip(&scene->walk.ground, &random), &drift);
        drift.mean += worst / COUNT;
        drift.worst = fmax(drift.worst, worst);
    }
    double count = fmax(1, (double)errors.count);
    printf("%-32s %5u %9.4f %7.3f   %.3f to %.3f %6.1f %8.3f %6.2f %8.4f %6.3f %9.0f\n", what,
           scene->march.image ? scene->image.size : 0, drift.mean, drift.worst, drift.shortest, drift.longest,
           (double)errors.count / COUNT, errors.distance / count, errors.worst_distance, errors.angle / count,
           errors.worst_angle, 1e9 * drift.seconds / (COUNT * STEPS));
}

static void print_modes(const char *charts, MesoMarchScene *scene)
{
    static const struct {
        const char *name;
        bool snaps, metric;
    } modes[] = {{"snapped to texels", true, false}, {"between texels", false, false}, {"by the metric", false, true}};
    for (uint32_t m = 0; m < 3; m++) {
        char what[64];
        scene->march.snaps = modes[m].snaps;
        scene->march.metric = modes[m].metric;
        snprintf(what, sizeof what, "%s, %s", charts, modes[m].name);
        print_drift(what, scene);
    }
}

static void measure_cube(bool gnomonic, uint32_t size)
{
    MesoMarchScene scene;
    MesoTriangulation mesh = cube_sphere();
    MesoVec2 *uv = cube_coordinates(&mesh, gnomonic);
    meso_march_scene_init_with(&scene, mesh, uv, size);
    CHECK(scene.image.chart_count == 6);
    print_modes(gnomonic ? "gnomonic" : "equiangular", &scene);
    if (!gnomonic && size == 1024) {
        scene.march.image = NULL;
        print_drift("straightest walks", &scene);
    }
    free(uv);
    meso_march_scene_release(&scene);
}

static void measure_atlas(float radius)
{
    MesoMarchScene scene;
    char charts[32];
    meso_march_scene_init(&scene, cube_sphere(), radius, 1024);
    snprintf(charts, sizeof charts, "%u charts", scene.image.chart_count);
    print_modes(charts, &scene);
    meso_march_scene_release(&scene);
}

/* Ends of marches of some lengths beside those of straightest walks. */
static void measure_torus(void)
{
    MesoMarchScene scene;
    meso_march_scene_init(&scene, meso_fixture_torus(320, 128, 0.3f), 0, 1024);
    printf("torus, %u charts of 1024 texels; from the straightest walk's end after 0.1, 1 and %.2f:\n",
           scene.image.chart_count, STEPS * step);
    for (uint32_t mode = 0; mode < 3; mode++) {
        double apart[3] = {0};
        MesoRandom random;
        meso_random_init(&random, 3, 0);
        scene.march.snaps = mode == 0;
        scene.march.metric = mode == 2;
        for (uint32_t i = 0; i < 3 * COUNT; i++) {
            MesoWalk walk = {.tip = meso_fixture_tip(&scene.walk.ground, &random),
                             .length = i % 3 == 0 ? 0.1 : i % 3 == 1 ? 1 : STEPS * step}, exact = walk;
            meso_texture_walks(&scene.march, &walk, 1, NULL);
            meso_walks(&scene.walk.ground, &exact, 1, NULL);
            apart[i % 3] += meso_fixture_texels_apart(&scene, &walk.tip, &exact.tip);
        }
        printf("  %-18s", mode == 0 ? "snapped to texels" : mode == 1 ? "between texels" : "by the metric");
        for (uint32_t l = 0; l < 3; l++)
            printf(" %8.5f", apart[l] / COUNT / scene.image.texels_per_unit);
        printf("\n");
    }
    meso_march_scene_release(&scene);
}

int main(void)
{
    printf("a unit sphere, %u steps of %.2f, %u starts; radians, but for jumps in texels\n", STEPS, step, COUNT);
    printf("%-32s %5s %9s %7s   %14s %6s %8s %6s %8s %6s %9s\n", "", "size", "off, mean", "worst", "step taken",
           "jumps", "apart", "worst", "turned", "worst", "ns a step");
    measure_cube(false, 256);
    measure_cube(false, 1024);
    measure_cube(false, 2048);
    measure_cube(true, 1024);
    measure_atlas(0);
    measure_atlas(0.3f);
    measure_torus();
    return 0;
}
