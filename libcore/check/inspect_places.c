/* Vertices at one position become one place; triangles that are none, or are there before, are found and left out. */
#include <string.h>

#include "libcore/check/inspect_work.h"

/* A height of less than this share of the longest side is rounding: floats have 24 bits. */
#define FLAT_HEIGHT 1e-6

static uint64_t mix(uint64_t a, uint64_t b, uint64_t c)
{
    uint64_t x = a * UINT64_C(0x9e3779b97f4a7c15) ^ b * UINT64_C(0xc2b2ae3d27d4eb4f) ^ c * UINT64_C(0x165667b19e3779f9);
    x = (x ^ x >> 32) * UINT64_C(0xd6e8feb86659fd93);
    return x ^ x >> 32;
}

/* The bits of a float, with one zero: sums of zeros are positive. */
static uint32_t bits_of(float x)
{
    uint32_t bits;
    x += 0.0f;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/* Open addressing over `count` things, at most half full. */
static uint64_t room_for(uint64_t count)
{
    uint64_t room = 64;
    while (room < 2 * count)
        room *= 2;
    return room;
}

/* ---- places ---- */

static bool same_position(MesoVec3 a, MesoVec3 b)
{
    return bits_of(a.x) == bits_of(b.x) && bits_of(a.y) == bits_of(b.y) && bits_of(a.z) == bits_of(b.z);
}

/* `place_of` [vertex_count] gets the places, numbered as they are met. */
static MesoStatus weld(MesoInspectWork *work, uint32_t *place_of, MesoError *error)
{
    const MesoInspectedMesh *mesh = work->mesh;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint64_t room = room_for(mesh->vertex_count);
    uint32_t *table = MESO_NEW(work->scratch, uint32_t, room, error);
    if (!table)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        MesoVec3 p = mesh->positions[v];
        uint64_t at = mix(bits_of(p.x), bits_of(p.y), bits_of(p.z)) & (room - 1);
        while (table[at] && !same_position(mesh->positions[table[at] - 1], p))
            at = (at + 1) & (room - 1);
        place_of[v] = table[at] ? place_of[table[at] - 1] : work->place_count++;
        if (!table[at])
            table[at] = v + 1;
    }
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

/* ---- triangles ---- */

static bool has_bad_number(const MesoInspectedMesh *mesh, uint32_t t)
{
    bool bad = !meso_inspect_is_finite(mesh, t);
    for (uint32_t k = 0; k < 3 && !bad; k++) {
        uint32_t normal = meso_inspect_normal_at(mesh, 3 * t + k);
        bad = normal != MESO_NO_INDEX && !meso_vec3_finite(mesh->normals[normal]);
    }
    return bad;
}

static bool is_collapsed(const uint32_t *places)
{
    return places[0] == places[1] || places[1] == places[2] || places[2] == places[0];
}

static bool is_flat(const MesoInspectedMesh *mesh, uint32_t t)
{
    double longest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        MesoVec3d side = meso_vec3d_sub(meso_vec3d(meso_inspect_corner(mesh, 3 * t + (k + 1) % 3)),
                                        meso_vec3d(meso_inspect_corner(mesh, 3 * t + k)));
        longest = fmax(longest, meso_vec3d_dot(side, side));
    }
    return meso_vec3d_length(meso_inspect_area(mesh, t)) <= FLAT_HEIGHT * longest;
}

/* Three places in ascending order. */
typedef struct Trio {
    uint32_t p[3];
} Trio;

static Trio trio_of(const uint32_t *places)
{
    Trio trio = {{places[0], places[1], places[2]}};
    for (int i = 0; i < 3; i++) {
        int k = i == 1 ? 1 : 0;
        if (trio.p[k] > trio.p[k + 1]) {
            uint32_t swapped = trio.p[k];
            trio.p[k] = trio.p[k + 1];
            trio.p[k + 1] = swapped;
        }
    }
    return trio;
}

static void leave_out(MesoInspectWork *work, uint32_t t)
{
    for (uint32_t k = 0; k < 3; k++)
        work->mates[3 * t + k] = MESO_MATE_OUT;
}

static MesoStatus find_doubles(MesoInspectWork *work, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint64_t room = room_for(work->mesh->triangle_count);
    uint32_t *table = MESO_NEW(work->scratch, uint32_t, room, error);
    if (!table)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < work->mesh->triangle_count; t++) {
        if (work->mates[3 * t] == MESO_MATE_OUT)
            continue;
        Trio trio = trio_of(&work->places[3 * t]);
        uint64_t at = mix(trio.p[0], trio.p[1], trio.p[2]) & (room - 1);
        for (; table[at]; at = (at + 1) & (room - 1)) {
            Trio other = trio_of(&work->places[3 * (table[at] - 1)]);
            if (memcmp(&trio, &other, sizeof trio) == 0)
                break;
        }
        if (table[at]) {
            meso_inspect_note(work, MESO_FAULT_DOUBLE, t, 0);
            leave_out(work, t);
        } else {
            table[at] = t + 1;
        }
    }
    meso_arena_rewind(work->scratch, mark);
    return MESO_OK;
}

MesoStatus meso_inspect_places(MesoInspectWork *work, MesoError *error)
{
    const MesoInspectedMesh *mesh = work->mesh;
    size_t half_count = 3 * (size_t)mesh->triangle_count;
    work->places = MESO_NEW(work->scratch, uint32_t, half_count, error);
    work->mates = MESO_NEW(work->scratch, uint32_t, half_count, error);
    if (!work->places || !work->mates)
        return MESO_ERR_MEMORY;
    MesoArenaMark mark = meso_arena_mark(work->scratch);
    uint32_t *place_of = MESO_NEW(work->scratch, uint32_t, mesh->vertex_count, error);
    MesoStatus status = place_of ? weld(work, place_of, error) : MESO_ERR_MEMORY;
    if (status)
        return status;
    for (size_t h = 0; h < half_count; h++)
        work->places[h] = place_of[mesh->corners[h]];
    meso_arena_rewind(work->scratch, mark);
    for (uint32_t t = 0; t < mesh->triangle_count; t++) {
        bool collapsed = is_collapsed(&work->places[3 * t]), bad = has_bad_number(mesh, t);
        if (bad)
            meso_inspect_note(work, MESO_FAULT_NUMBER, t, 0);
        if (collapsed || (!bad && is_flat(mesh, t)))
            meso_inspect_note(work, MESO_FAULT_FLAT, t, 0);
        if (collapsed)
            leave_out(work, t);
    }
    return find_doubles(work, error);
}
