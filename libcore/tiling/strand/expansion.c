#include "libcore/tiling/strand/expansion.h"

#include <math.h>
#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/crease_columns.h"
#include "libcore/scene/placed.h"
#include "libcore/tiling/strand/slot_sweeps.h"
#include "libcore/tiling/strand/slot_winding.h"
#include "libcore/tiling/strand/steps.h"

enum { INSTANCES_A_RANGE = 1024 };

/* Of the tolerance for what columns are off; the steps along get most of what is left. */
static const float AROUND_SHARE = 0.5f;

/* Of the tolerance for chords of sections that a slot bends. */
static const float BEND_SHARE = 0.2f;

/* Of the tolerance for chords of sections that a crease folds. */
static const float CREASE_SHARE = 0.6f;

typedef struct Builder {
    const MesoModel *model;
    MesoScene *scene;
    MesoMapOptions options;     /* resolved */
    MesoKindOrigin *origins;    /* of the scene's kinds */
    const MesoContourSet *contours;
    MesoSlotSweeps *slots;
    uint32_t stored;            /* sweeps at most; 0: any number */
} Builder;

static bool deforms(const Builder *b)
{
    return b->options.deform == MESO_SWEEP_SHAPE;
}

/* ---- kinds ---- */

/* Keeps the kinds of `profiles` that have instances. */
static MesoStatus keep_used_kinds(Builder *b, const MesoProfileSet *profiles, MesoArena *arena,
                                  MesoError *error)
{
    MesoScene *out = b->scene;
    uint64_t instance_count = 0;
    out->kinds = MESO_NEW(arena, MesoSweptKind, profiles->kind_count, error);
    b->origins = MESO_NEW(arena, MesoKindOrigin, profiles->kind_count, error);
    if (!out->kinds || !b->origins)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < profiles->kind_count; k++) {
        MesoSweptKind kind = profiles->kinds[k];
        uint32_t bucket = meso_kind_bucket(&profiles->origins[k]);
        kind.instance_begin = (uint32_t)instance_count;
        kind.instance_count = b->slots->bucket_begin[bucket + 1] - b->slots->bucket_begin[bucket];
        if (kind.instance_count == 0)
            continue;
        instance_count += kind.instance_count;
        if (instance_count > UINT32_MAX / 2)
            return meso_fail(error, MESO_ERR_LIMIT, "over 2^31 sweeps; split the surface");
        b->origins[out->kind_count] = profiles->origins[k];
        out->kinds[out->kind_count++] = kind;
    }
    out->sweep_count = (uint32_t)instance_count;
    out->columns = profiles->columns;
    out->column_count = profiles->column_count;
    b->slots->origins = b->origins;
    b->slots->scene = *out;
    return MESO_OK;
}

