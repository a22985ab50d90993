/*
 * Bytes to a zlib stream (RFC 1950, 1951), quickly: for pictures, most of whose bytes are long runs and most of the
 * others noise. What comes again is looked for where the four bytes that it begins with came last, and nowhere else;
 * of what lies in a match only the last place is noted, and after long noise fewer and fewer places are looked at.
 */
#ifndef MESO_QUICK_DEFLATE_H
#define MESO_QUICK_DEFLATE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

enum { MESO_DEFLATE_HEAD_BITS = 12, MESO_DEFLATE_SEQUENCES = 1 << 13 };

/* Bytes as they are, and then `length` bytes (0: none) as they were `distance` before. */
typedef struct MesoDeflateSequence {
    uint32_t literals;
    uint16_t length, distance;      /* 32768 at most */
} MesoDeflateSequence;

/* Scratch. */
typedef struct MesoQuickDeflate {
    uint32_t heads[1 << MESO_DEFLATE_HEAD_BITS];     /* where four bytes of a hash were last */
    MesoDeflateSequence sequences[MESO_DEFLATE_SEQUENCES];
} MesoQuickDeflate;

/* Bytes that meso_quick_deflate() may write to, of so many, which are less than 2^31. */
size_t meso_quick_deflate_bound(size_t size);

/*
 * in [size]; out [meso_quick_deflate_bound(size)]. Returns how long the stream is. The same bytes on all machines.
 * O(size).
 */
size_t meso_quick_deflate(MesoQuickDeflate *scratch, const uint8_t *in, size_t size, uint8_t *out);

#endif
