#include <string.h>

#include "formats/mesh/mesh_kinds.h"
#include "formats/mesh/obj/obj_pieces.h"

enum { MOST_ATTRIBUTES = 3 + MESO_OBJ_NAME_KINDS };

typedef struct ObjReader {
    MesoObj obj;
    MesoPolygonMesh *mesh;
    MesoArena *arena, scratch;
    uint32_t thread_count;
    uint32_t name_counts[MESO_OBJ_NAME_KINDS];
    const char **names[MESO_OBJ_NAME_KINDS];
} ObjReader;

/* ---- counting ---- */

/* Numbers in the first statement `name` of a piece; `otherwise` where there is none. */
static uint32_t numbers_in_first(const ObjReader *reader, uint32_t p, const char *name, uint32_t otherwise)
{
    const MesoTextPiece *piece = &reader->obj.text.pieces[p];
    MesoTextLine line = {.next = piece->begin};
    MesoWord word;
    uint32_t count = 0;
    do {
        if (!meso_text_line(&reader->obj.text, piece, line.next, &line))
            return otherwise;
    } while (!meso_text_word(&line, &word) || !meso_word_is(word, name));
    while (meso_text_word(&line, &word))
        count++;
    return count;
}

static MesoStatus add_up(ObjReader *reader, MesoError *error)
{
    MesoObj *obj = &reader->obj;
    for (uint32_t p = 0; p < obj->text.piece_count; p++)
        for (uint32_t k = 0; k < MESO_OBJ_COUNTS; k++) {
            obj->pieces[p].begin[k] = obj->totals[k];
            obj->totals[k] += obj->pieces[p].counts[k];
        }
    for (uint32_t k = 0; k < MESO_OBJ_COUNTS; k++)
        if (obj->totals[k] > MESO_MESH_LIMIT)
            return meso_fail(error, MESO_ERR_LIMIT, "mesh has more than %u elements of a kind", MESO_MESH_LIMIT);
    return MESO_OK;
}

static MesoStatus count(ObjReader *reader, MesoError *error)
{
    MesoObj *obj = &reader->obj;
    obj->pieces = MESO_NEW(&reader->scratch, MesoObjPiece, obj->text.piece_count, error);
    if (!obj->pieces)
        return MESO_ERR_MEMORY;
    obj->colored = obj->text.piece_count > 0 && numbers_in_first(reader, 0, "v", 6) == 6;
    meso_mesh_text_for(&obj->text, reader->thread_count, meso_obj_count, obj);
    return add_up(reader, error);
}

/* ---- room ---- */

/* Of all faces, where they have as many; else 0. */
static uint32_t common_sides(const MesoObj *obj)
{
    uint32_t least = MESO_NO_INDEX, most = 0;
    for (uint32_t p = 0; p < obj->text.piece_count; p++) {
        least = obj->pieces[p].least_sides < least ? obj->pieces[p].least_sides : least;
        most = obj->pieces[p].most_sides > most ? obj->pieces[p].most_sides : most;
    }
    return least == most ? most : 0;
}

static uint32_t texture_width(const ObjReader *reader)
{
    uint32_t p = 0;
    while (reader->obj.pieces[p].counts[MESO_OBJ_TEXTURES] == 0)
        p++;
    return numbers_in_first(reader, p, "vt", 2) > 2 ? 3 : 2;
}

/* An array of `count` in the mesh's arena; NULL, with `*failed` set, where memory is out. */
static void *room(ObjReader *reader, uint64_t elements, size_t size, bool *failed, MesoError *error)
{
    void *array = meso_arena_alloc(reader->arena, (size_t)elements, size, error);
    *failed |= array == NULL;
    return array;
}

