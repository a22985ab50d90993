/* Options of meso-map about sweeps: their frames, the size and shape of their sections, their bends, a tolerance. */
#ifndef MESO_MAP_SWEEP_H
#define MESO_MAP_SWEEP_H

#include "cmd/common/tool.h"
#include "libcore/tiling/strand/model.h"

typedef struct MesoMapSweep {
    const char *frame, *section_size, *deform, *bends;     /* names of MesoFrameRule and the like; NULL: not given */
    const char *tolerance;              /* a number, and perhaps a unit */
    struct {
        bool frame, section_size, deform, bends, tolerance, relax;
    } given;
} MesoMapSweep;

#define MESO_MAP_SWEEP_OPTIONS(sweep)                                                                         \
    MESO_CHOICE(0, "frame", "RULE", "how sections turn along their sweeps (default paper)", &(sweep).frame,   \
                "paper|minimal", .given = &(sweep).given.frame, .more = MESO_OPTION_OVERRIDES),               \
    MESO_CHOICE(0, "section-size", "OF", "what --section-scale is for: the scene, or a slot of mean size "    \
                "(default scene)", &(sweep).section_size, "scene|slot", .given = &(sweep).given.section_size, \
                .more = MESO_OPTION_OVERRIDES),                                                               \
    MESO_CHOICE(0, "deform", "WHAT", "what follows the slots: trajectories alone, or sections, too (default curves)", \
                &(sweep).deform, "curves|shape", .given = &(sweep).given.deform, .more = MESO_OPTION_OVERRIDES), \
    MESO_CHOICE(0, "bends", "HOW", "tubes in bends narrower than they are: mitred, so that they do not fold back, or " \
                "as drawn (default mitred)", &(sweep).bends, "mitred|drawn", .given = &(sweep).given.bends,   \
                .more = MESO_OPTION_OVERRIDES),                                                               \
    MESO_TEXT(0, "tolerance", "X", "steps along and around so that the polygons stay so near to the surface, " \
              "in edge lengths, or with 'u' behind in scene units", &(sweep).tolerance,                       \
              .given = &(sweep).given.tolerance, .more = MESO_OPTION_OVERRIDES)

#define MESO_MAP_RELAX_OPTION(sweep, options)                                                                 \
    MESO_COUNT(0, "relax", "N", "steps by which strands are aligned beyond their slots and kept apart "       \
               "(default 0: none)", &(options).relax, 0, MESO_RELAX_MOST, .given = &(sweep).given.relax,      \
               .more = MESO_OPTION_OVERRIDES)

/* Puts what was given into `options`; `steps`: divisions or a section step were given, which exclude a tolerance. */
MesoStatus meso_map_sweep_set(const MesoMapSweep *sweep, bool steps, MesoMapOptions *options, MesoError *error);

#endif
