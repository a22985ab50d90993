/*
 * What a shell is made of beside its surface: normals, sides and heights; and the slots whose hexahedra fold.
 */
#ifndef MESO_SHELL_FORM_H
#define MESO_SHELL_FORM_H

#include "libcore/shell/hexahedra.h"

/* Along which normals it rises. Neighbours meet on the same floats in each case, as walls take the mean of both. */
typedef enum MesoShellNormals {
    MESO_NORMALS_FILE,      /* those that the surface has */
    MESO_NORMALS_SMOOTH,    /* of vertices: of the faces around, by area; inner meshes meet too */
    MESO_NORMALS_FLAT       /* of faces */
} MesoShellNormals;

/* Where it lies about the surface that is `offset` away. */
typedef enum MesoShellSide {
    MESO_SHELL_OUTSIDE,      /* on it */
    MESO_SHELL_BOTH,         /* in the middle of it */
    MESO_SHELL_INSIDE        /* under it */
} MesoShellSide;

extern const char *const meso_shell_normals_names[], *const meso_shell_side_names[];     /* ended by NULL */

typedef struct MesoShellForm {
    float offset, thickness;        /* the height is half of the thickness */
    uint32_t normals, side;         /* MesoShellNormals, MesoShellSide */
    const float *factors, *lifts;   /* [vertex_count] of the thickness, and added to the offset; NULL: 1, 0 */
    bool limit_folds;               /* lower it where it would fold */
    bool shared;                    /* neighbours have the same corners: of normals that differ there, the mean */
} MesoShellForm;

/*
 * Builds a shell; what it needs lives in `arena`. Where folds are limited, heights are scaled by factors that differ by
 * at most MESO_LIMIT_SLOPE from corner to corner of a face, and go down to MESO_LIMIT_LEAST, so that the offset surfaces
 * keep a twentieth of each corner's area; corners that the surface itself folds are left. O(face_count).
 * MESO_ERR_MEMORY alone.
 */
#define MESO_LIMIT_SLOPE 0.25f
#define MESO_LIMIT_LEAST 0.01f
MesoStatus meso_shell_build(MesoShell *shell, MesoArena *arena, const MesoQuadMesh *mesh, const MesoSlotGraph *graph,
                            const MesoShellForm *form, MesoError *error);

/*
 * Counts the slots whose hexahedron folds: at a corner of its bottom or top the sides turn the other way round than on
 * the surface, det [P(i+1) - P(i), P(i-1) - P(i), n(i)] <= 0. Writes the first `room` of them, ascending. O(face_count).
 */
uint32_t meso_shell_folds(const MesoShell *shell, uint32_t *slots, uint32_t room);

#endif
