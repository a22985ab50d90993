#include "libcore/tiling/strand/model.h"

#include <string.h>

const char *const meso_section_size_names[] = {"scene", "slot", NULL};
const char *const meso_bends_names[] = {"mitred", "drawn", NULL};
const char *const meso_tolerance_unit_names[] = {"edge", "scene", NULL};

static float positive_or(float value, float otherwise)
{
    return value > 0 ? value : otherwise;
}

static bool within(float value, float low, float high)
{
    return value >= low && value <= high;
}

const char *meso_map_options_problem(const MesoMapOptions *options)
{
    const float shortest = MESO_SHORTEST_EDGE, longest = 4 * MESO_COORDINATE_LIMIT;
    if (!within(options->thickness, shortest, longest))
        return "thickness";
    if (!within(options->offset, -longest, longest))
        return "offset";
    if (!within(options->section_scale, shortest, longest))
        return "section scale";
    if (!within(options->tangent_scale, 1e-6f, 1e3f))
        return "tangent scale";
    if (!within(options->section_step, 1e-4f, 1))
        return "section step";
    if (options->divisions < 2 || options->divisions > 4096)
        return "number of divisions";
    if (options->frame > MESO_FRAME_MINIMAL)
        return "frame";
    if (options->bends > MESO_BENDS_DRAWN)
        return "bends";
    if (options->normals > MESO_NORMALS_FLAT || options->side > MESO_SHELL_INSIDE || options->limit_folds > 1)
        return "form of the shell";
    if (options->section_size > MESO_SECTION_SLOT)
        return "section size";
    if (options->deform > MESO_SWEEP_SHAPE)
        return "deformation";
    if (!within(options->tolerance, 0, longest) || options->tolerance_in > MESO_TOLERANCE_SCENE)
        return "tolerance";
    if (options->relax > MESO_RELAX_MOST)
        return "number of steps of relaxation";
    return NULL;
}

bool meso_map_options_same_form(const MesoMapOptions *a, const MesoMapOptions *b)
{
    MesoMapOptions x = *a;
    x.section_step = b->section_step;
    x.divisions = b->divisions;
    x.tolerance = b->tolerance;
    x.tolerance_in = b->tolerance_in;
    return memcmp(&x, b, sizeof x) == 0;
}

float meso_map_options_tolerance(const MesoMapOptions *options, float mean_edge_length)
{
    float edge = positive_or(mean_edge_length, 1);
    if (!(options->tolerance > 0))
        return 0;
    float in_edges = options->tolerance / (options->tolerance_in == MESO_TOLERANCE_SCENE ? edge : 1);
    return edge * fminf(fmaxf(in_edges, MESO_TOLERANCE_LEAST), MESO_TOLERANCE_MOST);
}

MesoMapOptions meso_map_options_resolve(MesoMapOptions options, float mean_edge_length)
{
    /* All vertices in one point: any length will do, but not 0, which stands for the default. */
    float edge = positive_or(mean_edge_length, 1);
    options.thickness = positive_or(options.thickness, edge);
    options.section_scale = positive_or(options.section_scale, edge);
    options.tangent_scale = positive_or(options.tangent_scale, 1);
    options.section_step = positive_or(options.section_step, 0.02f);
    if (options.divisions == 0)
        options.divisions = 12;
    if (options.divisions < 2)
        options.divisions = 2;
    return options;
}

MesoStatus meso_model_shell(MesoShell *shell, MesoArena *arena, const MesoModel *model, MesoError *error)
{
    MesoMapOptions o = meso_map_options_resolve(model->options, model->surface.mean_edge_length);
    const MesoShellForm form = {.offset = o.offset, .thickness = o.thickness, .normals = o.normals, .side = o.side,
                                .factors = model->factors, .lifts = model->lifts, .limit_folds = o.limit_folds,
                                .shared = o.deform == MESO_SWEEP_SHAPE};
    return meso_shell_build(shell, arena, &model->surface, &model->graph, &form, error);
}
