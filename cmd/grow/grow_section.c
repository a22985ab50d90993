#include "cmd/grow/grow_section.h"

#include <stdio.h>
#include <string.h>

#include "libcore/base/nearest.h"
#include "libcore/tiling/tile/contour.h"

/* Rings of a prism: enough for the curve of a step. */
enum { RINGS = 5 };

static const float SAMPLING_STEP = 0.02f, SHARP_COSINE = 0.766f;

/* ---- which one ---- */

/* Whether "interface/section", or the section alone, is meant. */
static bool is_named(const MesoTileSet *set, uint32_t section, const char *name)
{
    const MesoSection *s = &set->sections[section];
    const char *interface = set->interfaces[s->interface].name, *slash = strchr(name, '/');
    if (!slash)
        return strcmp(s->name, name) == 0;
    size_t length = (size_t)(slash - name);
    return strlen(interface) == length && memcmp(interface, name, length) == 0 && strcmp(s->name, slash + 1) == 0;
}

static MesoStatus no_section(const MesoTileSet *set, const char *name, MesoError *error)
{
    char words[2][160], *word = words[0];
    MesoNearest nearest = meso_nearest(name, strlen(name));
    for (uint32_t i = 0; i < set->section_count; i++) {
        const MesoSection *section = &set->sections[i];
        const char *interface = set->interfaces[section->interface].name;
        bool whole = strchr(name, '/') != NULL;
        snprintf(word, sizeof words[0], "%s%s%s", whole ? interface : "", whole ? "/" : "", section->name);
        meso_nearest_try(&nearest, word);
        if (nearest.best == word)
            word = word == words[0] ? words[1] : words[0];
    }
    const MesoSection *first = &set->sections[0];
    if (nearest.best)
        return meso_fail(error, MESO_ERR_INPUT, "no cross-section '%s'; did you mean '%s'?", name, nearest.best);
    return meso_fail(error, MESO_ERR_INPUT, "no cross-section '%s'; there is '%s/%s'", name,
                     set->interfaces[first->interface].name, first->name);
}

static MesoStatus find_section(uint32_t *found, const MesoTileSet *set, const char *name, MesoError *error)
{
    *found = MESO_NO_INDEX;
    if (set->section_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "the tile set has no cross-section");
    for (uint32_t i = 0; i < set->section_count && name; i++) {
        if (!is_named(set, i, name))
            continue;
        if (*found != MESO_NO_INDEX)
            return meso_fail(error, MESO_ERR_INPUT, "cross-sections of several interfaces have the name '%s': give "
                             "INTERFACE/SECTION", name);
        *found = i;
    }
    if (!name)
        *found = 0;
    return *found != MESO_NO_INDEX ? MESO_OK : no_section(set, name, error);
}

/* ---- prisms ---- */

typedef struct Prism {
    MesoVec3 *positions, *normals;
    MesoVec2 *uvs;
    uint32_t *corners;
    uint32_t vertex_count, face_count;
} Prism;

/* Outward of the way from a to b, where material is to the left: of unit length. */
static MesoVec2 side_normal(MesoVec2 a, MesoVec2 b)
{
    float x = b.y - a.y, y = a.x - b.x, length = sqrtf(x * x + y * y);
    return length > 0 ? (MesoVec2){x / length, y / length} : (MesoVec2){0, 1};
}

/* The normal of a side at a point that it shares with another: of both where the corner is not sharp. */
static MesoVec2 shared_normal(MesoVec2 own, MesoVec2 other)
{
    MesoVec2 sum = {own.x + other.x, own.y + other.y};
    float length = sqrtf(sum.x * sum.x + sum.y * sum.y);
    bool sharp = own.x * other.x + own.y * other.y < SHARP_COSINE;
    return sharp || !(length > 0) ? own : (MesoVec2){sum.x / length, sum.y / length};
}

static void put_point(Prism *prism, MesoVec2 at, MesoVec2 normal, float u)
{
    for (uint32_t ring = 0; ring < RINGS; ring++) {
        float x = (float)ring / (RINGS - 1);
        prism->positions[prism->vertex_count] = (MesoVec3){x, -at.x, at.y};
        prism->normals[prism->vertex_count] = (MesoVec3){0, -normal.x, normal.y};
        prism->uvs[prism->vertex_count++] = (MesoVec2){u, x};
    }
}

/* Quads between two columns of points, as triangles, seen from outside. */
static void put_faces(Prism *prism, uint32_t a, uint32_t b)
{
    for (uint32_t ring = 0; ring + 1 < RINGS; ring++) {
        const uint32_t corners[6] = {a + ring, a + ring + 1, b + ring, b + ring, a + ring + 1, b + ring + 1};
        memcpy(prism->corners + 3 * (size_t)prism->face_count, corners, sizeof corners);
        prism->face_count += 2;
    }
}

static void put_contour(Prism *prism, const MesoVec2 *points, uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        MesoVec2 before = points[(i + count - 1) % count], a = points[i];
        MesoVec2 b = points[(i + 1) % count], after = points[(i + 2) % count];
        MesoVec2 own = side_normal(a, b);
        uint32_t first = prism->vertex_count;
        put_point(prism, a, shared_normal(own, side_normal(before, a)), (float)i / (float)count);
        put_point(prism, b, shared_normal(own, side_normal(b, after)), (float)(i + 1) / (float)count);
        put_faces(prism, first, first + RINGS);
    }
}

static bool prism_room(Prism *prism, MesoArena *arena, size_t points, MesoError *error)
{
    prism->positions = MESO_NEW(arena, MesoVec3, 2 * RINGS * points, error);
    prism->normals = MESO_NEW(arena, MesoVec3, 2 * RINGS * points, error);
    prism->uvs = MESO_NEW(arena, MesoVec2, 2 * RINGS * points, error);
    prism->corners = MESO_NEW(arena, uint32_t, 6 * (RINGS - 1) * points, error);
    return prism->positions && prism->normals && prism->uvs && prism->corners;
}

MesoStatus meso_grow_section(MesoTerminalShape *shape, uint32_t *section, MesoArena *arena, const MesoTileSet *set,
                             const char *name, MesoError *error)
{
    MesoContourSet contours;
    Prism prism = {0};
    MesoStatus status = find_section(section, set, name, error);
    if (!status)
        status = meso_contour_set_build(&contours, arena, set, SAMPLING_STEP, error);
    if (status)
        return status;
    uint32_t begin = contours.section_begin[*section], end = contours.section_begin[*section + 1];
    size_t points = 0;
    for (uint32_t c = begin; c < end; c++)
        points += contours.contours[c].point_count;
    if (points == 0)
        return meso_fail(error, MESO_ERR_INPUT, "the drawing of cross-section '%s' has no area",
                         set->sections[*section].name);
    if (!prism_room(&prism, arena, points, error))
        return MESO_ERR_MEMORY;
    for (uint32_t c = begin; c < end; c++)
        put_contour(&prism, contours.points + contours.contours[c].point_begin, contours.contours[c].point_count);
    const MesoBody body = {.vertex_count = prism.vertex_count, .face_count = prism.face_count, .face_width = 3,
                           .positions = prism.positions, .normals = prism.normals, .uvs = prism.uvs,
                           .corners = prism.corners};
    return meso_terminal_shape_build(shape, arena, &body, MESO_SHAPE_ALONG_X, error);
}
