#include "formats/decor/pattern_field.h"

#include "formats/decor/pattern_seeds.h"

enum { MOST_LEVELS = 1 << 16 };

/* Gain and frequency are relative to the region unless "unit" says otherwise, so that a pattern fits any surface. */
static void read_noise(const MesoJsonField *field, MesoNoise *noise)
{
    static const char *const keys[] = {"of", "gain", "frequency", "unit", "seed", NULL};
    static const char *const of[] = {"metric", "field", NULL};
    static const char *const units[] = {"scene", "size", NULL};
    if (!field->value || !meso_json_object(field, keys))
        return;
    MesoJsonField which = meso_json_key(field, "of"), gain = meso_json_key(field, "gain");
    MesoJsonField frequency = meso_json_key(field, "frequency"), seed = meso_json_key(field, "seed");
    MesoJsonField unit = meso_json_key(field, "unit");
    noise->of = meso_json_word(&which, "kind of noise", of, 0) == 0 ? MESO_NOISE_OF_METRIC : MESO_NOISE_OF_FIELD;
    noise->gain = meso_json_float_in(&gain, 0, INFINITY, false, 0.02f);
    noise->frequency = meso_json_float_in(&frequency, 0, INFINITY, true, 8);
    noise->relative = meso_json_word(&unit, "unit", units, 1) == 1;
    noise->seed = (uint64_t)meso_json_whole(&seed, 0, INT64_MAX, 0);
}

void meso_pattern_field(MesoPatternParser *parser, const MesoJsonField *object, MesoFieldSpec *spec)
{
    MesoJsonField dist = meso_json_key(object, "dist"), blend = meso_json_key(object, "blend");
    MesoJsonField noise = meso_json_key(object, "noise");
    if (dist.value && blend.value)
        meso_json_wrong(object, "either \"dist\" or \"blend\" is possible");
    spec->blend = blend.value != NULL;
    if (spec->blend && meso_json_count(&blend, 2, 2) == 2) {
        MesoJsonField from = meso_json_item(&blend, 0), to = meso_json_item(&blend, 1);
        meso_pattern_seeds(parser, &from, &spec->from);
        meso_pattern_seeds(parser, &to, &spec->to);
    } else if (!spec->blend) {
        meso_pattern_seeds(parser, &dist, &spec->from);
    }
    read_noise(&noise, &spec->noise);
}

/* A number, or a list of ascending ones. */
static void read_values(MesoPatternParser *parser, const MesoJsonField *at, float most, MesoLevels *levels)
{
    bool one = !json_is_array(at->value);
    uint32_t count = one ? 1 : meso_json_count(at, 1, MOST_LEVELS);
    float *values = MESO_PATTERN_NEW(parser, float, count);
    for (uint32_t i = 0; values && i < count; i++) {
        MesoJsonField item = meso_json_item(at, i);
        const MesoJsonField *field = one ? at : &item;
        values[i] = meso_json_float_in(field, 0, most, true, 0.5f);
        if (i > 0 && values[i] <= values[i - 1])
            meso_json_wrong(field, "%g; levels must ascend, and the one before is %g", (double)values[i],
                            (double)values[i - 1]);
    }
    levels->values = values;
    levels->value_count = values ? count : 0;
}

void meso_pattern_levels(MesoPatternParser *parser, const MesoJsonField *object, MesoLevels *levels)
{
    static const char *const units[] = {"scene", "share", "size", NULL};
    static const float half[1] = {0.5f};
    MesoJsonField at = meso_json_key(object, "at"), count = meso_json_key(object, "count");
    MesoJsonField every = meso_json_key(object, "every"), unit = meso_json_key(object, "unit");
    bool blend = meso_pattern_has(object, "blend");
    levels->unit = (MesoLevelUnit)meso_json_word(&unit, "unit", units, blend ? MESO_LEVEL_SCENE : MESO_LEVEL_SHARE);
    if (blend && levels->unit == MESO_LEVEL_SIZE)
        meso_json_wrong(&unit, "a blend is no length; \"share\" is possible");
    if (!!at.value + !!count.value + !!every.value > 1)
        meso_json_wrong(object, "one of \"at\", \"count\" and \"every\" is possible");
    if (unit.value && !at.value && !every.value)
        meso_json_wrong(&unit, "it goes with \"at\" and \"every\"");
    float most = blend || levels->unit == MESO_LEVEL_SHARE ? 1 : INFINITY;
    if (at.value) {
        read_values(parser, &at, most, levels);
    } else if (count.value) {
        levels->count = (uint32_t)meso_json_whole(&count, 1, MOST_LEVELS, 1);
    } else if (every.value) {
        levels->every = meso_json_float_in(&every, 0, most, true, 0.5f);
    } else {
        levels->values = half;
        levels->value_count = 1;
    }
}
