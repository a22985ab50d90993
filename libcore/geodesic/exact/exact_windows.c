#include "libcore/geodesic/exact/exact_windows.h"

#include "libcore/base/grow.h"

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

static void free_room(MesoWindowStore *store, MesoWindowList *list)
{
    if (!list->windows)
        return;
    memcpy((void *)list->windows, &store->rooms[list->size], sizeof(MesoWindow *));
    store->rooms[list->size] = list->windows;
    *list = (MesoWindowList){0};
}

/* Empty, with room for so many. */
static MesoStatus new_room(MesoWindowStore *store, uint32_t count, MesoWindowList *list, MesoError *error)
{
    uint32_t size = LEAST_SIZE;
    while (UINT32_C(1) << size < count)
        size++;
    *list = (MesoWindowList){store->rooms[size], 0, size};
    if (list->windows)
        memcpy(&store->rooms[size], (void *)list->windows, sizeof(MesoWindow *));
    else
        list->windows = MESO_NEW(store->arena, MesoWindow, (size_t)1 << size, error);
    return list->windows ? MESO_OK : MESO_ERR_MEMORY;
}

/* The merged windows in the stead of those from `begin` to `end`. */
static MesoStatus replace_windows(MesoWindowStore *store, MesoWindowList *list, uint32_t begin, uint32_t end,
                                  MesoError *error)
{
    uint32_t behind = list->count - end, count = begin + store->merged_count + behind;
    MesoWindowList old = *list;
    if (count > old.count && count - old.count > store->limit - store->count)
        return meso_fail(error, MESO_ERR_LIMIT, "exact distances need more than %u windows at a time", store->limit);
    if (!list->windows || count > UINT32_C(1) << list->size) {
        MesoStatus status = new_room(store, count, list, error);
        if (status)
            return status;
        if (begin)
            memcpy(list->windows, old.windows, begin * sizeof *list->windows);
    }
    if (behind)
        memmove(list->windows + count - behind, old.windows + end, behind * sizeof *list->windows);
    if (store->merged_count)
        memcpy(list->windows + begin, store->merged, store->merged_count * sizeof *list->windows);
    list->count = count;
    store->count += count - old.count;
    store->peak = store->count > store->peak ? store->count : store->peak;
    if (old.windows != list->windows)
        free_room(store, &old);
    return MESO_OK;
}

void meso_window_clear(MesoWindowStore *store, MesoWindowList *list)
{
    store->count -= list->count;
    free_room(store, list);
}

/* The first that ends behind t. */
static uint32_t find_window(const MesoWindowList *list, double t)
{
    uint32_t low = 0, high = list->count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        if (list->windows[middle].end > t)
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
    double least;           /* of what is kept of it */
    double tiny;
    MesoError *error;
} Merge;

static MesoStatus append(Merge *merge, const MesoWindow *like, double begin, double end)
{
    MesoWindowStore *store = merge->store;
    if (!(end - begin > merge->tiny))
        return MESO_OK;
    store->merged = MESO_GROW(store->arena, store->merged, store->merged_count, store->merged_room, 64, merge->error);
    if (!store->merged)
        return MESO_ERR_MEMORY;
    MesoWindow *window = &store->merged[store->merged_count++];
    *window = *like;
    window->begin = begin;
    window->end = end;
    return MESO_OK;
}

static MesoStatus append_added(Merge *merge, double end)
{
    uint32_t before = merge->store->merged_count;
    MesoStatus status = append(merge, merge->added, merge->run, end);
    if (!status && merge->store->merged_count > before) {
        merge->least = fmin(merge->least, meso_front_least(&merge->added->front, merge->run, end));
        merge->store->made++;
    }
    return status;
}

/* Whoever came first stays where the difference may be rounding: else equal windows cut each other to pieces. */
static bool is_nearer(const MesoFront *added, const MesoFront *old, double t)
{
    return meso_front_value(added, t) < meso_front_value(old, t) * (1 - 1e-13);
}

/* Decides between `added` and a window that it overlaps. */
static MesoStatus contend(Merge *merge, const MesoWindow *old)
{
    const MesoWindow *added = merge->added;
    double cut[4] = {fmax(old->begin, added->begin)}, last = fmin(old->end, added->end), rest = old->begin;
    uint32_t cuts = 1 + find_ties(&added->front, &old->front, cut[0], last, cut + 1);
    MesoStatus status = MESO_OK;
    cut[cuts] = last;
    for (uint32_t i = 0; i < cuts && !status; i++) {
        if (is_nearer(&added->front, &old->front, 0.5 * (cut[i] + cut[i + 1]))) {
            status = append(merge, old, rest, cut[i]);
            rest = cut[i + 1];
        } else {
            status = append_added(merge, cut[i]);
            merge->run = cut[i + 1];
        }
    }
    if (!status && rest == last && old->end > last) {
        status = append_added(merge, last);
        merge->run = last;
    }
    return status ? status : append(merge, old, rest, old->end);
}

MesoStatus meso_window_insert(MesoWindowStore *store, MesoWindowList *list, const MesoWindow *added, double tiny,
                              double *least, MesoError *error)
{
    Merge merge = {store, added, added->begin, INFINITY, tiny, error};
    uint32_t first = find_window(list, added->begin + tiny), next = first;
    MesoStatus status = MESO_OK;
    store->merged_count = 0;
    while (next < list->count && list->windows[next].begin < added->end - tiny && !status)
        status = contend(&merge, &list->windows[next++]);
    if (!status)
        status = append_added(&merge, added->end);
    *least = merge.least;
    return status ? status : replace_windows(store, list, first, next, error);
}
