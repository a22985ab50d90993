/* Webs out of a surface: its own triangles, details put in, its vertices taken out; all by lengths on the surface. */
#include <stdlib.h>
#include <string.h>

#include "libcore/replicate/web/detail_web.h"
#include "libcore/replicate/web/oriented_surface.h"
#include "libcore/replicate/web/web_edit.h"

enum { STACK = 256, RING = 256, ROUNDS = 50 };

/* A web that is being built: nodes are those of the surface, and behind them the details. */
typedef struct Build {
    const MesoTriangulation *mesh;
    MesoOrientedSurface surface;
    MesoWeb web;
    double *length2;        /* [3 * triangle_room] squared, of half-edges */
    uint32_t *hosts;        /* [triangle_room] the surface's triangle that it lies in, while details are put in */
    bool *dead;             /* [triangle_room] */
    double (*places)[2];    /* [count] details in the plane of their triangle */
} Build;

/* ---- flips by lengths ---- */

static bool is_bad(const Build *b, uint32_t h)
{
    uint32_t g = b->web.twins[h];
    if (g == MESO_NO_INDEX)
        return false;
    double ab = b->length2[h], bc = b->length2[meso_next_corner(h)], ca = b->length2[meso_previous_corner(h)];
    double ad = b->length2[meso_next_corner(g)], db = b->length2[meso_previous_corner(g)];
    double cot_c = bc + ca - ab, cot_d = ad + db - ab;
    if (cot_c >= 0 && cot_d >= 0)
        return false;
    double area_c = sqrt(meso_heron(ab, bc, ca)), area_d = sqrt(meso_heron(ab, ad, db));
    return cot_c * area_d + cot_d * area_c < -1e-9 * ab * (area_c + area_d);
}

/* Between the apexes, both triangles laid flat. */
static double other_diagonal2(const Build *b, uint32_t h)
{
    uint32_t g = b->web.twins[h];
    double ab = b->length2[h], bc = b->length2[meso_next_corner(h)], ca = b->length2[meso_previous_corner(h)];
    double ad = b->length2[meso_next_corner(g)], db = b->length2[meso_previous_corner(g)];
    if (!(ab > 0))
        return ca;
    double along = (ca - bc - ad + db) / 2, across = (sqrt(meso_heron(ab, bc, ca)) + sqrt(meso_heron(ab, ad, db))) / 2;
    return (along * along + across * across) / ab;
}

static void flip(Build *b, uint32_t h, double diagonal2)
{
    uint32_t g = b->web.twins[h], n = meso_next_corner(h), gn = meso_next_corner(g);
    b->length2[h] = b->length2[gn];
    b->length2[g] = b->length2[n];
    b->length2[n] = b->length2[gn] = diagonal2;
    meso_web_flip(&b->web, h);
}

static void settle(Build *b, uint32_t h, bool in_host)
{
    uint32_t stack[STACK] = {h}, count = 1;
    for (uint32_t steps = 0; count > 0 && steps < 4 * STACK; steps++) {
        h = stack[--count];
        uint32_t g = b->web.twins[h];
        if (!is_bad(b, h) || (in_host && b->hosts[h / 3] != b->hosts[g / 3]) || !meso_web_can_flip(&b->web, h))
            continue;
        flip(b, h, other_diagonal2(b, h));
        const uint32_t around[4] = {h, meso_previous_corner(h), g, meso_previous_corner(g)};
        for (uint32_t k = 0; k < 4 && count < STACK; k++)
            stack[count++] = around[k];
    }
}

static void settle_all(Build *b)
{
    for (uint32_t round = 0, bad = 1; round < ROUNDS && bad > 0; round++) {
        bad = 0;
        for (uint32_t h = 0; h < 3 * b->web.triangle_count; h++) {
            if (b->web.twins[h] == MESO_NO_INDEX || b->web.twins[h] < h || !is_bad(b, h)
                || !meso_web_can_flip(&b->web, h))
                continue;
            settle(b, h, false);
            bad++;
        }
    }
}

/* ---- the surface ---- */

static double apart2(MesoVec3 a, MesoVec3 b)
{
    double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
    return x * x + y * y + z * z;
}

