/* Sources of maps, fields and places, one at a time. Inside of grow_contexts.c. */
#ifndef MESO_GROW_SOURCES_H
#define MESO_GROW_SOURCES_H

#include "cmd/common/tool.h"
#include "formats/image/picture.h"
#include "libcore/growth/ground/growth_seeds.h"
#include "libcore/mesh/polygon_mesh.h"

/* A picture that was read once. */
typedef struct MesoGrowPicture {
    const char *file;
    MesoPicture picture;
} MesoGrowPicture;

typedef struct MesoGrowSources {
    MesoTool *tool;
    const MesoGrammar *grammar;
    const MesoPolygonMesh *polygons;
    const MesoGrowthGround *ground;
    const char *folder;
    const char *what;               /* for messages: "map 'wall'" */
    const MesoGrammarSource *source;    /* in hand */
    MesoVec2 *uvs;                  /* [3 * triangle_count] once an image has asked for them */
    MesoGrowPicture *pictures;      /* [picture_count] */
    uint32_t picture_count, picture_room;
    MesoVec3 *principal[2];         /* [triangle_count] of the largest and the least curvature, once asked for */
} MesoGrowSources;

/* "GRAMMAR:LINE: map 'wall': ...", of the source in hand. */
MesoStatus meso_grow_source_fail(const MesoGrowSources *sources, MesoStatus status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Where a file that the grammar names lies; NULL where memory is out. */
const char *meso_grow_source_path(const MesoGrowSources *sources, const char *file);

/* Opens one; the caller closes it. */
MesoStatus meso_grow_source_open(const MesoGrowSources *sources, MesoInput *input, const char *file, const char *role);

/* Each fills a map from the source in hand. Errors as of meso_grow_contexts(). */
MesoStatus meso_grow_map_image(MesoGrowSources *sources, MesoGrowthMap *map);
MesoStatus meso_grow_map_attribute(MesoGrowSources *sources, MesoGrowthMap *map);
MesoStatus meso_grow_map_region(MesoGrowSources *sources, MesoGrowthMap *map);
MesoStatus meso_grow_map_distance(MesoGrowSources *sources, MesoGrowthMap *map);

/* [triangle_count] vectors of the attribute that the source in hand names. */
MesoStatus meso_grow_attribute_vectors(MesoGrowSources *sources, MesoVec3 **vectors);

/* Points of the file that the source in hand names, at `value`, on the surface; of curves with their breaks. */
typedef struct MesoGrowPoints {
    uint32_t count;
    MesoMeshPoint *points;          /* [count] */
    const MesoVec3 *corners;        /* [count] where they were in space */
    const uint8_t *breaks;          /* [count] NULL for points */
} MesoGrowPoints;

MesoStatus meso_grow_points(MesoGrowSources *sources, const char *file, bool curve, MesoGrowPoints *points);

#endif
