#include "libcore/mesh/edit/origins.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "libcore/base/names.h"

/* One attribute on its way. */
typedef struct Carry {
    const MesoOrigins *origins;
    const MesoAttribute *from;
    uint32_t old_count, count;  /* elements */
    MesoArena *arena, *scratch;
} Carry;

static uint64_t source_begin(const MesoOrigins *origins, uint32_t element)
{
    return origins->begin ? origins->begin[element] : element;
}

/* ---- copies ---- */

static uint32_t heaviest_source(const MesoOrigins *origins, uint32_t element)
{
    if (!origins->begin)
        return origins->sources ? origins->sources[element] : element;
    uint64_t best = origins->begin[element];
    for (uint64_t s = best + 1; s < origins->begin[element + 1]; s++)
        if (origins->weights[s] > origins->weights[best])
            best = s;
    return origins->sources[best];
}

/* From the last element to the first: new sources have higher numbers. */
static void find_entries(const Carry *carry, uint32_t *entries)
{
    for (uint32_t i = carry->count; i-- > 0;) {
        uint32_t source = heaviest_source(carry->origins, i);
        entries[i] = source < carry->old_count ? meso_attribute_entry(carry->from, source)
                                               : entries[source - carry->old_count];
    }
}

static MesoStatus gather_values(const Carry *carry, MesoAttribute *to, const uint32_t *entries, MesoError *error)
{
    size_t size = (size_t)to->width * meso_scalar_size(to->scalar);
    to->entry_of = NULL;
    to->entry_count = carry->count;
    to->values = meso_arena_alloc(carry->arena, carry->count, size, error);
    if (!to->values)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < carry->count; i++)
        memcpy((char *)to->values + size * i, (const char *)carry->from->values + size * entries[i], size);
    return MESO_OK;
}

static MesoStatus carry_copies(const Carry *carry, MesoAttribute *to, MesoError *error)
{
    bool indexed = carry->from->entry_of || to->width == 0;
    uint32_t *entries = MESO_NEW(indexed ? carry->arena : carry->scratch, uint32_t, carry->count, error);
    if (!entries)
        return MESO_ERR_MEMORY;
    find_entries(carry, entries);
    to->entry_of = entries;
    return indexed ? MESO_OK : gather_values(carry, to, entries, error);
}

/* ---- combinations ---- */

static double clamp(double x, double low, double high)
{
    return fmin(fmax(x, low), high);
}

/* The number that meso_attribute_number() gives back, as near as may be. */
static void store(const MesoAttribute *to, size_t i, double x)
{
    switch (to->scalar) {
    case MESO_SCALAR_DOUBLE: ((double *)to->values)[i] = x; break;
    case MESO_SCALAR_INT8: ((int8_t *)to->values)[i] = (int8_t)lrint(clamp(x, -1, 1) * INT8_MAX); break;
    case MESO_SCALAR_UINT8: ((uint8_t *)to->values)[i] = (uint8_t)lrint(clamp(x, 0, 1) * UINT8_MAX); break;
    case MESO_SCALAR_INT16: ((int16_t *)to->values)[i] = (int16_t)lrint(clamp(x, -1, 1) * INT16_MAX); break;
    case MESO_SCALAR_UINT16: ((uint16_t *)to->values)[i] = (uint16_t)lrint(clamp(x, 0, 1) * UINT16_MAX); break;
    case MESO_SCALAR_INT32: ((int32_t *)to->values)[i] = (int32_t)lrint(clamp(x, -1, 1) * INT32_MAX); break;
    case MESO_SCALAR_UINT32: ((uint32_t *)to->values)[i] = (uint32_t)lrint(clamp(x, 0, 1) * UINT32_MAX); break;
    default: ((float *)to->values)[i] = (float)x; break;
    }
}

/* False where no source has an entry. `missing` [new elements] knows which of the later ones have none. */
static bool combine(const Carry *carry, const MesoAttribute *to, const bool *missing, uint32_t element, double *sums)
{
    const MesoOrigins *origins = carry->origins;
    double total = 0;
    memset(sums, 0, to->width * sizeof *sums);
    for (uint64_t s = source_begin(origins, element); s < source_begin(origins, element + 1); s++) {
        uint32_t source = origins->sources[s];
        bool old = source < carry->old_count;
        assert(old || source - carry->old_count > element);
        uint32_t entry = old                                 ? meso_attribute_entry(carry->from, source)
                         : missing[source - carry->old_count] ? MESO_NO_INDEX
                                                              : source - carry->old_count;
        if (entry == MESO_NO_INDEX)
            continue;
        double weight = (double)origins->weights[s];
        total += weight;
        for (uint32_t k = 0; k < to->width; k++)
            sums[k] += weight * meso_attribute_number(old ? carry->from : to, entry, k);
    }
    for (uint32_t k = 0; k < to->width && total != 0; k++)
        sums[k] /= total;
    return total != 0;
}

