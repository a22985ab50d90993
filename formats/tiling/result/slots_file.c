#include "formats/tiling/result/slots_file.h"

#include <stdlib.h>
#include <string.h>

#include "formats/tiling/result/slots_text.h"

/* Files have the oldest that says what they hold. */
enum { MAJOR = 1, MAJOR_ORIENTED = 2, MAJOR_WOUND = 3, MINOR = 0 };

/* Half-edges count to 4 * slot_count in 32 bits. */
static const uint64_t most_slots = UINT32_MAX / 4;

static char *join_names(const MesoTileSet *set, MesoArena *arena, size_t *size, MesoError *error)
{
    *size = 0;
    for (uint32_t i = 0; i < set->tile_count; i++)
        *size += strlen(set->tiles[i].name) + 1;
    char *names = MESO_NEW(arena, char, *size, error);
    char *out = names;
    for (uint32_t i = 0; names && i < set->tile_count; i++) {
        size_t length = strlen(set->tiles[i].name) + 1;
        memcpy(out, set->tiles[i].name, length);
        out += length;
    }
    return names;
}

static bool turns_any(const uint8_t *quarters, uint32_t slot_count)
{
    for (uint32_t s = 0; quarters && s < slot_count; s++)
        if (quarters[s])
            return true;
    return false;
}

static MesoStatus write_with(const MesoAssignment *assignment, const MesoTileSet *set,
                             const uint8_t *quarters, const uint8_t *over, const uint64_t hashes[4],
                             const MesoProvenance *provenance, MesoOutput *output, MesoArena *arena,
                             MesoError *error)
{
    size_t names_size;
    const char *text = meso_provenance_text(provenance, arena, error);
    const char *names = text ? join_names(set, arena, &names_size, error) : NULL;
    if (!names)
        return MESO_ERR_MEMORY;
    bool oriented = turns_any(quarters, assignment->slot_count);
    MesoContainer container = {.kind = "slots", .minor = MINOR,
                               .major = over ? MAJOR_WOUND : oriented ? MAJOR_ORIENTED : MAJOR};
    meso_container_add(&container, "prov", text, strlen(text));
    meso_container_add(&container, "inputs", hashes, 4 * sizeof *hashes);
    meso_container_add(&container, "names", names, names_size);
    meso_container_add(&container, "tile", assignment->tile, assignment->slot_count * sizeof(uint32_t));
    meso_container_add(&container, "xform", assignment->transform, assignment->slot_count);
    if (oriented)
        meso_container_add(&container, "orient", quarters, assignment->slot_count);
    if (over)
        meso_container_add(&container, "over", over, assignment->slot_count);
    return meso_container_write(&container, output, error);
}

MesoStatus meso_slots_write(const MesoAssignment *assignment, const MesoTileSet *set,
                            const uint8_t *quarters, const uint8_t *over, const uint64_t tiles_hash[2],
                            const uint64_t surface_hash[2], const MesoProvenance *provenance,
                            MesoOutput *output, MesoError *error)
{
    uint64_t hashes[4] = {tiles_hash[0], tiles_hash[1], surface_hash[0], surface_hash[1]};
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = write_with(assignment, set, quarters, over, hashes, provenance, output, &arena,
                                   error);
    meso_arena_release(&arena);
    return status;
}

typedef struct NamedTile {
    const char *name;
    uint32_t tile;
} NamedTile;

static int compare_names(const void *a, const void *b)
{
    return strcmp(((const NamedTile *)a)->name, ((const NamedTile *)b)->name);
}

static MesoStatus check_unique(const MesoSlotsFile *slots, MesoArena *arena, const char *path,
                               MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(arena);
    NamedTile *sorted = MESO_NEW(arena, NamedTile, slots->tile_count, error);
    if (!sorted)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < slots->tile_count; i++)
        sorted[i] = (NamedTile){slots->tile_names[i], i};
    qsort(sorted, slots->tile_count, sizeof *sorted, compare_names);
    MesoStatus status = MESO_OK;
    for (uint32_t i = 1; i < slots->tile_count && !status; i++)
        if (strcmp(sorted[i - 1].name, sorted[i].name) == 0)
            status = meso_fail(error, MESO_ERR_INPUT, "%s: names the tile '%s' twice", path,
                               sorted[i].name);
    meso_arena_rewind(arena, mark);
    return status;
}

