/* All inputs of small networks. */
#include "libcore/sat/sorting_network.h"

#include "libcore/base/check.h"

typedef struct Formula {
    MesoSat *sat;
    int32_t variable_count;
} Formula;

static MesoStatus add(void *context, int32_t *literals, uint32_t count, MesoError *error)
{
    Formula *formula = context;
    for (uint32_t i = 0; i < count; i++)
        CHECK(literals[i] != MESO_LITERAL_TRUE && literals[i] != -MESO_LITERAL_TRUE);
    return meso_sat_add(formula->sat, literals, count, error);
}

static int32_t new_variable(void *context)
{
    Formula *formula = context;
    return ++formula->variable_count;
}

static bool value(const Formula *formula, int32_t literal)
{
    if (literal == MESO_LITERAL_TRUE || literal == -MESO_LITERAL_TRUE)
        return literal > 0;
    return meso_sat_value(formula->sat, literal);
}

/* Inputs that `fixed` says, 1 or 2, are constants: what never holds, or always. */
static void check_network(uint32_t count, uint32_t fixed)
{
    Formula formula = {.variable_count = (int32_t)count};
    const MesoClauses clauses = {add, new_variable, &formula};
    int32_t items[8], assumptions[8];
    CHECK(meso_sat_init(&formula.sat, NULL, NULL, NULL) == MESO_OK);
    uint32_t open = 0, held = 0;
    for (uint32_t i = 0, f = fixed; i < count; i++, f /= 3) {
        items[i] = f % 3 == 0 ? (int32_t)i + 1 : f % 3 == 1 ? -MESO_LITERAL_TRUE : MESO_LITERAL_TRUE;
        held += f % 3 == 2;
        if (f % 3 == 0)
            assumptions[open++] = (int32_t)i + 1;
    }
    for (uint32_t i = 0; i < open; i++)
        CHECK(meso_sat_freeze(formula.sat, assumptions[i], NULL) == MESO_OK);
    CHECK(meso_sort_literals(&clauses, items, count, NULL) == MESO_OK);
    for (uint32_t i = 0; i < count; i++)
        if (items[i] != MESO_LITERAL_TRUE && items[i] != -MESO_LITERAL_TRUE)
            CHECK(meso_sat_freeze(formula.sat, items[i] > 0 ? items[i] : -items[i], NULL) == MESO_OK);
    for (uint32_t input = 0; input < 1u << open; input++) {
        MesoSatAnswer answer;
        int32_t given[8];
        for (uint32_t i = 0; i < open; i++)
            given[i] = (input >> i) & 1 ? assumptions[i] : -assumptions[i];
        CHECK(meso_sat_solve(formula.sat, &answer, given, open, 1000, NULL, NULL, NULL) == MESO_OK);
        CHECK(answer == MESO_SAT_YES);
        for (uint32_t i = 0; i < count; i++)
            CHECK(value(&formula, items[i]) == (i < held + (uint32_t)__builtin_popcount(input)));
    }
    meso_sat_release(formula.sat);
}

int main(void)
{
    uint32_t cases = 1;
    for (uint32_t count = 0; count <= 5; count++, cases *= 3)
        for (uint32_t fixed = 0; fixed < cases; fixed++)
            check_network(count, fixed);
    for (uint32_t count = 6; count <= 8; count++)
        check_network(count, 0);
    return 0;
}
