/*
 * How well points lie on a swatch, after "Mesh Quilting For Geometric Texture Synthesis" (Zhou et al. 2006), equations
 * 1 and 2, by a table:
 *
 *     D(p) = min over faces f of (1 + lambda distance(p, f)) (1 + |n(p) - n(f)|)
 *
 * n(f) is the face's own normal. D is 1 at the least.
 */
#ifndef MESO_MATCH_FIELD_H
#define MESO_MATCH_FIELD_H

#include <string.h>

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"
#include "libcore/quilt/match/match_bins.h"
#include "libcore/quilt/swatch/swatch.h"

/* A point of a surface, in the swatch's units, and the surface's unit normal there. */
typedef struct MesoMatchPoint {
    MesoVec3 position, normal;
} MesoMatchPoint;

/* D at the centres of voxels that hold the tile and all that overhangs it, for normals in 26 directions: voxel
 * (x, y, z) with direction k is at ((k * count[2] + z) * count[1] + y) * count[0] + x. */
typedef struct MesoMatchField {
    uint32_t bins, count[3];
    float voxel;                /* side of a voxel */
    MesoVec3 low;               /* corner of the first voxel; a whole number of voxels from the origin */
    float lambda;               /* in 1 / length */
    const MesoSwatch *swatch;
    uint16_t *costs;            /* [bins * voxels] meso_match_excess() of these is D - 1 */
    uint16_t *faces;            /* [bins * voxels] the face that has it; NULL where there are too many for it: */
    uint32_t *many_faces;       /* [bins * voxels] or NULL */
    MesoVec3 *face_normals;     /* [triangle_count] 0 for faces without area */
} MesoMatchField;

/*
 * D - 1 in 16 bits: a float from 2^-16 on, without sign, with the eleven leading digits. Rounded up, by less than one
 * part in 2048.
 */
#define MESO_MATCH_EXCESS_BIAS (UINT32_C(111) << 23)

static inline float meso_match_excess(uint16_t code)
{
    uint32_t bits = ((uint32_t)code << 12) + MESO_MATCH_EXCESS_BIAS;
    float excess;
    memcpy(&excess, &bits, sizeof excess);
    return excess;
}

static inline uint16_t meso_match_excess_code(float excess)
{
    float least = 1.0f / 65536, most = 65504.0f, kept = excess > least ? excess < most ? excess : most : least;
    uint32_t bits;
    memcpy(&bits, &kept, sizeof bits);
    return (uint16_t)((bits - MESO_MATCH_EXCESS_BIAS + 0xfff) >> 12);
}

static inline uint32_t meso_match_face(const MesoMatchField *field, size_t at)
{
    return field->faces ? field->faces[at] : field->many_faces[at];
}

/*
 * Fills the table. For each direction the faces whose normals are nearest to it have a transform of distances; what is
 * kept of a voxel is the best of the nearest faces of all directions, by exact distance and normal. It is no less than
 * D there, mostly just that, and some parts in a hundred more on average: a face somewhat farther off may have the
 * better normal.
 *
 * swatch        has to outlast the field
 * lambda        what a distance counts; 1 over the mean edge or so
 * voxel         side of a voxel, > 0; about the mean edge or less
 * thread_count  0: all cores; the same bytes for any number
 *
 * O(676 * voxels); 4 * 26 bytes a voxel of memory, 6 * 26 for more than 65535 faces, and while it is filled 8 a thread.
 * MESO_ERR_INPUT for a swatch without faces or a side that is not positive, MESO_ERR_LIMIT for more than 2^24 voxels,
 * MESO_ERR_MEMORY.
 */
MesoStatus meso_match_field_build(MesoMatchField *field, MesoArena *arena, const MesoSwatch *swatch, float lambda,
                                  float voxel, uint32_t thread_count, MesoError *error);

/* D by all faces; of equals the first one. `face` may be NULL. For tests. O(triangle_count). */
float meso_match_exact(const MesoSwatch *swatch, float lambda, MesoMatchPoint point, uint32_t *face);

/* D of the best face that is found from those in the table by going on to better ones that share a corner: exact for
 * this face, no less than D. Points beyond the table start from the nearest voxel. `face` may be NULL. O(1). */
float meso_match_at(const MesoMatchField *field, MesoMatchPoint point, uint32_t *face);

#endif
