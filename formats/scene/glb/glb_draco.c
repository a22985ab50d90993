/*
 * GLB with KHR_draco_mesh_compression: each material is a mesh whose geometry
 * is cut into pieces, so that all cores encode at once and a viewer need not
 * decode everything before it shows something.
 */
#include <stdatomic.h>
#include <string.h>

#include "formats/scene/glb/glb_parts.h"
#include "libcore/base/parallel.h"

/* Half a million triangles a piece; only a larger part makes a larger piece. */
enum { PIECE_FACES = 1 << 18 };

/* Runs of one material that become one primitive. */
typedef struct Piece {
    uint32_t range_begin, range_end;
    uint32_t material;
    uint64_t face_count;
} Piece;

/* What all pieces are made from, and what became of each. */
typedef struct Encoding {
    const MesoSceneParts *parts;
    const MesoMeshWriteOptions *options;
    MesoDracoOptions draco;
    MesoPartRange *ranges;
    Piece *pieces;              /* [piece_count] by material */
    uint32_t piece_count;
    MesoDracoResult *results;   /* [piece_count] */
    MesoStatus *status;
    MesoError *errors;
    atomic_uint_fast64_t faces_done, bytes;
    atomic_flag reporting;
} Encoding;

static void join_runs(Encoding *encoding, const MesoGlbRun *runs, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        Piece *last = encoding->piece_count ? &encoding->pieces[encoding->piece_count - 1] : NULL;
        encoding->ranges[i] = runs[i].range;
        if (last && last->material == runs[i].material &&
            last->face_count + runs[i].face_count <= PIECE_FACES) {
            last->range_end = i + 1;
            last->face_count += runs[i].face_count;
        } else {
            encoding->pieces[encoding->piece_count++] =
                (Piece){i, i + 1, runs[i].material, runs[i].face_count};
        }
    }
}

static MesoStatus make_pieces(Encoding *encoding, MesoArena *arena, MesoError *error)
{
    MesoGlbRun *runs;
    uint32_t count;
    MesoStatus status = meso_glb_runs(&runs, &count, encoding->parts, PIECE_FACES, UINT32_MAX, arena, error);
    if (status)
        return status;
    encoding->ranges = MESO_NEW(arena, MesoPartRange, count, error);
    encoding->pieces = MESO_NEW(arena, Piece, count, error);
    if (!encoding->ranges || !encoding->pieces)
        return MESO_ERR_MEMORY;
    join_runs(encoding, runs, count);
    return MESO_OK;
}

/* One thread at a time reports; the others pass on. */
static void report(Encoding *encoding, uint64_t faces)
{
    const MesoSceneParts *parts = encoding->parts;
    const MesoMeshWriteOptions *options = encoding->options;
    uint64_t done = atomic_fetch_add(&encoding->faces_done, faces) + faces;
    if (!options->progress || atomic_flag_test_and_set(&encoding->reporting))
        return;
    double share = (double)done / (double)parts->face_begin[parts->part_count];
    options->progress(options->progress_context, (uint64_t)(share * (double)parts->triangle_count),
                      parts->triangle_count);
    atomic_flag_clear(&encoding->reporting);
}

static void encode_pieces(void *context, uint64_t begin, uint64_t end)
{
    Encoding *encoding = context;
    for (uint64_t i = begin; i < end; i++) {
        const Piece *piece = &encoding->pieces[i];
        if (atomic_load(&encoding->bytes) > UINT32_MAX)
            continue;   /* too large already, as the heads will find */
        encoding->status[i] = meso_draco_encode_parts(
            encoding->parts, piece->range_end - piece->range_begin,
            encoding->ranges + piece->range_begin, &encoding->draco, &encoding->results[i],
            &encoding->errors[i]);
        atomic_fetch_add(&encoding->bytes, encoding->results[i].size);
        report(encoding, piece->face_count);
    }
}

