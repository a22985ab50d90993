#include "libcore/quilt/check/check_seams.h"

enum { BINS = 4096 };

/* Of what is at seams, and of the rest. */
typedef struct Distribution {
    uint64_t counts[2][BINS];
} Distribution;

/* Vertices between triangles of different patches, and elements that have such. */
static void mark_seams(uint8_t *at_seam, uint8_t *has_seam, const MesoCheckMesh *mesh)
{
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        uint32_t across = mesh->twins[h];
        if (across != MESO_NO_INDEX && mesh->patches[h / 3] != mesh->patches[across / 3])
            at_seam[mesh->corners[h]] = at_seam[mesh->corners[across]] = has_seam[mesh->elements[h / 3]] = 1;
    }
}

static MesoVec3 normal_of(const MesoCheckMesh *mesh, uint32_t triangle)
{
    const uint32_t *v = &mesh->corners[3 * (size_t)triangle];
    MesoVec3 a = mesh->positions[v[0]];
    return meso_vec3_direction(meso_vec3_cross(meso_vec3_sub(mesh->positions[v[1]], a),
                                               meso_vec3_sub(mesh->positions[v[2]], a)), (MesoVec3){0, 0, 0});
}

static uint32_t bin_of(double share)
{
    return share <= 0 ? 0 : share >= 1 ? BINS - 1 : (uint32_t)(share * BINS);
}

/* From 2^-12 to 2^12 of the unit. */
static uint32_t length_bin(double length, double unit)
{
    return length > 0 && unit > 0 ? bin_of((log2(length / unit) + 12) / 24) : 0;
}

static uint32_t angle_bin(MesoVec3 a, MesoVec3 b)
{
    double sine = (double)meso_vec3_length(meso_vec3_cross(a, b)), cosine = (double)meso_vec3_dot(a, b);
    return bin_of(atan2(sine, cosine) / MESO_PI);
}

static double edge_length(const MesoCheckMesh *mesh, uint32_t h)
{
    return (double)meso_vec3_length(meso_vec3_sub(mesh->positions[mesh->corners[meso_next_corner(h)]],
                                                  mesh->positions[mesh->corners[h]]));
}

static double mean_length(const MesoCheckMesh *mesh)
{
    double sum = 0;
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++)
        sum += edge_length(mesh, h);
    return mesh->triangle_count ? sum / (3.0 * mesh->triangle_count) : 0;
}

/* The largest difference between the shares that lie below a value. */
static double distance(const Distribution *d, uint64_t *totals)
{
    double below[2] = {0, 0}, most = 0;
    totals[0] = totals[1] = 0;
    for (int i = 0; i < BINS; i++)
        for (int k = 0; k < 2; k++)
            totals[k] += d->counts[k][i];
    if (totals[0] == 0 || totals[1] == 0)
        return 0;
    for (int i = 0; i < BINS; i++) {
        for (int k = 0; k < 2; k++)
            below[k] += (double)d->counts[k][i] / (double)totals[k];
        most = fmax(most, fabs(below[0] - below[1]));
    }
    return most;
}

MesoStatus meso_check_seams(MesoSeams *seams, MesoArena *scratch, const MesoCheckMesh *mesh, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    *seams = (MesoSeams){0};
    uint8_t *at_seam = MESO_NEW(scratch, uint8_t, mesh->vertex_count, error);
    uint8_t *has_seam = MESO_NEW(scratch, uint8_t, mesh->element_count, error);
    Distribution *lengths = MESO_NEW(scratch, Distribution, 1, error);
    Distribution *angles = MESO_NEW(scratch, Distribution, 1, error);
    if (!at_seam || !has_seam || !lengths || !angles)
        return MESO_ERR_MEMORY;
    mark_seams(at_seam, has_seam, mesh);
    double unit = mean_length(mesh);
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        uint32_t across = mesh->twins[h];
        if (across == MESO_NO_INDEX || !has_seam[mesh->elements[h / 3]])
            continue;
        uint32_t other = !at_seam[mesh->corners[h]];
        lengths->counts[other][length_bin(edge_length(mesh, h), unit)]++;
        angles->counts[other][angle_bin(normal_of(mesh, h / 3), normal_of(mesh, across / 3))]++;
    }
    uint64_t totals[2];
    seams->angle_distance = distance(angles, totals);
    seams->length_distance = distance(lengths, totals);
    seams->seam_edge_count = totals[0];
    seams->other_edge_count = totals[1];
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}
