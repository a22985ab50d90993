#include "cmd/render/render_show.h"

#include <string.h>

#include "cmd/common/input_kind.h"
#include "cmd/common/scene_input.h"
#include "formats/json/json_text.h"
#include "formats/mesh/surface_read.h"
#include "formats/scene/strand/strand_scene.h"
#include "formats/tiling/result/report_slots.h"
#include "formats/tiling/result/slots_file.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/base/index.h"
#include "libcore/sketch/id_color.h"
#include "libcore/show/surface_sketch.h"

static const char ID_PREFIX[] = "id:";

/* The surface in whichever form it came. */
typedef struct Shown {
    MesoTool *tool;
    MesoSurface surface;
    MesoPolygonMesh mesh;
    const uint32_t *twin;
    const MesoModel *tiling;    /* of a model; NULL: of a mesh */
    const char *path;
} Shown;

/* ---- what there is to show ---- */

typedef struct ShowRow {
    const char *word;
    uint32_t low, high;         /* operands */
    const char *operands;
    MesoStatus (*read)(MesoRenderSource *source, MesoRenderArguments *a, const char *model, MesoError *error);
} ShowRow;

/* ---- surfaces ---- */

static MesoStatus keep_tiling(Shown *shown, const MesoModel *tiling, MesoError *error)
{
    if (!tiling)
        return meso_fail(error, MESO_ERR_INPUT, "%s: this model holds no surface of quads: give the surface itself",
                         shown->path);
    const MesoQuadMesh *quads = &tiling->surface;
    shown->tiling = tiling;
    shown->twin = tiling->graph.twin;
    shown->mesh = (MesoPolygonMesh){.vertex_count = quads->vertex_count, .face_count = quads->face_count,
                                    .corner_count = 4 * quads->face_count, .side_count = 4,
                                    .positions = quads->positions,
                                    .corners = quads->face_vertices};
    return MESO_OK;
}

static MesoStatus read_surface(Shown *shown, MesoRenderSource *source, MesoRenderArguments *a, const char *path,
                               MesoError *error)
{
    MesoTool *tool = &a->tool;
    *shown = (Shown){.tool = tool, .path = path};
    MesoStatus status = meso_tool_open_place(tool, &source->input, path, &MESO_PLACE_MODEL);
    source->open = status == MESO_OK;
    if (status)
        return status;
    if (meso_file_kind(&source->input) & (MESO_FILE_MODEL | MESO_FILE_QUILT)) {
        MesoSceneReading reading = {.thread_count = tool->threads};
        MesoScene scene;
        status = meso_scene_read(&scene, &tool->arena, &source->input, &reading, error);
        return status ? status : keep_tiling(shown, reading.tiling, error);
    }
    tool->provenance.inputs[tool->provenance.input_count - 1].role = "surface";
    status = meso_surface_read(&shown->surface, &tool->arena, &source->input, 0, tool->threads, error);
    shown->mesh = shown->surface.mesh;
    shown->twin = shown->surface.edges.twin;
    return status;
}

static MesoStatus sketch(const Shown *shown, MesoScene *scene, const MesoFaceClass *classes, uint32_t class_count,
                         const uint32_t *face_class, bool marks, MesoError *error)
{
    MesoSurfaceMarks found;
    const MesoSurfaceSketch look = {.mesh = &shown->mesh, .twin = shown->twin, .class_count = class_count,
                                    .classes = classes, .face_class = face_class, .directions = marks,
                                    .corners = marks && shown->mesh.side_count == 4};
    MesoStatus status = meso_surface_sketch(scene, &found, &shown->tool->arena, &look, error);
    if (!status && look.corners) {
        json_t *corners = json_pack("{s:I, s:I, s:I}", "of_3", (json_int_t)found.three, "of_5", (json_int_t)found.five,
                                    "others", (json_int_t)found.others);
        json_object_set_new(shown->tool->report, "singular_corners", corners);
    }
    return status;
}

static MesoStatus show_macro(MesoRenderSource *source, MesoRenderArguments *a, const char *model, MesoError *error)
{
    static const MesoFaceClass faces = {"faces", {0.62f, 0.62f, 0.6f}};
    Shown shown;
    MesoStatus status = read_surface(&shown, source, a, model, error);
    return status ? status : sketch(&shown, &source->scene, &faces, 1, NULL, true, error);
}

