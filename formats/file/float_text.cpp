#include "formats/file/float_text.h"

#include <charconv>
#include <cmath>

extern "C" char *meso_float_text(float value, char *out)
{
    try {
        if (!std::isfinite(value))
            value = 0;
        return std::to_chars(out, out + MESO_FLOAT_TEXT, value).ptr;
    } catch (...) {
        *out = '0';
        return out + 1;
    }
}
