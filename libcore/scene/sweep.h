/* Sweeps: points, vertices and faces of tubes, by the formulas of scene.h. */
#ifndef MESO_SWEEP_H
#define MESO_SWEEP_H

#include "libcore/scene/scene.h"
#include "libcore/scene/sweep_section.h"

/* P of an instance of a swept kind, a cap too, at one of its columns, or one like them, and v in [0,1]. */
MesoVec3 meso_sweep_point(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                          const MesoSweepColumn *column, float v);

/*
 * Gives a sweep that has all but that its mitre: the least, in eighths, with which no line along it runs backwards, but
 * a tenth as fast as the trajectory at least, or as near to that as can be; 0 where none runs backwards anyway; and
 * where some does with any, or its frame would flip, a crease, with the twist that it asks for. Columns of the kind
 * reach so far. O(1) where no bend is narrower than the section, and no frame flips, else O(columns).
 */
void meso_sweep_add_mitre(const MesoScene *scene, const MesoSweptKind *kind, MesoKindReach reach,
                          MesoSweepInstance *sweep);

/* v of ring `ring` of a sweep. */
float meso_sweep_place(const MesoSweptKind *kind, const MesoSweepInstance *sweep, uint32_t ring);

/* Which columns of a kind, and how many rings, as a level of detail has them (detail.h). */
typedef struct MesoSweepGrid {
    const uint32_t *columns;    /* [column_count] columns of the kind; NULL: all of them */
    const MesoSweepColumn *stand_ins;   /* [column_count] what is there in their place, or NULL */
    uint32_t column_count, ring_count;
    bool own;                   /* rings as files have them: paced, bowed, without what is absent; else even, whole */
    bool bare;                  /* positions alone: the rest of the vertices is left as it was */
    const uint8_t *wanted;      /* [column_count * ring_count] not 0: others may be left as they were; NULL: all are */
} MesoSweepGrid;

/* Vertices of an instance of `kind` on these, to `out` [column_count * ring_count less what is absent], by rings. */
void meso_sweep_grid(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                     const MesoSweepGrid *grid, MesoMeshVertex *out);

/* Where columns of a kind lie at the ends of a sweep, by coordinates, in units of the profiles: many at once. */
enum { MESO_SWEEP_LANES = 8 };
typedef struct MesoSweepPlaces {
    uint32_t count;
    const float *start_x, *start_y, *end_x, *end_y;     /* [count, up to a multiple of MESO_SWEEP_LANES] */
} MesoSweepPlaces;

/*
 * Points at these on `ring_count` even rings of an instance whose section keeps its shape (MESO_SWEEP_CURVES): the same
 * as meso_sweep_grid() finds. To `x`, `y` and `z` [count * ring_count + MESO_SWEEP_LANES], by rings; behind the last
 * one is anything.
 */
void meso_sweep_points(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                       const MesoSweepPlaces *places, uint32_t ring_count, float *x, float *y, float *z);

/* Of one instance of a kind; quads are two triangles. */
uint64_t meso_sweep_vertex_count(const MesoSweptKind *kind);
uint64_t meso_sweep_face_count(const MesoSweptKind *kind);
uint64_t meso_sweep_triangle_count(const MesoSweptKind *kind);

/*
 * Vertices of one instance of `kind`, ring by ring, to `out` [meso_sweep_vertex_count()], and its faces, row by row,
 * whose indices count from `base`, to `out` [meso_sweep_face_count()]. A cap's last row are triangles.
 */
void meso_sweep_vertices(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                         MesoMeshVertex *out);
void meso_sweep_faces(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep, uint32_t base,
                      MesoMeshFace *out);

/*
 * Bits of a sweep's leans: each joint between the ends has one for each of a number of parts of the rows, or a few
 * joints have one together, where there are very many. Where it is set, a quad's diagonal is the one from its second
 * corner, not from its first.
 */
enum { MESO_LEAN_BITS = 64 * MESO_LEAN_WORDS, MESO_LEAN_PARTS = 16 };

static inline uint32_t meso_sweep_lean_parts(uint32_t joint_count)
{
    uint32_t parts = joint_count > 0 ? MESO_LEAN_BITS / joint_count : 1;
    return parts < 1 ? 1 : parts > MESO_LEAN_PARTS ? MESO_LEAN_PARTS : parts;
}

static inline uint32_t meso_sweep_lean_bit(uint32_t joint, uint32_t joint_count, uint32_t row, uint32_t row_count)
{
    uint32_t parts = meso_sweep_lean_parts(joint_count);
    if (joint_count > MESO_LEAN_BITS)
        joint = (uint32_t)((uint64_t)joint * MESO_LEAN_BITS / joint_count);
    return joint * parts + (row_count <= parts ? row : (uint32_t)((uint64_t)row * parts / row_count));
}

static inline bool meso_sweep_leans(const MesoSweepInstance *sweep, uint32_t bit)
{
    return sweep->steps.leans[bit / 64] >> bit % 64 & 1;
}

/*
 * How many triangles of a sweep, no cap, are against the normals of all their corners, or nearly, with all columns and
 * even rings, as many as the kind has, but 64 at most, whichever way quads are cut; or a number over `enough`, if they
 * are more. O(columns * rings).
 */
uint32_t meso_sweep_against(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                            uint32_t enough);

/* Counts what is absent in the columns of a kind, and what is joined. */
void meso_sweep_count(MesoSweptKind *kind, const MesoSweepColumn *columns);

#endif
