#include "libcore/mesh/refine/subdivide.h"

#include <math.h>

#include "libcore/base/bits.h"
#include "libcore/mesh/edit/face_area.h"
#include "libcore/mesh/edit/origins.h"
#include "libcore/mesh/half_edges.h"

/* One level. New vertices are the old ones, then those of edges, then those of faces. */
typedef struct Level {
    const MesoPolygonMesh *mesh;
    MesoScheme scheme;
    bool triangles;             /* become triangles; else all faces become quads */
    MesoHalfEdges edges;
    const uint64_t *creases;    /* bits of half-edges; NULL: none */
    uint32_t *next;             /* [corner_count] */
    uint32_t *edge_of;          /* [corner_count] */
    uint32_t *half_of;          /* [edge_count] the first */
    uint32_t *edges_at, *creases_at;    /* [vertex_count] how many */
    MesoArena *scratch;
} Level;

static bool is_linear(const Level *level)
{
    return level->scheme == MESO_LINEAR || level->scheme == MESO_LINEAR_QUADS;
}

static bool is_crease(const Level *level, uint32_t h)
{
    uint32_t twin = level->edges.twin[h];
    return twin == MESO_NO_INDEX || (level->creases && (meso_bits_test(level->creases, h) ||
                                                        meso_bits_test(level->creases, twin)));
}

/* ---- edges ---- */

static void number_edges(Level *level)
{
    const MesoPolygonMesh *mesh = level->mesh;
    uint32_t count = 0;
    for (uint32_t h = 0; h < mesh->corner_count; h++) {
        uint32_t twin = level->edges.twin[h];
        if (twin != MESO_NO_INDEX && twin < h) {
            level->edge_of[h] = level->edge_of[twin];
            continue;
        }
        level->edge_of[h] = count;
        level->half_of[count++] = h;
        uint32_t ends[2] = {mesh->corners[h], mesh->corners[level->next[h]]};
        for (int i = 0; i < 2; i++) {
            level->edges_at[ends[i]]++;
            level->creases_at[ends[i]] += is_crease(level, h);
        }
    }
}

static void find_next_corners(const Level *level)
{
    for (uint32_t f = 0; f < level->mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(level->mesh, f), end = begin + meso_polygon_sides(level->mesh, f);
        for (uint32_t c = begin; c < end; c++)
            level->next[c] = c + 1 < end ? c + 1 : begin;
    }
}

static MesoStatus init_level(Level *level, uint32_t thread_count, MesoError *error)
{
    const MesoPolygonMesh *mesh = level->mesh;
    MesoStatus status = meso_half_edges_join(&level->edges, level->scratch, mesh, thread_count, error);
    if (!status)
        status = meso_half_edges_require_manifold(&level->edges, mesh, error);
    if (status)
        return status;
    level->next = MESO_NEW(level->scratch, uint32_t, mesh->corner_count, error);
    level->edge_of = MESO_NEW(level->scratch, uint32_t, mesh->corner_count, error);
    level->half_of = MESO_NEW(level->scratch, uint32_t, level->edges.edge_count, error);
    level->edges_at = MESO_NEW(level->scratch, uint32_t, mesh->vertex_count, error);
    level->creases_at = MESO_NEW(level->scratch, uint32_t, mesh->vertex_count, error);
    if (!level->next || !level->edge_of || !level->half_of || !level->edges_at || !level->creases_at)
        return MESO_ERR_MEMORY;
    find_next_corners(level);
    number_edges(level);
    return MESO_OK;
}

/* ---- vertices ---- */

typedef enum Rule { STAYS, CURVE, SMOOTH } Rule;

static Rule rule_of(const Level *level, uint32_t v)
{
    uint32_t creases = level->creases_at[v];
    if (is_linear(level) || level->edges_at[v] == 0 || creases > 2)
        return STAYS;
    return creases == 2 ? CURVE : SMOOTH;
}

static bool edge_is_middle(const Level *level, uint32_t h)
{
    return is_linear(level) || is_crease(level, h);
}

static void put(MesoOrigins *origins, uint64_t *at, uint32_t source, double weight)
{
    origins->sources[*at] = source;
    origins->weights[(*at)++] = (float)weight;
}

/* Sources of a vertex: itself; the ends of its edges; its faces' new vertices, of Catmull and Clark's. */
static uint32_t source_count(const Level *level, uint32_t v)
{
    uint32_t n = level->edges_at[v];
    switch (rule_of(level, v)) {
    case STAYS: return 1;
    case CURVE: return 3;
    default: return level->triangles ? 1 + n : 1 + 2 * n;
    }
}

