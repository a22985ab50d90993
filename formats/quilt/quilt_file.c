#include "formats/quilt/quilt_file.h"

#include <stdlib.h>
#include <string.h>
#include <xxhash.h>

#include "formats/json/json_text.h"
#include "formats/scene/material_json.h"

enum { MINOR = 1 };

/* How the numbers of everything lie in the file. */
typedef struct StoredHead {
    uint32_t vertices, triangles, elements, base_vertices, base_triangles, swatch_vertices, swatch_triangles,
        swatch_elements;
} StoredHead;

typedef struct StoredSurface {
    uint32_t vertices, faces, corners, embedding;
    uint64_t hash[2];
} StoredSurface;

_Static_assert(sizeof(MesoQuiltVertex) == 16 && sizeof(StoredHead) == 32 && sizeof(StoredSurface) == 32,
               "layout of the chunks");

/* Weights of what lies beyond a border are not in [0, 1]; these would be far beyond. */
static const float WEIGHT_LIMIT = 1e6f;

MesoSurfaceMark meso_surface_mark(const MesoPolygonMesh *mesh)
{
    MesoSurfaceMark mark = {mesh->vertex_count, mesh->face_count, mesh->corner_count, {0, 0}};
    XXH128_hash_t hash = XXH3_128bits_withSeed(mesh->corners, mesh->corner_count * sizeof *mesh->corners,
                                               mesh->side_count);
    if (mesh->face_begin)
        hash = XXH3_128bits_withSeed(mesh->face_begin, ((size_t)mesh->face_count + 1) * sizeof *mesh->face_begin,
                                     hash.high64 ^ hash.low64);
    mark.hash[0] = hash.high64;
    mark.hash[1] = hash.low64;
    return mark;
}

/* ---- writing ---- */

/* To be freed; NULL where memory is out. */
static char *describe_looks(const MesoSwatch *swatch)
{
    json_t *root = json_object();
    int failed = json_object_set_new(root, "materials", meso_materials_to_json(swatch->material_count, swatch->looks,
                                                                               swatch->material_names));
    char *text = failed ? NULL : json_dumps(root, JSON_COMPACT);
    json_decref(root);
    return text;
}

static void add_quilt(MesoContainer *container, const MesoQuilt *q)
{
    const uint64_t index = sizeof(uint32_t), elements = q->element_count;
    meso_container_add(container, "vertex", q->vertices, q->vertex_count * sizeof *q->vertices);
    meso_container_add(container, "origin", q->origins, q->vertex_count * index);
    meso_container_add(container, "corner", q->corners, 3 * index * q->triangle_count);
    meso_container_add(container, "triorig", q->triangle_origins, q->triangle_count * index);
    meso_container_add(container, "patch", q->patches, q->triangle_count * index);
    meso_container_add(container, "vbegin", q->vertex_begin, (elements + 1) * index);
    meso_container_add(container, "tbegin", q->triangle_begin, (elements + 1) * index);
    meso_container_add(container, "elemorig", q->element_origins, elements * index);
}

static void add_base(MesoContainer *container, const MesoQuiltFile *file)
{
    const MesoTriangulation *base = &file->base;
    meso_container_add(container, "basepos", base->positions, base->vertex_count * sizeof *base->positions);
    meso_container_add(container, "basecorn", base->corners, base->triangle_count * 3 * sizeof *base->corners);
    meso_container_add(container, "baseorig", base->origins, base->vertex_count * sizeof *base->origins);
    meso_container_add(container, "baseuv", file->base_uvs,
                       file->base_uvs ? base->triangle_count * 3 * sizeof *file->base_uvs : 0);
}

static void add_swatch(MesoContainer *container, const MesoSwatch *s)
{
    const uint64_t corners = 3 * (uint64_t)s->triangle_count, index = sizeof(uint32_t);
    meso_container_add(container, "swpos", s->positions, s->vertex_count * sizeof *s->positions);
    meso_container_add(container, "swcorn", s->corners, corners * index);
    meso_container_add(container, "swtwin", s->twins, corners * index);
    meso_container_add(container, "swmat", s->materials, s->triangle_count * index);
    meso_container_add(container, "swuv", s->uvs, s->uvs ? s->vertex_count * sizeof *s->uvs : 0);
    meso_container_add(container, "swcuv", s->corner_uvs, s->corner_uvs ? corners * sizeof *s->corner_uvs : 0);
}

