/* Headers of products: nothing but the bytes is read, and what is found is JSON that can be printed and passed on. */
#include <stdlib.h>
#include <string.h>

#include "formats/product/file_kind.h"
#include "formats/product/product_file.h"
#include "formats/product/provenance.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Whatever an input says of its making, the provenance of the product can be read back. */
static void pass_on(const MesoInput *input)
{
    MesoProvenance provenance = {.tool = "meso-try", .command_line = "meso-try fuzz"};
    const char *text, *copy;
    MesoArena arena;
    MesoError error;
    meso_arena_init(&arena);
    if (meso_provenance_add(&provenance, "x", input, &arena, &error) != MESO_OK)
        abort();
    text = meso_provenance_text(&provenance, &arena, &error);
    if (!text || meso_provenance_copy(&copy, text, strlen(text), "fuzz", &arena, &error) != MESO_OK)
        abort();
    meso_arena_release(&arena);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoInput input;
    MesoError error;
    meso_input_wrap(&input, "fuzz", data, size);
    MesoProductKind kind = meso_product_recognise(&input);
    if (!meso_file_kind_phrase(meso_file_kind(&input)))
        abort();
    json_t *facts = json_object();
    MesoStatus status = meso_product_describe(facts, kind, &input, &error);
    if (status && status != MESO_ERR_INPUT)
        abort();
    char *text = json_dumps(facts, 0);
    if (!text)
        abort();
    free(text);
    json_decref(facts);
    pass_on(&input);
    return 0;
}
