#include "libcore/field/field_comb.h"

typedef struct Comb {
    const MesoFieldPowers *powers;
    MesoVec3 *directions;       /* [triangle_count] */
    MesoComplex *in_frames;     /* [triangle_count] the same */
    uint8_t *combed;            /* [triangle_count] */
    uint32_t *queue;            /* [triangle_count] */
    uint32_t begin, end;        /* of the queue */
} Comb;

/* The turn of a direction by a multiple of 2 pi / symmetry that is nearest to another one. */
static MesoComplex nearest_turn(MesoComplex direction, uint32_t symmetry, MesoComplex to)
{
    MesoComplex back = meso_complex_times(direction, meso_complex_conjugate(to));
    if (symmetry == 4 && fabs(back.im) > fabs(back.re)) {
        MesoComplex quarter = {0, back.im > 0 ? -1 : 1};
        return meso_complex_times(direction, quarter);
    }
    if (symmetry == 3 || symmetry > 4) {
        double part = 2 * MESO_PI / symmetry, angle = -part * rint(atan2(back.im, back.re) / part);
        return meso_complex_times(direction, (MesoComplex){cos(angle), sin(angle)});
    }
    if (symmetry > 1 && back.re < 0)
        return (MesoComplex){-direction.re, -direction.im};
    return direction;
}

static void add_triangle(Comb *comb, uint32_t triangle, MesoComplex like)
{
    const MesoFieldPowers *p = comb->powers;
    MesoComplex root = meso_complex_root(p->powers[triangle], p->symmetry);
    comb->in_frames[triangle] = nearest_turn(root, p->symmetry, like);
    comb->combed[triangle] = 1;
    comb->queue[comb->end++] = triangle;
    comb->directions[triangle] = meso_frame_out(&p->frames[triangle], comb->in_frames[triangle]);
}

static void comb_part(Comb *comb, uint32_t first, MesoComplex like)
{
    const MesoTriangulation *mesh = comb->powers->mesh;
    add_triangle(comb, first, like);
    while (comb->begin < comb->end) {
        uint32_t t = comb->queue[comb->begin++];
        for (uint32_t h = 3 * t; h < 3 * t + 3; h++) {
            uint32_t across = meso_frame_across(mesh, h);
            if (across == MESO_NO_INDEX || comb->combed[across / 3])
                continue;
            MesoComplex turn = meso_frame_turn(mesh, comb->powers->frames, h, across);
            add_triangle(comb, across / 3, meso_complex_times(comb->in_frames[t], turn));
        }
    }
}

MesoStatus meso_field_comb(MesoVec3 *directions, MesoArena *scratch, const MesoFieldPowers *powers,
                           const MesoVec3 *guides, const float *weights, MesoError *error)
{
    uint32_t n = powers->mesh->triangle_count;
    Comb comb = {.powers = powers, .directions = directions, .in_frames = MESO_NEW(scratch, MesoComplex, n, error),
                 .combed = MESO_NEW(scratch, uint8_t, n, error), .queue = MESO_NEW(scratch, uint32_t, n, error)};
    if (!comb.in_frames || !comb.combed || !comb.queue)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; guides && weights && t < n; t++)
        if (!comb.combed[t] && weights[t] > 0)
            comb_part(&comb, t, meso_frame_in(&powers->frames[t], guides[t]));
    for (uint32_t t = 0; t < n; t++)
        if (!comb.combed[t])
            comb_part(&comb, t, (MesoComplex){1, 0});
    return MESO_OK;
}