static void take_surface(Build *b)
{
    const MesoTriangulation *mesh = b->mesh;
    b->web.triangle_count = mesh->triangle_count;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        b->hosts[t] = t;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        uint32_t from = b->surface.corners[h], to = b->surface.corners[meso_next_corner(h)];
        b->web.corners[h] = from;
        b->web.node_corner[from] = h;
        b->web.twins[h] = b->surface.twins[h];
        b->length2[h] = apart2(mesh->positions[b->surface.vertices[from]], mesh->positions[b->surface.vertices[to]]);
    }
}

/* ---- details ---- */

typedef struct Host {
    uint32_t nodes[3];
    double places[3][2];
} Host;

static Host host_of(const Build *b, uint32_t triangle)
{
    uint32_t h = 3 * triangle;
    double l = sqrt(b->length2[h]), x = l > 0 ? (b->length2[h] + b->length2[h + 2] - b->length2[h + 1]) / (2 * l) : 0;
    return (Host){{b->web.corners[h], b->web.corners[h + 1], b->web.corners[h + 2]},
                  {{0, 0}, {l, 0}, {x, sqrt(fmax(0, b->length2[h + 2] - x * x))}}};
}

static const double *place_in(const Build *b, const Host *host, uint32_t node)
{
    if (node >= b->surface.node_count)
        return b->places[node - b->surface.node_count];
    return host->places[node == host->nodes[0] ? 0 : node == host->nodes[1] ? 1 : 2];
}

static double left_of(const double *p, const double *from, const double *to)
{
    return (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0]);
}

/* Inside, a hair away from sides and corners, so that no triangle has no area. */
static void place_detail(Build *b, const Host *host, const MesoMeshPoint *point, uint32_t detail)
{
    const double least = 1e-5;
    const uint32_t *corners = b->mesh->corners + 3 * (size_t)point->triangle, *vertices = b->surface.vertices;
    double place[2] = {0, 0}, sum = 0;
    for (uint32_t k = 0; k < 3; k++) {
        double w = fmax(least, (double)point->weight[k]);
        uint32_t at = corners[k] == vertices[host->nodes[0]] ? 0 : corners[k] == vertices[host->nodes[1]] ? 1 : 2;
        const double *corner = host->places[at];
        place[0] += w * corner[0];
        place[1] += w * corner[1];
        sum += w;
    }
    b->places[detail][0] = place[0] / sum;
    b->places[detail][1] = place[1] / sum;
}

/* Walks towards the place, by sides that it lies beyond, inside the host. */
static uint32_t locate(const Build *b, const Host *host, uint32_t triangle, const double *place)
{
    for (uint32_t steps = 0; steps < b->web.triangle_count; steps++) {
        uint32_t h = 3 * triangle, next = MESO_NO_INDEX;
        for (uint32_t k = 0; k < 3 && next == MESO_NO_INDEX; k++) {
            uint32_t side = h + (k + steps) % 3, twin = b->web.twins[side];
            if (twin != MESO_NO_INDEX && b->hosts[twin / 3] == b->hosts[triangle]
                && left_of(place, place_in(b, host, b->web.corners[side]),
                           place_in(b, host, b->web.corners[meso_next_corner(side)])) < 0)
                next = twin / 3;
        }
        if (next == MESO_NO_INDEX)
            break;
        triangle = next;
    }
    return triangle;
}

static double from_place(const Build *b, const Host *host, uint32_t node, const double *place)
{
    const double *q = place_in(b, host, node);
    return (q[0] - place[0]) * (q[0] - place[0]) + (q[1] - place[1]) * (q[1] - place[1]);
}

static uint32_t put_in(Build *b, const Host *host, uint32_t near, uint32_t detail)
{
    const double *place = b->places[detail];
    uint32_t t = locate(b, host, near, place), new = 3 * b->web.triangle_count;
    uint32_t node = b->surface.node_count + detail, h = 3 * t;
    double sides[3] = {b->length2[h], b->length2[h + 1], b->length2[h + 2]}, spokes[3];
    for (uint32_t k = 0; k < 3; k++)
        spokes[k] = from_place(b, host, b->web.corners[h + k], place);
    meso_web_split(&b->web, t, node);
    const double lengths[9] = {sides[0], spokes[1], spokes[0], sides[1], spokes[2], spokes[1],
                               sides[2], spokes[0], spokes[2]};
    for (uint32_t k = 0; k < 9; k++)
        b->length2[k < 3 ? h + k : new + k - 3] = lengths[k];
    b->hosts[new / 3] = b->hosts[new / 3 + 1] = b->hosts[t];
    settle(b, h, true);
    settle(b, new, true);
    settle(b, new + 3, true);
    return b->web.node_corner[node] / 3;
}

