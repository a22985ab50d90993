#include "libcore/quilt/match/match_field.h"

#include <string.h>

#include "libcore/base/parallel.h"
#include "libcore/math/box.h"
#include "libcore/math/lanes.h"
#include "libcore/quilt/match/nearest_faces.h"
#include "libcore/quilt/match/triangle_distance.h"

/* ---- one face ---- */

static MesoVec3 face_normal(const MesoSwatch *swatch, uint32_t face)
{
    const uint32_t *corners = &swatch->corners[3 * (size_t)face];
    MesoVec3 a = swatch->positions[corners[0]];
    MesoVec3 across = meso_vec3_cross(meso_vec3_sub(swatch->positions[corners[1]], a),
                                      meso_vec3_sub(swatch->positions[corners[2]], a));
    return meso_vec3_direction(across, (MesoVec3){0, 0, 0});
}

float meso_match_exact(const MesoSwatch *swatch, float lambda, MesoMatchPoint point, uint32_t *face)
{
    float best = INFINITY;
    uint32_t which = MESO_NO_INDEX;
    for (uint32_t f = 0; f < swatch->triangle_count; f++) {
        const uint32_t *corners = &swatch->corners[3 * (size_t)f];
        const MesoVec3 *p = swatch->positions;
        float turn = 1 + meso_vec3_length(meso_vec3_sub(point.normal, face_normal(swatch, f)));
        if (turn >= best)
            continue;
        float square = meso_triangle_square(point.position, p[corners[0]], p[corners[1]], p[corners[2]]);
        float cost = (1 + lambda * sqrtf(square)) * turn;
        if (cost < best) {
            best = cost;
            which = f;
        }
    }
    if (face)
        *face = which;
    return best;
}

/* ---- building ---- */

typedef struct Builder {
    MesoMatchField *field;
    MesoVoxelGrid grid;
    uint32_t begins[MESO_MATCH_BINS + 1];
    uint32_t *list;         /* [triangle_count] faces by bin */
    bool known[MESO_MATCH_BINS];    /* bins that have faces; the nearest are kept where the field's faces come to be */
    float turns[MESO_MATCH_BINS][MESO_MATCH_BINS];  /* the least of 1 + |n - n(f)| over a bin's faces, by bin and n */
    uint32_t worker_count;
    float *squares;         /* [worker_count * voxels] */
    uint32_t *nearest;      /* [worker_count * voxels] */
    char *scratch;
    size_t scratch_size;    /* of each worker */
} Builder;

/* Voxels around the tile and the swatch's box, one more above and below, on the lattice through the origin. */
static MesoStatus place_voxels(MesoMatchField *field, const MesoSwatch *swatch, MesoError *error)
{
    MesoBox box = meso_box_of(swatch->positions, swatch->vertex_count);
    meso_box_add(&box, (MesoVec3){0, 0, box.low.z - field->voxel});
    meso_box_add(&box, (MesoVec3){swatch->size.x, swatch->size.y, box.high.z + field->voxel});
    const float low[3] = {box.low.x, box.low.y, box.low.z}, high[3] = {box.high.x, box.high.y, box.high.z};
    double total = 1;
    float first[3];
    for (int k = 0; k < 3; k++) {
        double from = floor((double)low[k] / field->voxel + 1e-3), to = ceil((double)high[k] / field->voxel - 1e-3);
        double count = to > from ? to - from : 1;
        total *= count;
        if (!(total <= 1 << 24))
            return meso_fail(error, MESO_ERR_LIMIT, "voxels of %g are too small for a swatch of %g x %g x %g",
                             (double)field->voxel, (double)high[0] - low[0], (double)high[1] - low[1],
                             (double)high[2] - low[2]);
        field->count[k] = (uint32_t)count;
        first[k] = (float)(from * field->voxel);
    }
    field->low = (MesoVec3){first[0], first[1], first[2]};
    return MESO_OK;
}

