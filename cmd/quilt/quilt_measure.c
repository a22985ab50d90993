#include "cmd/quilt/quilt_measure.h"

#include "formats/json/json_text.h"

typedef struct Count {
    const char *key;
    uint64_t count;
} Count;

typedef struct Number {
    const char *key;
    double number;
} Number;

#define PUT(part, table) put_part(object, part, table, sizeof table / sizeof *table, NULL, 0)
#define PUT_BOTH(part, counts, numbers) \
    put_part(object, part, counts, sizeof counts / sizeof *counts, numbers, sizeof numbers / sizeof *numbers)

static void put_part(json_t *object, const char *name, const Count *counts, size_t count_count, const Number *numbers,
                     size_t number_count)
{
    json_t *part = json_object();
    for (size_t i = 0; i < count_count; i++)
        json_object_set_new(part, counts[i].key, json_integer((json_int_t)counts[i].count));
    for (size_t i = 0; i < number_count; i++)
        json_object_set_new(part, numbers[i].key, meso_json_shortest((float)numbers[i].number));
    json_object_set_new(object, name, part);
}

static void put_mesh(json_t *object, const MesoQuiltCheck *k)
{
    const MesoMeshFaults *f = &k->faults;
    const Count faults[] = {
        {"unplaced_vertices", f->unplaced_count}, {"open_edges", f->open_count}, {"crowded_edges", f->crowded_count},
        {"reversed_edges", f->reversed_count}, {"collapsed_triangles", f->collapsed_count},
        {"pinched_vertices", f->pinched_count},
    };
    const Count counts[] = {
        {"whole", k->whole_count}, {"changed", k->changed_count}, {"squeezed", k->squeezed_count},
        {"strands", k->strand_count}, {"merged", k->merged_count}, {"apart", k->apart_count},
    };
    const Number numbers[] = {
        {"whole_by_area", k->expected_whole_count}, {"least_volume", k->least_volume},
        {"largest_volume", k->largest_volume}, {"triangles_by_area", k->expected_triangle_count},
        {"area_share", k->area_share},
    };
    const Count sections[] = {{"compared", k->sections.count}, {"changed", k->sections.changed_count}};
    const Number areas[] = {{"least", k->sections.least}, {"largest", k->sections.largest}, {"rms", k->sections.rms}};
    PUT("mesh", faults);
    PUT_BOTH("elements", counts, numbers);
    PUT_BOTH("sections", sections, areas);
}

static void put_space(json_t *object, const MesoQuiltCheck *k)
{
    const Count crossings[] = {
        {"between_elements", k->crossings.between_count}, {"within_elements", k->crossings.within_count},
        {"of_one_patch", k->crossings.one_patch_count}, {"elements", k->crossings.element_count},
    };
    const Number expected[] = {{"of_the_swatch_by_area", k->expected_crossings}};
    const Count places[] = {{"places", k->cover.place_count}, {"empty", k->cover.empty_count}};
    const Number discs[] = {{"widest", k->cover.widest}, {"swatch_widest", k->cover.swatch_widest}};
    PUT_BOTH("crossings", crossings, expected);
    PUT_BOTH("cover", places, discs);
}

static void put_looks(json_t *object, const MesoQuiltCheck *k)
{
    const MesoLikeness *l = &k->likeness;
    const Count edges[] = {{"edges", k->seams.seam_edge_count}};
    const Number seams[] = {{"length_distance", k->seams.length_distance}, {"angle_distance", k->seams.angle_distance}};
    const Count windows[] = {{"windows", l->window_count}, {"laid_windows", l->laid_window_count},
                             {"swatch_windows", l->swatch_window_count}};
    const Number distances[] = {{"radius", l->radius}, {"distance", l->distance}, {"largest", l->largest_distance},
                                {"laid_distance", l->laid_distance}, {"swatch_distance", l->swatch_distance},
                                {"ratio", l->ratio}};
    PUT_BOTH("seams", edges, seams);
    PUT_BOTH("likeness", windows, distances);
}

static void say(const MesoTool *tool, const MesoQuiltCheck *k)
{
    const MesoMeshFaults *f = &k->faults;
    meso_tool_say(tool, "%u open edges, %u crowded, %u wound against each other, %u pinched vertices", f->open_count,
                  f->crowded_count, f->reversed_count, f->pinched_count);
    if (f->unplaced_count) {
        meso_tool_say(tool, "%u vertices are nowhere", f->unplaced_count);
        return;
    }
    if (k->whole_count)
        meso_tool_say(tool, "%u whole elements (%.0f by area): %u changed, %u squeezed, volumes %.3f to %.3f",
                      k->whole_count, k->expected_whole_count, k->changed_count, k->squeezed_count, k->least_volume,
                      k->largest_volume);
    if (k->sections.count)
        meso_tool_say(tool, "%u strands, %u of %u sections changed, areas %.3f to %.3f", k->strand_count,
                      k->sections.changed_count, k->sections.count, k->sections.least, k->sections.largest);
    meso_tool_say(tool, "%llu pairs of triangles cross between elements, %llu within; %.0f in as much of the swatch",
                  (unsigned long long)k->crossings.between_count, (unsigned long long)k->crossings.within_count,
                  k->expected_crossings);
    meso_tool_say(tool, "%u of %u places are empty", k->cover.empty_count, k->cover.place_count);
    if (k->likeness.window_count)
        meso_tool_say(tool, "%u windows are %.4f from the swatch, its own %.4f, and %.4f bent over the surface: %.2f",
                      k->likeness.window_count, k->likeness.distance, k->likeness.swatch_distance,
                      k->likeness.laid_distance, k->likeness.ratio);
}

MesoStatus meso_quilt_measure(MesoTool *tool, const MesoQuilt *quilt, const MesoSwatch *swatch,
                              const MesoVec3 *positions, const MesoTriangulation *base,
                              const MesoQuiltCheckOptions *options)
{
    MesoQuiltCheck check;
    MesoStatus status = meso_quilt_check(&check, &tool->arena, quilt, swatch, positions, base, options, &tool->error);
    if (status)
        return status;
    json_t *object = json_object();
    put_mesh(object, &check);
    put_space(object, &check);
    put_looks(object, &check);
    json_object_set_new(tool->report, "check", object);
    say(tool, &check);
    return MESO_OK;
}
