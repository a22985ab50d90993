#include "libcore/mesh/polygon_mesh.h"

#include <assert.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "libcore/base/parallel.h"

uint32_t meso_polygon_face(const MesoPolygonMesh *mesh, uint32_t corner)
{
    assert(corner < mesh->corner_count);
    if (!mesh->face_begin)
        return corner / mesh->side_count;
    uint32_t low = 0, high = mesh->face_count;
    while (high - low > 1) {
        uint32_t middle = low + (high - low) / 2;
        *(mesh->face_begin[middle] <= corner ? &low : &high) = middle;
    }
    return low;
}

uint32_t meso_polygon_elements(const MesoPolygonMesh *mesh, MesoAttributeDomain domain)
{
    return domain == MESO_ON_VERTICES ? mesh->vertex_count
         : domain == MESO_ON_FACES    ? mesh->face_count
                                      : mesh->corner_count;
}

/* ---- attributes by name ---- */

static const MesoAttributeDomain domains[] = {MESO_ON_FACES, MESO_ON_VERTICES, MESO_ON_CORNERS};
enum { DOMAIN_COUNT = sizeof domains / sizeof *domains };

const MesoAttribute *meso_polygon_attribute_on(const MesoPolygonMesh *mesh, const char *name,
                                               MesoAttributeDomain domain)
{
    for (uint32_t a = 0; a < mesh->attribute_count; a++)
        if (mesh->attributes[a].domain == domain && strcmp(mesh->attributes[a].name, name) == 0)
            return &mesh->attributes[a];
    return NULL;
}

const MesoAttribute *meso_polygon_attribute(const MesoPolygonMesh *mesh, const char *name)
{
    const MesoAttribute *found = NULL;
    for (uint32_t d = 0; d < DOMAIN_COUNT && !found; d++)
        found = meso_polygon_attribute_on(mesh, name, domains[d]);
    return found;
}

const MesoAttribute *meso_polygon_normals(const MesoPolygonMesh *mesh)
{
    const MesoAttribute *normals = meso_polygon_attribute_on(mesh, "normal", MESO_ON_CORNERS);
    if (!normals || normals->width != 3)
        normals = meso_polygon_attribute_on(mesh, "normal", MESO_ON_VERTICES);
    return normals && normals->width == 3 ? normals : NULL;
}

const MesoAttribute *meso_polygon_number_on(const MesoPolygonMesh *mesh, const char *name, MesoAttributeDomain domain,
                                            uint32_t *component)
{
    for (uint32_t a = 0; a < mesh->attribute_count; a++) {
        const MesoAttribute *attribute = &mesh->attributes[a];
        *component = attribute->domain == domain ? meso_attribute_component(attribute, name) : MESO_NO_INDEX;
        if (*component != MESO_NO_INDEX)
            return attribute;
    }
    return NULL;
}

const MesoAttribute *meso_polygon_number(const MesoPolygonMesh *mesh, const char *name, uint32_t *component)
{
    const MesoAttribute *found = NULL;
    for (uint32_t d = 0; d < DOMAIN_COUNT && !found; d++)
        found = meso_polygon_number_on(mesh, name, domains[d], component);
    return found;
}

static double number_or_nan(const MesoAttribute *attribute, uint32_t element, uint32_t component)
{
    uint32_t entry = meso_attribute_entry(attribute, element);
    return entry == MESO_NO_INDEX ? NAN : meso_attribute_number(attribute, entry, component);
}

double meso_polygon_face_number(const MesoPolygonMesh *mesh, const MesoAttribute *attribute, uint32_t component,
                                uint32_t face)
{
    if (attribute->domain == MESO_ON_FACES)
        return number_or_nan(attribute, face, component);
    uint32_t begin = meso_polygon_begin(mesh, face), sides = meso_polygon_sides(mesh, face);
    double sum = 0;
    for (uint32_t c = begin; c < begin + sides; c++)
        sum += number_or_nan(attribute, attribute->domain == MESO_ON_CORNERS ? c : mesh->corners[c], component);
    return sum / sides;
}

/* ---- checks ---- */

enum { GRAIN = 1 << 15, FEW_SIDES = 16 };

typedef struct Check {
    const MesoPolygonMesh *mesh;
    atomic_uint_fast32_t first;     /* wrong element so far, or MESO_NO_INDEX */
    atomic_bool many;               /* a face has more than FEW_SIDES */
} Check;

static void note_wrong(Check *check, uint32_t element)
{
    uint_fast32_t first = atomic_load(&check->first);
    while (element < first && !atomic_compare_exchange_weak(&check->first, &first, element)) {}
}

