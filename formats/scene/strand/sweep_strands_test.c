/* Strands of a weave, of a ring, and of ends that share a place; and the curves of a file, read back. */
#include "formats/scene/strand/sweep_strands.h"

#include "formats/scene/mesh_file_fixture.h"
#include "formats/scene/strand/usda_scene.h"

static const MesoSweptKind *kind_of(const MesoScene *scene, uint32_t sweep)
{
    return &scene->kinds[meso_scene_kind(scene, sweep)];
}

static MesoVec3 end_of(const MesoScene *scene, MesoStrandPiece piece, bool last)
{
    return scene->sweeps[piece.sweep].p[last != piece.reversed ? 3 : 0];
}

static void check_joined(const MesoScene *scene, const MesoStrands *s, uint32_t strand)
{
    for (uint32_t i = s->begin[strand]; i + 1 < s->begin[strand + 1]; i++) {
        MesoStrandPiece here = s->pieces[i], next = s->pieces[i + 1];
        bool tip = kind_of(scene, here.sweep)->cap;
        MesoVec3 a = end_of(scene, here, !tip || here.reversed), b = end_of(scene, next, false);
        CHECK(a.x == b.x && a.y == b.y && a.z == b.z);
    }
}

/* n x n slots: n strands each way, over all slots of a row; caps by themselves, or two of them tip to tip. */
static void test_weave(void)
{
    enum { N = 5 };
    SceneFixture fixture;
    MesoStrands s;
    scene_fixture_init(&fixture, N, 4, 0.1f);
    const MesoScene *scene = &fixture.scene;
    CHECK(meso_strands_find(&s, &fixture.arena, scene, NULL) == MESO_OK);
    uint32_t threads = 0;
    CHECK(s.begin[0] == 0 && s.begin[s.count] == scene->sweep_count);
    for (uint32_t i = 0; i < s.count; i++) {
        uint32_t count = s.begin[i + 1] - s.begin[i];
        bool capped = kind_of(scene, s.pieces[s.begin[i]].sweep)->cap;
        CHECK(count == (capped ? count : N) && count <= N && !s.closed[i]);
        CHECK(capped ? s.length[i] == 0 && count <= 2 : s.length[i] > N - 0.1f && s.length[i] < 2 * N);
        check_joined(scene, &s, i);
        threads += !capped;
        for (uint32_t k = s.begin[i]; k < s.begin[i + 1]; k++)
            CHECK(s.of_sweep[s.pieces[k].sweep] == i);
    }
    CHECK(threads == 2 * N);
    scene_fixture_release(&fixture);
}

/* A scene of sweeps of one kind between the corners of a square, numbered around, or to themselves. */
typedef struct Square {
    MesoMaterial material;
    const char *name;
    MesoSweepColumn columns[4];
    MesoSweptKind kind;
    MesoSweepInstance sweeps[4];
    uint32_t ids[4];
    MesoScene scene;
} Square;

static void square_init(Square *q, uint32_t count, const uint32_t (*ends)[2])
{
    static const MesoVec3 corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    *q = (Square){.name = "m", .kind = {.column_count = 4, .joint_count = 3, .division_count = 3,
                           .instance_count = count},
                  .ids = {0, 1, 2, 3}};
    for (uint32_t c = 0; c < 4; c++)
        q->columns[c] = (MesoSweepColumn){.start = {c < 2 ? 0.1f : -0.1f, 0}, .end = {0.1f, 0}, .joins_next = c < 3};
    for (uint32_t i = 0; i < count; i++) {
        MesoVec3 a = corners[ends[i][0]], b = corners[ends[i][1]];
        q->sweeps[i] = (MesoSweepInstance){.p = {a, meso_vec3_lerp(a, b, 1 / 3.0f), meso_vec3_lerp(a, b, 2 / 3.0f), b},
                                           .up = {{0, 0, 1}, {0, 0, 1}}, .ids = i, .size = {1, 1}};
    }
    q->scene = (MesoScene){.channel_count = 1, .channels = {{"slot", 4, NULL}}, .material_count = 1,
                           .materials = &q->material, .material_names = &q->name, .id_row_count = 4, .ids = q->ids,
                           .section_scale = 1, .kind_count = 1, .column_count = 4, .sweep_count = count,
                           .kinds = &q->kind, .columns = q->columns, .sweeps = q->sweeps};
}

static void test_ring(MesoArena *arena)
{
    static const uint32_t ends[4][2] = {{0, 1}, {2, 1}, {2, 3}, {0, 3}};
    static const bool reversed[4] = {false, true, false, true};
    Square q;
    MesoStrands s;
    square_init(&q, 4, ends);
    CHECK(meso_strands_find(&s, arena, &q.scene, NULL) == MESO_OK);
    CHECK(s.count == 1 && s.closed[0] && fabsf(s.length[0] - 4) < 1e-5f);
    for (uint32_t i = 0; i < 4; i++)
        CHECK(s.pieces[i].sweep == i && s.pieces[i].reversed == reversed[i]);
    CHECK(meso_strand_radius(&q.scene, &q.kind, false) == 0.1f);
}