/* For as long as sweeps are made. */
static MesoStatus measure_kinds(Builder *b, MesoArena *arena, MesoError *error)
{
    const MesoScene *scene = b->scene;
    MesoKindReach *reaches = MESO_NEW(arena, MesoKindReach, scene->kind_count, error);
    for (uint32_t k = 0; k < scene->kind_count && reaches; k++)
        reaches[k] = meso_sweep_kind_reach(scene, &scene->kinds[k]);
    b->slots->reaches = reaches;
    return reaches ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- instances ---- */

/* Where sections deform, those of all slots, by number. */
static MesoStatus make_cages(Builder *b, MesoArena *arena, MesoError *error)
{
    uint32_t count = b->model->surface.face_count;
    if (!deforms(b))
        return MESO_OK;
    b->scene->cage_count = count;
    b->scene->cages = MESO_NEW(arena, MesoCage, count, error);
    for (uint32_t slot = 0; slot < count && b->scene->cages; slot++)
        b->scene->cages[slot] = meso_shell_cage(&b->slots->shell, slot);
    return b->scene->cages ? MESO_OK : MESO_ERR_MEMORY;
}

/* Of all slots, where sections deform and a tolerance asks for it. */
static MesoStatus measure_stretch(MesoCellStretch *stretch, const MesoMapOptions *options, const MesoModel *model,
                                  MesoError *error)
{
    MesoArena scratch;
    MesoShell shell;
    *stretch = (MesoCellStretch){0, 0};
    if (options->deform == MESO_SWEEP_CURVES || options->tolerance == 0)
        return MESO_OK;
    meso_arena_init(&scratch);
    MesoStatus status = meso_model_shell(&shell, &scratch, model, error);
    for (uint32_t slot = 0; slot < model->surface.face_count && !status; slot++) {
        MesoCage cage = meso_shell_cage(&shell, slot);
        MesoCellStretch own = meso_cell_stretch(&cage);
        *stretch = (MesoCellStretch){fmaxf(stretch->most, own.most), fmaxf(stretch->bend, own.bend)};
    }
    meso_arena_release(&scratch);
    return status;
}

/* The tolerance in units of the profiles, where they are largest; 0 is none. */
static float profile_tolerance(const MesoMapOptions *options, const MesoModel *model, MesoCellStretch stretch)
{
    const MesoQuadMesh *surface = &model->surface;
    float largest = 0, mean = surface->mean_edge_length;
    if (stretch.most > 0)
        return meso_map_options_tolerance(options, mean) / (stretch.most * meso_cell_scale(options, model));
    for (uint32_t slot = 0; slot < surface->face_count && options->section_size == MESO_SECTION_SLOT; slot++)
        largest = fmaxf(largest, meso_slot_size(surface, slot));
    float size = largest > 0 && mean > 0 ? largest / mean : 1;
    return meso_map_options_tolerance(options, mean) / (options->section_scale * size);
}

static MesoColumnLimits column_limits(const MesoMapOptions *options, const MesoModel *model, MesoCellStretch stretch)
{
    float bend = BEND_SHARE * meso_map_options_tolerance(options, model->surface.mean_edge_length);
    return (MesoColumnLimits){AROUND_SHARE * profile_tolerance(options, model, stretch),
                              stretch.bend > 0 ? sqrtf(8 * bend / stretch.bend) / meso_cell_scale(options, model) : 0};
}

static void make_range(void *context, uint64_t begin, uint64_t end)
{
    Builder *b = context;
    const MesoSweptKind *kinds = b->scene->kinds;
    uint32_t kind = meso_scene_kind(b->scene, (uint32_t)begin);
    for (uint64_t i = begin; i < end; i++) {
        while (i >= (uint64_t)kinds[kind].instance_begin + kinds[kind].instance_count)
            kind++;
        if (meso_slot_sweep(b->slots, kind, (uint32_t)i, &b->scene->sweeps[i], NULL))
            meso_slot_sweeps_note(b->slots, i);
    }
}

/* Many are not stored where that is allowed, but made when they are wanted. */
static MesoStatus make_instances(Builder *b, MesoArena *arena, uint32_t thread_count, MesoError *error)
{
    if (b->stored && b->scene->sweep_count > b->stored)
        return meso_slot_sweeps_maker(b->slots, b->scene, arena, thread_count, error);
    b->scene->sweeps = MESO_NEW(arena, MesoSweepInstance, b->scene->sweep_count, error);
    if (!b->scene->sweeps)
        return MESO_ERR_MEMORY;
    atomic_store(&b->slots->failed, UINT64_MAX);
    meso_parallel_for(thread_count, b->scene->sweep_count, INSTANCES_A_RANGE, make_range, b);
    return meso_slot_sweeps_check(b->slots, error);
}

/* Kinds are cut up, then, and come from where they did. */
static MesoStatus add_crease_columns(Builder *b, MesoArena *arena, float tolerance, MesoError *error)
{
    uint32_t *from;
    MesoStatus status = meso_crease_columns(b->scene, &from, arena, CREASE_SHARE * tolerance, error);
    if (status || !from)
        return status;
    MesoKindOrigin *origins = MESO_NEW(arena, MesoKindOrigin, b->scene->kind_count, error);
    for (uint32_t k = 0; k < b->scene->kind_count && origins; k++)
        origins[k] = b->origins[from[k]];
    b->origins = origins;
    return origins ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- inner meshes ---- */

static uint32_t slots_of_tile(const Builder *b, uint32_t tile)
{
    return b->slots->bucket_begin[2 * tile + 2] - b->slots->bucket_begin[2 * tile];
}

static bool is_near(float x)
{
    return fabsf(x) <= MESO_INNER_LIMIT;    /* and a number */
}

static MesoStatus check_inner(const MesoModel *model, const MesoTile *tile, uint32_t inner, MesoError *error)
{
    const MesoInnerMesh *place = &model->tile_set.inners[inner];
    const MesoTriangleMesh *mesh = &model->inner_meshes[inner];
    MesoFrame frame;
    memcpy(frame.m, place->transform, sizeof frame.m);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 q = meso_frame_point(&frame, mesh->positions[v]);
        if (!is_near(q.x) || !is_near(q.y) || !is_near(q.z))
            return meso_fail(error, MESO_ERR_INPUT,
                             "tile '%s': vertex %u of its mesh '%s' lies more than %g tiles away",
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
            if (slots_of_tile(b, t) > 0)
                status = check_inner(b->model, &set->tiles[t], set->tiles[t].inner_begin + k, error);
    return status;
}

/* Bodies and frames are numbered as the inner meshes are. */
static MesoStatus make_bodies(Builder *b, MesoArena *arena, MesoError *error)
{
    const MesoTileSet *set = &b->model->tile_set;
    MesoScene *out = b->scene;
    out->body_count = out->frame_count = set->inner_count;
    out->bodies = MESO_NEW(arena, MesoBody, set->inner_count, error);
    out->frames = MESO_NEW(arena, MesoFrame, set->inner_count, error);
    if (!out->bodies || !out->frames)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < set->inner_count; i++) {
        const MesoTriangleMesh *mesh = &b->model->inner_meshes[i];
        out->bodies[i] = (MesoBody){.vertex_count = mesh->vertex_count, .face_count = mesh->triangle_count,
                                    .face_width = 3, .positions = mesh->positions, .normals = mesh->normals,
                                    .corners = mesh->triangles};
        memcpy(out->frames[i].m, set->inners[i].transform, sizeof out->frames[i].m);
    }
    return MESO_OK;
}

static bool is_placed(const Builder *b, uint32_t inner)
{
    return b->model->inner_meshes[inner].triangle_count > 0;
}

/* How many inner meshes of a tile have something in them. */
static uint32_t placed_of_tile(const Builder *b, const MesoTile *tile)
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < tile->inner_count; k++)
        count += is_placed(b, tile->inner_begin + k);
    return count;
}