static MesoStatus make_room(ObjReader *reader, MesoError *error)
{
    MesoObj *obj = &reader->obj;
    MesoObjArrays *arrays = &obj->arrays;
    const uint64_t *totals = obj->totals;
    uint64_t corners = totals[MESO_OBJ_CORNERS];
    bool failed = false;
    reader->mesh->side_count = common_sides(obj);
    arrays->positions = room(reader, totals[MESO_OBJ_VERTICES], sizeof(MesoVec3), &failed, error);
    if (obj->colored && totals[MESO_OBJ_COLORED] == totals[MESO_OBJ_VERTICES] && totals[MESO_OBJ_VERTICES])
        arrays->colors = room(reader, totals[MESO_OBJ_VERTICES], sizeof(MesoVec3), &failed, error);
    arrays->corners = room(reader, corners, sizeof(uint32_t), &failed, error);
    if (!reader->mesh->side_count)
        arrays->face_begin = room(reader, totals[MESO_OBJ_FACES] + 1, sizeof(uint32_t), &failed, error);
    if (totals[MESO_OBJ_NORMALS]) {
        arrays->normals = room(reader, totals[MESO_OBJ_NORMALS], sizeof(MesoVec3), &failed, error);
        arrays->normal_of = room(reader, corners, sizeof(uint32_t), &failed, error);
    }
    if (totals[MESO_OBJ_TEXTURES]) {
        arrays->texture_width = texture_width(reader);
        arrays->textures = room(reader, totals[MESO_OBJ_TEXTURES] * arrays->texture_width, sizeof(float), &failed,
                                error);
        arrays->texture_of = room(reader, corners, sizeof(uint32_t), &failed, error);
    }
    for (uint32_t k = 0; k < MESO_OBJ_NAME_KINDS; k++)
        if (reader->name_counts[k])
            arrays->name_of[k] = room(reader, totals[MESO_OBJ_FACES], sizeof(uint32_t), &failed, error);
    return failed ? MESO_ERR_MEMORY : MESO_OK;
}

/* ---- filling ---- */

static bool any_piece(const MesoObj *obj, size_t member)
{
    for (uint32_t p = 0; p < obj->text.piece_count; p++)
        if (*((const bool *)(const void *)&obj->pieces[p] + member))
            return true;
    return false;
}

static MesoStatus fill(ObjReader *reader, MesoError *error)
{
    MesoObj *obj = &reader->obj;
    meso_mesh_text_for(&obj->text, reader->thread_count, meso_obj_fill, obj);
    MesoStatus status = meso_mesh_text_status(&obj->text, error);
    if (status || !any_piece(obj, offsetof(MesoObjPiece, missing_normals)))
        return status;
    /* a file without normals whose faces use some: they are kept for the check to find the first */
    obj->arrays.normal_of = MESO_NEW(reader->arena, uint32_t, obj->totals[MESO_OBJ_CORNERS], error);
    obj->arrays.normals = MESO_NEW(reader->arena, MesoVec3, 0, error);
    if (!obj->arrays.normal_of || !obj->arrays.normals)
        return MESO_ERR_MEMORY;
    meso_mesh_text_for(&obj->text, reader->thread_count, meso_obj_fill, obj);
    return MESO_OK;
}

static void add_attribute(MesoPolygonMesh *mesh, MesoAttribute attribute)
{
    mesh->attributes[mesh->attribute_count++] = attribute;
}

