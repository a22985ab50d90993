/*
 * Growth under way. Branches take turns in their order; a turn goes on to the next walk, of a step, a move or a placed
 * shape, and to the end of the rule. What grows is what one turn after the other would give. To have it sooner, the
 * turns of a window of branches are tried together, against what had grown before (growth_try.c); then each in turn is
 * admitted, or done again where what the window has grown by then may have changed it (growth_admit.c). That gives
 * numbers to what they have grown, which is written down together, too (growth_accept.c), with the tries of the next
 * window. Where no rule looks, threads have a batch of each window, which stays theirs from its rules to what it has
 * grown (growth_relay.c): what passes from one to another takes as long as a turn does.
 */
#ifndef MESO_GROWTH_WORK_H
#define MESO_GROWTH_WORK_H

#include "libcore/base/team.h"
#include "libcore/growth/engine/growth.h"
#include "libcore/growth/engine/growth_seat.h"
#include "libcore/growth/space/growth_space.h"

/*
 * Branches that one thread tries at a time. In a relay where nothing that grows is looked at there are more: nothing is
 * done again for that, and threads come less often to memory next to each other's. At most, where one is faster.
 */
enum { MESO_GROWTH_BATCH = 128, MESO_GROWTH_BATCH_UNSEEN = 256, MESO_GROWTH_BATCH_MOST = 416 };

/* Marks of triangles: as a rule many more than there are pieces of a window, so that few triangles share one. */
enum { MESO_GROWTH_MARKS = 1 << 15 };

/* Elements that a step is divided into at most. */
enum { MESO_GROWTH_SPANS = 8 };

/* Sides that a step may cross: where a mesh has no area walks may stand still. */
enum { MESO_GROWTH_CROSSINGS = 1 << 14 };

/* How the curve of a step leaves its way, in radians to the left of that. */
typedef struct MesoGrowthBow {
    float length;               /* of the way; 0: nothing asks for its curve */
    float begin, end;
} MesoGrowthBow;

/* A living branch. */
typedef struct MesoGrowthTip {
    MesoTip at;
    MesoGrowthRun run;
    double state[MESO_STATE_COUNT];
    MesoGrowthFooting foot;     /* of `at`, but for its heading */
    MesoFour arrive;            /* how its last step came; 0 where there was none */
    uint32_t seed, branch, rule;        /* seed: of the grammar; rule: MESO_NO_INDEX before the first */
    uint32_t joint;             /* that its next step begins at; MESO_NO_INDEX: its own */
    uint32_t node, shape;       /* shape: of its last step */
    uint32_t piece;             /* the newest when its last step was admitted: as a rule the step's own last */
    uint32_t walks, faces;      /* of this run of a rule, so far */
    MesoGrowthBow bow;          /* of its last step, where that kept to a condition */
    float lift, roll;           /* at its joint */
    float raise;                /* of its joint, over its lift: so that its last shape is not below the surface */
    bool moved;                 /* away from its node */
    bool open;                  /* the last step did not say its width at its end */
    bool done;                  /* whether the last command could be */
    uint32_t rests_in;          /* the generation, and 1, that its rule is done for; what is older is over */
} MesoGrowthTip;

/* A branch that a turn begins. */
typedef struct MesoGrowthShoot {
    uint32_t entry;
    uint64_t key;
    MesoTip at;                 /* turned, where its parent was */
} MesoGrowthShoot;

typedef enum MesoGrowthOutcome {
    MESO_GROWTH_NOTHING, MESO_GROWTH_STEPS, MESO_GROWTH_JOINS, MESO_GROWTH_MOVES, MESO_GROWTH_PLACES,
    MESO_GROWTH_REFUSED
} MesoGrowthOutcome;

struct MesoGrowthBatch;

enum { MESO_GROWTH_TURN_LINE = 64, MESO_GROWTH_TURN_LINES = 3 };

