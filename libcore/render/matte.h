/*
 * Mattes: which things a pixel shows, and how much of it each covers, by name: Cryptomatte, specification 1.2.0
 * (Friedman and Jones 2015). A thing's number is MurmurHash3_32 of its name, made a float that is neither
 * infinite, nor too small, nor no number.
 */
#ifndef MESO_MATTE_H
#define MESO_MATTE_H

#include <stddef.h>
#include <stdint.h>


/* Things a pixel that are kept, those that cover most of it; three layers of two each. */
enum { MESO_MATTE_RANKS = 6, MESO_MATTE_MOST = 8 };

typedef struct MesoMatte {
    const char *name;           /* of the channel of ids, or "material" */
    uint32_t count;             /* things */
    const char *const *names;   /* [count], or NULL: numbers are their own names */
    float *hashes;              /* [count] */
    uint64_t *seen;             /* [words of count] bits of things: those that some pixel shows */
    float *ranks;               /* [2 * MESO_MATTE_RANKS * pixels] number and coverage of each, most first; 0 for none */
} MesoMatte;

uint32_t meso_matte_hash(const void *text, size_t length);
float meso_matte_number(uint32_t hash);

/* The name of thing `i`, in `text` where it is a number. */
const char *meso_matte_name(const MesoMatte *matte, uint32_t i, char text[16]);

/* Hashes all names; `hashes` and `seen`, zeroed, have their places. */
void meso_matte_init(MesoMatte *matte);

/*
 * Fills in the ranks of a pixel from its samples' things [sample_count], of which MESO_NO_INDEX is none. May be called
 * for different pixels at once.
 */
void meso_matte_put(MesoMatte *matte, size_t pixel, const uint32_t *things, uint32_t sample_count);

#endif
