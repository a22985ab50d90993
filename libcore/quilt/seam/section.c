#include "libcore/quilt/seam/section.h"

static MesoVec3 point_of(const MesoSection *section, uint32_t place)
{
    return section->positions[section->vertices[place]];
}

void meso_section_measure(MesoSection *section)
{
    section->length = section->reach = 0;
    section->centre = section->area = (MesoVec3){0, 0, 0};
    MesoVec3 first = point_of(section, 0), sum = {0, 0, 0};
    for (uint32_t i = 0; i < section->count; i++) {
        MesoVec3 a = meso_vec3_sub(point_of(section, i), first);
        MesoVec3 b = meso_vec3_sub(point_of(section, (i + 1) % section->count), first);
        float length = meso_vec3_length(meso_vec3_sub(b, a));
        sum = meso_vec3_mad(sum, 0.5f * length, meso_vec3_add(a, b));
        section->area = meso_vec3_mad(section->area, 0.5f, meso_vec3_cross(b, a));
        section->length += length;
    }
    section->centre = section->length > 0 ? meso_vec3_mad(first, 1 / section->length, sum) : first;
    for (uint32_t i = 0; i < section->count; i++) {
        float distance = meso_vec3_length(meso_vec3_sub(point_of(section, i), section->centre));
        section->reach = distance > section->reach ? distance : section->reach;
    }
}

/* Vertex of `b` that is `steps` against its direction from `from`. */
static uint32_t backwards(const MesoSection *b, uint32_t from, uint32_t steps)
{
    return (from + b->count - steps % b->count) % b->count;
}

uint32_t meso_section_align(const MesoSection *a, const MesoSection *b)
{
    uint32_t best = 0;
    float least = INFINITY;
    for (uint32_t j = 0; j < b->count; j++) {
        float sum = 0;
        for (uint32_t i = 0; i < a->count; i++) {
            uint32_t across = backwards(b, j, (uint32_t)((uint64_t)i * b->count / a->count));
            MesoVec3 p = meso_vec3_sub(point_of(a, i), a->centre);
            MesoVec3 q = meso_vec3_sub(point_of(b, across), b->centre);
            MesoVec3 d = meso_vec3_sub(p, q);
            sum += meso_vec3_dot(d, d);
        }
        if (sum < least) {
            least = sum;
            best = j;
        }
    }
    return best;
}

static float side_length(const MesoSection *section, uint32_t from, uint32_t to)
{
    return meso_vec3_length(meso_vec3_sub(point_of(section, from), point_of(section, to)));
}

void meso_section_across(MesoVec3 *points, const MesoSection *a, const MesoSection *b, uint32_t aligned)
{
    float scale = a->length > 0 ? b->length / a->length : 0;
    float wanted = 0, begin = 0;
    uint32_t step = 0, at = aligned, next = backwards(b, aligned, 1);
    float side = side_length(b, at, next);
    for (uint32_t i = 0; i < a->count; i++) {
        while (begin + side < wanted && step + 1 < b->count) {
            begin += side;
            step++;
            at = next;
            next = backwards(b, aligned, step + 1);
            side = side_length(b, at, next);
        }
        float share = side > 0 ? (wanted - begin) / side : 0;
        points[i] = meso_vec3_lerp(point_of(b, at), point_of(b, next), share < 1 ? share : 1);
        wanted += scale * side_length(a, i, (i + 1) % a->count);
    }
}

static float gap(const MesoSection *a, const MesoSection *b, uint32_t i, uint32_t j, MesoVec3 apart)
{
    MesoVec3 d = meso_vec3_sub(meso_vec3_sub(point_of(a, i), point_of(b, j)), apart);
    return meso_vec3_dot(d, d);
}

void meso_section_zip(uint32_t *corners, const MesoSection *a, const MesoSection *b, uint32_t aligned,
                      uint32_t b_offset)
{
    MesoVec3 apart = meso_vec3_sub(a->centre, b->centre);
    uint32_t i = 0, j = 0;
    while (i < a->count || j < b->count) {
        uint32_t at = i % a->count, after = (i + 1) % a->count;
        uint32_t across = backwards(b, aligned, j), beyond = backwards(b, aligned, j + 1);
        /* the shorter of both diagonals; but neither side runs ahead by a quarter, or the ring would meet itself */
        int64_t lead = (int64_t)i * b->count - (int64_t)j * a->count, limit = (int64_t)a->count * b->count / 4;
        bool along = j == b->count || (i < a->count && lead <= limit &&
                                       (lead < -limit || gap(a, b, after, across, apart) <= gap(a, b, at, beyond, apart)));
        if (along) {
            *corners++ = a->vertices[after];
            *corners++ = a->vertices[at];
            *corners++ = b->vertices[across] + b_offset;
            i++;
        } else {
            *corners++ = b->vertices[across] + b_offset;
            *corners++ = b->vertices[beyond] + b_offset;
            *corners++ = a->vertices[at];
            j++;
        }
    }
}

/* ---- caps ---- */

typedef struct Flat {
    const MesoVec2 *places;
    uint32_t *ring;     /* what is left, in the cap's direction */
    uint32_t count;
} Flat;

