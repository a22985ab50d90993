/* Provenance: the same text for the same making, whatever bytes it holds. */
#include "formats/provenance.h"

#include <string.h>

#include "libcore/base/check.h"

int main(void)
{
    MesoProvenance provenance = {.tool = "meso-try", .command_line = "meso-try '\xff\n'", .seed = INT64_MAX};
    MesoInput input = {.hash = {0x0123456789abcdef, 0xf}};
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    meso_provenance_add(&provenance, "tiles", &input);
    meso_provenance_add(&provenance, "surface", &input);
    CHECK(provenance.input_count == 2);
    const char *text = meso_provenance_text(&provenance, &arena, &error);
    CHECK(strcmp(text, "{\"tool\":\"meso-try\",\"version\":\"" MESO_VERSION "\",\"command\":"
                       "\"meso-try '?\\n'\",\"seed\":9223372036854775807,\"inputs\":["
                       "{\"role\":\"tiles\",\"xxh3_128\":\"0123456789abcdef000000000000000f\"},"
                       "{\"role\":\"surface\",\"xxh3_128\":\"0123456789abcdef000000000000000f\"}]}") == 0);

    const char *copy;
    CHECK(meso_provenance_copy(&copy, text, strlen(text), "file", &arena, &error) == MESO_OK);
    CHECK(copy != text && strcmp(copy, text) == 0);
    CHECK(meso_provenance_copy(&copy, text, strlen(text) - 1, "file", &arena, &error) == MESO_ERR_INPUT);
    CHECK(strncmp(error.message, "file: chunk 'prov':1:", 21) == 0);
    CHECK(meso_provenance_copy(&copy, "[]", 2, "file", &arena, &error) == MESO_ERR_INPUT);
    CHECK(strcmp(error.message, "file: chunk 'prov': is not an object") == 0);
    CHECK(meso_provenance_copy(&copy, "", 0, "file", &arena, &error) == MESO_ERR_INPUT);
    meso_arena_release(&arena);
    return 0;
}