static bool is_good_quad(const uint32_t *v, uint32_t vertex_count)
{
    return (v[0] < vertex_count) & (v[1] < vertex_count) & (v[2] < vertex_count) & (v[3] < vertex_count) &
           (v[0] != v[1]) & (v[0] != v[2]) & (v[0] != v[3]) & (v[1] != v[2]) & (v[1] != v[3]) & (v[2] != v[3]);
}

/* Of a face of many sides, only that its corners are in range. */
static bool is_good_face(const uint32_t *v, uint32_t sides, uint32_t vertex_count)
{
    for (uint32_t i = 0; i < sides; i++) {
        if (v[i] >= vertex_count)
            return false;
        for (uint32_t j = sides > FEW_SIDES ? i : 0; j < i; j++)
            if (v[i] == v[j])
                return false;
    }
    return sides >= 3;
}

static void check_faces(void *context, uint64_t begin, uint64_t end)
{
    Check *check = context;
    const MesoPolygonMesh *mesh = check->mesh;
    for (uint32_t f = (uint32_t)begin; f < end; f++) {
        uint32_t sides = meso_polygon_sides(mesh, f);
        const uint32_t *corners = mesh->corners + meso_polygon_begin(mesh, f);
        bool good = sides == 4 ? is_good_quad(corners, mesh->vertex_count)
                               : is_good_face(corners, sides, mesh->vertex_count);
        if (sides > FEW_SIDES)
            atomic_store(&check->many, true);
        if (!good) {
            note_wrong(check, f);
            return;
        }
    }
}

/* seen[v] is the last face, plus 1, that used vertex v: faces of any size in linear time. */
static MesoStatus check_large_faces(Check *check, MesoError *error)
{
    const MesoPolygonMesh *mesh = check->mesh;
    MesoArena scratch;
    meso_arena_init(&scratch);
    uint32_t *seen = MESO_NEW(&scratch, uint32_t, mesh->vertex_count, error);
    for (uint32_t f = 0; seen && f < mesh->face_count && f < atomic_load(&check->first); f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        for (uint32_t c = begin; sides > FEW_SIDES && c < begin + sides; c++) {
            if (seen[mesh->corners[c]] == f + 1)
                note_wrong(check, f);
            seen[mesh->corners[c]] = f + 1;
        }
    }
    meso_arena_release(&scratch);
    return seen ? MESO_OK : MESO_ERR_MEMORY;
}

static bool entry_is_good(const MesoAttribute *attribute, uint32_t element)
{
    uint32_t entry = meso_attribute_entry(attribute, element);
    return entry < attribute->entry_count || entry == MESO_NO_INDEX;
}

static const char *word_for(const MesoAttribute *attribute)
{
    return strcmp(attribute->name, "uv") == 0 ? "texture coordinate" : attribute->name;
}

static MesoStatus fail_entry(const char *element, uint32_t number, const MesoAttribute *attribute, uint32_t entry,
                             MesoError *error)
{
    return meso_fail(error, MESO_ERR_INPUT, "%s %u uses %s %llu of %u", element, number + 1, word_for(attribute),
                     entry + 1ull, attribute->entry_count);
}

typedef struct EntryCheck {
    Check check;
    const MesoAttribute *attribute;
} EntryCheck;

static void check_entries(void *context, uint64_t begin, uint64_t end)
{
    EntryCheck *entries = context;
    for (uint32_t e = (uint32_t)begin; e < end; e++)
        if (!entry_is_good(entries->attribute, e)) {
            note_wrong(&entries->check, e);
            return;
        }
}

/* First element of the attribute whose entry is out of range, or MESO_NO_INDEX. */
static uint32_t wrong_entry(const MesoPolygonMesh *mesh, const MesoAttribute *attribute, uint32_t thread_count)
{
    EntryCheck entries = {.check = {.mesh = mesh, .first = MESO_NO_INDEX}, .attribute = attribute};
    uint32_t count = meso_polygon_elements(mesh, attribute->domain);
    if (attribute->entry_of || attribute->entry_count < count)
        meso_parallel_for(thread_count, count, GRAIN, check_entries, &entries);
    return (uint32_t)atomic_load(&entries.check.first);
}

