/* OFF, the ASCII "Object File Format" of Geomview (geomview.org/docs/html/OFF.html). */
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "formats/mesh/mesh_kinds.h"
#include "formats/mesh/mesh_text.h"
#include "libcore/math/vec.h"

typedef struct OffPiece {
    uint64_t lines, lines_before;       /* with words, behind the counts: each is a vertex or a face */
    uint64_t corners, corners_before;
    uint32_t least_sides, most_sides;
} OffPiece;

typedef struct Off {
    MesoMeshText text;
    bool normals;           /* each vertex has one */
    bool more;              /* colours or texture coordinates may follow */
    uint32_t vertex_count, face_count;  /* as the header has them */
    uint32_t body_piece;    /* where the first vertex is: in this piece, */
    const char *body;       /* at this line */
    OffPiece *pieces;
    uint64_t line_count;
    MesoPolygonMesh *mesh;
    MesoVec3 *normal_values;
} Off;

/* ---- header ---- */

/* A line of the header, in whichever piece it is; false at the end of the file. */
typedef struct OffHeader {
    Off *off;
    MesoTextLine line;
    MesoError *error;
} OffHeader;

static bool next_line(OffHeader *header)
{
    Off *off = header->off;
    for (; off->body_piece < off->text.piece_count; off->body_piece++) {
        const MesoTextPiece *piece = &off->text.pieces[off->body_piece];
        if (!off->body)
            off->body = piece->begin;
        if (meso_text_filled_line(&off->text, piece, off->body, &header->line)) {
            off->body = header->line.next;
            return true;
        }
        off->body = NULL;
    }
    return false;
}

/* In the line that was read last, or, where there is none, behind the last one of the file. */
__attribute__((format(printf, 3, 4)))
static MesoStatus fail(OffHeader *header, bool at_line, const char *format, ...)
{
    char message[400];
    const Off *off = header->off;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    size_t offset = at_line ? meso_text_offset(&off->text.pieces[off->body_piece], header->line.begin) : off->text.size;
    return meso_fail(header->error, MESO_ERR_INPUT, "%s:%u: %s", off->text.path,
                     meso_mesh_text_line_number(&off->text, offset), message);
}

/* The keyword is [ST][C][N][4][n]OFF. */
static MesoStatus read_keyword(OffHeader *header)
{
    static const char not_off[] = "not an OFF file: the first word is not OFF";
    MesoWord word, next;
    if (!next_line(header))
        return fail(header, false, not_off);
    if (!meso_text_word(&header->line, &word) || word.size < 3 || memcmp(word.text + word.size - 3, "OFF", 3) != 0)
        return fail(header, true, not_off);
    const char *at = word.text, *keyword = word.text + word.size - 3;
    bool textures = keyword - at >= 2 && memcmp(at, "ST", 2) == 0;
    at += textures ? 2 : 0;
    bool colors = *at == 'C';
    at += colors;
    header->off->more = textures || colors;
    header->off->normals = *at == 'N';
    at += header->off->normals;
    if (at != keyword)
        return fail(header, true, "OFF of the kind '%.*s' is not read, only OFF with the prefixes ST, C and N",
                    MESO_WORD_ARGUMENTS(word));
    MesoTextLine rest = header->line;
    if (meso_text_word(&rest, &next) && meso_word_is(next, "BINARY"))
        return fail(header, true, "binary OFF is not read; write it as ASCII, or as PLY");
    return MESO_OK;
}

/* Vertices, faces, edges: on the line of the keyword or the next one. */
static MesoStatus read_counts(OffHeader *header)
{
    uint32_t counts[3] = {0};
    bool at_line = true;
    MesoWord word;
    for (int i = 0; i < 3; i++) {
        int64_t count;
        bool got = meso_text_word(&header->line, &word);
        if (!got && i == 0) {
            at_line = next_line(header);
            got = at_line && meso_text_word(&header->line, &word);
        }
        if (!got)
            return fail(header, at_line, "counts of vertices, faces and edges are missing");
        if (!meso_word_integer(word, &count) || count < 0 || count >= UINT32_MAX - 1)
            return fail(header, true, "count '%.*s' is not a number of elements", MESO_WORD_ARGUMENTS(word));
        counts[i] = (uint32_t)count;
    }
    if (meso_text_word(&header->line, &word))
        return fail(header, true, "'%.*s' follows the counts", MESO_WORD_ARGUMENTS(word));
    header->off->vertex_count = counts[0];
    header->off->face_count = counts[1];
    return MESO_OK;
}

static MesoStatus read_header(Off *off, MesoError *error)
{
    OffHeader header = {.off = off, .error = error};
    MesoStatus status = read_keyword(&header);
    return status ? status : read_counts(&header);
}

/* ---- counting ---- */

static const char *first_line(const Off *off, uint64_t p)
{
    return p == off->body_piece ? off->body : off->text.pieces[p].begin;
}