/* What comes of a turn. */
typedef struct MesoGrowthTurn {
    /* all that is asked when it is admitted, as a rule, in MESO_GROWTH_TURN_LINES lines of memory */
    struct MesoGrowthBatch *batch;      /* that its pieces, registers and shoots lie in */
    double length;              /* of the way */
    uint32_t rule;              /* that it ran; MESO_NO_INDEX: a seed's */
    MesoGrowthOutcome outcome;
    uint32_t shoot_begin, shoot_count;
    uint32_t middle_begin, middle_count;    /* joints between, of a step that is several elements */
    float raise;                /* over the lift at the end */
    float depth;                /* below the surface, as a share of its length, that is left */
    bool shares;                /* `from` is the joint that the branch had */
    bool at_border;
    bool looked;                /* the rule asked for what has grown, within the ball */
    /* numbers of what it has grown: the first of new joints, elements and branches, its own node, and newest piece */
    uint32_t joint_begin, element_begin, branch_begin, node, piece;
    uint32_t piece_begin, piece_count;  /* of the batch's */
    MesoGrowthKin kin;          /* but for `placed` and `end` */
    MesoGrowthCommand command;
    MesoTip end;
    double rest;                /* what of the way lies beyond a border */
    uint32_t try;               /* that was taken: 0, the first */
    float ball[4];              /* center and radius of all that the turn depends on */
    MesoGrowthFooting foot;     /* of `end` */
    MesoFour arrive;
    MesoGrowthSeat from, to;
    float had;                  /* width of the joint that the branch had, where `from` is another in its place */
    float lift, roll;           /* at the end */
    MesoGrowthBow bow;
} MesoGrowthTurn;

static inline bool meso_growth_is_step(const MesoGrowthTurn *turn)
{
    return turn->outcome == MESO_GROWTH_STEPS || turn->outcome == MESO_GROWTH_JOINS;
}

typedef struct MesoGrowthMiddle {
    MesoGrowthSeat joint;
    MesoTip at;
} MesoGrowthMiddle;

typedef struct MesoGrowthLinkedPiece {
    MesoGrowthPiece piece;
    uint32_t next;
} MesoGrowthLinkedPiece;

/* Where turns are tried: lines of memory of a thread's own. */
typedef struct MesoGrowthBatch {
    _Alignas(MESO_GROWTH_TURN_LINE) MesoGrowthPiece *pieces;    /* of turns, each turn's together */
    MesoGrowthLinkedPiece *linked;      /* of walks under way */
    MesoGrowthShoot *shoots;
    double *registers;          /* [shoot_count * local_count] of shoots */
    MesoGrowthMiddle *middles;
    uint32_t middle_count, middle_room;
    uint32_t piece_count, piece_room, linked_count, linked_room, shoot_count, shoot_room, register_room;
    uint32_t first[MESO_GROWTH_BATCH_MOST], last[MESO_GROWTH_BATCH_MOST];     /* linked pieces of each walk */
    MesoWalk walks[MESO_GROWTH_BATCH_MOST];
    uint32_t walkers[MESO_GROWTH_BATCH_MOST];   /* turns that walk */
    uint32_t walker_count;
    uint32_t begin;             /* of its window, of the active tips */
    uint32_t number, drafted, admitted;     /* in a relay: which it is; behind its turns that ran, and are admitted */
    MesoGrowthSeen seen;
    const MesoGrowthSpace *space;       /* NULL: nobody asks where pieces are, or others add some meanwhile */
    uint64_t *runs;             /* [rule_count] of rules, that begin with the next generation */
    bool failed;                /* out of memory */
} MesoGrowthBatch;

/* Turns that are tried together. */
typedef struct MesoGrowthWindow {
    uint32_t begin, count;      /* of the active tips; how many are admitted */
    uint32_t first_branch, first_tip, first_shoot;      /* that it begins */
    MesoGrowthTurn *turns;      /* [as many as its batches have at most] */
    MesoGrowthTip *befores;     /* [window_size] where rules look; before their turns */
    double *register_befores;
    MesoGrowthBatch *batches;   /* [batch_count] and as many again, for what is done again of each */
} MesoGrowthWindow;

