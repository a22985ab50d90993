/* Clips of numbered meshes and of caches: their frames, in any order, and what is wrong with them. */
#include "formats/clip/clip_file.h"
#include "formats/file/test_folder.h"
#include "formats/mesh/gltf/gltf_clip_fixture.h"

static void write_text(const TestFolder *folder, const char *name, const char *text)
{
    test_file_write(test_path(folder, name), text, strlen(text));
}

/*
 *     3---2      A quad and a triangle, whose vertex 0 lies at
 *     |   | \    x = frame.
 *     0---1--4
 */
static void write_frame(const TestFolder *folder, int32_t frame)
{
    char name[32], text[256];
    snprintf(name, sizeof name, "b%%-%03d.obj", frame);
    snprintf(text, sizeof text, "v %d 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\n", frame);
    write_text(folder, name, text);
}

static MesoStatus open_clip(MesoClipFile **clip, const char *path, const char *rest, const char *frames, bool ahead,
                            MesoError *error)
{
    MesoArena arena;
    MesoFrameList list;
    meso_arena_init(&arena);
    if (frames)
        CHECK(meso_frame_list_parse(&list, &arena, frames, error) == MESO_OK);
    const MesoClipSource source = {.path = path, .rest = rest, .frames = frames ? &list : NULL, .ahead = ahead};
    MesoStatus status = meso_clip_open(clip, &source, error);
    meso_arena_release(&arena);
    return status;
}

/* The message without the folder's path before it, and before the name in quotes. */
static void check_message(const TestFolder *folder, const MesoError *error, const char *expected)
{
    char text[512] = "";
    const char *from = error->message;
    for (const char *at; (at = strstr(from, folder->path)); from = at + strlen(folder->path) + 1)
        strncat(text, from, (size_t)(at - from));
    strcat(text, from);
    CHECK_TEXT(text, expected);
}

static void expect_no_clip(const TestFolder *folder, const char *path, const char *rest, const char *frames,
                           MesoStatus status, const char *message)
{
    MesoClipFile *clip;
    MesoError error;
    CHECK(open_clip(&clip, path, rest, frames, false, &error) == status);
    CHECK(!clip);
    check_message(folder, &error, message);
}

static void test_numbered(bool ahead)
{
    static const uint32_t order[] = {0, 1, 2, 3, 2, 1, 1, 3, 0, 2};
    TestFolder folder = test_folder_make();
    MesoClipFile *clip;
    MesoError error;
    for (int32_t f = 9; f <= 18; f += 3)
        write_frame(&folder, f);
    write_text(&folder, "b%-12.obj", "no frame: too few digits");
    write_text(&folder, "b%-0x2.obj", "no frame: no number");
    CHECK(open_clip(&clip, test_path(&folder, "b%%-%03d.obj"), NULL, NULL, ahead, &error) == MESO_OK);
    CHECK(meso_clip_frame_count(clip) == 4);
    CHECK(meso_clip_frame_number(clip, 0) == 9 && meso_clip_frame_number(clip, 3) == 18);
    CHECK(meso_clip_mesh(clip)->vertex_count == 5 && meso_clip_mesh(clip)->face_count == 2);
    for (size_t i = 0; i < sizeof order / sizeof *order; i++) {
        const MesoVec3 *positions = meso_clip_place_frame(clip, order[i], &error);
        CHECK(positions && positions[0].x == (float)(9 + 3 * order[i]) && positions[4].x == 2);
    }
    meso_clip_release(clip);

    /* backwards, with the mesh of another frame at rest */
    CHECK(open_clip(&clip, test_path(&folder, "b%%-%03d.obj"), test_path(&folder, "b%-018.obj"), "15-9x3", ahead,
                    &error) == MESO_OK);
    CHECK(meso_clip_frame_count(clip) == 3 && meso_clip_mesh(clip)->positions[0].x == 18);
    CHECK(meso_clip_place_frame(clip, 0, &error)[0].x == 15 && meso_clip_place_frame(clip, 2, &error)[0].x == 9);
    meso_clip_release(clip);
    test_folder_remove(&folder);
}

