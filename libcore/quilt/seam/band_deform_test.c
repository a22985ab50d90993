/* Bands against equations 5 and 6 in full, and what must hold of them. */
#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/quilt/seam/band_deform.h"

enum { AROUND = 6, ALONG = 9, MOST = AROUND * ALONG, TRIANGLES = 2 * AROUND * ALONG, PULLS = 12 };

typedef struct Mesh {
    uint32_t vertex_count, triangle_count, pull_count;
    uint32_t corners[3 * TRIANGLES];
    MesoVec3 positions[MOST];
    MesoBandPull pulls[PULLS];
} Mesh;

static float uniform(MesoRandom *random)
{
    return (float)meso_random_below(random, 1u << 24) / (1u << 23) - 1;
}

/* A crooked tube with open ends, or a strip where it is not closed; with holes, so that it may fall apart. */
static void make_tube(Mesh *mesh, MesoRandom *random, bool closed, uint32_t holes)
{
    *mesh = (Mesh){.vertex_count = MOST};
    for (uint32_t v = 0; v < MOST; v++) {
        float angle = 6.2831853f * (float)(v % AROUND) / AROUND;
        mesh->positions[v] = (MesoVec3){cosf(angle) + 0.2f * uniform(random), sinf(angle) + 0.2f * uniform(random),
                                        (float)(v / AROUND) + 0.2f * uniform(random)};
    }
    for (uint32_t v = 0; v < MOST - AROUND; v++) {
        uint32_t next = v % AROUND + 1 < AROUND ? v + 1 : v + 1 - AROUND;
        uint32_t two[6] = {v, next, v + AROUND, next, next + AROUND, v + AROUND};
        if ((next < v && !closed) || meso_random_below(random, 100) < holes)
            continue;
        memcpy(mesh->corners + 3 * mesh->triangle_count, two, sizeof two);
        mesh->triangle_count += 2;
    }
}

/* Vertices and points of triangles, their targets not far. */
static void add_pulls(Mesh *mesh, MesoRandom *random, uint32_t count)
{
    mesh->pull_count = count;
    for (uint32_t p = 0; p < count; p++) {
        MesoBandPull *pull = &mesh->pulls[p];
        uint32_t t = meso_random_below(random, mesh->triangle_count);
        float a = 0.5f + 0.4f * uniform(random), b = (1 - a) * (0.5f + 0.4f * uniform(random));
        *pull = (MesoBandPull){{0, UINT32_MAX, UINT32_MAX}, {1, 0, 0}, {0, 0, 0}};
        memcpy(pull->v, mesh->corners + 3 * t, (p % 2 ? 3 : 1) * sizeof *pull->v);
        if (p % 2) {
            float weights[3] = {a, b, 1 - a - b};
            memcpy(pull->weight, weights, sizeof weights);
        }
        pull->target = (MesoVec3){0.3f * uniform(random), 0.3f * uniform(random), 0.3f * uniform(random)};
        for (int k = 0; k < 3; k++)
            if (pull->weight[k] != 0)
                pull->target = meso_vec3_mad(pull->target, pull->weight[k], mesh->positions[pull->v[k]]);
    }
}

/* ---- the other route ---- */

typedef struct Dense {
    bool joined[MOST][MOST];
    bool moves[MOST];
    uint32_t place[MOST], free_count;
    double rows[MOST + PULLS][MOST], right[MOST + PULLS][3];    /* rows w = right, for all of the vertices */
    double a[MOST][MOST + 3];
} Dense;

static void find_moving(Dense *dense, const Mesh *mesh, uint32_t rings)
{
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        for (int k = 0; k < 9; k++) {
            uint32_t v = mesh->corners[3 * t + (uint32_t)k / 3], w = mesh->corners[3 * t + (uint32_t)k % 3];
            dense->joined[v][w] = v != w;
        }
    for (uint32_t p = 0; p < mesh->pull_count; p++)
        for (int k = 0; k < 3; k++)
            if (mesh->pulls[p].weight[k] != 0)
                dense->moves[mesh->pulls[p].v[k]] = true;
    for (uint32_t ring = 0; ring < rings; ring++) {
        bool before[MOST];
        memcpy(before, dense->moves, sizeof before);
        for (uint32_t v = 0; v < MOST; v++)
            for (uint32_t w = 0; w < MOST; w++)
                dense->moves[w] |= before[v] && dense->joined[v][w];
    }
    for (uint32_t v = 0; v < MOST; v++)
        dense->place[v] = dense->moves[v] ? dense->free_count++ : MESO_NO_INDEX;
}

