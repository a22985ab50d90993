/* What triangles say together: normals, volumes, folded hexahedra, sizes. */
#include "libcore/base/disjoint_sets.h"
#include "libcore/check/inspect_work.h"

/* ---- normals ---- */

/* Twice the cosine's sign is enough: 1 agrees, -1 opposes, 0 says nothing. */
static int agreement(MesoVec3d area, MesoVec3 normal)
{
    double dot = meso_vec3d_dot(area, meso_vec3d(normal));
    return (dot > 0) - (dot < 0);
}

/* A triangle whose normals all oppose it is against them; one of which some do has wrong normals. */
static void judge_normals(MesoInspectWork *work, uint32_t t, bool *against)
{
    const MesoInspectedMesh *mesh = work->mesh;
    MesoVec3d area = meso_inspect_area(mesh, t);
    uint32_t opposed = 0, lost = 0, known = 0;
    for (uint32_t k = 0; k < 3; k++) {
        uint32_t number = meso_inspect_normal_at(mesh, 3 * t + k);
        if (number == MESO_NO_INDEX || !meso_vec3_finite(mesh->normals[number]))
            continue;
        known++;
        lost += meso_vec3_dot(mesh->normals[number], mesh->normals[number]) == 0;
        opposed += agreement(area, mesh->normals[number]) < 0;
    }
    *against = known > 0 && opposed == known;
    if (!*against && opposed + lost > 0) {
        meso_inspect_note(work, MESO_FAULT_NORMAL, t, 0);
        work->result->findings[MESO_FAULT_NORMAL].count += opposed + lost - 1;
    }
}

static bool normals_agree(const MesoInspectedMesh *mesh, uint32_t corner, uint32_t other)
{
    uint32_t i = meso_inspect_normal_at(mesh, corner), k = meso_inspect_normal_at(mesh, other);
    return i != MESO_NO_INDEX && k != MESO_NO_INDEX && meso_vec3_dot(mesh->normals[i], mesh->normals[k]) > 0;
}

/*
 * What an edge says of a triangle against its normals with one that is not beyond it: 1, the surface folds back there
 * while its normals go on; -1, normals turn where the surface goes on, or the two are wound against each other.
 */
static int32_t weigh_edge(const MesoInspectWork *work, uint32_t half, uint32_t mate)
{
    const MesoInspectedMesh *mesh = work->mesh;
    MesoVec3d a = meso_inspect_area(mesh, half / 3), b = meso_inspect_area(mesh, mate / 3);
    bool agree = normals_agree(mesh, half, meso_half_next(mate)) && normals_agree(mesh, meso_half_next(half), mate);
    if (work->places[half] == work->places[mate])
        return -1;
    return agree == (meso_vec3d_dot(a, b) > 0) ? 0 : agree ? 1 : -1;
}

/* Of triangles against their normals that hang together: how much their outline says so. */
static void weigh_outlines(const MesoInspectWork *work, const bool *against, uint32_t *sets, int32_t *folds)
{
    uint32_t half_count = 3 * work->mesh->triangle_count;
    meso_sets_init(sets, work->mesh->triangle_count);
    for (uint32_t h = 0; h < half_count; h++)
        if (against[h / 3] && work->mates[h] < MESO_MATE_OUT && against[work->mates[h] / 3])
            meso_sets_join(sets, h / 3, work->mates[h] / 3);
    for (uint32_t h = 0; h < half_count; h++)
        if (against[h / 3] && work->mates[h] < MESO_MATE_OUT && !against[work->mates[h] / 3])
            folds[meso_sets_root(sets, h / 3)] += weigh_edge(work, h, work->mates[h]);
}

MesoStatus meso_inspect_normals(MesoInspectWork *work, MesoError *error)
{
    const uint32_t none = 1u << MESO_FAULT_FLAT | 1u << MESO_FAULT_DOUBLE, count = work->mesh->triangle_count;
    if (!work->mesh->normals)
        return MESO_OK;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    bool *against = MESO_NEW(work->scratch, bool, count, error);
    uint32_t *sets = MESO_NEW(work->scratch, uint32_t, count, error);
    int32_t *folds = MESO_NEW(work->scratch, int32_t, count, error);
    if (!against || !sets || !folds)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < count; t++)
        if (!(work->result->marks[t] & none) && meso_inspect_is_finite(work->mesh, t))
            judge_normals(work, t, &against[t]);
    weigh_outlines(work, against, sets, folds);
    for (uint32_t t = 0; t < count; t++)
        if (against[t])
            meso_inspect_note(work, folds[meso_sets_root(sets, t)] > 0 ? MESO_FAULT_PINCH : MESO_FAULT_INVERTED, t, 0);
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

/* ---- sizes and volumes ---- */

