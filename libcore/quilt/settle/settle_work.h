/* What settling shares: kinds of bodies, bodies, and who is near. */
#ifndef MESO_SETTLE_WORK_H
#define MESO_SETTLE_WORK_H

#include "libcore/quilt/settle/quilt_settle.h"
#include "libcore/quilt/settle/sphere_tree.h"

/* Where another body stands in the swatch. */
typedef struct MesoSettleRelation {
    uint32_t kind;
    MesoVec3 offset;            /* from centre to centre, in the surface's units */
} MesoSettleRelation;

/* How far points spread from a centre, which is alike where shapes stand alike: means of xx, yy, zz, xy, xz, yz. */
typedef struct MesoSettleSpread {
    float of[6];
} MesoSettleSpread;

/* A whole element of the swatch, with the smaller ones that stand in it. Lengths are in the surface's units. */
typedef struct MesoSettleKind {
    uint32_t member_begin, member_end;      /* in members: the element itself, then what it carries */
    uint32_t point_count, triangle_count;
    MesoVec3 *points;           /* [point_count] from the element's centre, member by member */
    uint32_t *corners;          /* [3 * triangle_count] */
    MesoSphereTree spheres;
    float reach;                /* of its points from the centre */
    float height;               /* of the centre above the surface */
    uint32_t root;              /* the point where it grows from a strand, or MESO_NO_INDEX */
    MesoSettleSpread spread;
    uint32_t likeness;          /* the first kind that spreads like it */
    uint32_t relation_begin, relation_end;
} MesoSettleKind;

typedef struct MesoSettleBody {
    uint32_t kind, patch;
    uint32_t element;           /* of the quilt, or MESO_NO_INDEX where it is added */
    MesoPose pose;              /* axes of the swatch, and the element's centre, in space */
    MesoQuiltVertex place;      /* of the centre */
    MesoVec3 root;              /* below the centre, where distances are those of the swatch */
    MesoVec3 *points;           /* [of the kind] in space, where it is not rigid; else NULL */
    int32_t cell[3];
    uint32_t next;              /* in the same bucket, or MESO_NO_INDEX */
    bool gone;
    bool stays;                 /* it lies at a border, and is not moved */
    bool settled;               /* it is known to cut nothing, or that it cannot be helped */
    uint32_t friends;           /* those around it that stand as in the swatch, once they are counted */
} MesoSettleBody;

typedef struct MesoSettleWork {
    const MesoTriangulation *surface;
    const MesoSwatch *swatch;
    MesoSettleOptions options;  /* with defaults filled in */
    MesoVec3 *directions;       /* [surface->vertex_count] */
    float low, high;            /* heights that the layer can have */
    uint32_t kind_count, relation_count, member_count;
    MesoSettleKind *kinds;      /* [kind_count] */
    MesoSettleRelation *relations;
    uint32_t *members;          /* [member_count] elements of the swatch */
    uint32_t *kind_of;          /* [swatch->element_count] that it is the first member of, or MESO_NO_INDEX */
    float spacing;              /* mean distance of a body of the swatch from the nearest one; 0: there is one alone */
    float reach;                /* the largest of any kind */
    bool alone;                 /* there are no strands */
    bool linked;                /* bodies reach through or under each other */
    bool fixed;                 /* they stay where the quilt has them, and bend with the layer */
    bool careful;               /* what is added may cut nothing from the first */
    uint32_t body_count, body_room;
    MesoSettleBody *bodies;     /* [body_count] */
    uint32_t *buckets, mask;    /* first body by hash of the cell */
    float cell;
    MesoArena *arena;           /* of all this */
} MesoSettleWork;

static inline MesoVec3 meso_settle_to_space(const MesoPose *f, MesoVec3 p)
{
    return meso_vec3_mad(meso_vec3_mad(meso_vec3_scale(f->x, p.x), p.y, f->y), p.z, f->z);
}

static inline MesoVec3 meso_settle_from_space(const MesoPose *f, MesoVec3 p)
{
    return (MesoVec3){meso_vec3_dot(p, f->x), meso_vec3_dot(p, f->y), meso_vec3_dot(p, f->z)};
}

/* ---- the layer ---- */

/*
 * The place that the layer has at `point`: walks from the triangle that *place has. Beyond a border it goes on straight;
 * `beyond` says how far. False where no place is found.
 */
bool meso_settle_locate(MesoQuiltVertex *place, float *beyond, const MesoSettleWork *work, MesoVec3 point);

/* Where a place is, and the unit direction in which the layer rises there. */
MesoVec3 meso_settle_point(const MesoSettleWork *work, MesoQuiltVertex place);
MesoVec3 meso_settle_up(const MesoSettleWork *work, MesoQuiltVertex place);

/* ---- kinds and bodies ---- */

MesoStatus meso_settle_find_kinds(MesoSettleWork *work, MesoError *error);