/* Faces by class, counted in the report. */
static MesoStatus show_classes(const Shown *shown, MesoScene *scene, const char *key, const MesoFaceClass *classes,
                               uint32_t class_count, const uint32_t *face_class, MesoError *error)
{
    json_t *counts = json_object();
    for (uint32_t i = 0; i < class_count; i++) {
        json_int_t count = 0;
        for (uint32_t f = 0; f < shown->mesh.face_count; f++)
            count += face_class[f] == i;
        json_object_set_new(counts, classes[i].name, json_integer(count));
    }
    json_object_set_new(shown->tool->report, key, counts);
    return sketch(shown, scene, classes, class_count, face_class, false, error);
}

/* ---- assignments ---- */

/* Tiles of the slots, by number, and their names. */
typedef struct Tiles {
    MesoAssignment slots;
    uint32_t count;
    const char **names;         /* [count] */
} Tiles;

static MesoStatus take_names(Tiles *tiles, const MesoTileSet *set, MesoArena *arena, MesoError *error)
{
    tiles->count = set->tile_count;
    tiles->names = MESO_NEW(arena, const char *, set->tile_count, error);
    for (uint32_t t = 0; tiles->names && t < set->tile_count; t++)
        tiles->names[t] = set->tiles[t].name;
    return tiles->names ? MESO_OK : MESO_ERR_MEMORY;
}

/* By the numbers of the set; where there is none, as the file has them. */
static MesoStatus bind_slots(Tiles *tiles, MesoSlotsFile *file, const MesoTileSet *set, MesoArena *arena,
                             MesoError *error)
{
    MesoStatus status = set ? meso_slots_bind(file, set, error) : MESO_OK;
    *tiles = (Tiles){file->assignment, file->tile_count, file->tile_names};
    return status || !set ? status : take_names(tiles, set, arena, error);
}

static MesoStatus read_slots(const Shown *shown, Tiles *tiles, const MesoTileSet *set, const char *path,
                             MesoError *error)
{
    MesoTool *tool = shown->tool;
    MesoInput input;
    MesoSlotsFile file;
    MesoStatus status = meso_tool_open_place(tool, &input, path, &MESO_PLACE_SLOTS);
    if (status)
        return status;
    status = meso_slots_read(&file, &tool->arena, &input, error);
    meso_input_close(&input);
    if (!status && file.assignment.slot_count != shown->mesh.face_count)
        return meso_fail(error, MESO_ERR_INPUT,
                         "'%s' assigns %u slots, but '%s' has %u faces: it belongs to another surface", path,
                         file.assignment.slot_count, shown->path, shown->mesh.face_count);
    if (!status && bind_slots(tiles, &file, set, &tool->arena, error))
        status = meso_fail_prefix(error, path);
    return status;
}

/* The operand TILES, where it stands before the others; else `set` gets NULL. */
static MesoStatus read_set(const MesoTileSet **set, MesoRenderArguments *a, bool given, MesoError *error)
{
    MesoTool *tool = &a->tool;
    MesoInput input;
    *set = NULL;
    MesoTileSet *read = given ? MESO_NEW(&tool->arena, MesoTileSet, 1, error) : NULL;
    if (!read)
        return given ? MESO_ERR_MEMORY : MESO_OK;
    MesoStatus status = meso_tool_open_place(tool, &input, tool->operands[0], &MESO_PLACE_TILES);
    if (status)
        return status;
    status = meso_tiles_read(read, &tool->arena, &input, error);
    meso_input_close(&input);
    *set = read;
    return status;
}

static MesoStatus read_model_tiles(const Shown *shown, Tiles *tiles, MesoError *error)
{
    if (!shown->tiling)
        return meso_fail(error, MESO_ERR_USAGE,
                         "--show tiles takes a MODEL of tiles, or SURFACE SLOTS: '%s' is a mesh", shown->path);
    tiles->slots = shown->tiling->assignment;
    return take_names(tiles, &shown->tiling->tile_set, &shown->tool->arena, error);
}

