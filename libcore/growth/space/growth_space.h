/*
 * What has grown, where: the pieces of all strands by the triangle that they lie in, in the triangle's own frame. A new
 * piece is tested against those of its triangle alone, or of the parts of it that it goes through, by signs of turns;
 * where rounding might have made a sign, the two count as meeting, so that what does not meet does not.
 *
 * Strands form trees. A step begins at a node: the end of an element, or the place of a seed. What begins or ends at
 * that node touches it there and nowhere else; and distances along the tree tell what is kin.
 */
#ifndef MESO_GROWTH_SPACE_H
#define MESO_GROWTH_SPACE_H

#include "libcore/growth/space/growth_cells.h"

/* Nodes that are no element's end: with the number of a seed's place. */
#define MESO_GROWTH_ROOT 0x80000000u

/* What lies nearer than this times its distance along the strands is kin to a step that must be clear by a distance. */
enum { MESO_GROWTH_KIN = 4 };

/* An element's place in its tree. */
typedef struct MesoGrowthKin {
    uint32_t node;              /* at which it begins, or from which its branch has moved to where it begins */
    bool moved, placed;         /* placed: a shape that nothing grows on from, nor may not be crossed */
    float begin, end;           /* along the way from the seed */
} MesoGrowthKin;

typedef struct MesoGrowthSpace {
    const MesoGrowthGround *ground;
    MesoGrowthCells cells;
    MesoGrowthKin *kin;
    uint32_t kin_count, kin_room;
} MesoGrowthSpace;

/* Who asks. */
typedef struct MesoGrowthAsker {
    uint32_t node;
    bool moved;
    double length;              /* along the way from the seed, where it begins */
    uint32_t since;             /* only pieces from this one on are looked at */
} MesoGrowthAsker;

typedef struct MesoGrowthMeeting {
    uint32_t piece;             /* of the way that asks */
    uint32_t met;               /* piece of a strand; where two are in one place, the newer */
    MesoComplex at;             /* on the strand that is met */
    double along;               /* the piece, up to there */
} MesoGrowthMeeting;

/* Triangles that a search has seen; it grows, and is the searcher's own. */
typedef struct MesoGrowthSeen {
    uint32_t *table, *queue;    /* [room], [room] */
    double *ends;               /* [6 * piece_room] in space */
    uint32_t room, count, piece_room;
    bool failed;                /* out of memory */
} MesoGrowthSeen;

MesoStatus meso_growth_space_init(MesoGrowthSpace *space, const MesoGrowthGround *ground, MesoError *error);
void meso_growth_space_release(MesoGrowthSpace *space);
void meso_growth_seen_release(MesoGrowthSeen *seen);

/* The next element, and the pieces of its way. False where memory is out. */
bool meso_growth_space_add(MesoGrowthSpace *space, MesoGrowthKin kin, const MesoGrowthPiece *pieces, uint32_t count);

/* Whether a way meets a strand, and where it does first. O(pieces in the cells that it goes through). */
bool meso_growth_meets(const MesoGrowthSpace *space, const MesoGrowthAsker *asker, const MesoGrowthPiece *pieces,
                       uint32_t count, MesoGrowthMeeting *first);

/*
 * Whether all elements keep the distance `clear` from a way, as far as the surface is joined to it within that
 * distance; but what is kin to it; kin that is placed counts where `placed_count`. O(triangles within the distance, and
 * pieces there).
 */
bool meso_growth_is_clear(const MesoGrowthSpace *space, MesoGrowthSeen *seen, const MesoGrowthAsker *asker,
                          const MesoGrowthPiece *pieces, uint32_t count, double clear, bool placed_count);

/* The way along the tree from where the asker begins to the nearer end of an element; infinite from tree to tree. */
double meso_growth_way_to(const MesoGrowthSpace *space, const MesoGrowthAsker *asker, uint32_t element, double most);

/* ---- points in triangles ---- */

/* Weights of the corners of a triangle at a point of its frame, clamped to it. */
void meso_growth_weigh(const MesoWalkGround *ground, uint32_t triangle, MesoComplex point, double weight[3]);

#endif