static float turn(MesoVec2 a, MesoVec2 b, MesoVec2 c)
{
    return meso_vec2_cross(meso_vec2_sub(b, a), meso_vec2_sub(c, a));
}

static bool is_ear(const Flat *flat, uint32_t k)
{
    uint32_t before = flat->ring[(k + flat->count - 1) % flat->count], at = flat->ring[k];
    uint32_t after = flat->ring[(k + 1) % flat->count];
    MesoVec2 a = flat->places[before], b = flat->places[at], c = flat->places[after];
    if (turn(a, b, c) <= 0)
        return false;
    for (uint32_t i = 0; i < flat->count; i++) {
        uint32_t other = flat->ring[i];
        MesoVec2 p = flat->places[other];
        if (other != before && other != at && other != after && turn(a, b, p) >= 0 && turn(b, c, p) >= 0 &&
            turn(c, a, p) >= 0)
            return false;
    }
    return true;
}

MesoStatus meso_section_cap(uint32_t *corners, MesoArena *scratch, const MesoSection *section, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoVec2 *places = MESO_NEW(scratch, MesoVec2, section->count, error);
    uint32_t *ring = MESO_NEW(scratch, uint32_t, section->count, error);
    if (!places || !ring)
        return MESO_ERR_MEMORY;
    MesoVec3 normal = meso_vec3_unit(section->area, (MesoVec3){0, 0, 1});
    MesoVec3 other = fabsf(normal.x) < 0.6f ? (MesoVec3){1, 0, 0} : (MesoVec3){0, 1, 0};
    MesoVec3 x = meso_vec3_unit(meso_vec3_cross(other, normal), other), y = meso_vec3_cross(normal, x);
    for (uint32_t i = 0; i < section->count; i++) {
        MesoVec3 p = meso_vec3_sub(point_of(section, i), section->centre);
        places[i] = (MesoVec2){meso_vec3_dot(p, x), meso_vec3_dot(p, y)};
        ring[i] = section->count - 1 - i;   /* against the loop: with the cap */
    }
    Flat flat = {places, ring, section->count};
    while (flat.count > 2) {
        uint32_t ear = 0;
        while (ear < flat.count && !is_ear(&flat, ear))
            ear++;
        ear = ear < flat.count ? ear : 0;
        *corners++ = section->vertices[ring[(ear + flat.count - 1) % flat.count]];
        *corners++ = section->vertices[ring[ear]];
        *corners++ = section->vertices[ring[(ear + 1) % flat.count]];
        flat.count--;
        for (uint32_t i = ear; i < flat.count; i++)
            ring[i] = ring[i + 1];
    }
    meso_arena_rewind(scratch, mark);
    return MESO_OK;
}

/* ---- strips ---- */

/* There and back may be longer than straight ahead by so much. */
#define WINDING_MOST 1.2f

/* From one end of a strip to the other, by both sides. */
typedef struct Strip {
    const MesoSection *section;
    const MesoVec2 *places;
    uint32_t first, last;       /* in the section */
} Strip;

/* The point so many steps from the first one, with the section or against it. */
static uint32_t along_strip(const Strip *strip, uint32_t steps, bool against)
{
    uint32_t count = strip->section->count;
    return (strip->first + (against ? count - steps : steps)) % count;
}

static bool find_ends(Strip *strip)
{
    const MesoVec2 *places = strip->places;
    uint32_t count = strip->section->count;
    float length = 0;
    for (uint32_t i = 0; i < count; i++) {
        strip->first = places[i].x < places[strip->first].x ? i : strip->first;
        strip->last = places[i].x > places[strip->last].x ? i : strip->last;
        length += fabsf(places[(i + 1) % count].x - places[i].x);
    }
    return length <= WINDING_MOST * 2 * (places[strip->last].x - places[strip->first].x);
}

static void add_corners(uint32_t **corners, const Strip *strip, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t *vertices = strip->section->vertices;
    *(*corners)++ = vertices[a];
    *(*corners)++ = vertices[b];
    *(*corners)++ = vertices[c];
}

bool meso_section_strip(uint32_t *corners, const MesoSection *section, const MesoVec2 *places)
{
    Strip strip = {.section = section, .places = places};
    if (section->count < 3 || !find_ends(&strip))
        return false;
    uint32_t with_count = (strip.last + section->count - strip.first) % section->count;
    uint32_t against_count = section->count - with_count, i = 1, j = 1;
    add_corners(&corners, &strip, along_strip(&strip, 1, false), strip.first, along_strip(&strip, 1, true));
    while (i + j + 1 < section->count) {
        uint32_t at = along_strip(&strip, i, false), across = along_strip(&strip, j, true);
        uint32_t after = along_strip(&strip, i + 1, false), beyond = along_strip(&strip, j + 1, true);
        if (j == against_count || (i < with_count && places[after].x <= places[beyond].x)) {
            add_corners(&corners, &strip, after, at, across);
            i++;
        } else {
            add_corners(&corners, &strip, across, beyond, at);
            j++;
        }
    }
    return true;
}
