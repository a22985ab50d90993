/*
 * Writes the Utah teapot as quads in an OBJ file to standard output: Martin
 * Newell's 32 bicubic Bezier patches (1975; the bottom is Frank Crow's, 1987),
 * with y up. Body, lid, handle and spout are separate pieces, as in the
 * original. The two poles, where patches shrink to a point, are covered by
 * disks of quads whose vertices lie on the same patches.
 */
#include <stdio.h>

#include "scripts/quad_obj.h"

/* Newell's circle: a quarter of radius 1 has the control points (1,0), (1,k), (k,1), (0,1). */
#define CIRCLE 0.56f

/* A meridian: control points (radius, height) of one cubic. */
typedef struct Meridian {
    MesoVec2 p[4];
} Meridian;

static const Meridian rim = {{{1.4f, 2.4f}, {1.3375f, 2.53125f}, {1.4375f, 2.53125f}, {1.5f, 2.4f}}};
static const Meridian body_top = {{{1.5f, 2.4f}, {1.75f, 1.875f}, {2, 1.35f}, {2, 0.9f}}};
static const Meridian body_low = {{{2, 0.9f}, {2, 0.45f}, {1.5f, 0.225f}, {1.5f, 0.15f}}};
static const Meridian bottom = {{{1.5f, 0.15f}, {1.5f, 0.075f}, {1.425f, 0}, {0, 0}}};
static const Meridian lid_knob = {{{0, 3.15f}, {0.8f, 3.15f}, {0, 2.85f}, {0.2f, 2.7f}}};
static const Meridian lid_brim = {{{0.2f, 2.7f}, {0.4f, 2.55f}, {1.3f, 2.55f}, {1.3f, 2.4f}}};

/* Halves of a tube, at y <= 0; the other half is its mirror image. Rows along the tube, around in steps of four. */
typedef struct HalfTube {
    MesoVec3 p[4][4];
} HalfTube;

static const HalfTube handle_top = {{
    {{-1.6f, 0, 2.025f}, {-1.6f, -0.3f, 2.025f}, {-1.5f, -0.3f, 2.25f}, {-1.5f, 0, 2.25f}},
    {{-2.3f, 0, 2.025f}, {-2.3f, -0.3f, 2.025f}, {-2.5f, -0.3f, 2.25f}, {-2.5f, 0, 2.25f}},
    {{-2.7f, 0, 2.025f}, {-2.7f, -0.3f, 2.025f}, {-3, -0.3f, 2.25f}, {-3, 0, 2.25f}},
    {{-2.7f, 0, 1.8f}, {-2.7f, -0.3f, 1.8f}, {-3, -0.3f, 1.8f}, {-3, 0, 1.8f}}}};
static const HalfTube handle_low = {{
    {{-2.7f, 0, 1.8f}, {-2.7f, -0.3f, 1.8f}, {-3, -0.3f, 1.8f}, {-3, 0, 1.8f}},
    {{-2.7f, 0, 1.575f}, {-2.7f, -0.3f, 1.575f}, {-3, -0.3f, 1.35f}, {-3, 0, 1.35f}},
    {{-2.5f, 0, 1.125f}, {-2.5f, -0.3f, 1.125f}, {-2.65f, -0.3f, 0.9375f}, {-2.65f, 0, 0.9375f}},
    {{-2, 0, 0.9f}, {-2, -0.3f, 0.9f}, {-1.9f, -0.3f, 0.6f}, {-1.9f, 0, 0.6f}}}};
static const HalfTube spout_low = {{
    {{1.7f, 0, 1.425f}, {1.7f, -0.66f, 1.425f}, {1.7f, -0.66f, 0.6f}, {1.7f, 0, 0.6f}},
    {{2.6f, 0, 1.425f}, {2.6f, -0.66f, 1.425f}, {3.1f, -0.66f, 0.825f}, {3.1f, 0, 0.825f}},
    {{2.3f, 0, 2.1f}, {2.3f, -0.25f, 2.1f}, {2.4f, -0.25f, 2.025f}, {2.4f, 0, 2.025f}},
    {{2.7f, 0, 2.4f}, {2.7f, -0.25f, 2.4f}, {3.3f, -0.25f, 2.4f}, {3.3f, 0, 2.4f}}}};