/* By host, and in it to and fro in strips, so that each is near the one before. */
typedef struct Visit {
    uint32_t host, strip;
    double along;
    uint32_t detail;
} Visit;

static int by_visit(const void *a, const void *b)
{
    const Visit *x = a, *y = b;
    if (x->host != y->host)
        return x->host < y->host ? -1 : 1;
    if (x->strip != y->strip)
        return x->strip < y->strip ? -1 : 1;
    if (x->along != y->along)
        return x->along < y->along ? -1 : 1;
    return x->detail < y->detail ? -1 : x->detail > y->detail;
}

static MesoStatus put_all(Build *b, MesoArena *arena, const MesoMeshPoint *points, uint32_t count, MesoError *error)
{
    Visit *visits = MESO_NEW(arena, Visit, count, error);
    uint32_t *many = MESO_NEW(arena, uint32_t, b->mesh->triangle_count, error);
    if (!visits || !many)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        many[points[i].triangle]++;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t t = points[i].triangle, strips = (uint32_t)sqrt(many[t] / 2.0) + 1;
        uint32_t strip = (uint32_t)fmin(strips - 1.0, fmax(0, (double)points[i].weight[0] * strips));
        double along = (double)points[i].weight[1];
        visits[i] = (Visit){t, strip, strip % 2 ? -along : along, i};
    }
    qsort(visits, count, sizeof *visits, by_visit);
    Host host = {0};
    for (uint32_t i = 0, near = 0; i < count; i++) {
        if (i == 0 || visits[i].host != visits[i - 1].host) {
            near = visits[i].host;
            host = host_of(b, near);
        }
        place_detail(b, &host, &points[visits[i].detail], visits[i].detail);
        near = put_in(b, &host, near, visits[i].detail);
    }
    return MESO_OK;
}

/* ---- taking out vertices ---- */

/* Triangles around an inner vertex, laid flat, with their angles scaled to a full turn. */
typedef struct Star {
    uint32_t degree;
    uint32_t spokes[RING];      /* half-edges from the vertex, counter-clockwise */
    double tips[RING][2];
} Star;

static bool lay_star(const Build *b, uint32_t vertex, Star *star)
{
    double angles[RING], turn = 0;
    star->degree = 0;
    MesoSpokes s = meso_spokes(&b->web, vertex);
    do {
        if (s.last || star->degree == RING)
            return false;
        uint32_t h = s.now;
        double a2 = b->length2[h], c2 = b->length2[meso_previous_corner(h)], e2 = b->length2[meso_next_corner(h)];
        double cosine = a2 > 0 && c2 > 0 ? (a2 + c2 - e2) / (2 * sqrt(a2 * c2)) : 1;
        angles[star->degree] = acos(fmax(-1, fmin(1, cosine)));
        turn += angles[star->degree];
        star->spokes[star->degree++] = h;
    } while (meso_spokes_next(&b->web, &s));
    double angle = 0;
    for (uint32_t i = 0; i < star->degree; i++) {
        double l = sqrt(b->length2[star->spokes[i]]);
        star->tips[i][0] = l * cos(angle);
        star->tips[i][1] = l * sin(angle);
        angle += angles[i] * (turn > 0 ? 2 * MESO_PI / turn : 0);
    }
    return turn > 0;
}

