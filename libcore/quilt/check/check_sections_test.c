/* A swatch's own strands are as thick as they are; those of one that is drawn thinner somewhere are not. */
#include "libcore/base/check.h"
#include "libcore/quilt/check/check_sections.h"
#include "libcore/quilt/swatch/swatch_make.h"

/* Twice as large and turned; in the left half the strands' sides lie so much deeper. */
static MesoSections measure(const char *recipe, float thinner)
{
    MesoArena arena;
    MesoError error;
    MesoPolygonMesh mesh;
    MesoSwatch s;
    MesoCheckMesh sample, laid;
    MesoSections sections;
    meso_arena_init(&arena);
    CHECK(meso_swatch_make(&mesh, &arena, &(MesoSwatchRecipe){.name = recipe, .jitter = 0.05f}, &error) == MESO_OK);
    CHECK(meso_swatch_build(&s, &arena, &mesh, &(MesoSwatchOptions){.up = 2}, &error) == MESO_OK);
    CHECK(meso_check_mesh_of_swatch(&sample, &arena, &s, &error) == MESO_OK);
    MesoVec3 *positions = MESO_NEW(&arena, MesoVec3, s.vertex_count, &error);
    uint32_t *elements = MESO_NEW(&arena, uint32_t, s.element_count, &error);
    uint32_t *triangles = MESO_NEW(&arena, uint32_t, s.triangle_count, &error);
    CHECK(positions && elements && triangles);
    for (uint32_t e = 0; e < s.element_count; e++)
        elements[e] = e;
    for (uint32_t t = 0; t < s.triangle_count; t++)
        triangles[t] = t;
    for (uint32_t v = 0; v < s.vertex_count; v++) {
        MesoVec3 p = s.positions[v];
        /* normals of a strand point away from its middle line */
        p = p.x < s.size.x / 2 ? meso_vec3_mad(p, -thinner, s.normals[v]) : p;
        positions[v] = (MesoVec3){2 * p.y, -2 * p.x, 2 * p.z};
    }
    laid = sample;
    laid.positions = positions;
    const MesoQuilt quilt = {.element_origins = elements, .triangle_origins = triangles};
    meso_check_sections(&sections, &laid, &sample, &quilt, &s, 4);
    meso_arena_release(&arena);
    return sections;
}

int main(void)
{
    MesoSections k = measure("wire", 0);
    CHECK(k.count > 3000 && k.changed_count == 0 && fabs(k.least - 1) < 1e-3 && k.rms < 1e-4);
    k = measure("weave", 0);
    CHECK(k.count > 3000 && k.changed_count == 0 && fabs(k.largest - 1) < 1e-3);
    /* half the strands' triangles */
    k = measure("wire", 0.05f);
    CHECK(k.changed_count > 2 * k.count / 5 && k.changed_count < 3 * k.count / 5 && k.least < 0.5 && k.largest < 1.01);
    k = measure("mail", 0);
    CHECK(k.count == 0 && k.changed_count == 0 && k.least == 1 && k.largest == 1);
    return 0;
}
