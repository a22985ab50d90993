/*
 * Products seen from outside: what kind of file it is, and what it says about
 * itself in its header, without decoding it.
 */
#ifndef MESO_PRODUCT_FILE_H
#define MESO_PRODUCT_FILE_H

#include <jansson.h>

#include "formats/file/input.h"

typedef enum MesoProductKind {
    MESO_PRODUCT_NONE,
    MESO_PRODUCT_EXR,
    MESO_PRODUCT_PNG,
    MESO_PRODUCT_GLB,
    MESO_PRODUCT_DRC,
    MESO_PRODUCT_PLY,   /* any PLY */
    MESO_PRODUCT_OBJ    /* an OBJ that begins with our provenance */
} MesoProductKind;

/* By the first bytes. */
MesoProductKind meso_product_recognise(const MesoInput *input);

/* "exr", "png", ... */
const char *meso_product_name(MesoProductKind kind);

/* "provenance" as below, alone; the caller owns it. `*found` is NULL where there is none. MESO_ERR_MEMORY alone. */
MesoStatus meso_product_provenance(json_t **found, MesoProductKind kind, const MesoInput *input);

/*
 * Sets what the header of a file of this kind says: "width", "height",
 * "channels" of images, "vertices", "faces", "triangles" of meshes, and
 * "provenance" where it is one of ours. MESO_ERR_INPUT where the header is cut
 * off or broken. O(size of the header), for OBJ O(size).
 */
MesoStatus meso_product_describe(json_t *facts, MesoProductKind kind, const MesoInput *input,
                                 MesoError *error);

#endif
