/*
 * Trajectories, ports, expansions and their polygons on small curved
 * surfaces: equal floats across edges, mirror images, winding, volumes.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/math/bezier.h"
#include "libcore/scene/cell.h"
#include "libcore/tiling/strand/expansion_fixture.h"
#include "libcore/tiling/strand/trajectory.h"

/* A quarter circle is met to 3e-4 of its radius (the known error of its cubic), a straight line exactly. */
static void test_trajectory(void)
{
    MesoPort east = {{1, 0.5f, 0}, {0, 0, 1}, {-1, 0, 0}}, north = {{0.5f, 1, 0}, {0, 0, 1}, {0, -1, 0}};
    MesoPort west = {{0, 0.5f, 0}, {0, 0, 1}, {1, 0, 0}};
    MesoVec3 p[4];
    meso_trajectory(&east, &north, false, 1, p);
    for (int i = 0; i <= 16; i++) {
        MesoVec3 d = meso_vec3_sub(meso_bezier_point(p, (float)i / 16), (MesoVec3){1, 1, 0});
        CHECK(fabsf(meso_vec3_length(d) - 0.5f) < 3e-4f * 0.5f);
    }
    meso_trajectory(&east, &west, false, 1, p);
    for (int i = 0; i <= 16; i++)
        CHECK(meso_bezier_point(p, (float)i / 16).y == 0.5f);
    CHECK(p[1].x < 1 && p[2].x > 0 && p[1].x > p[2].x);

    /* There and back on one side: the handles are those of a half circle over the distance. */
    MesoPort west2 = west;
    west2.point.y = 0.7f;
    meso_trajectory(&west, &west2, true, 1, p);
    CHECK(fabsf(p[1].x - 0.2f * 4 * (sqrtf(2) - 1) / 3) < 1e-6f && p[1].x == p[2].x);
}

/* Is `v` among the `count` positions, to the bit? */
static bool contains(const MesoMeshVertex *vertices, uint32_t count, MesoVec3 v)
{
    for (uint32_t i = 0; i < count; i++)
        if (memcmp(&vertices[i].position, &v, sizeof v) == 0)
            return true;
    return false;
}

/*
 * Across every inner edge each ring of one slot is, as a set of floats, a ring
 * of the other. Identity everywhere: side 0 (label a) meets side 2 (a'), side 1 (b)
 * meets side 3 (b'); sweeps 0 and 1 go on, the last loops on side 3 and caps stand opposite.
 */
static void test_same_floats(MesoArena *arena, MesoMapOptions options)
{
    Case s = {0};
    uint32_t tile[9] = {0};
    MesoTransform transform[9] = {0};
    make_tile_set(&s);
    make_grid(&s, arena, 3, tile, transform);
    options.divisions = s.model.options.divisions;
    s.model.options = options;
    MesoExpansion expansion;
    MesoScene scene = expand(&s.model, &expansion, arena);
    MesoSceneParts t;
    MesoMeshFace *faces;
    MesoMeshVertex *vertices = make_polygons(&scene, arena, &t, &faces);

    uint32_t met = 0;
    for (uint32_t a = 0; a < scene.sweep_count; a++)
        for (uint32_t b = 0; b < scene.sweep_count; b++) {
            const MesoKindOrigin *ka = &expansion.origins[meso_scene_kind(&scene, a)];
            const MesoKindOrigin *kb = &expansion.origins[meso_scene_kind(&scene, b)];
            uint32_t sa = scene.sweeps[a].ids, sb = scene.sweeps[b].ids;
            bool east = sb == sa + 1 && sa % 3 < 2, north = sb == sa + 3;
            for (int ends = 0; ends < 4; ends++) {
                bool end_a = ends & 1, end_b = ends & 2;
                if ((ka->sweep == MESO_NO_INDEX && end_a) || (kb->sweep == MESO_NO_INDEX && end_b))
                    continue;
                uint32_t side_a = end_a ? ka->end_side : ka->start_side;
                uint32_t side_b = end_b ? kb->end_side : kb->start_side;
                uint32_t section_a = end_a ? ka->end_section : ka->start_section;
                uint32_t section_b = end_b ? kb->end_section : kb->start_section;
                if (section_a != section_b || !((east && side_a == 0 && side_b == 2) ||
                                                (north && side_a == 1 && side_b == 3)))
                    continue;
                uint32_t na, nb;
                const MesoMeshVertex *ra = ring(&t, vertices, a, end_a, &na);
                const MesoMeshVertex *rb = ring(&t, vertices, b, end_b, &nb);
                for (uint32_t i = 0; i < na; i++)
                    CHECK(contains(rb, nb, ra[i].position));
                for (uint32_t i = 0; i < nb; i++)
                    CHECK(contains(ra, na, rb[i].position));
                met++;
            }
        }
    CHECK(met == 6 * 2 + 6 * 2);    /* two cross-sections on each of the 12 inner edges */
}

