#define _GNU_SOURCE     /* memmem() */
#include "formats/product/provenance.h"

#include <assert.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "formats/file/container.h"
#include "formats/json/json_text.h"
#include "formats/product/product_file.h"

const char *meso_provenance_name(const char *path, MesoArena *arena, MesoError *error)
{
    size_t end = strlen(path);
    while (end > 1 && path[end - 1] == '/')
        end--;
    size_t begin = end;
    while (begin > 0 && path[begin - 1] != '/')
        begin--;
    if (begin == end)   /* the root, or nothing */
        return meso_arena_copy_text(arena, path, error);
    return meso_arena_print(arena, error, "%.*s", (int)(end - begin), path + begin);
}

/* ---- of inputs ---- */

static bool holds(const MesoInput *input, const char *text)
{
    return memmem(input->data, input->size, text, strlen(text)) != NULL;
}

/* JSON from its text, where that is what it is. */
static MesoStatus parse_quietly(json_t **root, const void *data, size_t size)
{
    MesoInput text;
    meso_input_wrap(&text, "provenance", data, size);
    MesoStatus status = meso_json_parse(root, &text, NULL);
    return status == MESO_ERR_MEMORY ? status : MESO_OK;
}

static MesoStatus find_in_chunk(json_t **found, const MesoInput *input)
{
    uint64_t size;
    const void *text = meso_container_peek(input, "prov", &size);
    return text ? parse_quietly(found, text, size) : MESO_OK;
}

static MesoStatus find_in_json(json_t **found, const MesoInput *input)
{
    json_t *root = NULL;
    if (!holds(input, "\"provenance\""))   /* most have none, and need not be parsed twice */
        return MESO_OK;
    MesoStatus status = meso_json_parse(&root, input, NULL);
    *found = json_incref(json_object_get(root, "provenance"));
    json_decref(root);
    return status == MESO_ERR_MEMORY ? status : MESO_OK;
}

static bool begins_json(const MesoInput *input)
{
    size_t i = 0;
    while (i < input->size && strchr(" \t\r\n", input->data[i]) && input->data[i])
        i++;
    return i < input->size && input->data[i] == '{';
}

MesoStatus meso_provenance_find(json_t **found, const MesoInput *input, MesoError *error)
{
    MesoProductKind kind = meso_product_recognise(input);
    MesoStatus status = MESO_OK;
    *found = NULL;
    if (meso_container_recognise(input))
        status = find_in_chunk(found, input);
    else if (kind != MESO_PRODUCT_NONE)
        status = meso_product_provenance(found, kind, input);
    else if (begins_json(input))
        status = find_in_json(found, input);
    if (status)
        return meso_fail(error, status, "out of memory for the provenance of '%s'", input->path);
    if (json_is_string(json_object_get(*found, "tool")))
        return MESO_OK;
    json_decref(*found);
    *found = NULL;
    return MESO_OK;
}

static bool is_deeper(const json_t *value, int levels)
{
    const char *key;
    json_t *item;
    size_t index;
    if (!json_is_object(value) && !json_is_array(value))
        return false;
    if (levels == 0)
        return true;
    json_object_foreach((json_t *)(uintptr_t)value, key, item)
        if (is_deeper(item, levels - 1))
            return true;
    json_array_foreach(value, index, item)
        if (is_deeper(item, levels - 1))
            return true;
    return false;
}

/* `*text` becomes NULL where there is none, or too much of it. */
static MesoStatus nested_text(const char **text, const MesoProvenance *provenance, const MesoInput *input,
                              MesoArena *arena, MesoError *error)
{
    json_t *found;
    MesoStatus status = meso_provenance_find(&found, input, error);
    *text = NULL;
    if (status || !found || is_deeper(found, MESO_PROVENANCE_LEVELS)) {
        json_decref(found);
        return status;
    }
    char *dump = json_dumps(found, JSON_COMPACT);
    json_decref(found);
    if (!dump)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory for the provenance of '%s'", input->path);
    bool fits = strlen(dump) <= MESO_PROVENANCE_NESTED - provenance->nested_size;
    if (fits && !(*text = meso_arena_copy_text(arena, dump, error)))
        status = MESO_ERR_MEMORY;
    free(dump);
    return status;
}

