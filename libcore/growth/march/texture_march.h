/*
 * Steps through the texels of a geometry image, as "Dynamic On-Mesh Procedural Generation Control" (Buron, Marvie,
 * Guennebaud and Granier 2014) has them: straight on in a chart's texture; back from the background to the chart's last
 * texel; along one of the pointers around it, that which leads nearest to where the march was heading in space; and on
 * from there, turned as the charts' tangents are to each other in space.
 *
 * What is straight in a chart is not on the surface, and is not as long: that is the way's own error, at any number of
 * texels. With `metric` each texel's step asks the chart for its first fundamental form, and goes as far and in the
 * direction on the surface that a straightest walk would, as near as texels can tell.
 */
#ifndef MESO_TEXTURE_MARCH_H
#define MESO_TEXTURE_MARCH_H

#include "libcore/growth/march/chart_walk.h"

/* From chart to chart. Both tips are those of one march: where it leaves, and where it goes on. */
typedef struct MesoTextureJump {
    uint32_t walk;
    MesoTip from, to;
} MesoTextureJump;

typedef struct MesoTextureMarch {
    const MesoTriangulation *mesh;
    const MesoWalkGround *ground;       /* of that mesh */
    const MesoGeometryImage *image;     /* of that mesh */
    uint32_t neighbourhood;     /* texels around the last one in which pointers are looked for; 0: 2 */
    bool snaps;                 /* steps and jumps end in the middle of texels, as the paper's: steps of some texels */
    bool metric;
    void (*jump)(void *context, const MesoTextureJump *jump);   /* NULL: jumps are not told */
    void *context;
} MesoTextureMarch;

/*
 * Marches all of them to their ends: meso_walks() by another way, with the same promises but that of straightness.
 * Where no pointer is near, a march goes over the seam where it stands: none is lost. Pieces of a march follow each
 * other, but for a gap of some texels at each seam. `march` is a MesoTextureMarch. O(texels + triangles on the way).
 */
void meso_texture_walks(const void *march, MesoWalk *walks, uint32_t count, const MesoWalkOptions *options);

#endif
