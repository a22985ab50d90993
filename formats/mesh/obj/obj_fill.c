/* OBJ, as in Wavefront's "Object Files", appendix B1 of the Advanced Visualizer Manual. */
#include <math.h>
#include <string.h>

#include "formats/mesh/number_text.h"
#include "formats/mesh/obj/obj_pieces.h"

/* A piece on its way into the arrays: how many of everything there were before the line. */
typedef struct ObjFill {
    const MesoObj *obj;
    const MesoObjArrays *arrays;
    MesoTextPiece *lines;
    MesoObjPiece *piece;
    uint32_t vertices, normals, textures, faces, corners, names;
    uint32_t current[MESO_OBJ_NAME_KINDS];
} ObjFill;

/* What is neither vertex nor face, and says nothing about the shape of the faces. */
static const char *const passed_over[] = {
    "vp", "s", "mg", "mtllib", "usemap", "maplib", "l", "p",
    "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj",
};

static bool is_passed_over(MesoWord word)
{
    for (size_t i = 0; i < sizeof passed_over / sizeof *passed_over; i++)
        if (meso_word_is(word, passed_over[i]))
            return true;
    return false;
}

/* ---- any line ---- */

/* Three numbers; a weight or a colour may follow. `numbers` [6] gets as many of them as there are. */
static MesoStatus read_numbers(ObjFill *fill, MesoTextLine *line, const char *what, float numbers[6], uint32_t *count)
{
    MesoWord word;
    float ignored;
    for (*count = 0; meso_text_word(line, &word); ++*count) {
        float *number = *count < 6 ? &numbers[*count] : &ignored;
        MesoStatus status = meso_word_number(fill->lines, line, word, what, number);
        if (status)
            return status;
    }
    if (*count < 3)
        return meso_text_wrong(fill->lines, line->begin, "%s has %u numbers instead of 3", what, *count);
    return MESO_OK;
}

static void put_vertex(ObjFill *fill, const float *numbers, bool colored)
{
    fill->arrays->positions[fill->vertices] = (MesoVec3){numbers[0], numbers[1], numbers[2]};
    if (fill->arrays->colors && colored)
        fill->arrays->colors[fill->vertices] = (MesoVec3){numbers[3], numbers[4], numbers[5]};
    fill->vertices++;
}

static void put_normal(ObjFill *fill, const float *numbers)
{
    fill->arrays->normals[fill->normals++] = (MesoVec3){numbers[0], numbers[1], numbers[2]};
}

static MesoStatus read_vertex(ObjFill *fill, MesoTextLine *line)
{
    float numbers[6];
    uint32_t count;
    MesoStatus status = read_numbers(fill, line, "coordinate", numbers, &count);
    if (!status)
        put_vertex(fill, numbers, count == 6);
    return status;
}

static MesoStatus read_normal(ObjFill *fill, MesoTextLine *line)
{
    float numbers[6];
    uint32_t count;
    MesoStatus status = read_numbers(fill, line, "normal", numbers, &count);
    if (!status)
        put_normal(fill, numbers);
    return status;
}

/* What is wrong with a texture coordinate is nobody's concern but of who asks for them. */
static MesoStatus tolerate(const ObjFill *fill, MesoStatus status)
{
    fill->piece->wrong_textures |= status != MESO_OK;
    if (fill->obj->strict)
        return status;
    fill->lines->status = MESO_OK;
    return MESO_OK;
}

static MesoStatus read_texture(ObjFill *fill, MesoTextLine *line)
{
    float *texture = fill->arrays->textures + (size_t)fill->arrays->texture_width * fill->textures++;
    MesoWord word;
    uint32_t count = 0;
    MesoStatus status = MESO_OK;
    for (; count < fill->arrays->texture_width && !status && meso_text_word(line, &word); count++)
        status = meso_word_number(fill->lines, line, word, "texture coordinate", &texture[count]);
    if (count == 0)
        status = meso_text_wrong(fill->lines, line->begin, "texture coordinate has no numbers");
    return tolerate(fill, status);
}

typedef struct ObjIndex {
    MesoWord word;
    int64_t value;
} ObjIndex;

/* Index from 1, or from -1 downwards for the last one so far, to an index from 0. */
static MesoStatus resolve(ObjFill *fill, const MesoTextLine *line, ObjIndex as_written, uint32_t so_far,
                          const char *what, uint32_t *index)
{
    int64_t given = as_written.value;
    if (given == 0)
        return meso_text_wrong(fill->lines, line->begin, "%s index is 0; indices start at 1", what);
    if (given < -(int64_t)so_far)
        return meso_text_wrong(fill->lines, line->begin, "%s index %.*s goes back beyond the first of %u", what,
                               MESO_WORD_ARGUMENTS(as_written.word), so_far);
    if (given >= UINT32_MAX)
        return meso_text_wrong(fill->lines, line->begin, "%s index %.*s is too large", what,
                               MESO_WORD_ARGUMENTS(as_written.word));
    *index = (uint32_t)(given < 0 ? so_far + given : given - 1);
    return MESO_OK;
}

