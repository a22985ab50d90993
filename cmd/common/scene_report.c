#include "cmd/common/scene_report.h"

#include <stdio.h>

void meso_scene_report_ids(json_t *report, const MesoScene *scene)
{
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        char key[MESO_CHANNEL_NAME + 2];
        snprintf(key, sizeof key, "%ss", scene->channels[c].name);
        if (!scene->channels[c].names)
            json_object_set_new(report, key, json_integer(scene->channels[c].count));
    }
}