static void measure_sides(MesoInspection *result, const MesoInspectedMesh *mesh, uint32_t t, double *sum)
{
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3 p = meso_inspect_corner(mesh, 3 * t + k);
        double length = meso_vec3d_length(meso_vec3d_sub(meso_vec3d(meso_inspect_corner(mesh, 3 * t + (k + 1) % 3)),
                                                         meso_vec3d(p)));
        meso_box_add(&result->box, p);
        result->shortest_edge = fmin(result->shortest_edge, length);
        result->longest_edge = fmax(result->longest_edge, length);
        *sum += length;
    }
}

/* Six times the volume between a triangle and `origin`. */
static double volume_under(const MesoInspectedMesh *mesh, uint32_t t, MesoVec3d origin)
{
    MesoVec3d p[3];
    for (uint32_t k = 0; k < 3; k++)
        p[k] = meso_vec3d_sub(meso_vec3d(meso_inspect_corner(mesh, 3 * t + k)), origin);
    return meso_vec3d_det(p[0], p[1], p[2]);
}

typedef struct Solid {
    double volume;          /* six times; from the first corner of the piece, which keeps it exact far out */
    uint32_t first;         /* triangle */
    bool open, met;         /* open: not all of its edges have two triangles that agree */
} Solid;

static bool is_sound_edge(const MesoInspectWork *work, uint32_t half)
{
    uint32_t mate = work->mates[half];
    return mate == MESO_MATE_OUT || (mate < MESO_MATE_OUT && work->places[half] != work->places[mate]);
}

static void add_to_solid(const MesoInspectWork *work, uint32_t t, Solid *solid)
{
    if (!solid->met)
        *solid = (Solid){.first = t, .met = true};
    solid->open |= !meso_inspect_is_finite(work->mesh, t);
    for (uint32_t k = 0; k < 3; k++)
        solid->open |= !is_sound_edge(work, 3 * t + k);
    if (work->mates[3 * t] != MESO_MATE_OUT)
        solid->volume += volume_under(work->mesh, t, meso_vec3d(meso_inspect_corner(work->mesh, 3 * solid->first)));
}

static void measure(MesoInspectWork *work, Solid *solids)
{
    MesoInspection *result = work->result;
    double sum = 0, twice_area = 0;
    uint64_t measured = 0;
    result->box = meso_box_empty();
    result->shortest_edge = INFINITY;
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++) {
        add_to_solid(work, t, &solids[work->pieces[t]]);
        if (!meso_inspect_is_finite(work->mesh, t))
            continue;
        measured++;
        twice_area += meso_vec3d_length(meso_inspect_area(work->mesh, t));
        measure_sides(result, work->mesh, t, &sum);
    }
    result->area = 0.5 * twice_area;
    result->mean_edge = measured ? sum / (3 * (double)measured) : 0;
    result->shortest_edge = measured ? result->shortest_edge : 0;
}

MesoStatus meso_inspect_solids(MesoInspectWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    Solid *solids = MESO_NEW(work->scratch, Solid, work->piece_count, error);
    if (!solids)
        return MESO_ERR_MEMORY;
    measure(work, solids);
    for (uint32_t p = 0; p < work->piece_count; p++) {
        work->result->volume += isfinite(solids[p].volume) ? solids[p].volume / 6 : 0;
        if (!solids[p].open && solids[p].volume < 0)
            meso_inspect_note(work, MESO_FAULT_INSIDE_OUT, solids[p].first, 0);
    }
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

/* ---- hexahedra ---- */

/* What the three sides from corner k span; positive where they turn as those of a cube do. */
static double corner_volume(const MesoVec3 *cage, uint32_t k)
{
    uint32_t floor = k & 4u, next = floor | ((k + 1) & 3u), last = floor | ((k + 3) & 3u);
    MesoVec3d at = meso_vec3d(cage[k]);
    MesoVec3d across = meso_vec3d_sub(meso_vec3d(cage[k ^ 4u]), at);
    MesoVec3d up = meso_vec3d_scale(across, floor ? -1 : 1);
    return meso_vec3d_det(meso_vec3d_sub(meso_vec3d(cage[next]), at), meso_vec3d_sub(meso_vec3d(cage[last]), at), up);
}

/* A surface whose normals oppose its winding has hexahedra that are mirrored as a whole: these are not folded. */
MesoStatus meso_inspect_folds(MesoInspectWork *work, MesoError *error)
{
    (void)error;
    MesoFinding *finding = &work->result->findings[MESO_FAULT_FOLD];
    for (uint32_t c = 0; c < work->mesh->cage_count; c++) {
        uint32_t right = 0, mirrored = 0;
        for (uint32_t k = 0; k < 8; k++) {
            double volume = corner_volume(&work->mesh->cages[8 * (size_t)c], k);
            right += volume > 0;
            mirrored += volume < 0;
        }
        if (right == 8 || mirrored == 8)
            continue;
        finding->cage = finding->count++ ? finding->cage : c;
    }
    return MESO_OK;
}
