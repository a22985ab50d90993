/* Where things end: at which face of its slot's hexahedron a ring lies. */
#include "libcore/check/inspect_work.h"

/* A ring ends where the face that it lies at looks, give or take 60 degrees: sections stand across their sweeps. */
#define OUTWARD_COSINE 0.5
/* And its middle is no further from it than this share of the ring's size: faces bend, by up to 0.025 in models. */
#define FACE_SHARE 0.05

enum { STEPS = 8 };

/* Corners of the faces: four sides, the bottom, the top; around, so that they look outward. */
static const uint8_t FACES[6][4] = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {3, 2, 1, 0}, {4, 5, 6, 7}};

typedef struct Patch {
    MesoVec3d p[4];
} Patch;

static Patch patch_of(const MesoVec3 *cage, uint32_t face)
{
    Patch patch;
    for (uint32_t k = 0; k < 4; k++)
        patch.p[k] = meso_vec3d(cage[FACES[face][k]]);
    return patch;
}

static MesoVec3d patch_normal(const Patch *patch)
{
    return meso_vec3d_cross(meso_vec3d_sub(patch->p[2], patch->p[0]), meso_vec3d_sub(patch->p[3], patch->p[1]));
}

/* Of the hexahedron as a whole: where its normals oppose its winding, all faces look inward. */
static double handedness(const MesoVec3 *cage)
{
    MesoVec3d up = {0, 0, 0};
    for (uint32_t k = 0; k < 4; k++)
        up = meso_vec3d_add(up, meso_vec3d_sub(meso_vec3d(cage[4 + k]), meso_vec3d(cage[k])));
    Patch top = patch_of(cage, 5);
    return meso_vec3d_dot(up, patch_normal(&top)) < 0 ? -1 : 1;
}

static double clamp(double x)
{
    return fmin(fmax(x, 0), 1);
}

/* Square of the distance to a patch, bilinear between its corners: Newton's steps, which a plane needs one of. */
static double patch_distance(const Patch *patch, MesoVec3d point)
{
    const MesoVec3d *p = patch->p;
    double s = 0.5, t = 0.5, least = INFINITY;
    for (int step = 0; step < STEPS; step++) {
        MesoVec3d low = meso_vec3d_mad(p[0], s, meso_vec3d_sub(p[1], p[0]));
        MesoVec3d high = meso_vec3d_mad(p[3], s, meso_vec3d_sub(p[2], p[3]));
        MesoVec3d v = meso_vec3d_sub(high, low);
        MesoVec3d u = meso_vec3d_add(meso_vec3d_scale(meso_vec3d_sub(p[1], p[0]), 1 - t),
                                     meso_vec3d_scale(meso_vec3d_sub(p[2], p[3]), t));
        MesoVec3d way = meso_vec3d_sub(point, meso_vec3d_mad(low, t, v));
        double uu = meso_vec3d_dot(u, u), uv = meso_vec3d_dot(u, v), vv = meso_vec3d_dot(v, v), det = uu * vv - uv * uv;
        double du = meso_vec3d_dot(u, way), dv = meso_vec3d_dot(v, way);
        least = fmin(least, meso_vec3d_dot(way, way));
        if (!(det > 0))
            break;
        s = clamp(s + (du * vv - dv * uv) / det);
        t = clamp(t + (dv * uu - du * uv) / det);
    }
    return least;
}

MesoInspectEnd meso_inspect_end(const MesoInspectedMesh *mesh, uint32_t slot, MesoVec3d middle, MesoVec3d outward,
                                double size)
{
    if (!mesh->across || slot >= mesh->cage_count)
        return MESO_END_INSIDE;
    const MesoVec3 *cage = &mesh->cages[8 * (size_t)slot];
    double least = FACE_SHARE * size * FACE_SHARE * size, hand = handedness(cage);
    uint32_t face = 6;
    for (uint32_t f = 0; f < 6; f++) {
        Patch patch = patch_of(cage, f);
        MesoVec3d normal = patch_normal(&patch);
        double lengths = meso_vec3d_length(normal) * meso_vec3d_length(outward);
        double distance = patch_distance(&patch, middle);
        if (hand * meso_vec3d_dot(normal, outward) > OUTWARD_COSINE * lengths && distance <= least) {
            least = distance;
            face = f;
        }
    }
    if (face == 6)
        return MESO_END_INSIDE;
    if (face >= 4)
        return MESO_END_LID;
    return mesh->across[4 * (size_t)slot + face] == MESO_NO_INDEX ? MESO_END_BORDER : MESO_END_INSIDE;
}