static const HalfTube spout_tip = {{
    {{2.7f, 0, 2.4f}, {2.7f, -0.25f, 2.4f}, {3.3f, -0.25f, 2.4f}, {3.3f, 0, 2.4f}},
    {{2.8f, 0, 2.475f}, {2.8f, -0.25f, 2.475f}, {3.525f, -0.25f, 2.49375f}, {3.525f, 0, 2.49375f}},
    {{2.9f, 0, 2.475f}, {2.9f, -0.15f, 2.475f}, {3.45f, -0.15f, 2.5125f}, {3.45f, 0, 2.5125f}},
    {{2.8f, 0, 2.4f}, {2.8f, -0.15f, 2.4f}, {3.2f, -0.15f, 2.4f}, {3.2f, 0, 2.4f}}}};

/* The rim and the spout's lip are kept up to their crests: beyond, they fold back within less than
 * the shell's thickness. */
static const float crest = 0.5f;

/* Vertices that belong together are the same numbers up to rounding. */
static const float weld_distance = 1e-4f;

static float bezier(float a, float b, float c, float d, float t)
{
    float s = 1 - t;
    return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
}

static MesoVec3 bezier3(const MesoVec3 p[4], float t)
{
    return (MesoVec3){bezier(p[0].x, p[1].x, p[2].x, p[3].x, t), bezier(p[0].y, p[1].y, p[2].y, p[3].y, t),
                      bezier(p[0].z, p[1].z, p[2].z, p[3].z, t)};
}

/* Point of a revolved meridian: `turn` counts quarter turns, each one patch; z up in, y up out. */
static MesoVec3 revolved(const Meridian *m, float turn, float t)
{
    const MesoVec2 *p = m->p;
    float radius = bezier(p[0].x, p[1].x, p[2].x, p[3].x, t), quarter = floorf(turn), u = turn - quarter;
    float x = radius * bezier(1, 1, CIRCLE, 0, u), y = radius * bezier(0, CIRCLE, 1, 1, u);
    for (int k = 0; k < (int)quarter % 4; k++) {
        float old = x;
        x = -y, y = old;
    }
    return (MesoVec3){x, bezier(p[0].y, p[1].y, p[2].y, p[3].y, t), -y};
}

/* A row of quads around, between the vertices from `above` and from `below` on. */
static void add_row(ObjMesh *mesh, uint32_t around, uint32_t above, uint32_t below, bool turned)
{
    for (uint32_t k = 0; k < around; k++) {
        uint32_t next = (k + 1) % around;
        if (turned)
            obj_face(mesh, above + k, below + k, below + next, above + next);
        else
            obj_face(mesh, below + next, above + next, above + k, below + k);
    }
}

/*
 * Quads between the parameters `from` and `to` of a meridian that runs
 * downwards on the outside. `turned` faces begin at the opposite corner, so
 * that their tiles stand on their heads; see make_vase.c.
 */
static void add_revolved(ObjMesh *mesh, const Meridian *m, uint32_t side, uint32_t rows, float from, float to,
                         bool turned)
{
    uint32_t around = 4 * side, begin = mesh->vertex_count;
    for (uint32_t r = 0; r <= rows; r++)
        for (uint32_t k = 0; k < around; k++)
            obj_vertex(mesh, revolved(m, (float)k / (float)side, from + (to - from) * (float)r / (float)rows));
    for (uint32_t r = 0; r < rows; r++)
        add_row(mesh, around, begin + r * around, begin + (r + 1) * around, turned);
}

