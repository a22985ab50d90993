#include <string.h>

#include "libcore/growth/engine/growth_work.h"
#include "libcore/growth/language/grammar_draw.h"

/* Site of the draws of fields that lead anywhere. */
static const uint64_t face_site = 0x6661636500f1e1d5u;

/* ---- rules ---- */

static void tell(const MesoGrowthWork *work, const MesoGrowthTip *tip, const MesoGrowthCommand *command)
{
    if (!work->options->event)
        return;
    MesoGrowthEvent event = {work->branches[tip->branch].key, tip->rule, (uint32_t)tip->state[MESO_STATE_GENERATION],
                             command, tip->at, true};
    work->options->event(work->options->context, &event);
}

static void face(const MesoGrowthWork *work, MesoGrowthTip *tip, const MesoGrowthCommand *command)
{
    uint64_t draw = meso_draw_key(tip->run.key, face_site, tip->faces++);
    meso_growth_face(work->options->contexts, command->field, command->values[MESO_GROWTH_AMOUNT], draw, &tip->at);
}

/* A rule under way. */
typedef struct Running {
    MesoGrowthAsking asking;    /* first: it is what look-ups have as their context */
    MesoTip *at;
} Running;

static void turn_tip(void *context, double angle)
{
    const Running *running = context;
    meso_tip_turn(running->at, angle);
}

/* A branch that begins, with a copy of the registers. */
static void shoot(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                  const double *registers, MesoGrowthTurn *turn)
{
    uint32_t width = work->grammar->local_count;
    uint64_t count = (uint64_t)batch->shoot_count + 1;
    if (!meso_make_room((void **)&batch->shoots, &batch->shoot_room, count, sizeof *batch->shoots) ||
        !meso_make_room((void **)&batch->registers, &batch->register_room, count * width + 1, sizeof *registers)) {
        batch->failed = true;
        return;
    }
    batch->shoots[batch->shoot_count] = (MesoGrowthShoot){turn->command.entry, turn->command.key, tip->at};
    meso_copy_registers(batch->registers + (size_t)batch->shoot_count * width, registers, width);
    batch->shoot_count++;
    turn->shoot_count++;
}

/* Runs a tip's rule to the next walk or its end. */
static void run_rule(const MesoGrowthWork *work, MesoGrowthBatch *batch, MesoGrowthTip *tip, double *stored,
                     MesoGrowthTurn *turn)
{
    double registers[MESO_GRAMMAR_REGISTERS];
    Running running = {{work, batch, tip, turn, &tip->at}, &tip->at};
    const MesoGrowthHost host = {&running, tip->state, meso_growth_look, work->options->event ? NULL : turn_tip};
    MesoGrowthCommand *command = &turn->command;
    meso_copy_registers(registers, stored, work->grammar->local_count);
    turn->rule = tip->rule;
    turn->outcome = MESO_GROWTH_NOTHING;
    turn->looked = turn->at_border = false;
    turn->ball[3] = -1;
    turn->bow.length = 0;
    turn->batch = batch;
    turn->shoot_begin = batch->shoot_count;
    turn->shoot_count = turn->piece_count = 0;
    turn->kin = (MesoGrowthKin){.node = tip->node, .moved = tip->moved, .begin = (float)tip->state[MESO_STATE_LENGTH]};
    for (bool goes_on = true; goes_on && !batch->failed;) {
        meso_growth_resume(command, work->grammar, &tip->run, registers, &host, tip->done);
        tip->done = true;
        if (command->order == MESO_GROWTH_TURN)
            meso_tip_turn(&tip->at, command->values[MESO_GROWTH_AMOUNT]);
        else if (command->order == MESO_GROWTH_FACE)
            face(work, tip, command);
        else if (command->order == MESO_GROWTH_BRANCH)
            shoot(work, batch, tip, registers, turn);
        else
            goes_on = false;
        if (goes_on)
            tell(work, tip, command);
    }
    meso_copy_registers(stored, registers, work->grammar->local_count);
}

