/*
 * GLB with EXT_meshopt_compression: whole numbers for positions, octahedral normals, the rest as it is, each a stream
 * of its own that a GPU's memory takes as it is decoded. Pieces of each material are encoded on all cores, some at a
 * time, and written in order; what the JSON part says of them is known only then, so it is written last, into room that
 * is left for it.
 */
#include <math.h>
#include <meshoptimizer.h>
#include <stdlib.h>
#include <string.h>

#include "formats/scene/glb/glb_parts.h"
#include "libcore/base/parallel.h"

/* A quarter of a million triangles a piece, and pieces in memory at once. */
enum { PIECE_FACES = 1 << 17, BATCH = 16 };

enum { NORMALS_AT_ONCE = 64, POSITION_BITS = 14, NORMAL_BITS = 10, MOST_BITS = 16 };

/* One piece: its streams, one behind the other, each from a multiple of 4 on. */
typedef struct Encoded {
    uint8_t *data;              /* by malloc() */
    size_t size;
    MesoStatus status;
} Encoded;

typedef struct Writer {
    const MesoSceneParts *parts;
    const MesoMeshWriteOptions *options;
    MesoArena *arena;
    MesoGlbRun *runs;               /* [piece_count] by material */
    uint32_t piece_count;
    MesoGlbPrimitive *primitives;   /* [piece_count] */
    MesoGlbMeshopt *streams;        /* [piece_count] of them */
    Encoded *encoded;               /* [BATCH] */
    uint32_t batch_begin;
    MesoVec3 origin;
    float step;
    uint32_t steps;                 /* the most */
    int normal_bits;
    bool colored;
    size_t json_size;
} Writer;

/* ---- one piece ---- */

/* What a piece is made from, and a row of it after another. */
typedef struct Piece {
    const Writer *writer;
    MesoGlbRun run;
    uint32_t vertex_count, index_count;
    MesoMeshVertex *vertices;
    uint32_t *indices;
    uint8_t *row;                   /* [8 * vertex_count] */
    Encoded *out;
    size_t room;
    MesoGlbMeshopt *streams;
} Piece;

static void put_positions(const Piece *piece, MesoGlbPrimitive *primitive)
{
    const Writer *w = piece->writer;
    float low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {0, 0, 0};
    uint16_t *to = (uint16_t *)(void *)piece->row;
    for (uint32_t v = 0; v < piece->vertex_count; v++, to += 4) {
        MesoVec3 p = meso_vec3_sub(piece->vertices[v].position, w->origin);
        const float at[3] = {p.x, p.y, p.z};
        for (uint32_t k = 0; k < 3; k++) {
            float number = fminf(fmaxf(roundf(at[k] / w->step), 0), (float)w->steps);
            low[k] = fminf(low[k], number);
            high[k] = fmaxf(high[k], number);
            to[k] = (uint16_t)number;
        }
        to[3] = 0;
    }
    primitive->low = (MesoVec3){low[0], low[1], low[2]};
    primitive->high = (MesoVec3){high[0], high[1], high[2]};
}

static void put_normals(const Piece *piece, uint32_t stride)
{
    for (uint32_t begin = 0; begin < piece->vertex_count; begin += NORMALS_AT_ONCE) {
        float block[4 * NORMALS_AT_ONCE];
        uint32_t left = piece->vertex_count - begin, count = left < NORMALS_AT_ONCE ? left : NORMALS_AT_ONCE;
        for (uint32_t i = 0; i < count; i++) {
            MesoVec3 n = piece->vertices[begin + i].normal;
            const float four[4] = {n.x, n.y, n.z, 0};
            memcpy(block + 4 * i, four, sizeof four);
        }
        meshopt_encodeFilterOct(piece->row + (size_t)stride * begin, count, stride, piece->writer->normal_bits, block);
    }
}

static void put_uvs(const Piece *piece)
{
    for (uint32_t v = 0; v < piece->vertex_count; v++)
        memcpy(piece->row + (size_t)8 * v, &piece->vertices[v].uv, 8);
}

static void put_colors(const Piece *piece)
{
    const MesoSceneParts *parts = piece->writer->parts;
    MesoMeshColor *colors = (MesoMeshColor *)(void *)(piece->row + (size_t)4 * piece->vertex_count);
    meso_scene_colors(parts, piece->run.range.begin, piece->run.range.end, colors);
    for (uint32_t v = 0; v < piece->vertex_count; v++) {
        const uint8_t four[4] = {colors[v].r, colors[v].g, colors[v].b, 0};
        memcpy(piece->row + (size_t)4 * v, four, sizeof four);
    }
}