static MesoStatus add_attributes(ObjReader *reader, MesoError *error)
{
    static const char *rgb[3] = {"red", "green", "blue"};
    static const char *const names[] = {
        [MESO_OBJ_GROUP] = "group", [MESO_OBJ_OBJECT] = "object", [MESO_OBJ_MATERIAL] = "material"};
    const MesoObjArrays *arrays = &reader->obj.arrays;
    const uint64_t *totals = reader->obj.totals;
    MesoPolygonMesh *mesh = reader->mesh;
    mesh->attributes = MESO_NEW(reader->arena, MesoAttribute, MOST_ATTRIBUTES, error);
    if (!mesh->attributes)
        return MESO_ERR_MEMORY;
    if (arrays->normals)
        add_attribute(mesh, (MesoAttribute){
            .name = "normal", .domain = MESO_ON_CORNERS, .width = 3, .entry_count = (uint32_t)totals[MESO_OBJ_NORMALS],
            .values = arrays->normals, .entry_of = arrays->normal_of});
    bool wrong_textures = any_piece(&reader->obj, offsetof(MesoObjPiece, wrong_textures));
    if (arrays->textures && (reader->obj.strict || !wrong_textures))
        add_attribute(mesh, (MesoAttribute){
            .name = "uv", .domain = MESO_ON_CORNERS, .width = arrays->texture_width,
            .entry_count = (uint32_t)totals[MESO_OBJ_TEXTURES], .values = arrays->textures, .entry_of = arrays->texture_of});
    if (arrays->colors)
        add_attribute(mesh, (MesoAttribute){
            .name = "color", .components = rgb, .domain = MESO_ON_VERTICES, .width = 3,
            .entry_count = (uint32_t)totals[MESO_OBJ_VERTICES], .values = arrays->colors});
    for (uint32_t k = 0; k < MESO_OBJ_NAME_KINDS; k++)
        if (arrays->name_of[k])
            add_attribute(mesh, (MesoAttribute){
                .name = names[k], .domain = MESO_ON_FACES, .entry_count = reader->name_counts[k],
                .names = reader->names[k], .entry_of = arrays->name_of[k]});
    return MESO_OK;
}

static MesoStatus finish(ObjReader *reader, MesoError *error)
{
    const MesoObj *obj = &reader->obj;
    MesoPolygonMesh *mesh = reader->mesh;
    mesh->vertex_count = (uint32_t)obj->totals[MESO_OBJ_VERTICES];
    mesh->face_count = (uint32_t)obj->totals[MESO_OBJ_FACES];
    mesh->corner_count = (uint32_t)obj->totals[MESO_OBJ_CORNERS];
    mesh->positions = obj->arrays.positions;
    mesh->corners = obj->arrays.corners;
    mesh->face_begin = obj->arrays.face_begin;
    if (mesh->face_begin)
        mesh->face_begin[mesh->face_count] = mesh->corner_count;
    return add_attributes(reader, error);
}

static MesoStatus read(ObjReader *reader, const MesoInput *input, MesoError *error)
{
    MesoStatus status = meso_mesh_text_init(&reader->obj.text, &reader->scratch, input, 0, '#', true, error);
    if (!status)
        status = count(reader, error);
    if (!status && reader->obj.totals[MESO_OBJ_NAMES])
        status = meso_obj_number_names(&reader->obj, reader->arena, &reader->scratch, reader->thread_count,
                                       reader->names, reader->name_counts, error);
    if (!status)
        status = make_room(reader, error);
    if (!status)
        status = fill(reader, error);
    return status ? status : finish(reader, error);
}

static MesoStatus read_obj(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, bool strict,
                           uint32_t thread_count, MesoError *error)
{
    ObjReader reader = {.mesh = mesh, .arena = arena, .thread_count = thread_count, .obj.strict = strict};
    *mesh = (MesoPolygonMesh){0};
    meso_arena_init(&reader.scratch);
    MesoStatus status = read(&reader, input, error);
    meso_arena_release(&reader.scratch);
    return status;
}

MesoStatus meso_obj_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                         MesoError *error)
{
    return read_obj(mesh, arena, input, false, thread_count, error);
}

MesoStatus meso_obj_read_strictly(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                                  uint32_t thread_count, MesoError *error)
{
    return read_obj(mesh, arena, input, true, thread_count, error);
}

uint32_t meso_obj_face_line(MesoArena *scratch, const MesoInput *input, uint32_t face)
{
    MesoMeshText text;
    MesoWord word;
    if (meso_mesh_text_init(&text, scratch, input, 0, '#', true, NULL))
        return 0;
    for (uint32_t p = 0; p < text.piece_count; p++) {
        const MesoTextPiece *piece = &text.pieces[p];
        MesoTextLine line = {.next = piece->begin};
        while (meso_text_line(&text, piece, line.next, &line))
            if (meso_text_word(&line, &word) && meso_word_is(word, "f") && face-- == 0)
                return meso_mesh_text_line_number(&text, meso_text_offset(piece, line.begin));
    }
    return 0;
}
