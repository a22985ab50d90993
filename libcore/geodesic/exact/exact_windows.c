#include "libcore/geodesic/exact/exact_windows.h"

/* ---- windows ---- */

static MesoStatus new_chunk(MesoWindowStore *store, MesoError *error)
{
    store->chunks = MESO_GROW(store->arena, store->chunks, store->chunk_count, store->chunk_room, 64, error);
    if (!store->chunks)
        return MESO_ERR_MEMORY;
    MesoWindow *chunk = MESO_NEW(store->arena, MesoWindow, MESO_WINDOW_CHUNK, error);
    if (!chunk)
        return MESO_ERR_MEMORY;
    store->chunks[store->chunk_count++] = chunk;
    return MESO_OK;
}

/* A copy of `like`, from `begin` to `end`, that waits in the queue if it says so. */
static MesoStatus make_window(MesoWindowStore *store, const MesoWindow *like, double begin, double end, uint32_t *made,
                              MesoError *error)
{
    uint32_t w = store->unused;
    if (store->count >= store->limit)
        return meso_fail(error, MESO_ERR_LIMIT, "exact distances need more than %u windows at a time", store->limit);
    if (w != MESO_NO_INDEX) {
        store->unused = meso_window(store, w)->edge;
    } else {
        MesoStatus status = store->used == store->chunk_count * MESO_WINDOW_CHUNK ? new_chunk(store, error) : MESO_OK;
        if (status)
            return status;
        w = store->used++;
    }
    store->count++;
    store->made++;
    store->peak = store->count > store->peak ? store->count : store->peak;
    MesoWindow *window = meso_window(store, w);
    *window = *like;
    window->begin = begin;
    window->end = end;
    window->listed = 1;
    *made = w;
    if (!window->pending)
        return MESO_OK;
    MesoEvent event = {meso_front_least(&window->front, begin, end), w, MESO_EVENT_WINDOW};
    return meso_event_push(&store->queue, store->arena, event, error);
}

static void give_back(MesoWindowStore *store, uint32_t w)
{
    MesoWindow *window = meso_window(store, w);
    if (window->pending || window->listed)
        return;
    window->edge = store->unused;
    store->unused = w;
    store->count--;
}

static void unlist(MesoWindowStore *store, uint32_t w)
{
    meso_window(store, w)->listed = 0;
    give_back(store, w);
}

void meso_window_settle(MesoWindowStore *store, uint32_t w)
{
    meso_window(store, w)->pending = 0;
    give_back(store, w);
}

/* ---- distance functions ---- */

double meso_front_least(const MesoFront *front, double begin, double end)
{
    double t = front->linear ? (front->x > 0 ? begin : end)
                                               : fmin(fmax(front->x, begin), end);
    return meso_front_value(front, t);
}

/* Real roots of a*t*t - 2*b*t + c, given s, the square root of b*b - a*c: each without loss of digits. */
static uint32_t stable_roots(double a, double b, double c, double s, double root[2])
{
    double q = b < 0 ? b - s : b + s;
    root[0] = q / a;
    root[1] = c / q;
    return 2;
}

/* Both from points; t counts from p's foot. The discriminant is in factors: equal sigmas would lose half the digits. */
static uint32_t point_point_ties(const MesoFront *p, const MesoFront *q, double root[2])
{
    double a = q->x - p->x, delta = q->sigma - p->sigma;
    double m = (p->y - q->y) * (p->y + q->y) - (a - delta) * (a + delta);
    double l = (a - delta) * (a + delta);
    double s = m * m + 4 * p->y * p->y * l;
    if (!(s >= 0))
        return 0;
    /* 4*(delta^2-a^2) t^2 - 4*a*m t + 4*delta^2*y^2 - m^2 = 0 */
    double c = (2 * delta * p->y - m) * (2 * delta * p->y + m);
    return stable_roots(-4 * l, 2 * a * m, c, 2 * fabs(delta) * sqrt(s), root);
}

static uint32_t point_line_ties(const MesoFront *p, const MesoFront *line, double root[2])
{
    double c = line->sigma - p->sigma + line->x * p->x;
    double g = (1 - line->x) * (1 + line->x);
    double s = c * c - p->y * p->y * g;
    if (!(s >= 0))
        return 0;
    /* t^2 + y^2 = (c + x*t)^2 */
    return stable_roots(g, c * line->x, (p->y - c) * (p->y + c), sqrt(s), root);
}

/* Where two fronts may be equal, ascending between `begin` and `end`; places where they are not do no harm. */
static uint32_t find_ties(const MesoFront *p, const MesoFront *q, double begin, double end, double tie[2])
{
    double root[2];
    uint32_t count = 1, kept = 0;
    double foot = p->linear ? q->x : p->x;
    if (p->linear && q->linear) {
        foot = 0;
        root[0] = (q->sigma - p->sigma) / (p->x - q->x);
    } else if (p->linear) {
        count = point_line_ties(q, p, root);
    } else if (q->linear) {
        count = point_line_ties(p, q, root);
    } else {
        count = point_point_ties(p, q, root);
    }
    for (uint32_t i = 0; i < count; i++)
        if (root[i] + foot > begin && root[i] + foot < end)
            tie[kept++] = root[i] + foot;
    if (kept == 2 && tie[0] > tie[1]) {
        double first = tie[1];
        tie[1] = tie[0];
        tie[0] = first;
    }
    return kept;
}

/* ---- the windows of an edge ---- */

enum { LEAST_SIZE = 2 };

static void free_places(MesoWindowStore *store, MesoWindowList *list)
{
    if (!list->places)
        return;
    memcpy((void *)list->places, &store->rooms[list->size], sizeof(MesoWindowPlace *));
    store->rooms[list->size] = list->places;
    *list = (MesoWindowList){0};
}

