/*
 * Mesh writers: what is read back from each kind of file is the scene's geometry
 * itself, bit by bit (PLY, OBJ) or to the rounding of Draco, by its own decoder;
 * the bytes do not depend on the threads; what a format cannot hold is refused.
 */
#include "formats/scene/mesh_file_fixture.h"

/* First and last part of the faces, walking along. */
static uint32_t part_of_face(const MesoSceneParts *t, uint32_t part, uint64_t face)
{
    while (t->face_begin[part + 1] <= face)
        part++;
    return part;
}

/* ---- PLY ---- */

static void check_ply_faces(const MesoSceneParts *t, const Whole *whole, const uint8_t *row, const uint8_t *end)
{
    uint32_t part = 0;
    for (uint64_t i = 0; i < whole->face_count; i++) {
        const MesoMeshFace *face = &whole->faces[i];
        uint32_t corners = face->v[3] == MESO_NO_INDEX ? 3 : 4, slot;
        uint16_t tile, material;
        part = part_of_face(t, part, i);
        MesoPart of = meso_scene_part(t, part);
        CHECK(row[0] == corners && memcmp(row + 1, face->v, 4 * corners) == 0);
        row += 1 + 4 * corners;
        memcpy(&slot, row, 4);
        memcpy(&tile, row + 4, 2);
        memcpy(&material, row + 6, 2);
        CHECK(slot == meso_scene_id(t->scene, of.ids, 0) && tile == meso_scene_id(t->scene, of.ids, 1));
        CHECK(material == of.material);
        row += 8;
    }
    CHECK(row == end);
}

/* The colour is the material's. */
static void check_ply_vertices(const MesoSceneParts *t, const Whole *whole, const uint8_t *row)
{
    for (uint32_t part = 0; part < t->part_count; part++) {
        const float *albedo = t->scene->materials[meso_scene_part(t, part).material].albedo;
        for (uint64_t v = t->vertex_begin[part]; v < t->vertex_begin[part + 1]; v++, row += 35) {
            CHECK(memcmp(row, &whole->vertices[v], 32) == 0);
            for (int c = 0; c < 3; c++)
                CHECK(fabsf((float)row[32 + c] - 255 * albedo[c]) <= 0.501f);
        }
    }
}

/* Large enough for several windows. */
static void test_ply(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, 24, 24, 0.02f);
    const MesoSceneParts *t = &fixture.parts;
    Whole whole = make_whole(&fixture);
    MesoInput input = write_mesh(meso_ply_write, t, 2, path_of("x.ply"));
    CHECK(input.size > (size_t)17 << 20);

    char count[64];
    CHECK(memcmp(input.data, "ply\nformat binary_little_endian 1.0\ncomment provenance {", 56) == 0);
    CHECK(after(&input, "comment tile 0 plain \"weave\"\n") && after(&input, "comment material 2 weft/stud\n"));
    snprintf(count, sizeof count, "element vertex %llu\n", (unsigned long long)whole.vertex_count);
    CHECK(after(&input, count));
    snprintf(count, sizeof count, "element face %llu\n", (unsigned long long)whole.face_count);
    CHECK(after(&input, count));

    const uint8_t *rows = after(&input, "end_header\n");
    size_t vertex_bytes = whole.vertex_count * 35;
    CHECK(rows && (size_t)(input.data + input.size - rows) > vertex_bytes);
    check_ply_vertices(t, &whole, rows);
    check_ply_faces(t, &whole, rows + vertex_bytes, input.data + input.size);
    check_threads(meso_ply_write, t, &input);
    meso_input_close(&input);
    scene_fixture_release(&fixture);
}

/* ---- winding ---- */

static MesoVec3 face_normal(const Whole *whole, const MesoMeshFace *face)
{
    MesoVec3 p[4];
    for (int k = 0; k < 4; k++)
        p[k] = whole->vertices[face->v[k] == MESO_NO_INDEX ? face->v[0] : face->v[k]].position;
    return meso_vec3_cross(meso_vec3_sub(p[2], p[0]), meso_vec3_sub(p[3], p[1]));
}