/* Squared radius of the circle around an ear; INFINITY where it is none. */
static double ear_radius2(const Build *b, const Star *star, uint32_t i)
{
    const double middle[2] = {0, 0};
    uint32_t before = (i + star->degree - 1) % star->degree, after = (i + 1) % star->degree;
    const double *c = star->tips[before], *w = star->tips[i], *d = star->tips[after];
    double ear = left_of(d, c, w), rest = left_of(d, middle, c);
    double cw = (c[0] - w[0]) * (c[0] - w[0]) + (c[1] - w[1]) * (c[1] - w[1]);
    double wd = (d[0] - w[0]) * (d[0] - w[0]) + (d[1] - w[1]) * (d[1] - w[1]);
    double dc = (d[0] - c[0]) * (d[0] - c[0]) + (d[1] - c[1]) * (d[1] - c[1]);
    /* a hair's width, relative to its sides, is no ear; nor may the vertex fall out of what is left, but it may lie on
       the side, as those of grids do: it goes anyway */
    if (!(ear > 1e-9 * (cw + wd)) || !(rest > -1e-9 * dc)
        || meso_web_joined(&b->web, b->web.corners[meso_next_corner(star->spokes[before])],
                           b->web.corners[meso_next_corner(star->spokes[after])]))
        return INFINITY;
    return cw * wd * dc / (4 * ear * ear);
}

static bool clip_ear(Build *b, Star *star)
{
    uint32_t best = 0;
    double least = INFINITY;
    for (uint32_t i = 0; i < star->degree; i++) {
        double r2 = ear_radius2(b, star, i);
        if (r2 < least) {
            least = r2;
            best = i;
        }
    }
    if (!(least < INFINITY))
        return false;
    uint32_t before = (best + star->degree - 1) % star->degree, after = (best + 1) % star->degree;
    double x = star->tips[after][0] - star->tips[before][0], y = star->tips[after][1] - star->tips[before][1];
    flip(b, star->spokes[best], x * x + y * y);
    star->spokes[before] = star->spokes[best];
    star->degree--;
    for (uint32_t i = best; i < star->degree; i++) {
        star->spokes[i] = star->spokes[i + 1];
        memcpy(star->tips[i], star->tips[i + 1], sizeof star->tips[i]);
    }
    return true;
}

/* Three triangles around a vertex become one; not where that would close the surface to a triangle seen twice. */
static void close_star(Build *b, const Star *star, uint32_t vertex)
{
    MesoWeb *web = &b->web;
    uint32_t h = star->spokes[0], n = meso_next_corner(h), p = meso_previous_corner(h);
    uint32_t n1 = meso_next_corner(star->spokes[1]), n2 = meso_next_corner(star->spokes[2]);
    uint32_t beyond[3] = {web->twins[n], web->twins[n1], web->twins[n2]};
    if (beyond[0] != MESO_NO_INDEX && beyond[1] != MESO_NO_INDEX && beyond[2] != MESO_NO_INDEX
        && meso_web_apex(web, beyond[0]) == meso_web_apex(web, beyond[1])
        && meso_web_apex(web, beyond[1]) == meso_web_apex(web, beyond[2]))
        return;
    uint32_t w0 = web->corners[n], w1 = web->corners[n1], w2 = web->corners[n2];
    web->corners[h] = w2;
    b->length2[h] = b->length2[n2];
    b->length2[p] = b->length2[n1];
    meso_web_pair(web, h, beyond[2]);
    meso_web_pair(web, p, beyond[1]);
    web->node_corner[w0] = n;
    web->node_corner[w1] = p;
    web->node_corner[w2] = h;
    web->node_corner[vertex] = MESO_NO_INDEX;
    b->dead[n1 / 3] = b->dead[n2 / 3] = true;
    settle(b, h, false);
    settle(b, n, false);
    settle(b, p, false);
}

static void take_out(Build *b, uint32_t vertex)
{
    Star star;
    if (b->web.node_corner[vertex] == MESO_NO_INDEX || !lay_star(b, vertex, &star))
        return;
    while (star.degree > 3 && clip_ear(b, &star))
        continue;
    if (star.degree == 3)
        close_star(b, &star, vertex);
}

/* ---- all of it ---- */

