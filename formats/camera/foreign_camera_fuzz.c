/* Cameras of others' files: what is read can be looked through. */
#include <stdlib.h>

#include "formats/camera/gltf_camera.h"
#include "formats/camera/view_matrices.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const MesoCamera usual = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 30, 0};
    MesoCamera camera;
    MesoCameraKey *keys = NULL;
    MesoArena arena;
    MesoInput input;
    MesoError error;
    MesoView view;
    uint32_t count = 0;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_gltf_camera_read(&camera, &arena, &input, size % 2 ? "Camera" : NULL, &error) == MESO_OK &&
        meso_view_build(&view, &camera, NULL))
        abort();
    if (meso_view_matrices_read(&keys, &count, &arena, &input, &usual, &error) == MESO_OK)
        for (uint32_t i = 0; i < count; i++)
            if (keys[i].frame != (int32_t)i + 1 || meso_view_build(&view, &keys[i].camera, NULL))
                abort();
    meso_arena_release(&arena);
    return 0;
}