/* Counter-clockwise from outside, which is where the vertex normals point. */
static void test_winding(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, 6, 12, 0.02f);
    Whole whole = make_whole(&fixture);
    for (uint64_t i = 0; i < whole.face_count; i++) {
        const MesoMeshFace *face = &whole.faces[i];
        MesoVec3 normal = {0, 0, 0};
        for (int k = 0; k < 4 && face->v[k] != MESO_NO_INDEX; k++)
            normal = meso_vec3_add(normal, whole.vertices[face->v[k]].normal);
        MesoVec3 across = face_normal(&whole, face);
        if (face->v[3] == MESO_NO_INDEX)    /* diagonals of a triangle span it the other way */
            across = meso_vec3_cross(
                meso_vec3_sub(whole.vertices[face->v[1]].position, whole.vertices[face->v[0]].position),
                meso_vec3_sub(whole.vertices[face->v[2]].position, whole.vertices[face->v[0]].position));
        CHECK(meso_vec3_dot(across, normal) > 0);
    }
    scene_fixture_release(&fixture);
}

/* ---- OBJ ---- */

static const char *parse_floats(const char *text, const float *expected, int count)
{
    for (int i = 0; i < count; i++) {
        char *end;
        CHECK(*text == ' ');
        float value = strtof(text + 1, &end);
        CHECK(memcmp(&value, &expected[i], 4) == 0 || (value == 0 && expected[i] == 0));
        text = end;
    }
    CHECK(*text == '\n');
    return text;
}

static const char *parse_face(const char *text, const MesoMeshFace *face)
{
    for (int k = 0; k < 4 && face->v[k] != MESO_NO_INDEX; k++)
        for (int j = 0; j < 3; j++) {
            char *end;
            CHECK(*text == (j == 0 ? ' ' : '/'));
            CHECK(strtoul(text + 1, &end, 10) == (unsigned long)face->v[k] + 1);
            text = end;
        }
    CHECK(*text == '\n');
    return text;
}

typedef struct ObjCounts {
    uint64_t positions, uvs, normals, faces, slots, objects, materials;
} ObjCounts;

static const char *check_obj_line(const char *line, const char *newline, const Whole *whole,
                                  const MesoSceneParts *t, ObjCounts *n)
{
    const char *end = newline;
    if (line[0] == 'v' && line[1] == ' ')
        end = parse_floats(line + 1, &whole->vertices[n->positions++].position.x, 3);
    else if (line[0] == 'v' && line[1] == 't')
        end = parse_floats(line + 2, &whole->vertices[n->uvs++].uv.x, 2);
    else if (line[0] == 'v' && line[1] == 'n')
        end = parse_floats(line + 2, &whole->vertices[n->normals++].normal.x, 3);
    else if (line[0] == 'f')
        end = parse_face(line + 1, &whole->faces[n->faces++]);
    else if (strncmp(line, "# slot ", 7) == 0)
        CHECK(strtoul(line + 7, NULL, 10) == meso_scene_part(t, (uint32_t)n->slots++).ids);
    else if (strncmp(line, "o ", 2) == 0)
        n->objects++;
    else if (strncmp(line, "usemtl ", 7) == 0)
        n->materials++;
    else
        CHECK(strncmp(line, "# provenance {", 14) == 0);
    return end;
}

static void test_obj(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, 4, 9, 0.02f);
    const MesoSceneParts *t = &fixture.parts;
    Whole whole = make_whole(&fixture);
    MesoInput input = write_mesh(meso_obj_write, t, 2, path_of("x.obj"));
    ObjCounts n = {0};
    const char *line = (const char *)input.data, *end = line + input.size;
    while (line < end) {
        const char *newline = memchr(line, '\n', (size_t)(end - line));
        CHECK(newline);
        CHECK(check_obj_line(line, newline, &whole, t, &n) == newline);
        line = newline + 1;
    }
    CHECK(n.positions == whole.vertex_count && n.uvs == n.positions && n.normals == n.positions);
    CHECK(n.faces == whole.face_count && n.slots == t->part_count);
    CHECK(n.objects >= 2 && n.materials >= 4);
    check_threads(meso_obj_write, t, &input);
    meso_input_close(&input);
    scene_fixture_release(&fixture);
}

