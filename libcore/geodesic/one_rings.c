#include "libcore/geodesic/one_rings.h"

#include <stdlib.h>
#include <string.h>

/* ---- room ---- */

static MesoStatus reserve_pool(MesoOneRings *rings, uint64_t count, MesoError *error)
{
    if (count <= rings->pool_room)
        return MESO_OK;
    uint64_t room = rings->pool_room + rings->pool_room / 4;
    room = room < count ? count : room;
    if (count > UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "rings of %llu sides are beyond what can be counted",
                         (unsigned long long)count);
    room = room > UINT32_MAX ? UINT32_MAX : room;
    /* from nothing, the system's own zeros: pages that no ring needs are never touched */
    uint32_t *pool = rings->pool ? realloc(rings->pool, room * sizeof *pool) : calloc(room, sizeof *pool);
    if (!pool)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: %llu sides", (unsigned long long)room);
    if (rings->pool)
        memset(pool + rings->pool_count, 0, (room - rings->pool_count) * sizeof *pool);
    rings->pool = pool;
    rings->pool_room = (uint32_t)room;
    return MESO_OK;
}

MesoStatus meso_one_rings_reserve(MesoOneRings *rings, uint32_t vertex_count, MesoError *error)
{
    if (vertex_count <= rings->vertex_room)
        return MESO_OK;
    uint32_t *begins = realloc(rings->begins, vertex_count * sizeof *begins);
    if (begins)
        rings->begins = begins;
    uint8_t *sizes = realloc(rings->sizes, vertex_count * sizeof *sizes);
    if (sizes)
        rings->sizes = sizes;
    if (!begins || !sizes)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory: rings of %u vertices", vertex_count);
    memset(begins + rings->vertex_room, 0, (vertex_count - rings->vertex_room) * sizeof *begins);
    memset(sizes + rings->vertex_room, 0, (vertex_count - rings->vertex_room) * sizeof *sizes);
    rings->vertex_room = vertex_count;
    return MESO_OK;
}

/* ---- walking ---- */

typedef struct Walk {
    uint32_t count;     /* spokes */
    bool closed;
    bool fits;          /* all were written */
} Walk;

/* The spoke by which the fan enters its triangle. */
static uint32_t entry_spoke(const MesoTriangulation *mesh, MesoFan fan)
{
    return mesh->corners[fan.turned ? meso_previous_corner(fan.corner) : meso_next_corner(fan.corner)];
}

static uint32_t exit_spoke(const MesoTriangulation *mesh, MesoFan fan)
{
    return mesh->corners[fan.turned ? meso_next_corner(fan.corner) : meso_previous_corner(fan.corner)];
}

/* Writes the spokes from `fan` on to `spokes`, at most `room`. */
static Walk walk_from(const MesoTriangulation *mesh, MesoFan fan, uint32_t *spokes, uint32_t room)
{
    uint32_t first = fan.corner, count = 0;
    do {
        uint32_t spoke = entry_spoke(mesh, fan);
        if (count < room)
            spokes[count] = spoke;
        count++;
        if (!meso_fan_next(mesh, &fan)) {
            if (count < room)
                spokes[count] = exit_spoke(mesh, fan);
            count++;
            return (Walk){count, false, count <= room};
        }
    } while (fan.corner != first);
    return (Walk){count, true, count <= room};
}

/* Most vertices have no border, and it does not matter where a closed ring begins. */
static Walk walk_ring(const MesoTriangulation *mesh, uint32_t vertex, uint32_t *spokes, uint32_t room)
{
    uint32_t corner = mesh->vertex_corner[vertex];
    if (corner == MESO_NO_INDEX)
        return (Walk){0, false, true};
    Walk walk = walk_from(mesh, (MesoFan){corner, false}, spokes, room);
    return walk.closed ? walk : walk_from(mesh, meso_fan_first(mesh, vertex), spokes, room);
}

static void note_size(MesoOneRings *rings, uint32_t vertex, Walk walk)
{
    uint32_t size = walk.count < MESO_RING_LONG ? walk.count : MESO_RING_LONG;
    rings->sizes[vertex] = (uint8_t)(size | (walk.closed ? 128u : 0));
}

