/*
 * Tolerances on the fixture's small surfaces: how far the finely divided surface lies from the polygons that a
 * tolerance chooses, rings that neighbours share to the bit, corners that stay, and how few polygons it takes.
 */
#include <math.h>

#include "libcore/scene/sweep.h"
#include "libcore/tiling/strand/expansion_fixture.h"

typedef struct Meshed {
    MesoExpansion expansion;
    MesoScene scene;
    MesoSceneParts parts;
    MesoMeshFace *faces;
    const MesoMeshVertex *vertices;
} Meshed;

static void mesh(Meshed *m, const MesoModel *model, MesoArena *arena)
{
    m->scene = expand(model, &m->expansion, arena);
    m->vertices = make_polygons(&m->scene, arena, &m->parts, &m->faces);
}

static const MesoKindOrigin *origin_of(const Meshed *m, uint32_t part)
{
    return &m->expansion.origins[meso_scene_kind(&m->scene, part)];
}

static float distance_to_triangle(MesoVec3 p, MesoVec3 a, MesoVec3 b, MesoVec3 c)
{
    MesoVec3 ab = meso_vec3_sub(b, a), ac = meso_vec3_sub(c, a), n = meso_vec3_cross(ab, ac), ap = meso_vec3_sub(p, a);
    float nn = meso_vec3_dot(n, n), best = INFINITY;
    if (nn > 0) {
        float w = meso_vec3_dot(meso_vec3_cross(ab, ap), n) / nn, v = meso_vec3_dot(meso_vec3_cross(ap, ac), n) / nn;
        if (v >= 0 && w >= 0 && v + w <= 1)
            return fabsf(meso_vec3_dot(ap, n)) / sqrtf(nn);
    }
    const MesoVec3 ends[3][2] = {{a, b}, {b, c}, {c, a}};
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 d = meso_vec3_sub(ends[k][1], ends[k][0]), q = meso_vec3_sub(p, ends[k][0]);
        float l = meso_vec3_dot(d, d), t = l > 0 ? fmaxf(0, fminf(1, meso_vec3_dot(q, d) / l)) : 0;
        best = fminf(best, meso_vec3_length(meso_vec3_mad(q, -t, d)));
    }
    return best;
}

static float distance_to_part(const Meshed *m, uint32_t part, MesoVec3 p)
{
    float best = INFINITY;
    for (uint64_t f = m->parts.face_begin[part]; f < m->parts.face_begin[part + 1]; f++)
        for (uint32_t k = 2; k < 4 && m->faces[f].v[k] != MESO_NO_INDEX; k++)
            best = fminf(best, distance_to_triangle(p, m->vertices[m->faces[f].v[0]].position,
                                                    m->vertices[m->faces[f].v[k - 1]].position,
                                                    m->vertices[m->faces[f].v[k]].position));
    return best;
}

/* The part of `m` that is the same strand, or cap, as one of `other`. */
static uint32_t same_part(const Meshed *m, const Meshed *other, uint32_t part)
{
    const MesoKindOrigin *wanted = origin_of(other, part);
    for (uint32_t i = 0; i < m->scene.sweep_count; i++)
        if (m->scene.sweeps[i].ids == other->scene.sweeps[part].ids &&
            origin_of(m, i)->sweep == wanted->sweep && origin_of(m, i)->start_side == wanted->start_side &&
            origin_of(m, i)->start_section == wanted->start_section)
            return i;
    CHECK(false);
    return 0;
}

/* A grid of 2 x 2 slots whose strands bend, turn, change their shape and go there and back. */
static void make_case(Case *s, MesoArena *arena)
{
    static uint32_t tile[4];
    static MesoTransform transform[4];
    make_tile_set(s);
    s->sweeps[0].turn = 0.3f;
    s->sweeps[1].half_turn = true;
    make_grid(s, arena, 2, tile, transform);
    s->model.options = (MesoMapOptions){.frame = MESO_FRAME_MINIMAL, .section_scale = 1};
}