typedef struct ObjCorner {
    ObjIndex vertex, texture, normal;
    bool has_texture, has_normal;
} ObjCorner;

static bool read_index(ObjIndex *index, const char *begin, const char *end)
{
    index->word = (MesoWord){begin, (size_t)(end - begin)};
    return meso_word_integer(index->word, &index->value);
}

/* Splits "v", "v/vt", "v//vn" or "v/vt/vn"; false where it is none of them. */
static bool split_corner(MesoWord word, ObjCorner *corner)
{
    *corner = (ObjCorner){0};
    const char *end = word.text + word.size;
    const char *slash = memchr(word.text, '/', word.size);
    if (!read_index(&corner->vertex, word.text, slash ? slash : end))
        return false;
    if (!slash)
        return true;

    const char *second = memchr(slash + 1, '/', (size_t)(end - slash - 1));
    const char *middle = second ? second : end;
    corner->has_texture = middle > slash + 1;
    if (corner->has_texture && !read_index(&corner->texture, slash + 1, middle))
        return false;
    if (!second || second + 1 == end)
        return true;
    corner->has_normal = true;
    return read_index(&corner->normal, second + 1, end);
}

/* The arrays are as long as the faces that were counted need; unused texture coordinates need not be there. */
static void put_corner(ObjFill *fill, uint32_t vertex, uint32_t texture, uint32_t normal)
{
    const MesoObjArrays *arrays = fill->arrays;
    uint64_t texture_count = fill->obj->totals[MESO_OBJ_TEXTURES];
    arrays->corners[fill->corners] = vertex;
    if (arrays->normal_of)
        arrays->normal_of[fill->corners] = normal;
    else
        fill->piece->missing_normals |= normal != MESO_NO_INDEX;
    if (arrays->texture_of) {
        arrays->texture_of[fill->corners] = texture;
        fill->piece->wrong_textures |= texture != MESO_NO_INDEX && texture >= texture_count;
    }
    fill->corners++;
}

static void end_face(ObjFill *fill, uint32_t begin)
{
    const MesoObjArrays *arrays = fill->arrays;
    if (arrays->face_begin)
        arrays->face_begin[fill->faces] = begin;
    for (uint32_t k = 0; k < MESO_OBJ_NAME_KINDS; k++)
        if (arrays->name_of[k])
            arrays->name_of[k][fill->faces] = fill->current[k];
    fill->faces++;
}

static MesoStatus read_corner(ObjFill *fill, const MesoTextLine *line, MesoWord word)
{
    ObjCorner corner;
    if (!split_corner(word, &corner))
        return meso_text_wrong(fill->lines, line->begin, "face corner '%.*s' is not v, v/vt, v//vn or v/vt/vn",
                               MESO_WORD_ARGUMENTS(word));
    uint32_t vertex = MESO_NO_INDEX, texture = MESO_NO_INDEX, normal = MESO_NO_INDEX;
    MesoStatus status = resolve(fill, line, corner.vertex, fill->vertices, "vertex", &vertex);
    if (!status && corner.has_normal)
        status = resolve(fill, line, corner.normal, fill->normals, "normal", &normal);
    if (!status && corner.has_texture)
        status = tolerate(fill, resolve(fill, line, corner.texture, fill->textures, "texture coordinate", &texture));
    if (!status)
        put_corner(fill, vertex, texture, normal);
    return status;
}

static MesoStatus read_face(ObjFill *fill, MesoTextLine *line)
{
    MesoWord word;
    uint32_t begin = fill->corners;
    while (meso_text_word(line, &word)) {
        MesoStatus status = read_corner(fill, line, word);
        if (status)
            return status;
    }
    end_face(fill, begin);
    return MESO_OK;
}

/* Returns the next line; NULL where this one is wrong. */
static const char *read_line(ObjFill *fill, const char *at)
{
    MesoTextLine line;
    MesoWord word;
    MesoStatus status = MESO_OK;
    meso_text_line(&fill->obj->text, fill->lines, at, &line);
    if (!meso_text_word(&line, &word))
        return line.next;
    MesoObjName kind = meso_obj_name_kind(word);
    if (kind != MESO_OBJ_NAME_KINDS)
        fill->current[kind] = fill->arrays->name_entries[fill->names++];
    else if (meso_word_is(word, "f"))
        status = read_face(fill, &line);
    else if (meso_word_is(word, "v"))
        status = read_vertex(fill, &line);
    else if (meso_word_is(word, "vn"))
        status = read_normal(fill, &line);
    else if (meso_word_is(word, "vt"))
        status = read_texture(fill, &line);
    else if (!is_passed_over(word))
        status = meso_text_wrong(fill->lines, line.begin, "unknown statement '%.*s'", MESO_WORD_ARGUMENTS(word));
    return status ? NULL : line.next;
}

