/* Faces of a sweep's grid, how many there are, and which are against their normals. */
#include "libcore/scene/sweep.h"

/* A row of quads. */
typedef struct Row {
    const MesoSweptKind *kind;
    const MesoSweepColumn *columns;
    const MesoSweepInstance *sweep;
    uint32_t number;
} Row;

static bool leans(const Row *row, uint32_t joint)
{
    return meso_sweep_leans(row->sweep, meso_sweep_lean_bit(joint, row->kind->joint_count, row->number,
                                                            row->kind->division_count - 1));
}

/* The diagonal of a quad is from its first corner. */
static MesoMeshFace quad_face(uint32_t a, uint32_t b, uint32_t b_ahead, uint32_t a_ahead, bool lean)
{
    return lean ? (MesoMeshFace){{b, b_ahead, a_ahead, a}} : (MesoMeshFace){{a, b, b_ahead, a_ahead}};
}

/* A row of faces from a ring between the ends to the next. */
static MesoMeshFace *inner_row(const Row *row, uint32_t here, bool tip, MesoMeshFace *out)
{
    const MesoSweptKind *kind = row->kind;
    const MesoSweepColumn *columns = row->columns;
    uint32_t ahead = here + kind->column_count - kind->absent[2], joint = 0;
    bool last = false;      /* whether the column before joins this one */
    for (uint32_t c = 0; c < kind->column_count; c++) {
        if (!(columns[c].absent & MESO_ABSENT_BETWEEN)) {
            if (last)
                *out++ = tip ? (MesoMeshFace){{here - 1, ahead - 1, here, MESO_NO_INDEX}}
                             : quad_face(here - 1, ahead - 1, ahead, here, leans(row, joint++));
            here++;
            ahead++;
        }
        last = columns[c].joins_next;
    }
    return out;
}

/* From a row's one ring at `a` to its other at `b`, and on along both or one. */
static MesoMeshFace row_face(uint32_t a, uint32_t b, uint32_t b_ahead, uint32_t a_ahead, bool lean)
{
    if (a_ahead == a)
        return (MesoMeshFace){{a, b, b_ahead, MESO_NO_INDEX}};
    if (b_ahead == b)
        return (MesoMeshFace){{a, b, a_ahead, MESO_NO_INDEX}};
    return quad_face(a, b, b_ahead, a_ahead, lean);
}

/* A row between the ring at an end, from `ring`, and one between, from `inner`; both walk on by their columns. */
static MesoMeshFace *end_row(const Row *row, uint32_t ring, uint32_t inner, bool end, MesoMeshFace *out)
{
    const MesoSweptKind *kind = row->kind;
    const MesoSweepColumn *columns = row->columns;
    uint32_t absent = end ? MESO_ABSENT_END : MESO_ABSENT_START, joint = 0;
    for (uint32_t c = 1; c < kind->column_count; c++) {
        uint32_t ring_ahead = ring + !(columns[c].absent & absent);
        uint32_t inner_ahead = inner + !(columns[c].absent & MESO_ABSENT_BETWEEN);
        bool lean = leans(row, joint);
        if (columns[c - 1].joins_next && (ring_ahead > ring || inner_ahead > inner))
            *out++ = end ? row_face(inner, ring, ring_ahead, inner_ahead, lean)
                         : row_face(ring, inner, inner_ahead, ring_ahead, lean);
        joint += columns[c - 1].joins_next && inner_ahead > inner;
        ring = ring_ahead;
        inner = inner_ahead;
    }
    return out;
}

static bool row_is_uneven(const MesoSweptKind *kind, bool end)
{
    return kind->absent[end] || kind->absent[2];
}

/* The rings run clockwise around the tangent: along, then around is counter-clockwise from outside. */
void meso_sweep_faces(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep, uint32_t base,
                      MesoMeshFace *out)
{
    const MesoSweepColumn *columns = scene->columns + kind->column_begin;
    uint32_t last = kind->division_count - 1, width = kind->column_count - kind->absent[2];
    uint32_t first = kind->column_count - kind->absent[0];
    for (uint32_t ring = 0; ring < last; ring++) {
        const Row row = {kind, columns, sweep, ring};
        uint32_t here = ring == 0 ? base : base + first + (ring - 1) * width;
        if (ring == 0 && row_is_uneven(kind, false))
            out = end_row(&row, base, base + first, false, out);
        else if (ring + 1 == last && row_is_uneven(kind, true))
            out = end_row(&row, here + width, here, true, out);
        else
            out = inner_row(&row, here, kind->cap && ring + 1 == last, out);
    }
}

uint64_t meso_sweep_vertex_count(const MesoSweptKind *kind)
{
    uint64_t between = (uint64_t)(kind->division_count - 2) * (kind->column_count - kind->absent[2]);
    return between + 2 * (uint64_t)kind->column_count - kind->absent[0] - kind->absent[1];
}