static bool walks(const MesoGrowthTurn *turn)
{
    return turn->command.order == MESO_GROWTH_STEP || turn->command.order == MESO_GROWTH_MOVE ||
           turn->command.order == MESO_GROWTH_PLACE;
}

/* ---- turns ---- */

static double *registers_of(const MesoGrowthWork *work, uint32_t tip)
{
    return work->registers + (size_t)tip * work->grammar->local_count;
}

static void join(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn)
{
    if (turn->outcome != MESO_GROWTH_REFUSED && turn->outcome != MESO_GROWTH_NOTHING)
        meso_growth_join(work, tip, turn);
}

/* Pieces of all walks, each walk's together; they are asked for what lies where they are soon. */
static void walk_all(const MesoGrowthWork *work, MesoGrowthBatch *batch, MesoWalk *walks, uint32_t count)
{
    MesoWalkOptions options = {MESO_GROWTH_CROSSINGS, meso_growth_collect, batch};
    batch->linked_count = 0;
    for (uint32_t i = 0; i < count; i++)
        batch->first[i] = batch->last[i] = MESO_NO_INDEX;
    work->march.walk(work->march.context, walks, count, &options);
}

/* Memory of what is read next, of pieces from `first` on, comes while the others are read. */
static void fetch_ahead(const MesoGrowthWork *work, const MesoGrowthBatch *batch, uint32_t count, uint32_t first)
{
    const MesoTriangulation *mesh = work->ground->mesh;
    for (uint32_t i = 0; i < count; i++)
        __builtin_prefetch(&mesh->corners[3 * (size_t)batch->walks[i].tip.triangle]);
    if (work->uses_space)
        meso_growth_cells_fetch(&work->space.cells, batch->pieces + first, batch->piece_count - first);
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t vertex = mesh->corners[3 * (size_t)batch->walks[i].tip.triangle + k];
            __builtin_prefetch(&mesh->positions[vertex]);
            __builtin_prefetch(&work->ground->normals[vertex]);
        }
}

/* Memory of a tip that comes soon. */
static inline void fetch_tip(const MesoGrowthWork *work, uint32_t number)
{
    const char *tip = (const char *)&work->tips[number];
    for (size_t line = 0; line < sizeof(MesoGrowthTip); line += 64)
        __builtin_prefetch(tip + line);
    __builtin_prefetch(registers_of(work, number));
}

/* Rules of turns; those that are about to walk become walkers. */
static void run_rules(MesoGrowthWork *work, MesoGrowthWindow *window, MesoGrowthBatch *batch, uint32_t begin,
                      uint32_t end)
{
    enum { AHEAD = 4 };
    const uint32_t *active = work->active + batch->begin;
    uint32_t count = batch->walker_count;
    for (uint32_t i = begin; i < end; i++) {
        MesoGrowthTurn *turn = &window->turns[i];
        MesoGrowthTip *tip = &work->tips[active[i]];
        fetch_tip(work, active[i + AHEAD < end ? i + AHEAD : i]);
        if (work->looks) {
            window->befores[i] = *tip;
            memcpy(window->register_befores + (size_t)i * work->grammar->local_count, registers_of(work, active[i]),
                   work->grammar->local_count * sizeof(double));
        }
        run_rule(work, batch, tip, registers_of(work, active[i]), turn);
        if (!walks(turn))
            continue;
        meso_growth_set_walk(&batch->walks[count], tip, turn, 0);
        batch->walkers[count++] = i;
        tip->walks++;
        if (batch->space)
            meso_growth_fetch_piece(&work->space.cells, tip->piece);
    }
    batch->walker_count = count;
}

