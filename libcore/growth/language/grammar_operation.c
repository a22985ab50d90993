#include "libcore/growth/language/grammar_operation.h"

#include <assert.h>
#include <math.h>

/*
 * sin(x + quarters * pi / 2). The polynomials, for |x| <= pi / 4, and the parts of pi / 2 are those of FreeBSD's msun
 * (Sun Microsystems, 1993): within one unit in the last place as long as x is below some 10^5.
 */
static double sine(double x, double quarters)
{
    double k = floor(x * 6.36619772367581382433e-01 + 0.5);
    double r = x - k * 1.57079632673412561417e+00;
    r -= k * 6.07710050630396597660e-11;
    r -= k * 2.02226624879595063154e-21;
    double z = r * r, turn = k + quarters - 4 * floor((k + quarters) / 4);
    double s = r + r * z * (-1.66666666666666324348e-01 + z * (8.33333333332248946124e-03 +
               z * (-1.98412698298579493134e-04 + z * (2.75573137070700676789e-06 +
               z * (-2.50507602534068634195e-08 + z * 1.58969099521155010221e-10)))));
    double c = 1 - 0.5 * z + z * z * (4.16666666666666019037e-02 + z * (-1.38888888888741095749e-03 +
               z * (2.48015872894767294178e-05 + z * (-2.75573143513906633035e-07 +
               z * (2.08757232129817482790e-09 + z * -1.13596475577881948265e-11)))));
    double value = turn == 1 || turn == 3 ? c : s;
    return turn >= 2 ? -value : value;
}

/* Whole powers: others would need a library's logarithm. */
static double power(double base, double exponent)
{
    double n = fmin(fabs(floor(exponent + 0.5)), 1024), result = 1;
    for (uint32_t left = n >= 0 ? (uint32_t)n : 0; left; left /= 2) {
        if (left % 2)
            result *= base;
        base *= base;
    }
    return exponent < 0 ? 1 / result : result;
}

static double clamped(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* 3t^2 - 2t^3 of where x is between a and b. */
static double smooth(double a, double b, double x)
{
    double t = a == b ? (x < a ? 0 : 1) : clamped((x - a) / (b - a), 0, 1);
    return t * t * (3 - 2 * t);
}

double meso_grammar_apply(uint16_t operation, double a, double b, double c)
{
    switch (operation) {
    case MESO_OP_ADD: return a + b;
    case MESO_OP_SUBTRACT: return a - b;
    case MESO_OP_MULTIPLY: return a * b;
    case MESO_OP_DIVIDE: return a / b;
    case MESO_OP_MINIMUM: return a < b ? a : b;
    case MESO_OP_MAXIMUM: return a > b ? a : b;
    case MESO_OP_MODULO: return a - b * floor(a / b);
    case MESO_OP_POWER: return power(a, b);
    case MESO_OP_LESS: return a < b;
    case MESO_OP_LESS_EQUAL: return a <= b;
    case MESO_OP_EQUAL: return a == b;
    case MESO_OP_NOT_EQUAL: return a != b;
    case MESO_OP_NEGATE: return -a;
    case MESO_OP_NOT: return a == 0;
    case MESO_OP_ABSOLUTE: return fabs(a);
    case MESO_OP_FLOOR: return floor(a);
    case MESO_OP_CEILING: return ceil(a);
    case MESO_OP_ROUND: return floor(a + 0.5);
    case MESO_OP_SIGN: return (a > 0) - (a < 0);
    case MESO_OP_ROOT: return sqrt(a);
    case MESO_OP_SINE: return sine(a, 0);
    case MESO_OP_COSINE: return sine(a, 1);
    case MESO_OP_CLAMP: return clamped(a, b, c);
    case MESO_OP_LERP: return a + (b - a) * c;
    case MESO_OP_SMOOTH: return smooth(a, b, c);
    default: assert(0 && "not an operation on numbers"); return 0;
    }
}
