#include "libcore/geodesic/exact/exact_geodesic.h"

#include "libcore/geodesic/exact/event_queue.h"
#include "libcore/geodesic/exact/exact_windows.h"
#include "libcore/geodesic/exact/unfold.h"

enum { DEFAULT_WINDOW_LIMIT = 1 << 25 };

typedef enum EventKind { EVENT_SIDE, EVENT_VERTEX, EVENT_EDGE } EventKind;

/* Of a vertex. */
enum { EMITS = 1, FINAL = 2, REACHED = 4, ON_LINE = 8, INSIDE = 16, NEARER = 32 };

/* As MesoSideShape, and the half-edge across. */
typedef struct Side {
    double length, x, y;
    double due;             /* when windows are next to enter its triangle */
    uint32_t across;        /* in the domain */
    bool sooner;            /* among `changes`, as NEARER of a vertex */
} Side;

/* What is to happen sooner, when the present event is over. */
typedef struct Change {
    uint32_t item;
    EventKind kind;
} Change;

typedef struct Reached {
    uint32_t vertex;
    double before;          /* its distance until then */
} Reached;

typedef struct Solve {
    const MesoTriangulation *mesh;
    const MesoVec3 *positions;
    const MesoExactGeodesicQuery *query;
    double limit;
    Side *sides;            /* [3 * triangle_count] */
    MesoWindowList *lists;  /* [3 * triangle_count] an edge's windows, at its first half-edge */
    uint8_t *flags;         /* [vertex_count] */
    double *starts;         /* [vertex_count] what seeds on lines start with; NULL without them */
    double *distance;
    Reached *reached;       /* [reached_count] */
    uint32_t reached_count;
    MesoExactGeodesicField *field;
    MesoWindowStore store;
    MesoEventQueue queue;
    Change *changes;        /* [change_count] */
    uint32_t change_count, change_room;
    MesoWindow *entering;   /* [entering_count] windows that enter one triangle now */
    uint32_t entering_count, entering_room;
    MesoError *error;
} Solve;

/* ---- the domain, unfolded ---- */

static uint32_t triangle_count(const Solve *solve)
{
    const MesoDomain *domain = solve->query->domain;
    return domain && domain->triangles ? domain->triangle_count : solve->mesh->triangle_count;
}

/* The i-th of the domain; MESO_NO_INDEX where that does not belong to it. */
static uint32_t nth_triangle(const Solve *solve, uint32_t i)
{
    const MesoDomain *domain = solve->query->domain;
    if (domain && domain->triangles)
        return domain->triangles[i];
    return !domain || meso_domain_has(domain, solve->mesh, i) ? i : MESO_NO_INDEX;
}

static bool is_inside(const Solve *solve, uint32_t triangle)
{
    return !solve->query->domain || meso_domain_has(solve->query->domain, solve->mesh, triangle);
}

/* Returns the angle at the half-edge's origin. */
static double measure_side(Solve *solve, uint32_t h)
{
    MesoSideShape shape = meso_side_shape(solve->mesh, solve->positions, h);
    uint32_t twin = solve->mesh->twins[h];
    solve->sides[h] = (Side){shape.length, shape.x, shape.y, INFINITY,
                             twin != MESO_NO_INDEX && is_inside(solve, twin / 3) ? twin : MESO_NO_INDEX, false};
    return atan2(shape.y, shape.x);
}

/*
 * Paths bend at vertices with more than a full turn around them, and at borders. A triangle that has no area says
 * nothing of its angles: its corners become sources too, which is never wrong. `angles` are zero before.
 */
static void measure_domain(Solve *solve, double *angles)
{
    for (uint32_t i = 0; i < triangle_count(solve); i++) {
        uint32_t t = nth_triangle(solve, i);
        for (uint32_t h = 3 * t; t != MESO_NO_INDEX && h < 3 * t + 3; h++) {
            uint32_t vertex = solve->mesh->corners[h], next = solve->mesh->corners[meso_next_corner(h)];
            double angle = measure_side(solve, h);
            angles[vertex] += angle;
            solve->flags[vertex] |= INSIDE;
            if (solve->sides[h].across == MESO_NO_INDEX || !(solve->sides[h].y > 0)) {
                solve->flags[vertex] |= EMITS;
                solve->flags[next] |= EMITS;
            }
            if (!solve->query->keep)
                solve->distance[vertex] = INFINITY;
        }
    }
    /* below this the shadow behind a saddle is narrower than rounding */
    for (uint32_t v = 0; v < solve->mesh->vertex_count; v++)
        if (!(angles[v] <= 2 * MESO_PI + 1e-12))
            solve->flags[v] |= EMITS;
}

