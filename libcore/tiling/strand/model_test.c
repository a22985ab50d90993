/* Defaults of the mapping options. */
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/tiling/strand/model.h"

int main(void)
{
    MesoMapOptions all = meso_map_options_resolve((MesoMapOptions){0}, 0.5f);
    CHECK(all.thickness == 0.5f && all.section_scale == 0.5f && all.offset == 0);
    CHECK(all.tangent_scale == 1 && all.section_step == 0.02f && all.divisions == 12);

    MesoMapOptions own = {.thickness = 2, .offset = -3, .section_scale = 4, .tangent_scale = 5, .section_step = 0.5f,
                          .divisions = 7};
    MesoMapOptions kept = meso_map_options_resolve(own, 0.5f);
    CHECK(kept.thickness == 2 && kept.offset == -3 && kept.section_scale == 4);
    CHECK(kept.tangent_scale == 5 && kept.section_step == 0.5f && kept.divisions == 7);

    own.thickness = -1;
    own.section_scale = NAN;
    own.divisions = 1;
    kept = meso_map_options_resolve(own, 0);
    CHECK(kept.thickness == 1 && kept.section_scale == 1 && kept.divisions == 2);

    /* Resolved options do not change any more. */
    MesoMapOptions again = meso_map_options_resolve(kept, 9);
    CHECK(again.thickness == kept.thickness && again.section_scale == kept.section_scale);
    CHECK(again.divisions == kept.divisions && again.tangent_scale == kept.tangent_scale);

    /* The smallest and the largest surfaces have usable defaults. */
    const float edges[] = {MESO_SHORTEST_EDGE, 1, 3 * MESO_COORDINATE_LIMIT};
    for (int i = 0; i < 3; i++) {
        MesoMapOptions fine = meso_map_options_resolve((MesoMapOptions){0}, edges[i]);
        CHECK(!meso_map_options_problem(&fine));
    }
    MesoMapOptions wrong = all;
    wrong.tangent_scale = 2000;
    CHECK(strcmp(meso_map_options_problem(&wrong), "tangent scale") == 0);
    wrong = all;
    wrong.frame = 2;
    CHECK(strcmp(meso_map_options_problem(&wrong), "frame") == 0);
    wrong = all;
    wrong.tolerance = -1;
    CHECK(strcmp(meso_map_options_problem(&wrong), "tolerance") == 0);

    MesoMapOptions near = {.tolerance = 0.01f};     /* in edge lengths, or in scene units */
    CHECK(meso_map_options_tolerance(&all, 3) == 0 && meso_map_options_tolerance(&near, 2) == 0.02f);
    near.tolerance_in = MESO_TOLERANCE_SCENE;
    CHECK(fabsf(meso_map_options_tolerance(&near, 2) - 0.01f) < 1e-8f);
    return 0;
}
