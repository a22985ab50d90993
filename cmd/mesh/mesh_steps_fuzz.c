/* Small meshes of every kind that readers give, and steps in any order: what comes of each is a checked mesh, or an
 * error. */
#include <string.h>

#include "cmd/mesh/mesh_steps.h"
#include "libcore/base/check.h"
#include "libcore/mesh/edit/face_loops.h"
#include "libcore/mesh/half_edges.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { MOST_STEPS = 6, MOST_SIDES = 9, MOST_FACES = 5000 };

/* Bytes of the input; 0 behind its end. */
typedef struct Bytes {
    const uint8_t *at, *end;
} Bytes;

static uint32_t take(Bytes *bytes, uint32_t below)
{
    return bytes->at < bytes->end ? *bytes->at++ % below : 0;
}

/* ---- meshes ---- */

/* Mostly on a coarse grid, so that there are equal, flat and straight ones; else far apart, or very near. */
static float coordinate(Bytes *bytes)
{
    static const float others[] = {1e18f, -1e18f, 1e-30f, -1e-30f, 1e-42f, 3.0000002f, 0.1f, -0.0f};
    uint32_t byte = take(bytes, 256);
    return byte >= 248 ? others[byte - 248] : (float)(byte % 7) - 3;
}

static void add_faces(MesoPolygonMesh *mesh, Bytes *bytes)
{
    while (bytes->at < bytes->end) {
        uint32_t sides = 1 + take(bytes, MOST_SIDES);
        for (uint32_t k = 0; k < sides; k++)
            mesh->corners[mesh->corner_count++] = take(bytes, mesh->vertex_count);
        mesh->face_begin[++mesh->face_count] = mesh->corner_count;
    }
}

/* Faces with a vertex twice, or none at all, are what clean alone is given: else they become their loops as well. */
static MesoStatus make_mesh(MesoPolygonMesh *mesh, uint32_t *looped, MesoArena *arena, Bytes *bytes, MesoError *error)
{
    size_t room = (size_t)(bytes->end - bytes->at) * MOST_SIDES + MOST_SIDES;
    MesoPolygonMesh raw = {.vertex_count = 1 + take(bytes, 24)};
    raw.positions = MESO_NEW(arena, MesoVec3, raw.vertex_count, error);
    raw.face_begin = MESO_NEW(arena, uint32_t, room, error);
    raw.corners = MESO_NEW(arena, uint32_t, room, error);
    CHECK(raw.positions && raw.face_begin && raw.corners);
    for (uint32_t v = 0; v < raw.vertex_count; v++) {
        MesoVec3 *p = &raw.positions[v];
        p->x = coordinate(bytes);
        p->y = coordinate(bytes);
        p->z = coordinate(bytes);
    }
    add_faces(&raw, bytes);
    return meso_mesh_cut_loops(mesh, arena, &raw, looped, error);
}

static MesoAttribute *add_attribute(MesoPolygonMesh *mesh, MesoArena *arena, MesoAttribute attribute,
                                    uint32_t entry_count)
{
    MesoAttribute *a = &mesh->attributes[mesh->attribute_count++];
    *a = attribute;
    a->entry_count = entry_count;
    a->values = a->width ? meso_arena_alloc(arena, (size_t)a->width * entry_count, meso_scalar_size(a->scalar), NULL) : NULL;
    CHECK(a->values || !a->width);
    return a;
}

static uint32_t *some_entries(MesoArena *arena, uint32_t count, uint32_t entry_count)
{
    uint32_t *entry_of = MESO_NEW(arena, uint32_t, count, NULL);
    CHECK(entry_of);
    for (uint32_t i = 0; i < count; i++)
        entry_of[i] = i * 7 % (entry_count + 1) == entry_count ? MESO_NO_INDEX : i * 7 % (entry_count + 1);
    return entry_of;
}

/* One of each kind: dense, indexed with gaps, names; the numbers are what they happen to be. */
static void add_attributes(MesoPolygonMesh *mesh, MesoArena *arena)
{
    static const char *names[] = {"iron", "", "wood"};
    mesh->attributes = MESO_NEW(arena, MesoAttribute, 5, NULL);
    CHECK(mesh->attributes);
    MesoAttribute *normal = add_attribute(mesh, arena,
                                          (MesoAttribute){.name = "normal", .domain = MESO_ON_VERTICES, .width = 3},
                                          mesh->vertex_count);
    memcpy(normal->values, mesh->positions, mesh->vertex_count * sizeof *mesh->positions);
    MesoAttribute *color = add_attribute(mesh, arena, (MesoAttribute){.name = "color", .domain = MESO_ON_VERTICES,
                                         .scalar = MESO_SCALAR_UINT8, .normalized = true, .width = 4}, mesh->vertex_count);
    memcpy(color->values, mesh->positions, 4 * (size_t)mesh->vertex_count);
    MesoAttribute *uv = add_attribute(mesh, arena, (MesoAttribute){.name = "uv", .domain = MESO_ON_CORNERS, .width = 2},
                                      3);
    memcpy(uv->values, (float[6]){0, 1, 2, 3, -1e30f, 1e30f}, 6 * sizeof(float));
    uv->entry_of = some_entries(arena, mesh->corner_count, 3);
    MesoAttribute *material = add_attribute(mesh, arena, (MesoAttribute){.name = "material", .domain = MESO_ON_FACES},
                                            3);
    material->names = names;
    material->entry_of = some_entries(arena, mesh->face_count, 3);
    add_attribute(mesh, arena, (MesoAttribute){.name = "id", .domain = MESO_ON_FACES, .scalar = MESO_SCALAR_INT16,
                                               .width = 1},
                  mesh->face_count);
}