static MesoStatus allocate(Builder *builder, MesoArena *arena, MesoError *error)
{
    MesoMatchField *field = builder->field;
    builder->scratch_size = meso_nearest_faces_scratch(&builder->grid);
    builder->list = MESO_NEW(arena, uint32_t, field->swatch->triangle_count, error);
    size_t voxels = meso_voxel_count(&builder->grid);
    builder->squares = MESO_NEW(arena, float, builder->worker_count * voxels, error);
    builder->nearest = MESO_NEW(arena, uint32_t, builder->worker_count * voxels, error);
    builder->scratch = meso_arena_alloc(arena, builder->worker_count, builder->scratch_size, error);
    return builder->list && builder->squares && builder->nearest && builder->scratch ? MESO_OK : MESO_ERR_MEMORY;
}

static void sort_faces(Builder *builder)
{
    const MesoMatchField *field = builder->field;
    uint32_t fill[MESO_MATCH_BINS] = {0};
    for (uint32_t f = 0; f < field->swatch->triangle_count; f++)
        fill[meso_match_nearest_bin(field->face_normals[f])]++;
    for (uint32_t bin = 0; bin < MESO_MATCH_BINS; bin++) {
        builder->begins[bin + 1] = builder->begins[bin] + fill[bin];
        fill[bin] = builder->begins[bin];
    }
    for (uint32_t f = 0; f < field->swatch->triangle_count; f++)
        builder->list[fill[meso_match_nearest_bin(field->face_normals[f])]++] = f;
}

static void put_face(const MesoMatchField *field, size_t at, uint32_t face)
{
    if (field->faces)
        field->faces[at] = (uint16_t)face;
    else
        field->many_faces[at] = face;
}

static inline __attribute__((always_inline)) float turn_between(MesoVec3 n, float x, float y, float z)
{
    float dx = n.x - x, dy = n.y - y, dz = n.z - z;
    return 1 + sqrtf(dx * dx + dy * dy + dz * dz);
}

/* To `turns`, of one bin: by directions. */
static void measure_turns(float *turns, const MesoMatchField *field, const uint32_t *list, uint32_t count)
{
    for (uint32_t direction = 0; direction < MESO_MATCH_BINS; direction++) {
        MesoVec3 n = meso_match_direction(direction);
        turns[direction] = INFINITY;
        for (uint32_t i = 0; i < count; i++) {
            MesoVec3 own = field->face_normals[list[i]];
            float turn = turn_between(n, own.x, own.y, own.z);
            turns[direction] = turn < turns[direction] ? turn : turns[direction];
        }
    }
}

static void measure_bins(void *context, uint32_t worker, uint64_t begin, uint64_t end)
{
    Builder *builder = context;
    const MesoSwatch *swatch = builder->field->swatch;
    size_t voxels = meso_voxel_count(&builder->grid);
    uint32_t *nearest = builder->nearest + worker * voxels;
    for (size_t bin = (size_t)begin; bin < end; bin++) {
        uint32_t first = builder->begins[bin];
        meso_nearest_faces(nearest, builder->squares + worker * voxels, &builder->grid, swatch->positions,
                           swatch->corners, builder->list + first, builder->begins[bin + 1] - first,
                           builder->scratch + worker * builder->scratch_size);
        measure_turns(builder->turns[bin], builder->field, builder->list + first, builder->begins[bin + 1] - first);
        builder->known[bin] = nearest[0] != MESO_NO_INDEX;
        for (size_t v = 0; v < voxels && builder->known[bin]; v++)
            put_face(builder->field, bin * voxels + v, nearest[v]);
    }
}

/* So many voxels of a row at once: what is known of them stays near. They are filled up to whole lanes by the last. */
enum { CHUNK = MESO_TRIANGLE_ROW, LANES = MESO_LANES };

/* The nearest faces of one bin along a row. */
typedef struct Stretch {
    float factors[CHUNK], x[CHUNK], y[CHUNK], z[CHUNK];     /* 1 + lambda distance; normals */
    uint32_t faces[CHUNK];
    uint32_t bin;
    float least;                                            /* of the factors */
} Stretch;

/* What is best for one direction so far. */
typedef struct Best {
    float costs[CHUNK];
    uint32_t faces[CHUNK];
} Best;

static uint32_t whole_lanes(uint32_t count)
{
    return (count + LANES - 1) / LANES * LANES;
}

