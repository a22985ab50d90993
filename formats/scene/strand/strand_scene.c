#include "formats/scene/strand/strand_scene.h"

#include <string.h>

#include "libcore/scene/sweep.h"

/* ---- caps ---- */

typedef struct Caps {
    const MesoScene *in;
    MesoScene *out;
    uint8_t *open;      /* [sweeps] bit 1: the start, bit 2: the end */
} Caps;

/* A cap that closes nothing is open where it starts. */
static void find_open(Caps *caps, const MesoStrands *strands)
{
    for (uint32_t s = 0; s < strands->count; s++) {
        MesoStrandPiece first = strands->pieces[strands->begin[s]], last = strands->pieces[strands->begin[s + 1] - 1];
        bool alone = strands->begin[s + 1] - strands->begin[s] == 1;
        if (strands->closed[s])
            continue;
        if (!caps->in->kinds[meso_scene_kind(caps->in, first.sweep)].cap)
            caps->open[first.sweep] |= first.reversed ? 2 : 1;
        else if (alone)
            caps->open[first.sweep] |= 1;
        if (!caps->in->kinds[meso_scene_kind(caps->in, last.sweep)].cap)
            caps->open[last.sweep] |= last.reversed ? 1 : 2;
    }
}

/*
 * Seen from outside, the profile of a start is its mirror image, and its columns run the other way round. What is
 * absent on that ring is absent in the cap: the columns beside it join each other.
 */
static void add_columns(Caps *caps, const MesoSweptKind *kind, bool at_end)
{
    const MesoSweepColumn *from = caps->in->columns + kind->column_begin;
    uint32_t absent = at_end ? MESO_ABSENT_END : MESO_ABSENT_START, begin = caps->out->column_count;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        uint32_t source = at_end ? c : kind->column_count - 1 - c;
        MesoSweepColumn column = from[source];
        if (column.absent & absent)
            continue;
        column.absent = 0;
        if (at_end) {
            column.start = column.end;
            column.start_normal = column.end_normal;
        } else {
            column.start.x = -column.start.x;
            column.start_normal.x = -column.start_normal.x;
            column.joins_next = 0;
            if (caps->out->column_count > begin)
                caps->out->columns[caps->out->column_count - 1].joins_next = from[source].joins_next;
        }
        column.end = column.start;
        column.end_normal = column.start_normal;
        caps->out->columns[caps->out->column_count++] = column;
    }
}

static void add_instance(Caps *caps, const MesoSweepInstance *sweep, bool at_end)
{
    MesoSweepInstance cap = *sweep;
    MesoVec3 outward = at_end ? sweep->direction[1] : meso_vec3_scale(sweep->direction[0], -1);
    float rise = MESO_CAP_RISE * caps->in->section_scale * sweep->size[at_end];
    for (int i = 0; i < 4; i++)
        cap.p[i] = meso_vec3_mad(sweep->p[at_end ? 3 : 0], rise * (float)i / 3, outward);
    for (int i = 0; i < 2; i++) {
        cap.direction[i] = outward;
        cap.size[i] = sweep->size[at_end];
        cap.up[i] = sweep->up[at_end];
    }
    cap.twist = cap.mitre = 0;
    caps->out->sweeps[caps->out->sweep_count++] = cap;
}

static void add_caps(Caps *caps, const MesoSweptKind *kind, bool at_end)
{
    MesoSweptKind cap = *kind;
    const uint8_t bit = at_end ? 2 : 1;
    cap.column_begin = caps->out->column_count;
    cap.instance_begin = caps->out->sweep_count;
    cap.cap = true;
    cap.turn = 0;
    cap.start_material = cap.end_material = at_end ? kind->end_material : kind->start_material;
    for (uint32_t i = 0; i < kind->instance_count; i++)
        if (caps->open[kind->instance_begin + i] & bit)
            add_instance(caps, &caps->in->sweeps[kind->instance_begin + i], at_end);
    cap.instance_count = caps->out->sweep_count - cap.instance_begin;
    if (cap.instance_count == 0)
        return;
    add_columns(caps, kind, at_end);
    cap.column_count = caps->out->column_count - cap.column_begin;
    cap.bowed = false;
    meso_sweep_count(&cap, caps->out->columns + cap.column_begin);
    caps->out->kinds[caps->out->kind_count++] = cap;
}