static MesoStatus write_chunks(const MesoQuiltFile *file, const char *provenance, const char *looks, MesoOutput *output,
                               MesoError *error)
{
    const StoredHead head = {
        file->quilt.vertex_count, file->quilt.triangle_count, file->quilt.element_count, file->base.vertex_count,
        file->base.triangle_count, file->swatch.vertex_count, file->swatch.triangle_count, file->swatch.element_count};
    const StoredSurface surface = {file->surface.vertex_count, file->surface.face_count, file->surface.corner_count,
                                   file->embedding, {file->surface.hash[0], file->surface.hash[1]}};
    MesoContainer container = {.kind = "quilt", .major = MESO_QUILT_MAJOR, .minor = MINOR};
    meso_container_add(&container, "prov", provenance, strlen(provenance));
    meso_container_add(&container, "head", &head, sizeof head);
    meso_container_add(&container, "surface", &surface, sizeof surface);
    add_quilt(&container, &file->quilt);
    add_base(&container, file);
    add_swatch(&container, &file->swatch);
    meso_container_add(&container, "looks", looks, strlen(looks));
    return meso_container_write(&container, output, error);
}

MesoStatus meso_quilt_write(const MesoQuiltFile *file, const MesoProvenance *provenance, MesoOutput *output,
                            MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    const char *text = meso_provenance_text(provenance, &arena, error);
    char *looks = text ? describe_looks(&file->swatch) : NULL;
    MesoStatus status = MESO_ERR_MEMORY;
    if (looks)
        status = write_chunks(file, text, looks, output, error);
    else if (text)
        meso_fail(error, status, "out of memory for the materials");
    free(looks);
    meso_arena_release(&arena);
    return status;
}

/* ---- reading ---- */

/* What the reader's steps share. */
typedef struct Reading {
    MesoQuiltFile *file;
    const MesoContainer *container;
    MesoArena *arena;
    const char *path;
    MesoError *error;
    StoredHead head;
} Reading;

/* A copy of the chunk of `count` elements of `size` bytes; NULL, with the error filled, where it is not there. */
static void *take(const Reading *in, const char *name, uint64_t count, uint64_t size)
{
    const void *data = meso_container_require(in->container, in->path, name, count, size, in->error);
    void *copy = data ? meso_arena_alloc(in->arena, count, size, in->error) : NULL;
    return copy && count ? memcpy(copy, data, count * size) : copy;
}

/* The same of a chunk that may be empty instead: then NULL, and no error. */
static MesoStatus take_optional(const Reading *in, const char *name, uint64_t count, uint64_t size, void **copy)
{
    uint64_t bytes = 0;
    *copy = NULL;
    if (meso_container_find(in->container, name, &bytes) && bytes == 0)
        return MESO_OK;
    *copy = take(in, name, count, size);
    return *copy ? MESO_OK : in->error->status;
}

/* All numbers below `limit`; `none` is MESO_NO_INDEX where that may stand for none, else 0. */
static MesoStatus check_indices(const Reading *in, const char *name, const uint32_t *values, uint64_t count,
                                uint32_t limit, uint32_t none)
{
    for (uint64_t i = 0; i < count; i++)
        if (values[i] >= limit && (!none || values[i] != none))
            return meso_fail(in->error, MESO_ERR_INPUT, "%s: chunk '%s': number %llu is %u, of %u", in->path, name,
                             (unsigned long long)i, values[i], limit);
    return MESO_OK;
}

static MesoStatus check_places(const Reading *in, const char *name, const MesoVec3 *places, uint32_t count)
{
    for (uint32_t v = 0; v < count; v++) {
        MesoVec3 p = places[v];
        if (!meso_vec3_finite(p) || fmaxf(fabsf(p.x), fmaxf(fabsf(p.y), fabsf(p.z))) > MESO_COORDINATE_LIMIT)
            return meso_fail(in->error, MESO_ERR_INPUT, "%s: chunk '%s': vertex %u is not finite, or too far away",
                             in->path, name, v);
    }
    return MESO_OK;
}

