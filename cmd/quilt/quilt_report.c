#include "cmd/quilt/quilt_report.h"

#include "formats/json/json_text.h"

static void put_counts(json_t *object, const MesoQuilt *quilt)
{
    const MesoQuiltReport *r = &quilt->report;
    const struct {
        const char *key;
        uint64_t count;
    } counts[] = {
        {"elements", quilt->element_count}, {"vertices", quilt->vertex_count}, {"triangles", quilt->triangle_count},
        {"patches", r->patch_count}, {"correspondences", r->correspondence_count}, {"joins", r->join_count},
        {"caps", r->cap_count}, {"open_sections", r->open_count}, {"retries", r->retry_count},
        {"shrunk_patches", r->shrunk_count}, {"removed_elements", r->removed_count},
        {"skipped_triangles", r->skipped_count}, {"border_sections", r->border_count},
        {"border_removed_elements", r->border_removed_count}, {"closed_loops", r->closed_count},
        {"debris", r->debris_count}, {"settled_elements", r->settled_count}, {"added_elements", r->added_count},
    };
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        json_object_set_new(object, counts[i].key, json_integer((json_int_t)counts[i].count));
}

static void put_seconds(json_t *object, const MesoQuiltReport *report)
{
    static const char *const stages[] = {"charts", "matching", "seams", "whole_elements", "strands", "rest"};
    json_t *seconds = json_object();
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++)
        json_object_set_new(seconds, stages[i], meso_json_shortest((float)report->seconds[i]));
    json_object_set_new(object, "seconds", seconds);
}

void meso_quilt_report(MesoTool *tool, const MesoQuilt *quilt, float scale)
{
    const MesoQuiltReport *r = &quilt->report;
    json_t *object = json_object();
    put_counts(object, quilt);
    json_object_set_new(object, "scale", meso_json_shortest(scale));
    json_object_set_new(object, "matching_cost", meso_json_shortest((float)r->matching_cost));
    json_object_set_new(object, "deformation_rms", meso_json_shortest((float)r->deformation_rms));
    json_object_set_new(object, "deformation_largest", meso_json_shortest((float)r->deformation_largest));
    if (tool->verbose)
        put_seconds(object, r);
    json_object_set_new(tool->report, "quilt", object);
    if (tool->verbose)
        meso_tool_say(tool, "%u patches, %u elements, %u triangles; %u joins, %u caps, %u elements removed",
                      r->patch_count, quilt->element_count, quilt->triangle_count, r->join_count, r->cap_count,
                      r->removed_count);
}
