/*
 * Rates of the mesh writers on a generated structure, best of four. Beside the
 * PLY: what it costs to copy that much memory and to write that many bytes to
 * the same folder.
 *
 *     mesh_file_bench [FOLDER] [THREADS]
 */
#include <sys/stat.h>

#include "formats/scene/mesh_file.h"
#include "formats/scene/scene_fixture.h"
#include "libcore/base/clock.h"

enum { ROUNDS = 4, COPY_BYTES = 8 << 20 };

typedef MesoStatus WriteMesh(const MesoSceneParts *parts, const MesoMeshWriteOptions *options,
                             MesoOutput *output, MesoError *error);

/*
 * The time until all bytes are written. The first round is kept and gives the
 * size; the others are thrown away, so that no sync to the disk, which is not
 * ours to measure, goes on behind them.
 */
static double write_once(WriteMesh *write, const SceneFixture *fixture, uint32_t threads, const char *path,
                         uint64_t *bytes)
{
    MesoOutput *output;
    MesoError error;
    MesoMeshWriteOptions options = {.thread_count = threads, .speed = 7};
    struct stat file;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    double start = meso_seconds();
    if (write(&fixture->parts, &options, output, &error) != MESO_OK) {
        fprintf(stderr, "%s\n", error.message);
        exit(1);
    }
    double time = meso_seconds() - start;
    if (*bytes > 0) {
        meso_output_discard(output);
        return time;
    }
    CHECK(meso_output_commit(output, &error) == MESO_OK);
    CHECK(stat(path, &file) == 0);
    *bytes = (uint64_t)file.st_size;
    remove(path);
    return time;
}

/* Returns the size of the product. */
static uint64_t bench(const char *kind, WriteMesh *write, uint32_t slots, uint32_t threads, const char *folder)
{
    SceneFixture fixture;
    char path[512];
    double best = 1e30;
    uint64_t bytes = 0;
    scene_fixture_init(&fixture, slots, 20, 0.01f);
    snprintf(path, sizeof path, "%s/mesh_file_bench.%s", folder, kind);
    for (int i = 0; i < ROUNDS; i++) {
        double time = write_once(write, &fixture, threads, path, &bytes);
        best = time < best ? time : best;
    }
    uint64_t triangles = fixture.parts.triangle_count;
    printf("%s  %8.3f M triangles  %8.1f MB  %7.1f ms  %8.1f MB/s  %7.2f M triangles/s  %5.2f B/triangle\n",
           kind, 1e-6 * (double)triangles, 1e-6 * (double)bytes, 1e3 * best, 1e-6 * (double)bytes / best,
           1e-6 * (double)triangles / best, (double)bytes / (double)triangles);
    scene_fixture_release(&fixture);
    return bytes;
}

static double copy_and_write_once(uint8_t *from, uint8_t *to, uint64_t total, const char *path, double *copying)
{
    MesoOutput *output;
    MesoError error;
    CHECK(meso_output_open(&output, path, &error) == MESO_OK);
    double writing = 0;
    *copying = 0;
    for (uint64_t done = 0; done < total; done += COPY_BYTES) {
        double start = meso_seconds();
        memcpy(to, from, COPY_BYTES);
        from[done / COPY_BYTES % COPY_BYTES] ^= to[0];
        *copying += meso_seconds() - start;
        start = meso_seconds();
        CHECK(meso_output_write(output, to, COPY_BYTES, &error) == MESO_OK);
        writing += meso_seconds() - start;
    }
    meso_output_discard(output);
    return writing;
}

static void bench_copy(uint64_t total, const char *folder)
{
    MesoArena arena;
    MesoError error;
    char path[512];
    double copying = 1e30, writing = 1e30;
    meso_arena_init(&arena);
    uint8_t *from = MESO_NEW(&arena, uint8_t, COPY_BYTES, &error);
    uint8_t *to = MESO_NEW(&arena, uint8_t, COPY_BYTES, &error);
    CHECK(from && to);
    snprintf(path, sizeof path, "%s/mesh_file_bench.copy", folder);
    for (int i = 0; i < ROUNDS; i++) {
        double copy, write = copy_and_write_once(from, to, total, path, &copy);
        copying = copy < copying ? copy : copying;
        writing = write < writing ? write : writing;
    }
    printf("copy that much memory %.0f MB/s, write that much %.0f MB/s, both %.0f MB/s (one thread)\n",
           1e-6 * (double)total / copying, 1e-6 * (double)total / writing,
           1e-6 * (double)total / (copying + writing));
    meso_arena_release(&arena);
}

static MesoStatus write_draco(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                              MesoError *error)
{
    MesoMeshWriteOptions draco = *options;
    draco.compression = MESO_GLB_DRACO;
    return meso_glb_write(parts, &draco, output, error);
}

int main(int argc, char **argv)
{
    const char *folder = argc > 1 ? argv[1] : ".";
    uint32_t threads = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 0;
    bench_copy(bench("ply", meso_ply_write, 50, threads, folder), folder);
    bench("obj", meso_obj_write, 25, threads, folder);
    bench("drc", meso_drc_write, 16, threads, folder);
    bench("draco.glb", write_draco, 25, threads, folder);
    bench("glb", meso_glb_write, 50, threads, folder);
    bench("stl", meso_stl_write, 50, threads, folder);
    return 0;
}
