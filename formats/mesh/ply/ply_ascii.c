#include <float.h>
#include <math.h>
#include <string.h>

#include "formats/mesh/mesh_kinds.h"
#include "formats/mesh/mesh_text.h"
#include "formats/mesh/number_text.h"
#include "formats/mesh/ply/ply_body.h"
#include "formats/mesh/ply/ply_items.h"
#include "formats/mesh/ply/ply_layout.h"

typedef struct AsciiPiece {
    uint64_t lines, lines_before;       /* with words: each is an item */
    uint64_t corners, corners_before;
    uint32_t least_sides, most_sides;
    uint32_t *widths;                   /* [properties] of lists of corners; see ply_layout.h */
} AsciiPiece;

typedef struct Ascii {
    MesoPly *ply;
    MesoPolygonMesh *mesh;
    MesoMeshText text;
    AsciiPiece *pieces;
    uint64_t line_count;
} Ascii;

/* Which item a line is. */
typedef struct Place {
    const MesoPlyElement *element, *end;
    uint32_t item;
} Place;

static void pass_over_full(Place *place)
{
    while (place->element < place->end && place->item == place->element->count) {
        place->element++;
        place->item = 0;
    }
}

static Place place_of_line(const MesoPly *ply, uint64_t line)
{
    Place place = {.element = ply->elements, .end = ply->elements + ply->element_count};
    while (place.element < place.end && line >= place.element->count)
        line -= (place.element++)->count;
    place.item = (uint32_t)line;
    return place;
}

static void next_item(Place *place)
{
    place->item++;
    pass_over_full(place);
}

/* ---- counting ---- */

static void count_lines(void *context, uint64_t begin, uint64_t end)
{
    Ascii *ascii = context;
    const MesoTextPiece *lines = &ascii->text.pieces[begin];
    MesoTextLine line = {.next = lines->begin};
    (void)end;
    while (meso_text_filled_line(&ascii->text, lines, line.next, &line))
        ascii->pieces[begin].lines++;
}

/* Length of the list that comes next; what no line could hold is 0, and found out when it is read. */
static uint32_t list_length(MesoTextLine *line)
{
    MesoWord word;
    int64_t count;
    if (!meso_text_word(line, &word) || !meso_word_integer(word, &count) || count < 0)
        return 0;
    return count <= (line->end - line->at) / 2 + 1 ? (uint32_t)count : 0;
}

static void count_face(const MesoPlyElement *element, MesoTextLine line, AsciiPiece *piece)
{
    uint32_t sides = 0, counts[MESO_PLY_PROPERTIES];
    bool more = element->roles & (1u << MESO_PLY_TEXCOORD | 1u << MESO_PLY_CORNERS);
    for (const MesoPlyProperty *p = element->properties; p < element->properties_end; p++) {
        MesoWord word;
        uint32_t count = p->list ? list_length(&line) : 1;
        counts[p - element->properties] = count;
        if (p->role == MESO_PLY_INDICES)
            sides = count;
        if (p->role == MESO_PLY_INDICES && !more)
            break;
        while (count > 0 && meso_text_word(&line, &word))
            count--;
    }
    piece->corners += sides;
    piece->least_sides = sides < piece->least_sides ? sides : piece->least_sides;
    piece->most_sides = sides > piece->most_sides ? sides : piece->most_sides;
    if (more)
        meso_ply_note_widths(piece->widths, element, counts);
}

static void count_corners(void *context, uint64_t begin, uint64_t end)
{
    Ascii *ascii = context;
    AsciiPiece *piece = &ascii->pieces[begin];
    const MesoTextPiece *lines = &ascii->text.pieces[begin];
    MesoTextLine line = {.next = lines->begin};
    Place place = place_of_line(ascii->ply, piece->lines_before);
    Place last = place_of_line(ascii->ply, piece->lines_before + piece->lines);
    (void)end;
    piece->least_sides = MESO_NO_INDEX;
    pass_over_full(&place);
    if (place.element == last.element && place.element < place.end && place.element->kind != MESO_PLY_FACES)
        return;
    for (; place.element < place.end && meso_text_filled_line(&ascii->text, lines, line.next, &line); next_item(&place))
        if (place.element->kind == MESO_PLY_FACES)
            count_face(place.element, line, piece);
}

