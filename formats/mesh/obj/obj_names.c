#include <string.h>

#include "formats/mesh/obj/obj_pieces.h"
#include "libcore/base/grow.h"
#include "libcore/base/names.h"

typedef struct NameList {
    const MesoObj *obj;
    const char **statements;    /* [statements] where their lines begin */
} NameList;

/* Lines that may be statements of names, or that may be joined to the next; the others are passed over quickly. */
static bool looks_plain(const char *at, const char *end)
{
    return *at != 'g' && *at != 'o' && *at != 'u' && !meso_is_blank(*at) && (end == at || (end[-1] != '\\' && end[-1] != '\r'));
}

static void list_statements(void *context, uint64_t begin, uint64_t end)
{
    const NameList *list = context;
    const MesoObj *obj = list->obj;
    const MesoTextPiece *lines = &obj->text.pieces[begin];
    const char **statement = list->statements + obj->pieces[begin].begin[MESO_OBJ_NAMES];
    (void)end;
    if (obj->pieces[begin].counts[MESO_OBJ_NAMES] == 0)
        return;
    for (const char *at = lines->begin; at < lines->end;) {
        const char *line_end = memchr(at, obj->text.line_end, (size_t)(lines->end - at));
        MesoTextLine line = {.next = line_end + 1};
        MesoWord word;
        if (!looks_plain(at, line_end) && meso_text_line(&obj->text, lines, at, &line) &&
            meso_text_word(&line, &word) && meso_obj_name_kind(word) != MESO_OBJ_NAME_KINDS)
            *statement++ = at;
        at = line.next;
    }
}

typedef struct Numbering {
    MesoArena *arena, *scratch;
    MesoNames table[MESO_OBJ_NAME_KINDS];
    const char **names[MESO_OBJ_NAME_KINDS];        /* with room for more */
    uint32_t count[MESO_OBJ_NAME_KINDS], room[MESO_OBJ_NAME_KINDS];
    uint32_t current[MESO_OBJ_NAME_KINDS];
} Numbering;

/* The words behind the statement, with one blank between each two. */
static char *copy_words(MesoArena *arena, MesoTextLine line, size_t *size, MesoError *error)
{
    MesoWord word;
    char *copy = MESO_NEW(arena, char, (size_t)(line.end - line.at) + 1, error), *out = copy;
    while (copy && meso_text_word(&line, &word)) {
        if (out > copy)
            *out++ = ' ';
        memcpy(out, word.text, word.size);
        out += word.size;
    }
    *size = (size_t)(out - copy);
    return copy;
}

static MesoStatus number_name(Numbering *numbering, MesoObjName kind, const MesoTextLine *line, uint32_t *entry,
                              MesoError *error)
{
    size_t size;
    MesoArenaMark mark = meso_arena_mark(numbering->arena);
    char *name = copy_words(numbering->arena, *line, &size, error);
    if (!name)
        return MESO_ERR_MEMORY;
    *entry = meso_names_find(&numbering->table[kind], name, size);
    if (*entry != MESO_NO_INDEX) {
        meso_arena_rewind(numbering->arena, mark);
        return MESO_OK;
    }
    uint32_t *count = &numbering->count[kind];
    numbering->names[kind] = MESO_GROW(numbering->scratch, numbering->names[kind], *count, numbering->room[kind], 16,
                                       error);
    if (!numbering->names[kind])
        return MESO_ERR_MEMORY;
    *entry = meso_names_add(&numbering->table[kind], numbering->scratch, name, size, *count, error);
    numbering->names[kind][(*count)++] = name;
    return *entry == MESO_NO_INDEX ? MESO_ERR_MEMORY : MESO_OK;
}

static MesoStatus number_piece(Numbering *numbering, MesoObj *obj, uint32_t p, const char *const *statements,
                               MesoError *error)
{
    MesoObjPiece *piece = &obj->pieces[p];
    memcpy(piece->names_before, numbering->current, sizeof numbering->current);
    for (uint64_t s = piece->begin[MESO_OBJ_NAMES]; s < piece->begin[MESO_OBJ_NAMES] + piece->counts[MESO_OBJ_NAMES]; s++) {
        MesoTextLine line;
        MesoWord word;
        meso_text_line(&obj->text, &obj->text.pieces[p], statements[s], &line);
        meso_text_word(&line, &word);
        MesoObjName kind = meso_obj_name_kind(word);
        MesoStatus status = number_name(numbering, kind, &line, &obj->arrays.name_entries[s], error);
        if (status)
            return status;
        numbering->current[kind] = obj->arrays.name_entries[s];
    }
    return MESO_OK;
}

MesoStatus meso_obj_number_names(MesoObj *obj, MesoArena *arena, MesoArena *scratch, uint32_t thread_count,
                                 const char **names[MESO_OBJ_NAME_KINDS], uint32_t counts[MESO_OBJ_NAME_KINDS],
                                 MesoError *error)
{
    Numbering numbering = {.arena = arena, .scratch = scratch};
    NameList list = {obj, MESO_NEW(scratch, const char *, obj->totals[MESO_OBJ_NAMES], error)};
    obj->arrays.name_entries = MESO_NEW(scratch, uint32_t, obj->totals[MESO_OBJ_NAMES], error);
    if (!list.statements || !obj->arrays.name_entries)
        return MESO_ERR_MEMORY;
    memset(numbering.current, 0xff, sizeof numbering.current);
    meso_mesh_text_for(&obj->text, thread_count, list_statements, &list);
    for (uint32_t p = 0; p < obj->text.piece_count; p++) {
        MesoStatus status = number_piece(&numbering, obj, p, list.statements, error);
        if (status)
            return status;
    }
    for (uint32_t k = 0; k < MESO_OBJ_NAME_KINDS; k++) {
        counts[k] = numbering.count[k];
        names[k] = counts[k] ? MESO_NEW(arena, const char *, counts[k], error) : NULL;
        if (counts[k] && !names[k])
            return MESO_ERR_MEMORY;
        if (counts[k])
            memcpy(names[k], numbering.names[k], counts[k] * sizeof *names[k]);
    }
    return MESO_OK;
}
