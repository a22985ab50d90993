/* Strands as bodies: their sweeps' vertices, those at one place made one. */
#include <stdlib.h>
#include <string.h>

#include "formats/scene/strand/strand_scene.h"
#include "libcore/base/parallel.h"
#include "libcore/scene/sweep.h"

typedef struct Welder {
    const MesoScene *in;
    const MesoStrands *strands;
    MesoBody *bodies;       /* [strands] */
    void **blocks;          /* [strands] what each has allocated */
    MesoStatus *status;     /* [strands] */
} Welder;

/* What one strand is made of, before. */
typedef struct Strand {
    uint64_t vertex_count, face_count;
    MesoMeshVertex *vertices;   /* [vertex_count] */
    MesoMeshFace *faces;        /* [face_count] */
    uint32_t *number;           /* [vertex_count] of each among those that stay */
    uint32_t *table;            /* [table_size] vertices, by their places; MESO_NO_INDEX: none */
    uint64_t table_size;        /* a power of 2 */
} Strand;

static const MesoSweptKind *kind_of(const MesoScene *scene, uint32_t sweep)
{
    return &scene->kinds[meso_scene_kind(scene, sweep)];
}

/* ---- the sweeps ---- */

static void count_strand(const Welder *w, uint32_t strand, Strand *s)
{
    *s = (Strand){0};
    for (uint32_t i = w->strands->begin[strand]; i < w->strands->begin[strand + 1]; i++) {
        const MesoSweptKind *kind = kind_of(w->in, w->strands->pieces[i].sweep);
        s->vertex_count += meso_sweep_vertex_count(kind);
        s->face_count += meso_sweep_face_count(kind);
    }
    for (s->table_size = 16; s->table_size < 2 * s->vertex_count;)
        s->table_size *= 2;
}

static void fill_strand(const Welder *w, uint32_t strand, const Strand *s)
{
    MesoMeshVertex *vertices = s->vertices;
    MesoMeshFace *faces = s->faces;
    uint32_t begin = w->strands->begin[strand];
    for (uint32_t i = begin; i < w->strands->begin[strand + 1]; i++) {
        MesoStrandPiece piece = w->strands->pieces[i];
        const MesoSweptKind *kind = kind_of(w->in, piece.sweep);
        uint64_t count = meso_sweep_vertex_count(kind);
        meso_sweep_vertices(w->in, kind, &w->in->sweeps[piece.sweep], vertices);
        meso_sweep_faces(w->in, kind, &w->in->sweeps[piece.sweep], (uint32_t)(vertices - s->vertices), faces);
        for (uint64_t v = 0; v < count; v++)
            vertices[v].uv.y = (float)(i - begin) + (piece.reversed ? 1 - vertices[v].uv.y : vertices[v].uv.y);
        vertices += count;
        faces += meso_sweep_face_count(kind);
    }
}

/* ---- one vertex a place ---- */

static uint64_t hash_of(MesoVec3 p)
{
    const float plain[3] = {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};    /* -0 is where 0 is */
    uint32_t bits[3];
    memcpy(bits, plain, sizeof bits);
    uint64_t hash = bits[0] * 0x9e3779b97f4a7c15u;
    hash = (hash ^ (hash >> 29) ^ bits[1]) * 0xbf58476d1ce4e5b9u;
    hash = (hash ^ (hash >> 32) ^ bits[2]) * 0x94d049bb133111ebu;
    return hash ^ (hash >> 31);
}

static bool same_place(MesoVec3 a, MesoVec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* The first vertex at the place of `v`, which may be itself. */
static uint32_t first_at(const Strand *s, uint32_t v)
{
    MesoVec3 p = s->vertices[v].position;
    uint64_t at = hash_of(p) & (s->table_size - 1);
    while (s->table[at] != MESO_NO_INDEX && !same_place(s->vertices[s->table[at]].position, p))
        at = (at + 1) & (s->table_size - 1);
    if (s->table[at] == MESO_NO_INDEX)
        s->table[at] = v;
    return s->table[at];
}

static uint32_t number_vertices(const Strand *s, MesoVec3 *positions, MesoVec3 *normals, MesoVec2 *uvs)
{
    uint32_t count = 0;
    memset(s->table, 0xff, s->table_size * sizeof *s->table);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        const MesoMeshVertex *vertex = &s->vertices[v];
        uint32_t first = first_at(s, v);
        s->number[v] = first == v ? count++ : s->number[first];
        uint32_t number = s->number[v];
        if (first != v) {
            normals[number] = meso_vec3_add(normals[number], vertex->normal);
            continue;
        }
        positions[number] = vertex->position;
        normals[number] = vertex->normal;
        uvs[number] = vertex->uv;
    }
    for (uint32_t i = 0; i < count; i++)
        normals[i] = meso_vec3_unit(normals[i], (MesoVec3){0, 0, 1});
    return count;
}

/* Corners that have become one are one; what has less than three is gone. Returns the faces that stay. */
static uint32_t number_corners(const Strand *s, uint32_t *corners)
{
    uint32_t count = 0;
    for (uint64_t f = 0; f < s->face_count; f++) {
        uint32_t *to = corners + 4 * (size_t)count, used = 0;
        for (int k = 0; k < 4 && s->faces[f].v[k] != MESO_NO_INDEX; k++) {
            uint32_t number = s->number[s->faces[f].v[k]];
            if (used == 0 || to[used - 1] != number)
                to[used++] = number;
        }
        used -= used > 1 && to[used - 1] == to[0];
        if (used < 3 || to[0] == to[2] || (used == 4 && to[1] == to[3]))
            continue;
        if (used == 3)
            to[3] = MESO_NO_INDEX;
        count++;
    }
    return count;
}

