/* Where rings of strands should have others around them. */
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/base/parallel.h"
#include "libcore/quilt/finish/finish_relax_work.h"

/* Rings around a ring are looked for at these distances, as shares of the swatch's shorter side. */
static const float DISTANCES[2] = {0.08f, 0.16f};

/* Along strands into another patch: so many rings, of which each third counts. */
enum { ACROSS = 9, ACROSS_STRIDE = 3 };

/* The step from patch to patch itself is to be as long as all others. */
#define JOINT_WEIGHT 10

/*
 * What another patch has where this one would have a ring: at most so far from there, as a share of the swatch's
 * shorter side; on the same side of the surface, and along the same way, by the cosines; and as high, by a share of
 * the swatch's height.
 */
#define GUESS_REACH 0.05f
#define GUESS_SIDE 0.5f
#define GUESS_COSINE 0.85f
#define GUESS_HEIGHT 0.25f

/* ---- around a ring of the swatch ---- */

/* Rings by where they are. */
typedef struct Grid {
    uint32_t columns, rows;
    float cell;
    MesoVec2 low;
    uint32_t *heads, *next;     /* [columns * rows], [rings] or MESO_NO_INDEX */
} Grid;

static uint32_t clamp_cell(float at, uint32_t count)
{
    return at > 0 ? at < (float)count ? (uint32_t)at : count - 1 : 0;
}

static MesoStatus make_grid(Grid *grid, const MesoRelaxing *r, const MesoSwatch *swatch, MesoError *error)
{
    uint32_t count = r->rings->count;
    grid->cell = 2 * sqrtf(swatch->size.x * swatch->size.y / (float)count);
    grid->columns = (uint32_t)(swatch->size.x / grid->cell) + 1;
    grid->rows = (uint32_t)(swatch->size.y / grid->cell) + 1;
    size_t cells = (size_t)grid->columns * grid->rows;
    grid->heads = MESO_NEW(r->arena, uint32_t, cells, error);
    grid->next = MESO_NEW(r->arena, uint32_t, count, error);
    if (!grid->heads || !grid->next)
        return MESO_ERR_MEMORY;
    memset(grid->heads, 0xff, cells * sizeof *grid->heads);
    for (uint32_t i = 0; i < count; i++) {
        MesoVec2 p = meso_relax_place(r, i);
        uint32_t x = clamp_cell(p.x / grid->cell, grid->columns), y = clamp_cell(p.y / grid->cell, grid->rows);
        uint32_t *head = &grid->heads[(size_t)y * grid->columns + x];
        grid->next[i] = *head;
        *head = i;
    }
    return MESO_OK;
}

/* The ring nearest to a place, but for one; MESO_NO_INDEX where none is near. */
static uint32_t nearest_ring(const Grid *grid, const MesoRelaxing *r, MesoVec2 place, uint32_t but)
{
    uint32_t best = MESO_NO_INDEX;
    float least = grid->cell;
    for (int i = 0; i < 9; i++) {
        float x = place.x / grid->cell + (float)(i % 3 - 1), y = place.y / grid->cell + (float)(i / 3 - 1);
        if (!(x >= 0 && y >= 0 && x < (float)grid->columns && y < (float)grid->rows))
            continue;
        for (uint32_t n = grid->heads[(size_t)(uint32_t)y * grid->columns + (uint32_t)x]; n != MESO_NO_INDEX;
             n = grid->next[n]) {
            float distance = meso_vec2_length(meso_vec2_sub(meso_relax_place(r, n), place));
            if (n != but && distance < least) {
                least = distance;
                best = n;
            }
        }
    }
    return best;
}