static MesoStatus show_tiles(MesoRenderSource *source, MesoRenderArguments *a, const char *model, MesoError *error)
{
    Shown shown;
    Tiles tiles;
    const MesoTileSet *set;
    uint32_t operands = a->tool.operand_count;
    MesoStatus status = read_set(&set, a, operands == 3, error);
    if (!status)
        status = read_surface(&shown, source, a, model, error);
    if (!status)
        status = operands == 1 ? read_model_tiles(&shown, &tiles, error)
                               : read_slots(&shown, &tiles, set, a->tool.operands[operands - 1], error);
    MesoFaceClass *classes = status ? NULL : MESO_NEW(&a->tool.arena, MesoFaceClass, tiles.count, error);
    if (!classes)
        return status ? status : MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < tiles.count; t++) {
        classes[t].name = tiles.names[t];
        meso_id_color(classes[t].color, t);
    }
    return show_classes(&shown, &source->scene, "tiles", classes, tiles.count, tiles.slots.tile, error);
}

static MesoStatus show_difference(MesoRenderSource *source, MesoRenderArguments *a, const char *model, MesoError *error)
{
    enum { SAME, TURNED, OTHER, CLASSES };
    static const MesoFaceClass classes[CLASSES] = {
        [SAME] = {"same", {0.62f, 0.62f, 0.6f}}, [TURNED] = {"turned", {0.85f, 0.42f, 0.02f}},
        [OTHER] = {"other tile", {0.7f, 0.03f, 0.03f}}};
    Shown shown;
    Tiles tiles[2];
    const MesoTileSet *set;
    uint32_t operands = a->tool.operand_count;
    MesoStatus status = read_set(&set, a, operands == 4, error);
    if (!status)
        status = read_surface(&shown, source, a, model, error);
    for (uint32_t i = 0; i < 2 && !status; i++)
        status = read_slots(&shown, &tiles[i], set, a->tool.operands[operands - 2 + i], error);
    uint32_t *face_class = status ? NULL : MESO_NEW(&a->tool.arena, uint32_t, shown.mesh.face_count, error);
    if (!face_class)
        return status ? status : MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < shown.mesh.face_count; f++) {
        const char *names[2] = {tiles[0].names[tiles[0].slots.tile[f]], tiles[1].names[tiles[1].slots.tile[f]]};
        bool turned = tiles[0].slots.transform[f] != tiles[1].slots.transform[f];
        face_class[f] = strcmp(names[0], names[1]) != 0 ? OTHER : turned ? TURNED : SAME;
    }
    return show_classes(&shown, &source->scene, "difference", classes, CLASSES, face_class, error);
}

/* ---- failures ---- */

static MesoStatus show_failures(MesoRenderSource *source, MesoRenderArguments *a, const char *model, MesoError *error)
{
    enum { SOUND, FEW, SOME, MANY, CORE, CLASSES };
    static const MesoFaceClass classes[CLASSES] = {
        [SOUND] = {"no dead ends", {0.62f, 0.62f, 0.6f}}, [FEW] = {"few dead ends", {0.85f, 0.65f, 0.2f}},
        [SOME] = {"some dead ends", {0.85f, 0.3f, 0.02f}}, [MANY] = {"most dead ends", {0.6f, 0.02f, 0.02f}},
        [CORE] = {"core", {0.3f, 0.0f, 0.35f}}};
    static const MesoInputPlace place = {"--report", "a report of meso-solve", "report",
                                         MESO_FILE_REPORT | MESO_FILE_JSON};
    Shown shown;
    MesoInput input;
    MesoReportSlots report = {0};
    MesoStatus status = read_surface(&shown, source, a, model, error);
    if (!status)
        status = meso_tool_open_place(&a->tool, &input, a->report, &place);
    if (status)
        return status;
    status = meso_report_slots_read(&report, &a->tool.arena, &input, shown.mesh.face_count, error);
    meso_input_close(&input);
    uint32_t *face_class = status ? NULL : MESO_NEW(&a->tool.arena, uint32_t, shown.mesh.face_count, error);
    if (!face_class)
        return status ? status : MESO_ERR_MEMORY;
    uint32_t most = 0;
    for (uint32_t f = 0; f < report.slot_count; f++)
        most = report.dead_ends[f] > most ? report.dead_ends[f] : most;
    for (uint32_t f = 0; f < report.slot_count; f++) {
        uint64_t met = report.dead_ends[f];
        face_class[f] = report.in_core[f] ? CORE : met == 0 ? SOUND : 4 * met <= most ? FEW
                      : 2 * met <= most ? SOME : MANY;
    }
    return show_classes(&shown, &source->scene, "failures", classes, CLASSES, face_class, error);
}