/* ---- lines as most files have them ---- */

static const char *skip_blanks(const char *at)
{
    while (*at == ' ' || *at == '\t')
        at++;
    return at;
}

/* At the line end, which may have a carriage return before it: the next line; NULL elsewhere. */
static const char *behind_end(const char *at, char line_end)
{
    at = skip_blanks(at);
    at += *at == '\r' && line_end == '\n';
    return *at == line_end ? at + 1 : NULL;
}

static const char *plain_numbers(const char *at, float *numbers, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        at = meso_text_float(skip_blanks(at), &numbers[i]);
        if (!at || (*at != ' ' && *at != '\t' && *at != '\r' && *at != '\n') || !isfinite(numbers[i]))
            return NULL;
    }
    return at;
}

/* An index as files that count from the beginning have it: 1 to 9 digits, not 0. */
static const char *plain_index(const char *at, uint32_t *index)
{
    const char *begin = at;
    uint32_t number = 0;
    for (unsigned digit; (digit = (unsigned)(*at - '0')) <= 9; at++)
        number = 10 * number + digit;
    *index = number - 1;
    return at - begin <= 9 && number > 0 ? at : NULL;
}

static const char *plain_corner(ObjFill *fill, const char *at)
{
    uint32_t vertex, texture = MESO_NO_INDEX, normal = MESO_NO_INDEX;
    at = plain_index(at, &vertex);
    if (!at)
        return NULL;
    if (*at == '/') {
        if (at[1] != '/' && !(at = plain_index(at + 1, &texture)))
            return NULL;
        at += texture == MESO_NO_INDEX;
        if (*at == '/' && !(at = plain_index(at + 1, &normal)))
            return NULL;
    }
    put_corner(fill, vertex, texture, normal);
    return at;
}

static const char *plain_face(ObjFill *fill, const char *at, char line_end)
{
    uint32_t begin = fill->corners;
    const char *next;
    while (!(next = behind_end(at, line_end))) {
        const char *end = plain_corner(fill, skip_blanks(at));
        if (!end || !(meso_is_blank(*end) || *end == line_end)) {
            fill->corners = begin;
            return NULL;
        }
        at = end;
    }
    end_face(fill, begin);
    return next;
}

/* Returns the next line; NULL where this one is not plain, and then nothing of it is taken. */
static const char *plain_line(ObjFill *fill, const char *at)
{
    char line_end = fill->obj->text.line_end;
    float numbers[3];
    if (at[0] == 'f' && at[1] == ' ')
        return plain_face(fill, at + 2, line_end);
    if (at[0] != 'v')
        return NULL;
    uint32_t count = at[1] == 't' ? fill->arrays->texture_width : 3;
    bool vertex = at[1] == ' ';
    if (!vertex && ((at[1] != 'n' && at[1] != 't') || at[2] != ' '))
        return NULL;
    const char *next = plain_numbers(at + 2, numbers, count);
    next = next ? behind_end(next, line_end) : NULL;
    if (!next)
        return NULL;
    if (vertex)
        put_vertex(fill, numbers, false);
    else if (at[1] == 'n')
        put_normal(fill, numbers);
    else
        memcpy(fill->arrays->textures + (size_t)count * fill->textures++, numbers, count * sizeof *numbers);
    return next;
}

void meso_obj_fill(void *context, uint64_t begin, uint64_t end)
{
    MesoObj *obj = context;
    (void)end;
    MesoObjPiece *piece = &obj->pieces[begin];
    ObjFill fill = {
        .obj = obj, .arrays = &obj->arrays, .lines = &obj->text.pieces[begin], .piece = piece,
        .vertices = (uint32_t)piece->begin[MESO_OBJ_VERTICES], .normals = (uint32_t)piece->begin[MESO_OBJ_NORMALS],
        .textures = (uint32_t)piece->begin[MESO_OBJ_TEXTURES], .faces = (uint32_t)piece->begin[MESO_OBJ_FACES],
        .corners = (uint32_t)piece->begin[MESO_OBJ_CORNERS], .names = (uint32_t)piece->begin[MESO_OBJ_NAMES]};
    memcpy(fill.current, piece->names_before, sizeof fill.current);
    for (const char *at = fill.lines->begin, *next; at && at < fill.lines->end; at = next) {
        next = plain_line(&fill, at);
        if (!next)
            next = read_line(&fill, at);
    }
}
