/* OBJ, as in Wavefront's "Object Files", appendix B1 of the Advanced Visualizer Manual. */
#include <string.h>

#include "formats/mesh_scan.h"
#include "formats/mesh_text.h"

typedef struct ObjScan {
    MesoMeshScan *scan;
    MesoMeshText *text;
    MesoGroupsBuilder *groups;  /* or NULL */
} ObjScan;

static bool wants_textures(const ObjScan *obj)
{
    return obj->groups && obj->groups->textures;
}

/* What is neither vertex nor face, and says nothing about the shape of the faces. */
static const char *const passed_over[] = {
    "vt", "vp", "g", "o", "s", "mg", "usemtl", "mtllib", "usemap", "maplib", "l", "p",
    "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj",
};

static bool is_passed_over(MesoWord word)
{
    for (size_t i = 0; i < sizeof passed_over / sizeof *passed_over; i++)
        if (meso_word_is(word, passed_over[i]))
            return true;
    return false;
}

static void blank(char *begin, char *end)
{
    memset(begin, ' ', (size_t)(end - begin));
}

/* Three numbers; a weight or a colour may follow, and is blanked out. `colour` has 3 and a 1 where it is there. */
static MesoStatus read_point(const ObjScan *obj, const char *what, MesoVec3 *point, float colour[4],
                             MesoError *error)
{
    float *numbers[6] = {&point->x, &point->y, &point->z, colour, colour + 1, colour + 2}, ignored;
    MesoWord word;
    uint32_t count = 0;
    char *behind = NULL;
    for (; meso_mesh_text_word(obj->text, &word); count++) {
        MesoStatus status = meso_word_number(obj->text, word, what, count < 6 ? numbers[count] : &ignored, error);
        if (status)
            return status;
        if (count == 2)
            behind = obj->text->at;
    }
    if (count < 3)
        return meso_mesh_text_fail(obj->text, error, "%s has %u numbers instead of 3", what, count);
    blank(behind, obj->text->end);
    colour[3] = count == 6;
    return MESO_OK;
}

typedef struct ObjIndex {
    MesoWord word;
    int64_t value;
} ObjIndex;

/* Index from 1, or from -1 downwards for the last one so far, to an index from 0. */
static MesoStatus resolve(const ObjScan *obj, ObjIndex as_written, uint32_t so_far, const char *what,
                          uint32_t *index, MesoError *error)
{
    int64_t given = as_written.value;
    if (given == 0)
        return meso_mesh_text_fail(obj->text, error, "%s index is 0; indices start at 1", what);
    if (given < -(int64_t)so_far)
        return meso_mesh_text_fail(obj->text, error, "%s index %.*s goes back beyond the first of %u",
                                   what, MESO_WORD_ARGUMENTS(as_written.word), so_far);
    if (given >= UINT32_MAX)
        return meso_mesh_text_fail(obj->text, error, "%s index %.*s is too large", what,
                                   MESO_WORD_ARGUMENTS(as_written.word));
    *index = (uint32_t)(given < 0 ? so_far + given : given - 1);
    return MESO_OK;
}

typedef struct ObjCorner {
    ObjIndex vertex, texture, normal;
    bool has_texture, has_normal;
} ObjCorner;

static bool read_index(ObjIndex *index, char *begin, const char *end)
{
    index->word = (MesoWord){begin, (size_t)(end - begin)};
    return meso_word_integer(index->word, &index->value);
}

/* Splits "v", "v/vt", "v//vn" or "v/vt/vn"; false where it is none of them. */
static bool split_corner(MesoWord word, ObjCorner *corner)
{
    *corner = (ObjCorner){0};
    char *end = word.text + word.size;
    char *slash = memchr(word.text, '/', word.size);
    if (!read_index(&corner->vertex, word.text, slash ? slash : end))
        return false;
    if (!slash)
        return true;

    char *second = memchr(slash + 1, '/', (size_t)(end - slash - 1));
    const char *middle = second ? second : end;
    corner->has_texture = middle > slash + 1;
    if (corner->has_texture && !read_index(&corner->texture, slash + 1, middle))
        return false;
    if (!second || second + 1 == end)
        return true;
    corner->has_normal = true;
    return read_index(&corner->normal, second + 1, end);
}

/* Unlike vertices and normals, coordinates that nobody asks for need not be there. */
static MesoStatus keep_texture(const ObjScan *obj, const ObjCorner *corner, MesoError *error)
{
    uint32_t texture = MESO_NO_INDEX;
    MesoStatus status = MESO_OK;
    if (corner->has_texture)
        status = resolve(obj, corner->texture, obj->groups->texture_count, "texture coordinate", &texture, error);
    return status ? status : meso_groups_corner_texture(obj->groups, texture, error);
}

static MesoStatus read_corner(const ObjScan *obj, MesoWord word, MesoError *error)
{
    ObjCorner corner;
    if (!split_corner(word, &corner))
        return meso_mesh_text_fail(obj->text, error, "face corner '%.*s' is not v, v/vt, v//vn or v/vt/vn",
                                   MESO_WORD_ARGUMENTS(word));
    uint32_t vertex = MESO_NO_INDEX, normal = MESO_NO_INDEX;
    MesoStatus status = resolve(obj, corner.vertex, obj->scan->vertex_count, "vertex", &vertex, error);
    if (!status && corner.has_normal)
        status = resolve(obj, corner.normal, obj->scan->normal_count, "normal", &normal, error);
    if (!status && wants_textures(obj))
        status = keep_texture(obj, &corner, error);
    if (status)
        return status;
    obj->scan->relative |= corner.vertex.value < 0;
    char *slash = memchr(word.text, '/', word.size);
    if (slash)
        blank(slash, word.text + word.size);
    return meso_mesh_scan_corner(obj->scan, vertex, normal, error);
}

