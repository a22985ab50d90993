#include "libcore/replicate/plan/paper_rule.h"

#include "libcore/base/grow.h"
#include "libcore/replicate/plan/surface_foot.h"

enum { GRID = MESO_PAPER_GRID, SPLITS_A_STEP = 1000 };

/* What is nearer than this much of a mean triangle's side has merged. */
static const double CLOSE = 0.05;

/* Areas of H0 over the trigger's. */
static const double USEFUL = 3;

/* ---- H0 ---- */

static double twice_area(const double *a, const double *b, const double *c)
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double apart2(const double *a, const double *b)
{
    return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
}

/* The plane across the mean normal. */
static void lay_flat(MesoPaperRule *rule, const MesoReplication *r)
{
    MesoVec3 sum = {0, 0, 0};
    for (uint32_t i = 0; i < r->detail_count; i++)
        sum = meso_vec3_add(sum, r->web.normals[r->web.fixed_count + i]);
    MesoVec3 n = meso_vec3_unit(sum, (MesoVec3){0, 0, 1});
    MesoVec3 axis = fabsf(n.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(axis, n), axis), y = meso_vec3_cross(n, x);
    for (uint32_t i = 0; i < r->detail_count; i++) {
        MesoVec3 p = r->web.positions[r->web.fixed_count + i];
        rule->places[i][0] = meso_vec3_dot(p, x);
        rule->places[i][1] = meso_vec3_dot(p, y);
    }
}

static void inside_weights(const MesoPaperRule *rule, const uint32_t c[3], uint32_t p, double w[3])
{
    const double *place = rule->places[p];
    const double *a = rule->places[c[0]], *b = rule->places[c[1]], *d = rule->places[c[2]];
    w[0] = twice_area(place, b, d);
    w[1] = twice_area(a, place, d);
    w[2] = twice_area(a, b, place);
}

static bool has_inside(const MesoPaperRule *rule, const MesoReplication *r, const uint32_t c[3])
{
    for (uint32_t p = 0; p < r->options.original_count; p++) {
        double w[3];
        inside_weights(rule, c, p, w);
        if (p != c[0] && p != c[1] && p != c[2] && w[0] > 0 && w[1] > 0 && w[2] > 0)
            return true;
    }
    return false;
}

/* The corner across from the shortest side has the smallest angle; of equal ones, the first. */
static uint32_t sharpest(double side0, double side1, double side2)
{
    if (side1 <= side0 && side1 <= side2)
        return 0;
    return side2 <= side0 ? 1 : 2;
}

static bool make_triangle(MesoPaperTriangle *out, const MesoPaperRule *rule, uint32_t a, uint32_t b, uint32_t c)
{
    double area = twice_area(rule->places[a], rule->places[b], rule->places[c]) / 2;
    uint32_t order[3] = {a, area < 0 ? c : b, area < 0 ? b : c};
    if (!(fabs(area) > 0) || fabs(area) > rule->most)
        return false;
    double sides[3];
    for (uint32_t k = 0; k < 3; k++)
        sides[k] = apart2(rule->places[order[k]], rule->places[order[(k + 1) % 3]]);
    uint32_t first = sharpest(sides[0], sides[1], sides[2]);
    *out = (MesoPaperTriangle){(float)fabs(area), (float)meso_smallest_angle(sides[0], sides[1], sides[2]),
                               {order[first], order[(first + 1) % 3], order[(first + 2) % 3]}};
    return true;
}

static uint32_t axis_cell(double x, double most)
{
    double at = x / most * GRID;
    return at < GRID - 1 ? (uint32_t)at : GRID - 1;
}

static uint32_t cell_of(const MesoPaperRule *rule, const MesoPaperTriangle *t)
{
    return axis_cell((double)t->area, rule->most) * GRID + axis_cell((double)t->angle, MESO_PI / 3);
}