/* ---- steps ---- */

static const char *const STEPS[] = {
    "weld", "weld=0.5", "weld=1", "weld=1e18", "clean", "separate", "orient", "triangulate", "pair", "quads", "quads=linear",
    "subdivide", "subdivide=loop", "subdivide=linear", "subdivide=linear,2", "decimate=1", "decimate=6", "decimate=50%",
    "convert", "info",
};
enum { STEP_COUNT = sizeof STEPS / sizeof *STEPS };

/* Every entry of every attribute is there. */
static void check_attributes(const MesoPolygonMesh *mesh)
{
    for (const MesoAttribute *a = mesh->attributes; a < mesh->attributes + mesh->attribute_count; a++)
        for (uint32_t e = 0; e < meso_polygon_elements(mesh, a->domain); e++) {
            uint32_t entry = meso_attribute_entry(a, e);
            CHECK(entry < a->entry_count || (entry == MESO_NO_INDEX && a->entry_of));
            if (entry != MESO_NO_INDEX && a->width == 0)
                CHECK(strlen(a->names[entry]) <= 4);
            for (uint32_t k = 0; entry != MESO_NO_INDEX && k < a->width; k++)
                (void)meso_attribute_number(a, entry, k);
        }
}

static void check_joined(const MesoPolygonMesh *mesh, bool oriented)
{
    MesoArena scratch;
    MesoHalfEdges edges;
    MesoError error;
    meso_arena_init(&scratch);
    CHECK(meso_half_edges_join(&edges, &scratch, mesh, 1, &error) == MESO_OK);
    CHECK(edges.crowded_count == 0 && (!oriented || edges.reversed_count == 0));
    meso_arena_release(&scratch);
}

static void check_result(const MesoMeshWork *work, const char *step)
{
    MesoError error;
    CHECK(meso_polygon_mesh_check(&work->mesh, 1, NULL, &error) == MESO_OK);
    check_attributes(&work->mesh);
    if (strncmp(step, "decimate", 8) == 0 || strcmp(step, "separate") == 0)
        check_joined(&work->mesh, *step == 'd');
}

static void run(MesoMeshWork *work, Bytes *steps)
{
    while (steps->at < steps->end && work->mesh.face_count > 0 && work->mesh.face_count < MOST_FACES) {
        MesoMeshStep step;
        const char *text = STEPS[take(steps, STEP_COUNT)];
        CHECK(meso_mesh_step_parse(&step, text, &work->tool->error) == MESO_OK);
        MesoStatus status = meso_mesh_step_run(&step, work);
        CHECK(status == MESO_OK || status == MESO_ERR_INPUT || status == MESO_ERR_LIMIT);
        if (status)
            return;
        check_result(work, text);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const double creases[] = {MESO_NO_CREASE, 0, 30, 180};
    if (size < MOST_STEPS + 2 || size > 400)
        return 0;
    Bytes bytes = {data, data + size};
    MesoTool tool = {.quiet = true, .json = "", .threads = 1};
    MesoMeshWork work = {.tool = &tool, .crease = creases[take(&bytes, 4)], .infos = json_array()};
    uint32_t step_count = 1 + take(&bytes, MOST_STEPS);
    Bytes steps = {bytes.at, bytes.at + step_count};
    bytes.at = bytes.at + MOST_STEPS < bytes.end ? bytes.at + MOST_STEPS : bytes.end;
    CHECK(make_mesh(&work.mesh, &work.looped, &work.arena, &bytes, &tool.error) == MESO_OK);
    add_attributes(&work.mesh, &work.arena);
    if (meso_polygon_mesh_check(&work.mesh, 1, NULL, &tool.error) == MESO_OK)
        run(&work, &steps);
    json_decref(work.infos);
    meso_mesh_work_release(&work);
    CHECK(tool.arena.used == 0);
    meso_arena_release(&tool.arena);
    return 0;
}
