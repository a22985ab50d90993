/* Cameras, and the one that frames a scene. */
#ifndef MESO_CAMERA_H
#define MESO_CAMERA_H

#include "libcore/render/projection.h"
#include "libcore/scene/scene.h"

/*
 * A camera that frames the box from the front, a little from the right and
 * above, with a margin of 5 %. The front is +Z, or -Y where `up` is along Z.
 * `aspect` is width / height.
 */
MesoCamera meso_camera_frame(MesoVec3 low, MesoVec3 high, MesoVec3 up, float fov_degrees, float aspect);

/* The same, around the sweeps, cages and bodies themselves. O(sweeps + vertices). */
MesoCamera meso_camera_frame_scene(const MesoScene *scene, MesoVec3 up, float fov_degrees, float aspect);

/* The same, orthographic and as high as it takes. */
MesoCamera meso_camera_frame_scene_parallel(const MesoScene *scene, MesoVec3 up, float aspect);

/* How high an orthographic picture around the camera's target is that shows the whole scene, with the margin. */
float meso_camera_fit_height(const MesoScene *scene, const MesoCamera *camera, float aspect);

/* The vertical field of view, in degrees, of a lens before a sensor as wide as the picture, both in mm. */
float meso_camera_fov(float focal, float sensor, float aspect);

#endif
