#include "libcore/quilt/seam/bodies_meet.h"

#include "libcore/quilt/seam/strand_fixture.h"

/* A ring of radius 1 and thickness 2 * `tube` in the plane of x and one more axis, around `centre`. */
static MesoFixtureMesh make_ring(float tube, MesoVec3 centre, bool upright)
{
    enum { COLUMNS = 24, ROWS = 8 };
    MesoFixtureMesh mesh = {.vertex_count = COLUMNS * ROWS};
    mesh.positions = malloc(mesh.vertex_count * sizeof *mesh.positions);
    mesh.corners = malloc(6 * (size_t)mesh.vertex_count * sizeof *mesh.corners);
    CHECK(mesh.positions && mesh.corners);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) {
        float a = 6.2831853f * (float)(v % COLUMNS) / COLUMNS, b = 6.2831853f * (float)(v / COLUMNS) / ROWS;
        float r = 1 + tube * cosf(b), y = r * sinf(a), z = tube * sinf(b);
        mesh.positions[v] = meso_vec3_add(centre, upright ? (MesoVec3){r * cosf(a), -z, y} : (MesoVec3){r * cosf(a), y, z});
    }
    for (uint32_t r = 0; r < ROWS; r++)
        for (uint32_t c = 0; c < COLUMNS; c++) {
            uint32_t right = (c + 1) % COLUMNS, up = (r + 1) % ROWS * COLUMNS, low = r * COLUMNS;
            uint32_t quad[6] = {low + c, low + right, up + right, low + c, up + right, up + c};
            memcpy(&mesh.corners[3 * (size_t)mesh.triangle_count], quad, sizeof quad);
            mesh.triangle_count += 2;
        }
    return mesh;
}

static bool meet(const MesoFixtureMesh *a, const MesoFixtureMesh *b)
{
    MesoBodyPart p = {a->positions, a->corners, a->triangle_count, 0, a->vertex_count};
    MesoBodyPart q = {b->positions, b->corners, b->triangle_count, 0, b->vertex_count};
    bool result = meso_bodies_meet(&p, &q);
    CHECK(result == meso_bodies_meet(&q, &p));
    return result;
}

/* Links of a chain go through each other without meeting, until they are too thick. */
int main(void)
{
    MesoFixtureMesh flat = make_ring(0.2f, (MesoVec3){0, 0, 0}, false);
    const struct {
        MesoVec3 centre;
        bool upright, expected;
    } cases[] = {
        {{1, 0, 0}, true, false},       /* linked */
        {{0.5f, 0, 0}, true, false},
        {{0.25f, 0, 0}, true, true},    /* one lies in the other's tube */
        {{3, 0, 0}, true, false},
        {{2.3f, 0, 0}, false, true},
        {{2.5f, 0, 0}, false, false},
        {{0, 0, 0.5f}, false, false},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        MesoFixtureMesh other = make_ring(0.2f, cases[i].centre, cases[i].upright);
        CHECK(meet(&flat, &other) == cases[i].expected);
        meso_fixture_mesh_release(&other);
    }
    meso_fixture_mesh_release(&flat);
    return 0;
}
