#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/finish/finish_work.h"
#include "libcore/quilt/quilt_work.h"
#include "libcore/quilt/swatch/swatch_make.h"

/* A cloth of two patches, or ivy of one, on a plane around it. */
typedef struct Cloth {
    MesoArena arena;
    MesoSwatch swatch;
    MesoTriangulation plane;
    MesoQuiltBase base;
    MesoQuilt quilt;
} Cloth;

enum { SQUARES = 12 };
#define PLANE 8.0f
#define MARGIN 2.0f

static MesoQuiltVertex place_at(const MesoTriangulation *mesh, MesoVec3 p)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        const uint32_t *c = &mesh->corners[3 * (size_t)t];
        MesoVec3 o = mesh->positions[c[0]], a = meso_vec3_sub(mesh->positions[c[1]], o);
        MesoVec3 b = meso_vec3_sub(mesh->positions[c[2]], o), q = meso_vec3_sub(p, o);
        float area = a.x * b.y - a.y * b.x, u = (q.x * b.y - q.y * b.x) / area, v = (a.x * q.y - a.y * q.x) / area;
        if (u >= -1e-5f && v >= -1e-5f && u + v <= 1.00002f)
            return (MesoQuiltVertex){t, u, v, p.z};
    }
    fprintf(stderr, "a point is off the base\n");
    exit(1);
}

static MesoVec3 point_of(const Cloth *cloth, uint32_t v)
{
    MesoFinishWork work = {.base = &cloth->base};
    MesoVec3 p = meso_finish_foot(&work, cloth->quilt.vertices[v]);
    p.z = cloth->quilt.vertices[v].height;
    return p;
}

/* What a vertex of the swatch is moved by: waves along and across, so large. */
static MesoVec3 bent(MesoVec3 p, float size)
{
    return (MesoVec3){p.x + MARGIN + size * sinf(1.5f * p.y), p.y + MARGIN + size * sinf(1.2f * p.x), p.z};
}

static void init(Cloth *cloth, const char *recipe_name, float size)
{
    MesoError error;
    MesoPolygonMesh mesh;
    meso_arena_init(&cloth->arena);
    const MesoSwatchRecipe recipe = {.name = recipe_name, .columns = 4, .rows = 4, .jitter = 0.05f, .sides = 6};
    CHECK(meso_swatch_make(&mesh, &cloth->arena, &recipe, &error) == MESO_OK);
    const MesoSwatchOptions options = {.up = 2};
    CHECK(meso_swatch_build(&cloth->swatch, &cloth->arena, &mesh, &options, &error) == MESO_OK);
    cloth->plane = meso_fixture_sheet(SQUARES, SQUARES, PLANE / SQUARES);
    CHECK(meso_quilt_base_build(&cloth->base, &cloth->arena, &cloth->plane, NULL, 2, 1, &error) == MESO_OK);
    const MesoSwatch *s = &cloth->swatch;
    MesoQuilt *q = &cloth->quilt;
    *q = (MesoQuilt){.vertex_count = s->vertex_count, .triangle_count = s->triangle_count,
                     .element_count = s->element_count, .corners = s->corners, .vertex_begin = s->vertex_begin,
                     .triangle_begin = s->triangle_begin};
    q->element_origins = MESO_NEW(&cloth->arena, uint32_t, s->element_count, &error);
    CHECK(q->element_origins);
    for (uint32_t e = 0; e < s->element_count; e++)
        q->element_origins[e] = e;
    q->vertices = MESO_NEW(&cloth->arena, MesoQuiltVertex, s->vertex_count, &error);
    q->origins = MESO_NEW(&cloth->arena, uint32_t, s->vertex_count, &error);
    q->patches = MESO_NEW(&cloth->arena, uint32_t, s->triangle_count, &error);
    CHECK(q->vertices && q->origins && q->patches);
    for (uint32_t v = 0; v < s->vertex_count; v++) {
        q->vertices[v] = place_at(&cloth->base.mesh, bent(s->positions[v], size));
        q->origins[v] = v;
    }
    MesoStrandRings rings;
    CHECK(meso_strands_find_rings(&rings, s, &cloth->arena, &error) == MESO_OK);
    bool of_one = strcmp(recipe_name, "weave") != 0;
    for (uint32_t c = 0; c < 3 * s->triangle_count && !of_one; c++)      /* cut between rings: bands are the second's */
        q->patches[c / 3] |= rings.middles[rings.of_vertex[s->corners[c]]].x > 0.45f * s->size.x;
}

