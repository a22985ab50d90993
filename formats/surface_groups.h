/*
 * What mesh files say of faces beside their shape: groups, objects and
 * materials (OBJ), and numbers by name (PLY properties of faces and vertices,
 * vertex colours of OBJ).
 */
#ifndef MESO_SURFACE_GROUPS_H
#define MESO_SURFACE_GROUPS_H

#include <jansson.h>
#include <stdbool.h>

#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

typedef enum MesoGroupKind { MESO_GROUP_GROUP, MESO_GROUP_OBJECT, MESO_GROUP_MATERIAL, MESO_GROUP_KINDS } MesoGroupKind;

/* Names of one kind. A statement `g a b` is one entry, "a b", and its faces belong to both groups. */
typedef struct MesoFaceNames {
    uint32_t count;
    const char **names;         /* [count] */
    uint32_t *of_face;          /* [face_count] entry, or MESO_NO_INDEX */
} MesoFaceNames;

/*
 * Values by face. Those of vertices are means over the four corners; red,
 * green, blue and alpha that are stored as bytes or 16-bit words are scaled to
 * [0, 1]. Numbers may be anything, NaN too.
 */
typedef struct MesoFaceAttribute {
    const char *name;
    bool of_vertices;
    double *values;             /* [face_count] */
} MesoFaceAttribute;

typedef struct MesoSurfaceGroups {
    uint32_t face_count;
    MesoFaceNames names[MESO_GROUP_KINDS];
    uint32_t attribute_count;
    MesoFaceAttribute *attributes;  /* [attribute_count] faces' first */
} MesoSurfaceGroups;

/* True if the entry `names` is `name`, or, for groups, has it among its words. */
bool meso_face_names_match(MesoGroupKind kind, const char *names, const char *name);

/* Attribute `name`, of faces before that of vertices, or NULL. */
const MesoFaceAttribute *meso_face_attribute(const MesoSurfaceGroups *groups, const char *name);

/* For the scans: groups under construction. Arrays have room for more than their counts. */
typedef struct MesoGroupsBuilder {
    MesoArena *arena;
    json_t *numbers[MESO_GROUP_KINDS];      /* number of each name */
    uint32_t current[MESO_GROUP_KINDS];     /* entry that faces get now */
    uint32_t name_count[MESO_GROUP_KINDS], name_room[MESO_GROUP_KINDS];
    const char **names[MESO_GROUP_KINDS];
    uint32_t face_count, face_room;
    uint32_t *of_face;                      /* [MESO_GROUP_KINDS * face_count] */
    uint32_t column_count, column_room;
    struct MesoGroupsColumn *columns;
    bool textures;              /* set after the beginning: OBJ's texture coordinates are wanted too */
    uint32_t texture_count, texture_room;
    float *texture_u;           /* [texture_count] first coordinate of each `vt` */
    uint32_t corner_count, corner_room;
    uint32_t *corner_textures;  /* [corner_count] below texture_count, or MESO_NO_INDEX */
} MesoGroupsBuilder;

typedef struct MesoGroupsColumn {
    const char *name;
    bool of_vertices;
    double scale;
    size_t count, room;
    double *values;
} MesoGroupsColumn;

void meso_groups_begin(MesoGroupsBuilder *builder, MesoArena *arena);
void meso_groups_release(MesoGroupsBuilder *builder);

/* A statement: the faces to come have the name of `size` bytes. */
MesoStatus meso_groups_name(MesoGroupsBuilder *builder, MesoGroupKind kind, const char *name, size_t size,
                            MesoError *error);

/* A face, under the names of now. */
MesoStatus meso_groups_face(MesoGroupsBuilder *builder, MesoError *error);

/* A new column of values; its number goes to `column`. */
MesoStatus meso_groups_column(MesoGroupsBuilder *builder, const char *name, size_t size, bool of_vertices,
                              double scale, uint32_t *column, MesoError *error);

MesoStatus meso_groups_value(MesoGroupsBuilder *builder, uint32_t column, double value, MesoError *error);

/* A texture coordinate, and the one of a corner. */
MesoStatus meso_groups_texture(MesoGroupsBuilder *builder, float u, MesoError *error);
MesoStatus meso_groups_corner_texture(MesoGroupsBuilder *builder, uint32_t texture, MesoError *error);

/* Column `name` with `count` values, or NULL. */
const MesoGroupsColumn *meso_groups_find(const MesoGroupsBuilder *builder, const char *name, bool of_vertices,
                                         uint32_t count);

/*
 * Puts all together for quads of `corner_vertices` [4 * face_count], into
 * `arena`. Columns that do not have a value for every face, or every vertex,
 * are left out; as are names where no face was counted.
 */
MesoStatus meso_groups_finish(MesoGroupsBuilder *builder, MesoSurfaceGroups *groups, MesoArena *arena,
                              uint32_t vertex_count, uint32_t face_count, const uint32_t *corner_vertices,
                              MesoError *error);

#endif