MesoStatus meso_relax_look_around(MesoRelaxing *r, MesoError *error)
{
    Grid grid;
    uint32_t count = r->rings->count;
    float side = r->side / r->scale;
    MesoStatus status = make_grid(&grid, r, r->swatch, error);
    r->near = MESO_NEW(r->arena, uint32_t, MESO_RELAX_NEAR * (size_t)count, error);
    if (!r->near || status)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t *near = &r->near[MESO_RELAX_NEAR * (size_t)i];
        memcpy(near, &r->rings->next[2 * (size_t)i], 2 * sizeof *near);
        for (uint32_t k = 0; k < 2 * MESO_RELAX_DIRECTIONS; k++) {
            double angle = 2 * MESO_PI * (k / 2 + 0.5 * (k % 2)) / MESO_RELAX_DIRECTIONS;
            MesoVec2 way = {(float)cos(angle), (float)sin(angle)};
            MesoVec2 place = meso_vec2_add(meso_relax_place(r, i), meso_vec2_scale(way, DISTANCES[k % 2] * side));
            near[2 + k] = nearest_ring(&grid, r, place, i);
        }
    }
    return MESO_OK;
}

/* ---- pairs ---- */

uint32_t *meso_relax_entry(const MesoRelaxing *r, uint32_t patch, uint32_t name)
{
    uint64_t hash = ((uint64_t)patch << 32 | name) * UINT64_C(0x9e3779b97f4a7c15);
    uint32_t at = (uint32_t)(hash >> 32) & r->mask;
    while (r->table[at] != MESO_NO_INDEX &&
           (r->nodes[r->table[at]].name != name || r->nodes[r->table[at]].patch != patch))
        at = (at + 1) & r->mask;
    return &r->table[at];
}

static MesoRelaxPair pair_of(const MesoRelaxing *r, uint32_t from_name, uint32_t to, uint32_t to_name)
{
    MesoVec2 way = meso_vec2_sub(meso_relax_place(r, to_name), meso_relax_place(r, from_name));
    way = meso_vec2_scale(way, r->scale);
    float soft = MESO_RELAX_SOFT * r->side;
    return (MesoRelaxPair){to, way.x, way.y, 1 / (way.x * way.x + way.y * way.y + soft * soft)};
}

/* The other one of two next rings. */
static uint32_t other_of(const uint32_t next[2], uint32_t one)
{
    return next[next[0] == one];
}

static bool is_next(const uint32_t next[2], uint32_t one)
{
    return one != MESO_NO_INDEX && (next[0] == one || next[1] == one);
}

/*
 * Along the strand in one direction, in the quilt and in the swatch at the same time; what is of another patch there is
 * added. Which way the swatch goes is known by the ring before, or by the first ring if that is of the same patch.
 */
static uint32_t pair_across(MesoRelaxPair *pairs, const MesoRelaxing *r, uint32_t node, int way)
{
    const MesoRelaxNode *from = &r->nodes[node];
    uint32_t count = 0, before = node, at = from->next[way], behind = from->next[1 - way];
    const uint32_t *next = &r->rings->next[2 * (size_t)from->name];
    uint32_t name_before = from->name, name;
    if (at == MESO_NO_INDEX)
        return 0;
    if (r->nodes[at].patch == from->patch && is_next(next, r->nodes[at].name))
        name = r->nodes[at].name;
    else if (behind != MESO_NO_INDEX && r->nodes[behind].patch == from->patch && is_next(next, r->nodes[behind].name))
        name = other_of(next, r->nodes[behind].name);
    else
        return 0;
    for (uint32_t step = 1; step <= ACROSS && at != MESO_NO_INDEX && name != MESO_NO_INDEX; step++) {
        if (r->nodes[at].patch != from->patch && (step == 1 || step % ACROSS_STRIDE == 0)) {
            if (pairs) {
                pairs[count] = pair_of(r, from->name, at, name);
                pairs[count].weight *= step == 1 ? JOINT_WEIGHT : 1;
            }
            count++;
        }
        uint32_t node_after = other_of(r->nodes[at].next, before);
        uint32_t name_after = other_of(&r->rings->next[2 * (size_t)name], name_before);
        before = at;
        at = node_after;
        name_before = name;
        name = name_after;
    }
    return count;
}

