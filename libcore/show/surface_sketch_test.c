/* A cube, and an open strip of three quads: faces by class, each edge once, arrows, corners of three. */
#include "libcore/show/surface_sketch.h"

#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/index.h"
#include "libcore/mesh/half_edges.h"

static MesoArena arena;
static MesoError error;

static const MesoFaceClass classes[2] = {{"plain", {0.5f, 0.5f, 0.5f}}, {"marked", {1, 0, 0}}};

/* Sweeps and faces of a part. */
static void count_part(const MesoScene *scene, const char *name, uint32_t *bars, uint32_t *faces)
{
    const MesoIdChannel *parts = &scene->channels[0];
    uint32_t part = 0;
    *bars = *faces = 0;
    while (part < parts->count && strcmp(parts->names[part], name) != 0)
        part++;
    for (uint32_t s = 0; s < scene->sweep_count; s++)
        *bars += meso_scene_id(scene, scene->sweeps[s].ids, 0) == part;
    for (uint32_t p = 0; p < scene->placed_count; p++)
        if (meso_scene_id(scene, scene->placed[p].ids, 0) == part)
            *faces += scene->bodies[scene->placed[p].body].face_count;
}

static void check_part(const MesoScene *scene, const char *name, uint32_t bars, uint32_t faces)
{
    uint32_t found_bars, found_faces;
    count_part(scene, name, &found_bars, &found_faces);
    CHECK(found_bars == bars && found_faces == faces);
}

static MesoScene sketch(MesoPolygonMesh *mesh, const uint32_t *face_class, MesoSurfaceMarks *marks)
{
    MesoHalfEdges edges;
    MesoScene scene;
    CHECK(meso_half_edges_join(&edges, &arena, mesh, 1, &error) == MESO_OK);
    MesoSurfaceSketch look = {.mesh = mesh, .twin = edges.twin, .class_count = 2, .classes = classes,
                              .face_class = face_class, .directions = true, .corners = true};
    CHECK(meso_surface_sketch(&scene, marks, &arena, &look, &error) == MESO_OK);
    return scene;
}

static void test_cube(void)
{
    static uint32_t corners[24] = {0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5};
    static const uint32_t marked[6] = {0, 0, 1, 0, 0, 1};
    MesoVec3 positions[8];
    for (uint32_t i = 0; i < 8; i++)
        positions[i] = (MesoVec3){(float)(i & 1), (float)(i >> 1 & 1), (float)(i >> 2)};
    MesoPolygonMesh mesh = {.vertex_count = 8, .face_count = 6, .corner_count = 24, .side_count = 4,
                            .positions = positions, .corners = corners};
    MesoSurfaceMarks marks;
    MesoScene scene = sketch(&mesh, marked, &marks);
    CHECK(marks.three == 8 && marks.five == 0 && marks.others == 0);
    check_part(&scene, "plain", 0, 4);
    check_part(&scene, "marked", 0, 2);
    check_part(&scene, "edges", 12, 0);
    check_part(&scene, "borders", 0, 0);
    check_part(&scene, "directions", 12, 0);
    /* outward: where the face is, from the cube's middle */
    for (uint32_t b = 0; b < 2; b++)
        for (uint32_t v = 0; v < scene.bodies[b].vertex_count; v++) {
            MesoVec3 out = meso_vec3_sub(scene.bodies[b].positions[v], (MesoVec3){0.5f, 0.5f, 0.5f});
            CHECK(fabsf(meso_vec3_dot(out, scene.bodies[b].normals[v]) - 0.5f) < 1e-6f);
        }
}

/* A hundred-sided polygon beside two triangles: borders alone mark nothing. */
static void test_polygons(void)
{
    enum { SIDES = 100 };
    static uint32_t corners[SIDES + 3], face_begin[3] = {0, SIDES, SIDES + 3};
    static MesoVec3 positions[SIDES + 1];
    for (uint32_t i = 0; i < SIDES; i++) {
        positions[i] = (MesoVec3){cosf(0.0628318531f * (float)i), sinf(0.0628318531f * (float)i), 0};
        corners[i] = i;
    }
    positions[SIDES] = (MesoVec3){2, 0, 0};
    corners[SIDES] = 1, corners[SIDES + 1] = 0, corners[SIDES + 2] = SIDES;
    MesoPolygonMesh mesh = {.vertex_count = SIDES + 1, .face_count = 2, .corner_count = SIDES + 3,
                            .positions = positions,
                            .corners = corners, .face_begin = face_begin};
    MesoSurfaceMarks marks;
    MesoScene scene = sketch(&mesh, NULL, &marks);
    CHECK(marks.three + marks.five + marks.others == 0);
    check_part(&scene, "plain", 0, SIDES - 2 + 1);
    check_part(&scene, "edges", 1, 0);
    check_part(&scene, "borders", SIDES - 1 + 2, 0);
    check_part(&scene, "directions", 0, 0);
    double area = 0;
    const MesoBody *body = &scene.bodies[0];
    for (uint32_t f = 0; f < body->face_count; f++) {
        const uint32_t *v = body->corners + 4 * f;
        CHECK(v[3] == MESO_NO_INDEX);
        area += 0.5 * (double)meso_vec3_cross(meso_vec3_sub(body->positions[v[1]], body->positions[v[0]]),
                                              meso_vec3_sub(body->positions[v[2]], body->positions[v[0]])).z;
    }
    CHECK(fabs(area - 50 * sin(0.0628318531) - 0.5 * sin(0.0628318531)) < 1e-4);
}

int main(void)
{
    meso_arena_init(&arena);
    test_cube();
    test_polygons();
    meso_arena_release(&arena);
    return 0;
}