static void test_materials(void)
{
    SceneFixture fixture;
    MesoInput input;
    MesoOutput *output;
    MesoError error;
    scene_fixture_init(&fixture, 2, 3, 0.1f);
    const MesoMeshWriteOptions options = {.materials = "x y.mtl"};
    input = write_mesh_as(meso_obj_write, &fixture.parts, &options, 2, path_of("x.obj"));
    CHECK(after(&input, "\nmtllib x y.mtl\no "));
    meso_input_close(&input);
    CHECK(meso_output_open(&output, path_of("x.obj"), &error) == MESO_OK);
    CHECK(meso_mtl_write(&fixture.scene, NULL, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path_of("x.obj"), &error) == MESO_OK);
    CHECK(after(&input, "newmtl warp/strand\nKd 0.5 0.2 0.1\nPr 0.5\nPm 0\nnewmtl weft/strand\nKd 0.1 0.3 0.6\n"));
    meso_input_close(&input);
    scene_fixture_release(&fixture);
}

/* ---- STL ---- */

static const uint8_t *check_triangle(const Whole *whole, const uint8_t *row, const uint32_t corners[3])
{
    MesoVec3 at[4], along[3];
    memcpy(at, row, sizeof at);
    for (int k = 0; k < 3; k++)
        CHECK(memcmp(&at[1 + k], &whole->vertices[corners[k]].position, 12) == 0);
    for (int k = 0; k < 3; k++)
        along[k] = meso_vec3_sub(at[1 + (k + 1) % 3], at[1 + k]);
    CHECK(fabsf(meso_vec3_dot(at[0], along[0])) < 1e-3f && fabsf(meso_vec3_dot(at[0], along[1])) < 1e-3f);
    CHECK(fabsf(meso_vec3_length(at[0]) - 1) < 1e-4f && meso_vec3_dot(at[0], meso_vec3_cross(along[0], along[1])) > 0);
    return row + 50;
}

static void test_stl(void)
{
    SceneFixture fixture;
    uint32_t count;
    scene_fixture_init(&fixture, 4, 9, 0.02f);
    Whole whole = make_whole(&fixture);
    MesoInput input = write_mesh(meso_stl_write, &fixture.parts, 2, path_of("x.stl"));
    memcpy(&count, input.data + 80, sizeof count);
    CHECK(count == fixture.parts.triangle_count && input.size == 84 + (size_t)50 * count);
    const uint8_t *row = input.data + 84;
    for (uint64_t i = 0; i < whole.face_count; i++) {
        const uint32_t *v = whole.faces[i].v;
        row = check_triangle(&whole, row, v);
        if (v[3] != MESO_NO_INDEX)
            row = check_triangle(&whole, row, (const uint32_t[]){v[0], v[2], v[3]});
    }
    check_threads(meso_stl_write, &fixture.parts, &input);
    meso_input_close(&input);
    scene_fixture_release(&fixture);
}

/* ---- Draco, read back by its own decoder ---- */

static void bounds_of(const Whole *whole, MesoVec3 *low, MesoVec3 *high)
{
    *low = *high = whole->vertices[0].position;
    for (uint64_t i = 1; i < whole->vertex_count; i++) {
        MesoVec3 p = whole->vertices[i].position;
        *low = (MesoVec3){fminf(low->x, p.x), fminf(low->y, p.y), fminf(low->z, p.z)};
        *high = (MesoVec3){fmaxf(high->x, p.x), fmaxf(high->y, p.y), fmaxf(high->z, p.z)};
    }
}

