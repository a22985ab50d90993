#include "cmd/info/info_describe.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cmd/common/scene_report.h"
#include "cmd/info/info_decor.h"
#include "cmd/info/info_replicate.h"
#include "formats/json/json_text.h"
#include "formats/mesh/mesh_read.h"
#include "formats/mesh/surface_read.h"
#include "formats/model/model_body.h"
#include "formats/model/model_file.h"
#include "formats/model/model_mapping.h"
#include "formats/model/model_scene.h"
#include "formats/tiling/constraints/constraints_file.h"
#include "formats/tiling/result/report_file.h"
#include "formats/tiling/result/seed_lines.h"
#include "formats/tiling/result/slots_file.h"
#include "formats/tiling/tiles/prototype_json.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/math/box.h"
#include "libcore/mesh/slot_graph.h"
#include "libcore/scene/parts.h"

static MesoStatus memory_if(int failed, MesoError *error)
{
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory") : MESO_OK;
}

static int put_count(json_t *object, const char *key, uint64_t count)
{
    return json_object_set_new(object, key, json_integer((json_int_t)count));
}

static int put_number(json_t *object, const char *key, float value)
{
    return json_object_set_new(object, key, meso_json_shortest(value));
}

static int put_point(json_t *object, const char *key, MesoVec3 point)
{
    json_t *list = json_array();
    int failed = json_array_append_new(list, meso_json_shortest(point.x));
    failed |= json_array_append_new(list, meso_json_shortest(point.y));
    failed |= json_array_append_new(list, meso_json_shortest(point.z));
    return failed | json_object_set_new(object, key, list);
}

static int put_hash(json_t *object, const char *key, const uint64_t hash[2])
{
    char text[33];
    snprintf(text, sizeof text, "%016" PRIx64 "%016" PRIx64, hash[0], hash[1]);
    return json_object_set_new(object, key, json_string(text));
}

/* `text` has been checked by its reader. */
static int put_provenance(json_t *facts, const char *text)
{
    MesoInput input;
    json_t *root;
    meso_input_wrap(&input, "provenance", text, strlen(text));
    meso_json_parse(&root, &input, NULL);
    return json_object_set_new(facts, "provenance", root);
}

/* How many slots hold each tile and each transform. `names` [tile_count]. */
static MesoStatus put_histograms(json_t *facts, MesoArena *arena, const MesoAssignment *assignment,
                                 uint32_t tile_count, const char *const *names, MesoError *error)
{
    uint64_t transforms[MESO_TRANSFORM_COUNT] = {0};
    uint64_t *tiles = MESO_NEW(arena, uint64_t, tile_count, error);
    if (!tiles)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < assignment->slot_count; i++) {
        tiles[assignment->tile[i]]++;
        transforms[assignment->transform[i]]++;
    }
    json_t *by_tile = json_object(), *by_transform = json_array();
    int failed = 0;
    for (uint32_t i = 0; i < tile_count; i++) {
        json_t *name = meso_json_string(names[i]);
        failed |= !name || put_count(by_tile, json_string_value(name), tiles[i]);
        json_decref(name);
    }
    for (uint32_t i = 0; i < MESO_TRANSFORM_COUNT; i++)
        failed |= json_array_append_new(by_transform, json_integer((json_int_t)transforms[i]));
    failed |= json_object_set_new(facts, "tiles", by_tile);
    failed |= json_object_set_new(facts, "transforms", by_transform);
    return memory_if(failed, error);
}

/* How many slots start at each corner of their face. */
static int put_orientation(json_t *facts, const MesoSlotsFile *slots)
{
    uint64_t counts[4] = {0};
    for (uint32_t i = 0; i < slots->assignment.slot_count; i++)
        counts[slots->quarters[i]]++;
    json_t *list = json_array();
    int failed = 0;
    for (uint32_t i = 0; i < 4; i++)
        failed |= json_array_append_new(list, json_integer((json_int_t)counts[i]));
    return failed | json_object_set_new(facts, "orientation", list);
}

