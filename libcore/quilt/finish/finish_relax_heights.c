/*
 * Heights of rings. Where patches meet, strands were bent up and down to be joined, and what is left of it goes on from
 * patch to patch. Within a patch a strand is to rise and fall as in the swatch; from one patch to another it goes on by
 * the mean of what both do there. With z the swatch's heights, the quilt's are z + e, of least
 *
 *     sum over rings e^2 + w sum over steps along strands (e_j - e_i - g_ij)^2
 *
 * where g_ij is what a step into another patch is to rise by, less the difference of z; within a patch it is 0. So e
 * fades out along a strand to both sides of a join, by sqrt(w) rings, and strands are as steep on one side as on the
 * other.
 */
#include "libcore/quilt/finish/finish_relax_work.h"

/* A join is felt so far along a strand, as a share of the swatch's shorter side; in rings within these bounds. */
#define FADE 0.03f
#define RINGS_LEAST 2.0f
#define RINGS_MOST 24.0f

/* Of conjugate gradients: steps at most, and the error that is small against the first. */
enum { STEPS = 80 };
#define SMALL 1e-3

/* Of conjugate gradients, scaled by the diagonal: [node_count] each. */
typedef struct Heights {
    double *e, *left, *way, *pull, *diagonal;
} Heights;

/* The next node along a strand, or MESO_NO_INDEX where that one does not say the same. */
static uint32_t next_of(const MesoRelaxing *r, uint32_t node, int way)
{
    uint32_t to = r->nodes[node].next[way];
    return to != MESO_NO_INDEX && (r->nodes[to].next[0] == node || r->nodes[to].next[1] == node) ? to : MESO_NO_INDEX;
}

static double weight_of(const MesoRelaxing *r, uint32_t a, uint32_t b)
{
    float step = 0.5f * (r->rings->steps[r->nodes[a].name] + r->rings->steps[r->nodes[b].name]);
    float rings = step > 0 ? FADE * r->side / (r->scale * step) : 0;
    rings = fminf(fmaxf(rings, RINGS_LEAST), RINGS_MOST);
    return (double)(rings * rings);
}

/* What the swatch rises by from a ring towards `to`, by the ring on its other side; false where that is unknown. */
static bool find_rise(double *rise, const MesoRelaxing *r, uint32_t node, uint32_t to)
{
    const MesoRelaxNode *from = &r->nodes[node];
    uint32_t behind = from->next[from->next[0] == to];
    const uint32_t *next = &r->rings->next[2 * (size_t)from->name];
    if (behind == MESO_NO_INDEX || r->nodes[behind].patch != from->patch)
        return false;
    uint32_t name = r->nodes[behind].name;
    if (next[0] != name && next[1] != name)
        return false;
    uint32_t ahead = next[next[0] == name];
    float here = r->rings->middles[from->name].z;
    float most = ahead != MESO_NO_INDEX ? r->rings->middles[ahead].z - here : here - r->rings->middles[name].z;
    *rise = (double)(r->height_scale * most);
    return true;
}

static double height_in_swatch(const MesoRelaxing *r, uint32_t node)
{
    return (double)(r->height_scale * r->nodes[node].origin.z);
}

/* g of a step. */
static double gap_of(const MesoRelaxing *r, uint32_t a, uint32_t b)
{
    const uint32_t *next = &r->rings->next[2 * (size_t)r->nodes[a].name];
    double up = 0, down = 0;
    if (r->nodes[a].patch == r->nodes[b].patch && (next[0] == r->nodes[b].name || next[1] == r->nodes[b].name))
        return 0;
    bool has_up = find_rise(&up, r, a, b), has_down = find_rise(&down, r, b, a);
    double rise = has_up && has_down ? 0.5 * (up - down) : up - down;
    return rise - (height_in_swatch(r, b) - height_in_swatch(r, a));
}

static void apply(double *pull, const double *p, const MesoRelaxing *r)
{
    for (uint32_t i = 0; i < r->node_count; i++) {
        pull[i] = p[i];
        for (int k = 0; k < 2; k++) {
            uint32_t to = next_of(r, i, k);
            if (to != MESO_NO_INDEX)
                pull[i] += weight_of(r, i, to) * (p[i] - p[to]);
        }
    }
}

static void set_up(Heights *h, const MesoRelaxing *r)
{
    for (uint32_t i = 0; i < r->node_count; i++) {
        h->diagonal[i] = 1;
        for (int k = 0; k < 2; k++) {
            uint32_t to = next_of(r, i, k);
            if (to == MESO_NO_INDEX)
                continue;
            double weight = weight_of(r, i, to);
            h->diagonal[i] += weight;
            h->left[i] -= weight * gap_of(r, i, to);
        }
    }
}

static double product(const double *a, const double *b, const double *scale, uint32_t count)
{
    double sum = 0;
    for (uint32_t i = 0; i < count; i++)
        sum += a[i] * (scale ? b[i] / scale[i] : b[i]);
    return sum;
}

static void solve(Heights *h, const MesoRelaxing *r)
{
    uint32_t n = r->node_count;
    double before = 0, first = 0;
    for (int step = 0; step < STEPS; step++) {
        double now = product(h->left, h->left, h->diagonal, n);
        first = step ? first : now;
        if (!(now > SMALL * SMALL * first))
            break;
        for (uint32_t i = 0; i < n; i++)
            h->way[i] = h->left[i] / h->diagonal[i] + (step ? now / before * h->way[i] : 0);
        apply(h->pull, h->way, r);
        double share = now / product(h->way, h->pull, NULL, n);
        for (uint32_t i = 0; i < n; i++) {
            h->e[i] += share * h->way[i];
            h->left[i] -= share * h->pull[i];
        }
        before = now;
    }
}

MesoStatus meso_relax_heights(MesoRelaxing *r, float offset, MesoError *error)
{
    uint32_t n = r->node_count;
    Heights h = {MESO_NEW(r->arena, double, n, error), MESO_NEW(r->arena, double, n, error),
                 MESO_NEW(r->arena, double, n, error), MESO_NEW(r->arena, double, n, error),
                 MESO_NEW(r->arena, double, n, error)};
    if (!h.e || !h.left || !h.way || !h.pull || !h.diagonal)
        return MESO_ERR_MEMORY;
    set_up(&h, r);
    solve(&h, r);
    for (uint32_t i = 0; i < n; i++) {
        float height = offset + (float)(height_in_swatch(r, i) + h.e[i]);
        r->nodes[i].rise = height - r->nodes[i].height;
        r->nodes[i].height = height;
    }
    return MESO_OK;
}