static double distance_to_nearest(const MesoMeshVertex *v, uint64_t count, MesoVec3 p)
{
    double best = INFINITY;
    for (uint64_t i = 0; i < count; i++)
        best = fmin(best, (double)meso_vec3_length(meso_vec3_sub(v[i].position, p)));
    return best;
}

/*
 * A tile under flip x on a face, and the mirror image of the tile as it is on
 * the mirror image of the face, are mirror images of each other: sweeps, caps
 * and inner meshes. The mirrored face lists its corners so that it stays
 * counter-clockwise and its side 0 is the image of the old side 2.
 */
static void test_mirror(MesoArena *arena)
{
    Case a = {0}, b = {0};
    uint32_t tile[1] = {0};
    MesoTransform flip[1] = {meso_transform_make(true, false, 0)}, identity[1] = {0};
    make_tile_set(&a);
    make_tile_set(&b);
    make_grid(&a, arena, 1, tile, flip);
    make_grid(&b, arena, 1, tile, identity);
    b.model.surface = a.model.surface;
    MesoVec3 positions[4], normals[4];
    uint32_t corners[4];
    for (uint32_t i = 0; i < 4; i++) {
        positions[i] = a.model.surface.positions[i];
        normals[i] = a.model.surface.normals[i];
        positions[i].x *= -1;
        normals[i].x *= -1;
        corners[i] = a.model.surface.face_vertices[3 - i];
    }
    b.model.surface.positions = positions;
    b.model.surface.normals = normals;
    b.model.surface.face_vertices = corners;
    b.model.surface.face_normals = corners;
    uint32_t normal_of[4];
    for (uint32_t i = 0; i < 4; i++)
        normal_of[i] = a.model.surface.face_normals[3 - i];
    b.model.surface.face_normals = normal_of;

    MesoScene sa = expand(&a.model, NULL, arena), sb = expand(&b.model, NULL, arena);
    MesoSceneParts ta, tb;
    MesoMeshFace *fa, *fb;
    MesoMeshVertex *va = make_polygons(&sa, arena, &ta, &fa), *vb = make_polygons(&sb, arena, &tb, &fb);
    CHECK(ta.part_count == tb.part_count && ta.triangle_count == tb.triangle_count);
    for (uint32_t part = 0; part < ta.part_count; part++) {
        uint64_t begin = ta.vertex_begin[part], count = ta.vertex_begin[part + 1] - begin;
        for (uint64_t i = 0; i < count; i++) {
            MesoVec3 p = va[begin + i].position;
            p.x *= -1;
            CHECK(distance_to_nearest(vb + tb.vertex_begin[part], count, p) < 2e-6);
        }
    }
    /* And not the same shape unmirrored: the drawings are lopsided. */
    double worst = 0;
    for (uint64_t i = 0; i < ta.vertex_begin[1]; i++)
        worst = fmax(worst, distance_to_nearest(vb, tb.vertex_begin[1], va[i].position));
    CHECK(worst > 1e-2);
}