static int put_turned_over(json_t *facts, const MesoSlotsFile *slots)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < slots->assignment.slot_count; i++)
        count += slots->over[i];
    return put_count(facts, "faces_turned_over", count);
}

MesoStatus meso_info_slots(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoSlotsFile slots;
    MesoStatus status = meso_slots_read(&slots, arena, input, error);
    if (status)
        return status;
    bool listing = !meso_container_recognise(input);
    json_t *inputs = json_object();
    int failed = put_hash(inputs, "tiles", slots.tiles_hash);
    failed |= put_hash(inputs, "surface", slots.surface_hash);
    if (!listing)
        failed |= put_provenance(facts, slots.provenance);
    if (!slots.anonymous)
        failed |= json_object_set(facts, "inputs", inputs);
    json_decref(inputs);
    failed |= put_count(facts, "slots", slots.assignment.slot_count);
    failed |= slots.quarters && put_orientation(facts, &slots);
    failed |= slots.over && put_turned_over(facts, &slots);
    status = memory_if(failed, error);
    return status ? status : put_histograms(facts, arena, &slots.assignment, slots.tile_count,
                                            slots.tile_names, error);
}

/* "a", "a'" where flipped, null where the side shows nothing. */
static json_t *label_text(const MesoTileSet *set, int32_t label)
{
    return label == 0 ? json_null()
                      : json_sprintf("%s%s", set->interfaces[meso_label_interface(label)].name,
                                     meso_label_mark(label));
}

static json_t *interface_json(const MesoTileSet *set, uint32_t i)
{
    const MesoInterface *interface = &set->interfaces[i];
    const char *border = interface->border_exempt ? "exempt" : interface->border_only ? "only" : "any";
    json_t *object = json_object(), *sections = json_array();
    int failed = json_object_set_new(object, "name", json_string(interface->name));
    for (uint32_t s = 0; s < interface->section_count; s++)
        failed |= json_array_append_new(
            sections, json_string(set->sections[interface->section_begin + s].name));
    failed |= json_object_set_new(object, "border", json_string(border));
    failed |= json_object_set_new(object, "sections", sections);
    if (failed)
        json_decref(object);
    return failed ? NULL : object;
}

static json_t *tile_json(const MesoTileSet *set, uint32_t t)
{
    const MesoTile *tile = &set->tiles[t];
    json_t *object = json_object(), *sides = json_array();
    int failed = json_object_set_new(object, "name", json_string(tile->name));
    for (uint32_t k = 0; k < tile->side_count; k++)
        failed |= json_array_append_new(sides, label_text(set, tile->labels[k]));
    failed |= json_object_set_new(object, "sides", sides);
    failed |= put_count(object, "sweeps", tile->sweep_count);
    failed |= put_count(object, "inner", tile->inner_count);
    uint32_t allowed = 0;
    for (uint32_t transform = 0; transform < MESO_TRANSFORM_COUNT; transform++)
        allowed += meso_tile_allows(tile, (MesoTransform)transform);
    failed |= put_count(object, "transforms", allowed);
    if (tile->ignored)
        failed |= json_object_set_new(object, "ignored", json_true());
    if (failed)
        json_decref(object);
    return failed ? NULL : object;
}

static MesoStatus put_tile_set(json_t *facts, MesoArena *arena, const MesoTileSet *set,
                               MesoError *error)
{
    MesoVariantSet variants;
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoStatus status = meso_variant_set_build(&variants, arena, set, error);
    meso_arena_rewind(arena, mark);
    if (status)
        return status;
    json_t *summary = json_object(), *interfaces = json_array(), *tiles = json_array();
    int failed = put_count(summary, "sections", set->section_count);
    failed |= put_count(summary, "sweeps", set->sweep_count);
    failed |= put_count(summary, "inner", set->inner_count);
    failed |= put_count(summary, "variants", variants.count);
    for (uint32_t i = 0; i < set->interface_count; i++)
        failed |= json_array_append_new(interfaces, interface_json(set, i));
    for (uint32_t t = 0; t < set->tile_count; t++)
        failed |= json_array_append_new(tiles, tile_json(set, t));
    failed |= json_object_set_new(summary, "interfaces", interfaces);
    failed |= json_object_set_new(summary, "tiles", tiles);
    failed |= json_object_set_new(facts, "tile_set", summary);
    return memory_if(failed, error);
}