static MesoStatus read_names(MesoSlotsFile *slots, const MesoContainer *container, MesoArena *arena,
                             const char *path, MesoError *error)
{
    uint64_t size;
    const char *data = meso_container_find(container, "names", &size);
    if (!data)
        return meso_fail(error, MESO_ERR_INPUT, "%s: chunk 'names' is missing", path);
    if (size == 0 || data[size - 1] != 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: chunk 'names' does not end with a name", path);
    uint64_t count = 0;
    for (uint64_t i = 0; i < size; i++)
        count += data[i] == 0;
    if (count > UINT32_MAX - 1)
        return meso_fail(error, MESO_ERR_INPUT, "%s: names too many tiles", path);

    char *copy = MESO_NEW(arena, char, size, error);
    slots->tile_names = copy ? MESO_NEW(arena, const char *, count, error) : NULL;
    if (!slots->tile_names)
        return MESO_ERR_MEMORY;
    memcpy(copy, data, size);
    slots->tile_count = (uint32_t)count;
    for (uint32_t i = 0; i < slots->tile_count; i++) {
        slots->tile_names[i] = copy;
        if (*copy == 0)
            return meso_fail(error, MESO_ERR_INPUT, "%s: tile %u has an empty name", path, i);
        copy += strlen(copy) + 1;
    }
    return check_unique(slots, arena, path, error);
}

static MesoStatus read_assignment(MesoSlotsFile *slots, const MesoContainer *container,
                                  MesoArena *arena, const char *path, MesoError *error)
{
    uint64_t count;
    const void *transforms = meso_container_find(container, "xform", &count);
    if (transforms && (count == 0 || count > most_slots))
        return meso_fail(error, MESO_ERR_INPUT, "%s: chunk 'xform' has no possible number of slots",
                         path);
    transforms = meso_container_require(container, path, "xform", count, 1, error);
    const void *tiles = transforms ? meso_container_require(container, path, "tile", count,
                                                            sizeof(uint32_t), error) : NULL;
    if (!tiles)
        return MESO_ERR_INPUT;

    MesoAssignment *out = &slots->assignment;
    out->slot_count = (uint32_t)count;
    out->tile = MESO_NEW(arena, uint32_t, count, error);
    out->transform = out->tile ? MESO_NEW(arena, MesoTransform, count, error) : NULL;
    if (!out->transform)
        return MESO_ERR_MEMORY;
    memcpy(out->tile, tiles, count * sizeof *out->tile);
    memcpy(out->transform, transforms, count);
    for (uint32_t i = 0; i < out->slot_count; i++) {
        if (out->tile[i] >= slots->tile_count)
            return meso_fail(error, MESO_ERR_INPUT, "%s: slot %u has tile %u of %u", path, i,
                             out->tile[i], slots->tile_count);
        if (out->transform[i] >= MESO_TRANSFORM_COUNT)
            return meso_fail(error, MESO_ERR_INPUT, "%s: slot %u has transform %u of %d", path, i,
                             out->transform[i], MESO_TRANSFORM_COUNT);
    }
    return MESO_OK;
}

/* A number below `count` for each slot, or NULL without the chunk `name`. */
static MesoStatus read_bytes(uint8_t **bytes, uint8_t count, const char *name, const MesoSlotsFile *slots,
                             const MesoContainer *container, MesoArena *arena, const char *path, MesoError *error)
{
    uint64_t size;
    uint32_t slot_count = slots->assignment.slot_count;
    const uint8_t *stored = meso_container_find(container, name, &size);
    if (!stored)
        return MESO_OK;
    if (!meso_container_require(container, path, name, slot_count, 1, error))
        return MESO_ERR_INPUT;
    for (uint32_t i = 0; i < slot_count; i++)
        if (stored[i] >= count)
            return meso_fail(error, MESO_ERR_INPUT, "%s: slot %u has orientation %u of %u%s", path, i, stored[i], count,
                             count == 2 ? " sides" : "");
    *bytes = MESO_NEW(arena, uint8_t, slot_count, error);
    if (!*bytes)
        return MESO_ERR_MEMORY;
    memcpy(*bytes, stored, slot_count);
    return MESO_OK;
}

static MesoStatus read_orientation(MesoSlotsFile *slots, const MesoContainer *container,
                                   MesoArena *arena, const char *path, MesoError *error)
{
    MesoStatus status = read_bytes(&slots->quarters, 4, "orient", slots, container, arena, path, error);
    return status ? status : read_bytes(&slots->over, 2, "over", slots, container, arena, path, error);
}

MesoStatus meso_slots_read(MesoSlotsFile *slots, MesoArena *arena, const MesoInput *input,
                           MesoError *error)
{
    MesoContainer container;
    if (!meso_container_recognise(input))
        return meso_slots_text_read(slots, arena, input, error);
    MesoStatus status = meso_container_read(&container, input, "slots", MAJOR_WOUND, error);
    if (status)
        return status;

    *slots = (MesoSlotsFile){0};
    uint64_t size;
    const uint64_t *hashes = meso_container_require(&container, input->path, "inputs", 4,
                                                    sizeof *hashes, error);
    if (!hashes)
        return MESO_ERR_INPUT;
    memcpy(slots->tiles_hash, hashes, sizeof slots->tiles_hash);
    memcpy(slots->surface_hash, hashes + 2, sizeof slots->surface_hash);

    const void *text = meso_container_require(&container, input->path, "prov", 0, 0, error);
    if (!text)
        return MESO_ERR_INPUT;
    meso_container_find(&container, "prov", &size);
    status = meso_provenance_copy(&slots->provenance, text, size, input->path, arena, error);
    if (!status)
        status = read_names(slots, &container, arena, input->path, error);
    if (!status)
        status = read_assignment(slots, &container, arena, input->path, error);
    return status ? status : read_orientation(slots, &container, arena, input->path, error);
}

/* map[tile of the file] = tile of the set; missing ones, which matter only
 * where a slot uses them, get MESO_NO_INDEX. */
static MesoStatus map_names(uint32_t *map, const MesoSlotsFile *slots, const MesoTileSet *set,
                            MesoArena *arena, MesoError *error)
{
    NamedTile *sorted = MESO_NEW(arena, NamedTile, set->tile_count, error);
    if (!sorted)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < set->tile_count; i++)
        sorted[i] = (NamedTile){set->tiles[i].name, i};
    qsort(sorted, set->tile_count, sizeof *sorted, compare_names);
    for (uint32_t i = 0; i < slots->tile_count; i++) {
        NamedTile key = {slots->tile_names[i], 0};
        const NamedTile *found = bsearch(&key, sorted, set->tile_count, sizeof key, compare_names);
        map[i] = found ? found->tile : MESO_NO_INDEX;
    }
    return MESO_OK;
}

static MesoStatus bind_with(MesoSlotsFile *slots, const MesoTileSet *set, MesoArena *arena,
                            MesoError *error)
{
    uint32_t *map = MESO_NEW(arena, uint32_t, slots->tile_count, error);
    if (!map)
        return MESO_ERR_MEMORY;
    MesoStatus status = map_names(map, slots, set, arena, error);
    if (status)
        return status;
    const uint32_t *tile = slots->assignment.tile;
    for (uint32_t i = 0; i < slots->assignment.slot_count; i++)
        if (map[tile[i]] == MESO_NO_INDEX)
            return meso_fail(error, MESO_ERR_INPUT, "slot %u: the tile set has no tile '%s'", i,
                             slots->tile_names[tile[i]]);
    for (uint32_t i = 0; i < slots->assignment.slot_count; i++)
        slots->assignment.tile[i] = map[tile[i]];
    slots->tile_count = 0;
    slots->tile_names = NULL;
    return MESO_OK;
}

MesoStatus meso_slots_bind(MesoSlotsFile *slots, const MesoTileSet *set, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoStatus status = bind_with(slots, set, &arena, error);
    meso_arena_release(&arena);
    return status;
}
