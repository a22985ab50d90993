#include "libcore/quilt/check/check_seams.h"

enum { BINS = 4096 };

/* Of what is at seams, and of the rest, by weight. */
typedef struct Distribution {
    double weights[2][BINS];
} Distribution;

/* Edges, by the vertex of the swatch that they leave. */
typedef struct Places {
    const MesoCheckMesh *mesh;
    const uint8_t *at_seam, *has_seam;
    uint64_t (*counts)[2];      /* [places] at seams and elsewhere */
} Places;

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
static double distance(const Distribution *d)
{
    double below[2] = {0, 0}, totals[2] = {0, 0}, most = 0;
    for (int i = 0; i < BINS; i++)
        for (int k = 0; k < 2; k++)
            totals[k] += d->weights[k][i];
    if (!(totals[0] > 0 && totals[1] > 0))
        return 0;
    for (int i = 0; i < BINS; i++) {
        for (int k = 0; k < 2; k++)
            below[k] += d->weights[k][i] / totals[k];
        most = fmax(most, fabs(below[0] - below[1]));
    }
    return most;
}

/* ---- which edges count ---- */

static bool is_counted(const Places *p, uint32_t h)
{
    return p->mesh->twins[h] != MESO_NO_INDEX && p->has_seam[p->mesh->elements[h / 3]];
}

static uint32_t place_of(const Places *p, uint32_t h)
{
    return p->mesh->origins ? p->mesh->origins[p->mesh->corners[h]] : 0;
}

static MesoStatus count_places(Places *p, MesoArena *scratch, MesoError *error)
{
    uint32_t last = 0;
    for (uint32_t v = 0; v < p->mesh->vertex_count && p->mesh->origins; v++)
        last = p->mesh->origins[v] > last ? p->mesh->origins[v] : last;
    p->counts = meso_arena_alloc(scratch, (size_t)last + 1, sizeof *p->counts, error);
    if (!p->counts)
        return MESO_ERR_MEMORY;
    for (uint32_t h = 0; h < 3 * p->mesh->triangle_count; h++)
        if (is_counted(p, h))
            p->counts[place_of(p, h)][!p->at_seam[p->mesh->corners[h]]]++;
    return MESO_OK;
}

/* How much an edge counts among those of its place. */
static double weight_of(const Places *p, uint32_t h)
{
    const uint64_t *counts = p->counts[place_of(p, h)];
    if (!counts[0] || !counts[1])
        return 0;
    return p->at_seam[p->mesh->corners[h]] ? 1 : (double)counts[0] / (double)counts[1];
}

/* All edges, each by itself and by its place. */
typedef struct Tables {
    Distribution lengths, angles, placed_lengths, placed_angles;
} Tables;

static void fill(Tables *tables, MesoSeams *seams, const Places *p)
{
    const MesoCheckMesh *mesh = p->mesh;
    double unit = mean_length(mesh);
    for (uint32_t h = 0; h < 3 * mesh->triangle_count; h++) {
        if (!is_counted(p, h))
            continue;
        uint32_t other = !p->at_seam[mesh->corners[h]], length = length_bin(edge_length(mesh, h), unit);
        uint32_t angle = angle_bin(normal_of(mesh, h / 3), normal_of(mesh, mesh->twins[h] / 3));
        double weight = weight_of(p, h);
        tables->lengths.weights[other][length] += 1;
        tables->angles.weights[other][angle] += 1;
        tables->placed_lengths.weights[other][length] += weight;
        tables->placed_angles.weights[other][angle] += weight;
        *(other ? &seams->other_edge_count : &seams->seam_edge_count) += 1;
    }
}

MesoStatus meso_check_seams(MesoSeams *seams, MesoArena *scratch, const MesoCheckMesh *mesh, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    *seams = (MesoSeams){0};
    uint8_t *at_seam = MESO_NEW(scratch, uint8_t, mesh->vertex_count, error);
    uint8_t *has_seam = MESO_NEW(scratch, uint8_t, mesh->element_count, error);
    Tables *tables = MESO_NEW(scratch, Tables, 1, error);
    if (!at_seam || !has_seam || !tables)
        return MESO_ERR_MEMORY;
    mark_seams(at_seam, has_seam, mesh);
    Places places = {mesh, at_seam, has_seam, NULL};
    MesoStatus status = count_places(&places, scratch, error);
    if (!status) {
        fill(tables, seams, &places);
        seams->length_distance = distance(&tables->lengths);
        seams->angle_distance = distance(&tables->angles);
        seams->placed_length_distance = distance(&tables->placed_lengths);
        seams->placed_angle_distance = distance(&tables->placed_angles);
    }
    meso_arena_rewind(scratch, mark);
    return status;
}
