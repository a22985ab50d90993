#include "libcore/replicate/web/web_edit.h"

#include "libcore/base/grow.h"

bool meso_spokes_next(const MesoWeb *web, MesoSpokes *spokes)
{
    spokes->last = false;
    if (!spokes->back) {
        uint32_t next = web->twins[meso_previous_corner(spokes->now)];
        if (next == spokes->first)
            return false;
        if (next != MESO_NO_INDEX) {
            spokes->now = next;
            spokes->last = web->twins[meso_previous_corner(next)] == MESO_NO_INDEX;
            return true;
        }
        spokes->back = true;
        spokes->now = spokes->first;
    }
    uint32_t twin = web->twins[spokes->now];
    if (twin == MESO_NO_INDEX)
        return false;
    spokes->now = meso_next_corner(twin);
    return true;
}

bool meso_web_joined(const MesoWeb *web, uint32_t a, uint32_t b)
{
    MesoSpokes s = meso_spokes(web, a);
    do
        if (web->corners[meso_next_corner(s.now)] == b || (s.last && meso_web_apex(web, s.now) == b))
            return true;
    while (meso_spokes_next(web, &s));
    return false;
}

uint32_t meso_web_ring(const MesoWeb *web, uint32_t node, uint32_t *ring, uint32_t room)
{
    uint32_t count = 0;
    if (web->node_corner[node] == MESO_NO_INDEX)
        return 0;
    MesoSpokes s = meso_spokes(web, node);
    do {
        if (count < room)
            ring[count] = web->corners[meso_next_corner(s.now)];
        count++;
        if (s.last) {
            if (count < room)
                ring[count] = meso_web_apex(web, s.now);
            count++;
        }
    } while (meso_spokes_next(web, &s));
    return count;
}

bool meso_web_can_flip(const MesoWeb *web, uint32_t h)
{
    uint32_t g = web->twins[h];
    if (g == MESO_NO_INDEX || g / 3 == h / 3)
        return false;
    uint32_t c = meso_web_apex(web, h), d = meso_web_apex(web, g);
    return c != d && !meso_web_joined(web, c, d);
}

void meso_web_flip(MesoWeb *web, uint32_t h)
{
    uint32_t g = web->twins[h], n = meso_next_corner(h), p = meso_previous_corner(h);
    uint32_t gn = meso_next_corner(g), gp = meso_previous_corner(g);
    uint32_t a = web->corners[h], b = web->corners[g], c = web->corners[p], d = web->corners[gp];
    uint32_t beyond_ad = web->twins[gn], beyond_bc = web->twins[n];
    web->corners[n] = d;
    web->corners[gn] = c;
    meso_web_pair(web, h, beyond_ad);
    meso_web_pair(web, g, beyond_bc);
    meso_web_pair(web, n, gn);
    web->node_corner[a] = h;
    web->node_corner[b] = g;
    web->node_corner[c] = p;
    web->node_corner[d] = gp;
}

void meso_web_split(MesoWeb *web, uint32_t triangle, uint32_t node)
{
    uint32_t h = 3 * triangle, second = 3 * web->triangle_count, third = second + 3;
    uint32_t a = web->corners[h], b = web->corners[h + 1], c = web->corners[h + 2];
    uint32_t beyond_bc = web->twins[h + 1], beyond_ca = web->twins[h + 2];
    const uint32_t corners[6] = {b, c, node, c, a, node};
    web->triangle_count += 2;
    for (uint32_t k = 0; k < 6; k++)
        web->corners[second + k] = corners[k];
    web->corners[h + 2] = node;
    meso_web_pair(web, second, beyond_bc);
    meso_web_pair(web, third, beyond_ca);
    meso_web_pair(web, h + 1, second + 2);
    meso_web_pair(web, second + 1, third + 2);
    meso_web_pair(web, third + 1, h + 2);
    web->node_corner[a] = h;
    web->node_corner[b] = second;
    web->node_corner[c] = third;
    web->node_corner[node] = h + 2;
}

/* ---- merging ---- */

enum { FAN = 64 };

static uint32_t degree_of(const MesoWeb *web, uint32_t node)
{
    return meso_web_ring(web, node, NULL, 0);
}

