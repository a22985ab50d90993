/* Cross-sections of tile sets, as shapes that are swept along strands. */
#ifndef MESO_GROW_SECTION_H
#define MESO_GROW_SECTION_H

#include "libcore/growth/shape/terminal_shape.h"
#include "libcore/tiling/tile/tile_set.h"

/*
 * The prism over a cross-section of a checked set, open at both ends, so that those of a strand join; corners of more
 * than 40 degrees stay sharp. `name` is "interface/section", "section" alone where one interface has it, or NULL for
 * the first of all. MESO_ERR_INPUT for a name that is not there, with the nearest one, and for a drawing without area.
 */
MesoStatus meso_grow_section(MesoTerminalShape *shape, uint32_t *section, MesoArena *arena, const MesoTileSet *set,
                             const char *name, MesoError *error);

#endif
