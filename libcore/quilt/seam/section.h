/*
 * Sections: closed loops of points where a strand has been cut. Two of them
 * are joined by a ring of triangles, one that is left alone is closed by a cap.
 */
#ifndef MESO_SECTION_H
#define MESO_SECTION_H

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef struct MesoSection {
    uint32_t count;
    const uint32_t *vertices;   /* [count] along the loop, the mesh to the left */
    const MesoVec3 *positions;  /* by vertex */
    MesoVec3 centre;            /* of the loop as a wire */
    MesoVec3 area;              /* vector: half the sum of cross products; away from the mesh */
    float length;               /* around */
    float reach;                /* the largest distance of a point from the centre */
} MesoSection;

/* Fills in all but the first three. O(count). */
void meso_section_measure(MesoSection *section);

/*
 * Where along `b`, which is walked against its direction, `a` begins best: the vertex of `b` (its place in the loop)
 * that lies with a's first when the centres are laid on each other, by the least sum of squares over all turns.
 * O(count of a * count of b).
 */
uint32_t meso_section_align(const MesoSection *a, const MesoSection *b);

/*
 * The point of `b` across from a's vertex `i` [count of a], by length around from the places that were aligned.
 * To `points` [count of a]. O(count of a + count of b).
 */
void meso_section_across(MesoVec3 *points, const MesoSection *a, const MesoSection *b, uint32_t aligned);

/*
 * Joins two sections that face each other by a.count + b.count triangles: to `corners` [3 * that], in the numbers of
 * the vertices; those of `b` are told apart by `b_offset`, which is added to them. The ring continues both meshes
 * with their winding, uses each edge of both loops once, and is a cylinder: manifold whatever the places are.
 */
void meso_section_zip(uint32_t *corners, const MesoSection *a, const MesoSection *b, uint32_t aligned,
                      uint32_t b_offset);

/*
 * Closes a section by count - 2 triangles: ears are clipped in the plane across its area (Meisters, 1975); loops that
 * cross themselves there are closed too, in some way. To `corners` [3 * (count - 2)]. O(count^2).
 * MESO_ERR_MEMORY.
 */
MesoStatus meso_section_cap(uint32_t *corners, MesoArena *scratch, const MesoSection *section, MesoError *error);

/*
 * Closes a long and narrow section, as of a strand cut along, by count - 2 triangles from side to side of it, none
 * longer than it has to be, so that they follow it where it bends. `places` [count]: laid flat, x along it. False, and
 * nothing is written, where it does not go there and back by x. To `corners` [3 * (count - 2)]. O(count).
 */
bool meso_section_strip(uint32_t *corners, const MesoSection *section, const MesoVec2 *places);

#endif