/* What is wrong first in a face, corner by corner. `seen` [vertex_count] is zeroed. */
static MesoStatus explain_face(const MesoPolygonMesh *mesh, uint32_t f, uint8_t *seen, MesoError *error)
{
    uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
    if (sides < 3)
        return meso_fail(error, MESO_ERR_INPUT, "face %u has %u sides; a face has at least 3", f + 1, sides);
    for (uint32_t c = begin; c < begin + sides; c++) {
        uint32_t vertex = mesh->corners[c];
        if (vertex >= mesh->vertex_count)
            return meso_fail(error, MESO_ERR_INPUT, "face %u uses vertex %llu of %u", f + 1, vertex + 1ull,
                             mesh->vertex_count);
        for (const MesoAttribute *a = mesh->attributes; a < mesh->attributes + mesh->attribute_count; a++)
            if (a->domain == MESO_ON_CORNERS && !entry_is_good(a, c))
                return fail_entry("face", f, a, meso_attribute_entry(a, c), error);
        if (seen[vertex])
            return meso_fail(error, MESO_ERR_INPUT, "face %u uses vertex %u twice", f + 1, vertex + 1);
        seen[vertex] = 1;
    }
    for (const MesoAttribute *a = mesh->attributes; a < mesh->attributes + mesh->attribute_count; a++)
        if (a->domain == MESO_ON_FACES && !entry_is_good(a, f))
            return fail_entry("face", f, a, meso_attribute_entry(a, f), error);
    return MESO_OK;
}

static MesoStatus fail_face(const MesoPolygonMesh *mesh, uint32_t f, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    uint8_t *seen = MESO_NEW(&scratch, uint8_t, mesh->vertex_count, error);
    MesoStatus status = seen ? explain_face(mesh, f, seen, error) : MESO_ERR_MEMORY;
    meso_arena_release(&scratch);
    return status;
}

static bool is_good_position(MesoVec3 p)
{
    return fabsf(p.x) <= MESO_COORDINATE_LIMIT && fabsf(p.y) <= MESO_COORDINATE_LIMIT &&
           fabsf(p.z) <= MESO_COORDINATE_LIMIT;
}

static void check_positions(void *context, uint64_t begin, uint64_t end)
{
    Check *check = context;
    for (uint32_t v = (uint32_t)begin; v < end; v++)
        if (!is_good_position(check->mesh->positions[v])) {
            note_wrong(check, v);
            return;
        }
}

static MesoStatus check_vertices(const MesoPolygonMesh *mesh, uint32_t thread_count, MesoError *error)
{
    Check check = {.mesh = mesh, .first = MESO_NO_INDEX};
    meso_parallel_for(thread_count, mesh->vertex_count, GRAIN, check_positions, &check);
    uint32_t v = (uint32_t)atomic_load(&check.first);
    if (v != MESO_NO_INDEX && !meso_vec3_finite(mesh->positions[v]))
        return meso_fail(error, MESO_ERR_INPUT, "vertex %u is not finite", v + 1);
    if (v != MESO_NO_INDEX)
        return meso_fail(error, MESO_ERR_INPUT, "vertex %u lies beyond the largest coordinate, %g", v + 1,
                         (double)MESO_COORDINATE_LIMIT);
    for (const MesoAttribute *a = mesh->attributes; a < mesh->attributes + mesh->attribute_count; a++) {
        v = a->domain == MESO_ON_VERTICES ? wrong_entry(mesh, a, thread_count) : MESO_NO_INDEX;
        if (v != MESO_NO_INDEX)
            return fail_entry("vertex", v, a, meso_attribute_entry(a, v), error);
    }
    return MESO_OK;
}

MesoStatus meso_polygon_mesh_check(const MesoPolygonMesh *mesh, uint32_t thread_count, uint32_t *face, MesoError *error)
{
    Check check = {.mesh = mesh, .first = MESO_NO_INDEX};
    meso_parallel_for(thread_count, mesh->face_count, GRAIN, check_faces, &check);
    MesoStatus status = atomic_load(&check.many) ? check_large_faces(&check, error) : MESO_OK;
    for (const MesoAttribute *a = mesh->attributes; a < mesh->attributes + mesh->attribute_count; a++) {
        uint32_t wrong = a->domain == MESO_ON_VERTICES ? MESO_NO_INDEX : wrong_entry(mesh, a, thread_count);
        if (wrong != MESO_NO_INDEX)
            note_wrong(&check, a->domain == MESO_ON_FACES ? wrong : meso_polygon_face(mesh, wrong));
    }
    uint32_t first = (uint32_t)atomic_load(&check.first);
    if (face)
        *face = status ? MESO_NO_INDEX : first;
    if (!status && first != MESO_NO_INDEX)
        status = fail_face(mesh, first, error);
    return status ? status : check_vertices(mesh, thread_count, error);
}