/* ---- propagation ---- */

static MesoStatus push_event(Solve *solve, double key, uint32_t item, EventKind kind)
{
    return meso_event_push(&solve->queue, solve->store.arena, (MesoEvent){key, item, kind}, solve->error);
}

static MesoStatus note_change(Solve *solve, uint32_t item, EventKind kind)
{
    solve->changes = MESO_GROW(solve->store.arena, solve->changes, solve->change_count, solve->change_room, 64,
                               solve->error);
    if (!solve->changes)
        return MESO_ERR_MEMORY;
    solve->changes[solve->change_count++] = (Change){item, kind};
    return MESO_OK;
}

/* One event for each, however often it has changed. */
static MesoStatus push_changes(Solve *solve)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < solve->change_count && !status; i++) {
        Change change = solve->changes[i];
        if (change.kind == EVENT_SIDE)
            solve->sides[change.item].sooner = false;
        else
            solve->flags[change.item] &= (uint8_t)~NEARER;
        double key = change.kind == EVENT_SIDE ? solve->sides[change.item].due : solve->distance[change.item];
        status = push_event(solve, key, change.item, change.kind);
    }
    solve->change_count = 0;
    return status;
}

/* Windows are to enter the triangle of a half-edge. */
static MesoStatus wake_side(Solve *solve, uint32_t h, double when)
{
    Side *side = &solve->sides[h];
    if (!(when < side->due))
        return MESO_OK;
    side->due = when;
    if (side->sooner)
        return MESO_OK;
    side->sooner = true;
    return note_change(solve, h, EVENT_SIDE);
}

static MesoStatus reach(Solve *solve, uint32_t vertex, double distance)
{
    /* rounding may take a front that is wide and far from home below zero, where nothing would be an improvement */
    if (distance < 0)
        distance = 0;
    /* an improvement by rounding would start all over */
    if (!(solve->flags[vertex] & INSIDE) || !(distance < solve->distance[vertex] * (1 - 1e-14)) ||
        distance > solve->limit)
        return MESO_OK;
    if (!(solve->flags[vertex] & REACHED))
        solve->reached[solve->reached_count++] = (Reached){vertex, solve->distance[vertex]};
    solve->flags[vertex] |= REACHED;
    solve->distance[vertex] = distance;
    if (solve->flags[vertex] & NEARER)
        return MESO_OK;
    solve->flags[vertex] |= NEARER;
    return note_change(solve, vertex, EVENT_VERTEX);
}

/* Whether paths along the edge from its ends, or just over it, are shorter than all that comes through the window. */
static bool comes_too_late(const Solve *solve, uint32_t edge, const MesoWindow *window, double length)
{
    double d0 = solve->distance[solve->mesh->corners[edge]];
    double d1 = solve->distance[solve->mesh->corners[meso_next_corner(edge)]];
    double least = meso_front_least(&window->front, window->begin, window->end);
    return !(least < 0.5 * (d0 + d1 + length)) || least > solve->limit ||
           d0 + window->end <= meso_front_value(&window->front, window->end) ||
           d1 + length - window->begin <= meso_front_value(&window->front, window->begin);
}

static bool run_alike(const Solve *solve, uint32_t h, uint32_t twin)
{
    return h == twin || solve->mesh->corners[h] == solve->mesh->corners[twin];
}

static MesoStatus cross_triangle(Solve *solve, uint32_t g, const MesoFront *front, double begin, double end);

/* Of a side's length: so near, a source has its rays too close together along the side for windows to part them. */
static const double ON_SIDE = 1e-6;

static bool is_on_side(const MesoFront *front, double length)
{
    return !front->linear && front->y < ON_SIDE * length && front->x > -ON_SIDE * length &&
           front->x < (1 + ON_SIDE) * length;
}

