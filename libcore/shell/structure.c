#include "libcore/shell/structure.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/shell/profile.h"
#include "libcore/shell/shell.h"
#include "libcore/shell/trajectory.h"

enum { INSTANCES_A_RANGE = 1024 };

typedef struct Builder {
    const MesoModel *model;
    MesoStructure *structure;
    const MesoContourSet *contours;
    MesoShell shell;
    uint32_t *bucket_slots;     /* [slot_count] slots by tile and mirroring, ascending within */
    uint32_t *bucket_begin;     /* [2 * tile_count + 1] */
    atomic_uint_fast64_t failed;    /* smallest instance that has no port */
} Builder;

/* ---- slots by tile and mirroring ---- */

static uint32_t bucket_of(const MesoModel *model, uint32_t slot)
{
    return 2 * model->assignment.tile[slot] + meso_transform_flips(model->assignment.transform[slot]);
}

static MesoStatus fill_buckets(Builder *b, MesoArena *scratch, MesoError *error)
{
    const MesoModel *model = b->model;
    uint32_t bucket_count = 2 * model->tile_set.tile_count, slot_count = model->assignment.slot_count;
    uint32_t *next = MESO_NEW(scratch, uint32_t, bucket_count, error);
    b->bucket_begin = MESO_NEW(scratch, uint32_t, (size_t)bucket_count + 1, error);
    b->bucket_slots = MESO_NEW(scratch, uint32_t, slot_count, error);
    if (!next || !b->bucket_begin || !b->bucket_slots)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < slot_count; s++)
        b->bucket_begin[bucket_of(model, s) + 1]++;
    for (uint32_t i = 0; i < bucket_count; i++)
        next[i] = b->bucket_begin[i + 1] += b->bucket_begin[i];
    for (uint32_t i = 0; i < bucket_count; i++)
        next[i] = b->bucket_begin[i];
    for (uint32_t s = 0; s < slot_count; s++)
        b->bucket_slots[next[bucket_of(model, s)]++] = s;
    return MESO_OK;
}

/* ---- kinds ---- */

/* Keeps the kinds of `profiles` that have instances. */
static MesoStatus keep_used_kinds(Builder *b, const MesoProfileSet *profiles, MesoArena *arena,
                                  MesoError *error)
{
    MesoStructure *out = b->structure;
    uint64_t instance_count = 0;
    out->kinds = MESO_NEW(arena, MesoSweepKind, profiles->kind_count, error);
    if (!out->kinds)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < profiles->kind_count; k++) {
        MesoSweepKind kind = profiles->kinds[k];
        uint32_t bucket = 2 * kind.tile + kind.mirrored;
        kind.instance_begin = (uint32_t)instance_count;
        kind.instance_count = b->bucket_begin[bucket + 1] - b->bucket_begin[bucket];
        if (kind.instance_count == 0)
            continue;
        instance_count += kind.instance_count;
        if (instance_count > UINT32_MAX / 2)
            return meso_fail(error, MESO_ERR_LIMIT, "over 2^31 sweeps; split the surface");
        out->kinds[out->kind_count++] = kind;
    }
    out->instance_count = (uint32_t)instance_count;
    out->columns = profiles->columns;
    out->column_count = profiles->column_count;
    out->instances = MESO_NEW(arena, MesoSweepInstance, out->instance_count, error);
    return out->instances ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- instances ---- */

static MesoStatus find_port(const Builder *b, uint32_t slot, uint32_t tile_side, uint32_t section,
                            MesoPort *port, MesoError *error)
{
    const MesoAssignment *a = &b->model->assignment;
    MesoTransform transform = a->transform[slot];
    int32_t label = b->model->tile_set.tiles[a->tile[slot]].labels[tile_side];
    MesoVec2 center = b->contours->center[section];
    if (tile_side >= MESO_SIDE_TOP)
        return meso_shell_lid_port(&b->shell, slot, tile_side, transform, center, label < 0, port, error);
    return meso_shell_wall_port(&b->shell, slot, meso_transform_side(transform, tile_side), center,
                                (label < 0) != meso_transform_flips(transform), port, error);
}

static MesoStatus make_cap(const Builder *b, const MesoSweepKind *kind, uint32_t slot,
                           MesoSweepInstance *out, MesoError *error)
{
    MesoPort port;
    MesoStatus status = find_port(b, slot, kind->start_side, kind->start_section, &port, error);
    if (status)
        return status;
    float rise = MESO_CAP_RISE * b->structure->options.section_scale;
    *out = (MesoSweepInstance){.up = {port.up, port.up}, .direction = {port.inward, port.inward}, .slot = slot};
    for (int i = 0; i < 4; i++)
        out->p[i] = meso_vec3_mad(port.point, rise * (float)i / 3, port.inward);
    return MESO_OK;
}