static MesoStatus gather(MesoPaperTriangle **out, uint32_t *count, const MesoPaperRule *rule, const MesoReplication *r,
                         MesoArena *arena, MesoError *error)
{
    uint32_t n = r->options.original_count, room = 0;
    MesoPaperTriangle triangle, *all = NULL;
    for (uint32_t a = 0; a < n; a++)
        for (uint32_t b = a + 1; b < n; b++)
            for (uint32_t c = b + 1; c < n; c++) {
                if (!make_triangle(&triangle, rule, a, b, c) || !has_inside(rule, r, triangle.corners))
                    continue;
                all = MESO_GROW(arena, all, *count, room, 1 << 16, error);
                if (!all)
                    return MESO_ERR_MEMORY;
                all[(*count)++] = triangle;
            }
    *out = all;
    return MESO_OK;
}

static MesoStatus fill_grid(MesoPaperRule *rule, MesoReplication *r, MesoArena *scratch, MesoError *error)
{
    MesoPaperTriangle *all = NULL;
    uint32_t count = 0;
    MesoStatus status = gather(&all, &count, rule, r, scratch, error);
    if (status != MESO_OK)
        return status;
    rule->begin = MESO_NEW(&r->arena, uint32_t, GRID * GRID + 1, error);
    rule->triangles = MESO_NEW(&r->arena, MesoPaperTriangle, count, error);
    if (!rule->begin || !rule->triangles)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < count; i++)
        rule->begin[cell_of(rule, &all[i])]++;
    for (uint32_t c = 0, sum = 0; c <= GRID * GRID; c++) {
        sum += rule->begin[c];
        rule->begin[c] = sum;
    }
    for (uint32_t i = count; i-- > 0;)
        rule->triangles[--rule->begin[cell_of(rule, &all[i])]] = all[i];
    return MESO_OK;
}

