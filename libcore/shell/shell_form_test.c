/* Normals made anew, sides, heights by vertex; folds found where they are, and limited without a jump. */
#include "libcore/shell/shell_form.h"

#include <math.h>

#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;

enum { N = 16 };

typedef struct Surface {
    MesoQuadMesh mesh;
    MesoSlotGraph graph;
} Surface;

/* A grid of N by N quads over [-1, 1]^2, bent into a valley of radius r about the y axis, open upward. */
static Surface make_valley(double r)
{
    Surface s;
    MesoVec3 positions[(N + 1) * (N + 1)];
    uint32_t faces[4 * N * N];
    for (uint32_t j = 0; j <= N; j++)
        for (uint32_t i = 0; i <= N; i++) {
            double x = 2.0 * i / N - 1, y = 2.0 * j / N - 1, a = x / r;
            positions[j * (N + 1) + i] = (MesoVec3){(float)(r * sin(a)), (float)y, (float)(r - r * cos(a))};
        }
    for (uint32_t j = 0; j < N; j++)
        for (uint32_t i = 0; i < N; i++) {
            uint32_t v = j * (N + 1) + i, *f = &faces[4 * (j * N + i)];
            f[0] = v, f[1] = v + 1, f[2] = v + N + 2, f[3] = v + N + 1;
        }
    CHECK(meso_quad_mesh_build(&s.mesh, &arena, (N + 1) * (N + 1), positions, 0, NULL, N * N, faces, NULL, &error) ==
          MESO_OK);
    CHECK(meso_slot_graph_build(&s.graph, &arena, &s.mesh, &error) == MESO_OK);
    return s;
}

static MesoShell build(const Surface *s, MesoShellForm form)
{
    MesoShell shell;
    CHECK(meso_shell_build(&shell, &arena, &s->mesh, &s->graph, &form, &error) == MESO_OK);
    return shell;
}

/* Height of a corner over the surface. */
static double height(const MesoShell *shell, uint32_t slot, uint32_t corner, bool top)
{
    uint32_t v = shell->mesh->face_vertices[4 * slot + corner], n = shell->face_normals[4 * slot + corner];
    return (double)meso_vec3_dot(meso_vec3_sub(meso_shell_corner(shell, slot, corner, top), shell->mesh->positions[v]),
                                 shell->normals[n]);
}

static void test_sides(void)
{
    Surface s = make_valley(10);
    const double bottom[] = {0.5, 0.25, 0}, top[] = {1, 0.75, 0.5};
    for (uint32_t side = 0; side < 3; side++) {
        MesoShell shell = build(&s, (MesoShellForm){.offset = 0.5f, .thickness = 1, .side = side});
        CHECK(fabs(height(&shell, 7, 2, false) - bottom[side]) < 1e-6 && fabs(height(&shell, 7, 2, true) - top[side]) < 1e-6);
    }
}

/* Smooth ones are those of the sheet's cylinder, flat ones those of its faces; whatever the file says. */
static void test_normals(void)
{
    Surface s = make_valley(2);
    for (uint32_t kind = 0; kind < 2; kind++) {
        bool flat = kind == 1;
        MesoShell shell = build(&s, (MesoShellForm){.thickness = 1, .normals = MESO_NORMALS_SMOOTH + kind});
        for (uint32_t f = 0; f < N * N; f++)
            for (uint32_t k = 0; k < 4; k++) {
                uint32_t i = f % N + (k == 1 || k == 2);
                bool border = i == 0 || i == N;
                double x = 2.0 * (flat || border ? f % N + 0.5 : i) / N - 1, a = x / 2;
                MesoVec3 n = shell.normals[shell.face_normals[4 * f + k]];
                CHECK(fabs((double)n.x + sin(a)) < 1e-4 && fabs((double)n.z - cos(a)) < 1e-4);
            }
    }
}

static void test_heights(void)
{
    Surface s = make_valley(10);
    float factors[(N + 1) * (N + 1)], lifts[(N + 1) * (N + 1)];
    for (uint32_t v = 0; v < s.mesh.vertex_count; v++) {
        factors[v] = 1 + (float)v / 100;
        lifts[v] = (float)v / 1000;
    }
    MesoShell shell = build(&s, (MesoShellForm){.offset = 0.25f, .thickness = 2, .factors = factors, .lifts = lifts});
    for (uint32_t slot = 0; slot < N * N; slot++)
        for (uint32_t k = 0; k < 4; k++) {
            uint32_t v = s.mesh.face_vertices[4 * slot + k];
            CHECK(fabs(height(&shell, slot, k, false) - (0.25 + v / 1000.)) < 1e-5);
            CHECK(fabs(height(&shell, slot, k, true) - (0.25 + v / 1000. + 1 + v / 100.)) < 1e-5);
        }
    MesoPort one, two;      /* neighbours along x meet on the same floats */
    CHECK(meso_shell_wall_port(&shell, 0, 1, (MesoVec2){0.25f, 0.75f}, false, NULL, &one, &error) == MESO_OK);
    CHECK(meso_shell_wall_port(&shell, 1, 3, (MesoVec2){0.25f, 0.75f}, true, NULL, &two, &error) == MESO_OK);
    CHECK(one.point.x == two.point.x && one.point.y == two.point.y && one.point.z == two.point.z);
    MesoCage cage = meso_shell_cage(&shell, 5);
    for (uint32_t k = 0; k < 8; k++) {
        MesoVec3 a = meso_cage_corner(&cage, k), b = meso_shell_corner(&shell, 5, k & 3, k & 4);
        CHECK(meso_vec3_length(meso_vec3_sub(a, b)) < 1e-5f);
    }
}

/* A valley of radius r folds at the height r. Limited it does not, and each face's corners differ by the slope. */
static void test_folds(void)
{
    uint32_t slots[4];
    Surface s = make_valley(0.5);
    MesoShell shell = build(&s, (MesoShellForm){.thickness = 0.9f});
    CHECK(meso_shell_folds(&shell, slots, 4) == 0);
    shell = build(&s, (MesoShellForm){.thickness = 1.3f});
    CHECK(meso_shell_folds(&shell, slots, 4) == N * (N - 2) && slots[0] == 1 && slots[3] == 4);   /* not at the rims */
    shell = build(&s, (MesoShellForm){.thickness = 1.3f, .limit_folds = true});
    CHECK(meso_shell_folds(&shell, slots, 4) == 0);
    for (uint32_t slot = 0; slot < N * N; slot++) {
        double low = INFINITY, high = 0;
        for (uint32_t k = 0; k < 4; k++) {
            low = fmin(low, height(&shell, slot, k, true) / 0.65);
            high = fmax(high, height(&shell, slot, k, true) / 0.65);
        }
        CHECK(high <= 1.0001 && high - low <= MESO_LIMIT_SLOPE + 1e-4 && low >= 0.5);
    }
    shell = build(&s, (MesoShellForm){.thickness = 0.5f, .limit_folds = true});
    CHECK(fabs(height(&shell, 3, 0, true) - 0.25) < 1e-6);
}

int main(void)
{
    meso_arena_init(&arena);
    test_sides();
    test_normals();
    test_heights();
    test_folds();
    meso_arena_release(&arena);
    return 0;
}
