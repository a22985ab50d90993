/* What the tests of the writers share: files in a folder of their own, and what Draco's own decoder makes of them. */
#ifndef MESO_MESH_FILE_FIXTURE_H
#define MESO_MESH_FILE_FIXTURE_H

#include <unistd.h>

#include "formats/file/input.h"
#include "formats/scene/mesh_file.h"
#include "formats/scene/scene_fixture.h"

typedef MesoStatus WriteMesh(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                             MesoOutput *output, MesoError *error);

static char folder[] = "/tmp/mesh_file_test.XXXXXX";

static inline const char *path_of(const char *name)
{
    static char paths[8][64];
    static int next;
    char *path = paths[next++ % 8];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

/* `how` may be NULL. */
static inline MesoInput write_mesh_as(WriteMesh *write, const MesoSceneParts *t, const MesoMeshWriteOptions *how,
                                      uint32_t threads, const char *path)
{
    MesoProvenance provenance = {.tool = "meso-map", .command_line = "meso-map 'a b' \"c\"", .seed = 7};
    MesoMeshWriteOptions options = how ? *how : (MesoMeshWriteOptions){.speed = 7};
    MesoOutput *output;
    MesoInput input;
    MesoError error;
    options.thread_count = threads;
    options.provenance = &provenance;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    CHECK(write(t, &options, output, &error) == MESO_OK);
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(meso_input_open(&input, path, &error) == MESO_OK);
    return input;
}

static inline MesoInput write_mesh(WriteMesh *write, const MesoSceneParts *t, uint32_t threads, const char *path)
{
    return write_mesh_as(write, t, NULL, threads, path);
}

/* The same bytes for 1 and 7 threads. */
static inline void check_threads_as(WriteMesh *write, const MesoSceneParts *t, const MesoMeshWriteOptions *how,
                                    const MesoInput *expected)
{
    for (uint32_t threads = 1; threads <= 7; threads += 6) {
        MesoInput again = write_mesh_as(write, t, how, threads, path_of("again"));
        CHECK(again.size == expected->size && memcmp(again.data, expected->data, again.size) == 0);
        meso_input_close(&again);
    }
}

static inline void check_threads(WriteMesh *write, const MesoSceneParts *t, const MesoInput *expected)
{
    check_threads_as(write, t, NULL, expected);
}

static inline void remove_products(const char *const *names, int count)
{
    for (int i = 0; i < count; i++)
        remove(path_of(names[i]));
    CHECK(rmdir(folder) == 0);
}

/* All polygons at once, in the scene's arena. */
typedef struct Whole {
    uint64_t vertex_count, face_count;
    MesoMeshVertex *vertices;
    MesoMeshFace *faces;
} Whole;

static inline Whole make_whole(SceneFixture *s)
{
    MesoError error;
    const MesoSceneParts *t = &s->parts;
    Whole whole = {t->vertex_begin[t->part_count], t->face_begin[t->part_count], NULL, NULL};
    whole.vertices = MESO_NEW(&s->arena, MesoMeshVertex, whole.vertex_count, &error);
    whole.faces = MESO_NEW(&s->arena, MesoMeshFace, whole.face_count, &error);
    CHECK(whole.vertices && whole.faces);
    meso_scene_vertices(t, 0, t->part_count, whole.vertices);
    meso_scene_faces(t, 0, t->part_count, 0, whole.faces);
    return whole;
}

static inline const uint8_t *after(const MesoInput *input, const char *line)
{
    size_t length = strlen(line);
    for (size_t i = 0; i + length <= input->size && i < 1 << 14; i++)
        if (memcmp(input->data + i, line, length) == 0)
            return input->data + i + length;
    return NULL;
}

typedef struct Decoded {
    uint64_t vertex_count, face_count;
    MesoBox box;
} Decoded;

static inline uint64_t number_after(const MesoInput *input, const char *line)
{
    const uint8_t *digits = after(input, line);
    CHECK(digits);
    return strtoull((const char *)digits, NULL, 10);
}

/* The decoder writes positions and normals as 24 bytes, and colours as 3 more, then the faces. */
static inline Decoded decode(const char *path)
{
    char command[512];
    const char *ply = path_of("decoded.ply");
    MesoInput input;
    MesoError error;
    snprintf(command, sizeof command, "draco_decoder -i %s -o %s >/dev/null 2>&1", path, ply);
    CHECK(system(command) == 0);
    CHECK(meso_input_open(&input, ply, &error) == MESO_OK);
    Decoded d = {number_after(&input, "element vertex "), number_after(&input, "element face "), meso_box_empty()};
    const uint8_t *rows = after(&input, "end_header\n");
    size_t row = after(&input, "property uchar red\n") ? 27 : 24;
    CHECK(rows && (size_t)(input.data + input.size - rows) >= row * d.vertex_count);
    for (uint64_t i = 0; i < d.vertex_count; i++) {
        MesoVec3 p;
        memcpy(&p, rows + row * i, 12);
        meso_box_add(&d.box, p);
    }
    meso_input_close(&input);
    remove(ply);
    return d;
}

static inline bool contains(const MesoInput *input, const char *text)
{
    size_t length = strlen(text);
    for (size_t i = 0; i + length <= input->size; i++)
        if (memcmp(input->data + i, text, length) == 0)
            return true;
    return false;
}

static inline void check_near(MesoVec3 a, MesoVec3 b, float tolerance)
{
    CHECK(fabsf(a.x - b.x) <= tolerance && fabsf(a.y - b.y) <= tolerance && fabsf(a.z - b.z) <= tolerance);
}

#endif
