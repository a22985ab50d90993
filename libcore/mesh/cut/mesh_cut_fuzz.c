/* The cut: on meshes that are hard to cut, along lines that meet, overlap and cross, it keeps what it promises. */
#include "libcore/mesh/cut/mesh_cut_fixture.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { ROUNDS = 3, LARGEST = 3000 };

static MesoTriangulation choose_mesh(MesoChoices *choices)
{
    switch (meso_choose(choices, 6)) {
    case 0: return meso_fixture_sheet(1, 1, 1);
    case 1: return meso_fixture_sheet(3, 2, 0.1f);
    case 2: return meso_fixture_torus(3 + meso_choose(choices, 2), 3, 0.4f);
    case 3: return meso_fixture_moebius(5 + 2 * meso_choose(choices, 3));
    case 4: return meso_fixture_pillow();
    default: return meso_fixture_crumpled(choices, 2);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoArena arena;
    MesoChoices choices = {.bytes = data, .left = size};
    MesoTriangulation mesh = choose_mesh(&choices);
    meso_arena_init(&arena);
    for (uint32_t round = 0; round < ROUNDS && choices.left > 0 && mesh.triangle_count < LARGEST; round++) {
        MesoCutLines lines;
        MesoCutReport report;
        meso_choose_lines(&lines, &arena, &choices, &mesh, 1 + meso_choose(&choices, 6));
        meso_fixture_cut(&mesh, &lines, &report, &arena);
    }
    meso_triangulation_release(&mesh);
    meso_arena_release(&arena);
    return 0;
}