static MesoStatus count_sources(MesoOrigins *origins, const Level *level, MesoError *error)
{
    const MesoPolygonMesh *mesh = level->mesh;
    uint32_t vertex_count = mesh->vertex_count, edge_count = level->edges.edge_count;
    uint32_t face_vertices = level->triangles ? 0 : mesh->face_count;
    uint64_t sum = 0, *begin = MESO_NEW(level->scratch, uint64_t, (size_t)vertex_count + edge_count + face_vertices + 1,
                                        error);
    if (!begin)
        return MESO_ERR_MEMORY;
    origins->begin = begin;
    for (uint32_t v = 0; v < vertex_count; v++) {
        *begin++ = sum;
        sum += source_count(level, v);
    }
    for (uint32_t e = 0; e < edge_count; e++) {
        *begin++ = sum;
        sum += edge_is_middle(level, level->half_of[e]) ? 2 : 4;
    }
    for (uint32_t f = 0; f < face_vertices; f++) {
        *begin++ = sum;
        sum += meso_polygon_sides(mesh, f);
    }
    *begin = sum;
    origins->sources = MESO_NEW(level->scratch, uint32_t, sum, error);
    origins->weights = MESO_NEW(level->scratch, float, sum, error);
    return origins->sources && origins->weights ? MESO_OK : MESO_ERR_MEMORY;
}

/* Loop's weight of each of n neighbours. */
static double loop_weight(uint32_t n)
{
    double c = 3.0 / 8 + cos(2 * MESO_PI / n) / 4;
    return (5.0 / 8 - c * c) / n;
}

/* Of a neighbour; the vertices of faces weigh as much. */
static double neighbour_weight(const Level *level, uint32_t v)
{
    double n = level->edges_at[v];
    if (rule_of(level, v) == CURVE)
        return 1.0 / 8;
    return level->triangles ? loop_weight(level->edges_at[v]) : 1 / (n * n);
}

static double own_weight(const Level *level, uint32_t v)
{
    double n = level->edges_at[v];
    switch (rule_of(level, v)) {
    case STAYS: return 1;
    case CURVE: return 3.0 / 4;
    default: return level->triangles ? 1 - n * loop_weight(level->edges_at[v]) : (n - 2) / n;
    }
}

/* `at` [vertex_count] is where the next source of each goes. */
static void fill_vertices(MesoOrigins *origins, const Level *level, uint64_t *at)
{
    const MesoPolygonMesh *mesh = level->mesh;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        at[v] = origins->begin[v];
        put(origins, &at[v], v, own_weight(level, v));
    }
    for (uint32_t e = 0; e < level->edges.edge_count; e++) {
        uint32_t h = level->half_of[e], ends[2] = {mesh->corners[h], mesh->corners[level->next[h]]};
        for (int i = 0; i < 2; i++) {
            Rule rule = rule_of(level, ends[i]);
            if (rule == SMOOTH || (rule == CURVE && is_crease(level, h)))
                put(origins, &at[ends[i]], ends[1 - i], neighbour_weight(level, ends[i]));
        }
    }
    if (level->triangles)
        return;
    uint32_t face_begin = 2 * mesh->vertex_count + level->edges.edge_count;
    for (uint32_t f = 0; f < mesh->face_count; f++)
        for (uint32_t k = 0; k < meso_polygon_sides(mesh, f); k++) {
            uint32_t v = mesh->corners[meso_polygon_begin(mesh, f) + k];
            if (rule_of(level, v) == SMOOTH)
                put(origins, &at[v], face_begin + f, neighbour_weight(level, v));
        }
}

/* What stands across an edge on the side of a half-edge: the vertex of its face, or the corner of its triangle. */
static uint32_t across(const Level *level, uint32_t h)
{
    const MesoPolygonMesh *mesh = level->mesh;
    if (level->triangles)
        return mesh->corners[level->next[level->next[h]]];
    return 2 * mesh->vertex_count + level->edges.edge_count + meso_polygon_face(mesh, h);
}

