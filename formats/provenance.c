#include "formats/provenance.h"

#include <assert.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json_text.h"

void meso_provenance_add(MesoProvenance *provenance, const char *role, const MesoInput *input)
{
    assert(provenance->input_count < MESO_PROVENANCE_INPUTS);
    uint32_t i = provenance->input_count++;
    provenance->inputs[i].role = role;
    memcpy(provenance->inputs[i].hash, input->hash, sizeof input->hash);
}

static json_t *inputs_json(const MesoProvenance *provenance)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < provenance->input_count; i++) {
        char hash[33];
        snprintf(hash, sizeof hash, "%016" PRIx64 "%016" PRIx64, provenance->inputs[i].hash[0],
                 provenance->inputs[i].hash[1]);
        json_t *entry = json_object();
        int failed = json_object_set_new(entry, "role", meso_json_string(provenance->inputs[i].role));
        failed |= json_object_set_new(entry, "xxh3_128", json_string(hash));
        failed |= json_array_append_new(list, entry);
        if (failed) {
            json_decref(list);
            return NULL;
        }
    }
    return list;
}

json_t *meso_provenance_json(const MesoProvenance *provenance)
{
    json_t *root = json_object();
    int failed = json_object_set_new(root, "tool", meso_json_string(provenance->tool));
    failed |= json_object_set_new(root, "version", json_string(MESO_VERSION));
    failed |= json_object_set_new(root, "command", meso_json_string(provenance->command_line));
    failed |= json_object_set_new(root, "seed", json_integer((json_int_t)provenance->seed));
    failed |= json_object_set_new(root, "inputs", inputs_json(provenance));
    if (failed) {
        json_decref(root);
        return NULL;
    }
    return root;
}

const char *meso_provenance_text(const MesoProvenance *provenance, MesoArena *arena, MesoError *error)
{
    json_t *root = meso_provenance_json(provenance);
    char *text = root ? json_dumps(root, JSON_COMPACT) : NULL;
    json_decref(root);
    if (!text) {
        meso_fail(error, MESO_ERR_MEMORY, "out of memory for the provenance");
        return NULL;
    }
    const char *copy = meso_arena_copy_text(arena, text, error);
    free(text);
    return copy;
}

MesoStatus meso_provenance_copy(const char **text, const void *data, uint64_t size,
                                const char *path, MesoArena *arena, MesoError *error)
{
    MesoInput input;
    json_t *root = NULL;
    meso_input_wrap(&input, "chunk 'prov'", data, size);
    MesoStatus status = meso_json_parse(&root, &input, error);
    if (status == MESO_OK && !json_is_object(root))
        status = meso_fail(error, MESO_ERR_INPUT, "chunk 'prov': is not an object");
    json_decref(root);
    if (status != MESO_OK) {
        meso_fail_prefix(error, path);
        return status;
    }
    char *copy = MESO_NEW(arena, char, (size_t)size + 1, error);
    if (!copy)
        return MESO_ERR_MEMORY;
    *text = memcpy(copy, data, size);
    return MESO_OK;
}