static void release(Cloth *cloth)
{
    meso_quilt_base_release(&cloth->base);
    meso_triangulation_release(&cloth->plane);
    meso_arena_release(&cloth->arena);
}

static void relax_by(Cloth *cloth, uint32_t thread_count)
{
    MesoError error;
    const MesoFinishOptions options = {.scale = 1, .thread_count = thread_count};
    MesoFinishWork work = {.base = &cloth->base, .swatch = &cloth->swatch, .options = &options,
                           .arena = &cloth->arena};
    CHECK(meso_finish_relax(&cloth->quilt, &work, &error) == MESO_OK);
}

static void relax(Cloth *cloth)
{
    relax_by(cloth, 0);
}

/* By how much vertices some pitches apart are nearer or farther than in the swatch: root of the mean square. */
static double strain(const Cloth *cloth)
{
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t v = 0; v < cloth->swatch.vertex_count; v += 5)
        for (uint32_t w = v + 1; w < cloth->swatch.vertex_count; w += 7) {
            MesoVec3 there = meso_vec3_sub(cloth->swatch.positions[w], cloth->swatch.positions[v]);
            float apart = meso_vec3_length(there);
            if (apart < 2 || apart > 3)
                continue;
            double off = (double)(meso_vec3_length(meso_vec3_sub(point_of(cloth, w), point_of(cloth, v))) - apart);
            sum += off * off;
            count++;
        }
    return sqrt(sum / count);
}

/* The same of vertices of one ring, which are near each other. */
static double section_strain(Cloth *cloth)
{
    MesoError error;
    MesoStrandRings rings;
    double sum = 0;
    uint32_t count = 0;
    CHECK(meso_strands_find_rings(&rings, &cloth->swatch, &cloth->arena, &error) == MESO_OK);
    for (uint32_t v = 0; v < cloth->swatch.vertex_count; v++)
        for (uint32_t w = v > 8 ? v - 8 : 0; w < v; w++) {
            if (rings.of_vertex[v] != rings.of_vertex[w])
                continue;
            MesoVec3 there = meso_vec3_sub(cloth->swatch.positions[w], cloth->swatch.positions[v]);
            MesoVec3 here = meso_vec3_sub(point_of(cloth, w), point_of(cloth, v));
            double off = (double)(meso_vec3_length(here) - meso_vec3_length(there));
            sum += off * off;
            count++;
        }
    CHECK(count > cloth->swatch.vertex_count);
    return sqrt(sum / count);
}

static void test_bent(void)
{
    Cloth cloth;
    init(&cloth, "weave", 0.12f);
    double before = strain(&cloth);
    relax(&cloth);
    CHECK(before > 0.05);
    CHECK(strain(&cloth) < 0.4 * before);
    release(&cloth);
}

/* Strands that have been made wider, narrower and askew have the sections of the swatch again. */
static void test_sections(void)
{
    Cloth cloth;
    init(&cloth, "weave", 0.12f);
    for (uint32_t v = 0; v < cloth.quilt.vertex_count; v++)
        cloth.quilt.vertices[v].height *= 1.2f;
    double before = section_strain(&cloth);
    relax(&cloth);
    CHECK(before > 0.02);
    CHECK(section_strain(&cloth) < 1e-3 * before);
    release(&cloth);
}

