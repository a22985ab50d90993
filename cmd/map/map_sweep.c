#include "cmd/map/map_sweep.h"

#include <stdlib.h>
#include <string.h>

static uint32_t number_of(const char *const *names, const char *name)
{
    uint32_t number = 0;
    while (names[number] && strcmp(names[number], name) != 0)
        number++;
    return number;
}

/* A number of edge lengths, or of scene units with a 'u' behind. */
static bool read_tolerance(const char *text, MesoMapOptions *options)
{
    char *end;
    options->tolerance = strtof(text, &end);
    bool scene = *end == 'u', number = end != text && end[scene] == 0;
    options->tolerance_in = scene ? MESO_TOLERANCE_SCENE : MESO_TOLERANCE_EDGE;
    return number && options->tolerance >= (scene ? 1e-12f : MESO_TOLERANCE_LEAST) &&
           options->tolerance <= (scene ? 1e12f : MESO_TOLERANCE_MOST);
}

MesoStatus meso_map_sweep_set(const MesoMapSweep *sweep, bool steps, MesoMapOptions *options, MesoError *error)
{
    if (sweep->frame)
        options->frame = number_of(meso_frame_rule_names, sweep->frame);
    if (sweep->section_size)
        options->section_size = number_of(meso_section_size_names, sweep->section_size);
    if (sweep->deform)
        options->deform = number_of(meso_sweep_deform_names, sweep->deform);
    if (sweep->bends)
        options->bends = number_of(meso_bends_names, sweep->bends);
    if (options->deform == MESO_SWEEP_SHAPE && sweep->section_size)
        return meso_fail(error, MESO_ERR_USAGE, "--section-size is for sections that keep their shape; under "
                         "--deform shape they are as large as their slots make them");
    if (!sweep->tolerance)
        return MESO_OK;
    if (!read_tolerance(sweep->tolerance, options))
        return meso_fail(error, MESO_ERR_USAGE, "--tolerance '%s': a number from 1e-05 to 1, in edge lengths, is "
                         "needed, or one with 'u' behind, in scene units", sweep->tolerance);
    if (steps)
        return meso_fail(error, MESO_ERR_USAGE, "--tolerance chooses what --divisions and --section-step give: "
                         "give one or the other");
    return MESO_OK;
}
