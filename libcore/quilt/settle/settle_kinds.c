/* Kinds of bodies: whole elements of the swatch with what they carry, and how they stand around each other. */
#include <string.h>

#include "libcore/quilt/settle/settle_work.h"
#include "libcore/quilt/whole_roots.h"

/* An element is carried by another one whose reach is more than twice its own, and within half of which its centre stands. */
#define CARRIED 0.5f

/* Bodies whose centres are nearer than that, as a share of how far both reach, are linked, or lie over each other. */
#define LINKED 0.85f

/* Bodies stand around each other up to so many times the distance from the nearest one. */
#define AROUND 1.6f

static float distance_in_plane(MesoVec3 a, MesoVec3 b)
{
    return meso_vec2_length((MesoVec2){a.x - b.x, a.y - b.y});
}

/* The element that carries another one; itself where none does. */
static uint32_t carrier_of(const MesoSwatch *swatch, uint32_t element)
{
    uint32_t best = element;
    float least = INFINITY;
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        float d = distance_in_plane(swatch->centres[e], swatch->centres[element]);
        if (swatch->kinds[e] == MESO_ELEMENT_WHOLE && swatch->radii[element] < CARRIED * swatch->radii[e] &&
            d < CARRIED * swatch->radii[e] && d < least) {
            best = e;
            least = d;
        }
    }
    return best;
}

static MesoVec3 measured(const MesoSettleWork *work, MesoVec3 p)
{
    const MesoSettleOptions *o = &work->options;
    return (MesoVec3){p.x * o->scale, p.y * o->scale, p.z * o->height_scale};
}

/* Members of kinds, those that carry first; `carriers` [element_count], MESO_NO_INDEX of strands. */
static void list_members(MesoSettleWork *work, const uint32_t *carriers)
{
    const MesoSwatch *swatch = work->swatch;
    for (uint32_t e = 0; e < swatch->element_count; e++) {
        work->kind_of[e] = MESO_NO_INDEX;
        if (carriers[e] != e)
            continue;
        MesoSettleKind *kind = &work->kinds[work->kind_count];
        work->kind_of[e] = work->kind_count++;
        kind->member_begin = work->member_count;
        work->members[work->member_count++] = e;
        for (uint32_t f = 0; f < swatch->element_count; f++)
            if (f != e && carriers[f] == e)
                work->members[work->member_count++] = f;
        kind->member_end = work->member_count;
    }
}

static MesoStatus shape_kind(MesoSettleWork *work, MesoSettleKind *kind, MesoError *error)
{
    const MesoSwatch *swatch = work->swatch;
    MesoVec3 centre = swatch->centres[work->members[kind->member_begin]];
    for (uint32_t m = kind->member_begin; m < kind->member_end; m++) {
        uint32_t e = work->members[m];
        kind->point_count += swatch->vertex_begin[e + 1] - swatch->vertex_begin[e];
        kind->triangle_count += swatch->triangle_begin[e + 1] - swatch->triangle_begin[e];
    }
    kind->points = MESO_NEW(work->arena, MesoVec3, kind->point_count, error);
    kind->corners = MESO_NEW(work->arena, uint32_t, 3 * (size_t)kind->triangle_count, error);
    if (!kind->points || !kind->corners)
        return MESO_ERR_MEMORY;
    uint32_t points = 0, corners = 0;
    for (uint32_t m = kind->member_begin; m < kind->member_end; m++) {
        uint32_t e = work->members[m], first = points;
        for (uint32_t v = swatch->vertex_begin[e]; v < swatch->vertex_begin[e + 1]; v++) {
            MesoVec3 p = kind->points[points++] = measured(work, meso_vec3_sub(swatch->positions[v], centre));
            kind->reach = fmaxf(kind->reach, meso_vec3_length(p));
        }
        for (uint32_t c = 3 * swatch->triangle_begin[e]; c < 3 * swatch->triangle_begin[e + 1]; c++)
            kind->corners[corners++] = swatch->corners[c] - swatch->vertex_begin[e] + first;
    }
    kind->height = work->options.offset + work->options.height_scale * centre.z;
    work->reach = fmaxf(work->reach, kind->reach);
    return meso_sphere_tree_build(&kind->spheres, work->arena, kind->points, kind->corners, kind->triangle_count, error);
}

/* ---- relations ---- */

/* Offsets to another kind, and to its copies in the tiles around. */
typedef struct Images {
    MesoVec3 offsets[9];
    uint32_t count;
} Images;

static Images images_of(const MesoSettleWork *work, uint32_t from, uint32_t to)
{
    const MesoSwatch *swatch = work->swatch;
    MesoVec3 a = swatch->centres[work->members[work->kinds[from].member_begin]];
    MesoVec3 b = swatch->centres[work->members[work->kinds[to].member_begin]];
    int x = swatch->periodic_x, y = swatch->periodic_y;
    Images images = {.count = 0};
    for (int j = -y; j <= y; j++)
        for (int i = -x; i <= x; i++)
            if (from != to || i || j) {
                MesoVec3 move = {(float)i * swatch->size.x, (float)j * swatch->size.y, 0};
                images.offsets[images.count++] = measured(work, meso_vec3_add(meso_vec3_sub(b, a), move));
            }
    return images;
}

static float length_in_plane(MesoVec3 p)
{
    return meso_vec2_length((MesoVec2){p.x, p.y});
}

