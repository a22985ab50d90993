/* The step info: what a mesh is like, and which steps would mend it. */
#include <math.h>
#include <stdio.h>

#include "cmd/mesh/mesh_steps.h"
#include "formats/json/json_text.h"
#include "libcore/mesh/edit/mesh_facts.h"

static json_t *number_or_null(double number)
{
    return isfinite(number) ? json_real(number) : json_null();
}

static json_t *point(MesoVec3 p)
{
    return json_pack("[fff]", (double)p.x, (double)p.y, (double)p.z);
}

static json_t *valences(const MesoMeshFacts *facts)
{
    json_t *object = json_object();
    for (uint32_t i = 1; i <= MESO_MOST_VALENCE && object; i++) {
        char name[16];
        snprintf(name, sizeof name, "%u%s", i, i == MESO_MOST_VALENCE ? "+" : "");
        if (facts->valences[i] && json_object_set_new(object, name, json_integer(facts->valences[i])) != 0) {
            json_decref(object);
            return NULL;
        }
    }
    return object;
}

static json_t *attributes(const MesoPolygonMesh *mesh)
{
    static const char *const domains[] = {[MESO_ON_VERTICES] = "vertices", [MESO_ON_FACES] = "faces",
                                          [MESO_ON_CORNERS] = "corners"};
    json_t *list = json_array();
    int failed = list == NULL;
    for (uint32_t i = 0; i < mesh->attribute_count && !failed; i++) {
        const MesoAttribute *a = &mesh->attributes[i];
        json_t *item = json_pack("{sosssIsI}", "name", meso_json_string(a->name), "on", domains[a->domain], "numbers",
                                 (json_int_t)a->width, "entries", (json_int_t)a->entry_count);
        failed = json_array_append_new(list, item);
    }
    if (!failed)
        return list;
    json_decref(list);
    return NULL;
}

/* ---- what would mend it ---- */

static bool is_inside_out(const MesoMeshFacts *facts)
{
    return isfinite(facts->volume) && facts->volume < 0;
}

/* In the order in which they are best done. */
static json_t *mending(const MesoMeshWork *work, const MesoMeshFacts *facts)
{
    char weld[40];
    snprintf(weld, sizeof weld, "weld=%.3g", facts->near_distance);
    const struct {
        bool wanted;
        const char *step;
    } steps[] = {
        {facts->near_borders > 0, weld},
        {facts->near_borders == 0 && facts->coinciding_borders > 0, "weld"},
        {work->looped > 0 || facts->flat_faces > 0 || facts->double_faces > 0 || facts->valences[0] > 0, "clean"},
        {facts->crowded_edges > 0 || facts->pinched_vertices > 0, "separate"},
        {(facts->disagreeing_edges > 0 && facts->orientable) || is_inside_out(facts), "orient"},
        {facts->triangles > 0 || facts->larger > 0, "quads"},
    };
    json_t *list = json_array();
    int failed = list == NULL;
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++)
        if (steps[i].wanted)
            failed |= json_array_append_new(list, json_string(steps[i].step));
    if (!failed)
        return list;
    json_decref(list);
    return NULL;
}

/* ---- all together ---- */

/* Sets numbers of `facts` under their names; not 0 where memory is out. */
static int set_counts(json_t *info, const MesoMeshWork *work, const MesoMeshFacts *facts)
{
    const MesoPolygonMesh *mesh = &work->mesh;
    const struct {
        const char *name;
        uint32_t count;
    } counts[] = {
        {"vertices", mesh->vertex_count}, {"edges", facts->edge_count}, {"faces", mesh->face_count},
        {"triangles", facts->triangles}, {"quads", facts->quads}, {"larger_faces", facts->larger},
        {"most_sides", facts->most_sides}, {"components", facts->components},
        {"border_edges", facts->border_edges}, {"border_loops", facts->border_loops},
        {"disagreeing_edges", facts->disagreeing_edges}, {"crowded_edges", facts->crowded_edges},
        {"pinched_vertices", facts->pinched_vertices}, {"coinciding_vertices", facts->coinciding_vertices},
        {"near_vertices", facts->near_vertices}, {"unused_vertices", facts->valences[0]},
        {"looped_faces", work->looped}, {"flat_faces", facts->flat_faces}, {"double_faces", facts->double_faces},
    };
    int failed = 0;
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        failed |= json_object_set_new(info, counts[i].name, json_integer(counts[i].count));
    return failed;
}

static json_t *describe(const MesoMeshWork *work, const MesoMeshFacts *facts)
{
    json_t *info = json_object();
    int failed = set_counts(info, work, facts);
    failed |= json_object_set_new(info, "near_distance", json_real(facts->near_distance));
    failed |= json_object_set_new(info, "closed", json_boolean(facts->closed));
    failed |= json_object_set_new(info, "orientable", json_boolean(facts->orientable));
    failed |= json_object_set_new(info, "inside_out", json_boolean(is_inside_out(facts)));
    failed |= json_object_set_new(info, "euler", json_integer(facts->euler));
    failed |= json_object_set_new(info, "genus", facts->has_genus ? json_integer(facts->genus) : json_null());
    failed |= json_object_set_new(info, "valences", valences(facts));
    failed |= json_object_set_new(info, "edge_lengths", json_pack("{sfsfsf}", "shortest", facts->shortest_edge, "mean",
                                                                  facts->mean_edge, "longest", facts->longest_edge));
    failed |= json_object_set_new(info, "low", point(facts->low));
    failed |= json_object_set_new(info, "high", point(facts->high));
    failed |= json_object_set_new(info, "area", json_real(facts->area));
    failed |= json_object_set_new(info, "volume", number_or_null(facts->volume));
    failed |= json_object_set_new(info, "attributes", attributes(&work->mesh));
    failed |= json_object_set_new(info, "mend", mending(work, facts));
    if (!failed)
        return info;
    json_decref(info);
    return NULL;
}

MesoStatus meso_mesh_run_info(const MesoMeshStep *step, MesoMeshWork *work, MesoPolygonMesh *result)
{
    MesoMeshFacts facts;
    MesoTool *tool = work->tool;
    (void)step;
    *result = work->mesh;
    MesoStatus status = meso_mesh_find_facts(&facts, &work->mesh, tool->threads, &tool->error);
    if (status)
        return status;
    json_t *info = describe(work, &facts);
    if (!info)
        return meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the facts of the mesh");
    if (!tool->json)
        status = meso_json_write_file(info, NULL, &tool->error);
    if (json_array_append_new(work->infos, info) != 0 && !status)
        status = meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the report");
    return status;
}
