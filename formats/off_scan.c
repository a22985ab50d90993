/* OFF, the ASCII "Object File Format" of Geomview (geomview.org/docs/html/OFF.html). */
#include <string.h>

#include "formats/mesh_scan.h"
#include "formats/mesh_text.h"

typedef struct Off {
    MesoMeshScan *scan;
    MesoMeshText text;
    bool normals;           /* each vertex has one */
    bool more;              /* colours or texture coordinates may follow */
    uint32_t vertex_count, face_count;
    char *begin;            /* the keyword; OpenMesh wants it first, on its own line */
} Off;

/* The keyword is [ST][C][N][4][n]OFF; what is not read by OpenMesh is blanked out of it. */
static MesoStatus read_keyword(Off *off, MesoError *error)
{
    MesoWord word = {0}, next = {0};
    if (!meso_mesh_text_filled_line(&off->text) || !meso_mesh_text_word(&off->text, &word) || word.size < 3 ||
        memcmp(word.text + word.size - 3, "OFF", 3) != 0)
        return meso_mesh_text_fail(&off->text, error, "not an OFF file: the first word is not OFF");
    char *at = word.text, *keyword = word.text + word.size - 3;
    if (keyword - at >= 2 && memcmp(at, "ST", 2) == 0) {
        off->more = true;
        at += 2;
    }
    if (*at == 'C') {
        off->more = true;
        at++;
    }
    off->normals = *at == 'N';
    at += off->normals;
    if (at != keyword)
        return meso_mesh_text_fail(&off->text, error, "OFF of the kind '%.*s' is not read, only OFF with the "
                                   "prefixes ST, C and N", MESO_WORD_ARGUMENTS(word));
    char *rest = off->text.at;
    if (meso_mesh_text_word(&off->text, &next) && meso_word_is(next, "BINARY"))
        return meso_mesh_text_fail(&off->text, error, "binary OFF is not read; write it as ASCII, or as PLY");
    off->text.at = rest;

    memset(word.text, ' ', word.size);
    memcpy(word.text, off->normals ? "NOFF" : "OFF", off->normals ? 4 : 3);
    if (rest < off->text.end) {
        *rest = '\n';
        off->text.at = rest + 1;
    }
    off->begin = word.text;
    return MESO_OK;
}

/* Vertices, faces, edges: on the line of the keyword or the next one. */
static MesoStatus read_counts(Off *off, MesoError *error)
{
    uint32_t counts[3] = {0};
    for (int i = 0; i < 3; i++) {
        MesoWord word;
        int64_t count;
        bool got = meso_mesh_text_word(&off->text, &word);
        if (!got && i == 0 && meso_mesh_text_filled_line(&off->text))
            got = meso_mesh_text_word(&off->text, &word);
        if (!got)
            return meso_mesh_text_fail(&off->text, error, "counts of vertices, faces and edges are missing");
        if (!meso_word_integer(word, &count) || count < 0 || count >= UINT32_MAX - 1)
            return meso_mesh_text_fail(&off->text, error, "count '%.*s' is not a number of elements",
                                       MESO_WORD_ARGUMENTS(word));
        counts[i] = (uint32_t)count;
    }
    MesoWord word;
    if (meso_mesh_text_word(&off->text, &word))
        return meso_mesh_text_fail(&off->text, error, "'%.*s' follows the counts", MESO_WORD_ARGUMENTS(word));
    off->vertex_count = counts[0];
    off->face_count = counts[1];
    return MESO_OK;
}

static MesoStatus next_element(Off *off, const char *kind, uint32_t number, uint32_t count, MesoError *error)
{
    if (!meso_mesh_text_filled_line(&off->text))
        return meso_mesh_text_fail(&off->text, error, "file ends before %s %u of %u", kind, number + 1, count);
    return MESO_OK;
}

static MesoStatus read_vertex(Off *off, MesoError *error)
{
    float numbers[6] = {0};
    MesoWord word;
    uint32_t wanted = off->normals ? 6 : 3;
    for (uint32_t i = 0; i < wanted; i++) {
        if (!meso_mesh_text_word(&off->text, &word))
            return meso_mesh_text_fail(&off->text, error, "vertex has %u numbers instead of %u", i, wanted);
        MesoStatus status = meso_word_number(&off->text, word, i < 3 ? "coordinate" : "normal", &numbers[i], error);
        if (status)
            return status;
    }
    char *rest = off->text.at;
    if (meso_mesh_text_word(&off->text, &word) && !off->more)
        return meso_mesh_text_fail(&off->text, error, "vertex has more than %u numbers", wanted);
    memset(rest, ' ', (size_t)(off->text.end - rest));

    MesoStatus status = meso_mesh_scan_vertex(off->scan, (MesoVec3){numbers[0], numbers[1], numbers[2]}, error);
    if (!status && off->normals)
        status = meso_mesh_scan_normal(off->scan, (MesoVec3){numbers[3], numbers[4], numbers[5]}, error);
    return status;
}

/* The number of corners, their vertices, and perhaps a colour, which is blanked out. */
static MesoStatus read_face(Off *off, MesoError *error)
{
    MesoWord word = {0}, number = {0};
    int64_t count, vertex;
    meso_mesh_text_word(&off->text, &number);
    if (!meso_word_integer(number, &count) || count < 0)
        return meso_mesh_text_fail(&off->text, error, "face has '%.*s' corners", MESO_WORD_ARGUMENTS(number));
    for (int64_t i = 0; i < count; i++) {
        if (!meso_mesh_text_word(&off->text, &word))
            return meso_mesh_text_fail(&off->text, error, "face has %lld corners instead of %.*s", (long long)i,
                                       MESO_WORD_ARGUMENTS(number));
        if (!meso_word_integer(word, &vertex) || vertex < 0 || vertex >= UINT32_MAX)
            return meso_mesh_text_fail(&off->text, error, "face corner '%.*s' is not the index of a vertex",
                                       MESO_WORD_ARGUMENTS(word));
        MesoStatus status = meso_mesh_scan_corner(off->scan, (uint32_t)vertex, MESO_NO_INDEX, error);
        if (status)
            return status;
    }
    memset(off->text.at, ' ', (size_t)(off->text.end - off->text.at));
    return meso_mesh_scan_face(off->scan, off->text.line, error);
}

MesoStatus meso_off_scan(MesoMeshScan *scan, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    Off off = {.scan = scan};
    *scan = (MesoMeshScan){.arena = arena};
    MesoStatus status = meso_mesh_text_init(&off.text, arena, input, '#', error);
    if (!status)
        status = read_keyword(&off, error);
    if (!status)
        status = read_counts(&off, error);
    for (uint32_t v = 0; v < off.vertex_count && !status; v++) {
        status = next_element(&off, "vertex", v, off.vertex_count, error);
        if (!status)
            status = read_vertex(&off, error);
    }
    for (uint32_t f = 0; f < off.face_count && !status; f++) {
        status = next_element(&off, "face", f, off.face_count, error);
        if (!status)
            status = read_face(&off, error);
    }
    if (!status && meso_mesh_text_filled_line(&off.text))
        status = meso_mesh_text_fail(&off.text, error, "more lines than the header counts");
    if (status)
        return status;
    scan->bytes = off.begin;
    scan->size = (size_t)(off.text.bytes + off.text.size - off.begin);
    if (scan->normal_count && scan->corner_count)
        memcpy(scan->corner_normals, scan->corner_vertices, scan->corner_count * sizeof *scan->corner_normals);
    return meso_mesh_scan_check(scan, input->path, error);
}
