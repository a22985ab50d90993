/* Shepperd, "Quaternion from Rotation Matrix" (1978): the largest of the four parts first, by which the others are divided. */
#include "libcore/math/quaternion.h"

#include <math.h>

void meso_quaternion_of(const MesoVec3 columns[3], float rotation[4])
{
    double m[3][3];
    for (int c = 0; c < 3; c++) {
        m[0][c] = (double)columns[c].x;
        m[1][c] = (double)columns[c].y;
        m[2][c] = (double)columns[c].z;
    }
    double trace = m[0][0] + m[1][1] + m[2][2], q[4];
    int i = m[1][1] > m[0][0];
    i = m[2][2] > m[i][i] ? 2 : i;
    if (trace >= m[i][i]) {
        q[3] = 1 + trace;
        for (int k = 0; k < 3; k++)
            q[k] = m[(k + 2) % 3][(k + 1) % 3] - m[(k + 1) % 3][(k + 2) % 3];
    } else {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        q[i] = 1 + m[i][i] - m[j][j] - m[k][k];
        q[j] = m[i][j] + m[j][i];
        q[k] = m[i][k] + m[k][i];
        q[3] = m[k][j] - m[j][k];
    }
    double length = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int k = 0; k < 4; k++)
        rotation[k] = (float)(q[k] / (q[3] < 0 ? -length : length)) + 0.0f;     /* no negative zero */
}
