/*
 * Composite: the quilt while it grows. Strands are one soup of triangles, found
 * by the triangle of the base under their first corner; whole elements are
 * copies that stay together and are found by the triangle under their centre.
 * What is taken away is marked dead, and goes when the composite is packed.
 */
#ifndef MESO_COMPOSITE_H
#define MESO_COMPOSITE_H

#include "libcore/quilt/quilt.h"

/* A whole element where it was placed. */
typedef struct MesoPlacedWhole {
    uint32_t element;           /* of the swatch */
    uint32_t vertex_begin;      /* in whole_vertices */
    uint32_t patch;
    uint32_t next;              /* under the same triangle; MESO_NO_INDEX at the end */
    MesoQuiltVertex centre;
    bool dead;
} MesoPlacedWhole;

typedef struct MesoComposite {
    uint32_t vertex_count, triangle_count, whole_count, whole_vertex_count;
    uint32_t vertex_room, triangle_room, whole_room, whole_vertex_room;
    MesoQuiltVertex *vertices;  /* [vertex_count] of strands */
    uint32_t *vertex_origins;   /* [vertex_count] vertex of the swatch */
    uint32_t *marks;            /* [vertex_count] MESO_NO_INDEX between steps: numbers in a step */
    uint32_t *corners;          /* [3 * triangle_count]; the first is MESO_NO_INDEX where it is dead */
    uint32_t *triangle_origins; /* [triangle_count] triangle of the swatch */
    uint32_t *patches;          /* [triangle_count] */
    uint32_t *next;             /* [triangle_count] under the same triangle of the base */
    MesoPlacedWhole *wholes;    /* [whole_count] */
    MesoQuiltVertex *whole_vertices;
    uint32_t *caps;             /* [cap_count] the first triangle of each cap */
    uint32_t cap_count, cap_room;
    uint32_t base_count;
    uint32_t *triangle_head, *whole_head;   /* [base_count] by triangle of the base, or MESO_NO_INDEX */
    uint32_t triangle_limit, whole_vertex_limit;    /* beyond these it is packed */
} MesoComposite;

MesoStatus meso_composite_init(MesoComposite *composite, uint32_t base_count, MesoError *error);
void meso_composite_release(MesoComposite *composite);

/* Each makes room for one more first. The number of what is new, or MESO_NO_INDEX with `error` filled. Amortised O(1). */
uint32_t meso_composite_add_vertex(MesoComposite *composite, MesoQuiltVertex vertex, uint32_t origin, MesoError *error);
uint32_t meso_composite_add_triangle(MesoComposite *composite, const uint32_t *corners, uint32_t origin, uint32_t patch,
                                     MesoError *error);
/* Its `vertices` [count] are copied. */
uint32_t meso_composite_add_whole(MesoComposite *composite, uint32_t element, uint32_t patch, MesoQuiltVertex centre,
                                  const MesoQuiltVertex *vertices, uint32_t count, MesoError *error);

/* Remembers the cap that begins with a triangle. */
MesoStatus meso_composite_add_cap(MesoComposite *composite, uint32_t triangle, MesoError *error);

static inline bool meso_composite_is_dead(const MesoComposite *composite, uint32_t triangle)
{
    return composite->corners[3 * (size_t)triangle] == MESO_NO_INDEX;
}

/* Takes dead triangles and elements out of the lists under a triangle of the base. */
void meso_composite_tidy(MesoComposite *composite, uint32_t base_triangle);

/* Whether meso_composite_pack() would do anything, which takes room for a while. */
static inline bool meso_composite_wants_packing(const MesoComposite *composite)
{
    return composite->triangle_count > composite->triangle_limit ||
           composite->whole_vertex_count > composite->whole_vertex_limit;
}

/*
 * Between steps: where there is so much of it that it is worth while, what is dead makes room for what comes, and all
 * else has other numbers, in the same order. O(1) on the mean for each that was added.
 */
void meso_composite_pack(MesoComposite *composite, const MesoSwatch *swatch);

/* What lives, by element: connected triangles, and whole elements. To `arena`. O(all). MESO_ERR_LIMIT, _MEMORY. */
MesoStatus meso_composite_finish(MesoQuilt *quilt, MesoArena *arena, const MesoComposite *composite,
                                 const MesoSwatch *swatch, MesoError *error);

#endif
