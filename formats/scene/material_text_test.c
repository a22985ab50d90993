/* Materials as texts have them. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "formats/scene/material_text.h"
#include "libcore/base/check.h"

static MesoError error;

static MesoMaterial look_of(const char *text, const char *wanted)
{
    MesoMaterial look = {{0.5f, 0.25f, 0.125f}, 0.75f, 0.5f};
    char name[MESO_MATERIAL_NAME];
    CHECK(meso_material_of_text(&look, name, text, &error) == MESO_OK);
    CHECK_TEXT(name, wanted);
    return look;
}

static bool is_near(float a, double b)
{
    return fabs((double)a - b) < 1e-5;
}

static void test_materials(void)
{
    MesoMaterial look = look_of("clay", "clay");
    CHECK(look.albedo[0] == 0.5f && look.roughness == 0.75f && look.metallic == 0.5f);
    /* sRGB: 0 and 255 are 0 and 1, and 0x80 is (0.50196 + 0.055) / 1.055 to the power of 2.4 */
    look = look_of("leaf #ff0080", "leaf");
    CHECK(look.albedo[0] == 1 && look.albedo[1] == 0 && is_near(look.albedo[2], 0.2158605));
    CHECK(look.roughness == 0.75f && look.metallic == 0.5f);
    look = look_of("leaf #0A0a0a 0.5", "leaf");
    CHECK(is_near(look.albedo[1], 10 / 255.0 / 12.92) && look.roughness == 0.5f && look.metallic == 0.5f);
    look = look_of("steel #9a9a98 0 1", "steel");
    CHECK(look.roughness == 0 && look.metallic == 1);
    static const char *const wrong[] = {"", "#ffffff", "leaf green", "leaf #fff", "leaf #fffffff", "leaf #ggffff",
                                        "leaf #ffffff rough", "leaf #ffffff 2", "leaf #ffffff -1",
                                        "leaf #ffffff 0.5 1.5", "leaf #ffffff nan", "leaf #ffffff 0.5 0 0",
                                        "leaf #ffffff 0.5.5", "leaf #ffffff 0x1"};
    for (uint32_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        char name[MESO_MATERIAL_NAME];
        look = (MesoMaterial){{0.5f, 0.25f, 0.125f}, 0.75f, 0.5f};
        if (meso_material_of_text(&look, name, wrong[i], &error) != MESO_ERR_INPUT) {
            fprintf(stderr, "taken: '%s'\n", wrong[i]);
            exit(1);
        }
        CHECK(look.albedo[0] == 0.5f && strstr(error.message, "a name is wanted, or NAME #rrggbb"));
    }
    char name[MESO_MATERIAL_NAME], text[100];
    memset(text, 'x', sizeof text);
    text[99] = '\0';
    CHECK(meso_material_of_text(&look, name, text, &error) == MESO_ERR_INPUT);
}

int main(void)
{
    test_materials();
    return 0;
}
