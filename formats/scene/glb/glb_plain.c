/*
 * GLB that nothing has to decompress. The rows of its vertices and its indices
 * are streamed in windows, material by material; what the JSON part says of
 * them is known only then, so it is written last, into room that is left for it.
 */
#include <float.h>
#include <math.h>
#include <pthread.h>
#include <string.h>

#include "formats/scene/glb/glb_parts.h"
#include "formats/scene/surface_frame.h"

enum { FRAME_BYTES = sizeof(MesoTangent) + sizeof(MesoVec2) };

/* One primitive while it is written. */
typedef struct Piece {
    uint32_t run_count;
    const MesoPartRange *ranges;    /* [run_count] in the order of the parts */
    const uint64_t *base;           /* [run_count] vertices before each */
    bool colored, lengths, tangents;
    uint32_t stride;
    pthread_mutex_t *lock;
    MesoBox *box;                   /* of its positions, under the lock */
    bool *finite;
} Piece;

/* ---- rows ---- */

static void bound(const Piece *piece, const MesoMeshVertex *vertices, uint64_t count)
{
    MesoBox box = meso_box_empty();
    bool finite = true;
    for (uint64_t i = 0; i < count; i++) {
        meso_box_add(&box, vertices[i].position);
        finite &= meso_vec3_finite(vertices[i].position) && meso_vec3_finite(vertices[i].normal);
    }
    pthread_mutex_lock(piece->lock);
    meso_box_add(piece->box, box.low);
    meso_box_add(piece->box, box.high);
    *piece->finite &= finite;
    pthread_mutex_unlock(piece->lock);
}

/* Colour and ids behind each vertex; 16 bits are the low half of an id. */
static uint8_t *format_part(const Piece *piece, const MesoSceneParts *parts, uint32_t part,
                            const MesoMeshVertex *vertices, const MesoMeshColor *colors, uint8_t *out)
{
    const MesoScene *scene = parts->scene;
    uint64_t count = parts->vertex_begin[part + 1] - parts->vertex_begin[part];
    uint32_t ids[MESO_ID_CHANNELS], row = meso_scene_part(parts, part).ids;
    for (uint32_t c = 0; c < scene->channel_count; c++)
        ids[c] = meso_scene_id(scene, row, c);
    for (uint64_t i = 0; i < count; i++, out += piece->stride) {
        uint8_t *next = out + sizeof *vertices;
        memcpy(out, &vertices[i], sizeof *vertices);
        if (piece->colored) {
            memcpy(next, &colors[i], sizeof *colors);
            next[3] = 0;
            next += 4;
        }
        memcpy(next, ids, sizeof *ids * scene->channel_count);
    }
    return out;
}

/* What stands at the end of the rows of a part. `scratch` holds what they are made from and made of. */
static void format_frames(const Piece *piece, const MesoSceneParts *parts, uint32_t part,
                          const MesoMeshVertex *vertices, uint8_t *scratch, uint8_t *out)
{
    uint64_t count = parts->vertex_begin[part + 1] - parts->vertex_begin[part];
    uint64_t face_count = parts->face_begin[part + 1] - parts->face_begin[part];
    MesoTangent *tangents = (MesoTangent *)(void *)scratch;
    MesoMeshFace *faces = (MesoMeshFace *)(void *)(tangents + count);
    MesoVec2 *lengths = (MesoVec2 *)(void *)(faces + face_count);
    uint8_t *end = out + piece->stride;
    if (piece->tangents) {
        meso_scene_faces(parts, part, part + 1, 0, faces);
        meso_surface_tangents(count, vertices, face_count, faces, tangents);
        end -= sizeof *tangents;
        for (uint64_t i = 0; i < count; i++)
            memcpy(end + i * piece->stride, &tangents[i], sizeof *tangents);
    }
    if (piece->lengths) {
        meso_surface_lengths(parts, part, vertices, lengths);
        end -= sizeof *lengths;
        for (uint64_t i = 0; i < count; i++)
            memcpy(end + i * piece->stride, &lengths[i], sizeof *lengths);
    }
}

static size_t format_vertices(const void *context, const MesoSceneParts *parts, uint32_t begin, uint32_t end,
                              uint8_t *out, uint8_t *scratch)
{
    const Piece *piece = context;
    uint64_t first = parts->vertex_begin[begin], count = parts->vertex_begin[end] - first;
    MesoMeshVertex *vertices = (MesoMeshVertex *)(void *)scratch;
    uint8_t *frames = (uint8_t *)(vertices + count);
    MesoMeshColor *colors = (MesoMeshColor *)(frames + (piece->lengths || piece->tangents
        ? count * FRAME_BYTES + (parts->face_begin[end] - parts->face_begin[begin]) * sizeof(MesoMeshFace) : 0));
    uint8_t *next = out;
    meso_scene_vertices(parts, begin, end, vertices);
    if (piece->colored)
        meso_scene_colors(parts, begin, end, colors);
    bound(piece, vertices, count);
    for (uint32_t part = begin; part < end; part++) {
        uint64_t at = parts->vertex_begin[part] - first;
        if (piece->lengths || piece->tangents)
            format_frames(piece, parts, part, vertices + at, frames, next);
        next = format_part(piece, parts, part, vertices + at, piece->colored ? colors + at : NULL, next);
    }
    return (size_t)(next - out);
}