static MesoStatus start(Build *b, MesoArena *arena, const MesoTriangulation *mesh, uint32_t count, MesoError *error)
{
    *b = (Build){.mesh = mesh, .web = {.arena = arena}};
    MesoStatus status = meso_orient_surface(&b->surface, arena, mesh, error);
    if (status == MESO_OK)
        status = meso_web_reserve(&b->web, (uint64_t)b->surface.node_count + count,
                                  (uint64_t)mesh->triangle_count + 2 * (uint64_t)count, error);
    if (status != MESO_OK)
        return status;
    b->web.node_count = b->surface.node_count + count;
    b->length2 = MESO_NEW(arena, double, 3 * (size_t)b->web.triangle_room, error);
    b->hosts = MESO_NEW(arena, uint32_t, b->web.triangle_room, error);
    b->dead = MESO_NEW(arena, bool, b->web.triangle_room, error);
    b->places = meso_arena_alloc(arena, count, sizeof *b->places, error);
    for (uint32_t n = 0; n < b->web.node_count; n++)
        b->web.node_corner[n] = MESO_NO_INDEX;
    return b->length2 && b->hosts && b->dead && b->places ? MESO_OK : MESO_ERR_MEMORY;
}

/* Triangles that are left, behind each other; renames half-edges. */
static void copy_triangles(MesoWeb *web, const Build *b, uint32_t *new_triangle, const uint32_t *new_node)
{
    for (uint32_t t = 0; t < b->web.triangle_count; t++)
        new_triangle[t] = b->dead[t] ? MESO_NO_INDEX : web->triangle_count++;
    for (uint32_t h = 0; h < 3 * b->web.triangle_count; h++) {
        if (b->dead[h / 3])
            continue;
        uint32_t to = 3 * new_triangle[h / 3] + h % 3, twin = b->web.twins[h];
        web->corners[to] = new_node[b->web.corners[h]];
        web->twins[to] = twin == MESO_NO_INDEX ? MESO_NO_INDEX : 3 * new_triangle[twin / 3] + twin % 3;
        web->node_corner[web->corners[to]] = to;
    }
}

static MesoStatus finish(MesoWeb *web, Build *b, MesoArena *scratch, const MesoMeshPoint *points, uint32_t count,
                         MesoError *error)
{
    uint32_t *new_node = MESO_NEW(scratch, uint32_t, b->web.node_count, error);
    uint32_t *new_triangle = MESO_NEW(scratch, uint32_t, b->web.triangle_count, error);
    if (!new_node || !new_triangle)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_web_reserve(web, b->web.node_count, b->web.triangle_count, error);
    if (status != MESO_OK)
        return status;
    const MesoTriangulation *mesh = b->mesh;
    for (uint32_t v = 0; v < b->surface.node_count; v++) {
        if (b->web.node_corner[v] == MESO_NO_INDEX)
            continue;
        uint32_t corner = mesh->vertex_corner[b->surface.vertices[v]];
        web->points[web->node_count] = (MesoMeshPoint){.triangle = corner / 3};
        web->points[web->node_count].weight[corner % 3] = 1;
        new_node[v] = web->node_count++;
    }
    web->fixed_count = web->node_count;
    for (uint32_t i = 0; i < count; i++) {
        web->points[web->node_count] = points[i];
        new_node[b->surface.node_count + i] = web->node_count++;
    }
    copy_triangles(web, b, new_triangle, new_node);
    return MESO_OK;
}

MesoStatus meso_web_build(MesoWeb *web, MesoArena *arena, const MesoTriangulation *mesh, const MesoVec3 *normals,
                          const MesoMeshPoint *points, uint32_t count, MesoError *error)
{
    MesoArena scratch;
    Build build;
    meso_arena_init(&scratch);
    *web = (MesoWeb){.arena = arena};
    MesoStatus status = start(&build, &scratch, mesh, count, error);
    if (status == MESO_OK)
        take_surface(&build);
    if (status == MESO_OK)
        status = put_all(&build, &scratch, points, count, error);
    if (status == MESO_OK) {
        settle_all(&build);
        for (uint32_t v = 0; v < build.surface.node_count; v++)
            take_out(&build, v);
        status = finish(web, &build, &scratch, points, count, error);
    }
    meso_arena_release(&scratch);
    if (status != MESO_OK)
        return status;
    meso_web_place(web, mesh, mesh->positions, normals, 1);
    meso_web_settle(web, 0, 1);
    return MESO_OK;
}
