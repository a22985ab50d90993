/* JSON parser: whatever is read must be written, and read back equal. */
#include "formats/json/json_text.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Writes `root` to a file, and parses that. */
static json_t *write_and_parse(const json_t *root)
{
    static char path[] = "/tmp/meso-fuzz-XXXXXX";
    MesoOutput *output;
    MesoInput input;
    MesoError error;
    json_t *back;
    if (strstr(path, "XXXXXX"))
        close(mkstemp(path));
    if (meso_output_open(&output, path, &error) != MESO_OK ||
        meso_json_write(root, output, &error) != MESO_OK ||
        meso_output_commit(output, &error) != MESO_OK ||
        meso_input_open(&input, path, &error) != MESO_OK ||
        meso_json_parse(&back, &input, &error) != MESO_OK)
        abort();
    meso_input_close(&input);
    return back;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    MesoInput input;
    MesoError error;
    json_t *root;
    meso_input_wrap(&input, "fuzz", data, size);
    if (meso_json_parse(&root, &input, &error) == MESO_OK) {
        json_t *back = write_and_parse(root);
        if (!json_equal(root, back))
            abort();
        meso_json_check_format(root, "fuzz", "meso-tiles", 1, &error);
        json_decref(back);
    }
    json_decref(root);
    return 0;
}
