/* Columns for creases: on a square tube that one folds, chords are as near to the section as they are to be. */
#include "libcore/scene/crease_columns.h"

#include <math.h>

#include "libcore/base/check.h"
#include "libcore/scene/sweep.h"

/* A square of side 2, clockwise from a corner, two columns a corner, in a bend that is narrower. */
static void make_creased(MesoScene *scene, MesoSweptKind *kind, MesoSweepColumn *columns, MesoSweepInstance *sweeps)
{
    static const MesoVec2 corners[4] = {{-1, 1}, {1, 1}, {1, -1}, {-1, -1}};
    static const MesoVec2 normals[4] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
    for (uint32_t c = 0; c < 8; c++) {
        MesoSweepAngle slant = meso_sweep_angle(0.5f);      /* else folds would run along sides, or straight across */
        MesoVec2 at = meso_sweep_turned(corners[(c + 1) / 2 % 4], slant), n = meso_sweep_turned(normals[c / 2], slant);
        columns[c] = (MesoSweepColumn){.start = at, .end = at, .start_normal = n, .end_normal = n,
                                       .u = (float)((c + 1) / 2) / 4, .joins_next = c % 2 == 0};
    }
    *kind = (MesoSweptKind){.column_count = 8, .division_count = 9, .instance_count = 2};
    meso_sweep_count(kind, columns);
    sweeps[0] = (MesoSweepInstance){.p = {{0, 0, 0}, {0.3f, 0, 0}, {0.6f, 0.3f, 0}, {0.6f, 0.6f, 0}},
                                    .up = {{0.3f, 0, 1}, {0, 0.3f, 1}}, .direction = {{1, 0, 0}, {0, 1, 0}},
                                    .size = {1, 1}, .mitre = MESO_CREASED + 0.5f};
    sweeps[1] = (MesoSweepInstance){.p = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0, 0}}, .up = {{0, 0, 1}, {0, 0, 1}},
                                    .direction = {{1, 0, 0}, {1, 0, 0}}, .size = {1, 1}};
    *scene = (MesoScene){.section_scale = 1, .kind_count = 1, .column_count = 8, .sweep_count = 2, .kinds = kind,
                         .columns = columns, .sweeps = sweeps};
}

static float distance_to_line(MesoVec3 p, MesoVec3 a, MesoVec3 b)
{
    MesoVec3 d = meso_vec3_sub(b, a), q = meso_vec3_sub(p, a);
    return meso_vec3_length(meso_vec3_mad(q, -meso_vec3_dot(q, d) / meso_vec3_dot(d, d), d));
}

/* How far the section of the sweep with a crease lies off its chords, at most. */
static float off_chords(const MesoScene *scene)
{
    float worst = 0;
    for (uint32_t k = 0; k < scene->kind_count; k++) {
        const MesoSweptKind *kind = &scene->kinds[k];
        const MesoSweepInstance *sweep = &scene->sweeps[kind->instance_begin];
        for (uint32_t c = 0; c + 1 < kind->column_count && sweep->mitre > 0; c++)
            for (uint32_t i = 1; i < 15 * 16 && scene->columns[kind->column_begin + c].joins_next; i++) {
                const MesoSweepColumn *a = &scene->columns[kind->column_begin + c];
                float v = (float)(i / 15 + 1) / 17, t = (float)(i % 15) / 15;
                MesoSweepColumn on = *a;
                on.start = meso_vec2_lerp(a[0].start, a[1].start, t);
                on.end = meso_vec2_lerp(a[0].end, a[1].end, t);
                MesoVec3 at = meso_sweep_point(scene, kind, sweep, &on, v);
                MesoVec3 from = meso_sweep_point(scene, kind, sweep, &a[0], v);
                MesoVec3 to = meso_sweep_point(scene, kind, sweep, &a[1], v);
                worst = fmaxf(worst, distance_to_line(at, from, to));
            }
    }
    return worst;
}

/* What a crease folds has columns on flat sides, too, between the ends: not at them, and not where there is none. */
static void test_creased(MesoArena *arena)
{
    MesoScene scene;
    MesoSweptKind kind;
    MesoSweepColumn columns[8];
    MesoSweepInstance sweeps[2];
    MesoError error;
    uint32_t *from;
    make_creased(&scene, &kind, columns, sweeps);
    scene.sweeps[0].mitre = 0;      /* without a crease all stays as it is */
    CHECK(meso_crease_columns(&scene, &from, arena, 0.01f, &error) == MESO_OK);
    CHECK(!from && scene.kinds == &kind && scene.columns == columns);
    scene.sweeps[0].mitre = MESO_CREASED + 0.5f;
    CHECK(off_chords(&scene) > 0.05f);
    CHECK(meso_crease_columns(&scene, &from, arena, 0.01f, &error) == MESO_OK);
    float off = off_chords(&scene);
    CHECK(off > 0.001f && off <= 0.01f);
    CHECK(scene.kind_count == 2 && scene.sweep_count == 2 && from[0] == 0 && from[1] == 0);
    const MesoSweptKind *plain = &scene.kinds[0], *creased = &scene.kinds[1];
    CHECK(scene.sweeps[plain->instance_begin].mitre == 0 && scene.sweeps[creased->instance_begin].mitre > 0);
    CHECK(plain->column_count == 8 && creased->column_count > 20);
    for (uint32_t end = 0; end < 2; end++)
        CHECK(creased->column_count - creased->absent[end] == 8);
    CHECK(creased->absent[2] == 0 && creased->joint_count == creased->column_count - 4);

    MesoScene again = scene;    /* as all is narrow then, nothing more */
    CHECK(meso_crease_columns(&again, &from, arena, 1, &error) == MESO_OK);
    CHECK(again.kinds[again.kind_count - 1].column_count == creased->column_count);
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_creased(&arena);
    meso_arena_release(&arena);
    return 0;
}
