#include "cmd/common/scene_report.h"

#include <stdio.h>
#include <string.h>

/* "slots", "patches". */
static const char *plural_of(const char *name)
{
    size_t length = strlen(name);
    return length > 2 && strcmp(name + length - 2, "ch") == 0 ? "es" : "s";
}

void meso_scene_report_ids(json_t *report, const MesoScene *scene)
{
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        char key[MESO_CHANNEL_NAME + 3];
        snprintf(key, sizeof key, "%s%s", scene->channels[c].name, plural_of(scene->channels[c].name));
        if (!scene->channels[c].names)
            json_object_set_new(report, key, json_integer(scene->channels[c].count));
    }
}
