#include "libcore/growth/shape/bend.h"

#include "libcore/base/parallel.h"
#include "libcore/growth/shape/bend_kernel.h"

static MesoVec3 first_of(MesoLanes3 a)
{
    return (MesoVec3){a.x[0], a.y[0], a.z[0]};
}

static void load_one(MesoBendLanes *lanes, const MesoJoint *from, const MesoJoint *to)
{
    const MesoJoint *all_from[MESO_LANES], *all_to[MESO_LANES];
    for (uint32_t lane = 0; lane < MESO_LANES; lane++) {
        all_from[lane] = from;
        all_to[lane] = to;
    }
    meso_bend_load(lanes, all_from, all_to);
}

MesoBendFrame meso_bend_frame(const MesoJoint *from, const MesoJoint *to, float t)
{
    MesoBendLanes lanes;
    MesoBendRing ring;
    load_one(&lanes, from, to);
    meso_bend_ring(&ring, &lanes, t);
    return (MesoBendFrame){first_of(ring.origin), first_of(ring.tangent), first_of(ring.left), first_of(ring.normal),
                           ring.width[0]};
}

void meso_bend_curve(const MesoJoint *from, const MesoJoint *to, MesoVec3 p[4])
{
    MesoBendLanes lanes;
    load_one(&lanes, from, to);
    for (uint32_t i = 0; i < 4; i++)
        p[i] = first_of(lanes.p[i]);
}

static void bend_group_plain(const MesoTerminalShape *shape, MesoBendGroup *group)
{
    meso_bend_group(shape, group);
}

/* The same operations, and so the same bytes, on wider registers. */
#ifdef __x86_64__
__attribute__((target("avx2"))) static void bend_group_avx2(const MesoTerminalShape *shape, MesoBendGroup *group)
{
    meso_bend_group(shape, group);
}
#endif

static void (*best_bend_group(void))(const MesoTerminalShape *, MesoBendGroup *)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2"))
        return bend_group_avx2;
#endif
    return bend_group_plain;
}

static MesoBox box_of(const MesoBendGroup *group)
{
    MesoBox box = meso_box_empty();
    for (uint32_t lane = 0; lane < MESO_LANES; lane++) {
        meso_box_add(&box, (MesoVec3){group->low.x[lane], group->low.y[lane], group->low.z[lane]});
        meso_box_add(&box, (MesoVec3){group->high.x[lane], group->high.y[lane], group->high.z[lane]});
    }
    return box;
}

/* Joints of the spans before `end` that come next: they may lie anywhere. */
static void fetch_joints(const MesoBending *bending, uint64_t first, uint64_t end)
{
    for (uint64_t i = first; i < first + MESO_LANES && i < end; i++) {
        const char *joint = (const char *)&bending->joints[bending->spans[i].to];
        __builtin_prefetch(joint);
        __builtin_prefetch(joint + sizeof(MesoJoint) - 1);
    }
}

/* Where less than eight are left, the last is computed several times, and written to the same place. */
static void bend_range(void *context, uint64_t begin, uint64_t end)
{
    const MesoBending *bending = context;
    void (*bend)(const MesoTerminalShape *, MesoBendGroup *) = best_bend_group();
    MesoLanes most = meso_lanes_all(INFINITY);
    MesoBendGroup group = {.low = {most, most, most}, .high = {-most, -most, -most}};
    for (uint64_t first = begin; first < end; first += MESO_LANES) {
        uint64_t spans[MESO_LANES];
        for (uint32_t lane = 0; lane < MESO_LANES; lane++) {
            uint64_t i = first + lane < end ? first + lane : end - 1;
            size_t offset = (size_t)i * bending->shape->body.vertex_count;
            spans[lane] = i;
            group.from[lane] = &bending->joints[bending->spans[i].from];
            group.to[lane] = &bending->joints[bending->spans[i].to];
            group.positions[lane] = bending->positions + offset;
            group.normals[lane] = bending->normals + offset;
        }
        fetch_joints(bending, first + 2 * MESO_LANES, end);
        bend(bending->shape, &group);
        for (uint32_t lane = 0; lane < MESO_LANES && bending->folds; lane++)
            bending->folds[spans[lane]] = group.folds[lane] != 0;
    }
    if (bending->boxes)
        bending->boxes[begin / MESO_BEND_GRAIN] = box_of(&group);
}

void meso_bend(const MesoBending *bending, uint32_t thread_count)
{
    meso_parallel_for(thread_count, bending->span_count, MESO_BEND_GRAIN, bend_range, (void *)bending);
}