/* The bodies of a quilt as they lie in space, `positions` [quilt->vertex_count]. */
MesoStatus meso_settle_find_bodies(MesoSettleWork *work, const MesoQuilt *quilt, const MesoVec3 *positions,
                                   MesoError *error);

/* Room for one more; where it stands is set, and it is listed in its cell. MESO_NO_INDEX with `error` filled. */
uint32_t meso_settle_add_body(MesoSettleWork *work, const MesoSettleBody *body, MesoError *error);

/* Where a point of its kind is. */
static inline MesoVec3 meso_settle_body_point(const MesoSettleWork *work, const MesoSettleBody *body, uint32_t point)
{
    if (body->points)
        return body->points[point];
    return meso_vec3_add(body->pose.origin,
                         meso_settle_to_space(&body->pose, work->kinds[body->kind].points[point]));
}

/*
 * Makes a body as the layer bends it, `positions` [point_count of its kind], but of nearly the volume that it has in the
 * swatch. One that carries others stays as it is.
 */
MesoStatus meso_settle_bend(MesoSettleBody *body, const MesoSettleWork *work, const MesoVec3 *positions, MesoError *error);

/* A body's root, of its place. */
void meso_settle_set_root(const MesoSettleWork *work, MesoSettleBody *body);

/* Moves a body along the layer, its root to where it is nearest to `to`, turned with the layer; false, and it stays, where
 * the surface ends before. */
bool meso_settle_move(const MesoSettleWork *work, MesoSettleBody *body, MesoVec3 to);

/* Lists a body by its centre anew. */
void meso_settle_list(MesoSettleWork *work, uint32_t body);

/* Bodies whose cells are around a point, those that are gone left out: at most `room`, in an order that does not depend on
 * addresses. Cells are as wide as bodies near each other are apart, and two bodies that touch. */
uint32_t meso_settle_near(uint32_t *found, uint32_t room, const MesoSettleWork *work, MesoVec3 point);

enum { MESO_SETTLE_NEAR = 256 };

/* ---- steps ---- */

/* Moves a body towards the places that its neighbours would have it in, by one step; `itself` is no neighbour. True where
 * it has moved: it is not listed anew. */
bool meso_settle_relax_body(const MesoSettleWork *work, MesoSettleBody *body, uint32_t itself);

/* Turns a body around its own z; the part of a way that runs along the layer below it. */
void meso_settle_turn(MesoSettleBody *body, float sine);
MesoVec3 meso_settle_along(const MesoSettleWork *work, const MesoSettleBody *body, MesoVec3 way);

/* The same for all, again and again. */
void meso_settle_relax(MesoSettleWork *work, uint32_t rounds);

/* Adds bodies where the swatch would have them and there is room. */
MesoStatus meso_settle_fill(MesoSettleWork *work, MesoError *error);

/* Bodies that cut others give way; of those that still do, such that were added go. */
void meso_settle_part(MesoSettleWork *work);

/* The same of linked ones, but for what was added: of two in each other's place, that goes which has fewer friends. */
void meso_settle_push(MesoSettleWork *work);

/* How many pairs of triangles of a body and of its neighbours cross, up to `most`; rigid ones. */
uint32_t meso_settle_crossings(const MesoSettleWork *work, const MesoSettleBody *body, uint32_t itself, uint32_t most);

/* Whether a body, rigid or not, cuts another one. */
MesoStatus meso_settle_meets(bool *meets, const MesoSettleWork *work, const MesoSettleBody *body, MesoError *error);

/*
 * The relation of a kind that is nearest to an offset in the swatch's plane, within `most`, to something that spreads
 * like `spread`; MESO_NO_INDEX: none.
 */
uint32_t meso_settle_relation(const MesoSettleWork *work, uint32_t kind, const MesoSettleSpread *spread,
                              MesoVec2 offset, float most);

/* How a body spreads by given axes. */
MesoSettleSpread meso_settle_spread(const MesoSettleWork *work, const MesoSettleBody *body, const MesoPose *axes);
bool meso_settle_alike(const MesoSettleSpread *a, const MesoSettleSpread *b);

/* Finds kinds that are like each other, and gives those at the sides of the tile what all others like them have around
 * them. */
MesoStatus meso_settle_borrow(MesoSettleWork *work, MesoError *error);

/* Whether one body stands around another one as in the swatch, within a share of the spacing. */
bool meso_settle_is_meant(const MesoSettleWork *work, const MesoSettleBody *from, const MesoSettleBody *to, float most);

/* Bodies on sides of the surface that face each other have nothing to do with each other. */
static inline bool meso_settle_same_side(const MesoSettleBody *a, const MesoSettleBody *b)
{
    return meso_vec3_dot(a->pose.z, b->pose.z) > 0.3f;
}

/* From one body to another, in the plane of the first one, as far as their roots are apart. */
MesoVec2 meso_settle_offset(const MesoSettleBody *from, const MesoSettleBody *to);

#endif
