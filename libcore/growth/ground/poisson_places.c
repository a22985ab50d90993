/*
 * Darts that keep a distance, measured along the surface, until none fits any more. The surface is cut into cells, as
 * large as the distance at most, that are met in a random order; a cell whose dart does not fit and that is not covered
 * is cut into four ("A Simple Algorithm for Maximal Poisson-Disk Sampling in High Dimensions", Ebeida et al. 2012, cuts
 * all of them at once, and has straight distances). What a dart sees of a triangle is kept with the cells there.
 */
#include <stdlib.h>

#include "libcore/growth/ground/dart_sight.h"
#include "libcore/growth/ground/seed_places.h"

enum {
    NO_LINK = 0,
    DEPTH_LIMIT = 23,       /* up to here floats tell corners apart */
    CELL_LIMIT = 1 << 25,
    DART_LIMIT = 1 << 24    /* about, of a distance that does not vary */
};

/* Of the distance: uncovered cells smaller than this are left. */
static const double LEFT_OVER = 1.0 / 1024;

/* Of the surface's extent: so finely is it looked at where the distance varies, and for where there is one. */
static const double FINENESS = 1.0 / 128;

/* A part of a triangle. */
typedef struct Cell {
    float weights[3][2];    /* of its corners: those of the triangle's second and third corner */
    uint32_t triangle;
    uint32_t children;      /* the first of those that are not covered; 0: none */
    uint32_t views;         /* the first link */
    uint8_t depth, child_count;
    bool done;              /* covered */
    float size;             /* how far its corners are from its middle at most */
    float radius;           /* at its middle */
    uint64_t hash;
} Cell;

/* A view that some of a cell is reached by. */
typedef struct Link {
    uint32_t view, next;
} Link;

typedef struct Seen {
    MesoDartView view;
    double radius;          /* of the dart */
} Seen;

typedef struct Turn {
    double key;
    uint64_t hash;
    uint32_t cell;
} Turn;

typedef struct Board {
    MesoSeedWork *work;
    const MesoTriangulation *mesh;
    const MesoWalkGround *ground;
    const MesoGrammarValue *radius;
    bool varies;
    MesoDartSight sight;
    MesoArena *arena;
    Cell *cells;            /* [cell_count] the triangles come first */
    Link *links;
    Seen *seen;
    Turn *turns, *next;     /* of this round, and of the one to come */
    uint32_t cell_count, cell_room, link_count, link_room, seen_count, seen_room, turn_count, turn_room, next_count,
        next_room;
    double dart_radius, dart_reach;
    MesoStatus status;      /* of views on their way */
} Board;

/* ---- cells ---- */

static void cell_weights(const Cell *cell, double s, double t, double weight[3])
{
    double r = 1 - s - t;
    weight[1] = r * (double)cell->weights[0][0] + s * (double)cell->weights[1][0] + t * (double)cell->weights[2][0];
    weight[2] = r * (double)cell->weights[0][1] + s * (double)cell->weights[1][1] + t * (double)cell->weights[2][1];
    weight[0] = 1 - weight[1] - weight[2];
    weight[0] = weight[0] > 0 ? weight[0] : 0;
}

/* Weights of its middle as views want them. */
static double middle_of(const Cell *cell, uint32_t c)
{
    return ((double)cell->weights[0][c] + (double)cell->weights[1][c] + (double)cell->weights[2][c]) / 3;
}

static double size_of(const Board *board, const Cell *cell)
{
    MesoComplex corners[3], all[4];
    double size = 0;
    meso_walk_corners(board->ground, cell->triangle, corners);
    for (uint32_t k = 0; k < 4; k++) {
        double weight[3];
        cell_weights(cell, k == 3 ? 1.0 / 3 : k == 1, k == 3 ? 1.0 / 3 : k == 2, weight);
        all[k] = meso_walk_point(corners, weight);
    }
    for (uint32_t k = 0; k < 3; k++)
        size = fmax(size, hypot(all[k].re - all[3].re, all[k].im - all[3].im));
    return size;
}

/* Of the extent, too: a distance that varies and is smaller is none, for it may go down to 0. */
static const double LEAST = 1.0 / 4096;

/* The distance at a point; 0: no seeds there. Where it is no number the status says so. */
static double radius_at(Board *board, uint32_t triangle, const double weight[3], uint64_t draw)
{
    MesoSurfacePlace at = {triangle, {weight[0], weight[1], weight[2]}};
    double radius = board->varies ? meso_place_number(board->work, board->radius, &at, draw) : board->radius->number;
    if (!isfinite(radius) && !board->status)
        board->status = meso_place_fault(board->work, board->radius, "the radius");
    return !board->varies || radius > LEAST * board->work->contexts->ground->extent ? radius : 0;
}

