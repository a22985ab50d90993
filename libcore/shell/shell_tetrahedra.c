#include "libcore/shell/shell_tetrahedra.h"

#include "libcore/shell/prism_layer.h"
#include "libcore/shell/shell_stretch.h"

MesoShellPrism meso_shell_prism(const MesoShellMap *map, uint32_t triangle)
{
    MesoShellPrism prism;
    for (uint32_t k = 0; k < 6; k++) {
        uint32_t corner = 3 * triangle + k % 3, v = map->corners[corner], origin = map->origins[v];
        const double *uv = k < 3 ? map->low_uv : map->high_uv;
        double height = k < 3 ? map->low : map->high;
        prism.texture[k] = (MesoVec3d){uv[2 * (size_t)v], uv[2 * (size_t)v + 1], height};
        prism.shell[k] = meso_vec3d_mad(meso_vec3d(map->mesh->positions[origin]), height,
                                        meso_vec3d(map->directions[origin]));
    }
    /* by vertices of the mesh, so that charts agree at their seams */
    meso_prism_split(&map->mesh->corners[3 * (size_t)triangle], prism.tetrahedra);
    return prism;
}

void meso_shell_prism_part(const MesoShellPrism *prism, uint32_t part, MesoVec3d texture[4], MesoVec3d shell[4])
{
    for (uint32_t k = 0; k < 4; k++) {
        texture[k] = prism->texture[prism->tetrahedra[part][k]];
        shell[k] = prism->shell[prism->tetrahedra[part][k]];
    }
}

void meso_shell_prism_count(const MesoShellPrism *prism, uint32_t *negative_count, uint32_t *flat_count)
{
    for (uint32_t part = 0; part < 3; part++) {
        MesoVec3d texture[4], shell[4];
        meso_shell_prism_part(prism, part, texture, shell);
        double least = fmin(meso_tetrahedron_det(texture), meso_tetrahedron_det(shell));
        *negative_count += least < 0;
        *flat_count += least == 0;
    }
}

bool meso_shell_prism_stands(const MesoShellPrism *prism)
{
    /* as shares of what a prism of the same sides and height can have: floats tell no less */
    const double least = 1e-7;
    for (uint32_t part = 0; part < 3; part++) {
        MesoVec3d corners[2][4];
        meso_shell_prism_part(prism, part, corners[0], corners[1]);
        for (uint32_t side = 0; side < 2; side++) {
            double most = 1;
            for (uint32_t k = 1; k < 4; k++)
                most *= meso_vec3d_length(meso_vec3d_sub(corners[side][k], corners[side][0]));
            if (!(meso_tetrahedron_det(corners[side]) > least * most))
                return false;
        }
    }
    return true;
}
