/* Bodies that are written once, and where they are placed: EXT_mesh_gpu_instancing. */
#ifndef MESO_GLB_INSTANCES_H
#define MESO_GLB_INSTANCES_H

#include "libcore/scene/parts.h"

/* A place without bending: turned by a quaternion after it is stretched along the body's own axes, then moved. */
typedef struct MesoGlbPose {
    MesoVec3 translation;
    float rotation[4];
    MesoVec3 scale;
} MesoGlbPose;

/* Places of one body. */
typedef struct MesoGlbInstanceSet {
    uint32_t count;
    MesoGlbPose *poses;     /* [count] */
    uint32_t *rows;         /* [count] of the scene's ids */
} MesoGlbInstanceSet;

/*
 * A scene in which bodies that lie rigidly at two places or more are there once, in their own coordinates, behind all
 * other parts: part `first` + i stands for sets[i].
 */
typedef struct MesoGlbInstances {
    MesoScene scene;
    MesoSceneParts parts;
    uint32_t first, set_count;
    MesoGlbInstanceSet *sets;   /* [set_count] */
} MesoGlbInstances;

/* The pose of a placed body, where none of its vertices then lies farther off than a thousandth of its size, and
 * nothing is mirrored; false otherwise. O(1), by the corners of its box. */
bool meso_glb_pose(MesoGlbPose *pose, const MesoScene *scene, const MesoPlacedBody *placed, const MesoBox *box);

/* O(parts + vertices of bodies). MESO_ERR_MEMORY, or what meso_scene_parts_init() fails with. */
MesoStatus meso_glb_instances_find(MesoGlbInstances *instances, const MesoScene *scene, MesoArena *arena,
                                   MesoError *error);

#endif