static MesoStatus count(Ascii *ascii, uint32_t thread_count, MesoArena *scratch, MesoError *error)
{
    uint64_t corners = 0;
    ascii->pieces = MESO_NEW(scratch, AsciiPiece, ascii->text.piece_count, error);
    for (uint32_t p = 0; ascii->pieces && p < ascii->text.piece_count; p++)
        if (!(ascii->pieces[p].widths = MESO_NEW(scratch, uint32_t, ascii->ply->property_count, error)))
            return MESO_ERR_MEMORY;
    if (!ascii->pieces)
        return MESO_ERR_MEMORY;
    meso_mesh_text_for(&ascii->text, thread_count, count_lines, ascii);
    for (uint32_t p = 0; p < ascii->text.piece_count; p++) {
        ascii->pieces[p].lines_before = ascii->line_count;
        ascii->line_count += ascii->pieces[p].lines;
    }
    meso_mesh_text_for(&ascii->text, thread_count, count_corners, ascii);
    for (uint32_t p = 0; p < ascii->text.piece_count; p++) {
        ascii->pieces[p].corners_before = corners;
        corners += ascii->pieces[p].corners;
    }
    if (corners > MESO_MESH_LIMIT)
        return meso_fail(error, MESO_ERR_LIMIT, "mesh has more than %u elements of a kind", MESO_MESH_LIMIT);
    ascii->mesh->corner_count = (uint32_t)corners;
    return MESO_OK;
}

/* ---- room ---- */

static uint32_t common_sides(const Ascii *ascii)
{
    uint32_t least = MESO_NO_INDEX, most = 0;
    for (uint32_t p = 0; p < ascii->text.piece_count; p++) {
        least = ascii->pieces[p].least_sides < least ? ascii->pieces[p].least_sides : least;
        most = ascii->pieces[p].most_sides > most ? ascii->pieces[p].most_sides : most;
    }
    return least == most ? most : 0;
}

/* Of all faces, in the first piece's. */
static const uint32_t *common_widths(const Ascii *ascii, const MesoPlyElement *faces)
{
    for (uint32_t p = 1; p < ascii->text.piece_count; p++)
        meso_ply_join_widths(ascii->pieces[0].widths, ascii->pieces[p].widths, faces);
    return ascii->pieces[0].widths;
}

/* For as many items as there are lines. */
static MesoStatus make_room(Ascii *ascii, MesoArena *arena, MesoError *error)
{
    MesoPly *ply = ascii->ply;
    MesoPolygonMesh *mesh = ascii->mesh;
    uint64_t rest = ascii->line_count;
    MesoStatus status = MESO_OK;
    for (MesoPlyElement *element = ply->elements; element < ply->elements + ply->element_count && !status; element++) {
        uint32_t items = element->count < rest ? element->count : (uint32_t)rest;
        if (element->kind == MESO_PLY_VERTICES)
            status = meso_ply_make_vertices(element, mesh, arena, items, error);
        if (element->kind == MESO_PLY_FACES)
            status = meso_ply_make_faces(element, mesh, arena, items, mesh->corner_count, common_sides(ascii),
                                         common_widths(ascii, element), error);
        rest -= items;
    }
    if (!status && mesh->face_begin)
        mesh->face_begin[mesh->face_count] = mesh->corner_count;
    return status;
}

/* ---- items ---- */

typedef struct AsciiFill {
    const Ascii *ascii;
    MesoTextPiece *lines;
    MesoTextLine line;
    Place place;
    uint32_t corner;
} AsciiFill;

static MesoStatus wrong_item(AsciiFill *fill, const char *what)
{
    return meso_text_wrong(fill->lines, fill->line.begin, "%s %u %s", fill->place.element->name, fill->place.item + 1,
                           what);
}

