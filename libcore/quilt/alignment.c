/* A placement made exact: moved and turned until the older quilt lies on the swatch's faces. */
#include "libcore/quilt/quilt_work.h"

/* Turns of the loop; and what a distance counts as doubtful at, in mean edges of the swatch: at first, and at last. */
#define TURN_COUNT 5
#define DOUBTFUL_FIRST 1.0
#define DOUBTFUL_LAST 0.05

/* Points that are asked, and the move, in mean edges, after which it fits. */
#define POINT_LIMIT 400
#define MOVE_LEAST 1e-4

/* Angles: at most, and such as are only noise. */
#define ANGLE_MOST 0.15
#define ANGLE_LEAST 3e-4

typedef struct Motion {
    double x, y, angle;     /* of the swatch's plane; the angle about the window's middle, times `size` */
} Motion;

typedef struct Normals {
    double m[3][4];
} Normals;

/* One equation n . (t + a J p) = -distance, by its weight, to the normal equations. */
static void add_equation(Normals *normals, const double row[3], double right, double weight)
{
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++)
            normals->m[r][c] += weight * row[r] * row[c];
        normals->m[r][3] += weight * row[r] * right;
    }
}

static bool solve(Motion *motion, Normals *normals)
{
    double(*m)[4] = normals->m, hold = 1e-7 * (m[0][0] + m[1][1] + m[2][2]);   /* for what nothing holds */
    for (int k = 0; k < 3; k++)
        m[k][k] += hold;
    for (int k = 0; k < 3; k++) {
        if (!(m[k][k] > 0))
            return false;
        for (int r = k + 1; r < 3; r++) {
            double share = m[r][k] / m[k][k];
            for (int c = k; c < 4; c++)
                m[r][c] -= share * m[k][c];
        }
    }
    motion->angle = m[2][3] / m[2][2];
    motion->y = (m[1][3] - m[1][2] * motion->angle) / m[1][1];
    motion->x = (m[0][3] - m[0][1] * motion->y - m[0][2] * motion->angle) / m[0][0];
    return true;
}

/*
 * Point to plane (Chen and Medioni, "Object modelling by registration of multiple range images", 1992): each point has a
 * plane, that of the face which matches it best; the motion that brings all points nearest to their planes is a least
 * squares problem of three unknowns. Weights after Cauchy let points that match nothing count less and less.
 */
static bool find_motion(Motion *motion, const MesoQuiltStep *step, const MesoQuiltWork *work, double doubtful,
                        double size)
{
    const MesoSwatch *swatch = work->swatch;
    Normals normals = {{{0}}};
    uint32_t stride = step->point_count / POINT_LIMIT + 1;
    for (uint32_t i = 0; i < step->point_count; i += stride) {
        MesoMatchPoint p = step->points[i];
        MesoVec2 turned = meso_step_unturn(step, (MesoVec2){p.normal.x, p.normal.y});
        uint32_t face;
        p.position = meso_step_to_swatch(step, p.position);
        p.normal = (MesoVec3){turned.x, turned.y, p.normal.z};
        meso_match_at(&work->field, p, &face);
        MesoVec3 n = work->field.face_normals[face], on = swatch->positions[swatch->corners[3 * (size_t)face]];
        double distance = meso_vec3_dot(n, meso_vec3_sub(p.position, on)), far = distance / doubtful;
        double x = (p.position.x - step->match.shift.x) / size, y = (p.position.y - step->match.shift.y) / size;
        double weight = step->point_weights[i] / (1 + far * far);
        if (meso_vec3_dot(n, p.normal) > 0.5f)
            add_equation(&normals, (const double[3]){n.x, n.y, n.y * x - n.x * y}, -distance, weight);
    }
    return solve(motion, &normals);
}

bool meso_quilt_align(MesoQuiltStep *step, const MesoQuiltWork *work)
{
    if (!step->point_count)
        return false;
    double edge = work->swatch->mean_edge, doubtful = DOUBTFUL_FIRST, total = 0;
    double size = work->swatch->size.x > work->swatch->size.y ? work->swatch->size.x : work->swatch->size.y;
    for (int turn = 0; turn < TURN_COUNT; turn++) {
        Motion motion;
        if (!find_motion(&motion, step, work, doubtful * edge, size))
            break;
        double angle = motion.angle / size;
        if (fabs(angle) < ANGLE_LEAST || fabs(total + angle) > ANGLE_MOST)
            angle = 0;
        total += angle;
        /* the swatch's place of a point turns by `angle` about the window's middle, which is at the shift */
        double c = step->turn_cos, s = step->turn_sin, cos_angle = cos(angle), sin_angle = sin(angle);
        step->turn_cos = (float)(c * cos_angle + s * sin_angle);
        step->turn_sin = (float)(s * cos_angle - c * sin_angle);
        step->match.shift.x += (float)motion.x;
        step->match.shift.y += (float)motion.y;
        if (angle == 0 && fabs(motion.x) + fabs(motion.y) < MOVE_LEAST * edge)
            break;
        doubtful = doubtful / 2 > DOUBTFUL_LAST ? doubtful / 2 : DOUBTFUL_LAST;
    }
    return true;
}
