/* Points from files: rows of numbers (.csv, .txt, .xyz), or the vertices of a mesh file with or without faces. */
#ifndef MESO_POINT_FILE_H
#define MESO_POINT_FILE_H

#include "formats/file/input.h"
#include "libcore/base/arena.h"
#include "libcore/math/vec.h"

/*
 * A row is three numbers or more, of which the first three count, with blanks, commas or semicolons between; '#'
 * begins a comment, and a first row of words is a heading. MESO_ERR_INPUT with file and line for other rows, numbers
 * that are not finite, files without points, and what mesh_read.h says. O(size).
 */
MesoStatus meso_points_read(const MesoVec3 **points, uint32_t *count, MesoArena *arena, const MesoInput *input,
                            MesoError *error);

#endif
