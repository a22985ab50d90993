/*
 * Rates of reading two million quads with normals and texture coordinates, from files in memory's own store: beside
 * counting lines, copying the bytes into fresh memory, and OpenMesh; and peak memory but for the file, beside what the
 * mesh holds, which it should be at most 1.3 times.
 *
 *     mesh_read_bench [THREADS]
 */
#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "formats/mesh/mesh_read.h"
#include "formats/mesh/openmesh_adapter.h"
#include "libcore/base/check.h"
#include "libcore/base/clock.h"
#include "libcore/mesh/surface.h"

enum { WIDTH = 2000, HEIGHT = 1000, ROW = WIDTH + 1, VERTICES = ROW * (HEIGHT + 1), FACES = WIDTH * HEIGHT, ROUNDS = 5 };

static uint32_t threads;

/* ---- files ---- */

typedef struct Vertex {
    float x, y, z, nx, ny, nz, u, v;
} Vertex;

static Vertex vertex(uint32_t i)
{
    float u = (float)(i % ROW) / WIDTH, v = (float)(i / ROW) / HEIGHT;
    float slope = 0.3f * cosf(9 * u);
    return (Vertex){2 * u, v, 0.0333f * sinf(9 * u), -slope, 0.013f * v, sqrtf(1 - slope * slope), u, v};
}

static void corners(uint32_t f, uint32_t c[4])
{
    c[0] = f / WIDTH * ROW + f % WIDTH;
    c[1] = c[0] + 1;
    c[2] = c[1] + ROW;
    c[3] = c[0] + ROW;
}

static void write_obj(FILE *file)
{
    for (uint32_t i = 0; i < VERTICES; i++)
        fprintf(file, "v %.6f %.6f %.6f\n", (double)vertex(i).x, (double)vertex(i).y, (double)vertex(i).z);
    for (uint32_t i = 0; i < VERTICES; i++)
        fprintf(file, "vt %.6f %.6f\n", (double)vertex(i).u, (double)vertex(i).v);
    for (uint32_t i = 0; i < VERTICES; i++)
        fprintf(file, "vn %.4f %.4f %.4f\n", (double)vertex(i).nx, (double)vertex(i).ny, (double)vertex(i).nz);
    for (uint32_t f = 0, c[4]; f < FACES; f++) {
        corners(f, c);
        fprintf(file, "f");
        for (uint32_t k = 0; k < 4; k++)
            fprintf(file, " %u/%u/%u", c[k] + 1, c[k] + 1, c[k] + 1);
        fprintf(file, "\n");
    }
}

static void write_ply(FILE *file)
{
    fprintf(file, "ply\nformat binary_little_endian 1.0\nelement vertex %d\n", VERTICES);
    for (uint32_t i = 0; i < 8; i++)
        fprintf(file, "property float %s\n", (const char *[]){"x", "y", "z", "nx", "ny", "nz", "s", "t"}[i]);
    fprintf(file, "element face %d\nproperty list uchar int vertex_indices\nend_header\n", FACES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        Vertex v = vertex(i);
        fwrite(&v, sizeof v, 1, file);
    }
    for (uint32_t f = 0, c[4]; f < FACES; f++) {
        corners(f, c);
        fputc(4, file);
        fwrite(c, sizeof c, 1, file);
    }
}

static void write_off(FILE *file)
{
    fprintf(file, "NOFF\n%d %d 0\n", VERTICES, FACES);
    for (uint32_t i = 0; i < VERTICES; i++) {
        Vertex v = vertex(i);
        fprintf(file, "%.6f %.6f %.6f %.4f %.4f %.4f\n", (double)v.x, (double)v.y, (double)v.z, (double)v.nx,
                (double)v.ny, (double)v.nz);
    }
    for (uint32_t f = 0, c[4]; f < FACES; f++) {
        corners(f, c);
        fprintf(file, "4 %u %u %u %u\n", c[0], c[1], c[2], c[3]);
    }
}

/* ---- what is timed ---- */

static void read_mesh(const MesoInput *input)
{
    MesoArena arena;
    MesoPolygonMesh mesh;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_polygon_mesh_read(&mesh, &arena, input, threads, &error) == MESO_OK);
    CHECK(mesh.face_count == FACES && mesh.side_count == 4);
    meso_arena_release(&arena);
}

static void read_surface(const MesoInput *input)
{
    MesoArena arena;
    MesoPolygonMesh mesh;
    MesoSurface surface;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_polygon_mesh_read(&mesh, &arena, input, threads, &error) == MESO_OK);
    CHECK(meso_surface_build(&surface, &arena, &mesh, threads, &error) == MESO_OK);
    meso_arena_release(&arena);
}

static void copy_bytes(const MesoInput *input)
{
    volatile char *copy = malloc(input->size);
    CHECK(copy);
    memcpy((char *)copy, input->data, input->size);
    CHECK(copy[input->size / 2] == (char)input->data[input->size / 2]);
    free((char *)copy);
}

static void count_lines(const MesoInput *input)
{
    const uint8_t *at = input->data, *end = at + input->size;
    size_t lines = 0;
    for (; (at = memchr(at, '\n', (size_t)(end - at))) != NULL && ++at < end; lines++) {}
    CHECK(lines > 0);
}

static void open_again(const MesoInput *input)
{
    MesoInput again;
    CHECK(meso_input_open(&again, input->path, NULL) == MESO_OK);
    meso_input_close(&again);
}