/* One entry for all elements whose values have the same bytes; those that miss one have none. */
static MesoStatus join_equal(const Carry *carry, MesoAttribute *to, const bool *missing, MesoError *error)
{
    MesoNames names = {0};
    size_t size = (size_t)to->width * meso_scalar_size(to->scalar);
    const char *all = to->values;
    uint32_t count = 0, *entries = MESO_NEW(carry->arena, uint32_t, carry->count, error);
    uint32_t *first = MESO_NEW(carry->scratch, uint32_t, carry->count, error);
    if (!entries || !first)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < carry->count; i++) {
        entries[i] = missing[i] ? MESO_NO_INDEX
                                : meso_names_add(&names, carry->scratch, all + size * i, size, count, error);
        if (entries[i] == MESO_NO_INDEX && !missing[i])
            return MESO_ERR_MEMORY;
        if (entries[i] == count)
            first[count++] = i;
    }
    to->entry_of = entries;
    to->entry_count = count;
    to->values = meso_arena_alloc(carry->arena, count, size, error);
    for (uint32_t e = 0; to->values && e < count; e++)
        memcpy((char *)to->values + size * e, all + size * first[e], size);
    return to->values ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus carry_combinations(const Carry *carry, MesoAttribute *to, MesoError *error)
{
    bool indexed = carry->from->entry_of != NULL;
    double *sums = MESO_NEW(carry->scratch, double, to->width, error);
    bool *missing = MESO_NEW(carry->scratch, bool, carry->count, error);
    to->entry_of = NULL;
    to->entry_count = carry->count;
    to->values = meso_arena_alloc(indexed ? carry->scratch : carry->arena, carry->count,
                                  (size_t)to->width * meso_scalar_size(to->scalar), error);
    if (!sums || !missing || !to->values)
        return MESO_ERR_MEMORY;
    for (uint32_t i = carry->count; i-- > 0;) {
        missing[i] = !combine(carry, to, missing, i, sums);
        for (uint32_t k = 0; k < to->width; k++)
            store(to, (size_t)i * to->width + k, sums[k]);
    }
    return indexed ? join_equal(carry, to, missing, error) : MESO_OK;
}

/* ---- meshes ---- */

static MesoStatus carry_attribute(MesoAttribute *to, MesoArena *arena, const MesoAttribute *from, uint32_t old_count,
                                  uint32_t count, const MesoOrigins *origins, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    Carry carry = {origins, from, old_count, count, arena, &scratch};
    bool is_number = from->scalar == MESO_SCALAR_FLOAT || from->scalar == MESO_SCALAR_DOUBLE || from->normalized;
    *to = *from;
    MesoStatus status = origins->begin && from->width && is_number ? carry_combinations(&carry, to, error)
                                                                   : carry_copies(&carry, to, error);
    meso_arena_release(&scratch);
    return status;
}

static MesoStatus carry_positions(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                                  const MesoOrigins *origins, MesoError *error)
{
    MesoAttribute to, positions = {.domain = MESO_ON_VERTICES, .width = 3, .entry_count = from->vertex_count,
                                   .values = from->positions};
    MesoStatus status = carry_attribute(&to, arena, &positions, from->vertex_count, mesh->vertex_count, origins, error);
    mesh->positions = to.values;
    return status;
}

/* Equal numbers of sides need no array. */
static void settle_sides(MesoPolygonMesh *mesh)
{
    if (!mesh->face_begin || mesh->face_count == 0)
        return;
    uint32_t sides = mesh->face_begin[1];
    for (uint32_t f = 1; f < mesh->face_count; f++)
        if (mesh->face_begin[f + 1] - mesh->face_begin[f] != sides)
            return;
    mesh->side_count = sides;
    mesh->face_begin = NULL;
}

MesoStatus meso_mesh_carry(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                           const MesoMeshOrigins *origins, MesoError *error)
{
    settle_sides(mesh);
    mesh->attribute_count = from->attribute_count;
    mesh->attributes = MESO_NEW(arena, MesoAttribute, from->attribute_count, error);
    MesoStatus status = mesh->attributes ? MESO_OK : MESO_ERR_MEMORY;
    if (!status)
        status = carry_positions(mesh, arena, from, &origins->of[MESO_ON_VERTICES], error);
    for (uint32_t a = 0; a < from->attribute_count && !status; a++) {
        MesoAttributeDomain domain = from->attributes[a].domain;
        status = carry_attribute(&mesh->attributes[a], arena, &from->attributes[a], meso_polygon_elements(from, domain),
                                 meso_polygon_elements(mesh, domain), &origins->of[domain], error);
    }
    return status;
}

/* ---- detaching ---- */

