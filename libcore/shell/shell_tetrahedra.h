/* The tetrahedra of a shell map (shell_map.h), on both sides. */
#ifndef MESO_SHELL_TETRAHEDRA_H
#define MESO_SHELL_TETRAHEDRA_H

#include "libcore/math/vec3d.h"
#include "libcore/mesh/cut/triangulation.h"

typedef struct MesoShellMap {
    const MesoTriangulation *mesh;
    const MesoVec3 *directions; /* [mesh->vertex_count] */
    double low, high;
    uint32_t vertex_count;      /* of all charts: a vertex of the mesh at a seam is several */
    uint32_t *corners;          /* [3 * triangle_count] vertices of the map, by corner of the mesh */
    uint32_t *origins;          /* [vertex_count] vertices of the mesh */
    double *low_uv, *high_uv;   /* [2 * vertex_count] below and above, in units of the surface */
    uint8_t *held;              /* [vertex_count] 1 on the border of its chart, where the upper uv is the lower */
    uint8_t *plain;             /* [triangle_count] 1: a tetrahedron is negative, points go by the prism instead */
} MesoShellMap;

/* Corners of a triangle's prisms, 0 to 2 below and 3 to 5 above, and how both are cut. */
typedef struct MesoShellPrism {
    MesoVec3d texture[6], shell[6];
    uint8_t tetrahedra[3][4];
} MesoShellPrism;

MesoShellPrism meso_shell_prism(const MesoShellMap *map, uint32_t triangle);

/* Four of its corners. */
void meso_shell_prism_part(const MesoShellPrism *prism, uint32_t part, MesoVec3d texture[4], MesoVec3d shell[4]);

/* Tetrahedra that are negative on either side, and others that are flat there. */
void meso_shell_prism_count(const MesoShellPrism *prism, uint32_t *negative_count, uint32_t *flat_count);

/* Whether all its tetrahedra have a volume on both sides; the rest is left as it is. */
bool meso_shell_prism_stands(const MesoShellPrism *prism);

#endif
