#include "libcore/math/envelope.h"

#include <float.h>

MesoStatus meso_envelope_new(MesoEnvelope *envelope, MesoArena *arena, uint32_t count, uint32_t *firsts,
                             MesoError *error)
{
    size_t total = 0;
    *envelope = (MesoEnvelope){.count = count, .firsts = firsts, .begins = MESO_NEW(arena, size_t, count, error)};
    if (!envelope->begins)
        return MESO_ERR_MEMORY;
    for (uint32_t row = 0; row < count; row++) {
        envelope->begins[row] = total;
        total += row - firsts[row] + 1;
    }
    envelope->values = MESO_NEW(arena, double, total, error);
    return envelope->values ? MESO_OK : MESO_ERR_MEMORY;
}

/* Four sums at a time, for processors that add more than one. */
static double dot(const double *restrict a, const double *restrict b, uint32_t count)
{
    double sums[4] = {0, 0, 0, 0};
    uint32_t k = 0;
    for (; k + 4 <= count; k += 4)
        for (uint32_t c = 0; c < 4; c++)
            sums[c] += a[k + c] * b[k + c];
    for (; k < count; k++)
        sums[0] += a[k] * b[k];
    return (sums[0] + sums[1]) + (sums[2] + sums[3]);
}

/* Row of L, times D: each number less what the columns before it have of both rows. */
static void reduce_row(double *row, uint32_t first, uint32_t own, const MesoEnvelope *envelope)
{
    for (uint32_t j = first; j < own; j++) {
        uint32_t from = envelope->firsts[j] > first ? envelope->firsts[j] : first;
        row[j - first] -= dot(row + (from - first), meso_envelope_at(envelope, j, from), j - from);
    }
}

/*
 * What is left of a diagonal after its column has been eliminated is lost in rounding below this part of it: a few
 * units in the last place.
 */
static const double LEAST_PIVOT = 16 * DBL_EPSILON;

MesoStatus meso_envelope_factor(MesoEnvelope *envelope, MesoError *error)
{
    for (uint32_t i = 0; i < envelope->count; i++) {
        uint32_t first = envelope->firsts[i];
        double *row = &envelope->values[envelope->begins[i]], diagonal = row[i - first], left = diagonal;
        reduce_row(row, first, i, envelope);
        for (uint32_t j = first; j < i; j++) {
            double reduced = row[j - first];
            row[j - first] = reduced / *meso_envelope_at(envelope, j, j);
            left -= reduced * row[j - first];
        }
        row[i - first] = left;
        if (!(left > LEAST_PIVOT * diagonal && left <= DBL_MAX))
            return meso_fail(error, MESO_ERR_INPUT, "a matrix is not positive definite at row %u of %u", i,
                             envelope->count);
    }
    return MESO_OK;
}

void meso_envelope_solve(const MesoEnvelope *envelope, double *x)
{
    for (uint32_t i = 0; i < envelope->count; i++) {
        const double *row = &envelope->values[envelope->begins[i]];
        for (uint32_t j = envelope->firsts[i]; j < i; j++)
            for (size_t c = 0; c < 3; c++)
                x[3 * (size_t)i + c] -= row[j - envelope->firsts[i]] * x[3 * (size_t)j + c];
    }
    for (uint32_t i = 0; i < envelope->count; i++)
        for (size_t c = 0; c < 3; c++)
            x[3 * (size_t)i + c] /= *meso_envelope_at(envelope, i, i);
    for (uint32_t i = envelope->count; i-- > 0;) {
        const double *row = &envelope->values[envelope->begins[i]];
        for (uint32_t j = envelope->firsts[i]; j < i; j++)
            for (size_t c = 0; c < 3; c++)
                x[3 * (size_t)j + c] -= row[j - envelope->firsts[i]] * x[3 * (size_t)i + c];
    }
}
