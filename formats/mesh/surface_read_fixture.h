/* What the tests of the kinds of files share: bytes read as a macrosurface of quads. */
#ifndef MESO_SURFACE_READ_FIXTURE_H
#define MESO_SURFACE_READ_FIXTURE_H

#include <string.h>

#include "formats/mesh/surface_read.h"
#include "libcore/base/check.h"

static MesoArena arena;
static MesoQuadMesh mesh;       /* the last one read */
static MesoError error;

static inline MesoStatus read_file(const char *path, const void *bytes, size_t size)
{
    MesoInput input;
    MesoQuadSurface surface;
    meso_input_wrap(&input, path, bytes, size);
    MesoStatus status = meso_quad_surface_read(&surface, &arena, &input, 1, &error);
    mesh = surface.mesh;
    return status;
}

static inline void check_refused(const char *path, const char *text, const char *message)
{
    CHECK(read_file(path, text, strlen(text)) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
}

#endif