static MesoVec3 face_normal(const MesoMeshVertex *v, const MesoMeshFace *f, uint32_t second, uint32_t third)
{
    return meso_vec3_cross(meso_vec3_sub(v[f->v[second]].position, v[f->v[0]].position),
                           meso_vec3_sub(v[f->v[third]].position, v[f->v[0]].position));
}

/* Every face that has an area looks to where its vertices' normals point, mirrored slots too. */
static void test_winding(MesoArena *arena)
{
    for (MesoTransform transform = 0; transform < MESO_TRANSFORM_COUNT; transform++) {
        Case s = {0};
        uint32_t tile[1] = {0};
        make_tile_set(&s);
        make_grid(&s, arena, 1, tile, &transform);
        MesoScene scene = expand(&s.model, NULL, arena);
        MesoSceneParts t;
        MesoMeshFace *faces;
        MesoMeshVertex *v = make_polygons(&scene, arena, &t, &faces);
        for (uint64_t f = 0; f < t.face_begin[t.part_count]; f++) {
            bool quad = faces[f].v[3] != MESO_NO_INDEX;
            MesoVec3 geometric = face_normal(v, &faces[f], 1, 2), shaded = {0, 0, 0};
            if (quad)
                geometric = meso_vec3_add(geometric, face_normal(v, &faces[f], 2, 3));
            for (int k = 0; k < (quad ? 4 : 3); k++) {
                CHECK(meso_vec3_finite(v[faces[f].v[k]].position));
                CHECK(fabsf(meso_vec3_length(v[faces[f].v[k]].normal) - 1) < 1e-5f);
                shaded = meso_vec3_add(shaded, v[faces[f].v[k]].normal);
            }
            CHECK(meso_vec3_dot(geometric, shaded) > 0);
        }
    }
}

/*
 * A surface that is wound against its normals: it and all on it are the mirror image of one that is not, faces of which
 * the one looks up and the other down, and look outward all the same.
 */
static void test_against_normals(MesoArena *arena, uint32_t deform)
{
    Case a = {0}, b = {0};
    uint32_t tile[9] = {0};
    MesoTransform transform[9] = {0};
    make_tile_set(&a);
    make_tile_set(&b);
    make_grid(&a, arena, 3, tile, transform);
    make_grid(&b, arena, 3, tile, transform);
    a.model.options.deform = b.model.options.deform = deform;
    for (uint32_t i = 0; i < b.model.surface.vertex_count; i++)
        b.model.surface.positions[i].z *= -1;
    for (uint32_t i = 0; i < b.model.surface.normal_count; i++)
        b.model.surface.normals[i].z *= -1;

    MesoExpansion ea, eb;
    MesoScene sa = expand(&a.model, &ea, arena), sb = expand(&b.model, &eb, arena);
    MesoSceneParts ta, tb;
    MesoMeshFace *fa, *fb;
    MesoMeshVertex *va = make_polygons(&sa, arena, &ta, &fa), *vb = make_polygons(&sb, arena, &tb, &fb);
    CHECK(ta.part_count == tb.part_count);
    for (uint32_t part = 0; part < ta.part_count; part += 5) {
        uint64_t begin = ta.vertex_begin[part], count = ta.vertex_begin[part + 1] - begin;
        for (uint64_t i = 0; i < count; i += 3) {
            MesoVec3 p = va[begin + i].position;
            p.z *= -1;
            CHECK(distance_to_nearest(vb + tb.vertex_begin[part], count, p) < 4e-6);
        }
    }
    for (uint64_t f = 0; f < tb.face_begin[tb.part_count]; f++)
        CHECK(meso_vec3_dot(face_normal(vb, &fb[f], 1, 2), vb[fb[f].v[0]].normal) >= 0 ||
              meso_vec3_dot(face_normal(va, &fa[f], 1, 2), va[fa[f].v[0]].normal) < 0);
    CHECK(eb.origins[0].mirrored && !ea.origins[0].mirrored);
}