/*
 * Across a side that the source lies on, uncontested. Flat triangles come one behind the other, but a ring of them must
 * have an end.
 */
static MesoStatus skip_side(Solve *solve, uint32_t edge, MesoWindow *window, double length)
{
    if (window->front.skips == UINT8_MAX)
        return MESO_OK;
    window->front.skips++;
    if (!run_alike(solve, edge, window->into))
        meso_window_reverse(window, length);
    return cross_triangle(solve, window->into, &window->front, window->begin, window->end);
}

/* A half-edge is seen from within its own triangle: the other one is to be entered. */
static MesoStatus see_side(Solve *solve, uint32_t h, MesoFront front, double begin, double end)
{
    const Side *side = &solve->sides[h];
    double tiny = 1e-12 * side->length;
    if (side->across == MESO_NO_INDEX || !(end - begin > tiny))
        return MESO_OK;
    uint32_t first = h < side->across ? h : side->across;
    MesoWindow window = {front, begin, end, side->across, true};
    double least;
    if (!run_alike(solve, first, h))
        meso_window_reverse(&window, side->length);
    if (comes_too_late(solve, first, &window, side->length))
        return MESO_OK;
    if (is_on_side(&front, side->length))
        return skip_side(solve, first, &window, side->length);
    MesoStatus status = meso_window_insert(&solve->store, &solve->lists[first], &window, tiny, &least, solve->error);
    return status ? status : wake_side(solve, side->across, least);
}

/* The front in the frame of a half-edge that begins at (ox,oy) in the present one and has direction (ex,ey). */
static MesoFront turn_front(const MesoFront *front, double ox, double oy, double ex, double ey)
{
    MesoFront turned = *front;
    if (front->linear) {
        turned.x = ex * front->x + ey * front->y;
        turned.y = fmax(ey * front->x - ex * front->y, 0);
        turned.sigma += ox * front->x + oy * front->y;
    } else {
        double x = front->x - ox, y = -front->y - oy;
        turned.x = ex * x + ey * y;
        turned.y = fmax(ex * y - ey * x, 0);
    }
    return turned;
}

/* A ray of the front through (t,0): its direction, and how far to its left the third corner lies. */
typedef struct Ray {
    double y, left;
} Ray;

static Ray ray_through(const MesoFront *front, double t, const Side *side)
{
    double x = front->linear ? front->x : t - front->x;
    return (Ray){front->y, x * side->y + front->y * (t - side->x)};
}

/* The part a / (a + b) of a length. */
static double part_of(double a, double b, double length)
{
    double share = a / (a + b);
    return share > 0 ? fmin(share, 1) * length : 0;
}

/*
 * The third corner of a triangle that a front enters between `begin` and `end`: straight where it is in sight, else
 * around the end of the window, which is too far but bounds it.
 */
static MesoStatus reach_corner(Solve *solve, uint32_t g, const MesoFront *front, double begin, double end, Ray first,
                               Ray last)
{
    const Side *side = &solve->sides[g];
    double dx = side->x - front->x, dy = side->y + front->y, distance;
    if (first.left > 0 || last.left < 0) {
        double around = first.left > 0 ? begin : end;
        dx = side->x - around;
        distance = meso_front_value(front, around) + sqrt(dx * dx + side->y * side->y);
    } else if (front->linear) {
        distance = front->sigma + front->x * side->x + front->y * side->y;
    } else {
        distance = front->sigma + sqrt(dx * dx + dy * dy);
    }
    return reach(solve, solve->mesh->corners[meso_previous_corner(g)], distance);
}