static MesoStatus check_uvs(const Reading *in, const char *name, const MesoVec2 *uvs, uint64_t count)
{
    for (uint64_t i = 0; uvs && i < count; i++)
        if (!isfinite(uvs[i].x) || !isfinite(uvs[i].y))
            return meso_fail(in->error, MESO_ERR_INPUT, "%s: chunk '%s': number %llu is not finite", in->path, name,
                             (unsigned long long)i);
    return MESO_OK;
}

/* From 0 up to `end`, never less than before. */
static MesoStatus check_ranges(const Reading *in, const char *name, const uint32_t *begin, uint32_t end)
{
    uint32_t count = in->head.elements;
    bool good = begin[0] == 0 && begin[count] == end;
    for (uint32_t e = 0; e < count && good; e++)
        good = begin[e] <= begin[e + 1];
    return good ? MESO_OK
                : meso_fail(in->error, MESO_ERR_INPUT, "%s: chunk '%s' is no list of ranges up to %u", in->path, name,
                            end);
}

/* ---- the quilt ---- */

static MesoStatus take_quilt(const Reading *in)
{
    const StoredHead *head = &in->head;
    MesoQuilt *q = &in->file->quilt;
    const uint64_t index = sizeof(uint32_t);
    q->vertex_count = head->vertices;
    q->triangle_count = head->triangles;
    q->element_count = head->elements;
    if (!(q->vertices = take(in, "vertex", head->vertices, sizeof *q->vertices)) ||
        !(q->origins = take(in, "origin", head->vertices, index)) ||
        !(q->corners = take(in, "corner", head->triangles, 3 * index)) ||
        !(q->triangle_origins = take(in, "triorig", head->triangles, index)) ||
        !(q->patches = take(in, "patch", head->triangles, index)) ||
        !(q->vertex_begin = take(in, "vbegin", (uint64_t)head->elements + 1, index)) ||
        !(q->triangle_begin = take(in, "tbegin", (uint64_t)head->elements + 1, index)) ||
        !(q->element_origins = take(in, "elemorig", head->elements, index)))
        return in->error->status;
    return MESO_OK;
}

static MesoStatus check_vertices(const Reading *in)
{
    const MesoQuilt *q = &in->file->quilt;
    for (uint32_t v = 0; v < q->vertex_count; v++) {
        MesoQuiltVertex x = q->vertices[v];
        if (x.triangle >= in->head.base_triangles)
            return meso_fail(in->error, MESO_ERR_INPUT, "%s: vertex %u lies over triangle %u; the base has %u",
                             in->path, v, x.triangle, in->head.base_triangles);
        if (!(fabsf(x.b1) <= WEIGHT_LIMIT && fabsf(x.b2) <= WEIGHT_LIMIT && fabsf(x.height) <= MESO_COORDINATE_LIMIT))
            return meso_fail(in->error, MESO_ERR_INPUT, "%s: vertex %u is not finite, or too far away", in->path, v);
    }
    return MESO_OK;
}

static MesoStatus check_elements(const Reading *in)
{
    const MesoQuilt *q = &in->file->quilt;
    MesoStatus status = check_ranges(in, "vbegin", q->vertex_begin, q->vertex_count);
    if (!status)
        status = check_ranges(in, "tbegin", q->triangle_begin, q->triangle_count);
    for (uint32_t e = 0; e < q->element_count && !status; e++)
        for (uint64_t c = 3 * (uint64_t)q->triangle_begin[e]; c < 3 * (uint64_t)q->triangle_begin[e + 1]; c++)
            if (q->corners[c] < q->vertex_begin[e] || q->corners[c] >= q->vertex_begin[e + 1])
                return meso_fail(in->error, MESO_ERR_INPUT, "%s: element %u has a corner at vertex %u, not its own",
                                 in->path, e, q->corners[c]);
    return status;
}