static int put_bounds(json_t *facts, uint32_t count, const MesoVec3 *positions)
{
    json_t *bounds = json_object();
    MesoBox box = meso_box_of(positions, count);
    int failed = 0;
    if (count > 0) {
        failed |= put_point(bounds, "low", box.low);
        failed |= put_point(bounds, "high", box.high);
    }
    return failed | json_object_set_new(facts, "bounds", bounds);
}

static MesoStatus put_surface(json_t *facts, MesoArena *arena, const MesoQuadMesh *mesh, const MesoSlotGraph *graph,
                              MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(arena);
    uint32_t *component = MESO_NEW(arena, uint32_t, graph->slot_count, error);
    if (!component)
        return MESO_ERR_MEMORY;
    uint32_t components = meso_slot_graph_components(graph, component);
    meso_arena_rewind(arena, mark);
    int failed = put_count(facts, "vertices", mesh->vertex_count);
    failed |= put_count(facts, "faces", mesh->face_count);
    failed |= put_count(facts, "edges", graph->edge_count);
    failed |= put_count(facts, "border_edges", graph->border_count);
    failed |= put_count(facts, "reversed_edges", graph->reversed_count);
    failed |= put_count(facts, "components", components);
    failed |= put_number(facts, "mean_edge_length", mesh->mean_edge_length);
    failed |= put_bounds(facts, mesh->vertex_count, mesh->positions);
    return memory_if(failed, error);
}

static int put_options(json_t *facts, const MesoMapOptions *options)
{
    json_t *object = json_object();
    int failed = put_number(object, "thickness", options->thickness);
    failed |= put_number(object, "offset", options->offset);
    failed |= put_number(object, "section_scale", options->section_scale);
    failed |= put_number(object, "tangent_scale", options->tangent_scale);
    failed |= put_number(object, "section_step", options->section_step);
    failed |= put_count(object, "divisions", options->divisions);
    failed |= meso_mapping_to_json(object, options);
    return failed | json_object_set_new(facts, "options", object);
}

/* How many joints a relaxation has moved. */
static int put_joints(json_t *facts, const MesoModel *model)
{
    static const MesoJointMove still;
    uint64_t moved = 0;
    for (uint32_t j = 0; j < model->joint_count; j++)
        moved += memcmp(&model->joints[j], &still, sizeof still) != 0;
    return model->joints ? put_count(facts, "moved_joints", moved) : 0;
}

static int put_inners(json_t *facts, const MesoModel *model)
{
    uint64_t vertices = 0, triangles = 0;
    json_t *object = json_object();
    for (uint32_t i = 0; i < model->tile_set.inner_count; i++) {
        vertices += model->inner_meshes[i].vertex_count;
        triangles += model->inner_meshes[i].triangle_count;
    }
    int failed = put_count(object, "meshes", model->tile_set.inner_count);
    failed |= put_count(object, "vertices", vertices);
    failed |= put_count(object, "triangles", triangles);
    return failed | json_object_set_new(facts, "inner_meshes", object);
}

static MesoStatus put_body_model(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoScene scene;
    MesoSceneParts parts;
    MesoSceneReading reading = {0};
    MesoStatus status = meso_scene_read(&scene, arena, input, &reading, error);
    if (!status)
        status = meso_scene_parts_init(&parts, arena, &scene, error);
    if (status)
        return status;
    const MesoVec3 ends[2] = {scene.box.low, scene.box.high};
    int failed = put_provenance(facts, reading.provenance);
    meso_scene_report_ids(facts, &scene);
    failed |= put_count(facts, "bodies", parts.part_count);
    failed |= put_count(facts, "materials", scene.material_count);
    failed |= put_count(facts, "vertices", parts.vertex_begin[parts.part_count]);
    failed |= put_count(facts, "faces", parts.face_begin[parts.part_count]);
    failed |= put_count(facts, "triangles", parts.triangle_count);
    failed |= put_bounds(facts, parts.part_count ? 2 : 0, ends);
    return memory_if(failed, error);
}

