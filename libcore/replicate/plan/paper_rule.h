/*
 * The rule of the paper, to the letter, for comparison ("Real-Time Continuous Self-Replicating Details for Shape
 * Deformation", Rohmer, Hahmann and Cani 2015, sections 3.2, 4.1 and 4.2): a triangle larger than alpha times the
 * largest at rest is split as the triangle of H0 that is most similar to it, by equation 3. H0 has all triangles of
 * originals with others inside, laid into one plane, but for those larger than will ever be asked for. Of a triangle
 * smaller than beta times the smallest at rest the ends of the shortest edge move towards each other over the surface
 * (section 5.2), until they are as good as one; then the edge collapses (4.3), and the later one shrinks where it is.
 */
#ifndef MESO_PAPER_RULE_H
#define MESO_PAPER_RULE_H

#include "libcore/replicate/plan/replicate_work.h"

enum { MESO_PAPER_MOST = 500, MESO_PAPER_GRID = 20 };

typedef struct MesoPaperTriangle {
    float area, angle;          /* the smallest */
    uint32_t corners[3];        /* counter-clockwise, from that with the smallest angle */
} MesoPaperTriangle;

typedef struct MesoPaperRule {
    double largest, smallest;   /* areas of triangles at rest */
    double close;               /* distance at which two are one */
    double most;                /* area of the largest in H0 */
    double area, angle;         /* means at rest, that errors are relative to */
    double (*places)[2];        /* [originals] in the plane */
    uint32_t *begin;            /* [GRID * GRID + 1] by area and angle */
    MesoPaperTriangle *triangles;
} MesoPaperRule;

/* MESO_ERR_LIMIT for more than MESO_PAPER_MOST originals, MESO_ERR_MEMORY. O(n^3), and n for each of H0. */
MesoStatus meso_paper_build(MesoPaperRule *rule, MesoReplication *r, MesoError *error);

/* Splits the largest triangle while it is too large; merges at the smallest. */
MesoStatus meso_paper_step(MesoReplication *r, int32_t frame, MesoError *error);

#endif