/* The corners of a face, and the centre of a voxel. */
static inline __attribute__((always_inline)) void put_in_row(MesoTriangleRow *row, uint32_t i,
                                                             const MesoSwatch *swatch, uint32_t face,
                                                             MesoVec3 centre)
{
    const uint32_t *corners = &swatch->corners[3 * (size_t)face];
    MesoVec3 a = swatch->positions[corners[0]], b = swatch->positions[corners[1]], c = swatch->positions[corners[2]];
    row->p[0][i] = centre.x, row->p[1][i] = centre.y, row->p[2][i] = centre.z;
    row->a[0][i] = a.x, row->a[1][i] = a.y, row->a[2][i] = a.z;
    row->b[0][i] = b.x, row->b[1][i] = b.y, row->b[2][i] = b.z;
    row->c[0][i] = c.x, row->c[1][i] = c.y, row->c[2][i] = c.z;
}

/* `at`: the first voxel, (x, y, z), in the table of the bin. What fills it up is the last one. */
static inline __attribute__((always_inline)) void load_stretch(Stretch *stretch, const Builder *builder, size_t at,
                                                               const uint32_t place[3], uint32_t count)
{
    const MesoMatchField *field = builder->field;
    MesoTriangleRow row;
    for (uint32_t i = 0; i < CHUNK; i++) {
        uint32_t from = i < count ? i : count - 1, face = meso_match_face(field, at + from);
        MesoVec3 n = field->face_normals[face];
        put_in_row(&row, i, field->swatch, face,
                   meso_voxel_centre(&builder->grid, place[0] + from, place[1], place[2]));
        stretch->x[i] = n.x;
        stretch->y[i] = n.y;
        stretch->z[i] = n.z;
        stretch->faces[i] = face;
    }
    meso_triangle_squares(stretch->factors, &row);
    stretch->least = INFINITY;
    for (uint32_t i = 0; i < CHUNK; i++) {
        stretch->factors[i] = 1 + field->lambda * sqrtf(stretch->factors[i]);
        stretch->least = stretch->factors[i] < stretch->least ? stretch->factors[i] : stretch->least;
    }
}

/* Where the faces are better with a normal in direction `n` than what is there, they take its place. By masks: branches
 * keep the compiler from doing four at once. */
static inline __attribute__((always_inline)) void keep_better(Best *restrict best,
                                                              const Stretch *restrict stretch, MesoVec3 n,
                                                              uint32_t count)
{
    for (uint32_t i = 0; i < whole_lanes(count); i++) {
        float cost = stretch->factors[i] * turn_between(n, stretch->x[i], stretch->y[i], stretch->z[i]);
        float kept = best->costs[i];
        uint32_t mask = cost < kept ? UINT32_MAX : 0;
        best->costs[i] = cost < kept ? cost : kept;
        best->faces[i] ^= (best->faces[i] ^ stretch->faces[i]) & mask;
    }
}

static inline __attribute__((always_inline)) float largest_cost(const Best *best, uint32_t count)
{
    MesoLanes most = meso_lanes_all(0), costs;
    for (uint32_t i = 0; i < count; i += LANES) {
        memcpy(&costs, &best->costs[i], sizeof costs);
        most = meso_lanes_most(costs, most);
    }
    float largest = 0;
    for (uint32_t k = 0; k < LANES; k++)
        largest = most[k] > largest ? most[k] : largest;
    return largest;
}

/* All that is known of a stretch is loaded before what is best takes its place. */
static inline __attribute__((always_inline)) void combine_stretch(const Builder *builder, const uint32_t place[3],
                                                                  uint32_t count)
{
    const MesoMatchField *field = builder->field;
    size_t voxels = meso_voxel_count(&builder->grid);
    size_t at = ((size_t)place[2] * field->count[1] + place[1]) * field->count[0] + place[0];
    Stretch stretches[MESO_MATCH_BINS];
    uint32_t known_count = 0;
    for (uint32_t bin = 0; bin < MESO_MATCH_BINS; bin++)
        if (builder->known[bin]) {
            stretches[known_count].bin = bin;
            load_stretch(&stretches[known_count++], builder, bin * voxels + at, place, count);
        }
    for (uint32_t bin = 0; bin < MESO_MATCH_BINS; bin++) {
        MesoVec3 direction = meso_match_direction(bin);
        float largest = INFINITY;
        Best best;
        for (uint32_t i = 0; i < CHUNK; i++) {
            best.costs[i] = INFINITY;
            best.faces[i] = MESO_NO_INDEX;
        }
        for (uint32_t k = 0; k < known_count; k++) {
            const Stretch *stretch = &stretches[(k + bin) % known_count];
            if (stretch->least * builder->turns[stretch->bin][bin] >= largest)
                continue;   /* rounded products grow with what is multiplied: none of them is less */
            keep_better(&best, stretch, direction, count);
            largest = largest_cost(&best, count);
        }
        for (uint32_t i = 0; i < count; i++) {
            field->costs[bin * voxels + at + i] = meso_match_excess_code(best.costs[i] - 1);
            put_face(field, bin * voxels + at + i, best.faces[i]);
        }
    }
}

