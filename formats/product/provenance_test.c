/* Provenance: the same text for the same making, whatever bytes it holds. */
#include "formats/product/provenance.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/check.h"

static void test_text(void)
{
    MesoProvenance provenance = {.tool = "meso-try", .command_line = "meso-try '\xff\n'", .seed = INT64_MAX};
    MesoInput input = {.path = "a/b.json", .data = (const uint8_t *)"", .hash = {0x0123456789abcdef, 0xf}};
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    CHECK(meso_provenance_add(&provenance, "tiles", &input, &arena, &error) == MESO_OK);
    CHECK(meso_provenance_add(&provenance, "surface", &input, &arena, &error) == MESO_OK);
    CHECK(provenance.input_count == 2);
    const char *text = meso_provenance_text(&provenance, &arena, &error);
    CHECK(strcmp(text, "{\"tool\":\"meso-try\",\"version\":\"" MESO_VERSION "\",\"command\":"
                       "\"meso-try '?\\n'\",\"seed\":9223372036854775807,\"inputs\":["
                       "{\"role\":\"tiles\",\"name\":\"b.json\",\"xxh3_128\":\"0123456789abcdef000000000000000f\"},"
                       "{\"role\":\"surface\",\"name\":\"b.json\",\"xxh3_128\":\"0123456789abcdef000000000000000f\"}]}") == 0);

    const char *copy;
    CHECK(meso_provenance_copy(&copy, text, strlen(text), "file", &arena, &error) == MESO_OK);
    CHECK(copy != text && strcmp(copy, text) == 0);
    CHECK(meso_provenance_copy(&copy, text, strlen(text) - 1, "file", &arena, &error) == MESO_ERR_INPUT);
    CHECK(strncmp(error.message, "file: chunk 'prov':1:", 21) == 0);
    CHECK(meso_provenance_copy(&copy, "{\"a\": 1\0}", 9, "file", &arena, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "file: chunk 'prov':1:8: a zero byte, which is not text") == 0);
    CHECK(meso_provenance_copy(&copy, "{\"\xff\": 1}", 8, "file", &arena, &error) == MESO_ERR_INPUT);
    CHECK(meso_provenance_copy(&copy, "[]", 2, "file", &arena, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "file: chunk 'prov': is not an object") == 0);
    CHECK(meso_provenance_copy(&copy, "", 0, "file", &arena, &error) == MESO_ERR_INPUT);
    meso_arena_release(&arena);
}

static void expect_name(MesoArena *arena, const char *path, const char *name)
{
    MesoError error;
    CHECK(strcmp(meso_provenance_name(path, arena, &error), name) == 0);
}

static void test_names(void)
{
    MesoArena arena;
    meso_arena_init(&arena);
    expect_name(&arena, "a", "a");
    expect_name(&arena, "/a/b.c", "b.c");
    expect_name(&arena, "../a//", "a");
    expect_name(&arena, "/", "/");
    expect_name(&arena, "//", "//");
    expect_name(&arena, "-", "-");
    expect_name(&arena, "", "");
    meso_arena_release(&arena);
}

/* The provenance with one input that has these bytes; owned by the caller. */
static json_t *with_input(const void *data, size_t size, MesoProvenanceDetail detail)
{
    MesoProvenance provenance = {.tool = "t", .command_line = "t x", .detail = detail};
    MesoInput input;
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    meso_input_wrap(&input, "../x", data, size);
    CHECK(meso_provenance_add(&provenance, "x", &input, &arena, &error) == MESO_OK);
    json_t *json = meso_provenance_json(&provenance);
    CHECK(json);
    meso_arena_release(&arena);
    return json;
}

static const json_t *first_input(const json_t *json)
{
    return json_array_get(json_object_get(json, "inputs"), 0);
}

static bool nests_bytes(const void *data, size_t size)
{
    json_t *json = with_input(data, size, MESO_PROVENANCE_NAMES);
    bool found = json_object_get(first_input(json), "provenance") != NULL;
    json_decref(json);
    return found;
}

static bool nests(const char *text)
{
    return nests_bytes(text, strlen(text));
}

