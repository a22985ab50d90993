#include "cmd/info/info_replicate.h"

#include <string.h>

#include "cmd/common/mesh_path.h"
#include "formats/json/json_text.h"
#include "formats/replicate/deform_file.h"
#include "formats/replicate/details_file.h"
#include "formats/replicate/replica_file.h"

static int put_count(json_t *object, const char *key, uint64_t count)
{
    return json_object_set_new(object, key, json_integer((json_int_t)count));
}

static MesoStatus finish(int failed, MesoError *error)
{
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory") : MESO_OK;
}

/* ---- details ---- */

enum { MOST_FILES = 64 };

/* Files of points, beside the file of details. */
typedef struct Files {
    MesoArena *arena;
    const char *details;
    MesoInput inputs[MOST_FILES];
    uint32_t count;
} Files;

static const MesoInput *open_file(void *context, const char *name, MesoError *error)
{
    Files *files = context;
    int folder = meso_folder_length(files->details);
    const char *path = *name == '/' ? name
        : meso_arena_print(files->arena, error, "%.*s%s", folder, files->details, name);
    if (path && files->count == MOST_FILES)
        meso_fail(error, MESO_ERR_LIMIT, "over %d files", MOST_FILES);
    else if (path && meso_input_open(&files->inputs[files->count], path, error) == MESO_OK)
        return &files->inputs[files->count++];
    return NULL;
}

static int put_kinds(json_t *facts, const MesoDetailsFile *file)
{
    static const char *const geometries[] = {"mesh", "bump", "hole"};
    json_t *kinds = json_array();
    int failed = 0;
    for (uint32_t i = 0; i < file->kind_count; i++) {
        json_t *kind = json_object();
        failed |= json_object_set_new(kind, "name", meso_json_string(file->kinds[i].name));
        failed |= json_object_set_new(kind, "geometry", json_string(geometries[file->kinds[i].geometry]));
        if (*file->kinds[i].file)
            failed |= json_object_set_new(kind, "file", meso_json_string(file->kinds[i].file));
        failed |= json_array_append_new(kinds, kind);
    }
    return failed | json_object_set_new(facts, "kinds", kinds);
}

static int put_distributions(json_t *facts, const MesoDetailsFile *file)
{
    static const char *const sources[] = {"points", "poisson", "scene"};
    json_t *list = json_array();
    int failed = 0;
    for (uint32_t i = 0; i < file->distribution_count; i++) {
        const MesoDetailDistribution *d = &file->distributions[i];
        json_t *object = json_object();
        failed |= json_object_set_new(object, "source", json_string(sources[d->source]));
        if (d->source == MESO_DETAILS_AT_POINTS)
            failed |= put_count(object, "points", d->point_count);
        failed |= json_array_append_new(list, object);
    }
    return failed | json_object_set_new(facts, "details", list);
}

static MesoStatus put_details(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    Files opened = {.arena = arena, .details = input->path};
    const MesoJsonFiles files = {&opened, open_file};
    MesoDetailsFile file;
    MesoStatus status = meso_details_read(&file, arena, input, &files, error);
    if (!status) {
        int failed = json_object_set_new(facts, "kind", json_string("details"));
        failed |= put_count(facts, "materials", file.material_count);
        failed |= put_kinds(facts, &file);
        status = finish(failed | put_distributions(facts, &file), error);
    }
    for (uint32_t i = 0; i < opened.count; i++)
        meso_input_close(&opened.inputs[i]);
    return status;
}

/* ---- deformations ---- */

static MesoStatus put_deform(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    static const MesoVec3 box[] = {{0, 0, 0}, {1, 1, 1}};   /* what is not said goes by the mesh, which is not here */
    MesoDeformFile file;
    json_t *steps = json_array();
    MesoStatus status = meso_deform_read(&file, arena, input, box, 2, error);
    int failed = status ? 0 : json_object_set_new(facts, "kind", json_string("deform"));
    for (uint32_t i = 0; i < file.step_count && !status; i++)
        failed |= json_array_append_new(steps, json_string(meso_deform_names[file.steps[i].kind]));
    failed |= json_object_set_new(facts, "steps", steps);
    return status ? status : finish(failed, error);
}

/* ---- reports ---- */

static MesoStatus put_replication(json_t *facts, const json_t *root, MesoError *error)
{
    int failed = json_object_set_new(facts, "kind", json_string("replication"));
    failed |= json_object_set(facts, "provenance", json_object_get(root, "provenance"));
    failed |= json_object_set(facts, "mode", json_object_get(root, "mode"));
    failed |= put_count(facts, "frames", json_array_size(json_object_get(root, "frames")));
    failed |= put_count(facts, "details", json_array_size(json_object_get(root, "details")));
    return finish(failed, error);
}

bool meso_info_replicate(json_t *facts, MesoArena *arena, const char *format, const json_t *root,
                         const MesoInput *input, MesoStatus *status, MesoError *error)
{
    if (strcmp(format, "meso-details") == 0)
        *status = put_details(facts, arena, input, error);
    else if (strcmp(format, "meso-deform") == 0)
        *status = put_deform(facts, arena, input, error);
    else if (strcmp(format, "meso-replication") == 0)
        *status = put_replication(facts, root, error);
    else
        return false;
    return true;
}

/* ---- states and plans ---- */

static int put_shared(json_t *facts, const MesoInput *input, const MesoReplicaSettings *settings,
                      const MesoDetail *details, uint32_t count)
{
    static const char *const modes[] = {"plan", "play", "paper"};
    json_t *provenance = NULL;
    uint32_t originals = 0;
    for (uint32_t i = 0; i < count; i++)
        originals += details[i].born == MESO_DETAIL_ORIGINAL;
    meso_provenance_find(&provenance, input, NULL);
    int failed = json_object_set_new(facts, "provenance", provenance);
    failed |= json_object_set_new(facts, "mode", json_string(modes[settings->mode % 3]));
    failed |= put_count(facts, "seed", settings->seed);
    failed |= put_count(facts, "originals", originals);
    return failed | put_count(facts, "details", count);
}

MesoStatus meso_info_state(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoReplicaStateFile file;
    MesoStatus status = meso_replica_state_read(&file, arena, input, error);
    if (status)
        return status;
    int failed = json_object_set_new(facts, "kind", json_string("state"));
    failed |= put_shared(facts, input, &file.settings, file.state.details, file.state.detail_count);
    failed |= put_count(facts, "frames", file.history_count);
    return finish(failed | put_count(facts, "last_frame", (uint64_t)file.history[file.history_count - 1]), error);
}

MesoStatus meso_info_plan(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoReplicaPlanFile file;
    MesoStatus status = meso_replica_plan_read(&file, arena, input, error);
    if (status)
        return status;
    int failed = json_object_set_new(facts, "kind", json_string("plan"));
    failed |= put_shared(facts, input, &file.settings, file.plan.details, file.plan.detail_count);
    return finish(failed | put_count(facts, "pairs", file.plan.pair_begin[file.plan.detail_count]), error);
}