static MesoStatus make_sweep(const Builder *b, const MesoSweepKind *kind, uint32_t slot,
                             MesoSweepInstance *out, MesoError *error)
{
    MesoPort start, end;
    MesoStatus status = find_port(b, slot, kind->start_side, kind->start_section, &start, error);
    if (!status)
        status = find_port(b, slot, kind->end_side, kind->end_section, &end, error);
    if (status)
        return status;
    *out = (MesoSweepInstance){.up = {start.up, end.up},
                               .direction = {start.inward, meso_vec3_scale(end.inward, -1)},
                               .slot = slot};
    meso_trajectory(&start, &end, kind->start_side == kind->end_side,
                    b->structure->options.tangent_scale, out->p);
    return MESO_OK;
}

static MesoStatus make_instance(const Builder *b, uint32_t kind_index, uint32_t i, MesoError *error)
{
    const MesoSweepKind *kind = &b->structure->kinds[kind_index];
    uint32_t bucket = 2 * kind->tile + kind->mirrored;
    uint32_t slot = b->bucket_slots[b->bucket_begin[bucket] + (i - kind->instance_begin)];
    MesoSweepInstance *out = &b->structure->instances[i];
    return kind->cap ? make_cap(b, kind, slot, out, error) : make_sweep(b, kind, slot, out, error);
}

static void make_range(void *context, uint64_t begin, uint64_t end)
{
    Builder *b = context;
    uint32_t kind = meso_structure_kind(b->structure, (uint32_t)begin);
    for (uint64_t i = begin; i < end; i++) {
        while (i >= (uint64_t)b->structure->kinds[kind].instance_begin + b->structure->kinds[kind].instance_count)
            kind++;
        if (!make_instance(b, kind, (uint32_t)i, NULL))
            continue;
        uint_fast64_t first = atomic_load(&b->failed);
        while (i < first && !atomic_compare_exchange_weak(&b->failed, &first, i)) {
        }
    }
}

/* The first failure is found again alone, so that the message does not depend on the threads. */
static MesoStatus make_instances(Builder *b, uint32_t thread_count, MesoError *error)
{
    atomic_store(&b->failed, UINT64_MAX);
    meso_parallel_for(thread_count, b->structure->instance_count, INSTANCES_A_RANGE, make_range, b);
    uint64_t failed = atomic_load(&b->failed);
    if (failed == UINT64_MAX)
        return MESO_OK;
    return make_instance(b, meso_structure_kind(b->structure, (uint32_t)failed), (uint32_t)failed, error);
}

static bool is_near(float x)
{
    return fabsf(x) <= MESO_INNER_LIMIT;    /* and a number */
}

static MesoStatus check_inner(const MesoModel *model, const MesoTile *tile, uint32_t inner, MesoError *error)
{
    const MesoInnerMesh *place = &model->tile_set.inners[inner];
    const MesoTriangleMesh *mesh = &model->inner_meshes[inner];
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 q = meso_inner_point(place, mesh->positions[v]);
        if (!is_near(q.x) || !is_near(q.y) || !is_near(q.z))
            return meso_fail(error, MESO_ERR_INPUT, "tile '%s': vertex %u of its mesh '%s' lies more than %g tiles away",
                             tile->name, v + 1, place->file, (double)MESO_INNER_LIMIT);
    }
    return MESO_OK;
}

/* Of tiles that some slot holds. */
static MesoStatus check_inners(const Builder *b, MesoError *error)
{
    const MesoTileSet *set = &b->model->tile_set;
    MesoStatus status = MESO_OK;
    for (uint32_t t = 0; t < set->tile_count; t++)
        for (uint32_t k = 0; k < set->tiles[t].inner_count && !status; k++)
            if (b->bucket_begin[2 * t] < b->bucket_begin[2 * t + 2])
                status = check_inner(b->model, &set->tiles[t], set->tiles[t].inner_begin + k, error);
    return status;
}

static MesoStatus list_inners(Builder *b, MesoArena *arena, MesoError *error)
{
    const MesoTileSet *set = &b->model->tile_set;
    MesoStructure *out = b->structure;
    for (int pass = 0; pass < 2; pass++) {
        uint64_t count = 0;
        for (uint32_t t = 0; t < set->tile_count; t++)
            for (uint32_t k = 0; k < set->tiles[t].inner_count; k++) {
                uint32_t inner = set->tiles[t].inner_begin + k;
                if (b->model->inner_meshes[inner].triangle_count == 0)
                    continue;
                for (uint32_t i = b->bucket_begin[2 * t]; i < b->bucket_begin[2 * t + 2]; i++, count++)
                    if (pass == 1)
                        out->inners[count] = (MesoInnerInstance){inner, b->bucket_slots[i]};
            }
        if (count > UINT32_MAX / 2)
            return meso_fail(error, MESO_ERR_LIMIT, "over 2^31 inner meshes; split the surface");
        if (pass == 0) {
            out->inner_count = (uint32_t)count;
            out->inners = MESO_NEW(arena, MesoInnerInstance, count, error);
            if (!out->inners)
                return MESO_ERR_MEMORY;
        }
    }
    return MESO_OK;
}

