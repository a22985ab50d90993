#include <string.h>

#include "formats/mesh/obj/obj_pieces.h"

MesoObjName meso_obj_name_kind(MesoWord statement)
{
    static const char *const statements[] = {
        [MESO_OBJ_GROUP] = "g", [MESO_OBJ_OBJECT] = "o", [MESO_OBJ_MATERIAL] = "usemtl"};
    MesoObjName kind = 0;
    while (kind < MESO_OBJ_NAME_KINDS && !meso_word_is(statement, statements[kind]))
        kind++;
    return kind;
}

static uint32_t count_words(MesoTextLine line)
{
    MesoWord word;
    uint32_t count = 0;
    while (meso_text_word(&line, &word))
        count++;
    return count;
}

static void count_face(MesoObjPiece *piece, uint32_t sides)
{
    piece->counts[MESO_OBJ_FACES]++;
    piece->counts[MESO_OBJ_CORNERS] += sides;
    piece->least_sides = sides < piece->least_sides ? sides : piece->least_sides;
    piece->most_sides = sides > piece->most_sides ? sides : piece->most_sides;
}

/* Any line, however it is written; returns the next. */
static const char *count_line(const MesoObj *obj, MesoObjPiece *piece, const MesoTextPiece *lines, const char *at)
{
    MesoTextLine line;
    MesoWord word;
    meso_text_line(&obj->text, lines, at, &line);
    if (!meso_text_word(&line, &word))
        return line.next;
    if (meso_word_is(word, "v")) {
        piece->counts[MESO_OBJ_VERTICES]++;
        piece->counts[MESO_OBJ_COLORED] += obj->colored && count_words(line) == 6;
    } else if (meso_word_is(word, "f"))
        count_face(piece, count_words(line));
    else if (meso_word_is(word, "vn"))
        piece->counts[MESO_OBJ_NORMALS]++;
    else if (meso_word_is(word, "vt"))
        piece->counts[MESO_OBJ_TEXTURES]++;
    else
        piece->counts[MESO_OBJ_NAMES] += meso_obj_name_kind(word) != MESO_OBJ_NAME_KINDS;
    return line.next;
}

/* Words of a face up to the end of its line, which goes to `end`; or NULL where comments or joins may be in it. */
static const char *count_corners(const char *at, char line_end, uint32_t *count)
{
    uint32_t words = 0;
    bool blank = true;
    for (char c; (c = *at) != line_end; at++) {
        bool now = meso_is_blank(c);
        if (c == '#' || c == '\\')
            return NULL;
        words += blank & !now;
        blank = now;
    }
    *count = words;
    return at;
}

static bool may_join(const char *end)
{
    return end[-1] == '\\' || end[-1] == '\r';
}

/* Lines as most files have them; NULL for all others. */
static const char *count_plain_line(const MesoObj *obj, MesoObjPiece *piece, const MesoTextPiece *lines, const char *at)
{
    MesoObjCount kind = at[0] == 'v' && at[1] == ' ' && !obj->colored ? MESO_OBJ_VERTICES
                      : at[0] == 'v' && at[1] == 'n' && at[2] == ' '  ? MESO_OBJ_NORMALS
                      : at[0] == 'v' && at[1] == 't' && at[2] == ' '  ? MESO_OBJ_TEXTURES
                      : at[0] == 'f' && at[1] == ' '                  ? MESO_OBJ_FACES
                                                                      : MESO_OBJ_COUNTS;
    uint32_t sides = 0;
    if (kind == MESO_OBJ_COUNTS)
        return NULL;
    const char *end = kind == MESO_OBJ_FACES ? count_corners(at + 2, obj->text.line_end, &sides)
                                             : memchr(at, obj->text.line_end, (size_t)(lines->end - at));
    if (!end || (kind != MESO_OBJ_FACES && may_join(end) && memchr(at, '\\', (size_t)(end - at))))
        return NULL;
    if (kind == MESO_OBJ_FACES)
        count_face(piece, sides);
    else
        piece->counts[kind]++;
    return end + 1;
}

void meso_obj_count(void *context, uint64_t begin, uint64_t end)
{
    MesoObj *obj = context;
    (void)end;
    const MesoTextPiece *lines = &obj->text.pieces[begin];
    MesoObjPiece *piece = &obj->pieces[begin];
    piece->least_sides = MESO_NO_INDEX;
    for (const char *at = lines->begin, *next; at < lines->end; at = next) {
        next = count_plain_line(obj, piece, lines, at);
        if (!next)
            next = count_line(obj, piece, lines, at);
    }
}
