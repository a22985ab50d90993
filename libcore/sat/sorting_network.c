#include "libcore/sat/sorting_network.h"

static MesoStatus add_two(const MesoClauses *clauses, int32_t a, int32_t b, MesoError *error)
{
    int32_t literals[2] = {a, b};
    return clauses->add(clauses->context, literals, 2, error);
}

static MesoStatus add_three(const MesoClauses *clauses, int32_t a, int32_t b, int32_t c, MesoError *error)
{
    int32_t literals[3] = {a, b, c};
    return clauses->add(clauses->context, literals, 3, error);
}

/* Makes *high the larger and *low the smaller of both. */
static MesoStatus compare(const MesoClauses *clauses, int32_t *high, int32_t *low, MesoError *error)
{
    int32_t a = *high, b = *low;
    if (a == MESO_LITERAL_TRUE || b == -MESO_LITERAL_TRUE)
        return MESO_OK;
    if (b == MESO_LITERAL_TRUE || a == -MESO_LITERAL_TRUE) {
        *high = b;
        *low = a;
        return MESO_OK;
    }
    int32_t most = clauses->new_variable(clauses->context), least = clauses->new_variable(clauses->context);
    *high = most;
    *low = least;
    MesoStatus status = add_two(clauses, -a, most, error);
    if (!status)
        status = add_two(clauses, -b, most, error);
    if (!status)
        status = add_three(clauses, -most, a, b, error);
    if (!status)
        status = add_three(clauses, -a, -b, least, error);
    if (!status)
        status = add_two(clauses, -least, a, error);
    return status ? status : add_two(clauses, -least, b, error);
}

/* Batcher's odd-even merge sort, of a power of two. */
static MesoStatus sort_power(const MesoClauses *clauses, int32_t *items, uint32_t size, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t p = 1; p < size; p *= 2)
        for (uint32_t k = p; k >= 1; k /= 2)
            for (uint32_t j = k % p; j + k < size; j += 2 * k)
                for (uint32_t i = 0; i < k && i + j + k < size && !status; i++)
                    if ((i + j) / (2 * p) == (i + j + k) / (2 * p))
                        status = compare(clauses, &items[i + j], &items[i + j + k], error);
    return status;
}

uint64_t meso_sort_comparators(uint32_t count)
{
    uint64_t size = 1, log = 0;
    for (; size < count; size *= 2)
        log++;
    return size * log * (log + 1) / 4;
}

MesoStatus meso_sort_literals(const MesoClauses *clauses, int32_t *items, uint32_t count, MesoError *error)
{
    uint32_t size = 1;
    while (size < count)
        size *= 2;
    for (uint32_t i = count; i < size; i++)
        items[i] = -MESO_LITERAL_TRUE;
    return sort_power(clauses, items, size, error);
}
