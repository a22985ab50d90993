/* Indices: 32 bits; the largest number stands for none. */
#ifndef MESO_INDEX_H
#define MESO_INDEX_H

#include <stdint.h>

#define MESO_NO_INDEX UINT32_MAX

#endif
