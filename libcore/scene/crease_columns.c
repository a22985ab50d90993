#include "libcore/scene/crease_columns.h"

#include <math.h>
#include <string.h>

#include "libcore/scene/cell.h"
#include "libcore/scene/inner_column.h"
#include "libcore/scene/sweep.h"
#include "libcore/scene/sweep_section.h"

/* Places along a sweep where its crease is looked at; pieces of one chord. */
enum { PLACES = 16, MOST_PIECES = 512 };

typedef struct Creaser {
    const MesoScene *in;
    float tolerance;
    MesoScene *out;             /* its kinds, columns and sweeps are filled */
    uint32_t *from;
} Creaser;

static bool is_creased(const MesoSweepInstance *sweep)
{
    return sweep->mitre >= MESO_CREASED;
}

static uint32_t count_creased(const MesoScene *scene, const MesoSweptKind *kind)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < kind->instance_count; i++)
        count += is_creased(&scene->sweeps[kind->instance_begin + i]);
    return count;
}

/* What chords of width 1 are off at most where a sweep's crease is strongest. */
static float most_off(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep)
{
    MesoSweepTrack track = meso_sweep_track(scene, kind, sweep);
    float kept = 1;
    for (uint32_t i = 1; i < PLACES; i++) {
        MesoSweepBlend blend = meso_sweep_blend(&track, (float)i / PLACES);
        MesoSweepPlane plane = meso_sweep_plane(&track.frames, blend.v);
        meso_sweep_crease(&blend, &track, meso_sweep_bend(&track.frames, &plane, blend.v));
        kept = fminf(kept, blend.kept);
    }
    float a = sqrtf(2), b = sqrtf(1 + kept);
    return (a - b) / (a + b);
}

/* What chords are off, for each of their width in the profiles, at most, of the kind's sweeps that have creases. */
static float off_of(const MesoScene *scene, const MesoSweptKind *kind)
{
    float off = 0;
    for (uint32_t i = kind->instance_begin; i < kind->instance_begin + kind->instance_count; i++) {
        const MesoSweepInstance *sweep = &scene->sweeps[i];
        if (!is_creased(sweep))
            continue;
        float own = scene->section_scale * fmaxf(sweep->size[0], sweep->size[1]) * most_off(scene, kind, sweep);
        if (scene->deform == MESO_SWEEP_SHAPE)
            own *= meso_cell_stretch(&scene->cages[sweep->cage]).most;
        off = fmaxf(off, own);
    }
    return off;
}

/* Pieces that a chord between two columns is cut into, none wider than `widest`. */
static uint32_t pieces_of(const MesoSweepColumn *a, const MesoSweepColumn *b, float widest)
{
    float width = fmaxf(meso_vec2_length(meso_vec2_sub(b->start, a->start)),
                        meso_vec2_length(meso_vec2_sub(b->end, a->end)));
    float pieces = widest > 0 ? ceilf(width / widest) : 1;
    return pieces < MOST_PIECES ? pieces > 1 ? (uint32_t)pieces : 1 : MOST_PIECES;
}

static MesoSweepColumn column_between(const MesoSweepColumn *a, const MesoSweepColumn *b, float t)
{
    return (MesoSweepColumn){.start = meso_vec2_lerp(a->start, b->start, t), .end = meso_vec2_lerp(a->end, b->end, t),
                             .start_normal = meso_vec2_lerp(a->start_normal, b->start_normal, t),
                             .end_normal = meso_vec2_lerp(a->end_normal, b->end_normal, t),
                             .u = a->u + (b->u - a->u) * t, .joins_next = 1,
                             .absent = MESO_ABSENT_START | MESO_ABSENT_END, .own = a->own & b->own,
                             .own_normals = {meso_vec2_lerp(a->own_normals[0], b->own_normals[0], t),
                                             meso_vec2_lerp(a->own_normals[1], b->own_normals[1], t)}};
}

/* Columns of a kind with those between, in their order around, to `out`; NULL only counts them. */
static uint32_t put_columns(const MesoScene *scene, const MesoSweptKind *kind, float widest, MesoSweepColumn *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t count = 0, first = 0, next = MESO_NO_INDEX, pieces = 1, piece = 1;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        for (; piece < pieces; piece++) {
            MesoSweepColumn between = column_between(&columns[first], &columns[next], (float)piece / (float)pieces);
            if (c < next && between.u > columns[c].u)
                break;
            if (out)
                out[count] = between;
            count++;
        }
        if (out)
            out[count] = columns[c];
        count++;
        uint32_t joined = meso_next_inner_column(kind, columns, c);
        if (joined == MESO_NO_INDEX)
            continue;
        first = c;
        next = joined;
        pieces = pieces_of(&columns[first], &columns[next], widest);
        piece = 1;
    }
    return count;
}

static float widest_of(const Creaser *c, const MesoSweptKind *kind)
{
    float off = off_of(c->in, kind);
    return off > 0 ? c->tolerance / off : 0;
}

/* Sweeps of a kind that have a crease, or none, as a kind of their own. */
static void put_kind(Creaser *c, uint32_t k, bool creased)
{
    const MesoSweptKind *from = &c->in->kinds[k];
    MesoScene *out = c->out;
    MesoSweptKind kind = *from;
    kind.instance_begin = out->sweep_count;
    for (uint32_t i = from->instance_begin; i < from->instance_begin + from->instance_count; i++)
        if (is_creased(&c->in->sweeps[i]) == creased)
            out->sweeps[out->sweep_count++] = c->in->sweeps[i];
    kind.instance_count = out->sweep_count - kind.instance_begin;
    if (kind.instance_count == 0)
        return;
    if (creased) {
        kind.column_begin = out->column_count;
        kind.column_count = put_columns(c->in, from, widest_of(c, from), out->columns + out->column_count);
        meso_sweep_count(&kind, out->columns + kind.column_begin);
        out->column_count += kind.column_count;
    }
    c->from[out->kind_count] = k;
    out->kinds[out->kind_count++] = kind;
}

MesoStatus meso_crease_columns(MesoScene *scene, uint32_t **from, MesoArena *arena, float tolerance, MesoError *error)
{
    MesoScene out = *scene;
    Creaser c = {scene, tolerance, &out, NULL};
    *from = NULL;
    size_t kinds = scene->kind_count, columns = scene->column_count;
    for (uint32_t k = 0; k < scene->kind_count; k++)
        if (count_creased(scene, &scene->kinds[k]) > 0) {
            kinds++;
            columns += put_columns(scene, &scene->kinds[k], widest_of(&c, &scene->kinds[k]), NULL);
        }
    if (kinds == scene->kind_count)
        return MESO_OK;
    if (columns > UINT32_MAX / 2)
        return meso_fail(error, MESO_ERR_LIMIT, "over 2^31 columns of sweeps; take a larger tolerance");
    out.kinds = MESO_NEW(arena, MesoSweptKind, kinds, error);
    c.from = MESO_NEW(arena, uint32_t, kinds, error);
    out.columns = MESO_NEW(arena, MesoSweepColumn, columns, error);
    out.sweeps = MESO_NEW(arena, MesoSweepInstance, scene->sweep_count, error);
    if (!out.kinds || !c.from || !out.columns || !out.sweeps)
        return MESO_ERR_MEMORY;
    memcpy(out.columns, scene->columns, scene->column_count * sizeof *out.columns);
    out.kind_count = out.sweep_count = 0;
    for (uint32_t k = 0; k < scene->kind_count; k++)
        for (int creased = 0; creased < 2; creased++)
            put_kind(&c, k, creased);
    *scene = out;
    *from = c.from;
    return MESO_OK;
}