/* Of the exact surface in the middle between its columns, which are far apart on flat sides. */
static float error_between(const Meshed *exact, uint32_t part, const Meshed *coarse, uint32_t other)
{
    const MesoSweptKind *kind = &exact->scene.kinds[meso_scene_kind(&exact->scene, part)];
    const MesoSweepColumn *columns = exact->scene.columns + kind->column_begin;
    float worst = 0;
    for (uint32_t c = 0, i = 0; c + 1 < kind->column_count; c++) {
        MesoSweepColumn middle = columns[c];
        middle.start = meso_vec2_lerp(columns[c].start, columns[c + 1].start, 0.5f);
        middle.end = meso_vec2_lerp(columns[c].end, columns[c + 1].end, 0.5f);
        bool wide = meso_vec2_length(meso_vec2_sub(columns[c + 1].start, columns[c].start)) > 0.05f;
        for (uint32_t k = 1; columns[c].joins_next && (wide || i++ % 7 == 0) && k < 40; k += wide ? 1 : 13)
            worst = fmaxf(worst, distance_to_part(coarse, other, meso_sweep_point(&exact->scene, kind,
                                                                                  &exact->scene.sweeps[part], &middle,
                                                                                  (float)k / 40)));
    }
    return worst;
}

static float largest_error(const Meshed *exact, const Meshed *coarse)
{
    float worst = 0;
    for (uint32_t part = 0; part < exact->scene.sweep_count; part++) {
        uint32_t other = same_part(coarse, exact, part);
        uint64_t begin = exact->parts.vertex_begin[part], end = exact->parts.vertex_begin[part + 1];
        for (uint64_t v = begin; v < end; v += 61)
            worst = fmaxf(worst, distance_to_part(coarse, other, exact->vertices[v].position));
        worst = fmaxf(worst, error_between(exact, part, coarse, other));
    }
    return worst;
}

static void test_error(MesoArena *arena, uint32_t deform)
{
    static const float tolerances[] = {0.02f, 0.004f};
    Case s = {0};
    Meshed exact, coarse;
    make_case(&s, arena);
    s.model.options.deform = deform;
    float edge = s.model.surface.mean_edge_length;
    s.model.options.tolerance = 1e-4f;
    mesh(&exact, &s.model, arena);
    uint64_t triangles = 0;
    for (uint32_t i = 0; i < 2; i++) {
        s.model.options.tolerance = tolerances[i];
        mesh(&coarse, &s.model, arena);
        float worst = largest_error(&exact, &coarse);
        if (!(worst <= tolerances[i] * edge && worst > 0.1f * tolerances[i] * edge))
            fprintf(stderr, "deform %u, tolerance %g: %g, %llu triangles\n", deform,
                    (double)(tolerances[i] * edge), (double)worst, (unsigned long long)coarse.parts.triangle_count);
        CHECK(worst <= tolerances[i] * edge);
        CHECK(worst > 0.1f * tolerances[i] * edge);     /* no more than it takes */
        CHECK(coarse.parts.triangle_count > triangles);
        triangles = coarse.parts.triangle_count;
    }
    CHECK(triangles < exact.parts.triangle_count / 10);

    s.model.options.tolerance *= edge;      /* in scene units it is the same */
    s.model.options.tolerance_in = MESO_TOLERANCE_SCENE;
    mesh(&coarse, &s.model, arena);
    CHECK(coarse.parts.triangle_count == triangles);
}

/* Diagonals lean where that is nearer: with all of them the other way the surface is further off. */
static void test_diagonals(MesoArena *arena)
{
    Case s = {0};
    Meshed exact, coarse;
    make_case(&s, arena);
    s.model.options.tolerance = 1e-4f;
    mesh(&exact, &s.model, arena);
    s.model.options.tolerance = 0.02f;
    mesh(&coarse, &s.model, arena);
    float chosen = largest_error(&exact, &coarse);
    uint64_t leaning = 0;
    for (uint32_t i = 0; i < coarse.scene.sweep_count; i++)
        for (uint32_t k = 0; k < MESO_LEAN_WORDS; k++) {
            leaning |= coarse.scene.sweeps[i].steps.leans[k];
            coarse.scene.sweeps[i].steps.leans[k] = ~coarse.scene.sweeps[i].steps.leans[k];
        }
    coarse.vertices = make_polygons(&coarse.scene, arena, &coarse.parts, &coarse.faces);
    CHECK(leaning != 0 && largest_error(&exact, &coarse) > 1.25f * chosen);
}