static MesoStatus count_placed(Builder *b, MesoArena *arena, MesoError *error)
{
    const MesoTileSet *set = &b->model->tile_set;
    MesoScene *out = b->scene;
    uint64_t placed_count = 0, cage_count = 0;
    for (uint32_t t = 0; t < set->tile_count; t++) {
        uint32_t placed = placed_of_tile(b, &set->tiles[t]);
        placed_count += (uint64_t)placed * slots_of_tile(b, t);
        cage_count += placed ? slots_of_tile(b, t) : 0;
    }
    if (placed_count > UINT32_MAX / 2)
        return meso_fail(error, MESO_ERR_LIMIT, "over 2^31 inner meshes; split the surface");
    out->placed_count = (uint32_t)placed_count;
    out->placed = MESO_NEW(arena, MesoPlacedBody, placed_count, error);
    if (deforms(b))
        return out->placed ? MESO_OK : MESO_ERR_MEMORY;
    out->cage_count = (uint32_t)cage_count;
    out->cages = MESO_NEW(arena, MesoCage, cage_count, error);
    return out->placed && out->cages ? MESO_OK : MESO_ERR_MEMORY;
}

/* By inner mesh, then slot. */
static MesoStatus place_inners(Builder *b, MesoArena *arena, MesoError *error)
{
    const MesoTileSet *set = &b->model->tile_set;
    MesoStatus status = count_placed(b, arena, error);
    MesoPlacedBody *placed = b->scene->placed;
    uint32_t cage_begin = 0;
    for (uint32_t t = 0; t < set->tile_count && !status; t++) {
        const MesoTile *tile = &set->tiles[t];
        const uint32_t *slots = b->slots->bucket_slots + b->slots->bucket_begin[2 * t];
        uint32_t slot_count = placed_of_tile(b, tile) ? slots_of_tile(b, t) : 0;
        for (uint32_t i = 0; i < slot_count && !deforms(b); i++)
            b->scene->cages[cage_begin + i] = meso_shell_cage(&b->slots->shell, slots[i]);
        for (uint32_t inner = tile->inner_begin; inner < tile->inner_begin + tile->inner_count; inner++)
            for (uint32_t i = 0; i < slot_count && is_placed(b, inner); i++)
                *placed++ = (MesoPlacedBody){.body = inner, .material = set->section_count + inner,
                                             .ids = slots[i], .frame = inner,
                                             .cage = deforms(b) ? slots[i] : cage_begin + i,
                                             .place = MESO_PLACED_IN_CAGE,
                                             .turn = b->model->assignment.transform[slots[i]]};
        cage_begin += slot_count;
    }
    return status;
}

