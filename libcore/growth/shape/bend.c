#include "libcore/growth/shape/bend.h"

#include "libcore/base/parallel.h"
#include "libcore/growth/shape/bend_kernel.h"

/* Spans that a thread takes at once; a multiple of four. */
enum { GRAIN = 1024 };

static MesoVec3 first_of(MesoFour3 a)
{
    return (MesoVec3){a.x[0], a.y[0], a.z[0]};
}

static void load_one(MesoBendLanes *lanes, const MesoJoint *from, const MesoJoint *to)
{
    const MesoJoint *const four_from[4] = {from, from, from, from}, *const four_to[4] = {to, to, to, to};
    meso_bend_load(lanes, four_from, four_to);
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

/* The vertices of four spans, to `positions` and `normals`; returns bits of those that fold. */
static MesoFourBits bend_four(const MesoTerminalShape *shape, const MesoBendLanes *lanes, MesoVec3 *const positions[4],
                              MesoVec3 *const normals[4])
{
    MesoFourBits folds = {0, 0, 0, 0};
    uint32_t last = shape->body.vertex_count - 1;
    for (uint32_t r = 0; r < shape->ring_count; r++) {
        MesoBendRow row;
        meso_bend_row(&row, lanes, shape->along[r]);
        for (uint32_t v = shape->ring_begin[r]; v < shape->ring_begin[r + 1]; v++) {
            MesoVec3 p = shape->body.positions[v], n = shape->body.normals[v];
            MesoFour g = row.ring.speed + (row.pitch * p.z - row.turn * p.y);
            MesoFour3 at = meso_four3_mad(meso_four3_mad(row.ring.origin, meso_four_all(p.y), row.left),
                                          meso_four_all(p.z), row.normal);
            folds |= g < 0;
            meso_bend_store(positions, v, at, v == last);
            meso_bend_store(normals, v, meso_bend_normal(&row, p, n, g), v == last);
        }
    }
    return folds;
}

/* Where less than four are left, the last is computed several times, and written to the same place. */
static void bend_range(void *context, uint64_t begin, uint64_t end)
{
    const MesoBending *bending = context;
    for (uint64_t first = begin; first < end; first += 4) {
        const MesoJoint *from[4], *to[4];
        MesoVec3 *positions[4], *normals[4];
        uint64_t spans[4];
        for (uint32_t lane = 0; lane < 4; lane++) {
            uint64_t i = first + lane < end ? first + lane : end - 1;
            size_t offset = (size_t)i * bending->shape->body.vertex_count;
            spans[lane] = i;
            from[lane] = &bending->joints[bending->spans[i].from];
            to[lane] = &bending->joints[bending->spans[i].to];
            positions[lane] = bending->positions + offset;
            normals[lane] = bending->normals + offset;
        }
        MesoBendLanes lanes;
        meso_bend_load(&lanes, from, to);
        MesoFourBits folds = bend_four(bending->shape, &lanes, positions, normals);
        for (uint32_t lane = 0; lane < 4 && bending->folds; lane++)
            bending->folds[spans[lane]] = folds[lane] != 0;
    }
}

void meso_bend(const MesoBending *bending, uint32_t thread_count)
{
    meso_parallel_for(thread_count, bending->span_count, GRAIN, bend_range, (void *)bending);
}
