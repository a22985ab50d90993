#include "formats/tiling/constraints/constraint_places.h"

#include <math.h>
#include <string.h>

enum { MOST_ITEMS = 1 << 20 };

/* 2 GiB of slot numbers in all. */
static const uint64_t places_limit = (uint64_t)1 << 29;

/* A condition that each face fulfils or not. */
typedef struct Condition {
    const MesoAttribute *attribute;
    const uint8_t *chosen;          /* [entry_count] of names, the ones that fulfil it; NULL: a number is to lie */
    uint32_t component;             /* in this place */
    double low, high;               /* between these */
} Condition;

enum { CONDITION_COUNT = 4 };

typedef struct Selection {
    Condition conditions[CONDITION_COUNT];
    uint32_t count;
} Selection;

static void *allocate(MesoPlaceSelector *selector, uint64_t count, size_t size)
{
    void *array = meso_arena_alloc(selector->reader->arena, count, size, selector->reader->error);
    if (!array && !selector->reader->status)
        selector->reader->status = MESO_ERR_MEMORY;
    return array;
}

/* Array for `count` more places, NULL past the limit. */
static uint32_t *new_places(MesoPlaceSelector *selector, uint32_t count)
{
    MesoJsonReader *reader = selector->reader;
    selector->total += count;
    if (selector->total > places_limit && !reader->status)
        reader->status = meso_fail(reader->error, MESO_ERR_LIMIT, "%s: too many places: over %llu", reader->path,
                                   (unsigned long long)places_limit);
    return reader->status ? NULL : allocate(selector, count, sizeof(uint32_t));
}

/* True if the entry `names` is `name`, or has it among its words: a statement `g a b` puts faces into both groups. */
static bool has_word(const char *names, const char *name)
{
    size_t length = strlen(name);
    for (const char *word = names; *word && length > 0;) {
        size_t size = strcspn(word, " ");
        if (size == length && memcmp(word, name, length) == 0)
            return true;
        word += size;
        word += strspn(word, " ");
    }
    return strcmp(names, name) == 0;
}

/* Names are attributes of faces: "group", "object", "material". */
static void add_names(MesoPlaceSelector *selector, const MesoJsonField *where, const char *key, Selection *selection)
{
    MesoJsonField field = meso_json_key(where, key);
    const MesoAttribute *attribute = meso_polygon_attribute_on(selector->mesh, key, MESO_ON_FACES);
    uint32_t count = attribute && attribute->width == 0 ? attribute->entry_count : 0;
    bool groups = strcmp(key, "group") == 0, any = false;
    if (!field.value)
        return;
    const char *name = meso_json_text(&field);
    uint8_t *chosen = allocate(selector, count, 1);
    for (uint32_t i = 0; chosen && i < count; i++) {
        chosen[i] = groups ? has_word(attribute->names[i], name) : strcmp(attribute->names[i], name) == 0;
        any |= chosen[i];
    }
    if (!any)
        meso_json_wrong(&field, "the surface has no %s '%.80s'", key, name);
    selection->conditions[selection->count++] = (Condition){.attribute = attribute, .chosen = chosen};
}

static double read_number(const MesoJsonField *field)
{
    if (json_is_number(field->value))
        return json_number_value(field->value);
    meso_json_require(field);
    meso_json_wrong(field, "a number is needed here");
    return 0;
}

static void add_property(MesoPlaceSelector *selector, const MesoJsonField *where, Selection *selection)
{
    MesoJsonField field = meso_json_key(where, "property"), value = meso_json_key(where, "value");
    MesoJsonField range = meso_json_key(where, "range");
    if (!field.value && (value.value || range.value))
        meso_json_wrong(where, "\"value\" and \"range\" go with \"property\"");
    if (!field.value)
        return;
    if (!value.value == !range.value)
        meso_json_wrong(where, "with \"property\", either \"value\" or \"range\" is needed");
    uint32_t component;
    const MesoAttribute *attribute = meso_polygon_number(selector->mesh, meso_json_text(&field), &component);
    if (meso_json_good(where) && !attribute)
        meso_json_wrong(&field, "the surface has no property '%.80s'", json_string_value(field.value));
    if (!meso_json_good(where))
        return;
    Condition condition = {.attribute = attribute, .component = component};
    if (value.value) {
        condition.low = condition.high = read_number(&value);
    } else if (meso_json_count(&range, 2, 2) == 2) {
        MesoJsonField low = meso_json_item(&range, 0), high = meso_json_item(&range, 1);
        condition.low = read_number(&low);
        condition.high = read_number(&high);
        if (condition.low > condition.high)
            meso_json_wrong(&range, "the lower end is above the upper one");
    }
    selection->conditions[selection->count++] = condition;
}

