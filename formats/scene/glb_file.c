/*
 * GLB with KHR_draco_mesh_compression: each material is a mesh whose geometry
 * is cut into pieces, so that all cores encode at once and a viewer need not
 * decode everything before it shows something.
 */
#include <stdatomic.h>

#include "formats/scene/draco_mesh.h"
#include "formats/scene/gltf_adapter.h"
#include "formats/scene/mesh_file.h"
#include "formats/scene/mesh_window.h"
#include "libcore/base/parallel.h"

/* Half a million triangles a piece; only a larger part makes a larger piece. */
enum { PIECE_FACES = 1 << 18 };

/* A run of parts of one material, no larger than a piece. */
typedef struct Run {
    MesoPartRange range;
    uint32_t material;
    uint64_t face_count;
} Run;

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

/* Runs in the order of the parts; `runs` NULL only counts. */
static uint32_t cut_runs(const MesoSceneParts *parts, Run *runs)
{
    uint32_t count = 0;
    for (uint32_t part = 0; part < parts->part_count;) {
        Run run = {{part, part}, meso_scene_part(parts, part).material, 0};
        uint64_t first = parts->face_begin[part];
        do
            part++;
        while (part < parts->part_count && parts->face_begin[part + 1] - first <= PIECE_FACES &&
               meso_scene_part(parts, part).material == run.material);
        run.range.end = part;
        run.face_count = parts->face_begin[part] - first;
        if (run.face_count == 0)
            continue;
        if (runs)
            runs[count] = run;
        count++;
    }
    return count;
}

/* Puts runs of one material next to each other, otherwise in the order that they had. */
static void sort_runs(const Run *runs, uint32_t count, uint32_t *bins, uint32_t bin_count, Run *sorted)
{
    for (uint32_t i = 0; i < count; i++)
        bins[runs[i].material + 1]++;
    for (uint32_t m = 0; m < bin_count; m++)
        bins[m + 1] += bins[m];
    for (uint32_t i = 0; i < count; i++)
        sorted[bins[runs[i].material]++] = runs[i];
}

static void join_runs(Encoding *encoding, const Run *runs, uint32_t count)
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
    const MesoSceneParts *parts = encoding->parts;
    uint32_t count = cut_runs(parts, NULL);
    uint32_t material_count = parts->scene->material_count;
    Run *runs = MESO_NEW(arena, Run, count, error);
    Run *sorted = MESO_NEW(arena, Run, count, error);
    uint32_t *bins = MESO_NEW(arena, uint32_t, (size_t)material_count + 1, error);
    encoding->ranges = MESO_NEW(arena, MesoPartRange, count, error);
    encoding->pieces = MESO_NEW(arena, Piece, count, error);
    if (!runs || !sorted || !bins || !encoding->ranges || !encoding->pieces)
        return MESO_ERR_MEMORY;
    cut_runs(parts, runs);
    sort_runs(runs, count, bins, material_count, sorted);
    join_runs(encoding, sorted, count);
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
            continue;   /* too large already, as the adapter will find */
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

static MesoStatus make_meshes(const Encoding *encoding, MesoGltfScene *scene, MesoArena *arena,
                              MesoError *error)
{
    const MesoSceneParts *parts = encoding->parts;
    MesoGltfMesh *meshes = MESO_NEW(arena, MesoGltfMesh, encoding->piece_count, error);
    if (!meshes)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < encoding->piece_count; i++) {
        uint32_t material = encoding->pieces[i].material;
        if (i == 0 || material != encoding->pieces[i - 1].material) {
            char name[MESO_MESH_NAME];
            meso_mesh_material_name(parts->scene, material, name);
            MesoGltfMesh *mesh = &meshes[scene->mesh_count++];
            mesh->name = meso_arena_copy_text(arena, name, error);
            mesh->material = &parts->scene->materials[material];
            mesh->piece_begin = i;
            if (!mesh->name)
                return MESO_ERR_MEMORY;
        }
        meshes[scene->mesh_count - 1].piece_end = i + 1;
    }
    scene->meshes = meshes;
    return MESO_OK;
}

static MesoStatus make_asset(const Encoding *encoding, MesoGltfScene *scene, MesoArena *arena,
                             MesoError *error)
{
    const MesoProvenance *provenance = encoding->options->provenance;
    scene->generator = meso_arena_print(arena, error, "%s %s", provenance ? provenance->tool : "meso", MESO_VERSION);
    scene->provenance = meso_mesh_provenance(encoding->options, arena, error);
    if (!scene->generator || !scene->provenance)
        return MESO_ERR_MEMORY;
    scene->channel_count = encoding->parts->scene->channel_count;
    scene->channels = encoding->parts->scene->channels;
    scene->colored = encoding->draco.colored;
    scene->smaller = encoding->options->smaller;
    return MESO_OK;
}

static MesoStatus append(void *output, const void *data, size_t size, MesoError *error)
{
    return meso_output_write(output, data, size, error);
}

static MesoStatus run(Encoding *encoding, MesoArena *arena, MesoOutput *output, MesoError *error)
{
    MesoGltfScene scene = {0};
    MesoStatus status = make_pieces(encoding, arena, error);
    if (!status)
        status = meso_draco_options_make(&encoding->draco, encoding->parts, encoding->options, error);
    encoding->draco.for_gltf = true;
    if (!status)
        status = encode_all(encoding, arena, error);
    if (status)
        return status;
    drop_empty(encoding);
    scene.pieces = encoding->results;
    status = make_meshes(encoding, &scene, arena, error);
    if (!status)
        status = make_asset(encoding, &scene, arena, error);
    if (status)
        return status;
    if (scene.mesh_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "no geometry to write: all triangles are degenerate");
    return meso_gltf_write(&scene, append, output, error);
}

MesoStatus meso_glb_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                          MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    Encoding encoding = {.parts = parts, .options = options, .reporting = ATOMIC_FLAG_INIT};
    meso_arena_init(&arena);
    MesoStatus status = meso_mesh_check_counts(parts, options, "a GLB file", error);
    if (!status)
        status = run(&encoding, &arena, output, error);
    for (uint32_t i = 0; encoding.results && i < encoding.piece_count; i++)
        meso_draco_result_release(&encoding.results[i]);
    meso_arena_release(&arena);
    return status;
}