/* Everything in one block, of which what is needed later comes first. */
static MesoStatus weld_strand(const Welder *w, uint32_t strand)
{
    Strand s;
    count_strand(w, strand, &s);
    if (s.vertex_count >= UINT32_MAX || s.face_count >= UINT32_MAX)
        return MESO_ERR_LIMIT;
    size_t n = s.vertex_count, kept = n * (2 * sizeof(MesoVec3) + sizeof(MesoVec2)) + 16 * s.face_count;
    uint8_t *block = malloc(kept ? kept : 1);
    w->blocks[strand] = block;
    s.vertices = malloc(n * (sizeof *s.vertices + sizeof *s.number) + s.face_count * sizeof *s.faces +
                        s.table_size * sizeof *s.table);
    if (!block || !s.vertices) {
        free(s.vertices);
        return MESO_ERR_MEMORY;
    }
    s.faces = (MesoMeshFace *)(void *)(s.vertices + n);
    s.number = (uint32_t *)(void *)(s.faces + s.face_count);
    s.table = s.number + n;
    MesoVec3 *positions = (MesoVec3 *)(void *)block, *normals = positions + n;
    MesoVec2 *uvs = (MesoVec2 *)(void *)(normals + n);
    uint32_t *corners = (uint32_t *)(void *)(uvs + n);
    fill_strand(w, strand, &s);
    w->bodies[strand] = (MesoBody){.face_width = 4, .positions = positions, .normals = normals, .uvs = uvs,
                                   .corners = corners};
    w->bodies[strand].vertex_count = number_vertices(&s, positions, normals, uvs);
    w->bodies[strand].face_count = number_corners(&s, corners);
    free(s.vertices);
    return MESO_OK;
}

static void weld_range(void *context, uint64_t begin, uint64_t end)
{
    const Welder *w = context;
    for (uint64_t strand = begin; strand < end; strand++)
        w->status[strand] = weld_strand(w, (uint32_t)strand);
}

/* ---- the scene ---- */

static MesoStatus adopt(const Welder *w, MesoArena *arena, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t s = 0; s < w->strands->count; s++) {
        if (!status && w->status[s])
            status = meso_fail(error, w->status[s], "%s", w->status[s] == MESO_ERR_LIMIT
                                   ? "a strand of over 2^32 vertices" : "out of memory for welded strands");
        if (!status && !meso_arena_adopt(arena, w->blocks[s], error))
            status = MESO_ERR_MEMORY;
        if (status)
            free(w->blocks[s]);
    }
    return status;
}

static MesoStatus make_bodies(MesoScene *out, MesoArena *arena, const MesoScene *in, const MesoStrands *strands,
                              uint32_t thread_count, MesoError *error)
{
    out->bodies = MESO_NEW(arena, MesoBody, (size_t)strands->count + in->body_count, error);
    Welder w = {in, strands, out->bodies, MESO_NEW(arena, void *, strands->count, error),
                MESO_NEW(arena, MesoStatus, strands->count, error)};
    if (!w.bodies || !w.blocks || !w.status)
        return MESO_ERR_MEMORY;
    meso_parallel_for(thread_count, strands->count, 1, weld_range, &w);
    if (in->body_count > 0)
        memcpy(out->bodies + strands->count, in->bodies, in->body_count * sizeof *in->bodies);
    out->body_count = strands->count + in->body_count;
    return adopt(&w, arena, error);
}

static void place_bodies(MesoScene *out, const MesoScene *in, const MesoStrands *strands)
{
    for (uint32_t s = 0; s < strands->count; s++) {
        uint32_t material = kind_of(in, strands->pieces[strands->begin[s]].sweep)->start_material;
        out->placed[s] = (MesoPlacedBody){.body = s, .material = material, .ids = s};
    }
    for (uint32_t i = 0; i < in->placed_count; i++) {
        MesoPlacedBody *placed = &out->placed[strands->count + i];
        *placed = in->placed[i];
        placed->body += strands->count;
        placed->ids = strands->count;
    }
    for (uint32_t row = 0; row <= strands->count; row++)
        out->ids[row] = row;
}

MesoStatus meso_strand_scene_weld(MesoScene *out, MesoArena *arena, const MesoScene *in, const MesoStrands *strands,
                                  uint32_t thread_count, MesoError *error)
{
    *out = *in;
    out->kind_count = out->column_count = out->sweep_count = 0;
    out->channel_count = 1;
    out->channels[0] = (MesoIdChannel){"strand", strands->count + (in->placed_count > 0), NULL};
    out->id_row_count = strands->count + 1;
    out->ids = MESO_NEW(arena, uint32_t, out->id_row_count, error);
    out->placed_count = strands->count + in->placed_count;
    out->placed = MESO_NEW(arena, MesoPlacedBody, out->placed_count, error);
    if (!out->ids || !out->placed)
        return MESO_ERR_MEMORY;
    MesoStatus status = make_bodies(out, arena, in, strands, thread_count, error);
    if (!status)
        place_bodies(out, in, strands);
    return status;
}