MesoStatus meso_paper_build(MesoPaperRule *rule, MesoReplication *r, MesoError *error)
{
    if (r->options.original_count > MESO_PAPER_MOST)
        return meso_fail(error, MESO_ERR_LIMIT, "the paper's rule is for %d details, not for %u", MESO_PAPER_MOST,
                         r->options.original_count);
    *rule = (MesoPaperRule){.area = r->exemplars.area, .angle = r->exemplars.angle, .smallest = INFINITY};
    for (uint32_t t = 0; t < r->web.triangle_count; t++) {
        const uint32_t *c = r->web.corners + 3 * (size_t)t;
        if (c[0] < r->web.fixed_count || c[1] < r->web.fixed_count || c[2] < r->web.fixed_count)
            continue;
        rule->largest = fmax(rule->largest, meso_web_area(&r->web, t));
        rule->smallest = fmin(rule->smallest, meso_web_area(&r->web, t));
    }
    rule->close = CLOSE * sqrt(rule->area);
    rule->most = USEFUL * r->options.alpha * rule->largest;
    rule->places = meso_arena_alloc(&r->arena, r->detail_count, sizeof *rule->places, error);
    if (!rule->places)
        return MESO_ERR_MEMORY;
    lay_flat(rule, r);
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoStatus status = fill_grid(rule, r, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}

/* ---- a split ---- */

/* In its cell and those around it, and further out where these are empty. */
static const MesoPaperTriangle *most_similar(const MesoPaperRule *rule, double area, double angle)
{
    const MesoPaperTriangle *best = NULL;
    double least = INFINITY;
    int32_t row = (int32_t)axis_cell(area, rule->most), column = (int32_t)axis_cell(angle, MESO_PI / 3);
    for (int32_t reach = 1; reach < GRID && !best; reach++)
        for (int32_t y = row - reach; y <= row + reach; y++)
            for (int32_t x = column - reach; x <= column + reach; x++) {
                if (y < 0 || y >= GRID || x < 0 || x >= GRID)
                    continue;
                for (uint32_t i = rule->begin[y * GRID + x]; i < rule->begin[y * GRID + x + 1]; i++) {
                    const MesoPaperTriangle *t = &rule->triangles[i];
                    double e = fmax(fabs(area - (double)t->area) / rule->area,
                                    fabs(angle - (double)t->angle) / rule->angle);
                    if (e < least) {
                        least = e;
                        best = t;
                    }
                }
            }
    return best;
}

static MesoStatus split(MesoReplication *r, uint32_t triangle, int32_t frame, bool *done, MesoError *error)
{
    const MesoPaperRule *rule = r->paper;
    const MesoWeb *web = &r->web;
    const uint32_t *c = web->corners + 3 * (size_t)triangle;
    double sides[3];
    for (uint32_t k = 0; k < 3; k++)
        sides[k] = meso_web_length2(web, c[k], c[(k + 1) % 3]);
    const MesoPaperTriangle *similar = most_similar(rule, meso_web_area(web, triangle),
                                                    meso_smallest_angle(sides[0], sides[1], sides[2]));
    *done = similar != NULL;
    if (!similar)
        return MESO_OK;
    uint32_t first = sharpest(sides[0], sides[1], sides[2]), corners[3];
    MesoVec3 places[3];
    for (uint32_t k = 0; k < 3; k++) {
        corners[k] = c[(first + k) % 3] - web->fixed_count;
        places[k] = web->positions[c[(first + k) % 3]];
    }
    for (uint32_t p = 0; p < r->options.original_count; p++) {
        double w[3], all = 2 * (double)similar->area;
        inside_weights(rule, similar->corners, p, w);
        if (p == similar->corners[0] || p == similar->corners[1] || p == similar->corners[2]
            || !(w[0] > 0 && w[1] > 0 && w[2] > 0))
            continue;
        uint32_t nearest = w[1] > w[0] ? 1 : 0;
        uint32_t beside = corners[w[2] > w[nearest] ? 2 : nearest];
        MesoBirth birth = {p, {0, 0, 0}, beside, r->blocks[beside]};
        for (uint32_t k = 0; k < 3; k++)
            birth.place = meso_vec3_mad(birth.place, (float)(w[k] / all), places[k]);
        MesoStatus status = meso_give_birth(r, triangle, &birth, frame, error);
        if (status != MESO_OK)
            return status;
    }
    return MESO_OK;
}

static uint32_t largest_triangle(const MesoReplication *r, double *area)
{
    uint32_t largest = MESO_NO_INDEX;
    *area = 0;
    for (uint32_t t = 0; t < r->web.triangle_count; t++) {
        const uint32_t *c = r->web.corners + 3 * (size_t)t;
        if (c[0] < r->web.fixed_count || c[1] < r->web.fixed_count || c[2] < r->web.fixed_count)
            continue;
        double a = meso_web_area(&r->web, t);
        if (a > *area) {
            *area = a;
            largest = t;
        }
    }
    return largest;
}

static MesoStatus split_all(MesoReplication *r, int32_t frame, MesoError *error)
{
    for (uint32_t splits = 0; splits < SPLITS_A_STEP; splits++) {
        double area;
        uint32_t largest = largest_triangle(r, &area);
        bool done = true;
        if (largest == MESO_NO_INDEX || !(area > r->options.alpha * r->paper->largest))
            return MESO_OK;
        MesoStatus status = split(r, largest, frame, &done, error);
        if (status != MESO_OK || !done)
            return status;
    }
    return MESO_OK;
}

/* ---- mergings ---- */

static bool is_merging(const MesoReplication *r, uint32_t detail)
{
    for (uint32_t m = 0; m < r->merging_count; m++)
        if (r->mergings[m][0] == detail || r->mergings[m][1] == detail)
            return true;
    return false;
}

/* Of details that do not merge yet. */
static uint32_t smallest_triangle(const MesoReplication *r, double least)
{
    uint32_t smallest = MESO_NO_INDEX;
    for (uint32_t t = 0; t < r->web.triangle_count; t++) {
        const uint32_t *c = r->web.corners + 3 * (size_t)t, fixed = r->web.fixed_count;
        if (c[0] < fixed || c[1] < fixed || c[2] < fixed || !(meso_web_area(&r->web, t) < least)
            || is_merging(r, c[0] - fixed) || is_merging(r, c[1] - fixed) || is_merging(r, c[2] - fixed))
            continue;
        least = meso_web_area(&r->web, t);
        smallest = t;
    }
    return smallest;
}

static MesoStatus select_mergings(MesoReplication *r, MesoError *error)
{
    for (;;) {
        uint32_t t = smallest_triangle(r, r->options.beta * r->paper->smallest);
        if (t == MESO_NO_INDEX)
            return MESO_OK;
        const uint32_t *c = r->web.corners + 3 * (size_t)t;
        uint32_t shortest = 0;
        for (uint32_t k = 1; k < 3; k++)
            if (meso_web_length2(&r->web, c[k], c[(k + 1) % 3])
                < meso_web_length2(&r->web, c[shortest], c[(shortest + 1) % 3]))
                shortest = k;
        uint32_t a = c[shortest] - r->web.fixed_count, b = c[(shortest + 1) % 3] - r->web.fixed_count;
        bool first = r->details[a].rank < r->details[b].rank;
        r->mergings = MESO_GROW(&r->arena, r->mergings, r->merging_count, r->merging_room, 16, error);
        if (!r->mergings)
            return MESO_ERR_MEMORY;
        r->mergings[r->merging_count][0] = first ? a : b;
        r->mergings[r->merging_count++][1] = first ? b : a;
    }
}

static void move_to(MesoReplication *r, uint32_t detail, MesoVec3 place)
{
    uint32_t node = r->web.fixed_count + detail;
    MesoMeshPoint point = meso_point_towards(r->rest, r->now.positions, r->details[detail].point, place);
    r->details[detail].point = r->web.points[node] = point;
    r->web.positions[node] = meso_detail_position(r->rest, r->now.positions, &point);
    r->web.normals[node] = meso_vec3_unit(meso_detail_position(r->rest, r->normals, &point), (MesoVec3){0, 0, 1});
}

/* p0' = gamma (p1 - p0), p1' = -p0', for the time of a step. */
static void attract(MesoReplication *r, uint32_t a, uint32_t b)
{
    const MesoVec3 *places = r->web.positions + r->web.fixed_count;
    float share = (float)fmin(0.5, r->options.gamma * r->passing);
    MesoVec3 way = meso_vec3_scale(meso_vec3_sub(places[b], places[a]), share);
    MesoVec3 to = meso_vec3_sub(places[b], way);
    move_to(r, a, meso_vec3_add(places[a], way));
    move_to(r, b, to);
}

static void attract_all(MesoReplication *r, int32_t frame)
{
    const MesoWeb *web = &r->web;
    uint32_t left = 0;
    for (uint32_t m = 0; m < r->merging_count; m++) {
        uint32_t kept = r->mergings[m][0], given = r->mergings[m][1];
        attract(r, kept, given);
        bool close = meso_web_length2(web, web->fixed_count + kept, web->fixed_count + given)
                     < r->paper->close * r->paper->close;
        if (close && meso_web_remove(&r->web, web->fixed_count + given, web->fixed_count + kept)) {
            r->fates[given] = (MesoDetailFate){frame, kept};
            continue;
        }
        r->mergings[left][0] = kept;
        r->mergings[left++][1] = given;
    }
    r->merging_count = left;
}

MesoStatus meso_paper_step(MesoReplication *r, int32_t frame, MesoError *error)
{
    MesoStatus status = split_all(r, frame, error);
    if (status == MESO_OK)
        status = select_mergings(r, error);
    if (status == MESO_OK)
        attract_all(r, frame);
    return status;
}
