/* What lines divide a mesh into once it is cut along them, for tests. */
#ifndef MESO_REGIONS_FIXTURE_H
#define MESO_REGIONS_FIXTURE_H

#include "libcore/base/disjoint_sets.h"
#include "libcore/mesh/cut/mesh_cut.h"
#include "libcore/mesh/cut/triangulation_fixture.h"

/* Cuts, and numbers the parts between walls in `region` [room]; returns how many there are. */
static inline uint32_t meso_fixture_cut(MesoTriangulation *mesh, const MesoCutLines *lines, uint32_t *region,
                                        uint32_t room)
{
    MesoArena arena;
    MesoCutReport report;
    MesoError error;
    uint32_t count = 0;
    meso_arena_init(&arena);
    CHECK(meso_mesh_cut(mesh, lines, &report, &arena, &error) == MESO_OK);
    CHECK(meso_triangulation_check(mesh, &error) == MESO_OK && mesh->triangle_count <= room);
    meso_sets_init(region, mesh->triangle_count);
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        if (!meso_side_is_wall(mesh, h))
            meso_sets_join(region, h / 3, mesh->twins[h] / 3);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        region[t] = meso_sets_root(region, t);
    for (uint32_t t = 0; t < mesh->triangle_count; t++)     /* roots come before the others of their set */
        region[t] = region[t] == t ? count++ : region[region[t]];
    meso_arena_release(&arena);
    return count;
}

static inline double meso_fixture_area(const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *corners = mesh->corners + 3 * (size_t)triangle;
    MesoVec3 a = meso_vec3_sub(mesh->positions[corners[1]], mesh->positions[corners[0]]);
    MesoVec3 b = meso_vec3_sub(mesh->positions[corners[2]], mesh->positions[corners[0]]);
    return 0.5 * meso_vec3_length(meso_vec3_cross(a, b));
}

#endif