/* A front enters the triangle of half-edge g between `begin` and `end`, and leaves by the other two sides. */
static MesoStatus cross_triangle(Solve *solve, uint32_t g, const MesoFront *front, double begin, double end)
{
    uint32_t next = meso_next_corner(g), previous = meso_previous_corner(g);
    const Side *side = &solve->sides[g];
    double length = side->length, right = solve->sides[next].length, left = solve->sides[previous].length;
    Ray first = ray_through(front, begin, side), last = ray_through(front, end, side);
    MesoStatus status = reach_corner(solve, g, front, begin, end, first, last);
    if (!status && last.left > 0 && right > 0) {
        MesoFront turned = turn_front(front, length, 0, (side->x - length) / right, side->y / right);
        status = see_side(solve, next, turned, part_of(last.y * (length - end), last.left, right),
                          first.left > 0 ? part_of(first.y * (length - begin), first.left, right) : right);
    }
    if (!status && first.left < 0 && left > 0) {
        MesoFront turned = turn_front(front, side->x, side->y, -side->x / left, -side->y / left);
        status = see_side(solve, previous, turned, last.left < 0 ? part_of(-last.left, last.y * end, left) : 0,
                          part_of(-first.left, first.y * begin, left));
    }
    return status;
}

/*
 * Of a side's length: windows that are due so soon come along with the first. They may do so too early to know all that
 * is nearer, and some go on in vain; but what is in the caches is used, and there is one event for many windows.
 */
static const double AHEAD = 1;

/* Gathers those of a half-edge's windows that are due; says when the next ones are. */
static MesoStatus gather_entering(Solve *solve, uint32_t h, double until, double *next)
{
    uint32_t edge = solve->sides[h].across < h ? solve->sides[h].across : h;
    MesoWindowList *list = &solve->lists[edge];
    solve->entering_count = 0;
    *next = INFINITY;
    for (uint32_t i = 0; i < list->count; i++) {
        MesoWindow *window = &list->windows[i];
        if (!window->waits || window->into != h)
            continue;
        double least = meso_front_least(&window->front, window->begin, window->end);
        if (least > until) {
            *next = fmin(*next, least);
            continue;
        }
        solve->entering = MESO_GROW(solve->store.arena, solve->entering, solve->entering_count, solve->entering_room,
                                    64, solve->error);
        if (!solve->entering)
            return MESO_ERR_MEMORY;
        window->waits = false;
        solve->entering[solve->entering_count] = *window;
        if (!run_alike(solve, edge, h))
            meso_window_reverse(&solve->entering[solve->entering_count], solve->sides[h].length);
        solve->entering_count++;
    }
    return MESO_OK;
}

/* Windows enter the triangle of a half-edge. */
static MesoStatus enter_triangle(Solve *solve, uint32_t h, double now)
{
    double next;
    if (solve->sides[h].due != now)
        return MESO_OK;
    MesoStatus status = gather_entering(solve, h, now + AHEAD * solve->sides[h].length, &next);
    solve->sides[h].due = INFINITY;
    if (!status)
        status = wake_side(solve, h, next);
    for (uint32_t i = 0; i < solve->entering_count && !status; i++) {
        const MesoWindow *window = &solve->entering[i];
        status = cross_triangle(solve, h, &window->front, window->begin, window->end);
    }
    return status;
}

/*
 * No point of an edge is farther than half its length beyond the mean of its ends: what comes later than that is of no
 * use to it, and its windows are in nobody's way any more.
 */
static MesoStatus retire_edge_later(Solve *solve, uint32_t h)
{
    const uint32_t *corners = solve->mesh->corners;
    const Side *side = &solve->sides[h];
    double key = 0.5 * (solve->distance[corners[h]] + solve->distance[corners[meso_next_corner(h)]] + side->length);
    if (side->across == MESO_NO_INDEX || side->across < h || !(key < INFINITY))
        return MESO_OK;
    return push_event(solve, key, h, EVENT_EDGE);
}

/* From a vertex to the rest of one of its triangles. */
static MesoStatus leave_corner(Solve *solve, uint32_t corner)
{
    const uint32_t *corners = solve->mesh->corners;
    uint32_t next = meso_next_corner(corner), previous = meso_previous_corner(corner), vertex = corners[corner];
    const Side *opposite = &solve->sides[next];
    double distance = solve->distance[vertex];
    MesoStatus status = reach(solve, corners[next], distance + solve->sides[corner].length);
    if (!status)
        status = reach(solve, corners[previous], distance + solve->sides[previous].length);
    if (!status)
        status = retire_edge_later(solve, corner);
    if (!status)
        status = retire_edge_later(solve, previous);
    if (status || !(solve->flags[vertex] & EMITS))
        return status;
    MesoFront front = {opposite->x, opposite->y, distance, false, 0};
    return see_side(solve, next, front, 0, opposite->length);
}

