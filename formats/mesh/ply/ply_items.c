#include "formats/mesh/ply/ply_items.h"

#include <string.h>

static uint64_t load(const unsigned char *bytes, uint32_t size, bool big)
{
    uint16_t two;
    uint32_t four;
    uint64_t eight;
    switch (size) {
    case 1: return *bytes;
    case 2: memcpy(&two, bytes, 2); return big ? __builtin_bswap16(two) : two;
    case 4: memcpy(&four, bytes, 4); return big ? __builtin_bswap32(four) : four;
    default: memcpy(&eight, bytes, 8); return big ? __builtin_bswap64(eight) : eight;
    }
}

int64_t meso_ply_integer(MesoScalar type, const unsigned char *bytes, bool big)
{
    uint64_t bits = load(bytes, meso_scalar_size(type), big);
    switch (type) {
    case MESO_SCALAR_INT8: return (int8_t)bits;
    case MESO_SCALAR_INT16: return (int16_t)bits;
    case MESO_SCALAR_INT32: return (int32_t)bits;
    default: return (int64_t)bits;
    }
}

double meso_ply_number(MesoScalar type, const unsigned char *bytes, bool big)
{
    float single;
    double value;
    uint64_t bits = load(bytes, meso_scalar_size(type), big);
    uint32_t low = (uint32_t)bits;
    switch (type) {
    case MESO_SCALAR_FLOAT: memcpy(&single, &low, sizeof single); return (double)single;
    case MESO_SCALAR_DOUBLE: memcpy(&value, &bits, sizeof value); return value;
    default: return (double)meso_ply_integer(type, bytes, big);
    }
}

/* Whether a number is kept as the bits that it has. */
static bool keeps_bits(MesoScalar from, MesoScalar to)
{
    return from == to || (from == MESO_SCALAR_INT32 && to == MESO_SCALAR_UINT32);
}

static void put(MesoScalar from, MesoScalar to, unsigned char *out, const unsigned char *bytes, bool big)
{
    uint32_t size = meso_scalar_size(from);
    if (keeps_bits(from, to)) {
        for (uint32_t i = 0; i < size; i++)
            out[i] = bytes[big ? size - 1 - i : i];
    } else if (to == MESO_SCALAR_UINT32) {
        uint32_t index = (uint32_t)meso_ply_integer(from, bytes, big);
        memcpy(out, &index, sizeof index);
    } else {
        float number = (float)meso_ply_number(from, bytes, big);
        memcpy(out, &number, sizeof number);
    }
}

void meso_ply_put(const MesoPlyProperty *property, unsigned char *out, const unsigned char *bytes, bool big)
{
    put(property->type, property->to, out, bytes, big);
}

void meso_ply_add_run(MesoPlyItems *items, const MesoPlyProperty *property, uint32_t count, size_t offset,
                      size_t stride)
{
    if (!property->out || count == 0)
        return;
    MesoPlyRun *last = items->run_count ? &items->runs[items->run_count - 1] : NULL;
    uint32_t size = meso_scalar_size(property->type);
    if (last && last->from == property->type && last->to == property->to && last->stride == stride &&
        keeps_bits(last->from, last->to) && last->offset + (size_t)last->count * size == offset &&
        last->out + (size_t)last->count * size == property->out) {
        last->count += count;
        return;
    }
    items->runs[items->run_count++] = (MesoPlyRun){
        .count = count, .offset = offset, .from = property->type, .to = property->to, .out = property->out, .stride = stride};
}

/* With a number of bytes that the compiler knows. */
#define COPY_EACH(bytes)                                                             \
    for (; count > 0; count--, from += from_stride, to += to_stride)                 \
        memcpy(to, from, (bytes))

static void copy_bits(unsigned char *to, size_t to_stride, const unsigned char *from, size_t from_stride,
                      uint32_t count, size_t bytes)
{
    switch (bytes) {
    case 1: COPY_EACH(1); break;
    case 2: COPY_EACH(2); break;
    case 4: COPY_EACH(4); break;
    case 8: COPY_EACH(8); break;
    case 12: COPY_EACH(12); break;
    case 16: COPY_EACH(16); break;
    default: COPY_EACH(bytes); break;
    }
}

static void copy_run(const MesoPlyItems *items, const MesoPlyRun *run, uint32_t begin, uint32_t end)
{
    const unsigned char *from = items->data + begin * items->stride + run->offset;
    unsigned char *to = run->out + begin * run->stride;
    uint32_t from_size = meso_scalar_size(run->from), to_size = meso_scalar_size(run->to);
    if (keeps_bits(run->from, run->to) && (!items->big || from_size == 1)) {
        copy_bits(to, run->stride, from, items->stride, end - begin, (size_t)run->count * from_size);
        return;
    }
    for (uint32_t i = begin; i < end; i++, from += items->stride, to += run->stride)
        for (uint32_t k = 0; k < run->count; k++) {
            uint32_t word;
            const unsigned char *number = from + (size_t)k * from_size;
            if (from_size == 4 && to_size == 4 && keeps_bits(run->from, run->to)) {
                memcpy(&word, number, sizeof word);
                word = __builtin_bswap32(word);
                memcpy(to + 4 * (size_t)k, &word, sizeof word);
            } else
                put(run->from, run->to, to + (size_t)k * to_size, number, items->big);
        }
}

/* A few items at a time, which every run then finds in the cache. */
void meso_ply_copy_items(const MesoPlyItems *items, uint32_t begin, uint32_t end)
{
    enum { FEW = 512 };
    for (uint32_t i = begin; i < end; i += FEW)
        for (uint32_t r = 0; r < items->run_count; r++)
            copy_run(items, &items->runs[r], i, end - i > FEW ? i + FEW : end);
}
