#include "libcore/render/image.h"

#include "libcore/base/bits.h"

enum { MAX_SIZE = 16384, ALIGNMENT = 64 };

MesoStatus meso_render_check(const MesoRenderOptions *options, MesoError *error)
{
    if (options->width < 1 || options->width > MAX_SIZE || options->height < 1 || options->height > MAX_SIZE)
        return meso_fail(error, MESO_ERR_LIMIT, "image of %u x %u is not between 1 x 1 and %u x %u",
                         options->width, options->height, MAX_SIZE, MAX_SIZE);
    if (options->samples != 1 && options->samples != 4 && options->samples != 16)
        return meso_fail(error, MESO_ERR_USAGE, "%u samples a pixel (1, 4 or 16)", options->samples);
    return MESO_OK;
}

/* ---- arrays ---- */

/* Floats a pixel of an array, and the extra that asks for it, or 0: it is always there. */
typedef struct ArraySort {
    size_t offset;              /* of its pointer in MesoImage */
    uint32_t floats;
    unsigned extra;
} ArraySort;

static const ArraySort SORTS[] = {
    {offsetof(MesoImage, color), 4, 0},
    {offsetof(MesoImage, depth), 1, 0},
    {offsetof(MesoImage, normal), 3, 0},
    {offsetof(MesoImage, albedo), 3, 0},
    {offsetof(MesoImage, position), 3, MESO_EXTRA_POSITION},
    {offsetof(MesoImage, uv), 2, MESO_EXTRA_UV},
    {offsetof(MesoImage, openness), 1, MESO_EXTRA_OCCLUSION},
    {offsetof(MesoImage, material), 2, MESO_EXTRA_MATERIAL},
    {offsetof(MesoImage, motion), 2, MESO_EXTRA_MOTION},
};

enum { SORT_COUNT = sizeof SORTS / sizeof *SORTS };

static bool is_there(const ArraySort *sort, const MesoRenderOptions *options)
{
    return sort->extra == 0 || options->extras & sort->extra;
}

static uint32_t matte_count(const MesoScene *scene, const MesoRenderOptions *options)
{
    return options->extras & MESO_EXTRA_MATTES ? scene->channel_count + 1 : 0;
}

size_t meso_image_pixel_bytes(const MesoScene *scene, const MesoRenderOptions *options)
{
    size_t floats = scene->channel_count + (size_t)2 * MESO_MATTE_RANKS * matte_count(scene, options);
    for (uint32_t i = 0; i < SORT_COUNT; i++)
        floats += is_there(&SORTS[i], options) ? SORTS[i].floats : 0;
    return sizeof(float) * floats;
}

static MesoMatte matte_of(const MesoScene *scene, uint32_t m)
{
    if (m == scene->channel_count)
        return (MesoMatte){.name = "material", .count = scene->material_count,
                           .names = (const char *const *)scene->material_names};
    return (MesoMatte){.name = scene->channels[m].name, .count = scene->channels[m].count,
                       .names = (const char *const *)scene->channels[m].names};
}

/* Memory that is handed out from its beginning; without any, its size is counted. */
typedef struct Room {
    unsigned char *memory;
    size_t used;
} Room;

static void *take(Room *room, size_t size)
{
    void *taken = room->memory ? room->memory + room->used : NULL;
    room->used += (size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    return taken;
}

static void place_mattes(MesoImage *image, Room *room, const MesoScene *scene, const MesoRenderOptions *options)
{
    size_t pixels = (size_t)options->width * options->height;
    image->matte_count = matte_count(scene, options);
    for (uint32_t m = 0; m < image->matte_count; m++) {
        MesoMatte *matte = &image->mattes[m];
        *matte = matte_of(scene, m);
        matte->ranks = take(room, sizeof(float) * 2 * MESO_MATTE_RANKS * pixels);
        matte->hashes = take(room, sizeof(float) * matte->count);
        matte->seen = take(room, sizeof(uint64_t) * meso_bits_words(matte->count));
    }
}

static void place(MesoImage *image, Room *room, const MesoScene *scene, const MesoRenderOptions *options)
{
    size_t pixels = (size_t)options->width * options->height;
    *image = (MesoImage){.width = options->width, .height = options->height, .camera = options->camera,
                         .channel_count = scene->channel_count};
    for (uint32_t i = 0; i < SORT_COUNT; i++)
        if (is_there(&SORTS[i], options))
            *(float **)((char *)image + SORTS[i].offset) = take(room, sizeof(float) * SORTS[i].floats * pixels);
    for (uint32_t c = 0; c < scene->channel_count; c++) {
        image->channels[c] = scene->channels[c];
        image->ids[c] = take(room, sizeof(uint32_t) * pixels);
    }
    place_mattes(image, room, scene, options);
}

size_t meso_image_bytes(const MesoScene *scene, const MesoRenderOptions *options)
{
    MesoImage image;
    Room room = {0};
    place(&image, &room, scene, options);
    return room.used;
}

void meso_image_place(MesoImage *image, void *memory, const MesoScene *scene, const MesoRenderOptions *options)
{
    Room room = {memory, 0};
    place(image, &room, scene, options);
    for (uint32_t m = 0; m < image->matte_count; m++)
        meso_matte_init(&image->mattes[m]);
}
