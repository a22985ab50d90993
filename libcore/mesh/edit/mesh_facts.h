/* What there is to know of a mesh before anything is made of it. */
#ifndef MESO_MESH_FACTS_H
#define MESO_MESH_FACTS_H

#include "libcore/mesh/polygon_mesh.h"

/* Of vertices with as many edges or more there is one number. */
enum { MESO_MOST_VALENCE = 12 };

/* Vertices nearer than the mean edge times this, and not in one place, may be meant to be one. */
#define MESO_NEAR_VERTICES 1e-3

typedef struct MesoMeshFacts {
    uint32_t edge_count;
    uint32_t triangles, quads, larger;  /* faces */
    uint32_t most_sides;
    uint32_t components;                /* that share no vertex */
    uint32_t border_edges;
    uint32_t border_loops;              /* those that meet in a vertex count as one */
    uint32_t valences[MESO_MOST_VALENCE + 1];   /* vertices by the number of their edges; [0] are in no face */
    double shortest_edge, mean_edge, longest_edge;
    uint32_t disagreeing_edges;         /* whose faces run along them the same way */
    uint32_t crowded_edges;             /* with three faces or more */
    uint32_t pinched_vertices;          /* in which faces meet that are not neighbours around it */
    uint32_t coinciding_vertices;       /* in the same place as one before */
    uint32_t near_vertices;             /* besides, nearer than `near_distance` to one before */
    uint32_t coinciding_borders, near_borders;  /* those of them that lie, with the one before, on borders: gaps to weld */
    double near_distance;
    uint32_t flat_faces, double_faces;
    MesoVec3 low, high;                 /* of all vertices */
    double area;                        /* of the fans around the faces' first corners */
    bool closed, orientable;
    double volume;                      /* enclosed, where closed and windings agree; else NaN */
    int64_t euler;                      /* vertices of faces - edges + faces */
    bool has_genus;                     /* no crowded edges, no pinched vertices, orientable */
    int64_t genus;                      /* the sum over all components */
} MesoMeshFacts;

/* Of a checked mesh. O(corners) but for what meso_mesh_weld_map() says. MESO_ERR_MEMORY alone. */
MesoStatus meso_mesh_find_facts(MesoMeshFacts *facts, const MesoPolygonMesh *mesh, uint32_t thread_count,
                                MesoError *error);

#endif
