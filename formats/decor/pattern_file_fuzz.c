/* Any bytes as a pattern, and as the files that it names; what is accepted is as the header says. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/decor/pattern_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(bool right)
{
    if (!right)
        abort();
}

static void check_range(MesoRange range) { check(range.low <= range.high); }
static void check_text(const char *text) { check(text && strlen(text) <= 4096); }

static void check_selector(const MesoSelector *on)
{
    check(!on->path || *on->path);
    for (uint32_t i = 0; i < on->tag_count; i++)
        check_text(on->tags[i]);
    check(on->level <= MESO_SELECT_NODES && on->share >= 0 && on->share <= 1 && on->every >= 1);
    check(on->colors == 0 ? on->color == 0 : on->color < on->colors);
    check(isfinite(on->point.x) && isfinite(on->point.y) && isfinite(on->point.z));
    check_range(on->borders);
    check_range(on->corners);
    check_range(on->aspect);
    check_range(on->area);
    check_range(on->area_share);
}

static void check_seed(const MesoSeedSpec *seed)
{
    check(seed->kind <= MESO_SEED_POISSON && seed->of <= MESO_SEED_SIDE);
    check(isfinite(seed->point.x) && isfinite(seed->point.y) && isfinite(seed->point.z) && isfinite(seed->spacing));
    if (seed->kind == MESO_SEED_FACE)
        check(fabsf(seed->weight[0] + seed->weight[1] + seed->weight[2] - 1) < 1e-5f);
    if (seed->kind == MESO_SEED_ALONG || seed->kind == MESO_SEED_POISSON)
        check(seed->count > 0 || seed->spacing > 0);
    check(seed->border_slack >= 0 && seed->border_slack <= 1);
}

static void check_field(const MesoFieldSpec *field)
{
    check(field->from.count > 0 && (field->to.count > 0) == field->blend);
    for (uint32_t i = 0; i < field->from.count; i++)
        check_seed(&field->from.specs[i]);
    for (uint32_t i = 0; i < field->to.count; i++)
        check_seed(&field->to.specs[i]);
    check(field->noise.of <= MESO_NOISE_OF_FIELD && isfinite(field->noise.gain) && isfinite(field->noise.frequency));
}

static void check_levels(const MesoLevels *levels)
{
    check((levels->value_count > 0) + (levels->count > 0) + (levels->every > 0) == 1 && isfinite(levels->every));
    for (uint32_t i = 0; i < levels->value_count; i++)
        check(isfinite(levels->values[i]) && levels->values[i] > (i ? levels->values[i - 1] : 0));
}

static void check_after(const MesoPattern *pattern, const MesoAfterSplit *after)
{
    const MesoDisplacement *d = &after->displacement;
    check(!after->painted || (after->material_count > 0 && after->by <= MESO_PAINT_RAMP));
    for (uint32_t i = 0; i < after->material_count; i++)
        check(after->materials[i] < pattern->material_count);
    check(!after->displaced || (isfinite(d->height) && d->bias > 0 && d->bias < 1 && d->gain > 0 && d->gain < 1));
    check(!after->name || *after->name);
}

static void check_steps(const MesoPattern *pattern, const MesoStep *steps, uint32_t count, uint32_t *total)
{
    check((*total += count) <= MESO_PATTERN_STEPS && count > 0);
    for (const MesoStep *step = steps; step < steps + count; step++) {
        const MesoGrowth *growth = &step->growth;
        check_text(step->place);
        check_selector(&step->on);
        if (step->kind <= MESO_STEP_VORONOI)
            check_field(&step->field);
        if (step->kind == MESO_STEP_CONTOUR)
            check_levels(&step->levels);
        check((step->kind == MESO_STEP_STREAM) == (step->line_count > 0));
        check((step->kind == MESO_STEP_POLYLINE) == (step->point_count >= 2));
        for (uint32_t i = 0; i < step->point_count; i++)
            check_seed(&step->points[i]);
        for (uint32_t i = 0; i < step->after_count; i++)
            check_after(pattern, &step->after[i]);
        if (step->kind == MESO_STEP_MACRO)
            check_steps(pattern, step->macro.steps, step->macro.step_count, total);
        check((step->kind == MESO_STEP_GROW) == (growth->rule_count > 0));
        for (uint32_t i = 0; i < growth->rule_count; i++) {
            check_selector(&growth->rules[i].where);
            check_steps(pattern, growth->rules[i].macro.steps, growth->rules[i].macro.step_count, total);
        }
    }
}

typedef struct Files {
    const uint8_t *data;
    size_t size;
    MesoInput input;
} Files;

static const MesoInput *open_file(void *context, const char *name, MesoError *error)
{
    Files *files = context;
    if (*name == '-') {
        meso_fail(error, MESO_ERR_INPUT, "no such file");
        return NULL;
    }
    meso_input_wrap(&files->input, name, files->data, files->size);
    return &files->input;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    /* Behind the first zero byte begins the text of the other files. */
    const uint8_t *zero = size ? memchr(data, 0, size) : NULL;
    size_t own = zero ? (size_t)(zero - data) : size;
    Files others = {.data = zero ? zero + 1 : data, .size = zero ? size - own - 1 : size};
    const MesoJsonFiles files = {&others, open_file};
    MesoArena arena;
    MesoError error;
    MesoInput input;
    MesoPattern pattern;
    uint32_t total = 0;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "fuzz", size ? data : (const uint8_t *)"", own);
    if (meso_pattern_read(&pattern, &arena, &input, &files, &error) == MESO_OK) {
        check(pattern.material_count > 0);
        for (uint32_t i = 0; i < pattern.material_count; i++)
            check_text(pattern.material_names[i]);
        check_steps(&pattern, pattern.steps, pattern.step_count, &total);
    }
    meso_arena_release(&arena);
    return 0;
}