static MesoStatus read_quilt(const Reading *in)
{
    const MesoQuilt *q = &in->file->quilt;
    MesoStatus status = take_quilt(in);
    if (!status)
        status = check_vertices(in);
    if (!status)
        status = check_elements(in);
    if (!status)
        status = check_indices(in, "origin", q->origins, q->vertex_count, in->head.swatch_vertices, 0);
    if (!status)
        status = check_indices(in, "triorig", q->triangle_origins, q->triangle_count, in->head.swatch_triangles, 0);
    if (!status)
        status = check_indices(in, "patch", q->patches, q->triangle_count, UINT32_MAX - 1, 0);
    return status ? status
                  : check_indices(in, "elemorig", q->element_origins, q->element_count, in->head.swatch_elements, 0);
}

/* ---- base and swatch ---- */

/* Of version 1.0 there are no texture coordinates. */
static MesoStatus read_texture(const Reading *in)
{
    uint64_t bytes;
    void *uvs = NULL;
    const uint64_t count = 3 * (uint64_t)in->head.base_triangles;
    MesoStatus status = meso_container_find(in->container, "baseuv", &bytes)
                            ? take_optional(in, "baseuv", count, sizeof(MesoVec2), &uvs) : MESO_OK;
    in->file->base_uvs = uvs;
    return status ? status : check_uvs(in, "baseuv", uvs, count);
}

static MesoStatus read_base(const Reading *in)
{
    MesoTriangulation *base = &in->file->base;
    const StoredSurface *surface = meso_container_require(in->container, in->path, "surface", 1, sizeof *surface,
                                                          in->error);
    if (!surface)
        return MESO_ERR_INPUT;
    in->file->surface = (MesoSurfaceMark){surface->vertices, surface->faces, surface->corners,
                                          {surface->hash[0], surface->hash[1]}};
    if (surface->embedding >= MESO_QUILT_EMBEDDINGS)
        return meso_fail(in->error, MESO_ERR_INPUT, "%s: chunk 'surface': it lies over it in way %u, which is not known",
                         in->path, surface->embedding);
    in->file->embedding = surface->embedding;
    base->vertex_count = in->head.base_vertices;
    base->triangle_count = in->head.base_triangles;
    if (!(base->positions = take(in, "basepos", base->vertex_count, sizeof *base->positions)) ||
        !(base->corners = take(in, "basecorn", base->triangle_count, 3 * sizeof *base->corners)) ||
        !(base->origins = take(in, "baseorig", base->vertex_count, sizeof *base->origins)))
        return in->error->status;
    MesoStatus status = check_places(in, "basepos", base->positions, base->vertex_count);
    if (!status)
        status = check_indices(in, "basecorn", base->corners, 3 * (uint64_t)base->triangle_count, base->vertex_count,
                               0);
    if (!status)
        status = check_indices(in, "baseorig", base->origins, base->vertex_count, surface->vertices, MESO_NO_INDEX);
    return status ? status : read_texture(in);
}

static MesoStatus check_twins(const Reading *in)
{
    const MesoSwatch *s = &in->file->swatch;
    uint32_t count = 3 * s->triangle_count;
    MesoStatus status = check_indices(in, "swtwin", s->twins, count, count, MESO_NO_INDEX);
    for (uint32_t h = 0; h < count && !status; h++)
        if (s->twins[h] != MESO_NO_INDEX && s->twins[s->twins[h]] != h)
            return meso_fail(in->error, MESO_ERR_INPUT, "%s: chunk 'swtwin': half-edge %u is not across its own",
                             in->path, h);
    return status;
}

static MesoStatus read_looks(const Reading *in)
{
    static const char *const keys[] = {"materials", NULL};
    MesoSwatch *s = &in->file->swatch;
    MesoInput text;
    json_t *root = NULL;
    uint64_t size;
    if (!meso_container_require(in->container, in->path, "looks", 0, 0, in->error))
        return MESO_ERR_INPUT;
    const void *data = meso_container_find(in->container, "looks", &size);
    meso_input_wrap(&text, "chunk 'looks'", data, size);
    MesoStatus status = meso_json_parse(&root, &text, in->error);
    if (!status) {
        MesoJsonReader reader = {.path = text.path, .arena = in->arena, .error = in->error};
        MesoJsonField top = meso_json_root(&reader, root);
        meso_json_object(&top, keys);
        MesoJsonField materials = meso_json_key(&top, "materials");
        meso_materials_of_json(&materials, &s->material_count, &s->looks, &s->material_names);
        status = reader.status;
    }
    json_decref(root);
    if (status)
        meso_fail_prefix(in->error, in->path);
    return status;
}

