#include "cmd/map/map_relax.h"

#include <inttypes.h>

#include "formats/json/json_text.h"

static json_t *pair(json_t *before, json_t *after)
{
    return json_pack("{s:o, s:o}", "before", before, "after", after);
}

MesoStatus meso_map_relax_report(MesoTool *tool, const MesoRelaxReport *relaxed)
{
    const uint64_t *met = relaxed->intersections;
    const float *mean = relaxed->bend_mean, *most = relaxed->bend_most;
    json_t *object = json_pack("{s:I, s:o, s:o, s:o, s:o}", "joints", (json_int_t)relaxed->joints, "intersections",
                               pair(json_integer((json_int_t)met[0]), json_integer((json_int_t)met[1])), "bend",
                               pair(meso_json_shortest(mean[0]), meso_json_shortest(mean[1])), "largest_bend",
                               pair(meso_json_shortest(most[0]), meso_json_shortest(most[1])), "largest_move",
                               meso_json_shortest(relaxed->move_most));
    if (json_object_set_new(tool->report, "relaxed", object) != 0)
        return meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the report");
    meso_tool_say(tool, "relaxed: %" PRIu64 " intersections, %" PRIu64 " before; bends of %.3g sections, %.3g before",
                  met[1], met[0], (double)mean[1], (double)mean[0]);
    return MESO_OK;
}