/* Those of one node; only counted where `pairs` is NULL. */
static uint32_t list_pairs(MesoRelaxPair *pairs, const MesoRelaxing *r, uint32_t node)
{
    const MesoRelaxNode *from = &r->nodes[node];
    uint32_t count = 0;
    for (uint32_t k = 0; k < MESO_RELAX_NEAR; k++) {
        uint32_t name = r->near[MESO_RELAX_NEAR * (size_t)from->name + k];
        uint32_t to = name == MESO_NO_INDEX ? MESO_NO_INDEX : *meso_relax_entry(r, from->patch, name);
        if (to == MESO_NO_INDEX || to == node)
            continue;
        if (pairs)
            pairs[count] = pair_of(r, from->name, to, name);
        count++;
    }
    for (int way = 0; way < 2; way++)
        count += pair_across(pairs ? &pairs[count] : NULL, r, node, way);
    return count;
}

static void count_range(void *context, uint64_t begin, uint64_t end)
{
    const MesoRelaxing *r = context;
    for (uint32_t i = (uint32_t)begin; i < end; i++)
        r->begin[i + 1] = list_pairs(NULL, r, i);
}

static void list_range(void *context, uint64_t begin, uint64_t end)
{
    const MesoRelaxing *r = context;
    for (uint32_t i = (uint32_t)begin; i < end; i++)
        list_pairs(&r->pairs[r->begin[i]], r, i);
}

MesoStatus meso_relax_find_pairs(MesoRelaxing *r, MesoError *error)
{
    r->begin = MESO_NEW(r->arena, uint32_t, (size_t)r->node_count + 1, error);
    if (!r->begin)
        return MESO_ERR_MEMORY;
    meso_parallel_for(r->thread_count, r->node_count, MESO_RELAX_BLOCK, count_range, r);
    for (uint32_t i = 0; i < r->node_count; i++)
        r->begin[i + 1] += r->begin[i];
    r->pairs = MESO_NEW(r->arena, MesoRelaxPair, r->begin[r->node_count], error);
    if (r->pairs)
        meso_parallel_for(r->thread_count, r->node_count, MESO_RELAX_BLOCK, list_range, r);
    return r->pairs ? MESO_OK : MESO_ERR_MEMORY;
}

/* ---- strands of other patches ---- */

/* Where a node has moved to. */
static MesoVec3 moved(const MesoRelaxing *r, uint32_t node)
{
    const double *m = &r->moves[3 * (size_t)node];
    return meso_vec3_add(r->nodes[node].foot, (MesoVec3){(float)m[0], (float)m[1], (float)m[2]});
}

static void find_cell(int32_t cell[3], MesoVec3 p, float width)
{
    const float place[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; k++)
        cell[k] = (int32_t)fmaxf(fminf(floorf(place[k] / width), 1e9f), -1e9f);
}

static uint32_t *head_of(const MesoRelaxing *r, const int32_t cell[3])
{
    uint32_t key = (uint32_t)cell[0] * 73856093u ^ (uint32_t)cell[1] * 19349663u ^ (uint32_t)cell[2] * 83492791u;
    return &r->heads[(key ^ key >> 15) & r->mask];
}

static void sort_nodes(MesoRelaxing *r)
{
    memset(r->heads, 0xff, ((size_t)r->mask + 1) * sizeof *r->heads);
    for (uint32_t i = 0; i < r->node_count; i++) {
        int32_t cell[3];
        find_cell(cell, moved(r, i), GUESS_REACH * r->side);
        uint32_t *head = head_of(r, cell);
        r->next_in_cell[i] = *head;
        *head = i;
    }
}

/* Along a node's strand. */
static MesoVec3 axis_at(const MesoRelaxing *r, uint32_t node, uint32_t name)
{
    MesoVec3 axis = r->rings->axes[name];
    return meso_vec3_direction(meso_relax_turned(r, node, axis.x, axis.y), (MesoVec3){0, 0, 0});
}

/* Whether a node can be what another one should have as `name` at a place, and nearer than `least`. */
static bool could_be(float *least, const MesoRelaxing *r, uint32_t from, uint32_t name, MesoVec3 place, uint32_t node)
{
    const MesoRelaxNode *a = &r->nodes[from], *b = &r->nodes[node];
    float distance = meso_vec3_length(meso_relax_along(meso_vec3_sub(moved(r, node), place), a->normal));
    float above = fabsf(r->rings->middles[b->name].z - r->rings->middles[name].z);
    if (b->patch == a->patch || !(distance < *least) || meso_vec3_dot(a->normal, b->normal) < GUESS_SIDE ||
        above > GUESS_HEIGHT * r->swatch->size.z ||
        fabsf(meso_vec3_dot(axis_at(r, from, name), axis_at(r, node, b->name))) < GUESS_COSINE)
        return false;
    *least = distance;
    return true;
}

