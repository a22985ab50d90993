#include "libcore/tiling/strand/slot_sweeps.h"

#include "libcore/base/parallel.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/sweep_plane.h"
#include "libcore/tiling/strand/trajectory.h"

static bool deforms(const MesoSlotSweeps *s)
{
    return s->options.deform == MESO_SWEEP_SHAPE;
}

/* ---- slots by tile and mirroring ---- */

static uint32_t bucket_of(const MesoModel *model, uint32_t slot)
{
    return 2 * model->assignment.tile[slot] + meso_transform_flips(model->assignment.transform[slot]);
}

MesoStatus meso_slot_sweeps_sort(MesoSlotSweeps *s, MesoArena *arena, MesoError *error)
{
    const MesoModel *model = s->model;
    uint32_t bucket_count = 2 * model->tile_set.tile_count, slot_count = model->assignment.slot_count;
    uint32_t *next = MESO_NEW(arena, uint32_t, bucket_count, error);
    s->bucket_begin = MESO_NEW(arena, uint32_t, (size_t)bucket_count + 1, error);
    s->bucket_slots = MESO_NEW(arena, uint32_t, slot_count, error);
    if (!next || !s->bucket_begin || !s->bucket_slots)
        return MESO_ERR_MEMORY;
    for (uint32_t slot = 0; slot < slot_count; slot++)
        s->bucket_begin[bucket_of(model, slot) + 1]++;
    for (uint32_t i = 0; i < bucket_count; i++)
        next[i] = s->bucket_begin[i + 1] += s->bucket_begin[i];
    for (uint32_t i = 0; i < bucket_count; i++)
        next[i] = s->bucket_begin[i];
    for (uint32_t slot = 0; slot < slot_count; slot++)
        s->bucket_slots[next[bucket_of(model, slot)]++] = slot;
    return MESO_OK;
}

/* ---- one sweep ---- */

float meso_cell_scale(const MesoMapOptions *options, const MesoModel *model)
{
    float mean = model->surface.mean_edge_length;
    return options->section_scale / (mean > 0 ? mean : 1);
}

/* That of the cell which stands for the slot. */
static MesoStatus cell_port(const MesoSlotSweeps *s, uint32_t slot, uint32_t tile_side, MesoVec2 center, MesoPort *port,
                            MesoError *error)
{
    const MesoAssignment *a = &s->model->assignment;
    MesoTransform transform = a->transform[slot];
    if (tile_side >= MESO_SIDE_TOP) {
        bool flipped = s->model->tile_set.tiles[a->tile[slot]].labels[tile_side] < 0;
        return meso_shell_lid_port(&s->cell.shell, 0, tile_side == MESO_SIDE_BOTTOM, transform, center, flipped, port,
                                   error);
    }
    return meso_shell_wall_port(&s->cell.shell, 0, meso_transform_side(transform, tile_side), center,
                                meso_port_flipped(s->model, slot, tile_side), NULL, port, error);
}

/* Where sections deform, that of the cell; but none where the slot has none. */
static MesoStatus find_port(const MesoSlotSweeps *s, MesoSlotWalls *walls, uint32_t slot, uint32_t tile_side,
                            uint32_t section, MesoPort *port, MesoError *error)
{
    MesoVec2 center = s->ports.centers[section];
    MesoStatus status = meso_port_find_by(&s->ports, walls, slot, tile_side, section, port, error);
    if (status || !deforms(s))
        return status;
    center = (MesoVec2){meso_cell_round(center.x), meso_cell_round(center.y)};
    return cell_port(s, slot, tile_side, center, port, error);
}

static float port_size(const MesoSlotSweeps *s, uint32_t slot, uint32_t tile_side)
{
    return deforms(s) ? meso_cell_scale(&s->options, s->model) : meso_port_size(&s->ports, slot, tile_side);
}

static float one_if_none(float scale)
{
    return scale == 0 ? 1 : scale;
}

static float tangent_scale(const MesoSlotSweeps *s, const MesoKindOrigin *origin)
{
    const MesoTileSet *set = &s->model->tile_set;
    return s->options.tangent_scale * one_if_none(set->tiles[origin->tile].tangent_scale) *
           one_if_none(set->sweeps[origin->sweep].tangent_scale);
}

static MesoStatus make_cap(const MesoSlotSweeps *s, MesoSlotWalls *walls, const MesoKindOrigin *origin, uint32_t slot,
                           MesoSweepInstance *out, MesoError *error)
{
    MesoPort port;
    MesoStatus status = find_port(s, walls, slot, origin->start_side, origin->start_section, &port, error);
    if (status)
        return status;
    float size = port_size(s, slot, origin->start_side), rise = MESO_CAP_RISE * s->scene.section_scale * size;
    *out = (MesoSweepInstance){.up = {port.up, port.up}, .direction = {port.inward, port.inward}, .ids = slot,
                               .size = {size, size}, .cage = slot};
    for (int i = 0; i < 4; i++)
        out->p[i] = meso_vec3_mad(port.point, rise * (float)i / 3, port.inward);
    return MESO_OK;
}