static void fill_edges(MesoOrigins *origins, const Level *level)
{
    const MesoPolygonMesh *mesh = level->mesh;
    for (uint32_t e = 0; e < level->edges.edge_count; e++) {
        uint32_t h = level->half_of[e];
        uint64_t at = origins->begin[(size_t)mesh->vertex_count + e];
        bool middle = edge_is_middle(level, h);
        double end = middle ? 1.0 / 2 : level->triangles ? 3.0 / 8 : 1.0 / 4;
        put(origins, &at, mesh->corners[h], end);
        put(origins, &at, mesh->corners[level->next[h]], end);
        if (middle)
            continue;
        put(origins, &at, across(level, h), 1.0 / 2 - end);
        put(origins, &at, across(level, level->edges.twin[h]), 1.0 / 2 - end);
    }
}

static void fill_faces(MesoOrigins *origins, const Level *level)
{
    const MesoPolygonMesh *mesh = level->mesh;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint64_t at = origins->begin[(size_t)mesh->vertex_count + level->edges.edge_count + f];
        uint32_t sides = meso_polygon_sides(mesh, f);
        for (uint32_t k = 0; k < sides; k++)
            put(origins, &at, mesh->corners[meso_polygon_begin(mesh, f) + k], 1.0 / sides);
    }
}

static MesoStatus find_vertex_origins(MesoOrigins *origins, const Level *level, MesoError *error)
{
    uint64_t *at = MESO_NEW(level->scratch, uint64_t, level->mesh->vertex_count, error);
    MesoStatus status = at ? count_sources(origins, level, error) : MESO_ERR_MEMORY;
    if (status)
        return status;
    fill_vertices(origins, level, at);
    fill_edges(origins, level);
    if (!level->triangles)
        fill_faces(origins, level);
    return MESO_OK;
}

/* ---- corners and faces ---- */

/*
 * The new faces of one face, each with a corner of the old one first:
 *
 *     d---g---c          c               a b c d, or a b c, are corners; the others lie
 *     | 3 | 2 |         / \              on their edges, and in the middle
 *     h---m---f        f---e             3: the triangle d e f
 *     | 0 | 1 |       / \3/ \
 *     a---e---b      a---d---b
 */
typedef struct Split {
    uint32_t *corners;          /* of new faces: vertices */
    uint32_t *faces;            /* [new faces] old face */
    MesoOrigins origins;        /* of new corners, where anybody asks */
    uint64_t at;                /* next source */
    uint64_t *creases;          /* bits of new half-edges; NULL: none */
} Split;

static uint32_t middle_of(const Level *level, uint32_t h)
{
    return level->mesh->vertex_count + level->edge_of[h];
}

/* New corner `c` comes from `count` old ones, the first of which are `a` and `b`. */
static void begin_corner(Split *split, uint32_t c, uint32_t a, uint32_t b, uint32_t count)
{
    if (!split->origins.begin)
        return;
    split->origins.begin[c] = split->at;
    if (count > 0)
        put(&split->origins, &split->at, a, 1.0 / count);
    if (count > 1)
        put(&split->origins, &split->at, b, 1.0 / count);
}

static void mark_creases(Split *split, const Level *level, uint32_t face, uint32_t sides, uint32_t c, uint32_t before)
{
    if (!split->creases)
        return;
    if (is_crease(level, c))
        meso_bits_set(split->creases, face * sides);
    if (is_crease(level, before))
        meso_bits_set(split->creases, face * sides + sides - 1);
}

static void split_triangle(Split *split, const Level *level, uint32_t face)
{
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t c = 3 * face + k, before = 3 * face + (k + 2) % 3, out = 4 * face + k;
        uint32_t *v = split->corners + 3 * (size_t)out;
        split->faces[out] = face;
        v[0] = level->mesh->corners[c];
        v[1] = middle_of(level, c);
        v[2] = middle_of(level, before);
        begin_corner(split, 3 * out, c, c, 1);
        begin_corner(split, 3 * out + 1, c, level->next[c], 2);
        begin_corner(split, 3 * out + 2, before, c, 2);
        mark_creases(split, level, out, 3, c, before);
    }
    uint32_t middle = 4 * face + 3;
    split->faces[middle] = face;
    for (uint32_t k = 0; k < 3; k++) {
        split->corners[3 * (size_t)middle + k] = middle_of(level, 3 * face + k);
        begin_corner(split, 3 * middle + k, 3 * face + k, level->next[3 * face + k], 2);
    }
}

/* The corner in the middle comes from all corners for the last quad, and from that one for the others. */
static void begin_middle(Split *split, const Level *level, uint32_t quad, uint32_t begin, uint32_t end)
{
    const uint32_t last = 4 * (end - 1) + 2, corner = 4 * quad + 2;
    if (corner != last) {
        begin_corner(split, corner, level->mesh->corner_count + last, 0, 1);
        return;
    }
    begin_corner(split, corner, 0, 0, 0);
    for (uint32_t c = begin; c < end && split->origins.begin; c++)
        put(&split->origins, &split->at, c, 1.0 / (end - begin));
}