/* ---- materials and ids ---- */

/* "interface/section" and "tile/inner N": each inner mesh belongs to a tile. */
static MesoStatus make_materials(Builder *b, MesoArena *arena, MesoError *error)
{
    const MesoTileSet *set = &b->model->tile_set;
    MesoScene *out = b->scene;
    uint32_t count = out->material_count = set->section_count + set->inner_count;
    out->materials = MESO_NEW(arena, MesoMaterial, count, error);
    out->material_names = MESO_NEW(arena, const char *, count, error);
    if (!out->materials || !out->material_names)
        return MESO_ERR_MEMORY;
    bool complete = true;
    for (uint32_t i = 0; i < set->section_count; i++) {
        const MesoSection *section = &set->sections[i];
        out->materials[i] = section->material;
        out->material_names[i] = meso_arena_print(arena, error, "%s/%s", set->interfaces[section->interface].name,
                                                  section->name);
        complete = complete && out->material_names[i];
    }
    for (uint32_t t = 0; t < set->tile_count; t++)
        for (uint32_t k = 0; k < set->tiles[t].inner_count; k++) {
            uint32_t inner = set->tiles[t].inner_begin + k, material = set->section_count + inner;
            out->materials[material] = set->inners[inner].material;
            out->material_names[material] = meso_arena_print(arena, error, "%s/inner %u", set->tiles[t].name, k + 1);
            complete = complete && out->material_names[material];
        }
    return complete ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus make_ids(Builder *b, MesoArena *arena, MesoError *error)
{
    const MesoTileSet *set = &b->model->tile_set;
    const MesoAssignment *assignment = &b->model->assignment;
    MesoScene *out = b->scene;
    const char **names = MESO_NEW(arena, const char *, set->tile_count, error);
    out->channel_count = 2;
    out->channels[0] = (MesoIdChannel){"slot", assignment->slot_count, NULL};
    out->channels[1] = (MesoIdChannel){"tile", set->tile_count, names};
    out->id_row_count = assignment->slot_count;
    out->ids = MESO_NEW(arena, uint32_t, 2 * (size_t)assignment->slot_count, error);
    if (!names || !out->ids)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < set->tile_count; t++)
        names[t] = set->tiles[t].name;
    for (uint32_t s = 0; s < assignment->slot_count; s++) {
        out->ids[2 * (size_t)s] = s;
        out->ids[2 * (size_t)s + 1] = assignment->tile[s];
    }
    return MESO_OK;
}

/* ---- all of it ---- */

/* What sweeps are made by, which lives as long as the scene where that makes them. */
static MesoStatus begin_slots(Builder *b, MesoArena *arena, MesoError *error)
{
    MesoSlotSweeps *slots = b->slots = MESO_NEW(arena, MesoSlotSweeps, 1, error);
    uint32_t count = b->model->tile_set.section_count;
    MesoVec2 *centers = MESO_NEW(arena, MesoVec2, count, error);
    if (!slots || !centers)
        return MESO_ERR_MEMORY;
    if (count > 0)
        memcpy(centers, b->contours->center, count * sizeof *centers);
    slots->model = b->model;
    slots->options = b->options;
    meso_shell_cell_init(&slots->cell);
    MesoStatus status = meso_slot_sweeps_sort(slots, arena, error);
    if (!status)
        status = check_inners(b, error);
    if (!status)
        status = meso_model_shell(&slots->shell, arena, b->model, error);
    return status ? status : meso_port_finder_make(&slots->ports, arena, b->model, &slots->shell, centers, error);
}

