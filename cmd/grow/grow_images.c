/* Maps that are painted: images over the surface's texture coordinates. */
#include <math.h>
#include <string.h>

#include "cmd/grow/grow_sources.h"
#include "cmd/grow/grow_uvs.h"
#include "formats/image/image_read.h"
#include "libcore/base/grow.h"

/* ---- texture coordinates ---- */

static MesoStatus take_uvs(MesoGrowSources *s)
{
    MesoError error = {0};
    MesoStatus status = meso_grow_uvs(&s->uvs, &s->tool->arena, s->polygons, s->ground->mesh, &error);
    if (status == MESO_ERR_INPUT)
        return meso_grow_source_fail(s, status, "an image needs %s", error.message);
    s->tool->error = status ? error : s->tool->error;
    return status;
}

/* ---- pictures ---- */

static MesoStatus read_picture(MesoGrowSources *s, const char *file, MesoPicture *picture)
{
    MesoTool *tool = s->tool;
    MesoInput input;
    for (uint32_t i = 0; i < s->picture_count; i++)
        if (strcmp(s->pictures[i].file, file) == 0) {
            *picture = s->pictures[i].picture;
            return MESO_OK;
        }
    MesoStatus status = meso_grow_source_open(s, &input, file, "image");
    if (status)
        return status;
    status = meso_image_read(picture, &tool->arena, &input, &tool->error);
    meso_input_close(&input);
    if (status)
        return status;
    s->pictures = MESO_GROW(&tool->arena, s->pictures, s->picture_count, s->picture_room, 8, &tool->error);
    if (!s->pictures)
        return MESO_ERR_MEMORY;
    s->pictures[s->picture_count++] = (MesoGrowPicture){file, *picture};
    return MESO_OK;
}

static bool find_channel(const MesoPicture *picture, const char *name, uint32_t *channel)
{
    for (*channel = 0; *channel < picture->channel_count; ++*channel)
        if (strcmp(picture->channel_names[*channel], name) == 0)
            return true;
    return false;
}

/* One of r g b a; what is grey is so in all three, and of a picture with one channel that is r. */
static MesoStatus choose_channel(MesoGrowSources *s, const char *file, const MesoPicture *picture, uint32_t *channel)
{
    static const char *const names[] = {"R", "G", "B", "A"};
    uint32_t wanted = s->source->values[1].index;
    char had[128] = "";
    if (find_channel(picture, names[wanted], channel) || (wanted < 3 && find_channel(picture, "Y", channel)))
        return MESO_OK;
    *channel = 0;
    if (wanted == 0 && picture->channel_count == 1)
        return MESO_OK;
    for (uint32_t i = 0; i < picture->channel_count; i++)
        if (strlen(had) + strlen(picture->channel_names[i]) + 2 < sizeof had)
            strcat(strcat(had, i ? " " : ""), picture->channel_names[i]);
    return meso_grow_source_fail(s, MESO_ERR_INPUT, "'%s' has no channel '%c'; it has %s", file, "rgba"[wanted], had);
}

static MesoStatus check_pixels(const MesoGrowSources *s, const char *file, const MesoGrowthImage *image)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        if (!(fabsf(image->pixels[i]) <= MESO_COORDINATE_LIMIT))
            return meso_grow_source_fail(s, MESO_ERR_INPUT, "'%s' has no number in column %zu of row %zu", file,
                                         i % image->width + 1, i / image->width + 1);
    return MESO_OK;
}

MesoStatus meso_grow_map_image(MesoGrowSources *s, MesoGrowthMap *map)
{
    static const MesoGrowthWrap wraps[] = {MESO_GROWTH_REPEAT, MESO_GROWTH_CLAMP, MESO_GROWTH_MIRROR};
    const MesoGrammarValue *values = s->source->values;
    const char *file = values[0].text;
    MesoPicture picture;
    uint32_t channel;
    if (values[4].number != 0)
        return meso_grow_source_fail(s, MESO_ERR_INPUT, "surfaces have one set of texture coordinates, 'uv: 0'");
    MesoStatus status = read_picture(s, file, &picture);
    if (!status)
        status = choose_channel(s, file, &picture, &channel);
    if (!status && !s->uvs)
        status = take_uvs(s);
    if (status)
        return status;
    map->domain = MESO_GROWTH_BY_IMAGE;
    map->image = (MesoGrowthImage){picture.width, picture.height,
                                   picture.values + (size_t)channel * picture.width * picture.height,
                                   values[2].index == 1, wraps[values[3].index]};
    map->uvs = s->uvs;
    return check_pixels(s, file, &map->image);
}