static MesoStatus build(Builder *b, MesoArena *arena, MesoArena *scratch, uint32_t thread_count,
                        MesoError *error)
{
    MesoSlotGraph graph;
    MesoProfileSet profiles;
    const MesoMapOptions *options = &b->structure->options;
    MesoStatus status = meso_slot_graph_build(&graph, scratch, &b->model->surface, error);
    if (!status)
        status = meso_profile_set_build(&profiles, arena, &b->model->tile_set, b->contours, options->divisions, error);
    if (!status)
        status = fill_buckets(b, scratch, error);
    if (!status)
        status = check_inners(b, error);
    if (status)
        return status;

    b->shell = meso_shell_make(&b->model->surface, &graph, options);
    status = keep_used_kinds(b, &profiles, arena, error);
    if (!status)
        status = make_instances(b, thread_count, error);
    if (!status)
        status = list_inners(b, arena, error);
    return status;
}

MesoStatus meso_structure_build_over(MesoStructure *structure, MesoArena *arena,
                                     const MesoModel *model, const MesoContourSet *contours,
                                     uint32_t thread_count, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    *structure = (MesoStructure){
        .model = model,
        .options = meso_map_options_resolve(model->options, model->surface.mean_edge_length)};
    Builder builder = {.model = model, .structure = structure, .contours = contours};
    MesoStatus status = build(&builder, arena, &scratch, thread_count, error);
    meso_arena_release(&scratch);
    return status;
}

MesoStatus meso_structure_build(MesoStructure *structure, MesoArena *arena,
                                const MesoModel *model, uint32_t thread_count, MesoError *error)
{
    MesoArena scratch;
    MesoContourSet contours;
    meso_arena_init(&scratch);
    MesoMapOptions options = meso_map_options_resolve(model->options, model->surface.mean_edge_length);
    MesoStatus status = meso_contour_set_build(&contours, &scratch, &model->tile_set, options.section_step, error);
    if (!status)
        status = meso_structure_build_over(structure, arena, model, &contours, thread_count, error);
    meso_arena_release(&scratch);
    return status;
}

uint32_t meso_structure_kind(const MesoStructure *structure, uint32_t instance)
{
    uint32_t low = 0, high = structure->kind_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (structure->kinds[middle].instance_begin <= instance)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* ---- bounds ---- */

typedef struct Box {
    MesoVec3 low, high;
} Box;

static void grow(Box *box, MesoVec3 p)
{
    box->low = (MesoVec3){fminf(box->low.x, p.x), fminf(box->low.y, p.y), fminf(box->low.z, p.z)};
    box->high = (MesoVec3){fmaxf(box->high.x, p.x), fmaxf(box->high.y, p.y), fmaxf(box->high.z, p.z)};
}

static float kind_radius(const MesoStructure *s, const MesoSweepKind *kind)
{
    float radius = 0;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        const MesoSweepColumn *column = &s->columns[kind->column_begin + c];
        radius = fmaxf(radius, fmaxf(meso_vec2_length(column->start), meso_vec2_length(column->end)));
    }
    return radius * s->options.section_scale;
}

void meso_structure_bounds(const MesoStructure *structure, MesoVec3 *low, MesoVec3 *high)
{
    Box box = {{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}};
    for (uint32_t k = 0; k < structure->kind_count; k++) {
        const MesoSweepKind *kind = &structure->kinds[k];
        float r = kind_radius(structure, kind);
        for (uint32_t i = 0; i < kind->instance_count; i++)
            for (int j = 0; j < 4; j++) {
                MesoVec3 p = structure->instances[kind->instance_begin + i].p[j];
                grow(&box, (MesoVec3){p.x - r, p.y - r, p.z - r});
                grow(&box, (MesoVec3){p.x + r, p.y + r, p.z + r});
            }
    }

    MesoShell shell = meso_shell_make(&structure->model->surface, NULL, &structure->options);
    for (uint32_t i = 0; i < structure->inner_count; i++)
        for (int corner = 0; corner < 8; corner++)
            grow(&box, meso_shell_point(&shell, structure->inners[i].slot, (float)(corner & 1),
                                        (float)(corner >> 1 & 1), (float)(corner >> 2)));
    *low = box.low;
    *high = box.high;
}