/* At corner 1 two sweeps of one slot meet one of another: one of them goes on, the other ends. */
static void test_branch(MesoArena *arena)
{
    static const uint32_t ends[3][2] = {{0, 1}, {1, 2}, {1, 3}};
    Square q;
    MesoStrands s;
    square_init(&q, 3, ends);
    q.sweeps[2].ids = 1;
    CHECK(meso_strands_find(&s, arena, &q.scene, NULL) == MESO_OK);
    CHECK(s.count == 2 && s.begin[1] == 2 && s.of_sweep[0] == s.of_sweep[1] && s.of_sweep[2] == 1);
}

static void test_nothing(MesoArena *arena)
{
    MesoStrands s;
    const MesoScene empty = {0};
    CHECK(meso_strands_find(&s, arena, &empty, NULL) == MESO_OK && s.count == 0);
}

/* ---- curves, read back ---- */

/* Numbers of the array behind `key`, from `*text` on; returns how many. */
static uint32_t read_array(const char **text, const char *key, float *values, uint32_t room)
{
    uint32_t count = 0;
    const char *at = strstr(*text, key);
    CHECK(at);
    for (at += strlen(key); *at != ']';) {
        char *end;
        float value = strtof(at, &end);
        if (end == at) {
            at++;
            continue;
        }
        CHECK(count < room);
        values[count++] = value;
        at = end;
    }
    *text = at;
    return count;
}

/* The trajectories of all strands of the first material, one after another. */
static void check_points(SceneFixture *fixture, const float *values)
{
    MesoStrands s;
    CHECK(meso_strands_find(&s, &fixture->arena, &fixture->scene, NULL) == MESO_OK);
    for (uint32_t i = 0; i < s.begin[s.count]; i++) {
        const MesoStrandPiece piece = s.pieces[i];
        const MesoSweptKind *kind = kind_of(&fixture->scene, piece.sweep);
        if (kind->cap || kind->start_material != 0)
            continue;
        bool first = i == s.begin[s.of_sweep[piece.sweep]];
        for (int k = first ? 0 : 1; k < 4; k++, values += 3)
            CHECK(memcmp(values, &fixture->scene.sweeps[piece.sweep].p[piece.reversed ? 3 - k : k], 12) == 0);
    }
}

static void check_curves(SceneFixture *fixture, const char *text)
{
    enum { ROOM = 1 << 16 };
    float *values = MESO_NEW(&fixture->arena, float, ROOM, NULL), counts[256], lengths[256];
    uint32_t curves = read_array(&text, "int[] curveVertexCounts = [", counts, 256);
    uint32_t numbers = read_array(&text, "point3f[] points = [", values, ROOM), points = 0, ends = 0;
    for (uint32_t i = 0; i < curves; i++) {
        CHECK((uint32_t)counts[i] % 3 == 1);
        points += (uint32_t)counts[i];
        ends += (uint32_t)counts[i] / 3 + 1;
    }
    CHECK(numbers == 3 * points);
    check_points(fixture, values);
    CHECK(read_array(&text, "float[] widths = [", values, ROOM) == ends && values[0] > 0);
    CHECK(strncmp(text, "] (interpolation = \"varying\")", 29) == 0);
    CHECK(read_array(&text, "int[] primvars:strand = [", values, ROOM) == curves &&
          values[curves - 1] == (float)(curves - 1));
    CHECK(read_array(&text, "float[] primvars:strand_length = [", lengths, 256) == curves && lengths[0] > 1);
    CHECK(read_array(&text, "int[] primvars:slot = [", values, ROOM) == ends && values[0] < 25);
    CHECK(read_array(&text, "int[] primvars:tile = [", values, ROOM) == ends);
    CHECK(strstr(text, "rel material:binding = </World/Looks/look_0>"));
}

static void test_usda(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, 5, 4, 0.1f);
    const MesoMeshWriteOptions options = {.z_up = true, .unit = 0.25f};
    MesoInput input = write_mesh_as(meso_usda_scene_write, &fixture.parts, &options, 2, path_of("x.usda"));
    char *text = MESO_NEW(&fixture.arena, char, input.size + 1, NULL);
    CHECK(text);
    memcpy(text, input.data, input.size);
    CHECK(strncmp(text, "#usda 1.0\n", 10) == 0 && strstr(text, "metersPerUnit = 0.25\n    upAxis = \"Z\"\n"));
    CHECK(strstr(text, "string[] tiles = [\"plain \\\"weave\\\"\", \"float\"]"));
    check_curves(&fixture, text);
    CHECK(strstr(text, "def Mesh \"Bodies_3\"") && strstr(text, "custom string meso:name = \"weft/stud\""));
    check_threads_as(meso_usda_scene_write, &fixture.parts, &options, &input);
    meso_input_close(&input);
    scene_fixture_release(&fixture);
}

int main(void)
{
    MesoArena arena;
    CHECK(mkdtemp(folder));
    meso_arena_init(&arena);
    test_weave();
    test_ring(&arena);
    test_branch(&arena);
    test_nothing(&arena);
    test_usda();
    meso_arena_release(&arena);
    static const char *const products[] = {"x.usda", "again"};
    remove_products(products, 2);
    return 0;
}