/* Six times the signed volume under the faces [begin, end) of closed pieces. */
static double volume6(const MesoMeshVertex *v, const MesoMeshFace *faces, uint64_t begin, uint64_t end)
{
    double sum = 0;
    for (uint64_t f = begin; f < end; f++)
        for (int k = 2; k < 4 && faces[f].v[k] != MESO_NO_INDEX; k++)
            sum += (double)meso_vec3_dot(v[faces[f].v[0]].position,
                                         meso_vec3_cross(v[faces[f].v[k - 1]].position, v[faces[f].v[k]].position));
    return sum;
}

/*
 * On a flat unit slot a cap closes against the wall: with the wall's own
 * polygon its volume is the cross-section's area times the integral of
 * (1 - v^4)^2 over the rise, 0.125 * 32/45, met to the coarseness of its rings.
 * An inner mesh keeps the tetrahedron's volume times the determinant.
 */
static void test_volumes(MesoArena *arena)
{
    Case s = {0};
    uint32_t tile[1] = {0};
    MesoTransform transform[1] = {0};
    MesoVec3 flat[4] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, up = {0, 0, 1};
    uint32_t corners[4] = {0, 1, 2, 3}, normals[4] = {0, 0, 0, 0};
    MesoError error;
    make_tile_set(&s);
    make_grid(&s, arena, 1, tile, transform);
    s.model.options = (MesoMapOptions){.divisions = 400, .section_step = 0.02f};
    CHECK(meso_quad_mesh_build(&s.model.surface, arena, 4, flat, 1, &up, 1, corners, normals, &error) == MESO_OK);
    CHECK(meso_slot_graph_build(&s.model.graph, arena, &s.model.surface, NULL) == MESO_OK);
    MesoExpansion expansion;
    MesoScene scene = expand(&s.model, &expansion, arena);
    MesoSceneParts t;
    MesoMeshFace *faces;
    MesoMeshVertex *v = make_polygons(&scene, arena, &t, &faces);

    uint32_t caps = 0;
    for (uint32_t part = 0; part < scene.sweep_count; part++) {
        const MesoKindOrigin *origin = &expansion.origins[meso_scene_kind(&scene, part)];
        if (origin->sweep != MESO_NO_INDEX || origin->start_section != 1 || origin->start_side != 2)
            continue;
        /* side 2 lies in the plane x = 0: the wall adds nothing to the volume about the origin */
        double volume = volume6(v, faces, t.face_begin[part], t.face_begin[part + 1]) / 6;
        CHECK(fabs(volume - 0.01 * 0.125 * 32 / 45) < 1e-6);
        caps++;
    }
    /* section 2 of a is swept on side 0 only, so that the cap stands on side 2 */
    CHECK(caps == 1);

    uint32_t inner = scene.sweep_count;
    CHECK(t.part_count == inner + 1);
    double volume = volume6(v, faces, t.face_begin[inner], t.face_begin[inner + 1]) / 6;
    CHECK(fabs(volume - 0.2 * 0.3 * 0.4 / 6) < 1e-7);
    CHECK(meso_scene_part(&t, inner).material == 4);
}

