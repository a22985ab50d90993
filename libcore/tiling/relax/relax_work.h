/* What the steps of a relaxation share. */
#ifndef MESO_RELAX_WORK_H
#define MESO_RELAX_WORK_H

#include "libcore/shell/hexahedra.h"
#include "libcore/tiling/strand/strand_port.h"

/* How far a joint may go, in widths and heights of its wall; and the tangent of the angle that it may lean over. */
#define MESO_RELAX_REACH 0.25f
#define MESO_RELAX_LEAN 1.5f

enum { MESO_RELAX_CHORDS = 8, MESO_RELAX_DIRECTIONS = 16 };

/* An end of sweeps: a joint that both slots share, or one that stays. */
typedef struct MesoRelaxNode {
    MesoVec3 point, tangent;    /* the tangent into the slot that speaks for the wall */
    MesoWallMove move;
    bool free;
    float thin;                 /* the thinnest part of its sweeps' sections, in scene units */
    float bend_most;            /* how much contacts may bend its sweeps, by the sum of squared curvatures, */
    float curve_most;           /* and by the largest one, */
    float order_least;          /* and how near they may bring the planes at their ends to crossing */
    /* Of what is on a wall: */
    MesoWall wall;
    MesoVec3 axes[2];
    MesoVec2 place;             /* in the wall, unmoved */
    MesoVec2 low, high;         /* bounds of how far it is moved along and up */
    uint32_t half_edge, section;    /* MESO_NO_INDEX where it is on none */
} MesoRelaxNode;

/* Sections of a sweep by how far they reach in directions around their trajectory, from X to Y, in its own units. */
typedef struct MesoRelaxShape {
    float reach[2][MESO_RELAX_DIRECTIONS];  /* at the start, at the end */
    float turn;
    bool round;                             /* it reaches as far in all directions */
    float most, thin, mean;                 /* farthest; half of the thinnest width; mean distance from the middle */
} MesoRelaxShape;

/* One sweep. */
typedef struct MesoRelaxLink {
    uint32_t node[2];
    float sign[2];              /* 1 where it lies on the side that the node's tangent points to, else -1 */
    MesoVec3 up[2];
    float scale[2];             /* of its shape, in scene units */
    float tangent_scale;
    uint32_t slot, sweep, shape;
    bool same_side;
    MesoVec3 p[4];
    MesoVec3 points[MESO_RELAX_CHORDS + 1];
    MesoVec3 middles[MESO_RELAX_CHORDS];    /* of the chords between them, */
    float halves[MESO_RELAX_CHORDS];        /* half of their lengths, */
    MesoVec3 axes[MESO_RELAX_CHORDS][2];    /* and X and Y of the sections there */
    MesoBox box;                /* around them */
    float bound;                /* beyond which its sections do not reach */
    float room;                 /* to the nearest other sweep's section, */
    float clear;                /* and to its trajectory, where that is near */
    /* What contacts ask of its ends: places, handles; and how much each is asked. */
    MesoVec3 push[2], turn[2];
    float push_weight[2], turn_weight[2];
} MesoRelaxLink;

typedef struct MesoRelaxWork {
    MesoModel *model;
    MesoMapOptions options;     /* resolved */
    MesoShell shell;
    uint32_t joint_count;       /* the first nodes */
    uint32_t node_count, link_count;
    MesoRelaxNode *nodes;
    MesoRelaxLink *links;
    MesoRelaxShape *shapes;     /* [2 * sweep_count of the tile set], mirrored ones behind the others */
    bool *hollow;               /* [section_count of the set] others may lie within what their outlines reach */
    uint64_t *meant_begin;      /* [sweep_count of the set] of its pairs with the sweeps of its tile: */
    float *meant;               /* the part of what it takes by which they are to be apart; 0: they are one thing */
    uint64_t *drawn_begin;      /* [section_count of the set] of its pairs with the sections of its interface: */
    float *drawn;               /* the same */
    uint32_t *end_begin, *ends; /* of nodes: 2 * link + end */
    MesoWallMove *next;         /* [node_count] */
    uint64_t *near_begin;       /* [link_count + 1] */
    uint32_t *near;             /* links that may come near each one, and are to be apart: */
    float *near_part;           /* by this part of what it takes */
    float room;                 /* that is looked for around links, in scene units */
    float reach;                /* how far a point may come to be from where it was */
} MesoRelaxWork;

/* ---- relax_links.c ---- */

/* Makes nodes, links, shapes; in `arena`. */
MesoStatus meso_relax_build(MesoRelaxWork *work, MesoArena *arena, MesoError *error);

/* Where a node is after its move. */
void meso_relax_place(MesoRelaxNode *node);

/* Control points of a link between two nodes. */
void meso_relax_control(const MesoRelaxLink *link, const MesoRelaxNode *start, const MesoRelaxNode *end,
                        MesoVec3 p[4]);

/* Control points and points of a link, from its nodes. */
void meso_relax_trace(MesoRelaxLink *link, const MesoRelaxNode *nodes);

/* ---- relax_meant.c ---- */

/*
 * How sweeps of a tile lie to each other in a flat square slot of mean size, and sections of an interface in its
 * drawing. What lies wholly in another one somewhere is one thing with it, and what only overlaps is to be parted; but
 * where a section is hollow, others may be meant to lie in it, and are to come no nearer. After meso_relax_build(); in
 * `arena`.
 */
MesoStatus meso_relax_find_meant(MesoRelaxWork *work, MesoArena *arena, MesoError *error);

/* By which part of what it takes two links of one slot, or the links of two nodes, are to be apart. O(1). */
float meso_relax_meant(const MesoRelaxWork *work, const MesoRelaxLink *a, const MesoRelaxLink *b);
float meso_relax_drawn(const MesoRelaxWork *work, const MesoRelaxNode *a, const MesoRelaxNode *b);

/* ---- relax_contacts.c ---- */

/* Which links may ever come near each other. `arena` keeps the list. */
MesoStatus meso_relax_find_near(MesoRelaxWork *work, MesoArena *arena, MesoError *error);

/* Fills in what contacts ask of links [begin, end), and their room. */
void meso_relax_contacts(void *work, uint64_t begin, uint64_t end);

/* How two links lie to each other. */
typedef struct MesoRelaxNearness {
    float distance;     /* the least, as a part of what it takes there; at most 1 */
    float depth;        /* by which they overlap at most, in widths of the thinner one */
    float needed;       /* what it takes at the least distance; 0 where nothing overlaps */
} MesoRelaxNearness;

/* Of two links that need not be in a list. */
MesoRelaxNearness meso_relax_nearness(const MesoRelaxWork *work, const MesoRelaxLink *a, const MesoRelaxLink *b);

/* How far below what a link reaches a point lies; 0 outside. */
float meso_relax_depth_within(const MesoRelaxWork *work, const MesoRelaxLink *link, MesoVec3 point);

/* Pairs of links that overlap. O(near pairs). */
uint64_t meso_relax_count(const MesoRelaxWork *work);

/* ---- relax_bends.c ---- */

/* Moves of nodes [begin, end) to `next`: alignment, and back by a share. */
void meso_relax_align(void *work, uint64_t begin, uint64_t end);

/* How far contacts may bend the sweeps of nodes [begin, end): as far as they are, or not far for their sections. */
void meso_relax_bound_bends(void *work, uint64_t begin, uint64_t end);

/* Moves of nodes [begin, end) to `next`, as contacts ask. */
void meso_relax_part(void *work, uint64_t begin, uint64_t end);

/* Mean and largest bend. */
void meso_relax_bends(const MesoRelaxWork *work, float *mean, float *most);

#endif