static void take_vertex(void *context, float x, float y, float z)
{
    (void)context, (void)x, (void)y, (void)z;
}

static void take_face(void *context, const uint32_t *vertices, uint32_t count)
{
    (void)context, (void)vertices, (void)count;
}

static MesoOpenMeshKind openmesh_kind;

static void read_openmesh(const MesoInput *input)
{
    MesoOpenMeshSink sink = {NULL, take_vertex, take_face};
    CHECK(meso_openmesh_read(openmesh_kind, (const char *)input->data, input->size, &sink, NULL) == MESO_OK);
}

static double best_of(uint32_t rounds, void (*body)(const MesoInput *input), const MesoInput *input)
{
    double best = INFINITY;
    for (uint32_t i = 0; i < rounds; i++) {
        double start = meso_seconds();
        body(input);
        best = fmin(best, meso_seconds() - start);
    }
    return best;
}

/* ---- memory ---- */

static double holds(const MesoPolygonMesh *mesh)
{
    double bytes = 12.0 * mesh->vertex_count + 4.0 * mesh->corner_count + (mesh->face_begin ? 4.0 * (mesh->face_count + 1) : 0);
    for (const MesoAttribute *a = mesh->attributes; a < mesh->attributes + mesh->attribute_count; a++)
        bytes += (double)a->entry_count * a->width * meso_scalar_size(a->scalar) +
                 (a->entry_of ? 4.0 * meso_polygon_elements(mesh, a->domain) : 0);
    return bytes;
}

/* The most that was resident so far, in bytes. */
static double peak(void)
{
    double bytes = 0;
    char line[200];
    FILE *file = fopen("/proc/self/status", "r");
    while (file && fgets(line, sizeof line, file))
        if (strncmp(line, "VmHWM:", 6) == 0)
            bytes = 1024 * atof(line + 6);
    if (file)
        fclose(file);
    return bytes;
}

/* The file's bytes in memory of our own, all there before the reading begins: its mapped pages would come and go. */
static void copy_file(MesoInput *copy, const char *path)
{
    MesoInput input;
    CHECK(meso_input_open(&input, path, NULL) == MESO_OK);
    char *data = malloc(input.size);
    CHECK(data);
    memcpy(data, input.data, input.size);
    meso_input_wrap(copy, path, data, input.size);
    meso_input_close(&input);
}

static void read_and_print(const char *path)
{
    MesoArena arena;
    MesoInput input;
    MesoPolygonMesh mesh;
    MesoSurface surface;
    copy_file(&input, path);
    malloc_trim(0);     /* of what was read before, nothing is there to use again */
    FILE *reset = fopen("/proc/self/clear_refs", "w");
    CHECK(reset && fputs("5", reset) >= 0 && fclose(reset) == 0);
    double before = peak();
    meso_arena_init(&arena);
    CHECK(meso_polygon_mesh_read(&mesh, &arena, &input, threads, NULL) == MESO_OK);
    double reading = peak() - before, held = holds(&mesh);
    CHECK(meso_surface_build(&surface, &arena, &mesh, threads, NULL) == MESO_OK);
    double joining = peak() - before, joined = held + 4.0 * mesh.corner_count;
    printf("    the mesh holds %.0f MB, reading it took %.0f MB at most: %.2f times that; with neighbours %.0f MB, %.0f MB: %.2f\n",
           1e-6 * held, 1e-6 * reading, reading / held, 1e-6 * joined, 1e-6 * joining, joining / joined);
    fflush(stdout);
}

/* In a process of its own, whose memory is nothing else. */
static void print_memory(const char *path)
{
    fflush(stdout);
    pid_t child = fork();
    if (child == 0) {
        read_and_print(path);
        _exit(0);
    }
    waitpid(child, NULL, 0);
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*write)(FILE *file);
        MesoOpenMeshKind kind;
    } rows[] = {{"obj", write_obj, MESO_OPENMESH_OBJ}, {"ply", write_ply, MESO_OPENMESH_PLY},
                {"off", write_off, MESO_OPENMESH_OFF}};
    threads = argc > 1 ? (uint32_t)atol(argv[1]) : 0;
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char path[100];
        MesoInput input;
        snprintf(path, sizeof path, "/dev/shm/mesh_read_bench.%d.%s", (int)getpid(), rows[i].name);
        FILE *file = fopen(path, "wb");
        CHECK(file);
        rows[i].write(file);
        CHECK(fclose(file) == 0 && meso_input_open(&input, path, NULL) == MESO_OK);
        openmesh_kind = rows[i].kind;
        double rate = 1e-6 * (double)input.size;
        printf("%s, 2 M quads, %.0f MB, best of %d: %.0f MB/s; with neighbours %.0f MB/s; opening and hashing %.0f MB/s;\n"
               "    lines counted %.0f MB/s, copied into fresh memory %.0f MB/s, OpenMesh %.0f MB/s\n",
               rows[i].name, rate, ROUNDS, rate / best_of(ROUNDS, read_mesh, &input), rate / best_of(ROUNDS, read_surface, &input),
               rate / best_of(ROUNDS, open_again, &input), rate / best_of(ROUNDS, count_lines, &input),
               rate / best_of(ROUNDS, copy_bytes, &input), rate / best_of(1, read_openmesh, &input));
        meso_input_close(&input);
        print_memory(path);
        unlink(path);
    }
    return 0;
}