static void test_detail(void)
{
    static const char file[] = "{\"provenance\": {\"tool\": \"u\"}}";
    json_t *json = with_input(file, sizeof file - 1, MESO_PROVENANCE_FULL);
    CHECK(strcmp(json_string_value(json_object_get(first_input(json), "name")), "../x") == 0);
    CHECK(json_object_get(first_input(json), "provenance"));
    json_decref(json);
    json = with_input(file, sizeof file - 1, MESO_PROVENANCE_NONE);
    CHECK(json_object_size(json) == 2 && json_object_get(json, "tool") && json_object_get(json, "version"));
    json_decref(json);
}

/* Only what is a provenance is taken over; broken files are for their readers. */
static void test_kinds(void)
{
    CHECK(nests(" {\"a\": 1, \"provenance\": {\"tool\": \"u\"}}"));
    CHECK(nests("ply\ncomment provenance {\"tool\": \"u\"}\nend_header\n"));
    CHECK(nests("# provenance {\"tool\": \"u\"}\nv 1"));
    CHECK(!nests(""));
    CHECK(!nests("{\"provenance\": {\"tool\": 3}}"));
    CHECK(!nests("{\"provenance\": {\"tool\": \"u\"}"));
    CHECK(!nests("{\"provenance\": [\"tool\"]}"));
    CHECK(!nests("MESOFILE"));
}

/* One that is too deep or too long leaves the hash alone; a chain that grows is cut, and stays readable. */
static void test_limits(void)
{
    static char text[2 * MESO_PROVENANCE_NESTED];
    int size = snprintf(text, sizeof text, "{\"provenance\":{\"tool\":\"u\",\"a\":\"");
    memset(text + size, 'x', MESO_PROVENANCE_NESTED);
    const size_t most = (size_t)size + MESO_PROVENANCE_NESTED - strlen("{\"tool\":\"u\",\"a\":\"\"}");
    memcpy(text + most, "\"}}", 3);
    CHECK(nests_bytes(text, most + 3));
    memcpy(text + most, "x\"}}", 4);
    CHECK(!nests_bytes(text, most + 4));

    size = snprintf(text, sizeof text, "{\"provenance\":{\"tool\":\"u\",\"a\":");
    for (int levels = MESO_PROVENANCE_LEVELS - 1; levels < MESO_PROVENANCE_LEVELS + 1; levels++) {
        memset(text + size, '[', (size_t)levels);
        memset(text + size + levels, ']', (size_t)levels);
        memcpy(text + size + 2 * levels, "}}", 2);
        CHECK(nests_bytes(text, (size_t)size + 2 * (size_t)levels + 2) == (levels < MESO_PROVENANCE_LEVELS));
    }

    json_t *file = json_pack("{s:{s:s}}", "provenance", "tool", "u");
    uint32_t cuts = 0;
    for (int step = 0; step < 100; step++) {
        char *dump = json_dumps(file, 0);
        json_t *next = with_input(dump, strlen(dump), MESO_PROVENANCE_NAMES);
        cuts += json_object_get(first_input(next), "provenance") == NULL;
        free(dump);
        json_decref(file);
        file = json_pack("{s:o}", "provenance", next);
    }
    json_decref(file);
    CHECK(cuts >= 3 && cuts <= 6);
}

/* All inputs share the limit. */
static void test_sum(void)
{
    static char text[MESO_PROVENANCE_NESTED];
    MesoProvenance provenance = {.tool = "t", .command_line = "t"};
    MesoInput input;
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    int size = snprintf(text, sizeof text, "{\"provenance\":{\"tool\":\"%030000d\"}}", 0);
    meso_input_wrap(&input, "x", text, (size_t)size);
    for (int i = 0; i < 4; i++)
        CHECK(meso_provenance_add(&provenance, "x", &input, &arena, &error) == MESO_OK);
    CHECK(provenance.inputs[0].nested && provenance.inputs[1].nested);
    CHECK(!provenance.inputs[2].nested && !provenance.inputs[3].nested);
    meso_arena_release(&arena);
}

int main(void)
{
    test_text();
    test_names();
    test_detail();
    test_kinds();
    test_limits();
    test_sum();
    return 0;
}