typedef struct MesoGrowthWork {
    /* what turns read */
    const MesoGrowthOptions *options;
    const MesoGrammar *grammar;
    const MesoGrowthGround *ground;
    MesoGrowthMarch march;
    bool uses_space;            /* something asks for what has grown */
    bool looks;                 /* a rule does */
    bool clears;                /* a step must be clear of it */
    bool in_relay;              /* turns are admitted while rules of others run */
    uint8_t *ahead;             /* [code_count] of the grammar: see meso_growth_look_ahead(); NULL: nobody asks */
    uint32_t thread_count;
    MesoTeam *team;
    double element_limit, length_limit;
    uint64_t generation;

    MesoGrowthTip *tips;        /* in order */
    uint8_t *ended;             /* [tip_count] whether they have */
    double *registers;          /* [tip_count * local_count] */
    uint32_t tip_room, ended_room, register_room;
    uint32_t *active;           /* tips whose rule goes on */
    uint8_t *goes_on;           /* [active_room] whether it does after this turn */
    uint32_t *shoots;           /* those that have begun since these took their turns; MESO_NO_INDEX: they rest, too */
    uint32_t active_count, active_room, goes_on_room, shoot_room;

    MesoGrowthWindow windows[2];        /* what one has grown is written down while the next is tried */
    uint32_t window_size, batch_count;
    uint32_t relay_batch;               /* turns of a batch in a relay, on the average */
    uint32_t relay_places;              /* batches of a window there: threads that can run at once, at the beginning,
                                           since they wait for each other */
    uint32_t *shares;                   /* [relay_places] turns of each, which are relay_batch on the average */

    /* what has grown */
    MesoJoint *joints;
    MesoMeshPoint *points;
    MesoGrowthElement *elements;
    MesoGrowthBranch *branches;
    MesoGrowthRuleCount *rules;
    uint32_t joint_room, point_room, element_room, branch_room;

    /* what changes when turns are admitted: in other lines of memory, since other threads read those above then */
    _Alignas(MESO_GROWTH_TURN_LINE) uint32_t joint_count;
    uint32_t element_count, branch_count, tip_count, shoot_count;
    double length;
    float depth;
    uint64_t divided, raised;
    bool stops;                 /* at a limit: see `end` */
    MesoGrowthEnd end;
    MesoStatus status;
    MesoError *error;
    uint32_t since;             /* the first piece that the window under way has grown */
    float *balls;               /* [4 * ball_room] of the elements of that: x, y, z, radius in turn */
    uint32_t ball_count, ball_room;
    MesoGrowthSpace space;
    uint64_t grown_in[MESO_GROWTH_MARKS / 64];  /* bits: marks of the triangles that pieces of the window lie in */
} MesoGrowthWork;

/* ---- growth_rounds.c ---- */

/* All of it; what has grown stays in `work`, which is to be released. */
MesoStatus meso_growth_run(MesoGrowthWork *work, const MesoGrowthOptions *options, MesoError *error);
void meso_growth_release(MesoGrowthWork *work);

/* ---- growth_relay.c ---- */

/* A turn of each that is active, by the threads of the team, where no rule looks; false where growth ends with them. */
bool meso_growth_relay(MesoGrowthWork *work);

/* ---- growth_try.c: turns ---- */

/*
 * A batch of a window that begins at one of the active tips: first the rules of turns [begin, end), and where these
 * walk to, some after others; then what comes of all that, which may ask for what has grown. Rules that look ask, too.
 */
void meso_growth_begin_batch(const MesoGrowthWork *work, MesoGrowthBatch *batch, uint32_t window_begin);
void meso_growth_run_rules(MesoGrowthWork *work, MesoGrowthWindow *window, MesoGrowthBatch *batch, uint32_t begin,
                           uint32_t end);
void meso_growth_judge_walks(const MesoGrowthWork *work, MesoGrowthWindow *window, MesoGrowthBatch *batch);

/* The batch for what is done again of a turn. */
static inline MesoGrowthBatch *meso_growth_again(const MesoGrowthWork *work, const MesoGrowthWindow *window,
                                                 const MesoGrowthTurn *turn)
{
    uint32_t number = (uint32_t)(turn->batch - window->batches);
    return &window->batches[number < work->batch_count ? number + work->batch_count : number];
}

/* Again, one alone, from before it, against all that has grown. */
void meso_growth_try_again(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t turn);

/* ---- growth_step.c: walks ---- */

/* What comes of the walk of a turn, which is try number `try`; false where a step may not be, and has another try. */
bool meso_growth_judge(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                       const double *registers, MesoGrowthTurn *turn, const MesoWalk *walk, uint32_t try);

/* The same of a step, alone, from try number `try` on: where what has grown since has made the last one wrong. */
void meso_growth_judge_again(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                             const double *registers, MesoGrowthTurn *turn, uint32_t try);

/* Whether a step that was found good is in the way of what has grown `since`. */
bool meso_growth_collides(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                          const MesoGrowthTurn *turn, uint32_t since);

/* The walk of a turn's command at its tip, with the heading of one of its tries. */
void meso_growth_set_walk(MesoWalk *walk, const MesoGrowthTip *tip, const MesoGrowthTurn *turn, uint32_t try);

/* Adds a ball to that of a turn. */
void meso_growth_depends(MesoGrowthTurn *turn, MesoVec3 center, double radius);

MesoGrowthAsker meso_growth_asker(const MesoGrowthTip *tip, uint32_t since);

/* Collects pieces of walks: of MesoWalkOptions. `context`: the batch. */
void meso_growth_collect(void *context, const MesoWalkPiece *piece);