static MesoStatus next_word(AsciiFill *fill, MesoWord *word)
{
    return meso_text_word(&fill->line, word) ? MESO_OK : wrong_item(fill, "has too few values");
}

/* A float that a blank or the line's end follows; false leaves it to those who say what is wrong. */
static bool read_plain_float(MesoTextLine *line, float *number)
{
    const char *at = line->at;
    while (at < line->end && meso_is_blank(*at))
        at++;
    const char *end = at < line->end ? meso_text_float(at, number) : NULL;
    if (!end || (end < line->end && !meso_is_blank(*end)) || !isfinite(*number))
        return false;
    line->at = end;
    return true;
}

static MesoStatus read_float(AsciiFill *fill, unsigned char *out)
{
    float number;
    MesoWord word;
    MesoStatus status = MESO_OK;
    if (!read_plain_float(&fill->line, &number)) {
        status = next_word(fill, &word);
        if (!status)
            status = meso_word_number(fill->lines, &fill->line, word, "value", &number);
    }
    if (!status && out)
        memcpy(out, &number, sizeof number);
    return status;
}

static MesoStatus read_double(AsciiFill *fill, double most, unsigned char *out)
{
    MesoWord word;
    double number;
    MesoStatus status = next_word(fill, &word);
    if (status)
        return status;
    if (meso_text_double(word.text, &number) != word.text + word.size)
        return meso_text_wrong(fill->lines, fill->line.begin, "value '%.*s' is not a finite number",
                               MESO_WORD_ARGUMENTS(word));
    if (!(fabs(number) <= most))
        return meso_text_wrong(fill->lines, fill->line.begin, "value '%.*s' is too large", MESO_WORD_ARGUMENTS(word));
    if (out)
        memcpy(out, &number, sizeof number);
    return MESO_OK;
}

static MesoStatus read_integer(AsciiFill *fill, int64_t *integer, MesoWord *word)
{
    MesoStatus status = next_word(fill, word);
    if (!status && !meso_word_integer(*word, integer))
        return meso_text_wrong(fill->lines, fill->line.begin, "value '%.*s' is not an integer",
                               MESO_WORD_ARGUMENTS(*word));
    return status;
}

static MesoStatus put_integer(AsciiFill *fill, const MesoPlyProperty *property, int64_t integer, MesoWord word,
                              unsigned char *out)
{
    unsigned char bytes[8];
    memcpy(bytes, &integer, sizeof bytes);
    if (property->to != MESO_SCALAR_FLOAT && meso_ply_integer(property->type, bytes, false) != integer)
        return meso_text_wrong(fill->lines, fill->line.begin, "value '%.*s' is beyond its type",
                               MESO_WORD_ARGUMENTS(word));
    float number = (float)integer;
    memcpy(out, property->to == MESO_SCALAR_FLOAT ? (const void *)&number : bytes, meso_scalar_size(property->to));
    return MESO_OK;
}

/* One number, to `out` where that is not NULL. What is kept as a float is read as one, whatever the file calls it. */
static MesoStatus read_number(AsciiFill *fill, const MesoPlyProperty *property, unsigned char *out)
{
    int64_t integer;
    MesoWord word;
    bool is_double = property->type == MESO_SCALAR_DOUBLE, as_float = out && property->to == MESO_SCALAR_FLOAT;
    if (property->type == MESO_SCALAR_FLOAT || (is_double && as_float))
        return read_float(fill, out);
    if (is_double)
        return read_double(fill, property->role <= MESO_PLY_NZ ? (double)FLT_MAX : DBL_MAX, out);
    MesoStatus status = read_integer(fill, &integer, &word);
    return status || !out ? status : put_integer(fill, property, integer, word, out);
}

static MesoStatus read_index(AsciiFill *fill, bool counted)
{
    int64_t index;
    MesoWord word;
    MesoStatus status = read_integer(fill, &index, &word);
    if (status)
        return status;
    if (index < 0)
        return wrong_item(fill, "has a negative vertex index");
    if (index >= UINT32_MAX)
        return wrong_item(fill, "has a vertex index that is too large");
    if (counted)
        fill->ascii->mesh->corners[fill->corner++] = (uint32_t)index;
    return MESO_OK;
}