static void put_ids(const Piece *piece, uint32_t channel)
{
    const MesoSceneParts *parts = piece->writer->parts;
    uint32_t *to = (uint32_t *)(void *)piece->row;
    for (uint32_t part = piece->run.range.begin; part < piece->run.range.end; part++) {
        uint32_t id = meso_scene_id(parts->scene, meso_scene_part(parts, part).ids, channel);
        for (uint64_t v = parts->vertex_begin[part]; v < parts->vertex_begin[part + 1]; v++)
            *to++ = id;
    }
}

static bool close_stream(Piece *piece, MesoGlbStream *stream, uint32_t stride, size_t size)
{
    size_t padded = (size + 3) & ~(size_t)3;
    memset(piece->out->data + piece->out->size + size, 0, padded - size);
    *stream = (MesoGlbStream){.at = piece->out->size, .size = size, .stride = stride};
    piece->out->size += padded;
    return size > 0;
}

static bool encode_rows(Piece *piece, MesoGlbStream *stream, uint32_t stride)
{
    size_t size = meshopt_encodeVertexBuffer(piece->out->data + piece->out->size, piece->room - piece->out->size,
                                             piece->row, piece->vertex_count, stride);
    return close_stream(piece, stream, stride, size);
}

static bool encode_indices(Piece *piece)
{
    size_t size = meshopt_encodeIndexBuffer(piece->out->data + piece->out->size, piece->room - piece->out->size,
                                            piece->indices, piece->index_count);
    return close_stream(piece, &piece->streams->of[MESO_GLB_INDICES], 4, size);
}

static bool encode_streams(Piece *piece, MesoGlbPrimitive *primitive)
{
    const Writer *w = piece->writer;
    MesoGlbStream *of = piece->streams->of;
    uint32_t normal_stride = w->normal_bits > 8 ? 8 : 4;
    bool fits = encode_indices(piece);
    put_positions(piece, primitive);
    fits = fits && encode_rows(piece, &of[MESO_GLB_POSITION], 8);
    put_normals(piece, normal_stride);
    fits = fits && encode_rows(piece, &of[MESO_GLB_NORMAL], normal_stride);
    put_uvs(piece);
    fits = fits && encode_rows(piece, &of[MESO_GLB_UV], 8);
    if (w->colored) {
        put_colors(piece);
        fits = fits && encode_rows(piece, &of[MESO_GLB_COLOR], 4);
    }
    for (uint32_t c = 0; c < w->parts->scene->channel_count; c++) {
        put_ids(piece, c);
        fits = fits && encode_rows(piece, &of[MESO_GLB_IDS + c], 4);
    }
    return fits;
}

/* Quads are cut along corners 0 and 2. */
static uint32_t make_indices(const Piece *piece, MesoMeshFace *faces)
{
    const MesoSceneParts *parts = piece->writer->parts;
    uint32_t count = 0;
    meso_scene_faces(parts, piece->run.range.begin, piece->run.range.end, 0, faces);
    for (uint64_t f = 0; f < piece->run.face_count; f++) {
        const uint32_t *v = faces[f].v, corners[6] = {v[0], v[1], v[2], v[0], v[2], v[3]};
        uint32_t corner_count = v[3] == MESO_NO_INDEX ? 3 : 6;
        memcpy(piece->indices + count, corners, corner_count * sizeof *corners);
        count += corner_count;
    }
    return count;
}

