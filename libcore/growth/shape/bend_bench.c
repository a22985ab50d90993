/* Rates of bending on one thread, of each shape along a helix: to memory that is there, and to some in the cache. */
#include <time.h>

#include "libcore/base/check.h"
#include "libcore/growth/shape/bend.h"

enum { SPANS = 40000, WINDOW = 256, ROUNDS = 7 };

/* Processor time: a single thread, on machines that have more to do. */
static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static MesoJoint helix_joint(uint32_t i)
{
    float angle = 0.1f * (float)i;
    MesoVec3 normal = {cosf(angle), sinf(angle), 0}, heading = {-sinf(angle), cosf(angle), 0.1f};
    MesoVec3 position = {normal.x, normal.y, 0.01f * (float)i};
    return meso_joint(position, normal, heading, heading, 0.05f, 0);
}

/* All of the spans, `window` of them at a time to the same memory; the best of some rounds. */
static double time_windows(MesoBending bending, const MesoSpan *spans, uint32_t window)
{
    double best = 1e9;
    for (int round = 0; round < ROUNDS; round++) {
        double begin = seconds();
        for (uint32_t first = 0; first < SPANS; first += window) {
            bending.spans = spans + first;
            bending.span_count = SPANS - first < window ? SPANS - first : window;
            meso_bend(&bending, 1);
        }
        double took = seconds() - begin;
        best = took < best ? took : best;
    }
    return best;
}

static void time_shape(const MesoJoint *joints, const MesoSpan *spans, MesoBuiltinShape kind, uint32_t detail)
{
    MesoArena arena;
    MesoTerminalShape shape;
    meso_arena_init(&arena);
    CHECK(!meso_builtin_shape(&shape, &arena, kind, detail, NULL));
    size_t count = (size_t)SPANS * shape.body.vertex_count;
    MesoBending bending = {.shape = &shape, .joints = joints};
    bending.positions = MESO_NEW(&arena, MesoVec3, count, NULL);
    bending.normals = MESO_NEW(&arena, MesoVec3, count, NULL);
    CHECK(bending.positions && bending.normals);
    double all = time_windows(bending, spans, SPANS), again = time_windows(bending, spans, WINDOW);
    printf("bend %-5s %4u vertices, %3u rings: %4.0f million vertices/s, %4.0f in cache, %3.0f million triangles/s\n",
           meso_builtin_shape_names[kind], shape.body.vertex_count, shape.ring_count, 1e-6 * (double)count / all,
           1e-6 * (double)count / again, 1e-6 * SPANS * shape.body.face_count / all);
    meso_arena_release(&arena);
}

int main(void)
{
    MesoJoint *joints = malloc((SPANS + 1) * sizeof *joints);
    MesoSpan *spans = malloc(SPANS * sizeof *spans);
    CHECK(joints && spans);
    for (uint32_t i = 0; i <= SPANS; i++)
        joints[i] = helix_joint(i);
    for (uint32_t i = 0; i < SPANS; i++)
        spans[i] = (MesoSpan){i, i + 1};
    for (uint32_t detail = 0; detail <= 2; detail += 2)
        for (MesoBuiltinShape kind = 0; kind < MESO_BUILTIN_SHAPES; kind++)
            time_shape(joints, spans, kind, detail);
    free(joints);
    free(spans);
    return 0;
}