/* But for its twist and its mitre. */
static MesoStatus make_tube(const MesoSlotSweeps *s, MesoSlotWalls *walls, uint32_t kind, uint32_t slot,
                            MesoSweepInstance *out, MesoError *error)
{
    const MesoKindOrigin *origin = &s->origins[kind];
    MesoPort start, end;
    MesoStatus status = find_port(s, walls, slot, origin->start_side, origin->start_section, &start, error);
    if (!status)
        status = find_port(s, walls, slot, origin->end_side, origin->end_section, &end, error);
    if (status)
        return status;
    *out = (MesoSweepInstance){.up = {start.up, end.up},
                               .direction = {start.inward, meso_vec3_scale(end.inward, -1)},
                               .ids = slot,
                               .size = {port_size(s, slot, origin->start_side), port_size(s, slot, origin->end_side)},
                               .cage = slot};
    meso_trajectory(&start, &end, origin->start_side == origin->end_side, tangent_scale(s, origin), out->p);
    return MESO_OK;
}

static MesoStatus make_hull(const MesoSlotSweeps *s, MesoSlotWalls *walls, uint32_t kind, uint32_t slot,
                            MesoSweepInstance *out, MesoError *error)
{
    return s->scene.kinds[kind].cap ? make_cap(s, walls, &s->origins[kind], slot, out, error)
                                    : make_tube(s, walls, kind, slot, out, error);
}

static void add_turns(const MesoSlotSweeps *s, uint32_t kind, MesoSweepInstance *out)
{
    if (s->scene.kinds[kind].cap)
        return;
    if (s->options.frame == MESO_FRAME_MINIMAL)
        out->twist = meso_sweep_twist(out);
    if (s->options.bends == MESO_BENDS_MITRED)
        meso_sweep_add_mitre(&s->scene, &s->scene.kinds[kind], s->reaches[kind], out);
}

static uint32_t slot_of(const MesoSlotSweeps *s, uint32_t kind, uint32_t i)
{
    uint32_t first = s->bucket_begin[meso_kind_bucket(&s->origins[kind])];
    return s->bucket_slots[first + (i - s->scene.kinds[kind].instance_begin)];
}

MesoStatus meso_slot_sweep(const MesoSlotSweeps *s, uint32_t kind, uint32_t i, MesoSweepInstance *out, MesoError *error)
{
    MesoSlotWalls walls = {.made = {false}};
    MesoStatus status = make_hull(s, &walls, kind, slot_of(s, kind, i), out, error);
    if (!status)
        add_turns(s, kind, out);
    return status;
}

void meso_slot_sweeps_note(MesoSlotSweeps *s, uint64_t sweep)
{
    uint_fast64_t first = atomic_load(&s->failed);
    while (sweep < first && !atomic_compare_exchange_weak(&s->failed, &first, sweep)) {
    }
}

/* ---- the maker ---- */

/* Kinds of a slot. */
typedef struct SlotKinds {
    uint32_t begin, end;
} SlotKinds;

static SlotKinds kinds_of(const MesoSlotSweeps *s, uint32_t slot)
{
    uint32_t bucket = bucket_of(s->model, slot);
    return (SlotKinds){s->bucket_kinds[bucket], s->bucket_kinds[bucket + 1]};
}

/* Slots of a bundle, and the first of each one's kinds: a slot of many has several bundles. */
static uint32_t make_hulls(void *context, uint32_t bundle, MesoMadeSweep *out)
{
    MesoSlotSweeps *s = context;
    uint64_t slot = (uint64_t)(bundle / s->bundles_a_slot) * s->slots_a_bundle;
    uint32_t first = bundle % s->bundles_a_slot * MESO_BUNDLE_SWEEPS, count = 0;
    for (uint32_t i = 0; i < s->slots_a_bundle && slot < s->model->assignment.slot_count; i++, slot++) {
        SlotKinds kinds = kinds_of(s, (uint32_t)slot);
        MesoSlotWalls walls = {.made = {false}};
        for (uint32_t k = kinds.begin + first; k < kinds.end && count < MESO_BUNDLE_SWEEPS; k++, count++) {
            out[count].sweep = s->scene.kinds[k].instance_begin + s->rank[slot];
            out[count].kind = k;
            if (make_hull(s, &walls, k, (uint32_t)slot, &out[count].instance, NULL)) {
                out[count].instance = (MesoSweepInstance){0};
                meso_slot_sweeps_note(s, out[count].sweep);
            }
        }
    }
    return count;
}

