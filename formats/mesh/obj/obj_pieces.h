/* OBJ in pieces: what each piece has of everything, then its elements at their places. */
#ifndef MESO_OBJ_PIECES_H
#define MESO_OBJ_PIECES_H

#include "formats/mesh/mesh_text.h"
#include "libcore/math/vec.h"

typedef enum MesoObjCount {
    MESO_OBJ_VERTICES, MESO_OBJ_COLORED, MESO_OBJ_NORMALS, MESO_OBJ_TEXTURES, MESO_OBJ_FACES, MESO_OBJ_CORNERS,
    MESO_OBJ_NAMES,             /* statements g, o and usemtl */
    MESO_OBJ_COUNTS
} MesoObjCount;

typedef enum MesoObjName { MESO_OBJ_GROUP, MESO_OBJ_OBJECT, MESO_OBJ_MATERIAL, MESO_OBJ_NAME_KINDS } MesoObjName;

typedef struct MesoObjPiece {
    uint64_t counts[MESO_OBJ_COUNTS];
    uint64_t begin[MESO_OBJ_COUNTS];            /* of the pieces before */
    uint32_t least_sides, most_sides;
    uint32_t names_before[MESO_OBJ_NAME_KINDS]; /* entry that the first faces have, or MESO_NO_INDEX */
    bool wrong_textures;        /* a texture coordinate or the use of one is not as it should be */
    bool missing_normals;       /* a face uses a normal, and there is none */
} MesoObjPiece;

/* Where elements go; arrays are NULL where nobody wants them. */
typedef struct MesoObjArrays {
    MesoVec3 *positions, *colors, *normals;
    float *textures;            /* [texture_width * textures] */
    uint32_t texture_width;
    uint32_t *corners, *normal_of, *texture_of;     /* by corner */
    uint32_t *face_begin;
    uint32_t *name_of[MESO_OBJ_NAME_KINDS];         /* by face */
    uint32_t *name_entries;     /* [statements] entry of each */
} MesoObjArrays;

typedef struct MesoObj {
    MesoMeshText text;
    bool colored;               /* the first vertex has a colour: they are counted */
    bool strict;                /* texture coordinates that are not as they should be are errors */
    MesoObjPiece *pieces;
    uint64_t totals[MESO_OBJ_COUNTS];
    MesoObjArrays arrays;
} MesoObj;

/* Kind of a statement g, o or usemtl; MESO_OBJ_NAME_KINDS of others. */
MesoObjName meso_obj_name_kind(MesoWord statement);

/* For meso_mesh_text_for(), with a MesoObj: counts; fills the arrays. */
void meso_obj_count(void *context, uint64_t begin, uint64_t end);
void meso_obj_fill(void *context, uint64_t begin, uint64_t end);

/*
 * Numbers the names of all statements, of each kind from 0 in order of appearance, into `name_entries` and
 * `names_before`. `names` gets [counts] for each kind, NULL for one without statements; in `arena`. O(size).
 * MESO_ERR_MEMORY alone.
 */
MesoStatus meso_obj_number_names(MesoObj *obj, MesoArena *arena, MesoArena *scratch, uint32_t thread_count,
                                 const char **names[MESO_OBJ_NAME_KINDS], uint32_t counts[MESO_OBJ_NAME_KINDS],
                                 MesoError *error);

#endif