/* Of tiles, or of another method: the second has its own facts. */
MesoStatus meso_info_model(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    if (meso_model_has_body(input))
        return put_body_model(facts, arena, input, error);
    MesoModel model;
    const char *provenance;
    MesoStatus status = meso_model_read(&model, &provenance, arena, input, error);
    if (status)
        return status;
    const char **names = MESO_NEW(arena, const char *, model.tile_set.tile_count, error);
    if (!names)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < model.tile_set.tile_count; i++)
        names[i] = model.tile_set.tiles[i].name;

    json_t *surface = json_object();
    int failed = put_provenance(facts, provenance);
    failed |= put_options(facts, &model.options);
    failed |= put_count(facts, "slots", model.assignment.slot_count);
    failed |= json_object_set_new(facts, "surface", surface);
    failed |= put_inners(facts, &model);
    failed |= put_joints(facts, &model);
    status = memory_if(failed, error);
    if (!status)
        status = put_surface(surface, arena, &model.surface, &model.graph, error);
    if (!status)
        status = put_histograms(facts, arena, &model.assignment, model.tile_set.tile_count, names, error);
    return status ? status : put_tile_set(facts, arena, &model.tile_set, error);
}

/* A macrosurface; where it is none, any polygon mesh will do. The error is the first one's. */
MesoStatus meso_info_mesh(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoPolygonMesh mesh;
    MesoQuadSurface quads;
    MesoTriangleMesh triangles;
    MesoStatus status = meso_polygon_mesh_read(&mesh, arena, input, 0, error);
    if (status)
        return status;
    status = meso_quad_surface_make(&quads, arena, &mesh, input, 0, error);
    if (!status) {
        int failed = json_object_set_new(facts, "kind", json_string("surface"));
        return failed ? memory_if(failed, error) : put_surface(facts, arena, &quads.mesh, &quads.graph, error);
    }
    if (status == MESO_ERR_MEMORY || meso_polygon_triangulate(&triangles, arena, &mesh, NULL))
        return status;
    int failed = json_object_set_new(facts, "kind", json_string("mesh"));
    failed |= json_object_set_new(facts, "surface", json_false());
    failed |= json_object_set_new(facts, "reason", meso_json_string(error->message));
    failed |= put_count(facts, "vertices", triangles.vertex_count);
    failed |= put_count(facts, "triangles", triangles.triangle_count);
    failed |= put_bounds(facts, triangles.vertex_count, triangles.positions);
    return memory_if(failed, error);
}

static MesoStatus put_report(json_t *facts, json_t *root, const char *path, MesoError *error)
{
    MesoStatus status = meso_json_check_format(root, path, "meso-report", 1, error);
    if (status)
        return status;
    if (!json_is_string(json_object_get(root, "tool")))
        return meso_fail(error, MESO_ERR_INPUT, "%s: the report names no \"tool\"", path);
    int failed = json_object_set_new(facts, "kind", json_string("report"));
    failed |= json_object_set(facts, "report", root);
    return memory_if(failed, error);
}

/* What can be said without the tile set and the surface that they are for. */
static MesoStatus put_constraints(json_t *facts, MesoArena *arena, json_t *root, const char *path, MesoError *error)
{
    MesoConstraintOutline outline;
    MesoStatus status = meso_constraints_outline(&outline, arena, root, path, error);
    if (status)
        return status;
    json_t *provenance = json_object_get(root, "provenance");
    int failed = json_object_set_new(facts, "kind", json_string("constraints"));
    if (provenance)
        failed |= json_object_set(facts, "provenance", provenance);
    failed |= put_count(facts, "weights", outline.weight_count);
    failed |= put_count(facts, "pins", outline.pin_count);
    failed |= put_count(facts, "regions", outline.region_count);
    failed |= put_count(facts, "borders", outline.border_count);
    failed |= put_count(facts, "quotas", outline.quota_count);
    if (json_object_get(root, "strands"))
        failed |= json_object_set(facts, "strands", json_object_get(root, "strands"));
    return memory_if(failed, error);
}

