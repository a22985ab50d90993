#include "cmd/map/map_shell.h"

#include <stdio.h>
#include <string.h>

#include "formats/mesh/surface_number.h"

static uint32_t number_of(const char *const *names, const char *name)
{
    uint32_t number = 0;
    while (names[number] && strcmp(names[number], name) != 0)
        number++;
    return number;
}

void meso_map_shell_set(const MesoMapShell *shell, MesoMapOptions *options)
{
    if (shell->normals)
        options->normals = number_of(meso_shell_normals_names, shell->normals);
    if (shell->side)
        options->side = number_of(meso_shell_side_names, shell->side);
    options->limit_folds = shell->limit_folds;
}

MesoStatus meso_map_shell_heights(MesoTool *tool, const MesoMapShell *shell, const MesoPolygonMesh *mesh,
                                  const char *path, MesoModel *model)
{
    const MesoNumberWish factor = {shell->thickness_by, "thickness-by", 1, MESO_FACTOR_LEAST, MESO_FACTOR_MOST};
    const MesoNumberWish lift = {shell->offset_by, "offset-by", 0, -MESO_LIFT_MOST, MESO_LIFT_MOST};
    MesoStatus status = MESO_OK;
    if (factor.what)
        status = meso_surface_numbers(&model->factors, &tool->arena, mesh, &factor, path, &tool->error);
    if (!status && lift.what)
        status = meso_surface_numbers(&model->lifts, &tool->arena, mesh, &lift, path, &tool->error);
    return status;
}

MesoStatus meso_map_shell_judge(MesoTool *tool, const MesoModel *model)
{
    enum { NAMED = 5 };
    MesoShell shell;
    MesoArena scratch;
    uint32_t slots[NAMED], count = 0;
    char names[NAMED * 12 + 8] = "";
    size_t used = 0;
    meso_arena_init(&scratch);
    MesoStatus status = meso_model_shell(&shell, &scratch, model, &tool->error);
    if (!status)
        count = meso_shell_folds(&shell, slots, NAMED);
    meso_arena_release(&scratch);
    if (!status && json_object_set_new(tool->report, "folded_slots", json_integer(count)) != 0)
        status = meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the report");
    if (status || count == 0)
        return status;
    for (uint32_t i = 0; i < count && i < NAMED; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%u", i ? ", " : "", slots[i] + 1);
    meso_tool_say(tool, "warning: the shell folds at %u face%s (%s%s)%s", count, count == 1 ? "" : "s", names,
                  count > NAMED ? ", ..." : "",
                  model->options.limit_folds ? ", where the surface does" : "; --limit-folds lowers it there");
    return MESO_OK;
}
