#include "formats/json/json_files.h"

const MesoInput *meso_json_open(const MesoJsonFiles *files, const MesoJsonField *field, const char *name)
{
    MesoJsonReader *reader = field->reader;
    MesoError error;
    if (!meso_json_good(field))
        return NULL;
    if (!files) {
        meso_json_wrong(field, "other files cannot be read here");
        return NULL;
    }
    const MesoInput *input = files->open(files->context, name, &error);
    if (!input && error.status == MESO_ERR_INPUT)
        meso_json_wrong(field, "%s", error.message);
    else if (!input)
        reader->status = meso_fail(reader->error, error.status, "%s", error.message);
    return input;
}
