#include "cmd/info/info_compare.h"

#include <math.h>
#include <string.h>

#include "formats/image/image_read.h"

typedef struct Difference {
    uint64_t differing, unlike;     /* pixels; of them, those where one alone is finite */
    uint64_t worst;                 /* pixel */
    double largest, squares, own;   /* sums of squares: of the differences, and of the first picture */
} Difference;

static Difference compare(const float *a, const float *b, uint64_t count)
{
    Difference d = {0};
    for (uint64_t i = 0; i < count; i++) {
        bool same = a[i] == b[i] || (isnan(a[i]) && isnan(b[i]));
        d.differing += !same;
        if (!isfinite(a[i]) || !isfinite(b[i])) {
            d.unlike += !same;
            continue;
        }
        double difference = fabs((double)a[i] - (double)b[i]);
        d.squares += difference * difference;
        d.own += (double)a[i] * (double)a[i];
        if (difference > d.largest) {
            d.largest = difference;
            d.worst = i;
        }
    }
    return d;
}

static const float *find_channel(const MesoPicture *picture, const char *name)
{
    for (uint32_t c = 0; c < picture->channel_count; c++)
        if (strcmp(picture->channel_names[c], name) == 0)
            return picture->values + (size_t)c * picture->width * picture->height;
    return NULL;
}

static json_t *channel_json(const MesoPicture *a, uint32_t c, const float *other)
{
    uint64_t count = (uint64_t)a->width * a->height;
    Difference d = compare(a->values + c * count, other, count);
    json_int_t column = (json_int_t)(d.worst % a->width), row = (json_int_t)(d.worst / a->width);
    json_t *worst = d.largest > 0 ? json_pack("[I, I]", column, row) : json_null();
    return json_pack("{s:s, s:I, s:I, s:f, s:o, s:f, s:o}", "name", a->channel_names[c], "differing",
                     (json_int_t)d.differing, "unlike", (json_int_t)d.unlike, "largest", d.largest, "worst_pixel", worst,
                     "rms", sqrt(d.squares / (double)count), "relative",
                     d.own > 0 ? json_real(sqrt(d.squares / d.own)) : json_null());
}

/* Names of channels that `a` has, and not `b`; how many of them. */
static size_t put_alone(json_t *facts, const char *key, const MesoPicture *a, const MesoPicture *b)
{
    json_t *names = json_array();
    for (uint32_t c = 0; c < a->channel_count; c++)
        if (!find_channel(b, a->channel_names[c]))
            json_array_append_new(names, json_string(a->channel_names[c]));
    size_t count = json_array_size(names);
    json_object_set_new(facts, key, names);
    return count;
}

static MesoStatus compare_pictures(json_t *facts, const MesoPicture *a, const MesoPicture *b, MesoError *error)
{
    json_t *channels = json_array();
    uint32_t different = 0;
    int failed = channels == NULL;
    for (uint32_t c = 0; c < a->channel_count; c++) {
        const float *other = find_channel(b, a->channel_names[c]);
        if (!other)
            continue;
        json_t *channel = channel_json(a, c, other);
        different += json_integer_value(json_object_get(channel, "differing")) > 0;
        failed |= json_array_append_new(channels, channel);
    }
    failed |= json_object_set_new(facts, "width", json_integer(a->width));
    failed |= json_object_set_new(facts, "height", json_integer(a->height));
    failed |= json_object_set_new(facts, "channels", channels);
    size_t alone = put_alone(facts, "first_alone", a, b) + put_alone(facts, "second_alone", b, a);
    if (failed)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    if (different + alone > 0)
        return meso_fail(error, MESO_ERR_NO, "the pictures differ in %u of %u channels", different + (uint32_t)alone,
                         a->channel_count + (uint32_t)json_array_size(json_object_get(facts, "second_alone")));
    return MESO_OK;
}

MesoStatus meso_info_compare(json_t *facts, MesoArena *arena, const MesoInput *a, const MesoInput *b, MesoError *error)
{
    MesoPicture first, second;
    MesoStatus status = meso_image_read(&first, arena, a, error);
    if (!status)
        status = meso_image_read(&second, arena, b, error);
    if (status)
        return status;
    if (first.width != second.width || first.height != second.height)
        return meso_fail(error, MESO_ERR_INPUT, "'%s' has %u x %u pixels, '%s' %u x %u", a->path, first.width,
                         first.height, b->path, second.width, second.height);
    return compare_pictures(facts, &first, &second, error);
}
