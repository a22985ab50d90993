/* Names, disjoint sets, growing arrays. */
#include "libcore/base/names.h"

#include <stdio.h>
#include <string.h>

#include "libcore/base/check.h"
#include "libcore/base/disjoint_sets.h"
#include "libcore/base/grow.h"
#include "libcore/base/nearest.h"
#include "libcore/base/random.h"

/* The first of equal names counts; names may be parts of others, empty, or hold zero bytes. */
static void test_names(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    MesoNames names = {0};
    CHECK(meso_names_find(&names, "a", 1) == MESO_NO_INDEX);
    CHECK(meso_names_add(&names, &arena, "a", 1, 7, NULL) == 7);
    CHECK(meso_names_add(&names, &arena, "a", 1, 8, NULL) == 7);
    CHECK(meso_names_add(&names, &arena, "ab", 2, 9, NULL) == 9);
    CHECK(meso_names_add(&names, &arena, "", 0, 10, NULL) == 10);
    CHECK(meso_names_add(&names, &arena, "a\0b", 3, 11, NULL) == 11);
    CHECK(meso_names_find(&names, "abc", 2) == 9 && meso_names_find(&names, "", 0) == 10);
    CHECK(meso_names_find(&names, "a\0c", 3) == MESO_NO_INDEX);

    for (uint32_t i = 0; i < 5000; i++) {
        const char *text = meso_arena_print(&arena, NULL, "name %u", i % 2500);
        CHECK(meso_names_add(&names, &arena, text, strlen(text), i, NULL) == i % 2500);
    }
    CHECK(names.count == 2504 && names.count <= names.room);
    for (uint32_t i = 0; i < 2500; i++) {
        char text[16];
        int length = snprintf(text, sizeof text, "name %u", i);
        CHECK(meso_names_find(&names, text, (size_t)length) == i);
    }
    meso_arena_release(&arena);
}

/* Beside sets that are kept as colours. */
static void test_disjoint_sets(void)
{
    enum { COUNT = 200 };
    uint32_t parent[COUNT], color[COUNT];
    MesoRandom random;
    meso_random_init(&random, 1, 0);
    meso_sets_init(parent, COUNT);
    for (uint32_t i = 0; i < COUNT; i++)
        color[i] = i;
    for (int step = 0; step < 300; step++) {
        uint32_t a = meso_random_below(&random, COUNT), b = meso_random_below(&random, COUNT);
        uint32_t from = color[a], to = color[b];
        CHECK(meso_sets_join(parent, a, b) == (from != to));
        for (uint32_t i = 0; i < COUNT; i++)
            color[i] = color[i] == from ? to : color[i];
        for (uint32_t i = 0; i < COUNT; i++) {
            uint32_t smallest = 0;
            while (color[smallest] != color[i])
                smallest++;
            CHECK(meso_sets_root(parent, i) == smallest);
        }
    }
}

static void test_grow(void)
{
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    uint32_t *numbers = NULL, count = 0, room = 0;
    for (uint32_t i = 0; i < 1000; i++) {
        numbers = MESO_GROW(&arena, numbers, count, room, 3, &error);
        CHECK(numbers);
        numbers[count++] = i;
    }
    CHECK(room == 3 << 9);
    for (uint32_t i = 0; i < 1000; i++)
        CHECK(numbers[i] == i);

    uint8_t *bytes = NULL, few = 255, most = 128;
    bytes = MESO_GROW(&arena, bytes, few, most, 1, &error);
    CHECK(!bytes && error.status == MESO_ERR_MEMORY);
    meso_arena_release(&arena);
}

static const char *nearest(const char *text)
{
    static const char *const words[] = {"contour", "stream", "voronoi", "polyline", "count"};
    MesoNearest found = meso_nearest(text, strlen(text));
    for (int i = 0; i < 5; i++)
        meso_nearest_try(&found, words[i]);
    return found.best ? found.best : "";
}

static void test_nearest(void)
{
    CHECK(strcmp(nearest("countour"), "contour") == 0 && strcmp(nearest("co"), "contour") == 0);
    CHECK(strcmp(nearest("poly"), "polyline") == 0 && strcmp(nearest("veronoi"), "voronoi") == 0);
    CHECK(strcmp(nearest("counts"), "count") == 0 && strcmp(nearest("steam"), "stream") == 0);
    CHECK(!*nearest("") && !*nearest("c") && !*nearest("paint"));
    CHECK(!*nearest("a word that is much too long to be any of these"));
}

int main(void)
{
    test_nearest();
    test_names();
    test_disjoint_sets();
    test_grow();
}