static void fill_rows(Dense *dense, const Mesh *mesh, double mu)
{
    for (uint32_t v = 0; v < MOST; v++) {
        int degree = 0;
        for (uint32_t w = 0; w < MOST; w++)
            degree += dense->joined[v][w];
        for (uint32_t w = 0; w < MOST && degree; w++)
            dense->rows[v][w] = v == w ? 1 : dense->joined[v][w] ? -1.0 / degree : 0;
        for (uint32_t w = 0; w < MOST; w++) {
            dense->right[v][0] += dense->rows[v][w] * mesh->positions[w].x;
            dense->right[v][1] += dense->rows[v][w] * mesh->positions[w].y;
            dense->right[v][2] += dense->rows[v][w] * mesh->positions[w].z;
        }
    }
    for (uint32_t p = 0; p < mesh->pull_count; p++) {
        const MesoBandPull *pull = &mesh->pulls[p];
        for (int k = 0; k < 3; k++)
            if (pull->weight[k] != 0)
                dense->rows[MOST + p][pull->v[k]] += sqrt(mu) * pull->weight[k];
        dense->right[MOST + p][0] = sqrt(mu) * pull->target.x;
        dense->right[MOST + p][1] = sqrt(mu) * pull->target.y;
        dense->right[MOST + p][2] = sqrt(mu) * pull->target.z;
    }
}

/* Normal equations of the rows, with what does not move on the right; then Gauss with the largest pivots. */
static void solve_rows(Dense *dense, const Mesh *mesh, MesoVec3 *out)
{
    uint32_t n = dense->free_count;
    for (uint32_t r = 0; r < MOST + mesh->pull_count; r++) {
        double right[3] = {dense->right[r][0], dense->right[r][1], dense->right[r][2]};
        for (uint32_t v = 0; v < MOST; v++)
            if (!dense->moves[v]) {
                right[0] -= dense->rows[r][v] * mesh->positions[v].x;
                right[1] -= dense->rows[r][v] * mesh->positions[v].y;
                right[2] -= dense->rows[r][v] * mesh->positions[v].z;
            }
        for (uint32_t v = 0; v < MOST; v++) {
            if (!dense->moves[v])
                continue;
            for (uint32_t w = 0; w < MOST; w++)
                if (dense->moves[w])
                    dense->a[dense->place[v]][dense->place[w]] += dense->rows[r][v] * dense->rows[r][w];
            for (uint32_t c = 0; c < 3; c++)
                dense->a[dense->place[v]][n + c] += dense->rows[r][v] * right[c];
        }
    }
    for (uint32_t k = 0; k < n; k++) {
        uint32_t best = k;
        for (uint32_t i = k; i < n; i++)
            best = fabs(dense->a[i][k]) > fabs(dense->a[best][k]) ? i : best;
        for (uint32_t j = 0; j < n + 3; j++) {
            double t = dense->a[k][j];
            dense->a[k][j] = dense->a[best][j];
            dense->a[best][j] = t;
        }
        for (uint32_t i = 0; i < n; i++) {
            double f = i == k ? 0 : dense->a[i][k] / dense->a[k][k];
            for (uint32_t j = k; j < n + 3; j++)
                dense->a[i][j] -= f * dense->a[k][j];
        }
    }
    memcpy(out, mesh->positions, sizeof mesh->positions);
    for (uint32_t v = 0; v < MOST; v++)
        if (dense->moves[v]) {
            const double *row = dense->a[dense->place[v]], pivot = row[dense->place[v]];
            out[v] = (MesoVec3){(float)(row[n] / pivot), (float)(row[n + 1] / pivot), (float)(row[n + 2] / pivot)};
        }
}

