/* Any bytes as a picture: what is read can be looked at, and its numbers are in the bounds of its kind. */
#include <stdbool.h>

#include "formats/image/image_read.h"
#include "formats/product/file_kind.h"
#include "libcore/base/check.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoArena arena;
    MesoPicture picture;
    MesoInput input;
    MesoError error;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", size ? data : (const uint8_t *)"", size);
    MesoStatus status = meso_image_read(&picture, &arena, &input, &error);
    CHECK(status == MESO_OK || status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT);
    uint64_t count = 0;
    if (!status) {
        CHECK(picture.width && picture.height && picture.channel_count);
        count = (uint64_t)picture.width * picture.height * picture.channel_count;
        for (uint32_t c = 0; c < picture.channel_count; c++)
            CHECK(picture.channel_names[c]);
    }
    bool is_png = meso_file_kind(&input) == MESO_FILE_PNG;
    for (uint64_t i = 0; i < count; i++)
        CHECK(!is_png || (picture.values[i] >= 0 && picture.values[i] <= 1));
    meso_arena_release(&arena);
    return 0;
}
