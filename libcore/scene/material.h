/* Materials: what surfaces look like. */
#ifndef MESO_MATERIAL_H
#define MESO_MATERIAL_H

typedef struct MesoMaterial {
    float albedo[3];    /* linear, [0,1] */
    float roughness;    /* [0,1] */
    float metallic;     /* [0,1] */
} MesoMaterial;

#endif
