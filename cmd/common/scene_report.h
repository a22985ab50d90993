/* What tools report about a scene. */
#ifndef MESO_SCENE_REPORT_H
#define MESO_SCENE_REPORT_H

#include <jansson.h>

#include "libcore/scene/scene.h"

/* How many ids each channel without names has: "slots" for "slot". */
void meso_scene_report_ids(json_t *report, const MesoScene *scene);

#endif
