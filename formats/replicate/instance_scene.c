#include "formats/replicate/instance_scene.h"

#include <math.h>
#include <stdio.h>

/*
 * The quaternion of a rotation by its columns (Shepperd 1978): the largest of its four parts first, by which the
 * others are divided.
 */
static void rotation_of(const MesoVec3 columns[3], float rotation[4])
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

MesoInstance meso_instance_of(const MesoPlacedDetail *placed)
{
    MesoInstance instance = {.position = placed->position};
    const MesoVec3 columns[] = {placed->tangent, meso_vec3_cross(placed->normal, placed->tangent), placed->normal};
    rotation_of(columns, instance.rotation);
    instance.scale = (MesoVec3){placed->size, placed->width, 0};
    instance.scale.z = (float)sqrt((double)placed->size * (double)placed->width);
    return instance;
}

static bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

void meso_instance_name(const char *text, uint32_t number, char *name, size_t size)
{
    char ending[16];
    size_t ending_size = (size_t)snprintf(ending, sizeof ending, "_%u", number) + 1, used = 0;
    if (!is_letter(*text))
        name[used++] = '_';
    for (; *text && used + ending_size < size; text++)
        name[used++] = is_letter(*text) || (*text >= '0' && *text <= '9') ? *text : '_';
    snprintf(name + used, size - used, "%s", ending);
}
