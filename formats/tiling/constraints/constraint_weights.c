#include "formats/tiling/constraints/constraint_weights.h"

#include <math.h>
#include <string.h>

#include "libcore/base/grow.h"

enum { MOST_STOPS = 1024 };

/* 2 GiB of weights. */
static const uint64_t weights_limit = ((uint64_t)2 << 30) / sizeof(MesoWeight);

/* The slots that weights are for; all of them where `places` is NULL. */
typedef struct Places {
    const uint32_t *places;
    uint32_t count;
} Places;

/* What one key of an object of weights says. */
typedef struct Setting {
    uint32_t tile;
    MesoWeight weight;
} Setting;

static void out_of_memory(MesoWeightReader *weights)
{
    MesoJsonReader *reader = weights->reader;
    if (!reader->status)
        reader->status = meso_fail(reader->error, MESO_ERR_MEMORY, "%s: out of memory", reader->path);
}

/* `count` zeroed elements, or NULL with the reader's status set. */
static void *allocate(MesoWeightReader *weights, uint64_t count, size_t size)
{
    void *array = meso_arena_alloc(weights->reader->arena, count, size, weights->reader->error);
    if (!array)
        out_of_memory(weights);
    return array;
}

/*
 * Weight in parts of one. A decimal with three places is read as the double that its
 * quotient of whole numbers is: anything else has more places, or is none.
 */
static uint64_t read_weight(MesoWeightReader *weights, const MesoJsonField *field)
{
    if (!json_is_real(field->value))
        return MESO_WEIGHT_PARTS * (uint64_t)meso_json_whole(field, 0, MESO_WEIGHT_LIMIT, 0);
    double value = json_real_value(field->value), parts = floor(value * MESO_WEIGHT_PARTS + 0.5);
    if (!(value >= 0 && value <= MESO_WEIGHT_LIMIT))
        meso_json_wrong(field, "%.15g; it must be from 0 to %d", value, MESO_WEIGHT_LIMIT);
    else if (parts / MESO_WEIGHT_PARTS != value)
        meso_json_wrong(field, "%.15g; a weight has at most three decimals", value);
    if (!meso_json_good(field))
        return 0;
    weights->fractions |= (uint64_t)parts % MESO_WEIGHT_PARTS != 0;
    return (uint64_t)parts;
}

/* --- ramps --- */

static double read_value(const MesoJsonField *field)
{
    meso_json_require(field);
    if (field->value && !json_is_number(field->value))
        meso_json_wrong(field, "a number is needed here");
    return json_number_value(field->value);
}

/* Stops of a ramp, [[value, weight], ...]. */
static MesoWeightStop *read_stops(MesoWeightReader *weights, const MesoJsonField *list, uint32_t *count)
{
    *count = meso_json_count(list, 2, MOST_STOPS);
    MesoWeightStop *stops = allocate(weights, *count, sizeof *stops);
    for (uint32_t i = 0; stops && i < *count && meso_json_good(list); i++) {
        MesoJsonField item = meso_json_item(list, i);
        if (meso_json_count(&item, 2, 2) != 2)
            break;
        MesoJsonField value = meso_json_item(&item, 0), weight = meso_json_item(&item, 1);
        stops[i].value = read_value(&value);
        stops[i].weight = (double)read_weight(weights, &weight) / MESO_WEIGHT_PARTS;
        if (i > 0 && stops[i].value <= stops[i - 1].value)
            meso_json_wrong(&value, "%g does not lie above %g; stops are listed by ascending value", stops[i].value,
                            stops[i - 1].value);
    }
    return stops;
}