static void test_dense(void)
{
    static const double strengths[] = {1, 0.01, 100, 3};
    static Mesh mesh, moved, again;
    static Dense dense;
    MesoRandom random;
    MesoArena arena;
    meso_random_init(&random, 1, 0);
    meso_arena_init(&arena);
    for (uint32_t round = 0; round < 200; round++) {
        MesoVec3 expected[MOST];
        double rms, largest, rms_again, mu = strengths[round % 4], sum = 0, most = 0;
        uint32_t rings = meso_random_below(&random, 7);
        make_tube(&mesh, &random, round % 3 != 0, round % 5 == 0 ? 30 : 0);
        add_pulls(&mesh, &random, 1 + meso_random_below(&random, PULLS));
        moved = again = mesh;
        size_t used = arena.used;
        CHECK(!meso_band_deform(moved.positions, &arena, MOST, mesh.corners, mesh.triangle_count, mesh.pulls,
                                mesh.pull_count, rings, mu, &rms, &largest, NULL));
        CHECK(arena.used == used);
        CHECK(!meso_band_deform(again.positions, &arena, MOST, mesh.corners, mesh.triangle_count, mesh.pulls,
                                mesh.pull_count, rings, mu, &rms_again, NULL, NULL));
        CHECK(!memcmp(moved.positions, again.positions, sizeof moved.positions) && rms == rms_again);

        dense = (Dense){0};
        find_moving(&dense, &mesh, rings);
        fill_rows(&dense, &mesh, mu);
        solve_rows(&dense, &mesh, expected);
        for (uint32_t v = 0; v < MOST; v++)
            if (dense.moves[v])
                CHECK(meso_vec3_length(meso_vec3_sub(moved.positions[v], expected[v])) < 1e-5f);
            else
                CHECK(!memcmp(&moved.positions[v], &mesh.positions[v], sizeof(MesoVec3)));
        for (uint32_t p = 0; p < mesh.pull_count; p++) {
            MesoVec3 gap = mesh.pulls[p].target;
            for (int k = 0; k < 3; k++)
                if (mesh.pulls[p].weight[k] != 0)
                    gap = meso_vec3_mad(gap, -mesh.pulls[p].weight[k], expected[mesh.pulls[p].v[k]]);
            double length = meso_vec3_length(gap);
            sum += length * length;
            most = fmax(most, length);
        }
        CHECK(fabs(rms - sqrt(sum / mesh.pull_count)) < 1e-5 && fabs(largest - most) < 1e-5);
    }
    meso_arena_release(&arena);
}

/* One pull a triangle, of its middle: they agree, and without bounds they are met. Two rings, one at each end. */
static void test_met(void)
{
    static const double strengths[] = {1e7, 1e30, (double)INFINITY};
    static Mesh mesh;
    MesoRandom random;
    MesoArena arena;
    meso_random_init(&random, 2, 0);
    meso_arena_init(&arena);
    for (uint32_t round = 0; round < 60; round++) {
        double rms, largest;
        make_tube(&mesh, &random, true, 0);
        add_pulls(&mesh, &random, PULLS);
        for (uint32_t p = 0; p < PULLS; p++) {
            uint32_t t = (p < AROUND ? 0 : mesh.triangle_count - 2 * AROUND) + 2 * (p % AROUND);
            MesoVec3 target = {0.3f, 0.2f * (float)p, p < AROUND ? -0.3f : 0.3f};
            MesoBandPull *pull = &mesh.pulls[p];
            *pull = (MesoBandPull){{mesh.corners[3 * t], mesh.corners[3 * t + 1], mesh.corners[3 * t + 2]},
                                   {0.5f, 0.25f, 0.25f}, {0, 0, 0}};
            for (int k = 0; k < 3; k++)
                target = meso_vec3_mad(target, pull->weight[k], mesh.positions[pull->v[k]]);
            pull->target = target;
        }
        CHECK(!meso_band_deform(mesh.positions, &arena, MOST, mesh.corners, mesh.triangle_count, mesh.pulls, PULLS,
                                round / 3 % 5, strengths[round % 3], &rms, &largest, NULL));
        CHECK(largest < 1e-5 && rms <= largest);
    }
    meso_arena_release(&arena);
}