static void expect_bad_frame(const TestFolder *folder, const char *text, const char *message)
{
    for (int ahead = 0; ahead < 2; ahead++) {
        MesoClipFile *clip;
        MesoError error;
        write_frame(folder, 1);
        write_frame(folder, 2);
        write_frame(folder, 3);
        if (text)
            write_text(folder, "b%-002.obj", text);
        else
            CHECK(unlink(test_path(folder, "b%-002.obj")) == 0);
        CHECK(open_clip(&clip, test_path(folder, "b%%-%03d.obj"), NULL, "1-3", ahead, &error) == MESO_OK);
        CHECK(meso_clip_place_frame(clip, 0, &error));
        for (int again = 0; again < 2; again++) {
            CHECK(!meso_clip_place_frame(clip, 1, &error) && error.status == MESO_ERR_INPUT);
            check_message(folder, &error, message);
        }
        CHECK(meso_clip_place_frame(clip, 2, &error)[0].x == 3);      /* the others are as good as before */
        meso_clip_release(clip);
    }
}

static void test_bad_frames(void)
{
    TestFolder folder = test_folder_make();
    expect_bad_frame(&folder, NULL, "no such file 'b%-002.obj'");
    expect_bad_frame(&folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 2 4 3\n",
                     "b%-002.obj: 4 vertices; 'b%-001.obj' has 5");
    expect_bad_frame(&folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\n",
                     "b%-002.obj: 1 faces; 'b%-001.obj' has 2");
    expect_bad_frame(&folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 2 5 3 4\n",
                     "b%-002.obj: face 1 has 3 sides; in 'b%-001.obj' it has 4");
    expect_bad_frame(&folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 3 5\n",
                     "b%-002.obj: face 2 has vertex 3 as its corner 2; in 'b%-001.obj' that is vertex 5");
    expect_bad_frame(&folder, "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 nan 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 3\n",
                     "b%-002.obj:4: coordinate 'nan' is not a finite number");
    write_frame(&folder, 2);
    write_frame(&folder, 5);
    expect_no_clip(&folder, test_path(&folder, "b%%-%03d.obj"), NULL, NULL, MESO_ERR_INPUT,
                   "b%-004.obj: missing, between frames 3 and 5");
    expect_no_clip(&folder, test_path(&folder, "c-%d.obj"), NULL, NULL, MESO_ERR_INPUT,
                   "c-%d.obj: there are no such files");
    expect_no_clip(&folder, test_path(&folder, "c-1.obj"), NULL, NULL, MESO_ERR_USAGE,
                   "'c-1.obj' is no clip: a name with the frame's number, as in body-%04d.obj, a cache (.pc2, .mdd) "
                   "or an animation (.glb, .gltf) is");
    expect_no_clip(&folder, test_path(&folder, "%d/c.obj"), NULL, NULL, MESO_ERR_USAGE,
                   "'%d/c.obj': the number of a frame must stand in the name of the file for frames to be found; say "
                   "which there are");
    test_folder_remove(&folder);
}

/* A PC2 of three frames of five points; coordinate x of vertex 0 is the frame's number, from 1. */
static void write_cache(const TestFolder *folder, uint32_t points, float last)
{
    struct { char mark[12]; uint32_t version, points; float start, rate; uint32_t frames; } head = {
        "POINTCACHE2", 1, points, 0, 1, 3};
    char bytes[512];
    memcpy(bytes, &head, sizeof head);
    size_t size = sizeof head;
    for (uint32_t f = 0; f < 3; f++)
        for (uint32_t v = 0; v < points; v++, size += sizeof(MesoVec3)) {
            MesoVec3 p = {v ? (float)v : (float)(f + 1), 0, f == 2 && v == points - 1 ? last : 0};
            memcpy(bytes + size, &p, sizeof p);
        }
    test_file_write(test_path(folder, "b.pc2"), bytes, size);
}

static void test_cache(bool ahead)
{
    TestFolder folder = test_folder_make();
    MesoClipFile *clip;
    MesoError error;
    write_frame(&folder, 7);
    write_cache(&folder, 5, NAN);
    CHECK(open_clip(&clip, test_path(&folder, "b.pc2"), test_path(&folder, "b%-007.obj"), NULL, ahead, &error) ==
          MESO_OK);
    CHECK(meso_clip_frame_count(clip) == 3 && meso_clip_mesh(clip)->positions[0].x == 7);
    CHECK(meso_clip_place_frame(clip, 1, &error)[0].x == 2 && meso_clip_place_frame(clip, 0, &error)[0].x == 1);
    CHECK(!meso_clip_place_frame(clip, 2, &error));
    check_message(&folder, &error, "b.pc2: frame 3, vertex 5: coordinates that are not finite, or beyond 1e18");
    meso_clip_release(clip);
    CHECK(open_clip(&clip, test_path(&folder, "b.pc2"), test_path(&folder, "b%-007.obj"), "2,1,2", ahead, &error) ==
          MESO_OK);
    CHECK(meso_clip_frame_number(clip, 1) == 1 && meso_clip_place_frame(clip, 2, &error)[0].x == 2);
    meso_clip_release(clip);
    expect_no_clip(&folder, test_path(&folder, "b.pc2"), test_path(&folder, "b%-007.obj"), "1-4", MESO_ERR_INPUT,
                   "b.pc2: no frame 4; there are 1 to 3");
    expect_no_clip(&folder, test_path(&folder, "b.pc2"), NULL, NULL, MESO_ERR_USAGE,
                   "'b.pc2' has no faces: it needs a mesh beside it");
    write_cache(&folder, 4, 0);
    expect_no_clip(&folder, test_path(&folder, "b.pc2"), test_path(&folder, "b%-007.obj"), NULL, MESO_ERR_INPUT,
                   "b.pc2: 4 points; 'b%-007.obj' has 5 vertices");
    test_folder_remove(&folder);
}