static MesoStatus encode_piece(Writer *w, uint32_t number, Encoded *out)
{
    const MesoSceneParts *parts = w->parts;
    Piece piece = {.writer = w, .run = w->runs[number], .out = out, .streams = &w->streams[number]};
    const MesoPartRange range = piece.run.range;
    MesoGlbPrimitive *primitive = &w->primitives[number];
    MesoArena arena;
    meso_arena_init(&arena);
    piece.vertex_count = (uint32_t)(parts->vertex_begin[range.end] - parts->vertex_begin[range.begin]);
    MesoMeshFace *faces = MESO_NEW(&arena, MesoMeshFace, piece.run.face_count, NULL);
    piece.vertices = MESO_NEW(&arena, MesoMeshVertex, piece.vertex_count, NULL);
    piece.indices = MESO_NEW(&arena, uint32_t, 6 * piece.run.face_count, NULL);
    piece.row = MESO_NEW(&arena, uint8_t, (size_t)8 * piece.vertex_count, NULL);
    MesoStatus status = MESO_ERR_MEMORY;
    if (faces && piece.vertices && piece.indices && piece.row) {
        piece.index_count = make_indices(&piece, faces);
        meso_scene_vertices(parts, range.begin, range.end, piece.vertices);
        piece.room = meshopt_encodeIndexBufferBound(piece.index_count, piece.vertex_count) + 4 +
                     (4 + parts->scene->channel_count) *
                         (meshopt_encodeVertexBufferBound(piece.vertex_count, 8) + 4);
        out->data = malloc(piece.room);
        out->size = 0;
        primitive->vertex_count = piece.vertex_count;
        primitive->triangle_count = piece.index_count / 3;
        if (out->data)
            status = encode_streams(&piece, primitive) ? MESO_OK : MESO_ERR_INTERNAL;
    }
    meso_arena_release(&arena);
    return status;
}

static void encode_range(void *context, uint64_t begin, uint64_t end)
{
    Writer *w = context;
    for (uint64_t i = begin; i < end; i++)
        w->encoded[i].status = encode_piece(w, w->batch_begin + (uint32_t)i, &w->encoded[i]);
}

/* ---- the file ---- */

static MesoStatus measure(Writer *w, MesoError *error)
{
    const MesoMeshWriteOptions *options = w->options;
    uint32_t bits = options->position_bits ? options->position_bits : POSITION_BITS;
    uint32_t normal_bits = options->normal_bits ? options->normal_bits : NORMAL_BITS;
    MesoBox box;
    MesoStatus status = meso_scene_parts_box(w->parts, options->thread_count, &box, error);
    if (status)
        return status;
    if (options->box)
        box = *options->box;
    if (bits > MOST_BITS)
        return meso_fail(error, MESO_ERR_LIMIT, "%u bits a position: meshopt is given at most %d", bits, MOST_BITS);
    MesoVec3 size = meso_vec3_sub(box.high, box.low);
    float most = fmaxf(fmaxf(size.x, size.y), size.z);
    w->steps = (1u << bits) - 1;
    w->step = most > 0 ? most / (float)w->steps : 1;
    w->origin = box.low;
    w->normal_bits = (int)normal_bits;
    w->colored = meso_scene_is_colored(w->parts->scene);
    return MESO_OK;
}

static MesoStatus allocate(Writer *w, MesoError *error)
{
    MesoStatus status = meso_glb_runs(&w->runs, &w->piece_count, w->parts, PIECE_FACES, UINT32_MAX, w->arena, error);
    if (status)
        return status;
    w->primitives = MESO_NEW(w->arena, MesoGlbPrimitive, w->piece_count, error);
    w->streams = MESO_NEW(w->arena, MesoGlbMeshopt, w->piece_count, error);
    w->encoded = MESO_NEW(w->arena, Encoded, BATCH, error);
    if (!w->primitives || !w->streams || !w->encoded)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < w->piece_count; i++) {
        w->streams[i] = (MesoGlbMeshopt){.origin = w->origin, .step = w->step};
        w->primitives[i] = (MesoGlbPrimitive){.material = w->runs[i].material, .meshopt = &w->streams[i]};
    }
    return MESO_OK;
}

/* Room for what the JSON part will say: with numbers as long as they can be. */
static MesoStatus leave_room(Writer *w, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(w->arena);
    MesoGlbPrimitive *longest = MESO_NEW(w->arena, MesoGlbPrimitive, w->piece_count, error);
    MesoGlbMeshopt *streams = MESO_NEW(w->arena, MesoGlbMeshopt, 1, error);
    if (!longest || !streams)
        return MESO_ERR_MEMORY;
    const MesoVec3 most = {65535, 65535, 65535};
    *streams = (MesoGlbMeshopt){.origin = w->origin, .step = w->step};
    for (uint32_t s = 0; s < MESO_GLB_STREAMS; s++)
        streams->of[s] = (MesoGlbStream){UINT32_MAX, UINT32_MAX, UINT64_MAX >> 16, 8};
    for (uint32_t i = 0; i < w->piece_count; i++)
        longest[i] = (MesoGlbPrimitive){.material = w->runs[i].material, .vertex_count = UINT32_MAX,
                                        .triangle_count = UINT32_MAX, .low = most, .high = most, .meshopt = streams};
    const char *text = meso_glb_json(w->parts, w->options, longest, w->piece_count, UINT32_MAX, w->arena, error);
    w->json_size = text ? strlen(text) : 0;
    meso_arena_rewind(w->arena, mark);
    return text ? MESO_OK : MESO_ERR_MEMORY;
}