static void *copy_of(const void *data, size_t size, MesoArena *arena, MesoError *error)
{
    void *copy = meso_arena_alloc(arena, size, 1, error);
    return copy ? memcpy(copy, data, size) : NULL;
}

/* All in one piece. NULL when memory is out. */
static const char **copy_names(const char *const *names, uint32_t count, MesoArena *arena, MesoError *error)
{
    size_t size = 0;
    for (uint32_t i = 0; i < count; i++)
        size += names[i] ? strlen(names[i]) + 1 : 0;
    const char **copies = MESO_NEW(arena, const char *, count, error);
    char *text = MESO_NEW(arena, char, size, error);
    for (uint32_t i = 0; copies && text && i < count; i++) {
        size_t length = names[i] ? strlen(names[i]) + 1 : 0;
        copies[i] = names[i] ? memcpy(text, names[i], length) : NULL;
        text += length;
    }
    return text ? copies : NULL;
}

static MesoStatus detach_attribute(MesoAttribute *a, MesoArena *arena, const MesoAttribute *from, MesoError *error)
{
    bool good = true;
    if (a->name == from->name)
        good = (a->name = meso_arena_copy_text(arena, a->name, error)) != NULL;
    if (good && a->components && a->components == from->components)
        good = (a->components = copy_names(a->components, a->width, arena, error)) != NULL;
    if (good && a->names && a->names == from->names)
        good = (a->names = copy_names(a->names, a->entry_count, arena, error)) != NULL;
    if (good && a->values && a->values == from->values)
        good = (a->values = copy_of(a->values, (size_t)a->entry_count * a->width * meso_scalar_size(a->scalar), arena,
                                    error)) != NULL;
    return good ? MESO_OK : MESO_ERR_MEMORY;
}

MesoStatus meso_mesh_detach(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from, MesoError *error)
{
    assert(mesh->attribute_count == from->attribute_count && mesh->corners != from->corners);
    MesoStatus status = MESO_OK;
    for (uint32_t a = 0; a < mesh->attribute_count && !status; a++)
        status = detach_attribute(&mesh->attributes[a], arena, &from->attributes[a], error);
    return status;
}

/* ---- copies of all ---- */

MesoStatus meso_mesh_counts_check(const char *what, uint64_t vertices, uint64_t faces, uint64_t corners,
                                  MesoError *error)
{
    uint64_t most = vertices > corners ? vertices : corners;
    most = faces > most ? faces : most;
    if (most < UINT32_MAX)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_LIMIT, "%s would give %llu elements of a kind; a mesh has at most %u", what,
                     (unsigned long long)most, UINT32_MAX - 1);
}

MesoStatus meso_mesh_copies_init(MesoMeshCopies *copies, MesoArena *scratch, uint64_t face_room, uint64_t corner_room,
                                 MesoError *error)
{
    MesoStatus status = meso_mesh_counts_check("copying faces", 0, face_room, corner_room, error);
    *copies = (MesoMeshCopies){0};
    if (status)
        return status;
    copies->face_sources = MESO_NEW(scratch, uint32_t, face_room, error);
    copies->face_begin = MESO_NEW(scratch, uint32_t, face_room + 1, error);
    copies->corner_sources = MESO_NEW(scratch, uint32_t, corner_room, error);
    copies->corners = MESO_NEW(scratch, uint32_t, corner_room, error);
    return copies->face_sources && copies->face_begin && copies->corner_sources && copies->corners ? MESO_OK
                                                                                                   : MESO_ERR_MEMORY;
}

MesoStatus meso_mesh_copies_build(MesoPolygonMesh *mesh, MesoArena *arena, const MesoPolygonMesh *from,
                                  const MesoMeshCopies *copies, MesoError *error)
{
    *mesh = (MesoPolygonMesh){.vertex_count = copies->vertex_sources ? copies->vertex_count : from->vertex_count,
                              .face_count = copies->face_count, .corner_count = copies->corner_count};
    mesh->face_begin = MESO_NEW(arena, uint32_t, (size_t)copies->face_count + 1, error);
    mesh->corners = MESO_NEW(arena, uint32_t, copies->corner_count, error);
    if (!mesh->face_begin || !mesh->corners)
        return MESO_ERR_MEMORY;
    memcpy(mesh->face_begin, copies->face_begin, ((size_t)copies->face_count + 1) * sizeof *mesh->face_begin);
    memcpy(mesh->corners, copies->corners, copies->corner_count * sizeof *mesh->corners);
    MesoMeshOrigins origins = {.of = {[MESO_ON_VERTICES] = {.sources = copies->vertex_sources},
                                      [MESO_ON_FACES] = {.sources = copies->face_sources},
                                      [MESO_ON_CORNERS] = {.sources = copies->corner_sources}}};
    return meso_mesh_carry(mesh, arena, from, &origins, error);
}
