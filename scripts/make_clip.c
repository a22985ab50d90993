/*
 * Writes a clip of a plate that becomes twice as long along x, to standard output: the unit square in SIDE x SIDE
 * squares, whose middle is 0, by rows from below.
 *
 *     make_clip pc2|mdd SIDE     six samples of its places
 *     make_clip morph SIDE       a .glb of a second, with a morph target
 *     make_clip skin SIDE        the same, with two joints that go apart
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 6, MOST = 200 };

static uint32_t side, vertex_count;
static unsigned char bytes[16 << 20];
static size_t size;

static void put(uint32_t word, int big)
{
    for (int k = 0; k < 4; k++)
        bytes[size++] = (unsigned char)(word >> (big ? 24 - 8 * k : 8 * k));
}

static void put_float(float value, int big)
{
    uint32_t word;
    memcpy(&word, &value, sizeof word);
    put(word, big);
}

static float x_of(uint32_t vertex)
{
    return (float)(vertex % (side + 1)) / (float)side - 0.5f;
}

static void put_places(float x, float y, int big)
{
    for (uint32_t v = 0; v < vertex_count; v++) {
        put_float(x * x_of(v), big);
        put_float(y * ((float)(v / (side + 1)) / (float)side - 0.5f), big);
        put_float(0, big);
    }
}

/* ---- caches ---- */

static void put_cache(int big)
{
    if (big) {
        put(SAMPLES, big);
        put(vertex_count, big);
        for (int f = 0; f < SAMPLES; f++)
            put_float((float)f / (SAMPLES - 1), big);
    } else {
        memcpy(bytes, "POINTCACHE2", 12);
        size = 12;
        put(1, big);
        put(vertex_count, big);
        put_float(0, big);
        put_float(1, big);
        put(SAMPLES, big);
    }
    for (int f = 0; f < SAMPLES; f++)
        put_places(1 + (float)f / (SAMPLES - 1), 1, big);
}

/* ---- animations ---- */

static char text[16384], accessors[4096], views[4096];
static int accessor_count;

static void add(size_t from, int component, uint32_t count, const char *type, const char *more)
{
    char *a = accessors + strlen(accessors), *v = views + strlen(views);
    const char *comma = accessor_count ? "," : "";
    sprintf(a, "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"%s}", comma, accessor_count,
            component, count, type, more);
    sprintf(v, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", comma, from, size - from);
    accessor_count++;
}

/* Accessors 0 to 2: places, triangles, two times. */
static void put_plate(void)
{
    put_places(1, 1, 0);
    add(0, 5126, vertex_count, "VEC3", ",\"min\":[-0.5,-0.5,0],\"max\":[0.5,0.5,0]");
    size_t from = size;
    for (uint32_t s = 0; s < side * side; s++) {
        uint32_t a = s / side * (side + 1) + s % side, b = a + side + 1;
        const uint32_t corners[] = {a, a + 1, b + 1, a, b + 1, b};
        for (int k = 0; k < 6; k++)
            put(corners[k], 0);
    }
    add(from, 5125, 6 * side * side, "SCALAR", "");
    from = size;
    put_float(0, 0);
    put_float(1, 0);
    add(from, 5126, 2, "SCALAR", ",\"min\":[0],\"max\":[1]");
}

/* 3: as much again along x; 4: its weights. */
static void put_morph(void)
{
    size_t from = size;
    put_places(1, 0, 0);
    add(from, 5126, vertex_count, "VEC3", ",\"min\":[-0.5,0,0],\"max\":[0.5,0,0]");
    from = size;
    put_float(0, 0);
    put_float(1, 0);
    add(from, 5126, 2, "SCALAR", "");
}

/* 3 and 4: which joints, and how much of each: from the left to the right; 5 and 6: these go half a unit apart. */
static void put_skin(void)
{
    size_t from = size;
    for (uint32_t v = 0; v < vertex_count; v++)
        put(x_of(v) > -0.5f ? 0x0100 : 0, 0);
    add(from, 5121, vertex_count, "VEC4", "");
    from = size;
    for (uint32_t v = 0; v < vertex_count; v++)
        for (int k = 0; k < 4; k++)
            put_float(k == 0 ? 0.5f - x_of(v) : k == 1 ? 0.5f + x_of(v) : 0, 0);
    add(from, 5126, vertex_count, "VEC4", "");
    for (int joint = 0; joint < 2; joint++) {
        from = size;
        for (int k = 0; k < 6; k++)
            put_float(k == 3 ? (joint ? 0.5f : -0.5f) : 0, 0);
        add(from, 5126, 2, "VEC3", "");
    }
}

static void write_glb(int skin)
{
    put_plate();
    skin ? put_skin() : put_morph();
    snprintf(text, sizeof text, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[%s]}],"
            "\"nodes\":[{\"mesh\":0%s}%s],"
            "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0%s},\"indices\":1%s}]}],%s"
            "\"animations\":[{%s}],"
            "\"accessors\":[%s],\"bufferViews\":[%s],\"buffers\":[{\"byteLength\":%zu}]}",
            skin ? "0,3" : "0", skin ? ",\"skin\":0" : "",
            skin ? ",{\"name\":\"left\"},{\"name\":\"right\"},{\"children\":[1,2]}" : "",
            skin ? ",\"JOINTS_0\":3,\"WEIGHTS_0\":4" : "", skin ? "" : ",\"targets\":[{\"POSITION\":3}]",
            skin ? "\"skins\":[{\"joints\":[1,2]}]," : "",
            skin ? "\"samplers\":[{\"input\":2,\"output\":5},{\"input\":2,\"output\":6}],\"channels\":[{\"sampler\":0,"
                   "\"target\":{\"node\":1,\"path\":\"translation\"}},{\"sampler\":1,\"target\":{\"node\":2,\"path\":"
                   "\"translation\"}}]"
                 : "\"samplers\":[{\"input\":2,\"output\":4}],\"channels\":[{\"sampler\":0,\"target\":{\"node\":0,"
                   "\"path\":\"weights\"}}]", accessors, views, size);
    size_t length = strlen(text);
    while (length % 4)
        text[length++] = ' ';
    const uint32_t head[] = {0x46546c67, 2, (uint32_t)(28 + length + size), (uint32_t)length, 0x4e4f534a};
    const uint32_t binary[] = {(uint32_t)size, 0x004e4942};
    fwrite(head, sizeof head, 1, stdout);
    fwrite(text, 1, length, stdout);
    fwrite(binary, sizeof binary, 1, stdout);
}

int main(int argc, char **argv)
{
    const char *kind = argc > 1 ? argv[1] : "";
    side = argc > 2 ? (uint32_t)strtoul(argv[2], NULL, 10) : 0;
    if (argc != 3 || side < 1 || side > MOST) {
        fprintf(stderr, "usage: make_clip pc2|mdd|morph|skin SIDE\n");
        return 2;
    }
    vertex_count = (side + 1) * (side + 1);
    if (strcmp(kind, "pc2") == 0 || strcmp(kind, "mdd") == 0)
        put_cache(kind[0] == 'm');
    else
        write_glb(strcmp(kind, "skin") == 0);
    fwrite(bytes, 1, size, stdout);
    return fflush(stdout) || ferror(stdout);
}
