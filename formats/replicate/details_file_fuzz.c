/* Any bytes as details, as the points that they name, and as deformations; what is accepted is as the headers say. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/replicate/deform_file.h"
#include "formats/replicate/details_file.h"
#include "libcore/base/index.h"
#include "libcore/mesh/polygon_mesh.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void check(bool right)
{
    if (!right)
        abort();
}

static void check_text(const char *text) { check(text && strlen(text) <= 4096); }
static void check_place(MesoVec3 p) { check(meso_vec3_length(meso_vec3_scale(p, 1e-18f)) < 2); }
static bool is_direction(MesoVec3 v) { return v.x != 0 || v.y != 0 || v.z != 0; }

static void check_kind(const MesoDetailsFile *details, const MesoDetailKind *kind)
{
    check_text(kind->name);
    check_text(kind->file);
    check((*kind->file != 0) == (kind->geometry == MESO_DETAIL_MESH ||
                                 (kind->geometry == MESO_DETAIL_BUMP && kind->profile == MESO_BUMP_IMAGE)));
    check(kind->length >= 0 && isfinite(kind->length) && fabsf(kind->lift) <= 100 && fabsf(kind->height) <= 10);
    check(kind->material < details->material_count);
}

static void check_map(const MesoDetailMap *map)
{
    check(!map->given || !map->attribute != !map->image);
    check(!map->given || (isfinite(map->low) && isfinite(map->high) && map->low != map->high));
}

static void check_point(const MesoDetailsFile *details, const MesoDetailPoint *point)
{
    check_place(point->position);
    check(isnan(point->size) || (point->size > 0 && point->size < 1e18f));
    check(isnan(point->aspect) || (point->aspect >= 0.01f && point->aspect <= 100));
    check(point->kind == MESO_NO_INDEX || point->kind < details->kind_count);
    check(!point->headed || is_direction(point->direction));
}

static void check_distribution(const MesoDetailsFile *details, const MesoDetailDistribution *d)
{
    double sum = 0;
    check((d->source == MESO_DETAILS_AT_POINTS) == (d->point_count > 0));
    check((d->source == MESO_DETAILS_POISSON) == (d->radius > 0 || d->count > 0));
    check((d->source == MESO_DETAILS_OF_SCENE) == (d->scene != NULL));
    for (uint32_t i = 0; i < d->point_count; i++)
        check_point(details, &d->points[i]);
    check_map(&d->density);
    check_map(&d->size_map);
    check(d->size[0] > 0 && d->size[0] <= d->size[1] && isfinite(d->size[1]));
    check(d->aspect[0] > 0 && d->aspect[0] <= d->aspect[1]);
    check(d->heading.source != MESO_HEADING_DIRECTION || is_direction(d->heading.direction));
    check((d->heading.source == MESO_HEADING_ATTRIBUTE) == (d->heading.attribute != NULL));
    for (uint32_t i = 0; i < details->kind_count; i++)
        sum += (double)d->shares[i];
    check(fabs(sum - 1) < 1e-5);
}

typedef struct Others {
    const uint8_t *data;
    size_t size;
    MesoInput input;
} Others;

static const MesoInput *open_file(void *context, const char *name, MesoError *error)
{
    Others *others = context;
    if (*name == '-') {
        meso_fail(error, MESO_ERR_INPUT, "no such file");
        return NULL;
    }
    meso_input_wrap(&others->input, name, others->data, others->size);
    return &others->input;
}

static void read_details(const MesoInput *input, Others *others)
{
    const MesoJsonFiles files = {others, open_file};
    MesoArena arena;
    MesoError error;
    MesoDetailsFile details;
    meso_arena_init(&arena);
    if (meso_details_read(&details, &arena, input, &files, &error) == MESO_OK) {
        check(details.material_count > 0 && details.kind_count > 0 && details.distribution_count > 0);
        for (uint32_t i = 0; i < details.kind_count; i++)
            check_kind(&details, &details.kinds[i]);
        for (uint32_t i = 0; i < details.distribution_count; i++)
            check_distribution(&details, &details.distributions[i]);
    }
    meso_arena_release(&arena);
}

static void read_deformation(const MesoInput *input)
{
    static const MesoVec3 corners[] = {{0, 0, 0}, {4, 2, 1}, {4, 0, 0}};
    MesoVec3 moved[3];
    MesoArena arena;
    MesoError error;
    MesoDeformFile file;
    meso_arena_init(&arena);
    if (meso_deform_read(&file, &arena, input, corners, 3, &error) == MESO_OK) {
        for (uint32_t i = 0; i < file.step_count; i++)
            check(fabsf(meso_vec3_length(file.steps[i].axis) - 1) < 1e-4f &&
                  fabsf(meso_vec3_dot(file.steps[i].axis, file.steps[i].up)) < 1e-3f);
        for (int t = 0; t <= 4; t++)
            if (meso_deform(moved, corners, 3, file.steps, file.step_count, 0.25 * t, 1, &error) == MESO_OK)
                for (uint32_t v = 0; v < 3; v++)
                    check_place(moved[v]);
    }
    meso_arena_release(&arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    /* Behind the first zero byte begins the text of the other files. */
    const uint8_t *zero = size ? memchr(data, 0, size) : NULL;
    size_t own = zero ? (size_t)(zero - data) : size;
    Others others = {.data = zero ? zero + 1 : data, .size = zero ? size - own - 1 : size};
    MesoInput input;
    meso_input_wrap(&input, "fuzz", size ? data : (const uint8_t *)"", own);
    read_details(&input, &others);
    read_deformation(&input);
    return 0;
}
