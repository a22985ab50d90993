/* Numbers of every scalar, scaled and not; components by name. */
#include "libcore/mesh/attribute.h"

#include "libcore/base/check.h"

static void test_scalars(void)
{
    const struct {
        MesoScalar scalar;
        uint32_t size;
        const void *values;
        double plain, normalized;   /* of the second value */
    } rows[] = {
        {MESO_SCALAR_FLOAT, 4, (const float[]){1, -0.5f}, -0.5, -0.5},
        {MESO_SCALAR_DOUBLE, 8, (const double[]){1, 1e300}, 1e300, 1e300},
        {MESO_SCALAR_INT8, 1, (const int8_t[]){1, -128}, -128, -1},
        {MESO_SCALAR_UINT8, 1, (const uint8_t[]){1, 255}, 255, 1},
        {MESO_SCALAR_INT16, 2, (const int16_t[]){1, 32767}, 32767, 1},
        {MESO_SCALAR_UINT16, 2, (const uint16_t[]){1, 65535}, 65535, 1},
        {MESO_SCALAR_INT32, 4, (const int32_t[]){1, -2147483647}, -2147483647, -1},
        {MESO_SCALAR_UINT32, 4, (const uint32_t[]){1, 4294967295}, 4294967295, 1},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        MesoAttribute attribute = {.scalar = rows[i].scalar, .width = 1, .entry_count = 2,
                                   .values = (void *)rows[i].values};
        CHECK(meso_scalar_size(rows[i].scalar) == rows[i].size);
        CHECK(meso_attribute_number(&attribute, 1, 0) == rows[i].plain);
        attribute.normalized = true;
        CHECK(meso_attribute_number(&attribute, 1, 0) == rows[i].normalized);
    }
}

static void test_vectors(void)
{
    static const char *names[2] = {"s", "t"};
    float values[4] = {1, 2, 3, 4};
    uint32_t entry_of[3] = {1, MESO_NO_INDEX, 0};
    MesoAttribute attribute = {.name = "uv", .components = names, .width = 2, .entry_count = 2, .values = values};
    MesoVec3 v = meso_attribute_vec3(&attribute, 1);
    CHECK(v.x == 3 && v.y == 4 && v.z == 0 && meso_attribute_vec2(&attribute, 0).y == 2);
    CHECK(meso_attribute_component(&attribute, "t") == 1 &&
          meso_attribute_component(&attribute, "uv") == MESO_NO_INDEX);
    CHECK(meso_attribute_entry(&attribute, 1) == 1);
    attribute.entry_of = entry_of;
    CHECK(meso_attribute_entry(&attribute, 0) == 1 && meso_attribute_entry(&attribute, 1) == MESO_NO_INDEX);
    attribute = (MesoAttribute){.name = "heat", .width = 1};
    CHECK(meso_attribute_component(&attribute, "heat") == 0 &&
          meso_attribute_component(&attribute, "s") == MESO_NO_INDEX);
}

int main(void)
{
    test_scalars();
    test_vectors();
    return 0;
}