/* Where a piece's streams lie, in the file and where they are decoded to. */
static void place_streams(MesoGlbMeshopt *streams, const MesoGlbPrimitive *primitive, uint64_t at, uint64_t *plain)
{
    for (uint32_t s = 0; s < MESO_GLB_STREAMS; s++) {
        MesoGlbStream *stream = &streams->of[s];
        uint64_t count = s == MESO_GLB_INDICES ? 3 * primitive->triangle_count : primitive->vertex_count;
        if (!stream->size)
            continue;
        stream->at += at;
        stream->plain_at = *plain;
        *plain += count * stream->stride;
    }
    streams->plain_end = *plain;
}

static MesoStatus write_batch(Writer *w, uint32_t count, MesoOutput *output, uint64_t *size, uint64_t *plain,
                              MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < count; i++) {
        Encoded *encoded = &w->encoded[i];
        uint32_t piece = w->batch_begin + i;
        if (!status && encoded->status)
            status = encoded->status == MESO_ERR_MEMORY
                ? meso_fail(error, MESO_ERR_MEMORY, "out of memory for a piece of the mesh")
                : meso_fail(error, encoded->status, "meshoptimizer has not encoded a piece of the mesh");
        if (!status) {
            place_streams(&w->streams[piece], &w->primitives[piece], *size, plain);
            status = meso_output_write_at(output, MESO_GLB_HEAD + w->json_size + MESO_GLB_BINARY_HEAD + *size,
                                          encoded->data, encoded->size, error);
        }
        *size += encoded->size;
        free(encoded->data);
        *encoded = (Encoded){0};
    }
    if (!status && *size > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "too large for a GLB file: over 4 GiB%s%s",
                         MESO_MESH_SMALLER(w->options));
    if (w->options->progress)
        w->options->progress(w->options->progress_context, w->batch_begin + count, w->piece_count);
    return status;
}

static MesoStatus write_json(Writer *w, uint64_t size, MesoOutput *output, MesoError *error)
{
    uint32_t head[5], binary_head[2];
    const char *text = meso_glb_json(w->parts, w->options, w->primitives, w->piece_count, size, w->arena, error);
    char *room = text ? meso_arena_alloc(w->arena, w->json_size, 1, error) : NULL;
    if (!room)
        return MESO_ERR_MEMORY;
    memset(room, ' ', w->json_size);
    memcpy(room, text, strlen(text));
    MesoStatus status = meso_glb_heads(head, binary_head, w->json_size, size, w->options, error);
    if (!status)
        status = meso_output_write_at(output, 0, head, sizeof head, error);
    if (!status)
        status = meso_output_write_at(output, MESO_GLB_HEAD, room, w->json_size, error);
    return status ? status : meso_output_write_at(output, MESO_GLB_HEAD + w->json_size, binary_head,
                                                  sizeof binary_head, error);
}

static MesoStatus write_all(Writer *w, MesoOutput *output, MesoError *error)
{
    uint64_t size = 0, plain = 0;
    MesoStatus status = measure(w, error);
    if (!status)
        status = allocate(w, error);
    if (!status)
        status = leave_room(w, error);
    for (w->batch_begin = 0; !status && w->batch_begin < w->piece_count; w->batch_begin += BATCH) {
        uint32_t left = w->piece_count - w->batch_begin, count = left < BATCH ? left : BATCH;
        meso_parallel_for(w->options->thread_count, count, 1, encode_range, w);
        status = write_batch(w, count, output, &size, &plain, error);
    }
    return status ? status : write_json(w, size, output, error);
}

MesoStatus meso_glb_write_meshopt(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                  MesoError *error)
{
    MesoArena arena;
    Writer w = {.parts = parts, .options = options, .arena = &arena};
    meso_arena_init(&arena);
    MesoStatus status = write_all(&w, output, error);
    meso_arena_release(&arena);
    return status;
}