/* Judges the walks; returns how many steps have another try, whose walks come to lie at the front. */
static uint32_t judge_all(const MesoGrowthWork *work, MesoGrowthWindow *window, MesoGrowthBatch *batch, uint32_t count,
                          uint32_t try)
{
    const uint32_t *active = work->active + batch->begin;
    uint32_t left = 0;
    for (uint32_t i = 0; i < count && !batch->failed; i++) {
        uint32_t number = batch->walkers[i], of = active[number];
        MesoGrowthTurn *turn = &window->turns[number];
        const MesoGrowthTip *tip = &work->tips[of];
        if (meso_growth_judge(work, batch, tip, registers_of(work, of), turn, &batch->walks[i], try)) {
            join(work, tip, turn);
        } else {
            batch->walkers[left] = number;
            meso_growth_set_walk(&batch->walks[left++], tip, turn, try + 1);
        }
    }
    return batch->failed ? 0 : left;
}

/* Those from `first` on. */
static void walk_turns(const MesoGrowthWork *work, MesoGrowthWindow *window, MesoGrowthBatch *batch, uint32_t first,
                       uint32_t count)
{
    walk_all(work, batch, batch->walks + first, count);
    for (uint32_t i = 0; i < count; i++)
        meso_growth_keep_pieces(batch, &window->turns[batch->walkers[first + i]], i);
}

void meso_growth_begin_batch(const MesoGrowthWork *work, MesoGrowthBatch *batch, uint32_t window_begin)
{
    MesoGrowthBatch *again = batch + work->batch_count;
    batch->piece_count = batch->shoot_count = batch->middle_count = batch->walker_count = 0;
    again->piece_count = again->shoot_count = again->middle_count = 0;
    batch->space = work->uses_space && !work->in_relay ? &work->space : NULL;
    batch->begin = window_begin;
}

void meso_growth_run_rules(MesoGrowthWork *work, MesoGrowthWindow *window, MesoGrowthBatch *batch, uint32_t begin,
                           uint32_t end)
{
    uint32_t before = batch->walker_count;
    run_rules(work, window, batch, begin, end);
    if (batch->walker_count > before)
        walk_turns(work, window, batch, before, batch->walker_count - before);
}

/* What walks may meet, and what they may begin at. */
static void fetch_space(const MesoGrowthWork *work, const MesoGrowthBatch *batch)
{
    const MesoGrowthCells *cells = &work->space.cells;
    meso_growth_cells_fetch_heads(cells, batch->pieces, batch->piece_count, false);
    for (uint32_t i = 0; i < batch->walker_count; i++)
        meso_growth_fetch_piece(cells, work->tips[work->active[batch->begin + batch->walkers[i]]].piece);
}

void meso_growth_judge_walks(const MesoGrowthWork *work, MesoGrowthWindow *window, MesoGrowthBatch *batch)
{
    if (work->uses_space && !batch->space) {
        batch->space = &work->space;
        fetch_space(work, batch);
    }
    for (uint32_t try = 0, count = batch->walker_count, first = 0; count; try++) {
        if (try > 0) {
            first = batch->piece_count;
            walk_turns(work, window, batch, 0, count);
        }
        fetch_ahead(work, batch, count, first);
        count = judge_all(work, window, batch, count, try);
    }
}

void meso_growth_try_again(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t number)
{
    uint32_t active = work->active[window->begin + number];
    MesoGrowthTurn *turn = &window->turns[number];
    MesoGrowthBatch *batch = meso_growth_again(work, window, turn);
    MesoGrowthTip *tip = &work->tips[active];
    double *registers = registers_of(work, active);
    *tip = window->befores[number];
    memcpy(registers, window->register_befores + (size_t)number * work->grammar->local_count,
           work->grammar->local_count * sizeof *registers);
    run_rule(work, batch, tip, registers, turn);
    if (!walks(turn))
        return;
    MesoWalk walk;
    meso_growth_set_walk(&walk, tip, turn, 0);
    meso_growth_walk(work, batch, &walk, turn);
    tip->walks++;
    if (!meso_growth_judge(work, batch, tip, registers, turn, &walk, 0))
        meso_growth_judge_again(work, batch, tip, registers, turn, 1);
    join(work, tip, turn);
}