static MesoStatus settle_vertex(Solve *solve, uint32_t vertex)
{
    if (!(solve->flags[vertex] & FINAL))
        solve->field->touched[solve->field->touched_count++] = vertex;
    solve->flags[vertex] |= FINAL;
    if (solve->mesh->vertex_corner[vertex] == MESO_NO_INDEX)
        return MESO_OK;
    MesoFan fan = meso_fan_first(solve->mesh, vertex);
    uint32_t first = fan.corner;
    MesoStatus status = MESO_OK;
    do {
        if (is_inside(solve, fan.corner / 3))
            status = leave_corner(solve, fan.corner);
    } while (!status && meso_fan_next(solve->mesh, &fan) && fan.corner != first);
    return status;
}

static MesoStatus run_events(Solve *solve)
{
    MesoStatus status = push_changes(solve);
    while (!status && solve->queue.count > 0) {
        MesoEvent event = meso_event_pop(&solve->queue);
        if (event.kind == EVENT_SIDE) {
            status = enter_triangle(solve, event.item, event.key);
        } else if (event.kind == EVENT_EDGE) {
            meso_window_clear(&solve->store, &solve->lists[event.item]);
        } else if (event.key == solve->distance[event.item]) {
            status = settle_vertex(solve, event.item);
            if (event.item == solve->query->target)
                break;
        }
        if (!status)
            status = push_changes(solve);
    }
    return status;
}

/* ---- seeds ---- */

static MesoStatus start_vertices(Solve *solve)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < solve->query->seed_count && !status; i++) {
        const MesoExactGeodesicSeed *seed = &solve->query->seeds[i];
        solve->flags[seed->vertex] |= EMITS;
        if (seed->line) {
            double *start = &solve->starts[seed->vertex];
            *start = solve->flags[seed->vertex] & ON_LINE ? fmin(*start, seed->distance) : seed->distance;
            solve->flags[seed->vertex] |= ON_LINE;
        }
        status = reach(solve, seed->vertex, seed->distance);
    }
    return status;
}

static bool is_all_line(const Solve *solve, uint32_t triangle)
{
    const uint32_t *corners = &solve->mesh->corners[3 * (size_t)triangle];
    return solve->flags[corners[0]] & solve->flags[corners[1]] & solve->flags[corners[2]] & ON_LINE;
}

static bool is_line(const Solve *solve, uint32_t h)
{
    const MesoTriangulation *mesh = solve->mesh;
    uint32_t ends[2] = {mesh->corners[h], mesh->corners[meso_next_corner(h)]}, across = solve->sides[h].across;
    if (!(solve->flags[ends[0]] & solve->flags[ends[1]] & ON_LINE))
        return false;
    return meso_side_is_wall(mesh, h) ||
           (!is_all_line(solve, h / 3) && (across == MESO_NO_INDEX || !is_all_line(solve, across / 3)));
}

/* The front of a half-edge on a line, into its own triangle. Its window only keeps others away from the edge. */
static MesoStatus start_line(Solve *solve, uint32_t h)
{
    const uint32_t *corners = solve->mesh->corners;
    const Side *side = &solve->sides[h];
    double begin = solve->starts[corners[h]], end = solve->starts[corners[meso_next_corner(h)]];
    double slope = (end - begin) / side->length;
    if (!(fabs(slope) <= 1))    /* one end is the source of the other */
        return MESO_OK;
    MesoFront front = {slope, sqrt((1 - slope) * (1 + slope)), begin, true, 0};
    MesoStatus status = cross_triangle(solve, h, &front, 0, side->length);
    if (status || side->across < h || side->across == MESO_NO_INDEX)
        return status;
    MesoWindow window = {front, 0, side->length, h, false};
    double least;
    return meso_window_insert(&solve->store, &solve->lists[h], &window, 1e-12 * side->length, &least, solve->error);
}

static MesoStatus start_lines(Solve *solve)
{
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < triangle_count(solve); i++) {
        uint32_t t = nth_triangle(solve, i);
        for (uint32_t h = 3 * t; t != MESO_NO_INDEX && h < 3 * t + 3 && !status; h++)
            if (is_line(solve, h))
                status = start_line(solve, h);
    }
    return status;
}