static void turn_hull(void *context, MesoMadeSweep *sweep)
{
    add_turns(context, sweep->kind, &sweep->instance);
}

static void make_one(void *context, uint32_t sweep, MesoSweepInstance *out)
{
    const MesoSlotSweeps *s = context;
    meso_slot_sweep(s, meso_scene_kind(&s->scene, sweep), sweep, out, NULL);
}

static uint32_t ids_of(void *context, uint32_t sweep)
{
    const MesoSlotSweeps *s = context;
    return slot_of(s, meso_scene_kind(&s->scene, sweep), sweep);
}

static MesoStatus index_slots(MesoSlotSweeps *s, MesoArena *arena, MesoError *error)
{
    uint32_t bucket_count = 2 * s->model->tile_set.tile_count, most = 1;
    s->rank = MESO_NEW(arena, uint32_t, s->model->assignment.slot_count, error);
    s->bucket_kinds = MESO_NEW(arena, uint32_t, (size_t)bucket_count + 1, error);
    s->kind_sizes = MESO_NEW(arena, float, 2 * (size_t)s->scene.kind_count, error);
    if (!s->rank || !s->bucket_kinds || !s->kind_sizes)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < s->scene.kind_count; k++)
        s->bucket_kinds[meso_kind_bucket(&s->origins[k]) + 1]++;
    for (uint32_t b = 0; b < bucket_count; b++) {
        most = s->bucket_kinds[b + 1] > most ? s->bucket_kinds[b + 1] : most;
        s->bucket_kinds[b + 1] += s->bucket_kinds[b];
        for (uint32_t i = s->bucket_begin[b]; i < s->bucket_begin[b + 1]; i++)
            s->rank[s->bucket_slots[i]] = i - s->bucket_begin[b];
    }
    s->slots_a_bundle = most < MESO_BUNDLE_SWEEPS ? MESO_BUNDLE_SWEEPS / most : 1;
    s->bundles_a_slot = (most + MESO_BUNDLE_SWEEPS - 1) / MESO_BUNDLE_SWEEPS;
    return MESO_OK;
}

/* By all slots of the kind's tile. */
static float largest_size(const MesoSlotSweeps *s, uint32_t kind)
{
    const MesoKindOrigin *origin = &s->origins[kind];
    uint32_t bucket = meso_kind_bucket(origin);
    float size = 0;
    for (uint32_t i = s->bucket_begin[bucket]; i < s->bucket_begin[bucket + 1]; i++) {
        float start = port_size(s, s->bucket_slots[i], origin->start_side);
        float end = port_size(s, s->bucket_slots[i], origin->end_side);
        size = fmaxf(size, fmaxf(start, end));
    }
    return size;
}

static void find_sizes(void *context, uint64_t begin, uint64_t end)
{
    MesoSlotSweeps *s = context;
    for (uint64_t k = begin; k < end; k++)
        s->kind_sizes[k] = largest_size(s, (uint32_t)k);
}

MesoStatus meso_slot_sweeps_maker(MesoSlotSweeps *s, MesoScene *scene, MesoArena *arena, uint32_t thread_count,
                                  MesoError *error)
{
    MesoStatus status = index_slots(s, arena, error);
    if (status)
        return status;
    uint64_t slots = s->model->assignment.slot_count;
    uint64_t bundles = (slots + s->slots_a_bundle - 1) / s->slots_a_bundle * s->bundles_a_slot;
    if (bundles > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "over 2^32 bundles of sweeps; split the surface");
    meso_parallel_for(thread_count, scene->kind_count, 1, find_sizes, s);
    atomic_store(&s->failed, UINT64_MAX);
    s->maker = (MesoSweepMaker){.context = s, .thread_count = thread_count, .bundle_count = (uint32_t)bundles,
                                .kind_sizes = s->kind_sizes, .make_hulls = make_hulls,
                                .add_turns = turn_hull, .make = make_one, .ids = ids_of};
    scene->maker = &s->maker;
    for (uint32_t k = 0; k < scene->kind_count; k++)
        s->kind_sizes[scene->kind_count + k] = meso_scene_kind_radius(scene, &scene->kinds[k]);
    s->maker.kind_radii = s->kind_sizes + scene->kind_count;
    s->maker.bundle_boxes = MESO_NEW(arena, MesoBox, s->maker.bundle_count, error);
    return s->maker.bundle_boxes ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_slot_sweeps_check(MesoSlotSweeps *s, MesoError *error)
{
    MesoSweepInstance made;
    uint64_t failed = atomic_load(&s->failed);
    if (failed == UINT64_MAX)
        return MESO_OK;
    return meso_slot_sweep(s, meso_scene_kind(&s->scene, (uint32_t)failed), (uint32_t)failed, &made, error);
}