static MesoStatus encode_all(Encoding *encoding, MesoArena *arena, MesoError *error)
{
    uint32_t count = encoding->piece_count;
    MesoDracoResult *results = MESO_NEW(arena, MesoDracoResult, count, error);
    encoding->status = MESO_NEW(arena, MesoStatus, count, error);
    encoding->errors = MESO_NEW(arena, MesoError, count, error);
    if (!results || !encoding->status || !encoding->errors)
        return MESO_ERR_MEMORY;
    encoding->results = results;
    meso_parallel_for(encoding->options->thread_count, count, 1, encode_pieces, encoding);
    for (uint32_t i = 0; i < count; i++)
        if (encoding->status[i]) {
            if (error)
                *error = encoding->errors[i];
            return encoding->status[i];
        }
    return MESO_OK;
}

/* A piece whose triangles were all degenerate is no primitive: glTF wants at least one triangle. */
static void drop_empty(Encoding *encoding)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < encoding->piece_count; i++) {
        if (encoding->results[i].data && encoding->results[i].triangle_count == 0) {
            meso_draco_result_release(&encoding->results[i]);
            continue;
        }
        encoding->pieces[kept] = encoding->pieces[i];
        encoding->results[kept++] = encoding->results[i];
    }
    encoding->piece_count = kept;
}

/* What Draco made, each from a multiple of 4 on; returns the size of all. */
static uint64_t place(const Encoding *encoding, MesoGlbPrimitive *primitives)
{
    uint64_t size = 0;
    for (uint32_t i = 0; i < encoding->piece_count; i++) {
        const MesoDracoResult *result = &encoding->results[i];
        primitives[i] = (MesoGlbPrimitive){
            .material = encoding->pieces[i].material, .vertex_count = result->vertex_count,
            .triangle_count = result->triangle_count, .low = result->decoded_low, .high = result->decoded_high,
            .vertices_at = size, .draco = result};
        size += (result->size + 3) & ~(uint64_t)3;
    }
    return size;
}

static MesoStatus write_pieces(Encoding *encoding, MesoOutput *output, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < encoding->piece_count && !status; i++) {
        MesoDracoResult *result = &encoding->results[i];
        status = meso_output_write(output, result->data, result->size, error);
        if (!status)
            status = meso_output_write(output, "\0\0\0", (4 - result->size % 4) % 4, error);
        meso_draco_result_release(result);
    }
    return status;
}

static MesoStatus write_file(Encoding *encoding, MesoArena *arena, MesoOutput *output, MesoError *error)
{
    uint32_t head[5], binary_head[2];
    MesoGlbPrimitive *primitives = MESO_NEW(arena, MesoGlbPrimitive, encoding->piece_count, error);
    if (!primitives)
        return MESO_ERR_MEMORY;
    uint64_t size = place(encoding, primitives);
    const char *text = meso_glb_json(encoding->parts, encoding->options, primitives, encoding->piece_count, size, arena,
                                     error);
    if (!text)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_glb_heads(head, binary_head, strlen(text), size, encoding->options, error);
    if (!status)
        status = meso_output_write(output, head, sizeof head, error);
    if (!status)
        status = meso_output_write(output, text, strlen(text), error);
    if (!status)
        status = meso_output_write(output, binary_head, sizeof binary_head, error);
    return status ? status : write_pieces(encoding, output, error);
}

static MesoStatus run(Encoding *encoding, MesoArena *arena, MesoOutput *output, MesoError *error)
{
    MesoStatus status = make_pieces(encoding, arena, error);
    if (!status)
        status = meso_draco_options_make(&encoding->draco, encoding->parts, encoding->options, error);
    encoding->draco.for_gltf = true;
    if (!status)
        status = encode_all(encoding, arena, error);
    if (status)
        return status;
    drop_empty(encoding);
    if (encoding->piece_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "no geometry to write: all triangles are degenerate");
    return write_file(encoding, arena, output, error);
}

MesoStatus meso_glb_write_draco(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                MesoError *error)
{
    MesoArena arena;
    Encoding encoding = {.parts = parts, .options = options, .reporting = ATOMIC_FLAG_INIT};
    meso_arena_init(&arena);
    MesoStatus status = run(&encoding, &arena, output, error);
    for (uint32_t i = 0; encoding.results && i < encoding.piece_count; i++)
        meso_draco_result_release(&encoding.results[i]);
    meso_arena_release(&arena);
    return status;
}