/* The number that the surface calls `name`, of every slot; NULL where it has none. */
static const double *find_values(MesoWeightReader *weights, const char *name)
{
    MesoWeightColumn column;
    column.attribute = meso_polygon_number(weights->mesh, name, &column.component);
    for (uint32_t c = 0; c < weights->column_count; c++)
        if (weights->columns[c].attribute == column.attribute && weights->columns[c].component == column.component)
            return weights->columns[c].values;
    column.values = column.attribute ? allocate(weights, weights->slot_count, sizeof *column.values) : NULL;
    if (!column.values)
        return NULL;
    for (uint32_t slot = 0; slot < weights->slot_count; slot++)
        column.values[slot] = meso_polygon_face_number(weights->mesh, column.attribute, column.component, slot);
    weights->columns = MESO_GROW(weights->reader->arena, weights->columns, weights->column_count, weights->column_room,
                                 8, weights->reader->error);
    if (!weights->columns) {
        out_of_memory(weights);
        return NULL;
    }
    weights->columns[weights->column_count++] = column;
    return column.values;
}

/* Every slot that the ramp is for must have a number. */
static void check_values(const MesoWeightReader *weights, const MesoJsonField *property, const char *name,
                         const double *values, Places places)
{
    uint32_t count = places.places ? places.count : weights->slot_count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t slot = places.places ? places.places[i] : i;
        if (!isnan(values[slot]))
            continue;
        meso_json_wrong(property, "'%.80s' of slot %u is not a number", name, slot);
        return;
    }
}

/* Number of a new ramp, or MESO_NO_INDEX. */
static uint32_t add_ramp(MesoWeightReader *weights, MesoWeightRamp ramp)
{
    if (weights->ramp_count == weights->ramp_room) {
        uint32_t room = weights->ramp_room ? 2 * weights->ramp_room : 8;
        MesoWeightRamp *larger = allocate(weights, room, sizeof *larger);
        if (!larger)
            return MESO_NO_INDEX;
        if (weights->ramp_count)
            memcpy(larger, weights->ramps, weights->ramp_count * sizeof *larger);
        weights->ramps = larger;
        weights->ramp_room = room;
    }
    weights->ramps[weights->ramp_count] = ramp;
    return weights->ramp_count++;
}

static MesoWeight read_ramp(MesoWeightReader *weights, const MesoJsonField *field, Places places)
{
    static const char *const keys[] = {"property", "stops", NULL};
    MesoWeight weight = {MESO_WEIGHT_PARTS, MESO_NO_INDEX};
    if (!meso_json_object(field, keys))
        return weight;
    MesoJsonField property = meso_json_key(field, "property"), list = meso_json_key(field, "stops");
    const char *name = meso_json_text(&property);
    MesoWeightRamp ramp = {.values = find_values(weights, name)};
    if (ramp.values)
        check_values(weights, &property, name, ramp.values, places);
    else if (meso_json_good(field))
        meso_json_wrong(&property, "the surface has no property '%.80s'", name);
    ramp.stops = read_stops(weights, &list, &ramp.stop_count);
    if (meso_json_good(field))
        weight.ramp = add_ramp(weights, ramp);
    return weight;
}

/* --- tables --- */

static Setting read_setting(MesoWeightReader *weights, const MesoJsonField *field, Places places)
{
    Setting setting = {meso_constraint_tile(weights->names, field, field->key), {MESO_WEIGHT_PARTS, MESO_NO_INDEX}};
    if (json_is_object(field->value))
        setting.weight = read_ramp(weights, field, places);
    else if (json_is_number(field->value))
        setting.weight.amount = read_weight(weights, field);
    else
        meso_json_wrong(field, "a number, or an object with a ramp, is needed here");
    return setting;
}

static void apply(MesoWeightReader *weights, uint32_t table, const Setting *settings, uint32_t count)
{
    MesoWeight *of_tiles = weights->tables + (size_t)table * weights->names->set->tile_count;
    for (uint32_t i = 0; i < count; i++)
        of_tiles[settings[i].tile] = settings[i].weight;
}