static MesoVec3 area_vector(const MesoWeb *web, uint32_t a, uint32_t b, uint32_t c)
{
    MesoVec3 p = web->positions[a];
    return meso_vec3_cross(meso_vec3_sub(web->positions[b], p), meso_vec3_sub(web->positions[c], p));
}

/* Of the fan around `node`, h from it to `into`. */
static bool can_merge(const MesoWeb *web, uint32_t h, const uint32_t *fan, uint32_t count)
{
    uint32_t g = web->twins[h], node = web->corners[h], into = web->corners[g];
    uint32_t left = meso_web_apex(web, h), right = meso_web_apex(web, g);
    if (left == right || degree_of(web, left) < 4 || degree_of(web, right) < 4)
        return false;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = web->corners[meso_next_corner(fan[i])], b = meso_web_apex(web, fan[i]);
        if (a != into && a != left && a != right && meso_web_joined(web, a, into))
            return false;
        if (a != into && b != into
            && !(meso_vec3_dot(area_vector(web, node, a, b), area_vector(web, into, a, b)) > 0))
            return false;
    }
    return true;
}

static void drop_triangle(MesoWeb *web, uint32_t triangle)
{
    uint32_t last = --web->triangle_count;
    for (uint32_t k = 0; k < 3 && triangle != last; k++) {
        uint32_t from = 3 * last + k, to = 3 * triangle + k;
        web->corners[to] = web->corners[from];
        meso_web_pair(web, to, web->twins[from]);
        if (web->node_corner[web->corners[to]] == from)
            web->node_corner[web->corners[to]] = to;
    }
}

static void merge(MesoWeb *web, uint32_t h, const uint32_t *fan, uint32_t count)
{
    uint32_t g = web->twins[h], node = web->corners[h], into = web->corners[g];
    uint32_t n = web->twins[meso_next_corner(h)], p = web->twins[meso_previous_corner(h)];
    uint32_t gn = web->twins[meso_next_corner(g)], gp = web->twins[meso_previous_corner(g)];
    uint32_t left = meso_web_apex(web, h), right = meso_web_apex(web, g);
    for (uint32_t i = 0; i < count; i++)
        web->corners[fan[i]] = into;
    meso_web_pair(web, p, n);       /* these two begin or end at the node, and so are there */
    meso_web_pair(web, gn, gp);
    web->node_corner[into] = p;
    web->node_corner[left] = meso_next_corner(p);
    web->node_corner[right] = gn;
    web->node_corner[node] = MESO_NO_INDEX;
    uint32_t first = h / 3, second = g / 3;
    drop_triangle(web, first > second ? first : second);
    drop_triangle(web, first > second ? second : first);
}

bool meso_web_merge(MesoWeb *web, uint32_t node, uint32_t into)
{
    uint32_t fan[FAN], count = 0, towards = MESO_NO_INDEX;
    if (web->node_corner[node] == MESO_NO_INDEX)
        return false;
    MesoSpokes s = meso_spokes(web, node);
    do {
        if (s.last || s.back || count == FAN)
            return false;
        if (web->corners[meso_next_corner(s.now)] == into)
            towards = s.now;
        fan[count++] = s.now;
    } while (meso_spokes_next(web, &s));
    if (towards == MESO_NO_INDEX || !can_merge(web, towards, fan, count))
        return false;
    merge(web, towards, fan, count);
    return true;
}

static MesoStatus reserve_nodes(MesoWeb *web, uint64_t count, MesoError *error)
{
    size_t room = count + count / 2, n = web->node_count;
    MesoMeshPoint *points = meso_arena_enlarge(web->arena, web->points, n, room, sizeof *points, error);
    MesoVec3 *positions = meso_arena_enlarge(web->arena, web->positions, n, room, sizeof *positions, error);
    MesoVec3 *normals = meso_arena_enlarge(web->arena, web->normals, n, room, sizeof *normals, error);
    uint32_t *node_corner = meso_arena_enlarge(web->arena, web->node_corner, n, room, sizeof *node_corner, error);
    if (!points || !positions || !normals || !node_corner)
        return MESO_ERR_MEMORY;
    web->points = points;
    web->positions = positions;
    web->normals = normals;
    web->node_corner = node_corner;
    web->node_room = (uint32_t)room;
    return MESO_OK;
}

