/* A tube between two profiles, and its vertices: what tests of sweeps sweep. */
#ifndef MESO_SWEEP_FIXTURE_H
#define MESO_SWEEP_FIXTURE_H

#include "libcore/base/check.h"
#include "libcore/scene/sweep.h"

enum { MOST_COLUMNS = 256, MOST_RINGS = 512 };

typedef struct Tube {
    MesoSweepColumn columns[MOST_COLUMNS + 1];
    MesoSweptKind kind;
    MesoSweepInstance sweep;
    MesoScene scene;
    MesoMeshVertex vertices[(MOST_COLUMNS + 1) * MOST_RINGS];
} Tube;

static Tube tube;

/* Profiles of `count` points, the second shifted by `shift` of them; straight along x from 0 to 1. */
static inline void make_tube(const MesoVec2 *profile, uint32_t count, uint32_t shift, uint32_t rings)
{
    for (uint32_t i = 0; i <= count; i++) {
        const MesoVec2 *a = profile, *b = profile;
        uint32_t k = i % count, l = (i + shift) % count;
        MesoVec2 start = meso_vec2_sub(a[(k + 1) % count], a[(k + count - 1) % count]);
        MesoVec2 end = meso_vec2_sub(b[(l + 1) % count], b[(l + count - 1) % count]);
        tube.columns[i] = (MesoSweepColumn){a[k], b[l], {-start.y, start.x}, {-end.y, end.x}, 0, i < count,
                                            .absent = 0};
    }
    tube.kind = (MesoSweptKind){.column_count = count + 1, .joint_count = count, .division_count = rings,
                                .instance_count = 1};
    tube.sweep = (MesoSweepInstance){{{0, 0, 0}, {1 / 3.f, 0, 0}, {2 / 3.f, 0, 0}, {1, 0, 0}},
                                     {{0, 0, 1}, {0, 0, 1}}, {{1, 0, 0}, {1, 0, 0}}, 0, {1, 1}, 0, 0, 0, {{0}, {0}}};
    tube.scene = (MesoScene){.section_scale = 1, .kind_count = 1, .column_count = count + 1, .sweep_count = 1,
                             .kinds = &tube.kind, .columns = tube.columns, .sweeps = &tube.sweep};
}

/* Clockwise, as columns are. */
static inline uint32_t make_disc(MesoVec2 *profile, uint32_t count, float radius)
{
    for (uint32_t i = 0; i < count; i++) {
        double angle = -2 * MESO_PI * i / count;
        profile[i] = (MesoVec2){radius * (float)cos(angle), radius * (float)sin(angle)};
    }
    return count;
}

/* The same number of points on each side of a box, which starts in a corner. */
static inline uint32_t make_box(MesoVec2 *profile, uint32_t side, float width, float height)
{
    const MesoVec2 corners[4] = {{-width / 2, height / 2}, {width / 2, height / 2}, {width / 2, -height / 2},
                                 {-width / 2, -height / 2}};
    for (uint32_t i = 0; i < 4 * side; i++)
        profile[i] = meso_vec2_lerp(corners[i / side], corners[(i / side + 1) % 4], (float)(i % side) / (float)side);
    return 4 * side;
}

static inline void sweep(void)
{
    CHECK(tube.kind.column_count <= MOST_COLUMNS + 1 && tube.kind.division_count <= MOST_RINGS);
    meso_sweep_vertices(&tube.scene, &tube.kind, &tube.sweep, tube.vertices);
}

static inline void add_mitre(void)
{
    MesoKindReach reach = meso_sweep_kind_reach(&tube.scene, &tube.kind);
    meso_sweep_add_mitre(&tube.scene, &tube.kind, reach, &tube.sweep);
}

#endif
