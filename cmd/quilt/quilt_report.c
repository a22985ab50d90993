#include "cmd/quilt/quilt_report.h"

#include "formats/json/json_text.h"
#include "libcore/mesh/half_edges.h"

/* ---- growth ---- */

static void put_counts(json_t *object, const MesoQuilt *quilt)
{
    const MesoQuiltReport *r = &quilt->report;
    const struct {
        const char *key;
        uint64_t count;
    } counts[] = {
        {"elements", quilt->element_count}, {"vertices", quilt->vertex_count}, {"triangles", quilt->triangle_count},
        {"patches", r->patch_count}, {"correspondences", r->correspondence_count}, {"joins", r->join_count},
        {"welded_patches", r->weld_count},
        {"caps", r->cap_count}, {"open_sections", r->open_count}, {"retries", r->retry_count},
        {"shrunk_patches", r->shrunk_count}, {"removed_elements", r->removed_count},
        {"skipped_triangles", r->skipped_count}, {"border_sections", r->border_count},
        {"border_removed_elements", r->border_removed_count}, {"closed_loops", r->closed_count},
        {"debris", r->debris_count}, {"settled_elements", r->settled_count}, {"added_elements", r->added_count},
    };
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        json_object_set_new(object, counts[i].key, json_integer((json_int_t)counts[i].count));
}

/* ---- elements and edges ---- */

typedef struct Elements {
    uint32_t whole;         /* closed ones, with all the triangles that theirs has in the swatch */
    uint32_t broken;        /* closed ones without */
    uint32_t strands;
    uint32_t merged;        /* strands that several of the swatch's have become */
} Elements;

/* The element of each of the swatch's triangles; NULL where memory is out. */
static uint32_t *name_triangles(const MesoSwatch *swatch, MesoArena *scratch, MesoError *error)
{
    uint32_t *elements = MESO_NEW(scratch, uint32_t, swatch->triangle_count, error);
    for (uint32_t e = 0; elements && e < swatch->element_count; e++)
        for (uint32_t t = swatch->triangle_begin[e]; t < swatch->triangle_begin[e + 1]; t++)
            elements[t] = e;
    return elements;
}

static Elements count_elements(const MesoQuilt *quilt, const MesoSwatch *swatch, const uint32_t *swatch_elements)
{
    Elements count = {0};
    for (uint32_t e = 0; e < quilt->element_count; e++) {
        uint32_t begin = quilt->triangle_begin[e], end = quilt->triangle_begin[e + 1];
        uint32_t origin = quilt->element_origins[e], t = begin;
        if (swatch->kinds[origin] == MESO_ELEMENT_WHOLE) {
            bool all = end - begin == swatch->triangle_begin[origin + 1] - swatch->triangle_begin[origin];
            count.whole += all;
            count.broken += !all;
            continue;
        }
        while (t < end && swatch_elements[quilt->triangle_origins[t]] == origin)
            t++;
        count.strands++;
        count.merged += t < end;
    }
    return count;
}

/* Every loop of open edges is closed at the end, those that the swatch has too: what is open here it did not have. */
static MesoStatus count_open_edges(uint32_t *count, const MesoQuilt *quilt, MesoTool *tool, MesoArena *scratch)
{
    MesoHalfEdges joined;
    const MesoPolygonMesh mesh = {.vertex_count = quilt->vertex_count, .face_count = quilt->triangle_count,
                                  .corner_count = 3 * quilt->triangle_count, .side_count = 3,
                                  .corners = quilt->corners};
    MesoStatus status = meso_half_edges_join(&joined, scratch, &mesh, tool->threads, &tool->error);
    *count = status ? 0 : joined.border_count;
    return status;
}

static MesoStatus put_elements(json_t *object, MesoTool *tool, const MesoQuilt *quilt, const MesoSwatch *swatch)
{
    MesoArena scratch;
    uint32_t open_edges;
    meso_arena_init(&scratch);
    uint32_t *names = name_triangles(swatch, &scratch, &tool->error);
    MesoStatus status = names ? count_open_edges(&open_edges, quilt, tool, &scratch) : MESO_ERR_MEMORY;
    if (!status) {
        Elements count = count_elements(quilt, swatch, names);
        json_object_set_new(object, "whole_elements", json_integer(count.whole));
        json_object_set_new(object, "broken_elements", json_integer(count.broken));
        json_object_set_new(object, "strands", json_integer(count.strands));
        json_object_set_new(object, "merged_strands", json_integer(count.merged));
        json_object_set_new(object, "open_edges", json_integer(open_edges));
    }
    meso_arena_release(&scratch);
    return status;
}