static MesoStatus reserve_triangles(MesoWeb *web, uint64_t count, MesoError *error)
{
    size_t room = count + count / 2, n = 3 * (size_t)web->triangle_count;
    uint32_t *corners = meso_arena_enlarge(web->arena, web->corners, n, 3 * room, sizeof *corners, error);
    uint32_t *twins = meso_arena_enlarge(web->arena, web->twins, n, 3 * room, sizeof *twins, error);
    if (!corners || !twins)
        return MESO_ERR_MEMORY;
    web->corners = corners;
    web->twins = twins;
    web->triangle_room = (uint32_t)room;
    return MESO_OK;
}

MesoStatus meso_web_reserve(MesoWeb *web, uint64_t node_count, uint64_t triangle_count, MesoError *error)
{
    if (triangle_count > UINT32_MAX / 8 || node_count > UINT32_MAX / 8)
        return meso_fail(error, MESO_ERR_LIMIT, "too many details: %llu", (unsigned long long)node_count);
    if (node_count > web->node_room && reserve_nodes(web, node_count, error) != MESO_OK)
        return MESO_ERR_MEMORY;
    if (triangle_count > web->triangle_room && reserve_triangles(web, triangle_count, error) != MESO_OK)
        return MESO_ERR_MEMORY;
    return MESO_OK;
}

/* ---- check ---- */

static MesoStatus check_half_edge(const MesoWeb *web, uint32_t h, MesoError *error)
{
    uint32_t g = web->twins[h], a = web->corners[h], b = web->corners[meso_next_corner(h)];
    if (a >= web->node_count || a == b)
        return meso_fail(error, MESO_ERR_INTERNAL, "half-edge %u joins a node to itself", h);
    if (g != MESO_NO_INDEX
        && (web->twins[g] != h || web->corners[g] != b || web->corners[meso_next_corner(g)] != a))
        return meso_fail(error, MESO_ERR_INTERNAL, "half-edge %u and its twin do not join the same nodes", h);
    return MESO_OK;
}

static uint32_t spokes_of(const MesoWeb *web, uint32_t node, uint32_t *repeated)
{
    uint32_t count = 0, ring[64], size = meso_web_ring(web, node, ring, 64);
    MesoSpokes s = meso_spokes(web, node);
    do
        count++;
    while (meso_spokes_next(web, &s));
    for (uint32_t i = 0; i < size && i < 64; i++)
        for (uint32_t k = 0; k < i; k++)
            *repeated += ring[i] == ring[k];
    return count;
}

MesoStatus meso_web_check(const MesoWeb *web, int64_t euler, MesoError *error)
{
    int64_t edges2 = 0, nodes = 0, corners = 0;
    for (uint32_t h = 0; h < 3 * web->triangle_count; h++) {
        MesoStatus status = check_half_edge(web, h, error);
        if (status != MESO_OK)
            return status;
        edges2 += web->twins[h] == MESO_NO_INDEX ? 2 : 1;
    }
    for (uint32_t n = 0; n < web->node_count; n++) {
        uint32_t repeated = 0;
        if (web->node_corner[n] == MESO_NO_INDEX)
            continue;
        if (web->corners[web->node_corner[n]] != n)
            return meso_fail(error, MESO_ERR_INTERNAL, "half-edge of node %u begins elsewhere", n);
        corners += spokes_of(web, n, &repeated);
        if (repeated)
            return meso_fail(error, MESO_ERR_INTERNAL, "node %u is joined to another twice", n);
        nodes++;
    }
    if (corners != 3 * (int64_t)web->triangle_count)
        return meso_fail(error, MESO_ERR_INTERNAL, "a node has several fans");
    if (nodes - edges2 / 2 + web->triangle_count != euler)
        return meso_fail(error, MESO_ERR_INTERNAL, "Euler characteristic is %lld, not %lld",
                         (long long)(nodes - edges2 / 2 + web->triangle_count), (long long)euler);
    return MESO_OK;
}
