/* The recipes that there are. */
#include <string.h>

#include "libcore/quilt/swatch/swatch_make.h"
#include "libcore/quilt/swatch/swatch_maker.h"

#define MOST_JITTER 0.25f

enum { MOST_COLUMNS = 4096, LEAST_SIDES = 3, MOST_SIDES = 1024, METHOD_COUNT = 9 };

static const MesoSwatchMethod *method_at(uint32_t i)
{
    return i < 3   ? &meso_swatch_strand_methods[i]
           : i < 6 ? &meso_swatch_ring_methods[i - 3]
           : i < 8 ? &meso_swatch_leaf_methods[i - 6]
                   : &meso_swatch_fruit_methods[0];
}

const char *meso_swatch_recipe_names(void)
{
    return "weave, wire, armour, mail, rings, nuts, ivy, scales, apples";
}

static MesoStatus find_method(const MesoSwatchMethod **method, const char *name, MesoError *error)
{
    for (uint32_t i = 0; i < METHOD_COUNT; i++) {
        *method = method_at(i);
        if (name && strcmp((*method)->usual.name, name) == 0)
            return MESO_OK;
    }
    return meso_fail(error, MESO_ERR_USAGE, "no recipe for a swatch is named '%s'; there are %s", name ? name : "",
                     meso_swatch_recipe_names());
}

static MesoStatus check(const MesoSwatchRecipe *recipe, MesoError *error)
{
    if (recipe->columns > MOST_COLUMNS || recipe->rows > MOST_COLUMNS)
        return meso_fail(error, MESO_ERR_USAGE, "a swatch of %u columns and %u rows; at most %u of each",
                         recipe->columns, recipe->rows, MOST_COLUMNS);
    if (recipe->sides && (recipe->sides < LEAST_SIDES || recipe->sides > MOST_SIDES))
        return meso_fail(error, MESO_ERR_USAGE, "a cross-section of %u sides; it has %u to %u", recipe->sides,
                         LEAST_SIDES, MOST_SIDES);
    if (!(recipe->jitter >= 0 && recipe->jitter <= MOST_JITTER))
        return meso_fail(error, MESO_ERR_USAGE, "jitter by %g; it is from 0 to %g", (double)recipe->jitter,
                         (double)MOST_JITTER);
    if (!(recipe->thickness >= 0 && recipe->thickness <= 1))
        return meso_fail(error, MESO_ERR_USAGE, "strands of thickness %g; it is from 0 to 1",
                         (double)recipe->thickness);
    return MESO_OK;
}

static uint32_t round_up(uint32_t number, uint32_t multiple, uint32_t least)
{
    uint32_t times = (number + multiple - 1) / multiple;
    return (times < least ? least : times) * multiple;
}

/* What is left out is usual; without jitter the numbers are such that the far side meets the near one. */
static MesoSwatchRecipe complete(MesoSwatchRecipe recipe, const MesoSwatchMethod *method)
{
    const MesoSwatchRecipe *usual = &method->usual;
    recipe.columns = recipe.columns ? recipe.columns : usual->columns;
    recipe.rows = recipe.rows ? recipe.rows : usual->rows;
    recipe.sides = recipe.sides ? recipe.sides : usual->sides;
    recipe.thickness = recipe.thickness > 0 ? recipe.thickness : usual->thickness;
    if (recipe.jitter > 0)
        return recipe;
    recipe.columns = round_up(recipe.columns, method->columns_multiple, method->least_multiple);
    recipe.rows = round_up(recipe.rows, method->rows_multiple, method->least_multiple);
    return recipe;
}

MesoStatus meso_swatch_make(MesoPolygonMesh *mesh, MesoArena *arena, const MesoSwatchRecipe *recipe, MesoError *error)
{
    const MesoSwatchMethod *method;
    MesoStatus status = find_method(&method, recipe->name, error);
    if (!status)
        status = check(recipe, error);
    if (status)
        return status;
    MesoArena scratch;
    meso_arena_init(&scratch);
    MesoSwatchMaker maker = {.recipe = complete(*recipe, method), .materials = method->materials,
                             .material_count = method->material_count, .scratch = &scratch, .error = error};
    meso_random_init(&maker.random, recipe->seed, 0);
    method->make(&maker);
    status = maker.status ? maker.status : meso_maker_finish(mesh, arena, &maker, error);
    meso_arena_release(&scratch);
    return status;
}