static void test_drc(void)
{
    SceneFixture fixture;
    MesoVec3 low, high;
    scene_fixture_init(&fixture, 5, 8, 0.02f);
    Whole whole = make_whole(&fixture);
    MesoInput input = write_mesh(meso_drc_write, &fixture.parts, 2, path_of("x.drc"));
    Decoded d = decode(path_of("x.drc"));
    CHECK(d.face_count == fixture.parts.triangle_count);
    CHECK(d.vertex_count <= whole.vertex_count && d.vertex_count > whole.vertex_count * 9 / 10);
    bounds_of(&whole, &low, &high);
    MesoVec3 extent = meso_vec3_sub(high, low);
    float step = fmaxf(extent.x, fmaxf(extent.y, extent.z)) / (float)((1 << 14) - 1);
    char command[512];
    snprintf(command, sizeof command, "draco_decoder -i %s -o %s >/dev/null 2>&1", path_of("x.drc"), path_of("x.obj"));
    CHECK(system(command) == 0);
    MesoInput text;
    CHECK(meso_input_open(&text, path_of("x.obj"), &(MesoError){0}) == MESO_OK);
    CHECK(contains(&text, "usemtl warp/strand\n") && contains(&text, "usemtl plain_\"weave\"/inner_1\n"));
    meso_input_close(&text);
    check_near(d.box.low, low, 0.51f * step);
    check_near(d.box.high, high, 0.51f * step);
    CHECK(contains(&input, "slot") && contains(&input, "material") && contains(&input, "provenance"));
    CHECK(contains(&input, "[\"plain \\\"weave\\\"\",\"float\"]"));
    check_threads(meso_drc_write, &fixture.parts, &input);
    meso_input_close(&input);
    scene_fixture_release(&fixture);
}

/* ---- bodies with colours, and channels of another kind ---- */

static void test_colored_ply(const MesoSceneParts *parts, const ColoredFixture *c)
{
    MesoInput input = write_mesh(meso_ply_write, parts, 2, path_of("x.ply"));
    const uint8_t *row = after(&input, "comment region 1 stem one\ncomment state 0 green\ncomment state 1 dry\n"
                                       "comment material 0 paint\n");
    uint32_t element = 70000;
    CHECK(row && memcmp(row, "element vertex 3\n", 17) == 0);
    row = after(&input, "property float t\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
                        "element face 1\nproperty list uchar uint vertex_indices\nproperty ushort region\n"
                        "property uint element\nproperty ushort state\nproperty ushort material\nend_header\n");
    CHECK(row && memcmp(row + 35 + 32, &c->colors[1], 3) == 0 && memcmp(row + 35, &c->positions[1], 12) == 0);
    row += 3 * 35;
    CHECK(row[0] == 3 && memcmp(row + 1, c->corners, 12) == 0 && row[13] == 1 && row[14] == 0);
    CHECK(memcmp(row + 15, &element, 4) == 0 && row[19] == 0 && row + 23 == input.data + input.size);
    meso_input_close(&input);
}

static void test_colored_obj(const MesoSceneParts *parts)
{
    MesoInput input = write_mesh(meso_obj_write, parts, 2, path_of("x.obj"));
    CHECK(after(&input, "\no stem_one\nusemtl paint\n# element 70000\n# state 0 green\nv 0 0 0 1 0 0\n"));
    CHECK(after(&input, "\nv 1 0 0 0 0.2 0\n") && after(&input, "\nv 0 1 0 0 0 0.4\n"));
    meso_input_close(&input);
}

static void test_colored_drc(const MesoSceneParts *parts)
{
    MesoInput input = write_mesh(meso_drc_write, parts, 2, path_of("x.drc"));
    CHECK(contains(&input, "[\"leaf\",\"stem one\"]") && contains(&input, "states") && contains(&input, "element"));
    meso_input_close(&input);
}

static void test_colored(void)
{
    ColoredFixture c;
    MesoArena arena;
    MesoSceneParts parts;
    meso_arena_init(&arena);
    colored_fixture_init(&c);
    CHECK(meso_scene_parts_init(&parts, &arena, &c.scene, NULL) == MESO_OK);
    test_colored_ply(&parts, &c);
    test_colored_obj(&parts);
    test_colored_drc(&parts);
    meso_arena_release(&arena);
}

