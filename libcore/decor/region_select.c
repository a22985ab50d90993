#include <stdlib.h>
#include <string.h>

#include "libcore/decor/decor_work.h"
#include "libcore/mesh/point/surface_point.h"

/* Candidates of one scope. */
typedef struct Selection {
    MesoDecorWork *work;
    const MesoSelector *selector;
    uint32_t scope;
    uint32_t *regions;      /* [count] ascending */
    uint32_t count;
} Selection;

/* ---- by the tree ---- */

static bool has_tag(const MesoSelector *selector, const MesoRegion *region)
{
    for (uint32_t i = 0; i < selector->tag_count; i++)
        if (strcmp(selector->tags[i], region->tag) == 0)
            return true;
    return selector->tag_count == 0;
}

/* A leaf below (or at) a node that the path names. */
static bool is_below_path(const MesoRegionTree *tree, const Selection *s, uint32_t leaf)
{
    for (uint32_t r = leaf;; r = tree->regions[r].parent) {
        if (meso_region_fits_path(tree, s->scope, r, s->selector->path))
            return true;
        if (r == s->scope)
            return false;
    }
}

static bool is_candidate(const MesoRegionTree *tree, const Selection *s, uint32_t region)
{
    const MesoSelector *selector = s->selector;
    bool leaf = meso_region_is_leaf(tree, region);
    if (selector->level != MESO_SELECT_NODES && !leaf)
        return false;
    if (!has_tag(selector, &tree->regions[region]))
        return false;
    if (selector->path && selector->level == MESO_SELECT_DEFAULT)
        return is_below_path(tree, s, region);
    if (selector->path)
        return meso_region_fits_path(tree, s->scope, region, selector->path);
    return selector->level != MESO_SELECT_NODES || selector->tag_count > 0 || region == s->scope;
}

/* Of two nodes one within the other, the upper one is meant: a field lives on the whole of it. */
static void drop_inner(Selection *s)
{
    const MesoRegionTree *tree = &s->work->decor->tree;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        bool inner = false;
        /* parents have lower numbers: the ones before are sorted */
        for (uint32_t r = tree->regions[s->regions[i]].parent; !inner && r != MESO_NO_INDEX && r >= s->scope;
             r = tree->regions[r].parent)
            inner = bsearch(&r, s->regions, kept, sizeof r, meso_by_number) != NULL;
        if (!inner)
            s->regions[kept++] = s->regions[i];
    }
    s->count = kept;
}

static void add_within(Selection *s, uint32_t region)
{
    const MesoRegionTree *tree = &s->work->decor->tree;
    if (is_candidate(tree, s, region))
        s->regions[s->count++] = region;
    for (uint32_t i = 0; i < tree->regions[region].child_count; i++)
        add_within(s, tree->regions[region].child_begin + i);
}

/* ---- by shape ---- */

static bool is_in(MesoRange range, double value)
{
    return value >= (double)range.low && value <= (double)range.high;
}

static bool is_bounded(MesoRange range)
{
    return range.low > -INFINITY || range.high < INFINITY;
}

static bool fits_area(const Selection *s, const MesoRegion *region)
{
    double share = region->area / s->work->decor->tree.regions[s->scope].area;
    return is_in(s->selector->area, region->area) &&
           (!is_bounded(s->selector->area_share) || is_in(s->selector->area_share, share));
}

static MesoStatus keep_shaped(Selection *s, MesoError *error)
{
    const MesoSelector *selector = s->selector;
    bool borders = is_bounded(selector->borders) || is_bounded(selector->corners) || is_bounded(selector->aspect);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->count; i++) {
        MesoRegionShape shape;
        bool fits = fits_area(s, &s->work->decor->tree.regions[s->regions[i]]);
        if (fits && borders) {
            MesoStatus status = meso_decor_shape(s->work, s->regions[i], &shape, error);
            if (status)
                return status;
            fits = is_in(selector->borders, shape.borders) && is_in(selector->corners, shape.corners) &&
                   is_in(selector->aspect, shape.aspect);
        }
        if (fits)
            s->regions[kept++] = s->regions[i];
    }
    s->count = kept;
    return MESO_OK;
}

/* The one region that has the nearest point of the scope's surface. */
static MesoStatus keep_at_point(Selection *s, MesoError *error)
{
    MesoDecorWork *work = s->work;
    const MesoRegionTree *tree = &work->decor->tree;
    MesoDomain domain;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    MesoStatus status = meso_region_domain(&domain, work->member, work->scratch, tree, &work->lists, &work->decor->mesh,
                                           s->scope, error);
    if (status)
        return status;
    MesoMeshPoint nearest = meso_surface_point(&work->decor->mesh, &domain, s->selector->point);
    meso_region_domain_end(tree, s->scope, work->member);
    meso_arena_rewind(work->scratch, mark);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->count; i++)
        if (meso_region_is_within(tree, work->decor->mesh.labels[nearest.triangle], s->regions[i]))
            s->regions[kept++] = s->regions[i];
    s->count = kept;
    return MESO_OK;
}