static void count_lines(void *context, uint64_t begin, uint64_t end)
{
    Off *off = context;
    MesoTextLine line = {.next = first_line(off, begin)};
    (void)end;
    while (begin >= off->body_piece && meso_text_filled_line(&off->text, &off->text.pieces[begin], line.next, &line))
        off->pieces[begin].lines++;
}

/* Corners of a face; what its line could not hold is 0, and found out when it is read. */
static uint32_t side_count(MesoTextLine *line, MesoWord *word, int64_t *count)
{
    *word = (MesoWord){.text = line->at};
    *count = -1;
    if (!meso_text_word(line, word) || !meso_word_integer(*word, count) || *count < 0)
        return 0;
    return *count <= (line->end - line->at) / 2 + 1 ? (uint32_t)*count : 0;
}

static void count_corners(void *context, uint64_t begin, uint64_t end)
{
    Off *off = context;
    OffPiece *piece = &off->pieces[begin];
    uint64_t number = piece->lines_before, last = (uint64_t)off->vertex_count + off->face_count;
    MesoTextLine line = {.next = first_line(off, begin)};
    (void)end;
    piece->least_sides = MESO_NO_INDEX;
    if (number + piece->lines <= off->vertex_count || begin < off->body_piece)
        return;
    for (; number < last && meso_text_filled_line(&off->text, &off->text.pieces[begin], line.next, &line); number++) {
        MesoWord word;
        int64_t count;
        if (number < off->vertex_count)
            continue;
        uint32_t sides = side_count(&line, &word, &count);
        piece->corners += sides;
        piece->least_sides = sides < piece->least_sides ? sides : piece->least_sides;
        piece->most_sides = sides > piece->most_sides ? sides : piece->most_sides;
    }
}

static MesoStatus count(Off *off, uint32_t thread_count, MesoArena *scratch, MesoError *error)
{
    uint64_t corners = 0;
    uint32_t least = MESO_NO_INDEX, most = 0;
    off->pieces = MESO_NEW(scratch, OffPiece, off->text.piece_count, error);
    if (!off->pieces)
        return MESO_ERR_MEMORY;
    meso_mesh_text_for(&off->text, thread_count, count_lines, off);
    for (uint32_t p = 0; p < off->text.piece_count; p++) {
        off->pieces[p].lines_before = off->line_count;
        off->line_count += off->pieces[p].lines;
    }
    meso_mesh_text_for(&off->text, thread_count, count_corners, off);
    for (OffPiece *piece = off->pieces; piece < off->pieces + off->text.piece_count; piece++) {
        piece->corners_before = corners;
        corners += piece->corners;
        least = piece->least_sides < least ? piece->least_sides : least;
        most = piece->most_sides > most ? piece->most_sides : most;
    }
    if (corners > MESO_MESH_LIMIT)
        return meso_fail(error, MESO_ERR_LIMIT, "mesh has more than %u elements of a kind", MESO_MESH_LIMIT);
    off->mesh->corner_count = (uint32_t)corners;
    off->mesh->side_count = least == most ? most : 0;
    return MESO_OK;
}

static MesoStatus make_room(Off *off, MesoArena *arena, MesoError *error)
{
    MesoPolygonMesh *mesh = off->mesh;
    uint64_t faces = off->line_count > off->vertex_count ? off->line_count - off->vertex_count : 0;
    mesh->vertex_count = off->line_count < off->vertex_count ? (uint32_t)off->line_count : off->vertex_count;
    mesh->face_count = faces < off->face_count ? (uint32_t)faces : off->face_count;
    mesh->positions = MESO_NEW(arena, MesoVec3, mesh->vertex_count, error);
    mesh->corners = MESO_NEW(arena, uint32_t, mesh->corner_count, error);
    mesh->face_begin = mesh->side_count ? NULL : MESO_NEW(arena, uint32_t, (size_t)mesh->face_count + 1, error);
    off->normal_values = MESO_NEW(arena, MesoVec3, off->normals ? mesh->vertex_count : 0, error);
    mesh->attributes = MESO_NEW(arena, MesoAttribute, 1, error);
    if (!mesh->positions || !mesh->corners || !(mesh->face_begin || mesh->side_count) || !off->normal_values ||
        !mesh->attributes)
        return MESO_ERR_MEMORY;
    if (mesh->face_begin)
        mesh->face_begin[mesh->face_count] = mesh->corner_count;
    if (off->normals)
        mesh->attributes[mesh->attribute_count++] = (MesoAttribute){
            .name = "normal", .domain = MESO_ON_VERTICES, .width = 3, .entry_count = mesh->vertex_count, .values = off->normal_values};
    return MESO_OK;
}

/* ---- filling ---- */

