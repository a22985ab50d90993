/* Reader of cameras: what is read ascends, is finite, and gives cameras that can be looked through. */
#include <stdlib.h>

#include "formats/camera/camera_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const MesoCamera usual = {{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 30, 0};
    MesoCameraKey *keys = NULL;
    MesoArena arena;
    MesoInput input;
    MesoError error;
    MesoView view;
    uint32_t count = 0;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_camera_read(&keys, &count, &arena, &input, &usual, 1.5f, &error) == MESO_OK) {
        if (count == 0)
            abort();
        for (uint32_t i = 0; i < count; i++)
            if ((i > 0 && keys[i].frame <= keys[i - 1].frame) || meso_view_build(&view, &keys[i].camera, NULL))
                abort();
        meso_camera_at(keys, count, keys[0].frame + 1);
    }
    meso_arena_release(&arena);
    return 0;
}