/* ---- by neighbours ---- */

/* Pairs of selected regions that share walls, both ways, sorted. */
typedef struct Neighbours {
    uint64_t *pairs;        /* [count] higher half: one; lower half: the other */
    uint64_t count;
} Neighbours;

static int by_pair(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* Leaves of selected regions by the region's number among them, and the pairs across their walls. */
typedef struct PairSearch {
    const MesoDecorWork *work;
    uint32_t *place;        /* [region_count] by leaf, or MESO_NO_INDEX */
    uint32_t number;
    uint64_t *pairs;        /* NULL: only counted */
    uint64_t count;
} PairSearch;

static void note_place(void *context, uint32_t leaf)
{
    PairSearch *search = context;
    search->place[leaf] = search->number;
}

static void find_pairs(void *context, uint32_t leaf)
{
    PairSearch *search = context;
    const MesoTriangulation *mesh = &search->work->decor->mesh;
    const MesoRegionLists *lists = &search->work->lists;
    for (uint32_t i = lists->begin[leaf]; i < lists->begin[leaf + 1]; i++)
        for (uint32_t h = 3 * lists->triangles[i], k = 0; k < 3; k++, h++) {
            if (!meso_side_is_wall(mesh, h) || mesh->twins[h] == MESO_NO_INDEX)
                continue;
            uint32_t other = search->place[mesh->labels[mesh->twins[h] / 3]];
            if (other == search->number || other == MESO_NO_INDEX)
                continue;
            if (search->pairs)
                search->pairs[search->count] = (uint64_t)search->number << 32 | other;
            search->count++;
        }
}

static void each_leaf(const Selection *s, PairSearch *search, void (*visit)(void *context, uint32_t leaf))
{
    search->count = 0;
    for (search->number = 0; search->number < s->count; search->number++)
        meso_region_each_leaf(&s->work->decor->tree, s->regions[search->number], visit, search);
}

static MesoStatus find_neighbours(Neighbours *neighbours, const Selection *s, MesoError *error)
{
    uint32_t region_count = s->work->decor->tree.region_count;
    PairSearch search = {.work = s->work, .place = MESO_NEW(s->work->scratch, uint32_t, region_count, error)};
    if (!search.place)
        return MESO_ERR_MEMORY;
    memset(search.place, 0xff, region_count * sizeof *search.place);
    each_leaf(s, &search, note_place);
    each_leaf(s, &search, find_pairs);
    neighbours->count = 0;
    neighbours->pairs = search.pairs = MESO_NEW(s->work->scratch, uint64_t, search.count, error);
    if (!search.pairs)
        return MESO_ERR_MEMORY;
    each_leaf(s, &search, find_pairs);
    qsort(search.pairs, search.count, sizeof *search.pairs, by_pair);
    for (uint64_t i = 0; i < search.count; i++)
        if (i == 0 || search.pairs[i - 1] != search.pairs[i])
            neighbours->pairs[neighbours->count++] = search.pairs[i];
    return MESO_OK;
}

static uint64_t first_pair(const Neighbours *neighbours, uint32_t of)
{
    uint64_t low = 0, high = neighbours->count;
    while (low < high) {
        uint64_t middle = low + (high - low) / 2;
        if (neighbours->pairs[middle] >> 32 < of)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The lowest colour that no neighbour has, or the one that the fewest have. */
static uint32_t choose_color(const Neighbours *neighbours, const uint32_t *color, uint32_t of, uint32_t colors,
                             uint32_t *uses)
{
    memset(uses, 0, colors * sizeof *uses);
    for (uint64_t i = first_pair(neighbours, of); i < neighbours->count && neighbours->pairs[i] >> 32 == of; i++)
        if (color[(uint32_t)neighbours->pairs[i]] != MESO_NO_INDEX)
            uses[color[(uint32_t)neighbours->pairs[i]]]++;
    uint32_t best = 0;
    for (uint32_t c = 1; c < colors; c++)
        if (uses[c] < uses[best])
            best = c;
    return best;
}

/*
 * Breadth first, so that where two colours are enough they are: a region's first coloured neighbour decides for it.
 */
static MesoStatus color_regions(const Selection *s, uint32_t *color, MesoError *error)
{
    Neighbours neighbours;
    MesoStatus status = find_neighbours(&neighbours, s, error);
    uint32_t *queue = status ? NULL : MESO_NEW(s->work->scratch, uint32_t, s->count, error);
    uint32_t *uses = queue ? MESO_NEW(s->work->scratch, uint32_t, s->selector->colors, error) : NULL;
    uint8_t *queued = uses ? MESO_NEW(s->work->scratch, uint8_t, s->count, error) : NULL;
    if (!queued)
        return MESO_ERR_MEMORY;
    memset(color, 0xff, s->count * sizeof *color);
    for (uint32_t first = 0; first < s->count; first++) {
        uint32_t head = 0, tail = 0;
        if (queued[first])
            continue;
        queue[tail++] = first;
        queued[first] = 1;
        while (head < tail) {
            uint32_t of = queue[head++];
            color[of] = choose_color(&neighbours, color, of, s->selector->colors, uses);
            for (uint64_t i = first_pair(&neighbours, of); i < neighbours.count &&
                 neighbours.pairs[i] >> 32 == of; i++) {
                uint32_t next = (uint32_t)neighbours.pairs[i];
                if (!queued[next])
                    queue[tail++] = next;
                queued[next] = 1;
            }
        }
    }
    return MESO_OK;
}

static MesoStatus keep_colored(Selection *s, MesoError *error)
{
    uint32_t *color = MESO_NEW(s->work->scratch, uint32_t, s->count, error);
    MesoStatus status = color ? color_regions(s, color, error) : MESO_ERR_MEMORY;
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->count && !status; i++)
        if (color[i] == s->selector->color)
            s->regions[kept++] = s->regions[i];
    s->count = kept;
    return status;
}

/* ---- by number ---- */

static void keep_share(Selection *s)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < s->count; i++)
        if (meso_decor_random_share(s->work, s->regions[i], MESO_DRAW_SELECT) < s->selector->share)
            s->regions[kept++] = s->regions[i];
    s->count = kept;
}