/* Empty, with room for so many. */
static MesoStatus new_places(MesoWindowStore *store, uint32_t count, MesoWindowList *list, MesoError *error)
{
    uint32_t size = LEAST_SIZE;
    while (UINT32_C(1) << size < count)
        size++;
    *list = (MesoWindowList){store->rooms[size], 0, size};
    if (list->places)
        memcpy(&store->rooms[size], (void *)list->places, sizeof(MesoWindowPlace *));
    else
        list->places = MESO_NEW(store->arena, MesoWindowPlace, (size_t)1 << size, error);
    return list->places ? MESO_OK : MESO_ERR_MEMORY;
}

/* The merged places in the stead of those from `begin` to `end`. */
static MesoStatus replace_places(MesoWindowStore *store, MesoWindowList *list, uint32_t begin, uint32_t end,
                                 MesoError *error)
{
    uint32_t behind = list->count - end, count = begin + store->merged_count + behind;
    MesoWindowList old = *list;
    if (!list->places || count > UINT32_C(1) << list->size) {
        MesoStatus status = new_places(store, count, list, error);
        if (status)
            return status;
        if (begin)
            memcpy(list->places, old.places, begin * sizeof *list->places);
    }
    if (behind)
        memmove(list->places + count - behind, old.places + end, behind * sizeof *list->places);
    if (store->merged_count)
        memcpy(list->places + begin, store->merged, store->merged_count * sizeof *list->places);
    list->count = count;
    if (old.places != list->places)
        free_places(store, &old);
    return MESO_OK;
}

void meso_window_clear(MesoWindowStore *store, MesoWindowList *list)
{
    for (uint32_t i = 0; i < list->count; i++)
        unlist(store, list->places[i].window);
    free_places(store, list);
}

/* The first that ends behind t. */
static uint32_t find_place(const MesoWindowList *list, double t)
{
    uint32_t low = 0, high = list->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (list->places[middle].end > t)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* An edge's windows while one is added. */
typedef struct Merge {
    MesoWindowStore *store;
    const MesoWindow *added;
    double run;             /* what of `added` lies before this is decided */
    double tiny;
    MesoError *error;
} Merge;

static MesoStatus append(Merge *merge, uint32_t w)
{
    MesoWindowStore *store = merge->store;
    store->merged = MESO_GROW(store->arena, store->merged, store->merged_count, store->merged_room, 64, merge->error);
    if (!store->merged)
        return MESO_ERR_MEMORY;
    store->merged[store->merged_count++] = (MesoWindowPlace){meso_window(store, w)->end, w};
    return MESO_OK;
}

static MesoStatus append_copy(Merge *merge, const MesoWindow *like, double begin, double end)
{
    uint32_t w = MESO_NO_INDEX;
    if (!(end - begin > merge->tiny))
        return MESO_OK;
    MesoStatus status = make_window(merge->store, like, begin, end, &w, merge->error);
    return status ? status : append(merge, w);
}

/* What is left of `w`, a part at a time: the first keeps the window. */
static MesoStatus append_rest(Merge *merge, uint32_t w, const MesoWindow *whole, bool *kept, double begin, double end)
{
    if (*kept)
        return append_copy(merge, whole, begin, end);
    if (!(end - begin > merge->tiny))
        return MESO_OK;
    MesoWindow *window = meso_window(merge->store, w);
    window->begin = begin;
    window->end = end;
    *kept = true;
    return append(merge, w);
}

/* Whoever came first stays where the difference may be rounding: else equal windows cut each other to pieces. */
static bool is_nearer(const MesoFront *added, const MesoFront *old, double t)
{
    return meso_front_value(added, t) < meso_front_value(old, t) * (1 - 1e-13);
}

/* Decides between `added` and the window `w`, which overlap. */
static MesoStatus contend(Merge *merge, uint32_t w)
{
    const MesoWindow old = *meso_window(merge->store, w), *added = merge->added;
    double cut[4] = {fmax(old.begin, added->begin)}, last = fmin(old.end, added->end), rest = old.begin;
    uint32_t cuts = 1 + find_ties(&added->front, &old.front, cut[0], last, cut + 1);
    bool kept = false;
    MesoStatus status = MESO_OK;
    cut[cuts] = last;
    for (uint32_t i = 0; i < cuts && !status; i++) {
        if (is_nearer(&added->front, &old.front, 0.5 * (cut[i] + cut[i + 1]))) {
            status = append_rest(merge, w, &old, &kept, rest, cut[i]);
            rest = cut[i + 1];
        } else {
            status = append_copy(merge, added, merge->run, cut[i]);
            merge->run = cut[i + 1];
        }
    }
    if (!status && rest == last && old.end > last) {
        status = append_copy(merge, added, merge->run, last);
        merge->run = last;
    }
    if (!status)
        status = append_rest(merge, w, &old, &kept, rest, old.end);
    if (!status && !kept)
        unlist(merge->store, w);
    return status;
}

MesoStatus meso_window_insert(MesoWindowStore *store, MesoWindowList *list, const MesoWindow *added, double tiny,
                              MesoError *error)
{
    Merge merge = {store, added, added->begin, tiny, error};
    uint32_t first = find_place(list, added->begin + tiny), next = first;
    MesoStatus status = MESO_OK;
    store->merged_count = 0;
    while (next < list->count && meso_window(store, list->places[next].window)->begin < added->end - tiny && !status)
        status = contend(&merge, list->places[next++].window);
    if (!status)
        status = append_copy(&merge, added, merge.run, added->end);
    return status ? status : replace_places(store, list, first, next, error);
}
