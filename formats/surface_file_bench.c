/* Rate of reading an OBJ of 250000 quads with a normal a vertex. */
#include <math.h>
#include <stdio.h>

#include "formats/surface_file.h"
#include "libcore/base/check.h"
#include "libcore/base/clock.h"

enum { SIDE = 500, ROW = SIDE + 1, ROUNDS = 5, LINE = 64 };

static size_t make_grid(char *out)
{
    char *at = out;
    for (int v = 0; v < ROW * ROW; v++)
        at += sprintf(at, "v %.6f %.6f %.6f\n", 0.01 * (v % ROW), 0.01 * (v / ROW), sin(0.02 * (v % ROW)));
    for (int v = 0; v < ROW * ROW; v++)
        at += sprintf(at, "vn %.4f 0.0000 1.0000\n", -2 * cos(0.02 * (v % ROW)));
    for (int f = 0; f < SIDE * SIDE; f++) {
        int a = f / SIDE * ROW + f % SIDE + 1, b = a + 1, c = b + ROW, d = a + ROW;
        at += sprintf(at, "f %d//%d %d//%d %d//%d %d//%d\n", a, a, b, b, c, c, d, d);
    }
    return (size_t)(at - out);
}

int main(void)
{
    MesoArena arena;
    MesoInput input;
    MesoError error;
    double best = 1e9;
    meso_arena_init(&arena);
    char *text = MESO_NEW(&arena, char, (size_t)LINE * 3 * ROW * ROW, &error);
    CHECK(text);
    meso_input_wrap(&input, "grid.obj", text, make_grid(text));
    for (int i = 0; i < ROUNDS; i++) {
        MesoQuadMesh mesh;
        MesoArenaMark mark = meso_arena_mark(&arena);
        double start = meso_seconds();
        CHECK(meso_surface_read(&mesh, &arena, &input, &error) == MESO_OK);
        double took = meso_seconds() - start;
        best = took < best ? took : best;
        CHECK(mesh.face_count == SIDE * SIDE && mesh.normal_count == ROW * ROW);
        meso_arena_rewind(&arena, mark);
    }
    printf("read OBJ, 250000 quads: %.0f ms, %.0f MB/s\n", 1e3 * best, 1e-6 * (double)input.size / best);
    meso_arena_release(&arena);
    return 0;
}