static uint32_t find_guess(const MesoRelaxing *r, uint32_t from, uint32_t name, MesoVec3 place)
{
    uint32_t best = MESO_NO_INDEX;
    float least = GUESS_REACH * r->side;
    int32_t middle[3];
    find_cell(middle, place, least);
    for (int32_t i = 0; i < 27; i++) {
        const int32_t cell[3] = {middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1};
        for (uint32_t n = *head_of(r, cell); n != MESO_NO_INDEX; n = r->next_in_cell[n])
            if (could_be(&least, r, from, name, place, n))
                best = n;
    }
    return best;
}

/* Where a node's ring should have another one: by its place among those around it, or MESO_NO_INDEX. */
static uint32_t look_for(const MesoRelaxing *r, uint32_t from, uint32_t k)
{
    uint32_t name = r->near[MESO_RELAX_NEAR * (size_t)r->nodes[from].name + k];
    if (name == MESO_NO_INDEX || *meso_relax_entry(r, r->nodes[from].patch, name) != MESO_NO_INDEX)
        return MESO_NO_INDEX;
    MesoRelaxPair pair = pair_of(r, r->nodes[from].name, MESO_NO_INDEX, name);
    return find_guess(r, from, name, meso_vec3_add(moved(r, from), meso_relax_turned(r, from, pair.x, pair.y)));
}

/* What nodes from `first` on find. */
typedef struct Search {
    const MesoRelaxing *r;
    uint32_t first;
    uint32_t *found;            /* [MESO_RELAX_NEAR] of each */
} Search;

static void search_range(void *context, uint64_t begin, uint64_t end)
{
    const Search *search = context;
    for (uint32_t i = (uint32_t)begin; i < end; i++)
        for (uint32_t k = 0; k < MESO_RELAX_NEAR; k++)
            search->found[MESO_RELAX_NEAR * (size_t)i + k] = look_for(search->r, search->first + i, k);
}

static MesoStatus add_guess(MesoRelaxing *r, uint32_t from, uint32_t name, uint32_t to, MesoError *error)
{
    const MesoRelaxNode *node = &r->nodes[from];
    MesoRelaxPair pair = pair_of(r, node->name, to, name);
    MesoVec3 across = meso_vec3_cross(node->normal, axis_at(r, to, r->nodes[to].name));
    r->guesses = MESO_GROW(r->arena, r->guesses, r->guess_count, r->guess_room, 1024, error);
    if (!r->guesses)
        return MESO_ERR_MEMORY;
    r->guesses[r->guess_count++] = (MesoRelaxGuess){from, pair, meso_vec3_direction(across, (MesoVec3){0, 0, 0})};
    return MESO_OK;
}

MesoStatus meso_relax_guess(MesoRelaxing *r, MesoError *error)
{
    r->guess_count = 0;
    sort_nodes(r);
    uint32_t batch = r->node_count < MESO_RELAX_BATCH ? r->node_count : MESO_RELAX_BATCH;
    Search search = {.r = r, .found = MESO_NEW(r->arena, uint32_t, MESO_RELAX_NEAR * (size_t)batch, error)};
    if (!search.found)
        return MESO_ERR_MEMORY;
    for (; search.first < r->node_count; search.first += batch) {
        uint32_t rest = r->node_count - search.first, count = rest < batch ? rest : batch;
        meso_parallel_for(r->thread_count, count, MESO_RELAX_BLOCK, search_range, &search);
        for (uint32_t at = 0; at < MESO_RELAX_NEAR * count; at++) {
            uint32_t node = search.first + at / MESO_RELAX_NEAR;
            uint32_t name = r->near[MESO_RELAX_NEAR * (size_t)r->nodes[node].name + at % MESO_RELAX_NEAR];
            if (search.found[at] != MESO_NO_INDEX && add_guess(r, node, name, search.found[at], error))
                return MESO_ERR_MEMORY;
        }
    }
    return MESO_OK;
}