/* A disk over the pole at parameter `pole` of the meridian, out to the parameter `brim`. */
static void add_pole(ObjMesh *mesh, const Meridian *m, uint32_t side, uint32_t rings, float pole, float brim)
{
    uint32_t face_begin = mesh->face_count, begin = obj_disk(mesh, side, rings);
    for (uint32_t v = begin; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        float turn = (float)(atan2((double)p.y, (double)p.x) / (2 * atan(1.0)));
        float radius = fminf(sqrtf(p.x * p.x + p.y * p.y), 1);
        mesh->positions[v] = revolved(m, turn < 0 ? turn + 4 : turn, pole + (brim - pole) * radius);
    }
    for (uint32_t f = face_begin; f < mesh->face_count && pole > brim; f++) {
        uint32_t *v = &mesh->faces[4 * (size_t)f], swap = v[1];
        v[1] = v[3], v[3] = swap;
    }
}

/* Both halves of a tube, from its first row of control points up to the parameter `to`. */
static void add_tube(ObjMesh *mesh, const HalfTube *half, uint32_t half_around, uint32_t rows, float to)
{
    uint32_t around = 2 * half_around, begin = mesh->vertex_count;
    for (uint32_t r = 0; r <= rows; r++) {
        MesoVec3 ring[4];
        for (int i = 0; i < 4; i++) {
            MesoVec3 column[4] = {half->p[0][i], half->p[1][i], half->p[2][i], half->p[3][i]};
            ring[i] = bezier3(column, to * (float)r / (float)rows);
        }
        for (uint32_t k = 0; k < around; k++) {
            float mirror = k <= half_around ? 1.0f : -1.0f;
            MesoVec3 p = bezier3(ring, (float)(k <= half_around ? k : around - k) / (float)half_around);
            obj_vertex(mesh, (MesoVec3){p.x, p.z, -mirror * p.y});
        }
    }
    for (uint32_t r = 0; r < rows; r++)
        add_row(mesh, around, begin + (r + 1) * around, begin + r * around, false);
}

int main(void)
{
    ObjMesh mesh = {0};

    enum { BODY_SIDE = 14, LID_SIDE = 6, HANDLE_HALF = 5, SPOUT_HALF = 7 };
    add_revolved(&mesh, &rim, BODY_SIDE, 1, crest, 1, false);
    add_revolved(&mesh, &body_top, BODY_SIDE, 8, 0, 1, false);
    add_revolved(&mesh, &body_low, BODY_SIDE, 5, 0, 1, false);
    add_revolved(&mesh, &bottom, BODY_SIDE, 1, 0, 0.4f, true);
    add_pole(&mesh, &bottom, BODY_SIDE, 2, 1, 0.4f);
    obj_weld(&mesh, 0, weld_distance);

    uint32_t lid = mesh.vertex_count;
    add_pole(&mesh, &lid_knob, LID_SIDE, 1, 0, 0.25f);
    add_revolved(&mesh, &lid_knob, LID_SIDE, 1, 0.25f, 0.36f, false);
    add_revolved(&mesh, &lid_knob, LID_SIDE, 5, 0.36f, 1, true);
    add_revolved(&mesh, &lid_brim, LID_SIDE, 6, 0, 1, true);
    obj_weld(&mesh, lid, weld_distance);

    uint32_t handle = mesh.vertex_count;
    add_tube(&mesh, &handle_top, HANDLE_HALF, 10, 1);
    add_tube(&mesh, &handle_low, HANDLE_HALF, 10, 1);
    obj_weld(&mesh, handle, weld_distance);

    uint32_t spout = mesh.vertex_count;
    add_tube(&mesh, &spout_low, SPOUT_HALF, 12, 1);
    add_tube(&mesh, &spout_tip, SPOUT_HALF, 2, crest);
    obj_weld(&mesh, spout, weld_distance);

    obj_finish(&mesh, "Utah teapot");
    return 0;
}