/* Behind all others. */
static MesoStatus append_ring(MesoOneRings *rings, const MesoTriangulation *mesh, uint32_t vertex, MesoError *error)
{
    uint32_t begin = rings->pool_count, room = rings->pool_room - MESO_RING_SLACK - begin;
    Walk walk = walk_ring(mesh, vertex, rings->pool + begin, room);
    bool is_long = walk.count >= MESO_RING_LONG;
    if (!walk.fits || is_long) {
        MesoStatus status = reserve_pool(rings, (uint64_t)begin + is_long + walk.count + MESO_RING_SLACK, error);
        if (status)
            return status;
        begin += is_long;
        walk = walk_ring(mesh, vertex, rings->pool + begin, walk.count);
        if (is_long)
            rings->pool[begin - 1] = walk.count;
    }
    rings->begins[vertex] = begin;
    rings->pool_count = begin + walk.count;
    note_size(rings, vertex, walk);
    return MESO_OK;
}

/* ---- public ---- */

void meso_one_rings_release(MesoOneRings *rings)
{
    free(rings->begins);
    free(rings->sizes);
    free(rings->pool);
    *rings = (MesoOneRings){0};
}

MesoStatus meso_one_rings_init(MesoOneRings *rings, const MesoTriangulation *mesh, MesoError *error)
{
    *rings = (MesoOneRings){0};
    /* as many spokes as corners; one more a vertex on a border, most have none */
    uint64_t expected = 3 * (uint64_t)mesh->triangle_count + mesh->vertex_count / 16 + 64;
    MesoStatus status = meso_one_rings_reserve(rings, mesh->vertex_count + 1, error);
    if (!status)
        status = reserve_pool(rings, expected, error);
    for (uint32_t v = 0; v < mesh->vertex_count && !status; v++)
        status = append_ring(rings, mesh, v, error);
    if (status)
        meso_one_rings_release(rings);
    return status;
}

/* Rings in the order of their vertices, without gaps; they have to be copied in full, for they lie in any order. */
static MesoStatus close_gaps(MesoOneRings *rings, uint32_t vertex_count, MesoError *error)
{
    MesoOneRings closed = {0};
    MesoStatus status = reserve_pool(&closed, (uint64_t)rings->pool_room, error);
    if (status)
        return status;
    for (uint32_t v = 0; v < vertex_count; v++) {
        MesoOneRing ring = meso_one_ring(rings, v);
        if (ring.count >= MESO_RING_LONG)
            closed.pool[closed.pool_count++] = ring.count;
        memcpy(closed.pool + closed.pool_count, ring.spokes, ring.count * sizeof *ring.spokes);
        rings->begins[v] = closed.pool_count;
        closed.pool_count += ring.count;
    }
    free(rings->pool);
    rings->pool = closed.pool;
    rings->pool_count = closed.pool_count;
    rings->lost = 0;
    return MESO_OK;
}

MesoStatus meso_one_rings_remake(MesoOneRings *rings, const MesoTriangulation *mesh, uint32_t vertex, MesoError *error)
{
    MesoOneRing old = meso_one_ring(rings, vertex);
    if (old.count > 0 && old.count < MESO_RING_LONG) {
        /* a walk that does not fit must not spoil the next ring, nor the old one if memory is out */
        uint32_t spokes[MESO_RING_LONG];
        Walk walk = walk_ring(mesh, vertex, spokes, old.count);
        if (walk.fits) {
            memcpy(rings->pool + rings->begins[vertex], spokes, walk.count * sizeof *spokes);
            rings->lost += old.count - walk.count;
            note_size(rings, vertex, walk);
            return MESO_OK;
        }
    }
    MesoStatus status = append_ring(rings, mesh, vertex, error);
    if (status)
        return status;
    rings->lost += old.count;
    return rings->lost > rings->pool_count / 2 + 1024 ? close_gaps(rings, mesh->vertex_count, error) : MESO_OK;
}
