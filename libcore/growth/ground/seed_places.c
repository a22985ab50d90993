#include "libcore/growth/ground/seed_places.h"

MesoStatus meso_place_add(MesoSeedWork *work, const MesoSurfacePlace *at, uint64_t number)
{
    if (work->count >= (uint32_t)1 << 31)
        return meso_fail(work->error, MESO_ERR_LIMIT, "more than 2147483648 places for seeds");
    work->places = MESO_GROW(work->arena, work->places, work->count, work->room, 256, work->error);
    if (!work->places)
        return MESO_ERR_MEMORY;
    work->places[work->count++] = (MesoSeedPlace){*at, number};
    return MESO_OK;
}

typedef struct Asker {
    const MesoGrowthContexts *contexts;
    const MesoTip *tip;
} Asker;

static double look(void *context, MesoGrowthLook what, uint32_t map, double a, double b)
{
    const Asker *asker = context;
    return meso_growth_answer(asker->contexts, asker->tip, what, map, a, b);
}

double meso_place_value(const MesoSeedWork *work, uint32_t code, const MesoTip *tip, uint64_t key)
{
    double registers[MESO_GRAMMAR_REGISTERS], state[MESO_STATE_COUNT] = {0};
    Asker asker = {work->contexts, tip};
    const MesoGrowthHost host = {.context = &asker, .state = state, .look = look};
    MesoGrowthRun run = meso_growth_begin(code, key);
    meso_tip_position(work->contexts->ground->mesh, tip, &state[MESO_STATE_X]);
    return meso_growth_value(work->grammar, &run, code, registers, &host);
}

double meso_place_number(const MesoSeedWork *work, const MesoGrammarValue *value, const MesoSurfacePlace *at,
                         uint64_t number)
{
    if (value->index == MESO_NO_INDEX)
        return value->number;
    MesoTip tip = {at->triangle, false, {at->weight[0], at->weight[1], at->weight[2]}, {1, 0}};
    return meso_place_value(work, value->index, &tip, meso_growth_seed_key(work->job, work->seed->site, number));
}

MesoStatus meso_place_fault(const MesoSeedWork *work, const MesoGrammarValue *value, const char *what)
{
    uint32_t code = value->index == MESO_NO_INDEX ? work->seed->entry : value->index;
    return meso_fail(work->error, MESO_ERR_INPUT, "line %u: %s is no number at a place", work->grammar->lines[code],
                     what);
}

uint64_t meso_place_triangle(const MesoTriangulation *mesh, uint32_t triangle, uint32_t order[3])
{
    const uint32_t *c = &mesh->corners[3 * (size_t)triangle];
    uint64_t hash = 0;
    for (uint32_t k = 0; k < 3; k++)
        order[k] = k;
    for (uint32_t i = 1; i < 3; i++)
        for (uint32_t k = i; k > 0 && meso_place_compare(mesh->positions[c[order[k]]],
                                                         mesh->positions[c[order[k - 1]]]) < 0; k--) {
            uint32_t other = order[k];
            order[k] = order[k - 1];
            order[k - 1] = other;
        }
    for (uint32_t k = 0; k < 3; k++)
        hash = meso_draw_mix(hash + meso_place_hash(mesh->positions[c[order[k]]]));
    return hash;
}

double meso_place_area(const MesoTriangulation *mesh, uint32_t triangle)
{
    const uint32_t *c = &mesh->corners[3 * (size_t)triangle];
    MesoVec3 o = mesh->positions[c[0]], p = mesh->positions[c[1]], q = mesh->positions[c[2]];
    double a[3] = {(double)p.x - o.x, (double)p.y - o.y, (double)p.z - o.z};
    double b[3] = {(double)q.x - o.x, (double)q.y - o.y, (double)q.z - o.z};
    double x = a[1] * b[2] - a[2] * b[1], y = a[2] * b[0] - a[0] * b[2], z = a[0] * b[1] - a[1] * b[0];
    return 0.5 * sqrt(x * x + y * y + z * z);
}