/* Strands that have drifted up and down, each patch its own way, rise and fall as in the swatch again. */
static void test_heights(void)
{
    Cloth cloth;
    double before = 0, after = 0;
    init(&cloth, "weave", 0.12f);
    const MesoSwatch *s = &cloth.swatch;
    for (uint32_t c = 0; c < 3 * s->triangle_count; c++) {
        uint32_t v = s->corners[c];
        if (cloth.quilt.patches[c / 3])
            cloth.quilt.vertices[v].height = s->positions[v].z + 0.3f + 0.1f * s->positions[v].y;
    }
    for (uint32_t v = 0; v < s->vertex_count; v++)
        before = fmax(before, fabs((double)(cloth.quilt.vertices[v].height - s->positions[v].z)));
    relax(&cloth);
    for (uint32_t v = 0; v < s->vertex_count; v++)
        after = fmax(after, fabs((double)(cloth.quilt.vertices[v].height - s->positions[v].z)));
    CHECK(before > 0.3);
    CHECK(after < 0.03);
    release(&cloth);
}

/* What lies as in the swatch stays, to the bit. */
static void test_straight(void)
{
    Cloth cloth;
    init(&cloth, "weave", 0);
    size_t size = cloth.quilt.vertex_count * sizeof *cloth.quilt.vertices;
    MesoQuiltVertex *before = malloc(size);
    CHECK(before);
    memcpy(before, cloth.quilt.vertices, size);
    relax(&cloth);
    CHECK(memcmp(before, cloth.quilt.vertices, size) == 0);
    free(before);
    release(&cloth);
}

/* By how much leaves are nearer to stems or farther from them than in the swatch. */
static double leaf_strain(const Cloth *cloth)
{
    const MesoSwatch *s = &cloth->swatch;
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t e = 0; e < s->element_count; e++)
        for (uint32_t v = s->vertex_begin[e]; v < s->vertex_begin[e + 1] && s->kinds[e] == MESO_ELEMENT_WHOLE; v++)
            for (uint32_t w = 0; w < s->vertex_count; w++) {
                float apart = meso_vec3_length(meso_vec3_sub(s->positions[w], s->positions[v]));
                if (apart > 0.3f)
                    continue;
                double off = (double)(meso_vec3_length(meso_vec3_sub(point_of(cloth, w), point_of(cloth, v))) - apart);
                sum += off * off;
                count++;
            }
    CHECK(count > s->vertex_count);
    return sqrt(sum / count);
}

/* Leaves that stand too high, on stems that are bent, come back to these and are as in the swatch. */
static void test_carried(void)
{
    Cloth cloth;
    init(&cloth, "ivy", 0.12f);
    const MesoSwatch *s = &cloth.swatch;
    for (uint32_t e = 0; e < s->element_count; e++)
        for (uint32_t v = s->vertex_begin[e]; v < s->vertex_begin[e + 1] && s->kinds[e] == MESO_ELEMENT_WHOLE; v++)
            cloth.quilt.vertices[v].height += 0.1f;
    double before = strain(&cloth), leaves_before = leaf_strain(&cloth);
    relax(&cloth);
    CHECK(before > 0.05 && leaves_before > 0.02);
    CHECK(strain(&cloth) < 0.5 * before);
    CHECK(leaf_strain(&cloth) < 0.2 * leaves_before);
    release(&cloth);
}

/* The same to the bit by any number of threads. */
static void test_threads(void)
{
    Cloth one, many;
    init(&one, "weave", 0.12f);
    init(&many, "weave", 0.12f);
    for (uint32_t t = 0; t < one.quilt.triangle_count; t++)     /* patches to guess between */
        one.quilt.patches[t] = many.quilt.patches[t] = t % 3;
    relax_by(&one, 1);
    relax_by(&many, 7);
    CHECK(memcmp(one.quilt.vertices, many.quilt.vertices, one.quilt.vertex_count * sizeof *one.quilt.vertices) == 0);
    release(&one);
    release(&many);
}

int main(void)
{
    test_threads();
    test_bent();
    test_sections();
    test_carried();
    test_heights();
    test_straight();
    return 0;
}