uint64_t meso_sweep_face_count(const MesoSweptKind *kind)
{
    return (uint64_t)kind->joint_count * (kind->division_count - 1) + kind->more_joints[0] + kind->more_joints[1];
}

uint64_t meso_sweep_triangle_count(const MesoSweptKind *kind)
{
    return 2 * meso_sweep_face_count(kind) - (kind->cap ? kind->joint_count : 0) - kind->fans[0] - kind->fans[1];
}

/* Joins of the columns that lack not all of the bits. */
static uint32_t count_joints(const MesoSweepColumn *columns, uint32_t count, uint32_t absent)
{
    uint32_t joints = 0;
    for (uint32_t c = 1; c < count; c++)
        joints += columns[c - 1].joins_next && (columns[c].absent & absent) != absent;
    return joints;
}

void meso_sweep_count(MesoSweptKind *kind, const MesoSweepColumn *columns)
{
    static const uint32_t bits[3] = {MESO_ABSENT_START, MESO_ABSENT_END, MESO_ABSENT_BETWEEN};
    uint32_t count = kind->column_count;
    for (uint32_t k = 0; k < 3; k++) {
        kind->absent[k] = 0;
        for (uint32_t c = 0; c < count; c++)
            kind->absent[k] += (columns[c].absent & bits[k]) != 0;
    }
    kind->joint_count = count_joints(columns, count, MESO_ABSENT_BETWEEN);
    for (uint32_t end = 0; end < 2; end++) {
        uint32_t both = 0, faces = count_joints(columns, count, bits[end] | MESO_ABSENT_BETWEEN);
        for (uint32_t c = 1; c < count; c++)
            both += columns[c - 1].joins_next && !(columns[c].absent & (bits[end] | MESO_ABSENT_BETWEEN));
        kind->more_joints[end] = faces - kind->joint_count;
        kind->fans[end] = faces - both;
    }
}

/* ---- faces against their normals ---- */

/* Columns at once, the last of which are the first of the next; and rings. */
enum { SIDE = 32, MOST_RINGS = 64 };

/* Of the cosine between a normal and a triangle's: others may come to lie on either side, as they are rounded. */
static const float LEAST_COSINE = 0.01f;

static bool is_against(const MesoMeshVertex *a, const MesoMeshVertex *b, const MesoMeshVertex *c)
{
    MesoVec3 area = meso_vec3_cross(meso_vec3_sub(b->position, a->position), meso_vec3_sub(c->position, a->position));
    float most = fmaxf(fmaxf(meso_vec3_dot(area, a->normal), meso_vec3_dot(area, b->normal)),
                       meso_vec3_dot(area, c->normal));
    return most < 0 || most * most < LEAST_COSINE * LEAST_COSINE * meso_vec3_dot(area, area);
}

/* Of both cuts of a quad. */
static uint32_t count_quad(const MesoMeshVertex *a, const MesoMeshVertex *b, const MesoMeshVertex *c,
                           const MesoMeshVertex *d)
{
    return (uint32_t)is_against(a, b, c) + (uint32_t)is_against(a, c, d) + (uint32_t)is_against(a, b, d) +
           (uint32_t)is_against(b, c, d);
}

/* Between a ring and the next, of as many columns. */
static uint32_t count_row(const MesoSweepColumn *columns, const MesoMeshVertex *ring, uint32_t width)
{
    const MesoMeshVertex *next = ring + width;
    uint32_t against = 0;
    for (uint32_t c = 0; c + 1 < width; c++)
        against += columns[c].joins_next ? count_quad(&ring[c], &next[c], &next[c + 1], &ring[c + 1]) : 0;
    return against;
}

uint32_t meso_sweep_against(const MesoScene *scene, const MesoSweptKind *kind, const MesoSweepInstance *sweep,
                            uint32_t enough)
{
    MesoScene straight = *scene;
    MesoMeshVertex vertices[SIDE * MOST_RINGS];
    uint32_t numbers[SIDE], against = 0;
    uint32_t rings = kind->division_count < MOST_RINGS ? kind->division_count : MOST_RINGS;
    straight.deform = MESO_SWEEP_CURVES;    /* cages do not turn faces against their normals */
    for (uint32_t begin = 0; begin + 1 < kind->column_count && against <= enough; begin += SIDE - 1) {
        uint32_t left = kind->column_count - begin, width = left < SIDE ? left : SIDE;
        for (uint32_t c = 0; c < width; c++)
            numbers[c] = begin + c;
        MesoSweepGrid grid = {.columns = numbers, .column_count = width, .ring_count = rings};
        meso_sweep_grid(&straight, kind, sweep, &grid, vertices);
        for (uint32_t r = 0; r + 1 < rings; r++)
            against += count_row(&scene->columns[kind->column_begin + begin], &vertices[(size_t)r * width], width);
    }
    return against;
}
