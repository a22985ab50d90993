/* Mesh files through OpenMesh's readers. */
#ifndef MESO_OPENMESH_ADAPTER_H
#define MESO_OPENMESH_ADAPTER_H

#include <stddef.h>
#include <stdint.h>

#include "libcore/base/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum MesoOpenMeshKind { MESO_OPENMESH_OBJ, MESO_OPENMESH_PLY, MESO_OPENMESH_OFF } MesoOpenMeshKind;

/* Takes what the readers deliver: faces, then vertices, each in the order of the file. */
typedef struct MesoOpenMeshSink {
    void *context;          /* first argument of both */
    void (*vertex)(void *context, float x, float y, float z);
    void (*face)(void *context, const uint32_t *vertices, uint32_t count);
} MesoOpenMeshSink;

/*
 * Reads `bytes` with OpenMesh and hands every vertex and face on as its reader
 * parsed it: they never go into an OpenMesh mesh, which would add faces again
 * on duplicated vertices, or drop them. Indices are unchecked. The bytes must
 * be as mesh_kinds.h says a reader takes them: on others the readers run away on absurd
 * counts, and open files that an OBJ names. Not to be called from two threads
 * at once, for the readers are singletons with state.
 * MESO_ERR_INPUT where OpenMesh refuses, MESO_ERR_MEMORY, MESO_ERR_INTERNAL.
 */
MesoStatus meso_openmesh_read(MesoOpenMeshKind kind, const char *bytes, size_t size,
                              const MesoOpenMeshSink *sink, MesoError *error);

#ifdef __cplusplus
}
#endif

#endif