static MesoStatus put_tiles(json_t *facts, MesoArena *arena, const json_t *root,
                            const MesoInput *input, MesoError *error)
{
    MesoTileSet set;
    json_t *provenance = json_object_get(root, "provenance");
    const char *origin = meso_prototype_recognise(root) ? "prototype" : "meso";
    MesoStatus status = meso_tiles_read(&set, arena, input, error);
    if (status)
        return status;
    int failed = json_object_set_new(facts, "kind", json_string("tiles"));
    failed |= json_object_set_new(facts, "origin", json_string(origin));
    if (provenance)
        failed |= json_object_set(facts, "provenance", provenance);
    return failed ? memory_if(failed, error) : put_tile_set(facts, arena, &set, error);
}

MesoStatus meso_info_json(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    json_t *root;
    MesoStatus status = meso_json_parse(&root, input, error);
    if (status)
        return status;
    const char *format = json_string_value(json_object_get(root, "format"));
    if (format && strcmp(format, "meso-report") == 0)
        status = put_report(facts, root, input->path, error);
    else if (format && strcmp(format, "meso-constraints") == 0)
        status = put_constraints(facts, arena, root, input->path, error);
    else if (format && meso_info_decor(facts, format, root, input->path, &status, error))
        ;
    else if (format && meso_info_replicate(facts, arena, format, root, input, &status, error))
        ;
    else if ((format && strcmp(format, "meso-tiles") == 0) || meso_prototype_recognise(root))
        status = put_tiles(facts, arena, root, input, error);
    else
        status = meso_fail(error, MESO_ERR_INPUT,
                           "%s: neither a tile set, constraints, a report, a pattern, macros, regions, details nor "
                           "deformations; the suite knows no other JSON",
                           input->path);
    json_decref(root);
    return status;
}

static int compare_hashes(const void *a, const void *b)
{
    return memcmp(a, b, 2 * sizeof(uint64_t));
}

/* How many of the hashes differ; they become sorted. */
static uint32_t count_different(uint64_t (*hashes)[2], uint32_t count)
{
    uint32_t different = count > 0;
    qsort(hashes, count, sizeof *hashes, compare_hashes);
    for (uint32_t i = 1; i < count; i++)
        different += compare_hashes(hashes[i - 1], hashes[i]) != 0;
    return different;
}

MesoStatus meso_info_seed_lines(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoSeedLine *lines;
    uint32_t count, solved = 0, verdicts[MESO_VERDICT_GAVE_UP + 1] = {0};
    MesoStatus status = meso_seed_lines_read(&lines, &count, arena, input, NULL, 0, error);
    uint64_t (*hashes)[2] = status ? NULL : meso_arena_alloc(arena, count, 2 * sizeof **hashes, error);
    uint64_t (*problems)[2] = hashes ? meso_arena_alloc(arena, count, 2 * sizeof **problems, error) : NULL;
    if (!problems)
        return status ? status : MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        verdicts[lines[i].verdict]++;
        memcpy(problems[i], lines[i].problem, sizeof *problems);
        if (lines[i].verdict == MESO_VERDICT_SOLVED)
            memcpy(hashes[solved++], lines[i].assignment, sizeof *hashes);
    }
    json_t *by_verdict = json_object();
    int failed = json_object_set_new(facts, "kind", json_string("seeds"));
    failed |= put_count(facts, "seeds", count);
    if (count > 0) {
        failed |= put_count(facts, "first", lines[0].seed);
        failed |= put_count(facts, "last", lines[count - 1].seed);
    }
    for (int v = 0; v <= MESO_VERDICT_GAVE_UP; v++)
        failed |= put_count(by_verdict, meso_verdict_name((MesoVerdict)v), verdicts[v]);
    failed |= json_object_set_new(facts, "verdicts", by_verdict);
    failed |= put_count(facts, "assignments", count_different(hashes, solved));
    failed |= put_count(facts, "problems", count_different(problems, count));
    return memory_if(failed, error);
}