static MesoStatus find_radius(Board *board, Cell *cell)
{
    double middle[3];
    cell_weights(cell, 1.0 / 3, 1.0 / 3, middle);
    cell->radius = (float)radius_at(board, cell->triangle, middle, cell->hash);
    return board->status;
}

static MesoStatus fail_too_many(const Board *board)
{
    return meso_fail(board->work->error, MESO_ERR_LIMIT, "the radius of 'poisson' is too small for so much surface");
}

static MesoStatus add_cell(Board *board, const Cell *cell)
{
    if (board->cell_count >= CELL_LIMIT)
        return fail_too_many(board);
    board->cells = MESO_GROW(board->arena, board->cells, board->cell_count, board->cell_room, 1024, board->work->error);
    if (!board->cells)
        return MESO_ERR_MEMORY;
    board->cells[board->cell_count++] = *cell;
    return MESO_OK;
}

/* One of four. */
static Cell part_of(const Cell *cell, uint32_t part)
{
    static const float at[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5f, 0}, {0.5f, 0.5f}, {0, 0.5f}};
    static const uint8_t parts[4][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {4, 5, 3}};
    Cell out = {.triangle = cell->triangle, .depth = (uint8_t)(cell->depth + 1), .size = 0.5f * cell->size,
                .hash = meso_draw_mix(cell->hash + part + 1)};
    for (uint32_t k = 0; k < 3; k++) {
        const float *w = at[parts[part][k]];
        for (uint32_t c = 0; c < 2; c++)
            out.weights[k][c] = (1 - w[0] - w[1]) * cell->weights[0][c] + w[0] * cell->weights[1][c] +
                                w[1] * cell->weights[2][c];
    }
    return out;
}

/* ---- views ---- */

static MesoStatus link_view(Board *board, Cell *cell, uint32_t view)
{
    board->links = MESO_GROW(board->arena, board->links, board->link_count, board->link_room, 1024, board->work->error);
    if (!board->links)
        return MESO_ERR_MEMORY;
    board->links[board->link_count] = (Link){view, cell->views};
    cell->views = board->link_count++;
    return MESO_OK;
}