static MesoStatus take_swatch(const Reading *in)
{
    MesoSwatch *s = &in->file->swatch;
    const uint64_t corners = 3 * (uint64_t)in->head.swatch_triangles, index = sizeof(uint32_t);
    void *uvs, *corner_uvs;
    s->vertex_count = in->head.swatch_vertices;
    s->triangle_count = in->head.swatch_triangles;
    s->element_count = in->head.swatch_elements;
    if (!(s->positions = take(in, "swpos", s->vertex_count, sizeof *s->positions)) ||
        !(s->corners = take(in, "swcorn", corners, index)) || !(s->twins = take(in, "swtwin", corners, index)) ||
        !(s->materials = take(in, "swmat", s->triangle_count, index)))
        return in->error->status;
    MesoStatus status = take_optional(in, "swuv", s->vertex_count, sizeof *s->uvs, &uvs);
    if (!status)
        status = take_optional(in, "swcuv", corners, sizeof *s->corner_uvs, &corner_uvs);
    if (status)
        return status;
    s->uvs = uvs;
    s->corner_uvs = corner_uvs;
    return MESO_OK;
}

static MesoStatus read_swatch(const Reading *in)
{
    const MesoSwatch *s = &in->file->swatch;
    const uint64_t corners = 3 * (uint64_t)in->head.swatch_triangles;
    MesoStatus status = take_swatch(in);
    if (!status)
        status = read_looks(in);
    if (!status)
        status = check_places(in, "swpos", s->positions, s->vertex_count);
    if (!status)
        status = check_indices(in, "swcorn", s->corners, corners, s->vertex_count, 0);
    if (!status)
        status = check_twins(in);
    if (!status)
        status = check_indices(in, "swmat", s->materials, s->triangle_count, s->material_count, 0);
    if (!status)
        status = check_uvs(in, "swuv", s->uvs, s->vertex_count);
    return status ? status : check_uvs(in, "swcuv", s->corner_uvs, corners);
}

/* ---- the whole ---- */

static MesoStatus read_provenance(const Reading *in, const char **provenance)
{
    uint64_t size;
    if (!meso_container_require(in->container, in->path, "prov", 0, 0, in->error))
        return MESO_ERR_INPUT;
    const void *data = meso_container_find(in->container, "prov", &size);
    return meso_provenance_copy(provenance, data, size, in->path, in->arena, in->error);
}

static MesoStatus read_head(Reading *in)
{
    const uint32_t most = (UINT32_MAX - 1) / 3;
    const StoredHead *head = meso_container_require(in->container, in->path, "head", 1, sizeof *head, in->error);
    if (!head)
        return MESO_ERR_INPUT;
    in->head = *head;
    if (head->triangles <= most && head->base_triangles <= most && head->swatch_triangles <= most)
        return MESO_OK;
    return meso_fail(in->error, MESO_ERR_INPUT, "%s: chunk 'head': over %u triangles", in->path, most);
}

MesoStatus meso_quilt_read(MesoQuiltFile *file, const char **provenance, MesoArena *arena, const MesoInput *input,
                           MesoError *error)
{
    MesoContainer container;
    MesoError ignored;
    const char *text;
    Reading in = {file, &container, arena, input->path, error ? error : &ignored, {0}};
    *file = (MesoQuiltFile){0};
    MesoStatus status = meso_container_read(&container, input, "quilt", MESO_QUILT_MAJOR, error);
    if (!status)
        status = read_provenance(&in, &text);
    if (!status && provenance)
        *provenance = text;
    if (!status)
        status = read_head(&in);
    if (!status)
        status = read_base(&in);
    if (!status)
        status = read_swatch(&in);
    return status ? status : read_quilt(&in);
}

bool meso_quilt_recognise(const MesoInput *input)
{
    return meso_container_recognise(input) && input->size >= 16 && memcmp(input->data + 8, "quilt\0\0", 8) == 0;
}
