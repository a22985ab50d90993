/*
 * Growth: branches that run the rules of a grammar and walk over a surface, round by round. In a round each branch
 * runs one rule. Steps are proposed by all branches at once against what earlier rounds have grown, and accepted in
 * the order of generation and branch against what this round has: the result is the same for any number of threads.
 * ("Dynamic On-Mesh Procedural Generation Control", Buron, Marvie, Guennebaud and Granier 2014, grows in textures and
 * without collisions.)
 */
#ifndef MESO_GROWTH_H
#define MESO_GROWTH_H

#include "libcore/growth/ground/growth_seeds.h"
#include "libcore/growth/shape/bend.h"

/* How steps go over the surface: meso_walks(), or another way with the same promises. */
typedef struct MesoGrowthMarch {
    void (*walk)(const void *context, MesoWalk *walks, uint32_t count, const MesoWalkOptions *options);
    const void *context;
} MesoGrowthMarch;

/* A line of a trace: what was done by a branch. Told in the order in which it is accepted. */
typedef struct MesoGrowthEvent {
    uint64_t key;               /* of the branch */
    uint32_t rule, generation;
    const MesoGrowthCommand *command;
    MesoTip tip;                /* after it */
    bool accepted;
} MesoGrowthEvent;

typedef struct MesoGrowthOptions {
    const MesoGrammar *grammar;
    const MesoGrowthContexts *contexts;
    const MesoGrowthStarts *starts;
    const MesoGrowthMarch *march;       /* NULL: straight on over the mesh */
    uint32_t thread_count;              /* 0: all cores */
    double generations, elements, length;   /* limits beside the grammar's; 0: none */
    void (*event)(void *context, const MesoGrowthEvent *event);     /* may be NULL */
    bool (*progress)(void *context, uint32_t generation, uint64_t element_count);   /* may be NULL; false ends it */
    void *context;
} MesoGrowthOptions;

/* A shape from joint to joint, of a step or a place. */
typedef struct MesoGrowthElement {
    MesoSpan span;
    uint32_t shape;             /* of the grammar; MESO_NO_INDEX: a step without one */
    uint32_t branch;
    uint32_t rule, generation;
    float tint;
    float length;               /* of the branch's way from its seed, at the end of this */
} MesoGrowthElement;

typedef struct MesoGrowthBranch {
    uint64_t key;
    uint32_t parent;            /* MESO_NO_INDEX: it comes from a seed */
    uint32_t seed;              /* of the grammar */
    uint32_t element_begin;     /* its first element, or MESO_NO_INDEX; elements of a branch need not lie together */
} MesoGrowthBranch;

typedef enum MesoGrowthEnd {
    MESO_GROWTH_ALL_DONE, MESO_GROWTH_GENERATIONS, MESO_GROWTH_ELEMENTS, MESO_GROWTH_LENGTH, MESO_GROWTH_STOPPED
} MesoGrowthEnd;

typedef struct MesoGrowthRuleCount {
    uint64_t runs, steps, refused, placed, branches, at_borders;
} MesoGrowthRuleCount;

/* What has grown. */
typedef struct MesoGrown {
    uint32_t joint_count, element_count, branch_count;
    MesoJoint *joints;                  /* [joint_count] */
    MesoMeshPoint *points;              /* [joint_count] of the surface below each */
    MesoGrowthElement *elements;        /* [element_count] in the order of growth */
    MesoGrowthBranch *branches;         /* [branch_count] */
    MesoGrowthRuleCount *rules;         /* [rule_count] */
    uint32_t generation_count;
    double length;                      /* of all steps */
    MesoGrowthEnd end;
    uint64_t divided;                   /* steps that are several elements, since one would be below the surface */
    uint64_t raised;                    /* elements that are raised for that */
    float depth;                        /* of the deepest axis below the surface, as a share of its element's length */
} MesoGrown;

/*
 * Grows: what one branch after another would, each taking turns to its next step, move or placed shape, in the order of
 * their ages, until the rules of a generation are done. So look-ups, too, see all that older branches have grown.
 *
 * A step crosses nothing that has grown, but what begins or ends where it begins, there; and keeps `clear` from it, in
 * space, as far as the surface is joined to it within that distance: but for kin, which is nearer than four times that
 * along the strands and branchings. Placed shapes may be crossed. In rules, clear() sees all of them, kin or not, and
 * of strands what is not kin. A step that is refused is tried at other angles, in the order of draws of its branch; one
 * that joins ends at the first strand on its way, within `clear` behind its length.
 *
 * The length of a step that turns is its chord's. Joints of consecutive steps of a branch are the same joint, and so
 * meet in the same floats, but where a step's width differs from the one that the last has said to end with, or from
 * another shape's; then they are two in one place. A branch's first step begins at a joint of its own. Lift and roll
 * are those at the end of a step. Where an axis would be below the surface a tube's or a section's step becomes several
 * elements, as long as these are not too short for their width, and joints are raised. A placed shape is as wide as it
 * is long where nothing else is said, follows the surface, and goes on straight beyond a border. What has grown until a
 * limit is told by `end`, and is whole.
 *
 * MESO_ERR_INPUT where a value is no number, by line; MESO_ERR_MEMORY. O(elements * pieces that are near).
 */
MesoStatus meso_grow(MesoGrown *grown, MesoArena *arena, const MesoGrowthOptions *options, MesoError *error);

/*
 * Raises joints until no element's axis lies below the surface by more than a hundredth of its length, by what some
 * points of each tell: steps whose curves the next step has changed, tilted shapes, and such beyond corners, too. What
 * touches stays together. A surface that is nearer than an element is long, but far along the surface, is not seen.
 * The same for any number of threads. O(elements * triangles that they go over). MESO_ERR_MEMORY alone.
 */
MesoStatus meso_growth_lift(MesoGrown *grown, MesoArena *scratch, const MesoGrowthGround *ground,
                            uint32_t thread_count, MesoError *error);

#endif