/* Mean distance from the nearest other one. */
static float find_spacing(const MesoSettleWork *work)
{
    double sum = 0;
    uint32_t count = 0;
    for (uint32_t k = 0; k < work->kind_count; k++) {
        float least = INFINITY;
        for (uint32_t l = 0; l < work->kind_count; l++) {
            Images images = images_of(work, k, l);
            for (uint32_t i = 0; i < images.count; i++)
                least = fminf(least, length_in_plane(images.offsets[i]));
        }
        if (least < INFINITY) {
            sum += (double)least;
            count++;
        }
    }
    return count ? (float)(sum / count) : 0;
}

/* Those within reach; only counted where `relations` is NULL. */
static uint32_t list_relations(MesoSettleRelation *relations, const MesoSettleWork *work, uint32_t kind)
{
    uint32_t count = 0;
    for (uint32_t l = 0; l < work->kind_count; l++) {
        Images images = images_of(work, kind, l);
        for (uint32_t i = 0; i < images.count; i++) {
            if (length_in_plane(images.offsets[i]) > AROUND * work->spacing)
                continue;
            if (relations)
                relations[count] = (MesoSettleRelation){l, images.offsets[i]};
            count++;
        }
    }
    return count;
}

/* Whether bodies of the swatch cut each other as they stand there. */
static bool cuts_itself(const MesoSettleWork *work)
{
    const MesoPose here = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    for (uint32_t k = 0; k < work->kind_count; k++)
        for (uint32_t r = work->kinds[k].relation_begin; r < work->kinds[k].relation_end; r++) {
            MesoPose there = here;
            there.origin = work->relations[r].offset;
            if (meso_sphere_trees_crossings(&work->kinds[k].spheres, &here,
                                            &work->kinds[work->relations[r].kind].spheres, &there, 1))
                return true;
        }
    return false;
}

/* Whether most of them have another one so near. */
static bool are_linked(const MesoSettleWork *work)
{
    uint32_t linked = 0;
    for (uint32_t k = 0; k < work->kind_count; k++) {
        float radius = work->swatch->radii[work->members[work->kinds[k].member_begin]] * work->options.scale;
        bool is = false;
        for (uint32_t r = work->kinds[k].relation_begin; r < work->kinds[k].relation_end; r++) {
            const MesoSettleKind *other = &work->kinds[work->relations[r].kind];
            float both = radius + work->swatch->radii[work->members[other->member_begin]] * work->options.scale;
            is |= length_in_plane(work->relations[r].offset) < LINKED * both;
        }
        linked += is;
    }
    return 2 * linked > work->kind_count;
}

static MesoStatus find_relations(MesoSettleWork *work, MesoError *error)
{
    work->spacing = find_spacing(work);
    for (uint32_t k = 0; k < work->kind_count; k++) {
        work->kinds[k].relation_begin = work->relation_count;
        work->relation_count += list_relations(NULL, work, k);
        work->kinds[k].relation_end = work->relation_count;
    }
    work->relations = MESO_NEW(work->arena, MesoSettleRelation, work->relation_count, error);
    if (!work->relations)
        return MESO_ERR_MEMORY;
    for (uint32_t k = 0; k < work->kind_count; k++)
        list_relations(&work->relations[work->kinds[k].relation_begin], work, k);
    work->linked = are_linked(work);
    work->fixed = work->careful = work->linked && (!work->alone || cuts_itself(work));
    return meso_settle_borrow(work, error);
}

MesoStatus meso_settle_find_kinds(MesoSettleWork *work, MesoError *error)
{
    uint32_t count = work->swatch->element_count;
    uint32_t *carriers = MESO_NEW(work->arena, uint32_t, count, error);
    uint32_t *roots = MESO_NEW(work->arena, uint32_t, count, error);
    work->kinds = MESO_NEW(work->arena, MesoSettleKind, count, error);
    work->members = MESO_NEW(work->arena, uint32_t, count, error);
    work->kind_of = MESO_NEW(work->arena, uint32_t, count, error);
    if (!carriers || !roots || !work->kinds || !work->members || !work->kind_of)
        return MESO_ERR_MEMORY;
    for (uint32_t e = 0; e < count; e++)
        carriers[e] = work->swatch->kinds[e] == MESO_ELEMENT_WHOLE ? carrier_of(work->swatch, e) : MESO_NO_INDEX;
    for (uint32_t e = 0; e < count; e++)    /* what is carried carries nothing */
        if (carriers[e] != MESO_NO_INDEX && carriers[e] != e && carriers[carriers[e]] != carriers[e])
            carriers[e] = carriers[carriers[e]];
    list_members(work, carriers);
    MesoStatus status = MESO_OK;
    meso_whole_roots(roots, work->swatch);
    for (uint32_t k = 0; k < work->kind_count && !status; k++) {
        MesoSettleKind *kind = &work->kinds[k];
        uint32_t first = work->members[kind->member_begin], root = roots[first];
        kind->root = root == MESO_NO_INDEX ? root : root - work->swatch->vertex_begin[first];
        status = shape_kind(work, kind, error);
    }
    return status ? status : find_relations(work, error);
}

uint32_t meso_settle_relation(const MesoSettleWork *work, uint32_t kind, const MesoSettleSpread *spread,
                              MesoVec2 offset, float most)
{
    uint32_t best = MESO_NO_INDEX;
    float least = most * most;
    for (uint32_t r = work->kinds[kind].relation_begin; r < work->kinds[kind].relation_end; r++) {
        float x = work->relations[r].offset.x - offset.x, y = work->relations[r].offset.y - offset.y;
        if (x * x + y * y < least && meso_settle_alike(&work->kinds[work->relations[r].kind].spread, spread)) {
            least = x * x + y * y;
            best = r;
        }
    }
    return best;
}
