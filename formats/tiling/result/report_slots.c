#include "formats/tiling/result/report_slots.h"

#include "formats/json/json_text.h"
#include "formats/json/json_value.h"
#include "formats/tiling/result/report_file.h"

/* The slot of a field that must be there. */
static uint32_t read_slot(const MesoJsonField *field, const MesoReportSlots *slots)
{
    meso_json_require(field);
    return (uint32_t)meso_json_whole(field, 0, (int64_t)slots->slot_count - 1, 0);
}

static void add_dead_ends(MesoReportSlots *slots, const MesoJsonField *at, uint32_t count)
{
    uint32_t slot = read_slot(at, slots);
    if (!meso_json_good(at))
        return;
    uint32_t room = UINT32_MAX - slots->dead_ends[slot];
    slots->dead_ends[slot] += count < room ? count : room;
}

/* Hot spots count them all; where there are none, those that were kept are counted. */
static void read_dead_ends(MesoReportSlots *slots, const MesoJsonField *root)
{
    MesoJsonField spots = meso_json_key(root, "hot_spots"), ends = meso_json_key(root, "dead_ends");
    const MesoJsonField *list = spots.value ? &spots : &ends;
    uint32_t count = meso_json_count(list, 0, UINT32_MAX);
    for (uint32_t i = 0; i < count && meso_json_good(root); i++) {
        MesoJsonField item = meso_json_item(list, i);
        if (!meso_json_object(&item, NULL))
            return;
        MesoJsonField slot = meso_json_key(&item, "slot"), met = meso_json_key(&item, "dead_ends");
        add_dead_ends(slots, &slot, (uint32_t)meso_json_whole(&met, 0, UINT32_MAX, 1));
    }
}

static void read_core(MesoReportSlots *slots, const MesoJsonField *root)
{
    MesoJsonField core = meso_json_key(root, "core");
    if (!core.value || !meso_json_object(&core, NULL))
        return;
    MesoJsonField list = meso_json_key(&core, "slots");
    uint32_t count = meso_json_count(&list, 0, UINT32_MAX);
    slots->core = count > 0;
    for (uint32_t i = 0; i < count && meso_json_good(root); i++) {
        MesoJsonField item = meso_json_item(&list, i);
        uint32_t slot = read_slot(&item, slots);
        if (meso_json_good(&item))
            slots->in_core[slot] = 1;
    }
}

static void check_count(const MesoReportSlots *slots, const MesoJsonField *root)
{
    MesoJsonField count = meso_json_key(root, "slots");
    meso_json_require(&count);
    int64_t found = meso_json_whole(&count, 0, UINT32_MAX, 0);
    if (meso_json_good(root) && found != slots->slot_count)
        meso_json_wrong(&count, "it is about %lld slots, but the surface has %u faces", (long long)found,
                        slots->slot_count);
}

MesoStatus meso_report_slots_read(MesoReportSlots *slots, MesoArena *arena, const MesoInput *input, uint32_t slot_count,
                                  MesoError *error)
{
    json_t *json;
    *slots = (MesoReportSlots){.slot_count = slot_count};
    slots->dead_ends = MESO_NEW(arena, uint32_t, slot_count, error);
    slots->in_core = MESO_NEW(arena, uint8_t, slot_count, error);
    if (!slots->dead_ends || !slots->in_core)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_json_parse(&json, input, error);
    if (status)
        return status;
    status = meso_json_check_format(json, input->path, "meso-report", MESO_REPORT_VERSION, error);
    MesoJsonReader reader = {.path = input->path, .arena = arena, .error = error, .status = status};
    MesoJsonField root = meso_json_root(&reader, json);
    if (!status && meso_json_object(&root, NULL)) {
        check_count(slots, &root);
        if (!reader.status)
            read_dead_ends(slots, &root);
        if (!reader.status)
            read_core(slots, &root);
    }
    json_decref(json);
    return reader.status;
}
