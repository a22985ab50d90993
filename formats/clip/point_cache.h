/*
 * Caches of moving vertices, as animation programs exchange them, without connectivity: PC2 (Blender, 3ds Max) and MDD
 * (LightWave, Blender).
 *
 *     PC2     "POINTCACHE2\0", i32 version 1, i32 points, f32 first frame, f32 frames a sample, i32 samples, then
 *             x y z of each point, sample by sample; little-endian
 *     MDD     i32 frames, i32 points, f32 seconds of each frame, then x y z of each point, frame by frame; big-endian
 */
#ifndef MESO_POINT_CACHE_H
#define MESO_POINT_CACHE_H

#include "formats/file/input.h"
#include "libcore/math/vec.h"

typedef enum MesoPointCacheKind {
    MESO_CACHE_PC2, MESO_CACHE_MDD
} MesoPointCacheKind;

typedef struct MesoPointCache {
    const MesoInput *input;     /* must stay open */
    MesoPointCacheKind kind;
    uint32_t frame_count, point_count;
    float start, rate;          /* of PC2: the first frame's number, and the next one's distance from it */
} MesoPointCache;

/* Whether the bytes begin as a PC2 does; an MDD has no mark. */
bool meso_point_cache_is_pc2(const MesoInput *input);

/*
 * Reads what stands before the points. MESO_ERR_INPUT where there are no frames or no points, and where the file is not
 * as long as it says. O(1).
 */
MesoStatus meso_point_cache_open(MesoPointCache *cache, const MesoInput *input, MesoPointCacheKind kind,
                                 MesoError *error);

/*
 * Positions of a frame, from 0. MESO_ERR_INPUT names the first point whose coordinates are not finite or beyond
 * MESO_COORDINATE_LIMIT, counted from 1 as vertices are. O(points).
 *
 * positions  [point_count]
 */
MesoStatus meso_point_cache_frame(const MesoPointCache *cache, uint32_t frame, MesoVec3 *positions, MesoError *error);

/* When a frame is shown: its number in a PC2, seconds in an MDD. */
double meso_point_cache_time(const MesoPointCache *cache, uint32_t frame);

#endif
