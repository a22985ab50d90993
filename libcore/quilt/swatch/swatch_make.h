/* Swatches by recipe: strands, rings, leaves and fruit for those who have no mesh of their own. */
#ifndef MESO_SWATCH_MAKE_H
#define MESO_SWATCH_MAKE_H

#include "libcore/mesh/polygon_mesh.h"

/* What is 0 is as the recipe has it. */
typedef struct MesoSwatchRecipe {
    const char *name;           /* weave, wire, mail, rings, nuts, apples, ivy, scales, armour */
    uint32_t columns, rows;     /* strands, or elements, along x and y */
    float jitter;               /* of phase, offset and amplitude, in pitches, up to 0.25; with 0 it is periodic */
    uint64_t seed;
    uint32_t sides;             /* of a cross-section, 3 or more; of the outline of scales */
    float thickness;            /* across a strand, in pitches */
} MesoSwatchRecipe;

/*
 * weave, wire  plain weaves of flat strands and of round wires: over one, under one
 * armour       a dense twill of bands: over two, under two
 * mail         European 4-in-1: each ring goes through four others
 * rings        Japanese 4-in-1: flat rings, joined by upright ones
 * nuts         hexagonal nuts with a hole and chamfers, whose cross-section is given
 * apples       apples, and a stem in each
 * ivy          stems along x, by which leaves stand, elements of their own; two columns are a wave
 * scales       closed scales, row over row
 *
 * Nothing cuts anything else, unless strands are made thicker. Strands have open ends at the tile's sides. Without
 * jitter, columns and rows become so many more that the far sides meet the near ones: even, and for armour
 * multiples of four.
 *
 * The mesh of a recipe, z up, the pitch of its elements 1, with attributes "normal", "uv", and of faces "material",
 * "albedo", "roughness" and "metallic". Without jitter it is periodic along x and y, as meso_swatch_build() finds
 * it. O(faces). MESO_ERR_USAGE for a name that is not there, or numbers out of range; MESO_ERR_LIMIT,
 * MESO_ERR_MEMORY.
 */
MesoStatus meso_swatch_make(MesoPolygonMesh *mesh, MesoArena *arena, const MesoSwatchRecipe *recipe, MesoError *error);

/* "weave, wire, ...", for messages and help. */
const char *meso_swatch_recipe_names(void);

#endif
