/* An animated glTF, for tests. */
#ifndef MESO_GLTF_CLIP_FIXTURE_H
#define MESO_GLTF_CLIP_FIXTURE_H

#include <stdint.h>

#include "libcore/base/check.h"

#define HALF_ROOT 0.70710678f    /* of sine and cosine of 45 degrees */

/*
 * Two triangles. The first one's last vertex goes up by a morph target and back, while its node moves along x. Of the
 * second the first vertex follows joint 2, the next one joint 3, half a unit on, which turns by 90 degrees, and the
 * last one both by half.
 */
static const float animated_numbers[] = {
    0, 0, 0, 1, 0, 0, 0, 1, 0,              /* 0: positions */
    0, 0, 0, 0, 0, 0, 0, 1, 0,              /* 36: a target */
    0, 1, 2,                                /* 72: times */
    0, 1, 0,                                /* 84: weights */
    0, 0, 0, 2, 0, 0, 4, 0, 0,              /* 96: translations */
    0, 0, 0, 1, 0, 0, 0.5f, 1, 0,           /* 132: positions of the second */
    1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0,       /* 168: weights of joints */
    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,             /* 216: inverse matrices */
    1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -0.5f, 0, 0, 1,
    0, 0, 0, 1, 0, 0, HALF_ROOT, HALF_ROOT, 0, 0, HALF_ROOT, HALF_ROOT,     /* 344: rotations */
};
static const uint16_t animated_joints[] = {0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0};    /* 392 */

static const char animated_json[] =
    "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2]}],"
    "\"nodes\":[{\"mesh\":0},{\"mesh\":1,\"skin\":0,\"translation\":[100,0,0]},{\"children\":[3]},"
    "{\"translation\":[0.5,0,0]}],"
    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"targets\":[{\"POSITION\":1}]}]},"
    "{\"primitives\":[{\"attributes\":{\"POSITION\":5,\"WEIGHTS_0\":6,\"JOINTS_0\":9}}]}],"
    "\"skins\":[{\"joints\":[2,3],\"inverseBindMatrices\":7}],"
    "\"animations\":[{\"samplers\":[{\"input\":2,\"output\":3,\"interpolation\":\"%s\"},{\"input\":2,\"output\":4},"
    "{\"input\":2,\"output\":8}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,\"path\":\"weights\"}},"
    "{\"sampler\":1,\"target\":{\"node\":0,\"path\":\"translation\"}},"
    "{\"sampler\":2,\"target\":{\"node\":3,\"path\":\"rotation\"}}]}],"
    "\"accessors\":["
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"byteOffset\":0},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"byteOffset\":36},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\",\"byteOffset\":72},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"SCALAR\",\"byteOffset\":84},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"byteOffset\":96},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\",\"byteOffset\":132},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\",\"byteOffset\":168},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":2,\"type\":\"MAT4\",\"byteOffset\":216},"
    "{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\",\"byteOffset\":344},"
    "{\"bufferView\":0,\"componentType\":5123,\"count\":3,\"type\":\"VEC4\",\"byteOffset\":392}],"
    "\"bufferViews\":[{\"buffer\":0,\"byteLength\":416}],\"buffers\":[{\"byteLength\":416}]}";

/* Bytes of it, in `out` [8192]. */
static inline size_t make_animated_glb(uint8_t *out, const char *interpolation)
{
    char text[4096];
    size_t length = (size_t)snprintf(text, sizeof text, animated_json, interpolation);
    while (length % 4)
        text[length++] = ' ';
    CHECK(sizeof animated_numbers == 392 && sizeof animated_numbers + sizeof animated_joints == 416);
    const uint32_t head[] = {0x46546c67, 2, (uint32_t)(28 + length + 416), (uint32_t)length, 0x4e4f534a};
    const uint32_t binary[] = {416, 0x004e4942};
    memcpy(out, head, sizeof head);
    memcpy(out + 20, text, length);
    memcpy(out + 20 + length, binary, sizeof binary);
    memcpy(out + 28 + length, animated_numbers, sizeof animated_numbers);
    memcpy(out + 28 + length + sizeof animated_numbers, animated_joints, sizeof animated_joints);
    return 28 + length + 416;
}

#endif