/* A copy of table `from`; its number, or MESO_NO_INDEX. */
static uint32_t copy_table(MesoWeightReader *weights, uint32_t from)
{
    uint32_t tiles = weights->names->set->tile_count;
    MesoJsonReader *reader = weights->reader;
    if (((uint64_t)weights->table_count + 1) * weights->variants->count > weights_limit) {
        reader->status = meso_fail(reader->error, MESO_ERR_LIMIT, "%s: too many tables of weights: regions overlap "
                                   "in over %u ways", reader->path, weights->table_count);
        return MESO_NO_INDEX;
    }
    if (weights->table_count == weights->table_room) {
        MesoWeight *larger = allocate(weights, 2 * (uint64_t)weights->table_room * tiles, sizeof *larger);
        if (!larger)
            return MESO_NO_INDEX;
        memcpy(larger, weights->tables, (size_t)weights->table_count * tiles * sizeof *larger);
        weights->tables = larger;
        weights->table_room *= 2;
    }
    memcpy(weights->tables + (size_t)weights->table_count * tiles, weights->tables + (size_t)from * tiles,
           tiles * sizeof *weights->tables);
    return weights->table_count++;
}

/* Slots that shared a table before share one after. */
static void apply_to_places(MesoWeightReader *weights, Places places, const Setting *settings, uint32_t count)
{
    if (!weights->slot_table)
        weights->slot_table = allocate(weights, weights->slot_count, sizeof *weights->slot_table);
    uint32_t known = weights->table_count;
    uint32_t *next = allocate(weights, known, sizeof *next);
    if (!weights->slot_table || !next)
        return;
    memset(next, 0xff, known * sizeof *next);
    for (uint32_t i = 0; i < places.count; i++) {
        uint32_t *table = &weights->slot_table[places.places[i]];
        if (*table >= known)        /* a slot that is listed twice */
            continue;
        if (next[*table] == MESO_NO_INDEX) {
            next[*table] = copy_table(weights, *table);
            if (next[*table] == MESO_NO_INDEX)
                return;
            apply(weights, next[*table], settings, count);
        }
        *table = next[*table];
    }
}

void meso_weight_reader_begin(MesoWeightReader *weights)
{
    uint32_t tiles = weights->names->set->tile_count;
    weights->table_room = 4;
    weights->table_count = 1;
    weights->tables = allocate(weights, 4 * (uint64_t)tiles, sizeof *weights->tables);
    for (uint32_t t = 0; weights->tables && t < tiles; t++)
        weights->tables[t] = (MesoWeight){MESO_WEIGHT_PARTS, MESO_NO_INDEX};
}

void meso_weight_reader_add(MesoWeightReader *weights, const MesoJsonField *field, const uint32_t *places,
                            uint32_t count)
{
    const Places slots = {places, count};
    const char *name;
    json_t *value;
    uint32_t setting_count = 0;
    if (!field->value || !meso_json_object(field, NULL))
        return;
    Setting *settings = allocate(weights, json_object_size(field->value), sizeof *settings);
    json_object_foreach((json_t *)(uintptr_t)field->value, name, value) {
        MesoJsonField item = meso_json_key(field, name);
        if (!settings)
            return;
        settings[setting_count] = read_setting(weights, &item, slots);
        if (!meso_json_good(field) || settings[setting_count++].tile == MESO_NO_INDEX)
            return;
    }
    weights->given = true;
    if (places)
        apply_to_places(weights, slots, settings, setting_count);
    else
        apply(weights, 0, settings, setting_count);
}

/* Whole numbers are drawn by as they are: the same draws for every file of whole numbers. */
static void count_in_ones(MesoWeightReader *weights)
{
    size_t count = (size_t)weights->table_count * weights->names->set->tile_count;
    for (size_t i = 0; i < count; i++)
        weights->tables[i].amount /= MESO_WEIGHT_PARTS;
}

MesoWeights meso_weight_reader_finish(MesoWeightReader *weights)
{
    MesoJsonReader *reader = weights->reader;
    if (!weights->given || reader->status)
        return (MesoWeights){0};
    if (!weights->fractions)
        count_in_ones(weights);
    MesoWeights result = {.table_count = weights->table_count, .variant_count = weights->variants->count,
                          .slot_table = weights->slot_table, .ramps = weights->ramps};
    result.tables = meso_weights_of_variants(reader->arena, weights->variants, weights->names->set->tile_count,
                                             weights->table_count, weights->tables, reader->error);
    if (!result.tables)
        out_of_memory(weights);
    return result;
}
