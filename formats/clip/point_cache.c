#include "formats/clip/point_cache.h"

#include <string.h>

#include "libcore/mesh/polygon_mesh.h"

enum { PC2_HEADER = 32, MDD_HEADER = 8, POINT_BYTES = 12, TIME_BYTES = 4 };

static const char pc2_mark[12] = "POINTCACHE2";

static uint32_t little_word(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 | (uint32_t)bytes[3] << 24;
}

static uint32_t big_word(const uint8_t *bytes)
{
    return (uint32_t)bytes[3] | (uint32_t)bytes[2] << 8 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[0] << 24;
}

static uint32_t word(const MesoPointCache *cache, size_t at)
{
    const uint8_t *bytes = cache->input->data + at;
    return cache->kind == MESO_CACHE_PC2 ? little_word(bytes) : big_word(bytes);
}

static float number(const MesoPointCache *cache, size_t at)
{
    uint32_t bits = word(cache, at);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static size_t points_begin(const MesoPointCache *cache)
{
    return cache->kind == MESO_CACHE_PC2 ? PC2_HEADER : MDD_HEADER + TIME_BYTES * (size_t)cache->frame_count;
}

bool meso_point_cache_is_pc2(const MesoInput *input)
{
    return input->size >= sizeof pc2_mark && memcmp(input->data, pc2_mark, sizeof pc2_mark) == 0;
}

static MesoStatus read_pc2(MesoPointCache *cache, MesoError *error)
{
    if (!meso_point_cache_is_pc2(cache->input) || cache->input->size < PC2_HEADER)
        return meso_fail(error, MESO_ERR_INPUT, "%s: not a PC2 cache: it begins otherwise", cache->input->path);
    uint32_t version = word(cache, 12);
    if (version != 1)
        return meso_fail(error, MESO_ERR_INPUT, "%s: a PC2 cache of version %u; version 1 is known", cache->input->path,
                         version);
    cache->point_count = word(cache, 16);
    cache->start = number(cache, 20);
    cache->rate = number(cache, 24);
    cache->frame_count = word(cache, 28);
    return MESO_OK;
}

static MesoStatus read_mdd(MesoPointCache *cache, MesoError *error)
{
    if (cache->input->size < MDD_HEADER)
        return meso_fail(error, MESO_ERR_INPUT, "%s: not an MDD cache: it is too short", cache->input->path);
    cache->frame_count = word(cache, 0);
    cache->point_count = word(cache, 4);
    return MESO_OK;
}

MesoStatus meso_point_cache_open(MesoPointCache *cache, const MesoInput *input, MesoPointCacheKind kind,
                                 MesoError *error)
{
    *cache = (MesoPointCache){.input = input, .kind = kind};
    MesoStatus status = (kind == MESO_CACHE_PC2 ? read_pc2 : read_mdd)(cache, error);
    if (status)
        return status;
    if (cache->frame_count == 0 || cache->point_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: a cache of %u frames of %u points", input->path,
                         cache->frame_count, cache->point_count);
    /* Both are below 2^32, and so the product of all fits. */
    unsigned __int128 needed = points_begin(cache);
    needed += (unsigned __int128)POINT_BYTES * cache->frame_count * cache->point_count;
    if (needed != input->size)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %u frames of %u points take %.0f bytes; the file has %zu",
                         input->path, cache->frame_count, cache->point_count, (double)needed, input->size);
    return MESO_OK;
}

static bool is_place(MesoVec3 p)
{
    return fabsf(p.x) <= MESO_COORDINATE_LIMIT && fabsf(p.y) <= MESO_COORDINATE_LIMIT &&
           fabsf(p.z) <= MESO_COORDINATE_LIMIT;
}

MesoStatus meso_point_cache_frame(const MesoPointCache *cache, uint32_t frame, MesoVec3 *positions, MesoError *error)
{
    size_t at = points_begin(cache) + POINT_BYTES * (size_t)cache->point_count * frame;
    for (uint32_t v = 0; v < cache->point_count; v++, at += POINT_BYTES) {
        positions[v] = (MesoVec3){number(cache, at), number(cache, at + 4), number(cache, at + 8)};
        if (!is_place(positions[v]))
            return meso_fail(error, MESO_ERR_INPUT, "%s: frame %u, vertex %u: coordinates that are not finite, or "
                             "beyond 1e18", cache->input->path, frame + 1, v + 1);
    }
    return MESO_OK;
}

double meso_point_cache_time(const MesoPointCache *cache, uint32_t frame)
{
    if (cache->kind == MESO_CACHE_PC2)
        return (double)cache->start + (double)cache->rate * frame;
    return number(cache, MDD_HEADER + TIME_BYTES * (size_t)frame);
}
