#include "libcore/check/inspection.h"

#include "libcore/check/inspect_work.h"

enum { MOST_TRIANGLES = 1 << 30 };

/* Half of a float's last place, and as much again for what it was computed from. */
#define ROUNDING 1.2e-7

const char *const MESO_FAULT_NAMES[MESO_FAULT_COUNT] = {
    [MESO_FAULT_GAP] = "gap", [MESO_FAULT_ANGLE] = "angle", [MESO_FAULT_OPEN] = "open", [MESO_FAULT_BORDER] = "border",
    [MESO_FAULT_LID] = "lid", [MESO_FAULT_LEAK] = "leak", [MESO_FAULT_T_JOINT] = "t-joint",
    [MESO_FAULT_WINDING] = "winding", [MESO_FAULT_INVERTED] = "inverted", [MESO_FAULT_PINCH] = "pinch",
    [MESO_FAULT_NORMAL] = "normal", [MESO_FAULT_INSIDE_OUT] = "inside-out", [MESO_FAULT_NUMBER] = "number",
    [MESO_FAULT_FLAT] = "flat", [MESO_FAULT_DOUBLE] = "double", [MESO_FAULT_BRANCH] = "branch",
    [MESO_FAULT_EDGE] = "edge", [MESO_FAULT_VERTEX] = "vertex", [MESO_FAULT_FOLD] = "fold",
    [MESO_FAULT_CROSSING] = "crossing", [MESO_FAULT_SELF_CROSSING] = "self-crossing", [MESO_FAULT_THIN] = "thin",
    [MESO_FAULT_FLOATING] = "floating"};

static MesoStatus run(MesoInspectWork *work, MesoError *error)
{
    MesoStatus status = meso_inspect_places(work, error);
    if (!status)
        status = meso_inspect_edges(work, error);
    if (!status)
        status = meso_inspect_pieces(work, error);
    if (!status)
        status = meso_inspect_normals(work, error);
    if (!status)
        status = meso_inspect_solids(work, error);
    if (!status)
        status = meso_inspect_rings(work, error);
    if (!status)
        status = meso_inspect_folds(work, error);
    if (!status)
        status = meso_inspect_floats(work, error);
    return status;
}

static double largest_coordinate(const MesoBox *box)
{
    double x = fmax(fabs((double)box->low.x), fabs((double)box->high.x));
    double y = fmax(fabs((double)box->low.y), fabs((double)box->high.y));
    double z = fmax(fabs((double)box->low.z), fabs((double)box->high.z));
    return fmax(x, fmax(y, z));
}

static MesoStatus look_into_space(MesoInspectWork *work, MesoError *error)
{
    if (!work->options->crossings && !work->options->thickness)
        return MESO_OK;
    work->rounding = ROUNDING * largest_coordinate(&work->result->box);
    MesoStatus status = meso_inspect_triangle_tree(work, error);
    if (!status && work->options->crossings)
        status = meso_inspect_crossings(work, error);
    if (!status && work->options->thickness)
        status = meso_inspect_thickness(work, error);
    return status;
}

MesoStatus meso_inspect(MesoInspection *inspection, MesoArena *arena, const MesoInspectedMesh *mesh,
                        const MesoInspectionOptions *options, MesoError *error)
{
    MesoArena scratch;
    if (mesh->triangle_count > MOST_TRIANGLES)
        return meso_fail(error, MESO_ERR_LIMIT, "%u triangles; at most %d are checked at a time", mesh->triangle_count,
                         MOST_TRIANGLES);
    *inspection = (MesoInspection){0};
    for (uint32_t f = 0; f < MESO_FAULT_COUNT; f++)
        inspection->findings[f].triangle = inspection->findings[f].cage = MESO_NO_INDEX;
    inspection->marks = MESO_NEW(arena, uint32_t, mesh->triangle_count, error);
    if (!inspection->marks)
        return MESO_ERR_MEMORY;
    meso_arena_init(&scratch);
    MesoInspectWork work = {.mesh = mesh, .options = options, .arena = arena, .scratch = &scratch,
                            .result = inspection};
    MesoStatus status = run(&work, error);
    if (!status)
        status = look_into_space(&work, error);
    inspection->vertex_count = work.place_count;
    meso_arena_release(&scratch);
    return status;
}

MesoVec3 meso_inspected_middle(const MesoInspectedMesh *mesh, uint32_t triangle)
{
    MesoVec3d sum = {0, 0, 0};
    for (uint32_t k = 0; k < 3; k++)
        sum = meso_vec3d_mad(sum, 1.0 / 3, meso_vec3d(meso_inspect_corner(mesh, 3 * triangle + k)));
    return meso_vec3d_narrow(sum);
}