/* ---- indices ---- */

/* Vertices of the primitive before a part of it. */
static uint64_t base_of(const Piece *piece, const MesoSceneParts *parts, uint32_t part)
{
    uint32_t low = 0, high = piece->run_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        if (piece->ranges[middle].begin <= part)
            low = middle;
        else
            high = middle;
    }
    return piece->base[low] + parts->vertex_begin[part] - parts->vertex_begin[piece->ranges[low].begin];
}

/* Quads are cut along corners 0 and 2. */
static size_t format_indices(const void *context, const MesoSceneParts *parts, uint32_t begin, uint32_t end,
                             uint8_t *out, uint8_t *scratch)
{
    MesoMeshFace *faces = (MesoMeshFace *)(void *)scratch;
    uint32_t *next = (uint32_t *)(void *)out;
    uint64_t count = parts->face_begin[end] - parts->face_begin[begin];
    meso_scene_faces(parts, begin, end, (uint32_t)base_of(context, parts, begin), faces);
    for (uint64_t i = 0; i < count; i++) {
        const uint32_t *v = faces[i].v;
        bool quad = v[3] != MESO_NO_INDEX;
        const uint32_t corners[6] = {v[0], v[1], v[2], v[0], v[2], v[3]};
        memcpy(next, corners, sizeof corners);      /* of the room of a quad */
        next += quad ? 6 : 3;
    }
    return (size_t)((uint8_t *)next - out);
}

/* ---- primitives ---- */

typedef struct Writer {
    MesoMeshStream stream;
    MesoArena *arena;
    MesoGlbRun *runs;               /* [run_count] by material */
    MesoPartRange *ranges;          /* [run_count] of the runs */
    uint64_t *base;                 /* [run_count] */
    uint32_t run_count, primitive_count;
    uint32_t *run_begin;            /* [primitive_count + 1] */
    MesoGlbPrimitive *primitives;   /* [primitive_count] */
    Piece *pieces;                  /* [primitive_count] */
    MesoBox *boxes;                 /* [primitive_count] */
    uint32_t apart;                 /* the part from which on each stands for a set of instances */
    MesoGlbInstances instances;
    pthread_mutex_t lock;
    bool finite;
    size_t json_size;               /* room for it */
    uint64_t binary_at;             /* offset of the binary part's data */
} Writer;

static MesoStatus allocate(Writer *w, MesoError *error)
{
    MesoStatus status = meso_glb_runs(&w->runs, &w->run_count, w->stream.parts, UINT64_MAX, w->apart, w->arena,
                                      error);
    if (status)
        return status;
    w->ranges = MESO_NEW(w->arena, MesoPartRange, w->run_count, error);
    w->base = MESO_NEW(w->arena, uint64_t, w->run_count, error);
    w->run_begin = MESO_NEW(w->arena, uint32_t, (size_t)w->run_count + 1, error);
    w->primitives = MESO_NEW(w->arena, MesoGlbPrimitive, w->run_count, error);
    w->pieces = MESO_NEW(w->arena, Piece, w->run_count, error);
    w->boxes = MESO_NEW(w->arena, MesoBox, w->run_count, error);
    bool complete = w->ranges && w->base && w->run_begin && w->primitives && w->pieces && w->boxes;
    return complete ? MESO_OK : MESO_ERR_MEMORY;
}