/* ---- ids ---- */

static MesoStatus number_strands(MesoRenderSource *source, MesoArena *arena, MesoError *error)
{
    MesoStrands strands;
    MesoScene numbered;
    MesoStatus status = meso_strands_find(&strands, arena, &source->scene, error);
    if (!status)
        status = meso_strand_scene_number(&numbered, arena, &source->scene, &strands, error);
    if (!status)
        source->scene = numbered;
    return status;
}

/* "strand" is found where the model does not say it. */
static MesoStatus show_ids(MesoRenderSource *source, MesoRenderArguments *a, const char *model, MesoError *error)
{
    const char *name = strcmp(a->show, "strands") == 0 ? "strand" : a->show + strlen(ID_PREFIX);
    MesoSceneReading reading = {.thread_count = a->tool.threads};
    MesoScene *scene = &source->scene;
    MesoStatus status = meso_tool_read_scene(&a->tool, scene, &source->input, model, &reading);
    source->open = status == MESO_OK;
    if (!status && strcmp(name, "strand") == 0)
        status = number_strands(source, &a->tool.arena, error);
    char known[MESO_ID_CHANNELS * (MESO_CHANNEL_NAME + 2) + 8] = "";
    for (uint32_t c = 0; c < scene->channel_count && !status; c++) {
        if (strcmp(scene->channels[c].name, name) == 0) {
            source->color_channel = c;
            return MESO_OK;
        }
        strcat(strcat(known, c ? ", " : ""), scene->channels[c].name);
    }
    return status ? status : meso_fail(error, MESO_ERR_USAGE, "--show %s: '%s' has no such ids; it has %s", a->show,
                                       model,
                                       *known ? known : "none");
}

/* ---- all of them ---- */

static const ShowRow ROWS[] = {
    {"macro", 1, 1, "SURFACE, or a MODEL of tiles", show_macro},
    {"failures", 1, 1, "SURFACE, and --report", show_failures},
    {"tiles", 1, 3, "a MODEL of tiles, or [TILES] SURFACE SLOTS", show_tiles},
    {"difference", 3, 4, "[TILES] SURFACE SLOTS SLOTS", show_difference},
    {"strands", 1, 1, "MODEL", show_ids},
    {"id:NAME", 1, 1, "MODEL", show_ids},
};
enum { ROW_COUNT = sizeof ROWS / sizeof *ROWS };

static const ShowRow *find_row(const char *word)
{
    if (strncmp(word, ID_PREFIX, strlen(ID_PREFIX)) == 0 && word[strlen(ID_PREFIX)])
        word = "id:NAME";
    for (uint32_t i = 0; i < ROW_COUNT; i++)
        if (strcmp(ROWS[i].word, word) == 0)
            return &ROWS[i];
    return NULL;
}

MesoStatus meso_render_show_check(const MesoRenderArguments *a, MesoError *error)
{
    const ShowRow *row = find_row(a->show);
    bool failures = strcmp(a->show, "failures") == 0;
    if (!row)
        return meso_fail(error, MESO_ERR_USAGE,
                         "--show '%s' is none of macro, failures, tiles, difference, strands, id:NAME",
                         a->show);
    if (a->tool.operand_count < row->low || a->tool.operand_count > row->high)
        return meso_fail(error, MESO_ERR_USAGE, "--show %s takes %s", a->show, row->operands);
    if (failures != (a->report != NULL))
        return meso_fail(error, MESO_ERR_USAGE, failures ? "--show failures takes --report, of meso-solve"
                                                         : "--report is for --show failures");
    return MESO_OK;
}

uint32_t meso_render_show_surface(const MesoRenderArguments *a)
{
    const ShowRow *row = find_row(a->show);
    return row->high > 1 && a->tool.operand_count == row->high;
}

MesoStatus meso_render_show_read(MesoRenderSource *source, MesoRenderArguments *a, const char *model, MesoError *error)
{
    return find_row(a->show)->read(source, a, model, error);
}
