#include "cmd/replicate/replicate_scene.h"

#include "formats/model/scene_backdrop.h"

static bool is_shown(const MesoPlacedDetail *placed)
{
    return placed->size > 0 && placed->width > 0;
}

/* x along the tangent, z along the normal; as high as the root of size times width. */
static MesoFrame frame_of(const MesoPlacedDetail *d)
{
    MesoVec3 x = meso_vec3_scale(d->tangent, d->size);
    MesoVec3 y = meso_vec3_scale(meso_vec3_cross(d->normal, d->tangent), d->width);
    MesoVec3 z = meso_vec3_scale(d->normal, sqrtf(d->size * d->width)), p = d->position;
    return (MesoFrame){{x.x, y.x, z.x, p.x, x.y, y.y, z.y, p.y, x.z, y.z, z.z, p.z}};
}

static void count_parts(const MesoReplicateRun *r, const MesoReplicateKinds *kinds, const MesoPlacedDetail *placed,
                        uint32_t *details, uint64_t *parts)
{
    *details = 0;
    *parts = 0;
    for (uint32_t i = 0; i < r->count; i++) {
        uint32_t kind = r->details[i].kind;
        *details += is_shown(&placed[i]);
        *parts += is_shown(&placed[i]) ? kinds->body_begin[kind + 1] - kinds->body_begin[kind] : 0;
    }
}

static void place_detail(MesoScene *s, const MesoReplicateKinds *kinds, const MesoDetail *detail, uint32_t id,
                         const MesoPlacedDetail *placed)
{
    uint32_t row = s->id_row_count++, frame = s->frame_count++;
    s->ids[2 * row] = id;
    s->ids[2 * row + 1] = detail->kind;
    s->frames[frame] = frame_of(placed);
    for (uint32_t b = kinds->body_begin[detail->kind]; b < kinds->body_begin[detail->kind + 1]; b++)
        s->placed[s->placed_count++] = (MesoPlacedBody){
            .body = b, .material = kinds->body_materials[b], .ids = row, .frame = frame, .place = MESO_PLACED_IN_FRAME};
}

MesoStatus meso_replicate_scene(MesoScene *s, const MesoReplicateRun *r, const MesoReplicateKinds *kinds,
                                const MesoPlacedDetail *placed, const MesoPolygonMesh *surface, const char *material)
{
    MesoArena *arena = &r->tool->arena;
    MesoError *error = &r->tool->error;
    uint32_t details;
    uint64_t parts;
    count_parts(r, kinds, placed, &details, &parts);
    if (parts >= UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "over 2^32 parts");
    *s = (MesoScene){.channel_count = 2,
                     .channels = {{"detail", r->count, NULL}, {"kind", kinds->kind_count, kinds->names}},
                     .material_count = kinds->material_count, .materials = kinds->materials,
                     .material_names = kinds->material_names, .body_count = kinds->body_begin[kinds->kind_count],
                     .bodies = kinds->bodies, .ids = MESO_NEW(arena, uint32_t, 2 * (size_t)details, error),
                     .frames = MESO_NEW(arena, MesoFrame, details, error),
                     .placed = MESO_NEW(arena, MesoPlacedBody, parts, error)};
    if (!s->ids || !s->frames || !s->placed)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < r->count; i++)
        if (is_shown(&placed[i]))
            place_detail(s, kinds, &r->details[i], i, &placed[i]);
    meso_scene_measure(s);
    return surface ? meso_scene_add_backdrop(s, arena, surface, material, error) : MESO_OK;
}
