/* What is checked, as triangles: meshes of any kind, models, quilts. */
#ifndef MESO_CHECK_INPUT_H
#define MESO_CHECK_INPUT_H

#include "cmd/common/tool.h"
#include "libcore/check/inspection.h"

typedef struct MesoCheckInput {
    MesoInspectedMesh mesh;
    uint32_t *faces;            /* [triangle_count] of the file, from 0; NULL: it has parts */
    uint64_t face_count;
    uint32_t looped;            /* faces that come back to a vertex: they fell into loops, or away */
    const char *thing;          /* "strand", "element" or "detail"; "piece" where there are no such ids */
    const char **thing_names;   /* [thing_name_count], or NULL: numbers are their own names */
    uint32_t thing_name_count;
    float edge;                 /* mean edge of the surface below, where a model has one; 0: none */
} MesoCheckInput;

/*
 * Reads a mesh, a model or a quilt that is open to the tool's arena. The things are the ids of the first of the
 * channels "strand", "element" and "detail" that it has, the slots those of "slot"; a model of tiles has its hexahedra.
 * Faces become fans of triangles, quads the two that agree with it. Errors as those of the readers; MESO_ERR_INPUT for
 * ids below 0 or over 2^32 - 3.
 */
MesoStatus meso_check_read(MesoCheckInput *input, MesoTool *tool, const MesoInput *file);

/* Whether an input that is open is a mesh, rather than a model or quilt. */
bool meso_check_is_mesh(const MesoInput *file);

/* Name of a thing, or its number, in `room`. */
const char *meso_check_thing_name(const MesoCheckInput *input, uint32_t id, char room[24]);

#endif
