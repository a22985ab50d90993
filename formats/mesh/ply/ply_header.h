/* Headers of PLY files: the elements and their properties. */
#ifndef MESO_PLY_HEADER_H
#define MESO_PLY_HEADER_H

#include "formats/file/input.h"
#include "libcore/mesh/attribute.h"

enum { MESO_PLY_ELEMENTS = 64, MESO_PLY_PROPERTIES = 512 };

typedef enum MesoPlyForm { MESO_PLY_NONE, MESO_PLY_ASCII, MESO_PLY_LITTLE, MESO_PLY_BIG } MesoPlyForm;

/* What a property is for; the first three in the order of a position's numbers. */
typedef enum MesoPlyRole {
    MESO_PLY_X, MESO_PLY_Y, MESO_PLY_Z, MESO_PLY_NX, MESO_PLY_NY, MESO_PLY_NZ, MESO_PLY_INDICES, MESO_PLY_TEXCOORD,
    MESO_PLY_CORNERS,           /* any other list of faces: perhaps of so many numbers for each corner */
    MESO_PLY_OTHER
} MesoPlyRole;

typedef enum MesoPlyKind { MESO_PLY_VERTICES, MESO_PLY_FACES, MESO_PLY_UNKNOWN } MesoPlyKind;

typedef struct MesoPlyProperty {
    const char *name;
    MesoScalar type, count_type;
    bool list;
    MesoPlyRole role;
    /* where it goes in the mesh; see ply_layout.h */
    unsigned char *out;         /* of item 0, or of corner 0; NULL: nowhere */
    uint32_t stride;            /* bytes from item to item, or from corner to corner */
    MesoScalar to;              /* as it is kept */
} MesoPlyProperty;

typedef struct MesoPlyElement {
    char name[32];
    MesoPlyKind kind;
    uint32_t count;
    MesoPlyProperty *properties, *properties_end;
    uint32_t roles;             /* bit set of the roles that its properties have */
    bool lists;                 /* it has some */
    uint32_t size;              /* bytes of an item of a binary file, but for lists */
} MesoPlyElement;

/* A comment "tile 2 ribbon", as our writers name the number 2 of the property "tile". */
typedef struct MesoPlyName {
    const char *property, *name;
    uint32_t number;
} MesoPlyName;

typedef struct MesoPly {
    const char *path;
    MesoPlyForm form;
    uint32_t element_count, property_count;
    MesoPlyElement elements[MESO_PLY_ELEMENTS];
    MesoPlyProperty properties[MESO_PLY_PROPERTIES];
    uint32_t name_count, name_room;
    MesoPlyName *names;         /* [name_count] in the order of the file */
    size_t body;                /* where the header ends */
} MesoPly;

/* Whether the numbers of a property may be corners'. */
static inline bool meso_ply_is_of_corners(const MesoPlyProperty *property)
{
    return property->role == MESO_PLY_TEXCOORD || property->role == MESO_PLY_CORNERS;
}

/* Reads the header; names go to `arena`. MESO_ERR_INPUT with the line. */
MesoStatus meso_ply_header_read(MesoPly *ply, MesoArena *arena, const MesoInput *input, MesoError *error);

#endif