static bool fulfils(const MesoPolygonMesh *mesh, const Selection *selection, uint32_t slot)
{
    for (uint32_t i = 0; i < selection->count; i++) {
        const Condition *condition = &selection->conditions[i];
        uint32_t entry = condition->chosen ? meso_attribute_entry(condition->attribute, slot) : 0;
        if (condition->chosen && (entry == MESO_NO_INDEX || !condition->chosen[entry]))
            return false;
        if (condition->chosen)
            continue;
        double value = meso_polygon_face_number(mesh, condition->attribute, condition->component, slot);
        if (!(value >= condition->low && value <= condition->high))
            return false;
    }
    return true;
}

static uint32_t slot_number(const MesoPlaceSelector *selector, const MesoJsonField *field)
{
    return (uint32_t)meso_json_whole(field, 0, (int64_t)selector->slot_count - 1, 0);
}

/* Slots [low, high] of an item of "slots": a number, or a pair of the first and the last. */
static void read_span(const MesoPlaceSelector *selector, const MesoJsonField *item, uint32_t *low, uint32_t *high)
{
    if (!json_is_array(item->value)) {
        *low = *high = slot_number(selector, item);
        return;
    }
    *low = *high = 0;
    if (meso_json_count(item, 2, 2) != 2)
        return;
    MesoJsonField first = meso_json_item(item, 0), last = meso_json_item(item, 1);
    *low = slot_number(selector, &first);
    *high = slot_number(selector, &last);
    if (*low > *high)
        meso_json_wrong(item, "the first slot is behind the last");
}

/* Slots of all spans that fulfil the conditions, to `places` where that is not NULL; their number. */
static uint64_t go_through(const MesoPlaceSelector *selector, const Selection *selection, const uint32_t (*spans)[2],
                           uint32_t span_count, uint32_t *places)
{
    uint64_t count = 0;
    for (uint32_t i = 0; i < span_count; i++)
        for (uint32_t s = spans[i][0]; s <= spans[i][1] && s < selector->slot_count; s++)
            if (fulfils(selector->mesh, selection, s)) {
                if (places)
                    places[count] = s;
                count++;
            }
    return count;
}

uint32_t *meso_places_select(MesoPlaceSelector *selector, const MesoJsonField *where, uint32_t *count)
{
    static const char *const keys[] = {"slots", "group", "object", "material", "property", "value", "range", NULL};
    Selection selection = {.count = 0};
    *count = 0;
    if (!meso_json_object(where, keys))
        return NULL;
    add_names(selector, where, "group", &selection);
    add_names(selector, where, "object", &selection);
    add_names(selector, where, "material", &selection);
    add_property(selector, where, &selection);

    MesoJsonField slots = meso_json_key(where, "slots");
    uint32_t span_count = slots.value ? meso_json_count(&slots, 1, MOST_ITEMS) : 1;
    uint32_t(*spans)[2] = allocate(selector, span_count, sizeof *spans);
    uint64_t spanned = 0;
    for (uint32_t i = 0; spans && i < span_count && meso_json_good(where); i++) {
        MesoJsonField item = meso_json_item(&slots, i);
        spans[i][1] = selector->slot_count - 1;
        if (slots.value)
            read_span(selector, &item, &spans[i][0], &spans[i][1]);
        spanned += spans[i][1] - spans[i][0] + (uint64_t)1;
        if (spanned >= places_limit)
            meso_json_wrong(&item, "too many slots so far: %llu", (unsigned long long)spanned);
    }
    if (!spans || !meso_json_good(where))
        return NULL;
    uint64_t found = go_through(selector, &selection, (const uint32_t (*)[2])spans, span_count, NULL);
    if (found == 0)
        meso_json_wrong(where, "selects no slot");
    uint32_t *places = meso_json_good(where) ? new_places(selector, (uint32_t)found) : NULL;
    if (places) {
        go_through(selector, &selection, (const uint32_t (*)[2])spans, span_count, places);
        *count = (uint32_t)found;
    }
    return places;
}

uint32_t *meso_places_of_slot(MesoPlaceSelector *selector, const MesoJsonField *slot, uint32_t *count)
{
    uint32_t number = slot_number(selector, slot);
    uint32_t *places = meso_json_good(slot) ? new_places(selector, 1) : NULL;
    *count = places != NULL;
    if (places)
        places[0] = number;
    return places;
}