static MesoStatus expand(Builder *b, MesoArena *arena, MesoArena *scratch, uint32_t thread_count,
                         MesoError *error)
{
    MesoProfileSet profiles;
    MesoCellStretch stretch;
    float tolerance = meso_map_options_tolerance(&b->options, b->model->surface.mean_edge_length);
    MesoStatus status = measure_stretch(&stretch, &b->options, b->model, error);
    if (!status)
        status = meso_profile_set_build(&profiles, arena, &b->model->tile_set, b->contours, b->options.divisions,
                                        column_limits(&b->options, b->model, stretch), error);
    if (!status)
        status = begin_slots(b, b->stored ? arena : scratch, error);
    if (!status)
        status = keep_used_kinds(b, &profiles, arena, error);
    if (!status)
        status = measure_kinds(b, b->stored ? arena : scratch, error);
    if (!status)
        status = make_cages(b, arena, error);
    if (!status)
        status = make_instances(b, arena, thread_count, error);
    if (!status && tolerance > 0)
        status = add_crease_columns(b, arena, tolerance, error);
    if (!status && tolerance > 0)
        status = meso_scene_choose_steps(b->scene, &b->origins, arena, tolerance, thread_count, error);
    if (!status)
        status = make_bodies(b, arena, error);
    if (!status)
        status = place_inners(b, arena, error);
    if (!status)
        status = make_materials(b, arena, error);
    if (!status)
        status = make_ids(b, arena, error);
    if (status)
        return status;
    meso_scene_measure_by(b->scene, thread_count);
    return b->scene->maker ? meso_slot_sweeps_check(b->slots, error) : MESO_OK;
}

/*
 * Of contours that columns are chosen from: what they are off the drawing, and their alignment to whole points, are
 * small parts of the tolerance.
 */
static float contour_step(const MesoMapOptions *options, const MesoModel *model, MesoCellStretch stretch)
{
    float tolerance = profile_tolerance(options, model, stretch);
    return tolerance > 0 ? fminf(fmaxf(tolerance / 2, 2e-4f), 0.02f) : options->section_step;
}

/* Of at most `stored` sweeps, if that is not 0. */
static MesoStatus expand_over(MesoScene *scene, MesoExpansion *expansion, MesoArena *arena, const MesoModel *model,
                              const MesoContourSet *contours, uint32_t stored, uint32_t thread_count, MesoError *error)
{
    MesoArena scratch;
    MesoMapOptions options = meso_map_options_resolve(model->options, model->surface.mean_edge_length);
    bool shape = options.deform == MESO_SWEEP_SHAPE, made = stored && !shape && !(options.tolerance > 0);
    Builder builder = {.scene = scene, .options = options, .contours = contours, .stored = made ? stored : 0};
    *scene = (MesoScene){.section_scale = shape ? 1 : options.section_scale, .thickness = options.thickness,
                         .frame_rule = (MesoFrameRule)options.frame, .deform = (MesoSweepDeform)options.deform};
    meso_arena_init(&scratch);
    MesoArena *kept = made ? arena : &scratch;
    MesoModel *wound = MESO_NEW(kept, MesoModel, 1, error);
    MesoStatus status = wound ? meso_model_wind(wound, model, kept, error) : MESO_ERR_MEMORY;
    builder.model = wound;
    if (!status)
        status = expand(&builder, arena, &scratch, thread_count, error);
    meso_arena_release(&scratch);
    if (expansion)
        *expansion = (MesoExpansion){options, builder.origins};
    return status;
}

MesoStatus meso_model_expand_over(MesoScene *scene, MesoExpansion *expansion, MesoArena *arena,
                                  const MesoModel *model, const MesoContourSet *contours,
                                  uint32_t thread_count, MesoError *error)
{
    return expand_over(scene, expansion, arena, model, contours, 0, thread_count, error);
}

static MesoStatus expand_anew(MesoScene *scene, MesoExpansion *expansion, MesoArena *arena, const MesoModel *model,
                              uint32_t stored, uint32_t thread_count, MesoError *error)
{
    MesoArena scratch;
    MesoContourSet contours;
    meso_arena_init(&scratch);
    MesoMapOptions options = meso_map_options_resolve(model->options, model->surface.mean_edge_length);
    MesoCellStretch stretch;
    MesoStatus status = measure_stretch(&stretch, &options, model, error);
    if (!status)
        status = meso_contour_set_build(&contours, &scratch, &model->tile_set, contour_step(&options, model, stretch),
                                        error);
    if (!status)
        status = expand_over(scene, expansion, arena, model, &contours, stored, thread_count, error);
    meso_arena_release(&scratch);
    return status;
}

MesoStatus meso_model_expand(MesoScene *scene, MesoExpansion *expansion, MesoArena *arena,
                             const MesoModel *model, uint32_t thread_count, MesoError *error)
{
    return expand_anew(scene, expansion, arena, model, 0, thread_count, error);
}

MesoStatus meso_model_expand_to_draw(MesoScene *scene, MesoArena *arena, const MesoModel *model, uint32_t stored,
                                     uint32_t thread_count, MesoError *error)
{
    return expand_anew(scene, NULL, arena, model, stored, thread_count, error);
}