/* The sharp corners of drawings are on every ring, twice, with the normals of both sides. */
static void test_corners(MesoArena *arena)
{
    Case s = {0};
    Meshed coarse;
    make_case(&s, arena);
    s.model.options.tolerance = 0.2f;
    mesh(&coarse, &s.model, arena);
    for (uint32_t k = 0; k < coarse.scene.kind_count; k++) {
        const MesoSweptKind *kind = &coarse.scene.kinds[k];
        if (coarse.expansion.origins[k].start_section == 1 && kind->cap)    /* the box that only a cap closes */
            CHECK(kind->column_count >= 8 && kind->joint_count >= 4);
        for (uint32_t c = 0; c < kind->column_count; c++)
            CHECK(c + 1 < kind->column_count || !coarse.scene.columns[kind->column_begin + c].joins_next);
    }
}

/*
 * Between drawings that need their points in different places, rings have about as many as each drawing has, not those
 * of both; and every row joins what it lies between.
 */
static void test_between(MesoArena *arena)
{
    Case s = {0};
    Meshed coarse;
    MesoError error;
    uint32_t fewer = 0;
    make_case(&s, arena);
    s.model.options.tolerance = 0.002f;
    mesh(&coarse, &s.model, arena);
    for (uint32_t k = 0; k < coarse.scene.kind_count; k++) {
        const MesoSweptKind *kind = &coarse.scene.kinds[k];
        uint32_t between = kind->column_count - kind->absent[2];
        CHECK(kind->absent[2] == 0 || kind->division_count > 2);
        fewer += kind->absent[2] > 0 && 3 * between < 2 * kind->column_count;
    }
    CHECK(fewer > 0);
    for (uint32_t part = 0; part < coarse.scene.sweep_count; part++) {
        uint64_t used = 0, count = coarse.parts.vertex_begin[part + 1] - coarse.parts.vertex_begin[part];
        uint8_t *seen = MESO_NEW(arena, uint8_t, count, &error);
        for (uint64_t f = coarse.parts.face_begin[part]; f < coarse.parts.face_begin[part + 1]; f++)
            for (uint32_t i = 0; i < 4 && coarse.faces[f].v[i] != MESO_NO_INDEX; i++) {
                uint64_t v = coarse.faces[f].v[i] - coarse.parts.vertex_begin[part];
                CHECK(v < count);
                used += !seen[v];
                seen[v] = 1;
            }
        CHECK(used == count || origin_of(&coarse, part)->sweep == MESO_NO_INDEX);   /* a cap meets in one point */
    }
}

/* However a section turns on the way to another, what turns inside out there takes no columns of its own. */
static void test_turned(MesoArena *arena)
{
    uint32_t straight = 0;
    for (uint32_t i = 0; i < 10; i++) {
        Case s = {0};
        Meshed coarse;
        uint32_t most = 0;
        make_case(&s, arena);
        s.sweeps[0].turn = s.sweeps[1].turn = 0.1f * (float)i;
        s.model.options.tolerance = 0.002f;
        mesh(&coarse, &s.model, arena);
        for (uint32_t k = 0; k < coarse.scene.kind_count; k++)
            most = most > coarse.scene.kinds[k].column_count ? most : coarse.scene.kinds[k].column_count;
        straight = i == 0 ? most : straight;
        CHECK(most <= 2 * straight);
    }
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_error(&arena, MESO_SWEEP_CURVES);
    test_error(&arena, MESO_SWEEP_SHAPE);
    test_diagonals(&arena);
    test_corners(&arena);
    test_between(&arena);
    test_turned(&arena);
    meso_arena_release(&arena);
    return 0;
}