static inline __attribute__((always_inline)) void combine_some(const Builder *builder, uint64_t begin, uint64_t end)
{
    uint32_t length = builder->grid.count[0], pieces = (length + CHUNK - 1) / CHUNK;
    uint32_t piece = (length + pieces - 1) / pieces;
    for (uint64_t row = begin; row < end; row++)
        for (uint32_t x = 0; x < length; x += piece) {
            uint32_t rows = builder->grid.count[1], place[3] = {x, (uint32_t)(row % rows), (uint32_t)(row / rows)};
            combine_stretch(builder, place, length - x < piece ? length - x : piece);
        }
}

/* The same operations, and so the same table, on wider registers. */
#ifdef __x86_64__
__attribute__((target("avx2"))) static void combine_some_avx2(const Builder *builder, uint64_t begin, uint64_t end)
{
    combine_some(builder, begin, end);
}
#endif

static void combine_rows(void *context, uint64_t begin, uint64_t end)
{
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2")) {
        combine_some_avx2(context, begin, end);
        return;
    }
#endif
    combine_some(context, begin, end);
}

MesoStatus meso_match_field_build(MesoMatchField *field, MesoArena *arena, const MesoSwatch *swatch, float lambda,
                                  float voxel, uint32_t thread_count, MesoError *error)
{
    *field = (MesoMatchField){.bins = MESO_MATCH_BINS, .voxel = voxel, .lambda = lambda, .swatch = swatch};
    if (swatch->triangle_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "a swatch without faces");
    if (!(voxel > 0) || !(lambda >= 0))
        return meso_fail(error, MESO_ERR_INPUT, "a table of voxels of %g by a lambda of %g", (double)voxel,
                         (double)lambda);
    MesoStatus status = place_voxels(field, swatch, error);
    if (status != MESO_OK)
        return status;
    Builder builder = {.field = field,
                       .grid = {{field->count[0], field->count[1], field->count[2]}, voxel, field->low},
                       .worker_count = thread_count ? thread_count : meso_parallel_cores()};
    if (builder.worker_count > MESO_MATCH_BINS)
        builder.worker_count = MESO_MATCH_BINS;
    size_t cells = MESO_MATCH_BINS * meso_voxel_count(&builder.grid);
    bool many = swatch->triangle_count > UINT16_MAX;
    field->costs = MESO_NEW(arena, uint16_t, cells, error);
    field->faces = many ? NULL : MESO_NEW(arena, uint16_t, cells, error);
    field->many_faces = many ? MESO_NEW(arena, uint32_t, cells, error) : NULL;
    field->face_normals = MESO_NEW(arena, MesoVec3, swatch->triangle_count, error);
    MesoArenaMark mark = meso_arena_mark(arena);
    if (!field->costs || !(field->faces || field->many_faces) || !field->face_normals ||
        allocate(&builder, arena, error) != MESO_OK)
        return MESO_ERR_MEMORY;

    for (uint32_t f = 0; f < swatch->triangle_count; f++)
        field->face_normals[f] = face_normal(swatch, f);
    sort_faces(&builder);
    meso_parallel_team(builder.worker_count, MESO_MATCH_BINS, 1, measure_bins, &builder);
    meso_parallel_for(thread_count, (uint64_t)field->count[1] * field->count[2], 32, combine_rows, &builder);
    meso_arena_rewind(arena, mark);
    return MESO_OK;
}

/* ---- asking ---- */

/* Faces that are remembered: a power of two. */
enum { TRIED = 64 };

/* The best so far. */
typedef struct Climb {
    const MesoMatchField *field;
    MesoMatchPoint point;
    uint32_t face;
    float cost;
    uint32_t tried[TRIED];  /* the last face with each remainder: around a face its neighbours come twice, and again */
} Climb;