static MesoStatus read_face(const ObjScan *obj, MesoError *error)
{
    MesoWord word;
    MesoStatus status = MESO_OK;
    while (!status && meso_mesh_text_word(obj->text, &word))
        status = read_corner(obj, word, error);
    if (!status && obj->groups)
        status = meso_groups_face(obj->groups, error);
    return status ? status : meso_mesh_scan_face(obj->scan, obj->text->line, error);
}

/* The names of a `g`, `o` or `usemtl`: the words behind it, with one blank between each two. */
static MesoStatus read_names(const ObjScan *obj, MesoWord statement, MesoError *error)
{
    static const char *const statements[] = {
        [MESO_GROUP_GROUP] = "g", [MESO_GROUP_OBJECT] = "o", [MESO_GROUP_MATERIAL] = "usemtl"};
    for (uint32_t kind = 0; obj->groups && kind < MESO_GROUP_KINDS; kind++) {
        if (!meso_word_is(statement, statements[kind]))
            continue;
        char *names = statement.text + statement.size + 1, *end = names;
        MesoWord word;
        while (meso_mesh_text_word(obj->text, &word)) {
            if (end > names)
                *end++ = ' ';
            memmove(end, word.text, word.size);
            end += word.size;
        }
        return meso_groups_name(obj->groups, (MesoGroupKind)kind, names, (size_t)(end - names), error);
    }
    return MESO_OK;
}

/* Columns 0 to 2 of the groups are red, green and blue. */
static MesoStatus read_vertex(const ObjScan *obj, MesoError *error)
{
    MesoVec3 point = {0};
    float colour[4];
    MesoStatus status = read_point(obj, "coordinate", &point, colour, error);
    for (uint32_t c = 0; c < 3 && obj->groups && colour[3] > 0 && !status; c++)
        status = meso_groups_value(obj->groups, c, (double)colour[c], error);
    return status ? status : meso_mesh_scan_vertex(obj->scan, point, error);
}

static MesoStatus read_texture(const ObjScan *obj, MesoError *error)
{
    MesoWord word;
    float u;
    if (!meso_mesh_text_word(obj->text, &word))
        return meso_mesh_text_fail(obj->text, error, "texture coordinate has no numbers");
    MesoStatus status = meso_word_number(obj->text, word, "texture coordinate", &u, error);
    return status ? status : meso_groups_texture(obj->groups, u, error);
}

static MesoStatus read_line(const ObjScan *obj, MesoWord word, MesoError *error)
{
    MesoVec3 point = {0};
    float none[4];
    if (meso_word_is(word, "f"))
        return read_face(obj, error);
    if (meso_word_is(word, "v"))
        return read_vertex(obj, error);
    bool normal = meso_word_is(word, "vn");
    if (!normal && !is_passed_over(word))
        return meso_mesh_text_fail(obj->text, error, "unknown statement '%.*s'", MESO_WORD_ARGUMENTS(word));
    MesoStatus status = normal ? read_point(obj, "normal", &point, none, error) : read_names(obj, word, error);
    if (!status && normal)
        status = meso_mesh_scan_normal(obj->scan, point, error);
    if (!status && wants_textures(obj) && meso_word_is(word, "vt"))
        status = read_texture(obj, error);
    if (status)
        return status;
    /* OpenMesh needs none of it, and opens the files that mtllib names. */
    blank(word.text, obj->text->end);
    return MESO_OK;
}

static MesoStatus add_colours(MesoGroupsBuilder *groups, MesoError *error)
{
    static const char *const names[3] = {"red", "green", "blue"};
    MesoStatus status = MESO_OK;
    for (uint32_t c = 0, column; c < 3 && !status; c++)
        status = meso_groups_column(groups, names[c], strlen(names[c]), true, 1, &column, error);
    return status;
}

/* Texture coordinates may come after the faces that use them. */
static MesoStatus check_textures(const MesoMeshScan *scan, const MesoGroupsBuilder *groups, const char *path,
                                 MesoError *error)
{
    uint32_t face = 0;
    for (uint32_t c = 0; c < groups->corner_count; c++) {
        while (c >= scan->face_ends[face])
            face++;
        uint32_t texture = groups->corner_textures[c];
        if (texture >= groups->texture_count && texture != MESO_NO_INDEX)
            return meso_mesh_scan_fail(scan, path, face, error, "uses texture coordinate %llu of %u",
                                       texture + 1ull, groups->texture_count);
    }
    return MESO_OK;
}

MesoStatus meso_obj_scan_groups(MesoMeshScan *scan, MesoGroupsBuilder *groups, MesoArena *arena,
                                const MesoInput *input, MesoError *error)
{
    MesoMeshText text;
    ObjScan obj = {scan, &text, groups};
    *scan = (MesoMeshScan){.arena = arena};
    MesoStatus status = meso_mesh_text_init(&text, arena, input, '#', error);
    if (!status && groups)
        status = add_colours(groups, error);
    while (!status && meso_mesh_text_line(&text, true)) {
        MesoWord word;
        if (meso_mesh_text_word(&text, &word))
            status = read_line(&obj, word, error);
    }
    if (status)
        return status;
    scan->bytes = text.bytes;
    scan->size = text.size;
    status = meso_mesh_scan_check(scan, input->path, error);
    return status || !wants_textures(&obj) ? status : check_textures(scan, groups, input->path, error);
}

MesoStatus meso_obj_scan(MesoMeshScan *scan, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    return meso_obj_scan_groups(scan, NULL, arena, input, error);
}