/* Inner meshes reach as far as the product of three of their coordinates is a float, on the largest surface. */
static void test_far_inner(MesoArena *arena, uint32_t deform)
{
    Case s = {0};
    uint32_t tile[1] = {0};
    MesoTransform transform[1] = {0};
    MesoVec3 flat[4] = {{1e18f, -1e18f, 1e18f}, {1e18f, 1e18f, 1e18f}, {-1e18f, 1e18f, 1e18f}, {-1e18f, -1e18f, 1e18f}};
    MesoVec3 up = {0, 0, 1};
    uint32_t corners[4] = {0, 1, 2, 3}, normals[4] = {0, 0, 0, 0};
    MesoScene scene;
    MesoError error;
    make_tile_set(&s);
    make_grid(&s, arena, 1, tile, transform);
    CHECK(meso_quad_mesh_build(&s.model.surface, arena, 4, flat, 1, &up, 1, corners, normals, &error) == MESO_OK);
    CHECK(meso_slot_graph_build(&s.model.graph, arena, &s.model.surface, NULL) == MESO_OK);
    s.model.options.deform = deform;
    s.inners[0] = (MesoInnerMesh){"x", {-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0}, GREY};
    s.inner_positions[1] = (MesoVec3){MESO_INNER_LIMIT, MESO_INNER_LIMIT, MESO_INNER_LIMIT};
    scene = expand(&s.model, NULL, arena);
    MesoSceneParts t;
    MesoMeshFace *faces;
    const MesoMeshVertex *v = make_polygons(&scene, arena, &t, &faces);
    for (uint64_t i = t.vertex_begin[scene.sweep_count]; i < t.vertex_begin[t.part_count]; i++)
        CHECK(meso_vec3_finite(v[i].position) && meso_vec3_finite(v[i].normal));

    s.inners[0].transform[3] = -1;
    CHECK(meso_model_expand(&scene, NULL, arena, &s.model, 1, &error) == MESO_ERR_INPUT);
    CHECK(strstr(error.message, "vertex 2 of its mesh 'x' lies more than 1e+06 tiles away"));
    s.inner_positions[1] = (MesoVec3){3e38f, 3e38f, 3e38f};
    CHECK(meso_model_expand(&scene, NULL, arena, &s.model, 1, &error) == MESO_ERR_INPUT);
}

/* Ranges and threads do not change a byte. */
static void test_ranges(MesoArena *arena)
{
    Case s = {0};
    uint32_t tile[9] = {0};
    MesoTransform transform[9] = {0};
    make_tile_set(&s);
    make_grid(&s, arena, 3, tile, transform);
    MesoScene scene = expand(&s.model, NULL, arena);
    MesoSceneParts t;
    MesoMeshFace *faces;
    MesoMeshVertex *v = make_polygons(&scene, arena, &t, &faces);
    MesoMeshVertex *w = MESO_NEW(arena, MesoMeshVertex, t.vertex_begin[t.part_count], NULL);
    MesoMeshFace *g = MESO_NEW(arena, MesoMeshFace, t.face_begin[t.part_count], NULL);
    for (uint32_t part = 0; part < t.part_count; part++) {
        meso_scene_vertices(&t, part, part + 1, w + t.vertex_begin[part]);
        meso_scene_faces(&t, part, part + 1, (uint32_t)t.vertex_begin[part], g + t.face_begin[part]);
    }
    CHECK(memcmp(v, w, t.vertex_begin[t.part_count] * sizeof *v) == 0);
    CHECK(memcmp(faces, g, t.face_begin[t.part_count] * sizeof *g) == 0);

    MesoScene again;
    CHECK(meso_model_expand(&again, NULL, arena, &s.model, 1, NULL) == MESO_OK);
    CHECK(memcmp(again.sweeps, scene.sweeps, again.sweep_count * sizeof *again.sweeps) == 0);
}