/* What was tried once is no better than the best since. Most faces are out by their normals, or by their planes. */
static void try_face(Climb *climb, uint32_t face)
{
    const MesoMatchField *field = climb->field;
    if (climb->tried[face % TRIED] == face)
        return;
    climb->tried[face % TRIED] = face;
    const uint32_t *corners = &field->swatch->corners[3 * (size_t)face];
    const MesoVec3 *p = field->swatch->positions;
    MesoVec3 normal = field->face_normals[face], a = p[corners[0]];
    float turn = 1 + meso_vec3_length(meso_vec3_sub(climb->point.normal, normal));
    float height = meso_vec3_dot(meso_vec3_sub(climb->point.position, a), normal);
    if ((1 + field->lambda * 0.9999f * (height < 0 ? -height : height)) * turn >= climb->cost)
        return;
    float square = meso_triangle_square(climb->point.position, a, p[corners[1]], p[corners[2]]);
    float cost = (1 + field->lambda * sqrtf(square)) * turn;
    if (cost < climb->cost) {
        climb->cost = cost;
        climb->face = face;
    }
}

static uint32_t next_side(uint32_t side)
{
    return side % 3 == 2 ? side - 2 : side + 1;
}

static uint32_t previous_side(uint32_t side)
{
    return side % 3 == 0 ? side + 2 : side - 1;
}

/* Faces around the vertex that `side` starts from, but its own: one way round, and from a border the other. */
static void try_around(Climb *climb, uint32_t side)
{
    const uint32_t *twins = climb->field->swatch->twins;
    uint32_t at = twins[previous_side(side)];
    while (at != MESO_NO_INDEX && at != side) {
        try_face(climb, at / 3);
        at = twins[previous_side(at)];
    }
    if (at == side)
        return;
    at = twins[side];
    while (at != MESO_NO_INDEX) {
        at = next_side(at);
        try_face(climb, at / 3);
        at = twins[at];
    }
}

/* Rounds of going on to better faces around the best. */
enum { ROUNDS = 3 };

static void climb_on(Climb *climb)
{
    for (int round = 0; round < ROUNDS && climb->face != MESO_NO_INDEX; round++) {
        uint32_t from = climb->face;
        for (uint32_t k = 0; k < 3; k++)
            try_around(climb, 3 * from + k);
        if (climb->face == from)
            return;
    }
}

/* The voxel that a place is in, and the next one on the side of it that the place is nearer to. */
static void voxels_around(float x, uint32_t count, uint32_t near[2])
{
    near[0] = x > 0 ? x < (float)count ? (uint32_t)x : count - 1 : 0;
    bool up = x - (float)near[0] >= 0.5f;
    near[1] = up ? near[0] + (near[0] + 1 < count) : near[0] - (near[0] > 0);
}

/* The faces in the table for the voxel of the point and the three next to it. */
static void try_table(Climb *climb)
{
    const MesoMatchField *field = climb->field;
    MesoVec3 p = meso_vec3_scale(meso_vec3_sub(climb->point.position, field->low), 1 / field->voxel);
    MesoMatchBlend blend = meso_match_blend(climb->point.normal);
    uint32_t x[2], y[2], z[2];
    voxels_around(p.x, field->count[0], x);
    voxels_around(p.y, field->count[1], y);
    voxels_around(p.z, field->count[2], z);
    uint32_t last = MESO_NO_INDEX;
    for (int k = 0; k < 3; k++)
        for (int n = 0; n < 4 && blend.weights[k] > 0; n++) {
            size_t layer = (size_t)blend.bins[k] * field->count[2] + z[n == 3];
            size_t at = (layer * field->count[1] + y[n == 2]) * field->count[0] + x[n == 1];
            uint32_t face = meso_match_face(field, at);
            if (face != last)   /* neighbours often have the same */
                try_face(climb, face);
            last = face;
        }
}

float meso_match_at(const MesoMatchField *field, MesoMatchPoint point, uint32_t *face)
{
    Climb climb = {.field = field, .point = point, .face = MESO_NO_INDEX, .cost = INFINITY};
    memset(climb.tried, 0xff, sizeof climb.tried);
    try_table(&climb);
    climb_on(&climb);
    if (face)
        *face = climb.face;
    return climb.cost;
}
