/* Headers of products: nothing but the bytes is read, and what is found is JSON that can be printed. */
#include <stdlib.h>

#include "formats/product_file.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoInput input;
    MesoError error;
    meso_input_wrap(&input, "fuzz", data, size);
    MesoProductKind kind = meso_product_recognise(&input);
    json_t *facts = json_object();
    MesoStatus status = meso_product_describe(facts, kind, &input, &error);
    if (status != MESO_OK && status != MESO_ERR_INPUT)
        abort();
    char *text = json_dumps(facts, 0);
    if (!text)
        abort();
    free(text);
    json_decref(facts);
    return 0;
}
