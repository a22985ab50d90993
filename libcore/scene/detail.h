/*
 * Level of detail: how many columns and rings of a kind a picture needs, so
 * that what is drawn stays within a tolerance of the kind's own surface.
 */
#ifndef MESO_DETAIL_H
#define MESO_DETAIL_H

#include "libcore/scene/cell.h"

/*
 * Thins the columns of a kind.
 *
 * columns    [count]
 * tolerance  how far a dropped profile point may lie from the line that
 *            replaces it, in units of the profiles; 0 keeps all
 * kept       [count] gets ascending indices; kept[k] joins kept[k + 1] where
 *            columns[kept[k]] joins its next
 *
 * Ends of runs stay; normals of neighbours stay within 75 degrees. Returns the
 * number kept. O(count).
 */
uint32_t meso_detail_columns(const MesoSweepColumn *columns, uint32_t count, float tolerance,
                             uint32_t *kept);

/* The same for shadows: normals of neighbours stay within 123 degrees. */
uint32_t meso_detail_silhouette(const MesoSweepColumn *columns, uint32_t count, float tolerance, uint32_t *kept);

/*
 * Vertices along a sweep of `kind` so that its trajectories and profiles stay
 * within `tolerance` (scene units) of the curves; at least 2, at most the
 * kind's division_count. O(instances + columns).
 */
uint32_t meso_detail_rings(const MesoScene *scene, const MesoSweptKind *kind, float tolerance);

/* What the rings of a kind's instances hang on, in scene units. */
typedef struct MesoKindDetail {
    float radius, change;       /* of the profiles from the trajectory, and from end to end */
    MesoCellStretch stretch;    /* of the instances' cages */
} MesoKindDetail;
MesoKindDetail meso_kind_detail(const MesoScene *scene, const MesoSweptKind *kind);

/* The same as meso_detail_rings() for one instance; not `shaded`: for its shadow. O(1). */
uint32_t meso_detail_instance_rings(const MesoSweptKind *kind, const MesoKindDetail *detail,
                                    const MesoSweepInstance *instance, float tolerance, bool shaded);

/* What the rings of one instance hang on beside its kind: its second derivative, and how far it turns. */
typedef struct MesoSweepBend {
    float second, turn;
} MesoSweepBend;
MesoSweepBend meso_detail_bend(const MesoSweptKind *kind, const MesoKindDetail *detail,
                               const MesoSweepInstance *instance);
uint32_t meso_detail_bend_rings(const MesoSweptKind *kind, const MesoKindDetail *detail, MesoSweepBend bend,
                                float tolerance, bool shaded);

#endif