/* Sweeps to the lids: they end in the middle of the top and the bottom, and drawings there turn with the tile. */
static void test_lids(MesoArena *arena)
{
    Case s = {0};
    uint32_t tile[1] = {0};
    make_tile_set(&s);
    s.tiles[0].side_count = 6;
    s.tiles[0].labels[MESO_SIDE_TOP] = 1;
    s.tiles[0].labels[MESO_SIDE_BOTTOM] = 1;
    s.sweeps[0] = (MesoSweep){.from_side = 0, .to_side = MESO_SIDE_TOP};
    for (MesoTransform transform = 0; transform < MESO_TRANSFORM_COUNT; transform++) {
        MesoVec3 flat[4] = {{1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, up = {0, 0, 1};
        uint32_t corners[4] = {0, 1, 2, 3}, normals[4] = {0, 0, 0, 0};
        make_grid(&s, arena, 1, tile, &transform);
        CHECK(meso_quad_mesh_build(&s.model.surface, arena, 4, flat, 1, &up, 1, corners, normals, NULL) == MESO_OK);
        CHECK(meso_slot_graph_build(&s.model.graph, arena, &s.model.surface, NULL) == MESO_OK);
        MesoExpansion expansion;
        MesoScene scene = expand(&s.model, &expansion, arena);
        for (uint32_t i = 0; i < scene.sweep_count; i++) {
            const MesoKindOrigin *origin = &expansion.origins[meso_scene_kind(&scene, i)];
            if (origin->sweep == MESO_NO_INDEX || origin->end_side != MESO_SIDE_TOP)
                continue;
            MesoVec3 end = scene.sweeps[i].p[3];
            MesoVec2 expected = meso_transform_point(transform, (MesoVec2){0.325f, 0.6f});
            CHECK(fabsf(end.x - expected.x) < 1e-6f && fabsf(end.y - expected.y) < 1e-6f && end.z == 0.5f);
            CHECK(scene.sweeps[i].direction[1].z == 1);
        }
    }
}

/* Surfaces of any size that is let in give finite geometry with unit normals. */
static void test_scales(MesoArena *arena, uint32_t deform)
{
    const float scales[] = {1e-16f, 1e16f};
    for (int k = 0; k < 2; k++) {
        Case s = {0};
        uint32_t tile[1] = {0}, corners[4] = {0, 1, 2, 3};
        MesoTransform transform[1] = {0};
        float a = scales[k];
        MesoVec3 flat[4] = {{a, 0, 0}, {a, a, 0}, {0, a, 0}, {0, 0, 0}};
        make_tile_set(&s);
        make_grid(&s, arena, 1, tile, transform);
        CHECK(meso_quad_mesh_build(&s.model.surface, arena, 4, flat, 0, NULL, 1, corners, NULL, NULL) == MESO_OK);
        CHECK(meso_slot_graph_build(&s.model.graph, arena, &s.model.surface, NULL) == MESO_OK);
        s.model.options.deform = deform;
        MesoScene scene = expand(&s.model, NULL, arena);
        MesoSceneParts t;
        MesoMeshFace *faces;
        MesoMeshVertex *v = make_polygons(&scene, arena, &t, &faces);
        for (uint32_t i = 0; i < scene.sweep_count; i++)
            CHECK(isfinite(meso_sweep_growth(&scene, &scene.sweeps[i], false)));
        for (uint64_t i = 0; i < t.vertex_begin[t.part_count]; i++) {
            CHECK(meso_vec3_finite(v[i].position));
            CHECK(fabsf(meso_vec3_length(v[i].normal) - 1) < 1e-4f);
        }
    }
}

int main(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    test_trajectory();
    test_same_floats(&arena, (MesoMapOptions){0});
    test_same_floats(&arena, (MesoMapOptions){.frame = MESO_FRAME_MINIMAL, .section_size = MESO_SECTION_SLOT});
    test_same_floats(&arena, (MesoMapOptions){.frame = MESO_FRAME_MINIMAL, .section_size = MESO_SECTION_SLOT,
                                              .tolerance = 0.01f});
    test_same_floats(&arena, (MesoMapOptions){.deform = MESO_SWEEP_SHAPE});
    test_same_floats(&arena, (MesoMapOptions){.deform = MESO_SWEEP_SHAPE, .normals = MESO_NORMALS_FLAT,
                                              .side = MESO_SHELL_BOTH, .section_scale = 0.71f});
    test_same_floats(&arena, (MesoMapOptions){.deform = MESO_SWEEP_SHAPE, .frame = MESO_FRAME_MINIMAL,
                                              .tolerance = 0.01f});
    test_mirror(&arena);
    test_winding(&arena);
    test_against_normals(&arena, MESO_SWEEP_CURVES);
    test_against_normals(&arena, MESO_SWEEP_SHAPE);
    test_volumes(&arena);
    test_far_inner(&arena, MESO_SWEEP_CURVES);
    test_far_inner(&arena, MESO_SWEEP_SHAPE);
    test_ranges(&arena);
    test_lids(&arena);
    test_scales(&arena, MESO_SWEEP_CURVES);
    test_scales(&arena, MESO_SWEEP_SHAPE);
    meso_arena_release(&arena);
    return 0;
}