/* ---- refusals ---- */

static WriteMesh *const WRITERS[] = {meso_ply_write, meso_obj_write, meso_drc_write, meso_glb_write,
                                    meso_stl_write};
enum { WRITER_COUNT = 5 };

static MesoStatus try_write(WriteMesh *write, const MesoSceneParts *t, MesoError *error)
{
    MesoMeshWriteOptions options = {.speed = 7, .smaller = "make less of it"};
    MesoOutput *output;
    CHECK(meso_output_open(&output, path_of("refused"), error) == MESO_OK);
    MesoStatus status = write(t, &options, output, error);
    meso_output_discard(output);
    CHECK(access(path_of("refused"), F_OK) != 0);
    return status;
}

static void test_refusals(void)
{
    SceneFixture fixture;
    MesoError error;
    scene_fixture_init(&fixture, 2, 4, 0.1f);

    uint64_t nothing[1] = {0}, too_many[2] = {0, UINT32_MAX}, some[2] = {0, 1 << 26};
    MesoSceneParts empty = {&fixture.scene, 0, nothing, nothing, 0};
    MesoSceneParts huge = {&fixture.scene, 1, too_many, too_many, 2 * (uint64_t)UINT32_MAX};
    MesoSceneParts large = {&fixture.scene, 1, some, some, (1 << 26) + 1};
    for (int i = 0; i < WRITER_COUNT; i++) {
        CHECK(try_write(WRITERS[i], &empty, &error) == MESO_ERR_INPUT);
        CHECK(try_write(WRITERS[i], &huge, &error) == MESO_ERR_LIMIT && strstr(error.message, ": make less of it"));
    }
    CHECK(try_write(meso_drc_write, &large, &error) == MESO_ERR_LIMIT && strstr(error.message, ": make less of it"));

    uint32_t slots = fixture.scene.channels[0].count;
    fixture.scene.channels[0].count = (1u << 30) + 1;
    CHECK(try_write(meso_drc_write, &fixture.parts, &error) == MESO_ERR_LIMIT);
    fixture.scene.channels[0].count = slots;

    fixture.scene.sweeps[1].p[1].y = NAN;
    char slot[32];
    snprintf(slot, sizeof slot, "slot %u:", fixture.scene.sweeps[1].ids);
    CHECK(try_write(meso_drc_write, &fixture.parts, &error) == MESO_ERR_INPUT && strstr(error.message, slot));
    CHECK(try_write(meso_glb_write, &fixture.parts, &error) == MESO_ERR_INPUT && strstr(error.message, slot));
    scene_fixture_release(&fixture);
}

/* Progress never goes back and ends at the total. */
typedef struct Watch {
    uint64_t done, total;
} Watch;

static void watch(void *context, uint64_t done, uint64_t total)
{
    Watch *w = context;
    CHECK(done >= w->done && done <= total);
    *w = (Watch){done, total};
}

static void test_progress(void)
{
    SceneFixture fixture;
    MesoError error;
    scene_fixture_init(&fixture, 3, 5, 0.05f);
    for (int i = 0; i < WRITER_COUNT; i++) {
        Watch w = {0, 0};
        MesoMeshWriteOptions options = {.thread_count = 1, .speed = 7, .progress = watch, .progress_context = &w};
        MesoOutput *output;
        CHECK(meso_output_open(&output, path_of("watched"), &error) == MESO_OK);
        CHECK(WRITERS[i](&fixture.parts, &options, output, &error) == MESO_OK);
        meso_output_discard(output);
        CHECK(w.total > 0 && w.done == w.total);
    }
    scene_fixture_release(&fixture);
}

int main(void)
{
    CHECK(mkdtemp(folder));
    test_ply();
    test_winding();
    test_obj();
    test_materials();
    test_stl();
    test_drc();
    test_colored();
    test_refusals();
    test_progress();
    static const char *const products[] = {"x.ply", "x.obj", "x.drc", "x.stl", "again"};
    remove_products(products, 5);
    return 0;
}