static void keep_every(Selection *s)
{
    uint32_t kept = 0, every = s->selector->every ? s->selector->every : 1;
    for (uint64_t i = s->selector->from; i < s->count; i += every)
        s->regions[kept++] = s->regions[i];
    s->count = kept;
}

typedef struct Sized {
    double area;
    uint32_t region;
} Sized;

static int by_size(const void *a, const void *b)
{
    const Sized *x = a, *y = b;
    if (x->area != y->area)
        return x->area > y->area ? -1 : 1;
    return x->region < y->region ? -1 : x->region > y->region;
}

/* Of equal ones, the first stay. */
static MesoStatus keep_largest(Selection *s, MesoError *error)
{
    const MesoRegion *regions = s->work->decor->tree.regions;
    if (s->count <= s->selector->largest)
        return MESO_OK;
    Sized *sized = MESO_NEW(s->work->scratch, Sized, s->count, error);
    if (!sized)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < s->count; i++)
        sized[i] = (Sized){regions[s->regions[i]].area, s->regions[i]};
    qsort(sized, s->count, sizeof *sized, by_size);
    s->count = s->selector->largest;
    for (uint32_t i = 0; i < s->count; i++)
        s->regions[i] = sized[i].region;
    qsort(s->regions, s->count, sizeof *s->regions, meso_by_number);
    return MESO_OK;
}

static MesoStatus select_in_scope(Selection *s, MesoError *error)
{
    const MesoSelector *selector = s->selector;
    s->count = 0;
    add_within(s, s->scope);
    qsort(s->regions, s->count, sizeof *s->regions, meso_by_number);
    if (selector->level == MESO_SELECT_NODES)
        drop_inner(s);
    MesoStatus status = keep_shaped(s, error);
    if (!status && selector->has_point)
        status = keep_at_point(s, error);
    if (!status && selector->colors > 1)
        status = keep_colored(s, error);
    if (status)
        return status;
    if (selector->share < 1)
        keep_share(s);
    keep_every(s);
    return selector->largest ? keep_largest(s, error) : MESO_OK;
}

MesoStatus meso_decor_select(MesoDecorWork *work, const MesoSelector *selector, const uint32_t *scopes,
                             uint32_t scope_count, MesoTargets *targets, MesoError *error)
{
    const MesoRegionTree *tree = &work->decor->tree;
    Selection s = {.work = work, .selector = selector};
    *targets = (MesoTargets){0};
    s.regions = MESO_NEW(work->scratch, uint32_t, tree->region_count, error);
    targets->targets = MESO_NEW(work->scratch, MesoTarget, tree->region_count, error);
    if (!s.regions || !targets->targets)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < scope_count; i++) {
        s.scope = scopes[i];
        MesoStatus status = select_in_scope(&s, error);
        if (status)
            return status;
        for (uint32_t k = 0; k < s.count; k++)
            targets->targets[targets->count++] = (MesoTarget){s.regions[k], scopes[i]};
    }
    return MESO_OK;
}