static void cover(Board *board, Cell *cell)
{
    cell->done = true;
    for (uint32_t i = 0; i < cell->child_count; i++)
        cover(board, &board->cells[cell->children + i]);
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

typedef enum Meeting { MEETING_NONE, MEETING_SOME, MEETING_COVERS } Meeting;

static Meeting meet(const Board *board, const Cell *cell, const Seen *seen)
{
    double distance = meso_dart_distance(&seen->view, middle_of(cell, 0), middle_of(cell, 1));
    double size = (double)cell->size;
    if (distance + size < larger(seen->radius, (double)cell->radius))
        return MEETING_COVERS;
    return distance - size > (board->varies ? 2 : 1) * seen->radius ? MEETING_NONE : MEETING_SOME;
}

/* Gives a view to a cell, or to those that it was cut into. */
static MesoStatus give_view(Board *board, Cell *cell, uint32_t number)
{
    Meeting meeting = cell->done ? MEETING_NONE : meet(board, cell, &board->seen[number]);
    if (meeting == MEETING_COVERS)
        cover(board, cell);
    if (meeting != MEETING_SOME)
        return MESO_OK;
    if (!cell->child_count)
        return link_view(board, cell, number);
    bool done = true;
    MesoStatus status = MESO_OK;
    for (uint32_t i = 0; i < cell->child_count && !status; i++) {
        Cell *child = &board->cells[cell->children + i];
        status = give_view(board, child, number);
        done &= child->done;
    }
    cell->done = done;
    return status;
}

static void take_view(void *context, const MesoDartView *view)
{
    Board *board = context;
    Cell *root = &board->cells[view->triangle];
    if (board->status || root->done)
        return;
    board->seen = MESO_GROW(board->arena, board->seen, board->seen_count, board->seen_room, 1024, board->work->error);
    if (!board->seen) {
        board->status = MESO_ERR_MEMORY;
        return;
    }
    uint32_t link_count = board->link_count;
    board->seen[board->seen_count] = (Seen){*view, board->dart_radius};
    board->status = give_view(board, root, board->seen_count);
    board->seen_count += board->link_count > link_count;
}

/* ---- darts ---- */

static bool fits(const Board *board, const Cell *cell, const double weight[3], double radius)
{
    for (uint32_t l = cell->views; l != NO_LINK; l = board->links[l].next) {
        const Seen *seen = &board->seen[board->links[l].view];
        if (meso_dart_distance(&seen->view, weight[1], weight[2]) < larger(radius, seen->radius))
            return false;
    }
    return true;
}

static MesoStatus throw_dart(Board *board, uint32_t index)
{
    const Cell *cell = &board->cells[index];
    double s = meso_draw_share(meso_draw_key(board->work->job, cell->hash, 1));
    double t = meso_draw_share(meso_draw_key(board->work->job, cell->hash, 2)), weight[3];
    cell_weights(cell, s + t > 1 ? 1 - s : s, s + t > 1 ? 1 - t : t, weight);
    double radius = radius_at(board, cell->triangle, weight, cell->hash);
    if (board->status || !(radius > 0) || !fits(board, cell, weight, radius))
        return board->status;
    MesoSurfacePlace at = {cell->triangle, {weight[0], weight[1], weight[2]}};
    board->dart_radius = radius;
    MesoStatus status = meso_place_add(board->work, &at, cell->hash);
    if (!status)
        status = meso_dart_look(&board->sight, &at, board->varies ? 2 * radius : radius, take_view, board,
                                board->work->error);
    return status ? status : board->status;
}

/* ---- rounds ---- */

static MesoStatus queue_cell(Board *board, uint32_t index)
{
    board->next = MESO_GROW(board->arena, board->next, board->next_count, board->next_room, 1024, board->work->error);
    if (!board->next)
        return MESO_ERR_MEMORY;
    const Cell *cell = &board->cells[index];
    /* first come those that an even rain would hit first */
    double radius = (double)cell->radius;
    double area = meso_place_area(board->mesh, cell->triangle) * ldexp(1, -2 * cell->depth) / (radius * radius);
    double share = meso_draw_share(meso_draw_key(board->work->job, cell->hash, 0));
    board->next[board->next_count++] = (Turn){-log(1 - share) / area, cell->hash, index};
    return MESO_OK;
}

/* Cells in which nothing can be, and those that are as small as is told apart, are let go. */
static bool is_over(const Board *board, const Cell *cell)
{
    double least = cell->radius > 0 ? LEFT_OVER * (double)cell->radius
                                    : FINENESS * board->work->contexts->ground->extent;
    return cell->done || cell->depth >= DEPTH_LIMIT || (double)cell->size <= least;
}

/* A part of a cell with what it has of the cell's views; covered ones are not kept. */
static MesoStatus add_part(Board *board, uint32_t index, uint32_t part)
{
    Cell cell = part_of(&board->cells[index], part);
    MesoStatus status = find_radius(board, &cell);
    for (uint32_t l = board->cells[index].views; l != NO_LINK && !status; l = board->links[l].next) {
        uint32_t view = board->links[l].view;
        Meeting meeting = meet(board, &cell, &board->seen[view]);
        if (meeting == MEETING_COVERS)
            return MESO_OK;
        if (meeting == MEETING_SOME)
            status = link_view(board, &cell, view);
        if (status)     /* and perhaps no link is left */
            return status;
    }
    if (!status && !is_over(board, &cell))
        status = add_cell(board, &cell);
    return status;
}

/* Cuts a cell into the parts that are not covered. */
static MesoStatus cut(Board *board, uint32_t index)
{
    uint32_t children = board->cell_count;
    MesoStatus status = MESO_OK;
    for (uint32_t part = 0; part < 4 && !status; part++)
        status = add_part(board, index, part);
    if (status)     /* and perhaps no cell is left */
        return status;
    Cell *cell = &board->cells[index];
    cell->children = children;
    cell->child_count = (uint8_t)(board->cell_count - children);
    cell->done |= cell->child_count == 0;
    return MESO_OK;
}

static MesoStatus pass_on(Board *board, uint32_t index)
{
    MesoStatus status = cut(board, index);
    if (status)
        return status;
    uint32_t children = board->cells[index].children, count = board->cells[index].child_count;
    for (uint32_t i = 0; i < count && !status; i++)
        status = queue_cell(board, children + i);
    return status;
}

static MesoStatus take_turn(Board *board, uint32_t index)
{
    if (board->cells[index].done)
        return MESO_OK;
    MesoStatus status = throw_dart(board, index);
    if (status || is_over(board, &board->cells[index]))
        return status;
    return pass_on(board, index);
}

static int compare_turns(const void *a, const void *b)
{
    const Turn *x = a, *y = b;
    if (x->key != y->key)
        return x->key < y->key ? -1 : 1;
    return x->hash != y->hash ? (x->hash < y->hash ? -1 : 1) : (x->cell > y->cell) - (x->cell < y->cell);
}

static MesoStatus run_rounds(Board *board)
{
    MesoStatus status = MESO_OK;
    while (board->next_count > 0 && !status) {
        Turn *turns = board->turns;
        uint32_t room = board->turn_room;
        board->turns = board->next;
        board->turn_count = board->next_count;
        board->turn_room = board->next_room;
        board->next = turns;
        board->next_room = room;
        board->next_count = 0;
        qsort(board->turns, board->turn_count, sizeof *board->turns, compare_turns);
        for (uint32_t i = 0; i < board->turn_count && !status; i++)
            status = take_turn(board, board->turns[i].cell);
    }
    return status;
}

/* ---- beginning ---- */

/* Where the radius varies, cells that are small beside the surface do not miss where it is small. */
static bool is_too_large(const Board *board, const Cell *cell)
{
    double size = (double)cell->size;
    bool coarse = board->varies && size > FINENESS * board->work->contexts->ground->extent;
    return cell->depth < DEPTH_LIMIT && (coarse || (cell->radius > 0 && size > (double)cell->radius));
}

static MesoStatus begin_cell(Board *board, uint32_t index)
{
    if (board->cells[index].done)
        return MESO_OK;
    if (!is_too_large(board, &board->cells[index]))
        return is_over(board, &board->cells[index]) ? MESO_OK : queue_cell(board, index);
    MesoStatus status = cut(board, index);
    if (status)
        return status;
    uint32_t children = board->cells[index].children, count = board->cells[index].child_count;
    for (uint32_t i = 0; i < count && !status; i++)
        status = begin_cell(board, children + i);
    return status;
}

/* Discs of half the radius cover some 0.55 of the surface. */
static MesoStatus check_count(const Board *board)
{
    double area = 0, radius = board->radius->number;
    for (uint32_t t = 0; t < board->mesh->triangle_count && !board->varies; t++)
        area += meso_place_area(board->mesh, t);
    return 0.7 * area > DART_LIMIT * radius * radius ? fail_too_many(board) : MESO_OK;
}

static MesoStatus begin_triangles(Board *board)
{
    MesoStatus status = check_count(board);
    for (uint32_t t = 0; t < board->mesh->triangle_count && !status; t++) {
        uint32_t order[3];
        Cell root = {.triangle = t, .hash = meso_place_triangle(board->mesh, t, order)};
        for (uint32_t k = 0; k < 3; k++)
            if (order[k] > 0)
                root.weights[k][order[k] - 1] = 1;
        root.size = (float)size_of(board, &root);
        status = find_radius(board, &root);
        root.done = !(meso_place_area(board->mesh, t) > 0);
        if (!status)
            status = add_cell(board, &root);
    }
    for (uint32_t t = 0; t < board->mesh->triangle_count && !status; t++)
        status = begin_cell(board, t);
    return status;
}

MesoStatus meso_places_poisson(MesoSeedWork *work)
{
    const MesoGrammarValue *radius = &work->seed->places.values[0];
    Board board = {.work = work, .mesh = work->contexts->ground->mesh, .ground = &work->contexts->ground->walk,
                   .radius = radius, .varies = radius->index != MESO_NO_INDEX, .link_count = 1};
    MesoArena arena;
    if (!board.varies && !(radius->number > 0 && isfinite(radius->number)))
        return meso_fail(work->error, MESO_ERR_INPUT, "line %u: the radius of 'poisson' is not above 0",
                         work->grammar->lines[work->seed->entry]);
    meso_arena_init(&arena);
    board.arena = &arena;
    board.links = meso_arena_enlarge(&arena, NULL, 0, board.link_room = 1024, sizeof *board.links, work->error);
    MesoStatus status = board.links ? meso_dart_sight_init(&board.sight, &arena, board.mesh, board.ground,
                                                           work->thread_count, work->error) : MESO_ERR_MEMORY;
    if (!status)
        status = begin_triangles(&board);
    if (!status)
        status = run_rounds(&board);
    meso_dart_sight_release(&board.sight);
    meso_arena_release(&arena);
    return status;
}