static void split_polygon(Split *split, const Level *level, uint32_t face)
{
    uint32_t begin = meso_polygon_begin(level->mesh, face), end = begin + meso_polygon_sides(level->mesh, face);
    for (uint32_t c = begin; c < end; c++) {        /* quad c comes from corner c */
        uint32_t before = c > begin ? c - 1 : end - 1, *v = split->corners + 4 * (size_t)c;
        split->faces[c] = face;
        v[0] = level->mesh->corners[c];
        v[1] = middle_of(level, c);
        v[2] = level->mesh->vertex_count + level->edges.edge_count + face;
        v[3] = middle_of(level, before);
        begin_corner(split, 4 * c, c, c, 1);
        begin_corner(split, 4 * c + 1, c, level->next[c], 2);
        begin_middle(split, level, c, begin, end);
        begin_corner(split, 4 * c + 3, before, c, 2);
        mark_creases(split, level, c, 4, c, before);
    }
}

static bool has_corner_attributes(const MesoPolygonMesh *mesh)
{
    bool found = false;
    for (uint32_t a = 0; a < mesh->attribute_count; a++)
        found |= mesh->attributes[a].domain == MESO_ON_CORNERS;
    return found;
}

/* Six sources for each corner of a polygon and one more, twenty-one for each triangle. */
static MesoStatus init_split(Split *split, const Level *level, const MesoPolygonMesh *result, MesoArena *arena,
                             MesoError *error)
{
    size_t corners = result->corner_count, sources = 7 * (size_t)level->mesh->corner_count;
    *split = (Split){.corners = MESO_NEW(arena, uint32_t, corners, error),
                     .faces = MESO_NEW(level->scratch, uint32_t, result->face_count, error)};
    bool good = split->corners && split->faces;
    if (good && has_corner_attributes(level->mesh)) {
        split->origins.begin = MESO_NEW(level->scratch, uint64_t, corners + 1, error);
        split->origins.sources = MESO_NEW(level->scratch, uint32_t, sources, error);
        split->origins.weights = MESO_NEW(level->scratch, float, sources, error);
        good = split->origins.begin && split->origins.sources && split->origins.weights;
    }
    if (good && level->creases) {
        split->creases = MESO_NEW(arena, uint64_t, corners / 64 + 1, error);
        good = split->creases != NULL;
    }
    return good ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus split_faces(Split *split, const Level *level, const MesoPolygonMesh *result, MesoArena *arena,
                              MesoError *error)
{
    MesoStatus status = init_split(split, level, result, arena, error);
    for (uint32_t f = 0; f < level->mesh->face_count && !status; f++)
        (level->triangles ? split_triangle : split_polygon)(split, level, f);
    if (split->origins.begin && !status)
        split->origins.begin[result->corner_count] = split->at;
    return status;
}

/* ---- levels ---- */

static MesoStatus count_result(MesoPolygonMesh *result, const Level *level, MesoError *error)
{
    const MesoPolygonMesh *mesh = level->mesh;
    uint64_t vertices = (uint64_t)mesh->vertex_count + level->edges.edge_count + (level->triangles ? 0 : mesh->face_count);
    uint64_t faces = level->triangles ? 4 * (uint64_t)mesh->face_count : mesh->corner_count;
    uint32_t sides = level->triangles ? 3 : 4;
    /* Sources count old vertices before new ones. */
    MesoStatus status = meso_mesh_counts_check("subdividing", mesh->vertex_count + vertices, faces,
                                               mesh->corner_count + sides * faces, error);
    *result = (MesoPolygonMesh){.vertex_count = (uint32_t)vertices, .face_count = (uint32_t)faces,
                                .corner_count = (uint32_t)(sides * faces), .side_count = sides};
    return status;
}

static bool gives_triangles(const MesoPolygonMesh *mesh, MesoScheme scheme)
{
    return scheme == MESO_LOOP || (scheme == MESO_LINEAR && mesh->side_count == 3);
}

/* `creases` are those of `from`, and then those of `mesh`, in `arena`. */
static MesoStatus subdivide_once(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                                 MesoScheme scheme, uint64_t **creases, uint32_t thread_count, MesoError *error)
{
    MesoArena scratch;
    Split split;
    MesoMeshOrigins origins = {0};
    meso_arena_init(&scratch);
    Level level = {.mesh = from, .scheme = scheme, .triangles = gives_triangles(from, scheme), .creases = *creases,
                   .scratch = &scratch};
    MesoStatus status = init_level(&level, thread_count, error);
    if (!status)
        status = count_result(mesh, &level, error);
    if (!status)
        status = find_vertex_origins(&origins.of[MESO_ON_VERTICES], &level, error);
    if (!status)
        status = split_faces(&split, &level, mesh, arena, error);
    if (!status) {
        mesh->corners = split.corners;
        origins.of[MESO_ON_FACES].sources = split.faces;
        origins.of[MESO_ON_CORNERS] = split.origins;
        *creases = split.creases;
        status = meso_mesh_carry(mesh, arena, from, &origins, error);
    }
    meso_arena_release(&scratch);
    return status;
}

static bool bends_beyond(const MesoPolygonMesh *mesh, uint32_t face, uint32_t other, double cosine)
{
    MesoAreaVector a = meso_face_area(mesh, face), b = meso_face_area(mesh, other);
    return meso_area_dot(a, b) < cosine * sqrt(meso_area_dot(a, a)) * sqrt(meso_area_dot(b, b));
}

static MesoStatus find_creases(uint64_t **creases, MesoArena *arena, const MesoPolygonMesh *mesh, double angle,
                               uint32_t thread_count, MesoError *error)
{
    MesoHalfEdges edges;
    MesoStatus status = meso_half_edges_join(&edges, arena, mesh, thread_count, error);
    *creases = status ? NULL : MESO_NEW(arena, uint64_t, mesh->corner_count / 64 + 1, error);
    if (!*creases)
        return MESO_ERR_MEMORY;
    double cosine = cos(angle * MESO_PI / 180);
    for (uint32_t h = 0; h < mesh->corner_count; h++)
        if (edges.twin[h] != MESO_NO_INDEX && h < edges.twin[h] &&
            bends_beyond(mesh, meso_polygon_face(mesh, h), meso_polygon_face(mesh, edges.twin[h]), cosine))
            meso_bits_set(*creases, h);
    return MESO_OK;
}

static MesoStatus require_triangles(const MesoPolygonMesh *mesh, MesoError *error)
{
    for (uint32_t f = 0; mesh->side_count != 3 && f < mesh->face_count; f++)
        if (meso_polygon_sides(mesh, f) != 3)
            return meso_fail(error, MESO_ERR_INPUT, "face %u has %u sides; Loop's subdivision is one of triangles",
                             f + 1, meso_polygon_sides(mesh, f));
    return MESO_OK;
}

/* Before any work: the corners that there will be. */
static MesoStatus check_levels(const MesoPolygonMesh *mesh, bool triangles, uint32_t level_count, MesoError *error)
{
    uint64_t faces = mesh->face_count, corners = mesh->corner_count;
    for (uint32_t i = 0; i < level_count && corners > 0 && corners < UINT32_MAX; i++) {
        faces = triangles ? 4 * faces : corners;
        corners = (triangles ? 3 : 4) * faces;
    }
    return meso_mesh_counts_check("subdividing", 0, faces, corners, error);
}

/* Levels but the last lie in two arenas in turn; names and whole numbers that they share are those of `from`. */
MesoStatus meso_mesh_subdivide(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, MesoScheme scheme,
                               uint32_t level_count, double crease, uint32_t thread_count, MesoError *error)
{
    MesoArena turns[2];
    uint64_t *creases = NULL;
    MesoPolygonMesh before = *from;
    meso_arena_init(&turns[0]);
    meso_arena_init(&turns[1]);
    *mesh = *from;
    MesoStatus status = scheme == MESO_LOOP ? require_triangles(from, error) : MESO_OK;
    if (!status)
        status = check_levels(from, gives_triangles(from, scheme), level_count, error);
    if (!status && crease <= 180)
        status = find_creases(&creases, &turns[1], from, crease, thread_count, error);
    for (uint32_t i = 0; i < level_count && !status; i++) {
        status = subdivide_once(mesh, i + 1 == level_count ? arena : &turns[i % 2], &before, scheme, &creases,
                                thread_count, error);
        meso_arena_release(&turns[(i + 1) % 2]);
        before = *mesh;
    }
    meso_arena_release(&turns[0]);
    meso_arena_release(&turns[1]);
    return status;
}
