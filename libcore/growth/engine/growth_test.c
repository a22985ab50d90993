/* Growth by what it promises: what does not cross, keeps clear, joins, and stays the same. */
#include "libcore/growth/engine/growth_fixture.h"

int main(void)
{
    MesoGrowthScenery scenery;
    MesoArena arena;
    meso_arena_init(&arena);
    meso_scenery_init(&scenery, meso_fixture_sphere(32, 0.1f, 1));
    meso_scenery_read(&scenery, "meso-grow 1\nunit m\nshape cord = tube\nlimit generations 100\n"
                      "seed Shoot(10 mm) on vertices\n"
                      "rule Shoot(w) -> {\n turn(normal(0, 12 deg))\n"
                      " step(3 cm, shape: cord, width: w, end: 0.99*w) else retry(3, 70 deg)\n"
                      " choose { 80%: Shoot(0.99*w) 20%: { branch { turn(normal(45 deg, 8 deg)) Shoot(0.8*w) } Shoot(0.99*w) } } }\n");
    meso_scenery_strew(&scenery, 18, 5);
    MesoGrown grown = meso_scenery_grow(&scenery, &arena, 1);
    printf("%u elements %u joints %u branches %u generations, length %g, end %d refused %lu\n", grown.element_count, grown.joint_count, grown.branch_count, grown.generation_count, grown.length, grown.end, grown.rules[0].refused);
    return 0;
}