static MesoStatus read_list(AsciiFill *fill, const MesoPlyProperty *property, uint32_t first_corner)
{
    int64_t length;
    MesoWord word;
    MesoStatus status = read_integer(fill, &length, &word);
    if (!status && length < 0)
        return wrong_item(fill, "has a list of negative length");
    bool counted = length <= (fill->line.end - fill->line.at) / 2 + 1;
    for (int64_t i = 0; i < length && !status; i++) {
        if (property->role == MESO_PLY_INDICES) {
            status = read_index(fill, counted);
            continue;
        }
        size_t at = (size_t)first_corner * property->stride + (size_t)i * meso_scalar_size(property->to);
        status = read_number(fill, property, property->out && counted ? property->out + at : NULL);
    }
    return status;
}

static MesoStatus read_item(AsciiFill *fill)
{
    const MesoPlyElement *element = fill->place.element;
    uint32_t item = fill->place.item, first_corner = fill->corner;
    MesoStatus status = MESO_OK;
    if (element->kind == MESO_PLY_FACES && fill->ascii->mesh->face_begin)
        fill->ascii->mesh->face_begin[item] = first_corner;
    for (const MesoPlyProperty *p = element->properties; p < element->properties_end && !status; p++)
        status = p->list ? read_list(fill, p, first_corner)
                         : read_number(fill, p, p->out ? p->out + (size_t)item * p->stride : NULL);
    MesoWord more;
    if (!status && meso_text_word(&fill->line, &more))
        status = wrong_item(fill, "has too many values");
    return status;
}

static void fill_piece(void *context, uint64_t begin, uint64_t end)
{
    const Ascii *ascii = context;
    const AsciiPiece *piece = &ascii->pieces[begin];
    AsciiFill fill = {
        .ascii = ascii, .lines = &ascii->text.pieces[begin], .place = place_of_line(ascii->ply, piece->lines_before),
        .corner = (uint32_t)piece->corners_before};
    (void)end;
    fill.line.next = fill.lines->begin;
    pass_over_full(&fill.place);
    for (; meso_text_filled_line(&ascii->text, fill.lines, fill.line.next, &fill.line); next_item(&fill.place)) {
        if (fill.place.element == fill.place.end) {
            meso_text_wrong(fill.lines, fill.line.begin, "more lines than the header counts");
            return;
        }
        if (read_item(&fill))
            return;
    }
}

/* ---- all together ---- */

static MesoStatus check_end(const Ascii *ascii, MesoError *error)
{
    Place place = place_of_line(ascii->ply, ascii->line_count);
    pass_over_full(&place);
    if (place.element == place.end)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT, "%s:%u: file ends before %s %u of %u", ascii->ply->path,
                     meso_mesh_text_line_number(&ascii->text, ascii->text.size), place.element->name, place.item + 1,
                     place.element->count);
}

static MesoStatus read_ascii(Ascii *ascii, MesoArena *arena, MesoArena *scratch, uint32_t thread_count,
                             MesoError *error)
{
    MesoStatus status = count(ascii, thread_count, scratch, error);
    if (!status)
        status = make_room(ascii, arena, error);
    if (status)
        return status;
    meso_mesh_text_for(&ascii->text, thread_count, fill_piece, ascii);
    status = meso_mesh_text_status(&ascii->text, error);
    return status ? status : check_end(ascii, error);
}

MesoStatus meso_ply_read_ascii(MesoPly *ply, MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input,
                               uint32_t thread_count, MesoError *error)
{
    Ascii ascii = {.ply = ply, .mesh = mesh};
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = meso_mesh_text_init(&ascii.text, &scratch, input, ply->body, 0, false, error);
    if (!status)
        status = read_ascii(&ascii, arena, &scratch, thread_count, error);
    meso_arena_release(&scratch);
    return status;
}
