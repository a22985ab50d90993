/*
 * Scans of mesh files: every element exactly as the file gives it, with the
 * line of each face, so that nothing that a library mends or drops goes
 * unnoticed.
 */
#ifndef MESO_MESH_SCAN_H
#define MESO_MESH_SCAN_H

#include <stdbool.h>

#include "formats/file/input.h"
#include "formats/surface_groups.h"
#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/* Arrays have room for more than their counts while a scan fills them. */
typedef struct MesoMeshScan {
    MesoArena *arena;
    uint32_t vertex_count, normal_count, face_count, corner_count;
    uint32_t vertex_room, normal_room, face_room, corner_room;
    MesoVec3 *positions;        /* [vertex_count] finite */
    MesoVec3 *normals;          /* [normal_count] finite, of any length */
    uint32_t *face_ends;        /* [face_count] one past the face's last corner */
    uint32_t *face_lines;       /* [face_count] from 1; 0 in binary files */
    uint32_t *corner_vertices;  /* [corner_count] below vertex_count */
    uint32_t *corner_normals;   /* [corner_count] below normal_count, or MESO_NO_INDEX */

    /* The file as OpenMesh gets it, without what would lead it astray. NULL where it does not
       know the layout at all, so that the scan stands alone. */
    const char *bytes;
    size_t size;
    bool relative;              /* OBJ with negative indices, which OpenMesh counts from the last
                                   vertex of the file and not from the last one so far */
} MesoMeshScan;

/*
 * Each scans one kind of file into `arena`, which stays the caller's, and
 * fails with MESO_ERR_INPUT, naming file and line (the element in binary
 * files), on whatever is not as the format says: counts, numbers, ends.
 * Afterwards all indices are in range, and no face has fewer than three sides
 * or uses a vertex twice. Allocates in proportion to the file, whatever counts
 * its header claims. O(size).
 *
 * OBJ  v, vn, f; texture coordinates, groups, materials, lines and points are
 *      passed over; anything else is refused
 * PLY  ASCII and binary of either byte order; nx ny nz are vertex normals
 * OFF  ASCII, with normals, colours and texture coordinates in the header's order
 */
MesoStatus meso_obj_scan(MesoMeshScan *scan, MesoArena *arena, const MesoInput *input, MesoError *error);
MesoStatus meso_ply_scan(MesoMeshScan *scan, MesoArena *arena, const MesoInput *input, MesoError *error);
MesoStatus meso_off_scan(MesoMeshScan *scan, MesoArena *arena, const MesoInput *input, MesoError *error);

/* The same, and what the file says of faces beside their shape goes to `groups`; NULL: nowhere. */
MesoStatus meso_obj_scan_groups(MesoMeshScan *scan, MesoGroupsBuilder *groups, MesoArena *arena,
                                const MesoInput *input, MesoError *error);
MesoStatus meso_ply_scan_groups(MesoMeshScan *scan, MesoGroupsBuilder *groups, MesoArena *arena,
                                const MesoInput *input, MesoError *error);

/*
 * Scans a file of any kind, known by its name or content, and refuses glTF and
 * files without faces. `groups` may be NULL; OFF has none.
 */
MesoStatus meso_mesh_scan_file(MesoMeshScan *scan, MesoGroupsBuilder *groups, MesoArena *arena,
                               const MesoInput *input, MesoError *error);

/* For the scans: append one element. MESO_ERR_MEMORY, or MESO_ERR_LIMIT past 2^32 - 2 of a kind. */
MesoStatus meso_mesh_scan_vertex(MesoMeshScan *scan, MesoVec3 position, MesoError *error);
MesoStatus meso_mesh_scan_normal(MesoMeshScan *scan, MesoVec3 normal, MesoError *error);
MesoStatus meso_mesh_scan_corner(MesoMeshScan *scan, uint32_t vertex, uint32_t normal, MesoError *error);
/* Ends the face that the last corners belong to. */
MesoStatus meso_mesh_scan_face(MesoMeshScan *scan, uint32_t line, MesoError *error);

/* For the scans, at the end: checks indices and faces as said above. */
MesoStatus meso_mesh_scan_check(const MesoMeshScan *scan, const char *path, MesoError *error);

/* Fails with "PATH:LINE: face N " before the message; without the line where there is none. */
MesoStatus meso_mesh_scan_fail(const MesoMeshScan *scan, const char *path, uint32_t face,
                               MesoError *error, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

static inline uint32_t meso_mesh_scan_begin(const MesoMeshScan *scan, uint32_t face)
{
    return face ? scan->face_ends[face - 1] : 0;
}

#endif