MesoStatus meso_strand_scene_cap(MesoScene *out, MesoArena *arena, const MesoScene *in, MesoError *error)
{
    MesoStrands strands;
    *out = *in;
    out->kinds = MESO_NEW(arena, MesoSweptKind, 3 * (size_t)in->kind_count, error);
    out->columns = MESO_NEW(arena, MesoSweepColumn, 3 * (size_t)in->column_count, error);
    out->sweeps = MESO_NEW(arena, MesoSweepInstance, 3 * (size_t)in->sweep_count, error);
    Caps caps = {in, out, MESO_NEW(arena, uint8_t, in->sweep_count, error)};
    if (!out->kinds || !out->columns || !out->sweeps || !caps.open)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_strands_find(&strands, arena, in, error);
    if (status)
        return status;
    find_open(&caps, &strands);
    if (in->kind_count > 0) {
        memcpy(out->kinds, in->kinds, in->kind_count * sizeof *in->kinds);
        memcpy(out->columns, in->columns, in->column_count * sizeof *in->columns);
        memcpy(out->sweeps, in->sweeps, in->sweep_count * sizeof *in->sweeps);
    }
    for (uint32_t k = 0; k < in->kind_count; k++)
        for (int end = 0; end < (in->kinds[k].cap ? 1 : 2); end++)
            add_caps(&caps, &in->kinds[k], end);
    return MESO_OK;
}

/* ---- numbers ---- */

static bool wants_numbers(const MesoScene *in)
{
    for (uint32_t c = 0; c < in->channel_count; c++)
        if (strcmp(in->channels[c].name, "strand") == 0)
            return false;
    return in->sweep_count > 0 && in->channel_count < MESO_ID_CHANNELS;
}

/* A row of its own for each part: the old one, and the strand's number. */
static uint32_t add_row(MesoScene *out, const MesoScene *in, uint32_t row, uint32_t number)
{
    uint32_t *to = out->ids + (size_t)out->id_row_count * out->channel_count;
    memcpy(to, in->ids + (size_t)row * in->channel_count, in->channel_count * sizeof *to);
    to[in->channel_count] = number;
    return out->id_row_count++;
}

MesoStatus meso_strand_scene_number(MesoScene *out, MesoArena *arena, const MesoScene *in, const MesoStrands *strands,
                                    MesoError *error)
{
    size_t part_count = (size_t)in->sweep_count + in->placed_count;
    *out = *in;
    if (!wants_numbers(in))
        return MESO_OK;
    out->channels[out->channel_count++] = (MesoIdChannel){"strand", strands->count + (in->placed_count > 0), NULL};
    out->ids = MESO_NEW(arena, uint32_t, part_count * out->channel_count, error);
    out->sweeps = MESO_NEW(arena, MesoSweepInstance, in->sweep_count, error);
    out->placed = MESO_NEW(arena, MesoPlacedBody, in->placed_count, error);
    if (!out->ids || !out->sweeps || !out->placed)
        return MESO_ERR_MEMORY;
    out->id_row_count = 0;
    for (uint32_t i = 0; i < in->sweep_count; i++) {
        out->sweeps[i] = in->sweeps[i];
        out->sweeps[i].ids = add_row(out, in, in->sweeps[i].ids, strands->of_sweep[i]);
    }
    for (uint32_t i = 0; i < in->placed_count; i++) {
        out->placed[i] = in->placed[i];
        out->placed[i].ids = add_row(out, in, in->placed[i].ids, strands->count);
    }
    return MESO_OK;
}