static MesoStatus read_vertex(const Off *off, MesoTextPiece *piece, MesoTextLine *line, uint32_t v)
{
    float numbers[6] = {0};
    MesoWord word;
    uint32_t wanted = off->normals ? 6 : 3;
    for (uint32_t i = 0; i < wanted; i++) {
        if (!meso_text_word(line, &word))
            return meso_text_wrong(piece, line->begin, "vertex has %u numbers instead of %u", i, wanted);
        MesoStatus status = meso_word_number(piece, line, word, i < 3 ? "coordinate" : "normal", &numbers[i]);
        if (status)
            return status;
    }
    if (!off->more && meso_text_word(line, &word))
        return meso_text_wrong(piece, line->begin, "vertex has more than %u numbers", wanted);
    off->mesh->positions[v] = (MesoVec3){numbers[0], numbers[1], numbers[2]};
    if (off->normals)
        off->normal_values[v] = (MesoVec3){numbers[3], numbers[4], numbers[5]};
    return MESO_OK;
}

/* The number of corners, their vertices, and perhaps a colour. `*corner` is the face's first, and then the next
 * face's. */
static MesoStatus read_face(const Off *off, MesoTextPiece *piece, MesoTextLine *line, uint32_t f, uint32_t *corner)
{
    MesoWord number, word;
    int64_t count, vertex;
    uint32_t counted = side_count(line, &number, &count);
    if (count < 0)
        return meso_text_wrong(piece, line->begin, "face has '%.*s' corners", MESO_WORD_ARGUMENTS(number));
    if (off->mesh->face_begin)
        off->mesh->face_begin[f] = *corner;
    for (int64_t i = 0; i < count; i++) {
        if (!meso_text_word(line, &word))
            return meso_text_wrong(piece, line->begin, "face has %lld corners instead of %.*s", (long long)i,
                                   MESO_WORD_ARGUMENTS(number));
        if (!meso_word_integer(word, &vertex) || vertex < 0 || vertex >= UINT32_MAX)
            return meso_text_wrong(piece, line->begin, "face corner '%.*s' is not the index of a vertex",
                                   MESO_WORD_ARGUMENTS(word));
        if (i < counted)
            off->mesh->corners[(*corner)++] = (uint32_t)vertex;
    }
    return MESO_OK;
}

static void fill_piece(void *context, uint64_t begin, uint64_t end)
{
    const Off *off = context;
    MesoTextPiece *piece = &off->text.pieces[begin];
    uint64_t number = off->pieces[begin].lines_before;
    uint32_t corner = (uint32_t)off->pieces[begin].corners_before;
    MesoTextLine line = {.next = first_line(off, begin)};
    (void)end;
    for (; begin >= off->body_piece && meso_text_filled_line(&off->text, piece, line.next, &line); number++) {
        uint64_t face = number - off->vertex_count;
        MesoStatus status = number < off->vertex_count ? read_vertex(off, piece, &line, (uint32_t)number)
                          : face < off->face_count     ? read_face(off, piece, &line, (uint32_t)face, &corner)
                          : meso_text_wrong(piece, line.begin, "more lines than the header counts");
        if (status)
            return;
    }
}

/* ---- all together ---- */

static MesoStatus check_end(const Off *off, MesoError *error)
{
    bool in_vertices = off->line_count < off->vertex_count;
    uint64_t before = in_vertices ? 0 : off->vertex_count, have = off->line_count - before;
    uint32_t wanted = in_vertices ? off->vertex_count : off->face_count;
    if (have >= wanted)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_INPUT, "%s:%u: file ends before %s %llu of %u", off->text.path,
                     meso_mesh_text_line_number(&off->text, off->text.size), in_vertices ? "vertex" : "face",
                     (unsigned long long)have + 1, wanted);
}

MesoStatus meso_off_read(MesoPolygonMesh *mesh, MesoArena *arena, const MesoInput *input, uint32_t thread_count,
                         MesoError *error)
{
    Off off = {.mesh = mesh};
    MesoArena scratch;
    *mesh = (MesoPolygonMesh){0};
    meso_arena_init(&scratch);
    MesoStatus status = meso_mesh_text_init(&off.text, &scratch, input, 0, '#', false, error);
    if (!status)
        status = read_header(&off, error);
    if (!status)
        status = count(&off, thread_count, &scratch, error);
    if (!status)
        status = make_room(&off, arena, error);
    if (!status) {
        meso_mesh_text_for(&off.text, thread_count, fill_piece, &off);
        status = meso_mesh_text_status(&off.text, error);
    }
    if (!status)
        status = check_end(&off, error);
    meso_arena_release(&scratch);
    return status;
}

uint32_t meso_off_face_line(MesoArena *scratch, const MesoInput *input, uint32_t face)
{
    Off off = {0};
    OffHeader header = {.off = &off};
    if (meso_mesh_text_init(&off.text, scratch, input, 0, '#', false, NULL) || read_header(&off, NULL))
        return 0;
    for (uint64_t line = 0; line <= (uint64_t)off.vertex_count + face; line++)
        if (!next_line(&header))
            return 0;
    return meso_mesh_text_line_number(&off.text, meso_text_offset(&off.text.pieces[off.body_piece], header.line.begin));
}