static void make_pieces(Writer *w)
{
    const MesoSceneParts *parts = w->stream.parts;
    const MesoMeshWriteOptions *options = w->stream.options;
    const Piece common = {.colored = meso_scene_is_colored(parts->scene), .lengths = options->lengths,
                          .tangents = options->tangents, .stride = meso_glb_stride(parts->scene, options),
                          .lock = &w->lock, .finite = &w->finite};
    for (uint32_t i = 0; i < w->run_count; i++) {
        const MesoPartRange range = w->runs[i].range;
        bool instanced = range.begin >= w->apart;
        if (i == 0 || w->runs[i].material != w->runs[i - 1].material || instanced) {
            w->run_begin[w->primitive_count] = i;
            w->boxes[w->primitive_count] = meso_box_empty();
            w->pieces[w->primitive_count] = common;
            w->pieces[w->primitive_count].box = &w->boxes[w->primitive_count];
            w->primitives[w->primitive_count] = (MesoGlbPrimitive){
                .material = w->runs[i].material,
                .instances = instanced ? &w->instances.sets[range.begin - w->apart] : NULL};
            w->primitive_count++;
        }
        MesoGlbPrimitive *primitive = &w->primitives[w->primitive_count - 1];
        w->ranges[i] = range;
        w->base[i] = primitive->vertex_count;
        primitive->vertex_count += parts->vertex_begin[range.end] - parts->vertex_begin[range.begin];
    }
    w->run_begin[w->primitive_count] = w->run_count;
    for (uint32_t p = 0; p < w->primitive_count; p++) {
        w->pieces[p].run_count = w->run_begin[p + 1] - w->run_begin[p];
        w->pieces[p].ranges = w->ranges + w->run_begin[p];
        w->pieces[p].base = w->base + w->run_begin[p];
    }
}

/* Room for what the JSON part will say: with numbers as long as they can be. */
static MesoStatus leave_room(Writer *w, MesoError *error)
{
    const MesoVec3 long_text = {-FLT_MIN, -FLT_MIN, -FLT_MIN};
    const MesoSceneParts *parts = w->stream.parts;
    MesoArenaMark mark = meso_arena_mark(w->arena);
    uint32_t head[5], binary_head[2];
    MesoGlbPrimitive *longest = MESO_NEW(w->arena, MesoGlbPrimitive, w->primitive_count, error);
    if (!longest)
        return MESO_ERR_MEMORY;
    for (uint32_t p = 0; p < w->primitive_count; p++)
        longest[p] = (MesoGlbPrimitive){
            .material = w->primitives[p].material, .vertex_count = UINT32_MAX / 64, .triangle_count = UINT32_MAX,
            .low = long_text, .high = long_text, .vertices_at = UINT32_MAX, .indices_at = UINT32_MAX,
            .instances = w->primitives[p].instances, .instances_at = UINT32_MAX};
    const char *text = meso_glb_json(parts, w->stream.options, longest, w->primitive_count, UINT32_MAX, w->arena,
                                     error);
    if (!text)
        return MESO_ERR_MEMORY;
    w->json_size = strlen(text);
    meso_arena_rewind(w->arena, mark);
    w->binary_at = MESO_GLB_HEAD + w->json_size + MESO_GLB_BINARY_HEAD;
    w->stream.offset = w->binary_at;
    uint64_t size = meso_glb_stride(parts->scene, w->stream.options) * parts->vertex_begin[parts->part_count] +
                    12 * parts->triangle_count;
    for (uint32_t i = 0; i < w->instances.set_count; i++)
        size += (sizeof(MesoGlbPose) + 4 * parts->scene->channel_count) * (uint64_t)w->instances.sets[i].count;
    return meso_glb_heads(head, binary_head, w->json_size, size, w->stream.options, error);
}

static MesoStatus write_binary(Writer *w, MesoError *error)
{
    const Piece *first = &w->pieces[0];
    bool framed = first->lengths || first->tangents;
    MesoMeshPass vertices = {.format = format_vertices, .vertex_bytes = first->stride,
                             .vertex_scratch = (uint32_t)(sizeof(MesoMeshVertex) + (framed ? FRAME_BYTES : 0) +
                                                          (first->colored ? sizeof(MesoMeshColor) : 0)),
                             .face_scratch = framed ? sizeof(MesoMeshFace) : 0};
    MesoMeshPass indices = {.format = format_indices, .face_bytes = 24, .face_scratch = sizeof(MesoMeshFace)};
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; !status && i < 2 * w->primitive_count; i++) {
        uint32_t p = i % w->primitive_count;
        bool rows = i < w->primitive_count;
        MesoGlbPrimitive *primitive = &w->primitives[p];
        MesoMeshPass *pass = rows ? &vertices : &indices;
        uint64_t begin = w->stream.offset;
        pass->context = &w->pieces[p];
        w->stream.ranges = w->pieces[p].ranges;
        w->stream.range_count = w->pieces[p].run_count;
        status = meso_mesh_stream_run(&w->stream, pass, primitive->vertex_count, error);
        *(rows ? &primitive->vertices_at : &primitive->indices_at) = begin - w->binary_at;
        if (!rows)
            primitive->triangle_count = (w->stream.offset - begin) / 12;
        primitive->low = w->boxes[p].low;
        primitive->high = w->boxes[p].high;
    }
    return status;
}

/* ---- instances ---- */

enum { INSTANCES_AT_ONCE = 512 };