/* Pulls by one and the same way move all that is free as one piece, where nothing is fixed; without strength, nothing. */
static void test_shift(void)
{
    static Mesh mesh, before;
    MesoVec3 way = {0.5f, -0.25f, 0.125f};
    MesoRandom random;
    MesoArena arena;
    double rms, largest;
    meso_random_init(&random, 3, 0);
    meso_arena_init(&arena);
    make_tube(&mesh, &random, true, 0);
    mesh.pulls[0] = (MesoBandPull){{20, 0, 0}, {1, 0, 0}, meso_vec3_add(mesh.positions[20], way)};
    before = mesh;
    CHECK(!meso_band_deform(mesh.positions, &arena, MOST, mesh.corners, mesh.triangle_count, mesh.pulls, 1, 100, 0, &rms,
                            &largest, NULL));
    CHECK(!memcmp(&mesh, &before, sizeof mesh) && fabs(largest - meso_vec3_length(way)) < 1e-6);
    CHECK(!meso_band_deform(mesh.positions, &arena, MOST, mesh.corners, mesh.triangle_count, mesh.pulls, 1, 100, 1, &rms,
                            &largest, NULL));
    for (uint32_t v = 0; v < MOST; v++)
        CHECK(meso_vec3_length(meso_vec3_sub(mesh.positions[v], meso_vec3_add(before.positions[v], way))) < 1e-5f);
    CHECK(largest < 1e-5);
    CHECK(!meso_band_deform(mesh.positions, &arena, MOST, mesh.corners, mesh.triangle_count, NULL, 0, 3, 1, &rms,
                            &largest, NULL));
    CHECK(rms == 0 && largest == 0);
    meso_arena_release(&arena);
}

/* Vertices without triangles, a vertex that is named twice, and pulls against each other. */
static void test_lone(void)
{
    static const double strengths[] = {1e-3, 1, (double)INFINITY};
    MesoArena arena;
    double rms, largest;
    meso_arena_init(&arena);
    for (int k = 0; k < 3; k++) {
        MesoVec3 positions[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 7}};
        MesoBandPull pulls[3] = {{{0, 1, 2}, {0.25f, 0.25f, 0.5f}, {1, 1, 1}},
                                 {{3, 3, 0}, {0.5f, 0.5f, 0}, {2, 0, 7}}, {{3, 0, 0}, {1, 0, 0}, {0, 2, 7}}};
        CHECK(!meso_band_deform(positions, &arena, 4, NULL, 0, pulls, 3, 2, strengths[k], &rms, &largest, NULL));
        CHECK(meso_vec3_length(meso_vec3_sub(positions[3], (MesoVec3){1, 1, 7})) < 1e-5f);
        CHECK(fabs(0.25 * positions[0].z + 0.25 * positions[1].z + 0.5 * positions[2].z - 1) < 1e-5);
        CHECK(fabs(largest - sqrt(2)) < 1e-5);
    }
    meso_arena_release(&arena);
}

static void test_refused(void)
{
    MesoVec3 positions[3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, before[3];
    uint32_t corners[3] = {0, 1, 2}, wrong[3] = {0, 1, 3};
    MesoBandPull pull = {{0, 9, 9}, {1, 0, 0}, {1, 1, 1}}, changed;
    MesoArena arena;
    meso_arena_init(&arena);
    memcpy(before, positions, sizeof before);
    CHECK(meso_band_deform(positions, &arena, 3, wrong, 1, &pull, 1, 1, 1, NULL, NULL, NULL) == MESO_ERR_INTERNAL);
    CHECK(meso_band_deform(positions, &arena, 3, corners, 1, &pull, 1, 1, -1, NULL, NULL, NULL) == MESO_ERR_INPUT);
    changed = pull;
    changed.v[0] = 3;
    CHECK(meso_band_deform(positions, &arena, 3, corners, 1, &changed, 1, 1, 1, NULL, NULL, NULL) == MESO_ERR_INTERNAL);
    changed = pull;
    changed.weight[0] = NAN;
    CHECK(meso_band_deform(positions, &arena, 3, corners, 1, &changed, 1, 1, 1, NULL, NULL, NULL) == MESO_ERR_INPUT);
    changed = pull;
    changed.weight[0] = 0;
    CHECK(meso_band_deform(positions, &arena, 3, corners, 1, &changed, 1, 1, 1, NULL, NULL, NULL) == MESO_ERR_INPUT);
    changed = pull;
    changed.target.y = INFINITY;
    CHECK(meso_band_deform(positions, &arena, 3, corners, 1, &changed, 1, 1, 1, NULL, NULL, NULL) == MESO_ERR_INPUT);
    CHECK(!memcmp(before, positions, sizeof before));
    positions[2].z = NAN;
    CHECK(meso_band_deform(positions, &arena, 3, corners, 1, &pull, 1, 1, 1, NULL, NULL, NULL) == MESO_ERR_INPUT);
    meso_arena_release(&arena);
}

int main(void)
{
    test_dense();
    test_met();
    test_shift();
    test_lone();
    test_refused();
    return 0;
}
