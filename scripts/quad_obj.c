#include "scripts/quad_obj.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Enough for the grid's corners to settle; each round moves them less. */
enum { SMOOTHING_ROUNDS = 400 };

static void fail(const char *message)
{
    fprintf(stderr, "make-surface: %s\n", message);
    exit(1);
}

static void *grow(void *data, uint32_t *room, size_t size)
{
    *room = *room ? 2 * *room : 1024;
    data = realloc(data, *room * size);
    if (!data)
        fail("out of memory");
    return data;
}

uint32_t obj_vertex(ObjMesh *mesh, MesoVec3 position)
{
    if (mesh->vertex_count == mesh->vertex_room)
        mesh->positions = grow(mesh->positions, &mesh->vertex_room, sizeof *mesh->positions);
    mesh->positions[mesh->vertex_count] = position;
    return mesh->vertex_count++;
}

void obj_face(ObjMesh *mesh, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    if (mesh->face_count == mesh->face_room)
        mesh->faces = grow(mesh->faces, &mesh->face_room, 4 * sizeof *mesh->faces);
    uint32_t *face = &mesh->faces[4 * (size_t)mesh->face_count++];
    face[0] = a, face[1] = b, face[2] = c, face[3] = d;
}

/* Moves vertices from `begin` on, but for those that are `fixed` (or NULL), to the mean of their neighbours, again and again. */
static void smooth(ObjMesh *mesh, uint32_t face_begin, uint32_t begin, const bool *fixed)
{
    MesoVec3 *sum = calloc(mesh->vertex_count, sizeof *sum);
    uint32_t *count = calloc(mesh->vertex_count, sizeof *count);
    if (!sum || !count)
        fail("out of memory");
    for (int round = 0; round < SMOOTHING_ROUNDS; round++) {
        memset(sum, 0, mesh->vertex_count * sizeof *sum);
        memset(count, 0, mesh->vertex_count * sizeof *count);
        for (uint32_t h = 4 * face_begin; h < 4 * mesh->face_count; h++) {
            uint32_t a = mesh->faces[h], b = mesh->faces[h % 4 == 3 ? h - 3 : h + 1];
            sum[a] = meso_vec3_add(sum[a], mesh->positions[b]);
            sum[b] = meso_vec3_add(sum[b], mesh->positions[a]);
            count[a]++, count[b]++;
        }
        for (uint32_t v = begin; v < mesh->vertex_count; v++)
            if (!fixed || !fixed[v])
                mesh->positions[v] = meso_vec3_scale(sum[v], 1 / (float)count[v]);
    }
    free(sum);
    free(count);
}

void obj_smooth(ObjMesh *mesh, const bool *fixed)
{
    smooth(mesh, 0, 0, fixed);
}

static MesoVec3 on_circle(float radius, uint32_t k, uint32_t count)
{
    double angle = 2 * acos(-1) * k / count;
    return (MesoVec3){radius * (float)cos(angle), radius * (float)sin(angle), 0};
}

/* Vertex (i, j) of the grid, where the grid's border is the ring that begins at `ring`. */
static uint32_t grid_vertex(uint32_t side, uint32_t ring, uint32_t inner, uint32_t i, uint32_t j)
{
    if (j == 0)
        return ring + i;
    if (i == side)
        return ring + side + j;
    if (j == side)
        return ring + 3 * side - i;
    if (i == 0)
        return ring + 4 * side - j;
    return inner + (j - 1) * (side - 1) + i - 1;
}

uint32_t obj_disk(ObjMesh *mesh, uint32_t side, uint32_t ring_count)
{
    uint32_t around = 4 * side, begin = mesh->vertex_count, face_begin = mesh->face_count;

    for (uint32_t r = 0; r <= ring_count; r++)
        for (uint32_t k = 0; k < around; k++)
            obj_vertex(mesh, on_circle(1 - (float)r / (float)(ring_count + side), k, around));
    for (uint32_t r = 0; r < ring_count; r++)
        for (uint32_t k = 0; k < around; k++) {
            uint32_t outer = begin + r * around, next = (k + 1) % around;
            obj_face(mesh, outer + next, outer + around + next, outer + around + k, outer + k);
        }
    uint32_t ring = begin + ring_count * around, inner = mesh->vertex_count;
    for (uint32_t v = 0; v < (side - 1) * (side - 1); v++)
        obj_vertex(mesh, (MesoVec3){0, 0, 0});
    for (uint32_t j = 0; j < side; j++)
        for (uint32_t i = 0; i < side; i++)
            obj_face(mesh, grid_vertex(side, ring, inner, i, j), grid_vertex(side, ring, inner, i + 1, j),
                     grid_vertex(side, ring, inner, i + 1, j + 1), grid_vertex(side, ring, inner, i, j + 1));
    smooth(mesh, face_begin, begin + around, NULL);
    return begin;
}

void obj_weld(ObjMesh *mesh, uint32_t begin, float distance)
{
    uint32_t *target = malloc((mesh->vertex_count + 1) * sizeof *target), kept = begin;
    if (!target)
        fail("out of memory");
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t same = v < begin ? v : begin;
        while (v >= begin && same < kept &&
               !(meso_vec3_length(meso_vec3_sub(mesh->positions[same], mesh->positions[v])) <= distance))
            same++;
        if (same == kept && v >= begin)
            mesh->positions[kept++] = mesh->positions[v];
        target[v] = same;
    }
    mesh->vertex_count = kept;
    for (uint32_t i = 0; i < 4 * mesh->face_count; i++)
        mesh->faces[i] = target[mesh->faces[i]];
    free(target);
}

void obj_finish(ObjMesh *mesh, const char *title)
{
    MesoVec3 *normals = calloc(mesh->vertex_count, sizeof *normals);
    if (!normals)
        fail("out of memory");
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *v = &mesh->faces[4 * (size_t)f];
        const MesoVec3 *p = mesh->positions;
        MesoVec3 normal = meso_vec3_cross(meso_vec3_sub(p[v[2]], p[v[0]]), meso_vec3_sub(p[v[3]], p[v[1]]));
        for (int i = 0; i < 4; i++)
            normals[v[i]] = meso_vec3_add(normals[v[i]], normal);
    }
    printf("# %s: %u vertices, %u quads\n", title, mesh->vertex_count, mesh->face_count);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        printf("v %.6f %.6f %.6f\n", (double)p.x, (double)p.y, (double)p.z);
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 n = meso_vec3_unit(normals[v], (MesoVec3){0, 1, 0});
        printf("vn %.6f %.6f %.6f\n", (double)n.x, (double)n.y, (double)n.z);
    }
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        const uint32_t *v = &mesh->faces[4 * (size_t)f];
        printf("f %u//%u %u//%u %u//%u %u//%u\n", v[0] + 1, v[0] + 1, v[1] + 1, v[1] + 1,
               v[2] + 1, v[2] + 1, v[3] + 1, v[3] + 1);
    }
    free(normals);
    free(mesh->positions);
    free(mesh->faces);
    if (fflush(stdout) != 0 || ferror(stdout))
        fail("cannot write to standard output");
}
