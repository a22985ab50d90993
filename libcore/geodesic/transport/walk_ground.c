#include "libcore/geodesic/transport/walk_ground.h"

#include "libcore/base/parallel.h"
#include "libcore/geodesic/exact/unfold.h"
#include "libcore/mesh/cut/mesh_domain.h"

typedef struct Build {
    const MesoWalkGround *ground;
    const MesoTriangulation *mesh;
    const MesoDomain *domain;
} Build;

static double square_of_side(const MesoTriangulation *mesh, uint32_t half_edge)
{
    MesoVec3 a = mesh->positions[mesh->corners[half_edge]];
    MesoVec3 b = mesh->positions[mesh->corners[meso_next_corner(half_edge)]];
    double x = (double)b.x - a.x, y = (double)b.y - a.y, z = (double)b.z - a.z;
    return x * x + y * y + z * z;
}

/* Squares are compared, not lengths: the side has to be that of meso_frame(), which does so. */
static uint32_t longest_side(const MesoTriangulation *mesh, uint32_t triangle)
{
    uint32_t longest = 0;
    double most = 0;
    for (uint32_t k = 0; k < 3; k++) {
        double square = square_of_side(mesh, 3 * triangle + k);
        longest = square > most ? k : longest;
        most = fmax(square, most);
    }
    return longest;
}

static MesoComplex apex_over(const MesoSideShape *shape)
{
    if (!(shape->length > 0))
        return (MesoComplex){0, 0};
    return (MesoComplex){shape->x / shape->length, shape->y / shape->length};
}

static void build_face(const Build *build, uint32_t triangle)
{
    const MesoTriangulation *mesh = build->mesh;
    MesoWalkFace *face = &build->ground->faces[triangle];
    uint32_t base = longest_side(mesh, triangle);
    face->marks = base << 3;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t half_edge = 3 * triangle + k, across = meso_domain_across(build->domain, mesh, half_edge);
        MesoSideShape shape = meso_side_shape(mesh, mesh->positions, half_edge);
        face->twins[k] = across;
        face->apexes[k] = apex_over(&shape);
        if (across != MESO_NO_INDEX && mesh->corners[across] == mesh->corners[half_edge])
            face->marks |= 1u << k;
        if (k == base)
            build->ground->lengths[triangle] = shape.length;
    }
}

static void build_faces(void *context, uint64_t begin, uint64_t end)
{
    for (uint64_t t = begin; t < end; t++)
        build_face(context, (uint32_t)t);
}

MesoStatus meso_walk_ground_build(MesoWalkGround *ground, MesoArena *arena, const MesoTriangulation *mesh,
                                  const MesoDomain *domain, uint32_t thread_count, MesoError *error)
{
    *ground = (MesoWalkGround){.triangle_count = mesh->triangle_count};
    ground->faces = MESO_NEW(arena, MesoWalkFace, mesh->triangle_count, error);
    ground->lengths = MESO_NEW(arena, double, mesh->triangle_count, error);
    if (!ground->faces || !ground->lengths)
        return MESO_ERR_MEMORY;
    Build build = {ground, mesh, domain};
    meso_parallel_for(thread_count, mesh->triangle_count, 4096, build_faces, &build);
    return MESO_OK;
}
