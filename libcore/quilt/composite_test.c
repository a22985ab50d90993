/* A composite that is packed is as it was, in its lists too, but for what was dead. */
#include "libcore/base/check.h"
#include "libcore/base/random.h"
#include "libcore/quilt/composite.h"

enum { BASE = 37, ROUNDS = 60, ADDED = 3000 };

/* Of each base triangle's list, in order, what tells a triangle: its origin and its corners' origins. */
static uint64_t hash_lists(const MesoComposite *c)
{
    uint64_t hash = 1;
    for (uint32_t b = 0; b < BASE; b++) {
        for (uint32_t t = c->triangle_head[b]; t != MESO_NO_INDEX; t = c->next[t]) {
            if (meso_composite_is_dead(c, t))
                continue;
            hash = hash * 0x100000001b3 + c->triangle_origins[t] + c->patches[t];
            for (size_t k = 0; k < 3; k++) {
                uint32_t v = c->corners[3 * (size_t)t + k];
                hash = hash * 0x100000001b3 + c->vertex_origins[v] + c->vertices[v].triangle;
            }
        }
        for (uint32_t w = c->whole_head[b]; w != MESO_NO_INDEX; w = c->wholes[w].next) {
            const MesoPlacedWhole *whole = &c->wholes[w];
            if (!whole->dead)
                hash = hash * 0x100000001b3 + whole->patch + c->whole_vertices[whole->vertex_begin + 1].triangle;
        }
        hash++;
    }
    return hash;
}

static uint32_t count_caps(const MesoComposite *c)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < c->cap_count; i++)
        count += !meso_composite_is_dead(c, c->caps[i]);
    return count;
}

static void add_some(MesoComposite *c, MesoRandom *random, uint32_t round)
{
    for (uint32_t i = 0; i < ADDED; i++) {
        uint32_t corners[3];
        for (int k = 0; k < 3; k++)
            corners[k] = meso_composite_add_vertex(c, (MesoQuiltVertex){.triangle = meso_random_below(random, BASE)},
                                                   meso_random_below(random, 1000), NULL);
        if (i % 100 == 0)
            CHECK(!meso_composite_add_cap(c, c->triangle_count, NULL));
        CHECK(meso_composite_add_triangle(c, corners, i, round, NULL) != MESO_NO_INDEX);
        MesoQuiltVertex centre = {.triangle = meso_random_below(random, BASE)}, vertices[2] = {centre, {.triangle = i}};
        CHECK(meso_composite_add_whole(c, 0, i + round, centre, vertices, 2, NULL) != MESO_NO_INDEX);
    }
}

static void take_some(MesoComposite *c, MesoRandom *random)
{
    for (uint32_t t = 0; t < c->triangle_count; t++)
        if (meso_random_below(random, 4))
            c->corners[3 * (size_t)t] = MESO_NO_INDEX;
    for (uint32_t w = 0; w < c->whole_count; w++)
        c->wholes[w].dead |= meso_random_below(random, 4) != 0;
}

int main(void)
{
    MesoComposite c;
    uint32_t begin[2] = {0, 2};
    MesoSwatch swatch = {.vertex_begin = begin, .element_count = 1};
    MesoRandom random;
    meso_random_init(&random, 3, 0);
    CHECK(!meso_composite_init(&c, BASE, NULL));
    uint32_t packed = 0;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        add_some(&c, &random, round);
        take_some(&c, &random);
        uint64_t before = hash_lists(&c);
        uint32_t caps = count_caps(&c), triangles = c.triangle_count;
        meso_composite_pack(&c, &swatch);
        packed += c.triangle_count < triangles;
        CHECK(hash_lists(&c) == before && count_caps(&c) == caps);
        for (uint32_t v = 0; v < c.vertex_count; v++)
            CHECK(c.marks[v] == MESO_NO_INDEX);
        CHECK(c.triangle_count < 40000 && c.vertex_count < 120000 && c.whole_vertex_count < 40000);
    }
    CHECK(packed > 2);
    meso_composite_release(&c);
    return 0;
}