/* Two triangles with a seam of their own vertices between; what was one in the first frame stays so. */
static void test_welded(void)
{
    TestFolder folder = test_folder_make();
    MesoClipFile *clip;
    MesoError error;
    for (int f = 1; f <= 2; f++) {
        char name[32], text[256];
        snprintf(name, sizeof name, "s%d.obj", f);
        snprintf(text, sizeof text, "v 0 0 0\nv 1 0 0\nv 0 1 %d\nv 1 0 0\nv 1 1 %d\nv 0 1 %d\nf 1 2 3\nf 4 5 6\n", f,
                 5 * f, f);
        write_text(&folder, name, text);
    }
    for (int ahead = 0; ahead < 2; ahead++) {
        const MesoClipSource source = {.path = test_path(&folder, "s%d.obj"), .weld = true, .ahead = ahead};
        CHECK(meso_clip_open(&clip, &source, &error) == MESO_OK);
        const MesoPolygonMesh *mesh = meso_clip_mesh(clip);
        CHECK(mesh->vertex_count == 4 && mesh->face_count == 2 && mesh->corners[3] == 1 && mesh->corners[4] == 3);
        for (int f = 1; f <= 2; f++) {
            const MesoVec3 *positions = meso_clip_place_frame(clip, (uint32_t)f - 1, &error);
            CHECK(positions && positions[2].z == (float)f && positions[3].z == (float)(5 * f) && positions[1].x == 1);
        }
        meso_clip_release(clip);
    }
    write_text(&folder, "s1.obj", "v 0 0 0\nv 0 0 0\nv 0 0 0\nf 1 2 3\n");
    const MesoClipSource source = {.path = test_path(&folder, "s%d.obj"), .weld = true};
    CHECK(meso_clip_open(&clip, &source, &error) == MESO_ERR_INPUT);
    test_folder_remove(&folder);
}

/* Two seconds at 24 frames each, the last one among them; vertex 1 goes along x by 2 a second. */
static void test_animation(bool ahead)
{
    TestFolder folder = test_folder_make();
    uint8_t bytes[8192];
    MesoClipFile *clip;
    MesoError error;
    const char *path = test_path(&folder, "a.glb");
    test_file_write(path, bytes, make_animated_glb(bytes, "LINEAR"));
    CHECK(open_clip(&clip, path, NULL, NULL, ahead, &error) == MESO_OK);
    CHECK(meso_clip_frame_count(clip) == 49 && meso_clip_frame_number(clip, 48) == 49);
    CHECK(meso_clip_mesh(clip)->face_count == 2 && meso_clip_mesh(clip)->positions[3].x == 0);
    CHECK(meso_clip_place_frame(clip, 48, &error)[1].x == 5 && meso_clip_place_frame(clip, 24, &error)[1].x == 3);
    CHECK(meso_clip_place_frame(clip, 25, &error)[1].x > 3);
    meso_clip_release(clip);
    CHECK(open_clip(&clip, path, NULL, "25,13", ahead, &error) == MESO_OK);
    CHECK(meso_clip_mesh(clip)->positions[1].x == 3 && meso_clip_place_frame(clip, 1, &error)[1].x == 2);
    meso_clip_release(clip);
    expect_no_clip(&folder, path, NULL, "0", MESO_ERR_INPUT, "a.glb: no frame 0; there are 1 to 49");
    test_folder_remove(&folder);
}

int main(void)
{
    for (int ahead = 0; ahead < 2; ahead++) {
        test_numbered(ahead);
        test_cache(ahead);
        test_animation(ahead);
    }
    test_bad_frames();
    test_welded();
    return 0;
}