/* ---- the layer ---- */

static void put_stretch(json_t *object, const char *key, double before, double after)
{
    json_t *pair = json_object();
    json_object_set_new(pair, "before", meso_json_shortest((float)before));
    json_object_set_new(pair, "after", meso_json_shortest((float)after));
    json_object_set_new(object, key, pair);
}

/* Nothing of stretch where there is no layer in one sense. */
static void put_lay(json_t *object, const MesoQuiltLay *lay)
{
    const MesoPrismReport *layer = &lay->layer;
    json_t *part = json_object();
    if (layer->stretch_after > 0) {
        put_stretch(part, "stretch", layer->stretch_before, layer->stretch_after);
        put_stretch(part, "stretch_inverse", layer->stretch_before_inverse, layer->stretch_after_inverse);
        json_object_set_new(part, "inverted_tetrahedra", json_integer(layer->inverted_count));
        json_object_set_new(part, "limited_vertices", json_integer(layer->limited_count));
        json_object_set_new(part, "least_limit", meso_json_shortest(layer->least_limit));
    }
    if (lay->chart_count) {
        json_object_set_new(part, "charts", json_integer(lay->chart_count));
        json_object_set_new(part, "chart_area_ratio", meso_json_shortest(lay->area_ratio));
        json_object_set_new(part, "elements_over_seams", json_integer(lay->seam_count));
        json_object_set_new(part, "flat_tetrahedra", json_integer(lay->flat_count));
        json_object_set_new(part, "plain_triangles", json_integer(lay->plain_count));
    }
    json_object_set_new(object, "layer", part);
}

static void put_seconds(json_t *object, const MesoQuiltReport *grown, const MesoQuiltTimes *t)
{
    const struct {
        const char *key;
        double seconds;
    } stages[] = {
        {"swatch", t->swatch}, {"surface", t->surface}, {"base", t->base}, {"growth", t->growth},
        {"charts", grown->seconds[0]}, {"matching", grown->seconds[1]}, {"seams", grown->seconds[2]},
        {"whole_elements", grown->seconds[3]}, {"strands", grown->seconds[4]}, {"rest", grown->seconds[5]},
        {"finish", t->finish}, {"settling", t->settling}, {"embedding", t->embedding},
    };
    json_t *seconds = json_object();
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++)
        json_object_set_new(seconds, stages[i].key, meso_json_shortest((float)stages[i].seconds));
    json_object_set_new(object, "seconds", seconds);
}

MesoStatus meso_quilt_report(MesoTool *tool, const MesoQuiltResult *result, const MesoSwatch *swatch, float scale)
{
    const MesoQuilt *quilt = &result->quilt;
    const MesoQuiltReport *r = &quilt->report;
    json_t *object = json_object();
    put_counts(object, quilt);
    MesoStatus status = put_elements(object, tool, quilt, swatch);
    json_object_set_new(object, "scale", meso_json_shortest(scale));
    json_object_set_new(object, "matching_cost", meso_json_shortest((float)r->matching_cost));
    json_object_set_new(object, "deformation_rms", meso_json_shortest((float)r->deformation_rms));
    json_object_set_new(object, "deformation_largest", meso_json_shortest((float)r->deformation_largest));
    put_lay(object, &result->lay);
    if (tool->verbose)
        put_seconds(object, r, &result->times);
    json_object_set_new(tool->report, "quilt", object);
    if (tool->verbose)
        meso_tool_say(tool, "%u patches, %u elements, %u triangles; %u joins, %u caps, %u elements removed",
                      r->patch_count, quilt->element_count, quilt->triangle_count, r->join_count, r->cap_count,
                      r->removed_count);
    if (tool->verbose && result->lay.layer.stretch_after > 0)
        meso_tool_say(tool, "stretch %.3f before, %.3f after; %u vertices have a lower layer",
                      result->lay.layer.stretch_before, result->lay.layer.stretch_after,
                      result->lay.layer.limited_count);
    return status;
}