MesoStatus meso_provenance_add(MesoProvenance *provenance, const char *role, const MesoInput *input, MesoArena *arena,
                               MesoError *error)
{
    assert(provenance->input_count < MESO_PROVENANCE_INPUTS);
    uint32_t i = provenance->input_count;
    const char *nested = NULL, *name = provenance->detail == MESO_PROVENANCE_FULL
                                           ? meso_arena_copy_text(arena, input->path, error)
                                           : meso_provenance_name(input->path, arena, error);
    if (!name)
        return MESO_ERR_MEMORY;
    MesoStatus status = provenance->detail == MESO_PROVENANCE_NONE
                            ? MESO_OK
                            : nested_text(&nested, provenance, input, arena, error);
    if (status)
        return status;
    provenance->inputs[i].role = role;
    memcpy(provenance->inputs[i].hash, input->hash, sizeof input->hash);
    provenance->inputs[i].name = name;
    provenance->inputs[i].nested = nested;
    provenance->nested_size += nested ? strlen(nested) : 0;
    provenance->input_count++;
    return MESO_OK;
}

/* ---- out ---- */

static json_t *input_json(const MesoProvenance *provenance, uint32_t i)
{
    char hash[33];
    const char *nested = provenance->inputs[i].nested;
    snprintf(hash, sizeof hash, "%016" PRIx64 "%016" PRIx64, provenance->inputs[i].hash[0],
             provenance->inputs[i].hash[1]);
    json_t *entry = json_object();
    int failed = json_object_set_new(entry, "role", meso_json_string(provenance->inputs[i].role));
    failed |= json_object_set_new(entry, "name", meso_json_string(provenance->inputs[i].name));
    failed |= json_object_set_new(entry, "xxh3_128", json_string(hash));
    if (nested)
        failed |= json_object_set_new(entry, "provenance", json_loads(nested, 0, NULL));
    if (!failed)
        return entry;
    json_decref(entry);
    return NULL;
}

static json_t *inputs_json(const MesoProvenance *provenance)
{
    json_t *list = json_array();
    for (uint32_t i = 0; i < provenance->input_count; i++)
        if (json_array_append_new(list, input_json(provenance, i)) != 0) {
            json_decref(list);
            return NULL;
        }
    return list;
}

json_t *meso_provenance_json(const MesoProvenance *provenance)
{
    json_t *root = json_object();
    int failed = json_object_set_new(root, "tool", meso_json_string(provenance->tool));
    failed |= json_object_set_new(root, "version", json_string(MESO_VERSION));
    if (provenance->detail != MESO_PROVENANCE_NONE) {
        failed |= json_object_set_new(root, "command", meso_json_string(provenance->command_line));
        failed |= json_object_set_new(root, "seed", json_integer((json_int_t)provenance->seed));
        failed |= json_object_set_new(root, "inputs", inputs_json(provenance));
    }
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

/* Some readers of PLY and OBJ take no line over 1023 bytes. */
enum { PIECE = 960 };

const char *meso_provenance_lines(const MesoProvenance *provenance, const char *mark, MesoArena *arena,
                                  MesoError *error)
{
    const char *text = provenance ? meso_provenance_text(provenance, arena, error) : "";
    size_t left = text ? strlen(text) : 0, count = left / (PIECE - 3) + 1;
    char *lines = text ? MESO_NEW(arena, char, left + count * (strlen(mark) + 16) + 1, error) : NULL;
    char *out = lines;
    for (bool first = true; lines && left > 0; first = false) {
        size_t size = left < PIECE ? left : PIECE;
        while (size < left && ((unsigned char)text[size] & 0xc0) == 0x80 && size > PIECE - 3)
            size--;     /* characters stay whole */
        out += sprintf(out, "%sprovenance%s %.*s\n", mark, first ? "" : "+", (int)size, text);
        text += size;
        left -= size;
    }
    return lines;
}

MesoStatus meso_provenance_copy(const char **text, const void *data, uint64_t size,
                                const char *path, MesoArena *arena, MesoError *error)
{
    MesoInput input;
    json_t *root = NULL;
    meso_input_wrap(&input, "chunk 'prov'", data, size);
    MesoStatus status = meso_json_parse(&root, &input, error);
    if (!status && !json_is_object(root))
        status = meso_fail(error, MESO_ERR_INPUT, "chunk 'prov': is not an object");
    json_decref(root);
    if (status) {
        meso_fail_prefix(error, path);
        return status;
    }
    char *copy = MESO_NEW(arena, char, (size_t)size + 1, error);
    if (!copy)
        return MESO_ERR_MEMORY;
    *text = memcpy(copy, data, size);
    return MESO_OK;
}