/* Gives the pieces of walk number `walk` to a turn. */
void meso_growth_keep_pieces(MesoGrowthBatch *batch, MesoGrowthTurn *turn, uint32_t walk);

/* By how much another way is turned from the first. */
double meso_growth_retry_angle(const MesoGrowthTip *tip, const MesoGrowthTurn *turn, uint32_t try);

/* Walks from a tip, alone; pieces go to the turn where there is one. */
void meso_growth_walk(const MesoGrowthWork *work, MesoGrowthBatch *batch, MesoWalk *walk, MesoGrowthTurn *turn);

/* ---- growth_along.c: conditions of steps ---- */

/*
 * Whether the condition of a step holds along its way: at eight places at least, wherever it goes from triangle to
 * triangle, and at each pixel of the images that the condition reads. Where it reads images it must hold along the
 * curve, too, and along that of the step before, whose end this one turns; `bow` of the turn is filled.
 */
bool meso_growth_holds(const MesoGrowthWork *work, MesoGrowthBatch *batch, const MesoGrowthTip *tip,
                       const double *registers, MesoGrowthTurn *turn);

/* ---- growth_host.c: what rules ask ---- */

typedef struct MesoGrowthAsking {
    const MesoGrowthWork *work;
    MesoGrowthBatch *batch;
    const MesoGrowthTip *tip;
    MesoGrowthTurn *turn;
    const MesoTip *at;          /* where is asked */
} MesoGrowthAsking;

/* A look-up of a host whose context this is. */
double meso_growth_look(void *asking, MesoGrowthLook look, uint32_t map, double a, double b);

/* Whether rules of a grammar look for what has grown, and whether any step must be clear of it, or may not cross it. */
bool meso_growth_rules_look(const MesoGrammar *grammar);
bool meso_growth_steps_clear(const MesoGrammar *grammar);
bool meso_growth_steps_avoid(const MesoGrammar *grammar);

/* What code may come to next, before any other command but turns: the end of its rule, a look at something. */
enum { MESO_AHEAD_END = 1, MESO_AHEAD_LOOK = 2 };

/* Sets `ahead` [code_count], which is 0, for every place in the code. */
void meso_growth_look_ahead(const MesoGrammar *grammar, uint8_t *ahead);

/* ---- growth_joints.c ---- */

/* Joints at both ends of what a turn makes. */
void meso_growth_join(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn);

MesoGrowthFooting meso_growth_foot(const MesoGrowthGround *ground, const MesoTip *at);

/* A joint on a straight way over a point. */
MesoGrowthSeat meso_growth_joint_on(const MesoGrowthGround *ground, const MesoTip *at, float width, float lift, float roll);

/* ---- growth_depth.c ---- */

/* Divides a step, or raises a shape, where it would be below the surface. `lift` and `roll` are those at its begin. */
void meso_growth_surface(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn, bool divides,
                         float lift, float roll);

/* ---- growth_admit.c ---- */

/* Before the first turn of a window is admitted: what grows from here on is what the window has grown. */
void meso_growth_begin_window(MesoGrowthWork *work, MesoGrowthWindow *window);

/*
 * Brings turns [begin, end) of the window up to date, one after another, and gives them numbers. Returns `end`, or the
 * number of the turn before which growth stops.
 */
uint32_t meso_growth_admit_range(MesoGrowthWork *work, MesoGrowthWindow *window, uint32_t begin, uint32_t end);

/* After the last: the branches that the window has begun are there. */
void meso_growth_end_window(MesoGrowthWork *work, const MesoGrowthWindow *window);

/*
 * Whether there is room for all that has numbers, and so many turns more, and for the tips of branches that begin; or
 * makes it, and moves arrays for that. False where memory is out.
 */
bool meso_growth_has_rooms(MesoGrowthWork *work, uint32_t turns, uint32_t branches, uint32_t tips);
bool meso_growth_make_rooms(MesoGrowthWork *work, uint32_t turns, uint32_t branches, uint32_t tips);

/* ---- growth_accept.c ---- */

/* Writes down what turns [begin, end) of the window, which are of a batch and admitted, have grown. */
void meso_growth_accept(MesoGrowthWork *work, const MesoGrowthWindow *window, const MesoGrowthBatch *batch,
                        uint32_t begin, uint32_t end);

/* A branch at a place of its own. False where memory is out. */
bool meso_growth_plant(MesoGrowthWork *work, const MesoGrowthStart *start, uint32_t number);

#endif
