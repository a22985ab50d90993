#include "cmd/info/info_quilt.h"

#include <string.h>

#include "formats/json/json_text.h"
#include "formats/quilt/quilt_file.h"
#include "libcore/quilt/embed/quilt_embed.h"

static int put_count(json_t *object, const char *key, uint64_t count)
{
    return json_object_set_new(object, key, json_integer((json_int_t)count));
}

static int put_part(json_t *facts, const char *key, uint32_t vertices, uint32_t triangles)
{
    json_t *object = json_object();
    int failed = put_count(object, "vertices", vertices) | put_count(object, "triangles", triangles);
    return failed | json_object_set_new(facts, key, object);
}

/* Steps that have something left. */
static MesoStatus count_patches(uint32_t *count, MesoArena *arena, const MesoQuilt *quilt, MesoError *error)
{
    uint32_t largest = 0;
    for (uint32_t t = 0; t < quilt->triangle_count; t++)
        largest = quilt->patches[t] > largest ? quilt->patches[t] : largest;
    uint8_t *seen = largest < UINT32_MAX / 2 ? MESO_NEW(arena, uint8_t, (size_t)largest + 1, error) : NULL;
    *count = 0;
    if (!seen)      /* no quilt has grown in so many steps */
        return largest < UINT32_MAX / 2 ? MESO_ERR_MEMORY : MESO_OK;
    for (uint32_t t = 0; t < quilt->triangle_count; t++) {
        *count += !seen[quilt->patches[t]];
        seen[quilt->patches[t]] = 1;
    }
    return MESO_OK;
}

static int put_heights(json_t *facts, const MesoQuilt *quilt)
{
    MesoQuiltHeights heights = meso_quilt_heights(quilt);
    json_t *list = json_array();
    int failed = json_array_append_new(list, meso_json_shortest(heights.low));
    failed |= json_array_append_new(list, meso_json_shortest(heights.high));
    return failed | json_object_set_new(facts, "heights", list);
}

MesoStatus meso_info_quilt(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoQuiltFile file;
    MesoInput text;
    const char *provenance;
    json_t *root = NULL;
    uint32_t patches;
    MesoStatus status = meso_quilt_read(&file, &provenance, arena, input, error);
    if (!status)
        status = count_patches(&patches, arena, &file.quilt, error);
    if (status)
        return status;
    meso_input_wrap(&text, "provenance", provenance, strlen(provenance));
    meso_json_parse(&root, &text, NULL);
    int failed = json_object_set_new(facts, "provenance", root);
    failed |= put_count(facts, "elements", file.quilt.element_count);
    failed |= put_count(facts, "vertices", file.quilt.vertex_count);
    failed |= put_count(facts, "triangles", file.quilt.triangle_count);
    failed |= put_count(facts, "patches", patches);
    failed |= put_count(facts, "materials", file.swatch.material_count);
    failed |= put_heights(facts, &file.quilt);
    failed |= put_part(facts, "surface", file.base.vertex_count, file.base.triangle_count);
    failed |= put_part(facts, "swatch", file.swatch.vertex_count, file.swatch.triangle_count);
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory") : MESO_OK;
}