/* A point sees the three sides of its triangle; on a side, it sees the triangle across just as well. */
static MesoStatus start_point(Solve *solve, const MesoExactGeodesicPoint *point)
{
    uint32_t first = 3 * point->at.triangle;
    MesoStatus status = MESO_OK;
    for (uint32_t k = 0; k < 3 && !status; k++) {
        const Side *side = &solve->sides[first + k];
        double w1 = point->at.weight[(k + 1) % 3], w2 = point->at.weight[(k + 2) % 3];
        MesoFront front = {w1 * side->length + w2 * side->x, w2 * side->y, point->distance, false, 0};
        uint32_t vertex = solve->mesh->corners[first + k];
        if (!(w1 > ON_SIDE) || !(w2 > ON_SIDE))
            solve->flags[vertex] |= EMITS;
        status = reach(solve, vertex, point->distance + sqrt(front.x * front.x + front.y * front.y));
        if (!status)
            status = see_side(solve, first + k, front, 0, side->length);
    }
    return status;
}

static MesoStatus start(Solve *solve)
{
    MesoStatus status = start_vertices(solve);
    if (!status && solve->starts)
        status = start_lines(solve);
    for (uint32_t i = 0; i < solve->query->point_count && !status; i++)
        status = start_point(solve, &solve->query->points[i]);
    return status;
}

/* ---- the solver ---- */

/* What was not final when the search ended has the distance it had before. */
static void forget_bounds(Solve *solve)
{
    for (uint32_t i = 0; i < solve->reached_count; i++)
        if (!(solve->flags[solve->reached[i].vertex] & FINAL))
            solve->distance[solve->reached[i].vertex] = solve->reached[i].before;
}

static bool has_lines(const MesoExactGeodesicQuery *query)
{
    for (uint32_t i = 0; i < query->seed_count; i++)
        if (query->seeds[i].line)
            return true;
    return false;
}

static MesoStatus solve_in(Solve *solve, MesoArena *arena)
{
    uint32_t vertex_count = solve->mesh->vertex_count;
    size_t side_count = 3 * (size_t)solve->mesh->triangle_count;
    double *angles = MESO_NEW(arena, double, vertex_count, solve->error);
    solve->sides = MESO_NEW(arena, Side, side_count, solve->error);
    solve->lists = MESO_NEW(arena, MesoWindowList, side_count, solve->error);
    solve->flags = MESO_NEW(arena, uint8_t, vertex_count, solve->error);
    solve->reached = MESO_NEW(arena, Reached, vertex_count, solve->error);
    if (has_lines(solve->query))
        solve->starts = MESO_NEW(arena, double, vertex_count, solve->error);
    if (!angles || !solve->sides || !solve->lists || !solve->flags || !solve->reached ||
        (has_lines(solve->query) && !solve->starts))
        return MESO_ERR_MEMORY;
    measure_domain(solve, angles);
    MesoStatus status = start(solve);
    if (!status)
        status = run_events(solve);
    if (!status)
        forget_bounds(solve);
    return status;
}

MesoStatus meso_exact_geodesic(const MesoTriangulation *mesh, const MesoVec3 *positions,
                               const MesoExactGeodesicQuery *query, MesoArena *arena, double *distance,
                               MesoExactGeodesicField *field, MesoError *error)
{
    *field = (MesoExactGeodesicField){.touched = MESO_NEW(arena, uint32_t, mesh->vertex_count, error)};
    if (!field->touched)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < mesh->vertex_count && !query->domain && !query->keep; v++)
        distance[v] = INFINITY;
    Solve solve = {
        .mesh = mesh, .positions = positions ? positions : mesh->positions, .query = query,
        .limit = query->limit > 0 ? query->limit : INFINITY, .distance = distance, .field = field, .error = error,
        .store = {.arena = arena, .limit = query->window_limit ? query->window_limit : DEFAULT_WINDOW_LIMIT},
    };
    MesoArenaMark mark = meso_arena_mark(arena);
    MesoStatus status = solve_in(&solve, arena);
    field->window_count = solve.store.made;
    field->window_peak = solve.store.peak;
    meso_arena_rewind(arena, mark);
    return status;
}