/* Words [begin, end) of an instance: those of its pose, then an id a channel. */
static void instance_words(const MesoScene *scene, const MesoGlbInstanceSet *set, uint32_t instance, uint32_t begin,
                           uint32_t end, uint32_t *out)
{
    uint32_t words[sizeof(MesoGlbPose) / 4 + MESO_ID_CHANNELS];
    memcpy(words, &set->poses[instance], sizeof(MesoGlbPose));
    for (uint32_t c = 0; c < scene->channel_count; c++)
        words[sizeof(MesoGlbPose) / 4 + c] = meso_scene_id(scene, set->rows[instance], c);
    memcpy(out, words + begin, (end - begin) * sizeof *words);
}

/* The words [begin, end) of all instances of a set. */
static MesoStatus write_words(Writer *w, const MesoGlbInstanceSet *set, uint32_t begin, uint32_t end, MesoError *error)
{
    uint32_t words[INSTANCES_AT_ONCE * 4], width = end - begin;
    MesoStatus status = MESO_OK;
    for (uint32_t first = 0; first < set->count && !status; first += INSTANCES_AT_ONCE) {
        uint32_t left = set->count - first, count = left < INSTANCES_AT_ONCE ? left : INSTANCES_AT_ONCE;
        for (uint32_t i = 0; i < count; i++)
            instance_words(w->stream.parts->scene, set, first + i, begin, end, words + (size_t)i * width);
        status = meso_output_write_at(w->stream.output, w->stream.offset, words, (size_t)4 * width * count, error);
        w->stream.offset += (uint64_t)4 * width * count;
    }
    return status;
}

static MesoStatus write_instances(Writer *w, MesoError *error)
{
    static const uint32_t ends[] = {0, 3, 7, 10};
    MesoStatus status = MESO_OK;
    for (uint32_t p = 0; p < w->primitive_count; p++) {
        const MesoGlbInstanceSet *set = w->primitives[p].instances;
        if (!set)
            continue;
        w->primitives[p].instances_at = w->stream.offset - w->binary_at;
        for (uint32_t k = 0; k < 3 && !status; k++)
            status = write_words(w, set, ends[k], ends[k + 1], error);
        for (uint32_t c = 0; c < w->stream.parts->scene->channel_count && !status; c++)
            status = write_words(w, set, ends[3] + c, ends[3] + c + 1, error);
    }
    return status;
}

static MesoStatus write_json(Writer *w, MesoError *error)
{
    const uint64_t size = w->stream.offset - w->binary_at;
    uint32_t head[5], binary_head[2];
    const char *text = meso_glb_json(w->stream.parts, w->stream.options, w->primitives, w->primitive_count, size,
                                     w->arena, error);
    char *room = text ? meso_arena_alloc(w->arena, w->json_size, 1, error) : NULL;
    if (!room)
        return MESO_ERR_MEMORY;
    memset(room, ' ', w->json_size);
    memcpy(room, text, strlen(text));
    MesoStatus status = meso_glb_heads(head, binary_head, w->json_size, size, w->stream.options, error);
    if (!status)
        status = meso_output_write_at(w->stream.output, 0, head, sizeof head, error);
    if (!status)
        status = meso_output_write_at(w->stream.output, MESO_GLB_HEAD, room, w->json_size, error);
    return status ? status : meso_output_write_at(w->stream.output, MESO_GLB_HEAD + w->json_size, binary_head,
                                                  sizeof binary_head, error);
}

/* Says which part it is. */
static MesoStatus refuse_infinite(const Writer *w, MesoError *error)
{
    MesoBox box;
    return meso_scene_parts_box(w->stream.parts, w->stream.options->thread_count, &box, error);
}

static MesoStatus write_all(Writer *w, MesoError *error)
{
    MesoStatus status = allocate(w, error);
    if (status)
        return status;
    make_pieces(w);
    for (uint32_t p = 0; p < w->primitive_count; p++)
        w->stream.total += 2 * w->primitives[p].vertex_count;
    status = leave_room(w, error);
    if (!status)
        status = write_binary(w, error);
    if (!status)
        status = write_instances(w, error);
    if (!status && !w->finite)
        status = refuse_infinite(w, error);
    return status ? status : write_json(w, error);
}

MesoStatus meso_glb_write_plain(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                MesoError *error)
{
    MesoArena arena;
    Writer w = {.stream = {.parts = parts, .options = options, .output = output}, .arena = &arena, .finite = true,
                .apart = UINT32_MAX, .lock = PTHREAD_MUTEX_INITIALIZER};
    MesoStatus status = MESO_OK;
    meso_arena_init(&arena);
    if (options->instances) {
        status = meso_glb_instances_find(&w.instances, parts->scene, &arena, error);
        w.stream.parts = &w.instances.parts;
        w.apart = w.instances.first;
    }
    if (!status)
        status = write_all(&w, error);
    pthread_mutex_destroy(&w.lock);
    meso_arena_release(&arena);
    return status;
}
