#include "libcore/sketch/sketch.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/index.h"
#include "libcore/sketch/stroke_font.h"

enum { SIDES = 12, BALL_ROUND = 16, BALL_RINGS = 8, MOST_MATERIALS = UINT16_MAX };

static const double PI = 3.14159265358979323846;

/* ---- drawing ---- */

static bool grow(void **array, uint32_t room, size_t size)
{
    void *grown = realloc(*array, room * size);
    if (grown)
        *array = grown;
    return grown != NULL;
}

/* Whether there is room for so many more; half of what 32 bits count is the most. */
static bool make_room(MesoSketch *s, uint32_t bars, uint32_t vertices, uint32_t faces)
{
    const uint32_t most = UINT32_MAX / 2;
    if (s->bar_count > most - bars || s->vertex_count > most - vertices || s->face_count > most - faces)
        s->failed = true;
    if (!s->failed && s->bar_count + bars > s->bar_room) {
        s->bar_room = 2 * (s->bar_count + bars);
        s->failed = !grow((void **)&s->bars, s->bar_room, sizeof *s->bars);
    }
    if (!s->failed && s->vertex_count + vertices > s->vertex_room) {
        s->vertex_room = 2 * (s->vertex_count + vertices);
        s->failed = !grow((void **)&s->positions, s->vertex_room, sizeof *s->positions) ||
                    !grow((void **)&s->normals, s->vertex_room, sizeof *s->normals);
    }
    if (!s->failed && s->face_count + faces > s->face_room) {
        s->face_room = 2 * (s->face_count + faces);
        s->failed = !grow((void **)&s->faces, s->face_room, sizeof *s->faces);
    }
    return !s->failed;
}

void meso_sketch_part(MesoSketch *s, const char *name, const float albedo[3])
{
    if (!s->failed && s->part_count == s->part_room) {
        s->part_room = 2 * s->part_count + 4;
        s->failed = !grow((void **)&s->parts, s->part_room, sizeof *s->parts);
    }
    if (s->failed)
        return;
    s->parts[s->part_count++] = (MesoSketchPart){
        .name = name, .material = {{albedo[0], albedo[1], albedo[2]}, 0.6f, 0}, .bar_begin = s->bar_count,
        .vertex_begin = s->vertex_count, .face_begin = s->face_count};
}

static void add_bar(MesoSketch *s, MesoSketchBar bar)
{
    if (meso_vec3_length(meso_vec3_sub(bar.b, bar.a)) > 0 && make_room(s, 1, 0, 0))
        s->bars[s->bar_count++] = bar;
}

void meso_sketch_bar(MesoSketch *s, MesoVec3 a, MesoVec3 b, float radius)
{
    MesoVec3 way = meso_vec3_sub(b, a), more = meso_vec3_scale(meso_vec3_unit(way, way), 0.7f * radius);
    if (meso_vec3_length(way) > 0)
        add_bar(s, (MesoSketchBar){meso_vec3_sub(a, more), meso_vec3_add(b, more), {radius, radius}});
}

void meso_sketch_point(MesoSketch *s, MesoVec3 a, MesoVec3 b, float radius)
{
    add_bar(s, (MesoSketchBar){a, b, {radius, 1e-3f * radius}});
}

static void add_vertex(MesoSketch *s, MesoVec3 position, MesoVec3 normal)
{
    s->positions[s->vertex_count] = position;
    s->normals[s->vertex_count++] = normal;
}

/* Numbers of vertices count from the part's first. */
static void add_face(MesoSketch *s, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    s->faces[s->face_count++] = (MesoMeshFace){{a, b, c, d}};
}

static uint32_t next_vertex(const MesoSketch *s)
{
    return s->failed ? 0 : s->vertex_count - s->parts[s->part_count - 1].vertex_begin;
}

void meso_sketch_ball(MesoSketch *s, MesoVec3 middle, float radius)
{
    uint32_t first = next_vertex(s), round = BALL_ROUND + 1;
    if (!make_room(s, 0, round * (BALL_RINGS + 1), BALL_ROUND * BALL_RINGS))
        return;
    for (uint32_t j = 0; j <= BALL_RINGS; j++)
        for (uint32_t i = 0; i <= BALL_ROUND; i++) {
            double a = 2 * PI * (i % BALL_ROUND) / BALL_ROUND, t = PI * j / BALL_RINGS;
            MesoVec3 n = {(float)(sin(t) * cos(a)), (float)cos(t), (float)(-sin(t) * sin(a))};
            add_vertex(s, meso_vec3_mad(middle, radius, n), n);
        }
    for (uint32_t j = 0; j < BALL_RINGS; j++)
        for (uint32_t i = 0; i < BALL_ROUND; i++) {
            uint32_t v = first + j * round + i;
            add_face(s, v, v + round, v + round + 1, v + 1);
        }
}

void meso_sketch_face(MesoSketch *s, uint32_t count, const MesoVec3 *positions, const MesoVec3 *normals)
{
    uint32_t first = next_vertex(s);
    if (count < 3 || !make_room(s, 0, count, count - 2))
        return;
    for (uint32_t i = 0; i < count; i++)
        add_vertex(s, positions[i], normals[i]);
    if (count == 4)
        add_face(s, first, first + 1, first + 2, first + 3);
    for (uint32_t i = 1; count != 4 && i + 1 < count; i++)
        add_face(s, first, first + i, first + i + 1, MESO_NO_INDEX);
}

/* A stroke, longer by half its width at both ends. */
static void add_stroke(MesoSketch *s, MesoVec3 a, MesoVec3 b, MesoVec3 normal, float half)
{
    MesoVec3 along = meso_vec3_scale(meso_vec3_unit(meso_vec3_sub(b, a), normal), half);
    MesoVec3 across = meso_vec3_cross(normal, along);
    a = meso_vec3_sub(a, along);
    b = meso_vec3_add(b, along);
    const MesoVec3 corners[4] = {meso_vec3_sub(a, across), meso_vec3_sub(b, across), meso_vec3_add(b, across),
                                 meso_vec3_add(a, across)};
    const MesoVec3 normals[4] = {normal, normal, normal, normal};
    meso_sketch_face(s, 4, corners, normals);
}

void meso_sketch_text(MesoSketch *s, MesoVec3 start, MesoVec3 right, MesoVec3 up, float unit, const char *text)
{
    MesoVec3 normal = meso_vec3_cross(right, up), corner = meso_vec3_mad(start, -MESO_STROKE_BASE * unit, up);
    for (unsigned char letter; (letter = meso_stroke_next(&text)) != 0;) {
        MesoVec3 last = corner;
        bool drawn = false;     /* a stroke has begun */
        for (const char *p = meso_stroke_letter(letter); *p;) {
            if (*p == ' ') {
                drawn = false;
                p++;
                continue;
            }
            MesoVec3 at = meso_vec3_mad(meso_vec3_mad(corner, unit * (float)(p[0] - '0'), right),
                                        unit * (float)(p[1] - '0'), up);
            if (drawn)
                add_stroke(s, last, at, normal, 0.5f * MESO_STROKE_WIDTH * unit);
            last = at;
            drawn = true;
            p += 2;
        }
        corner = meso_vec3_mad(corner, MESO_STROKE_ADVANCE * unit, right);
    }
}

/* ---- into a scene ---- */

/* A longer copy of an array; NULL where memory is out. */
static void *longer(const void *array, size_t count, size_t more, size_t size, MesoArena *arena, MesoError *error)
{
    void *copy = meso_arena_alloc(arena, count + more, size, error);
    if (copy && count)
        memcpy(copy, array, count * size);
    return copy;
}

#define LONGER(array, count, more) \
    ((array) = longer((array), (count), (more), sizeof *(array), arena, error))

static MesoStatus lengthen(MesoScene *s, const MesoSketch *k, MesoArena *arena, MesoError *error)
{
    uint32_t parts = k->part_count;
    if ((uint64_t)s->material_count + parts > MOST_MATERIALS)
        return meso_fail(error, MESO_ERR_LIMIT, "with those of what is shown there are over %d materials",
                         MOST_MATERIALS);
    bool made = LONGER(s->materials, s->material_count, parts) && LONGER(s->material_names, s->material_count, parts) &&
                LONGER(s->ids, (size_t)s->id_row_count * s->channel_count, (size_t)parts * s->channel_count) &&
                LONGER(s->kinds, s->kind_count, parts) && LONGER(s->columns, s->column_count, SIDES + 1) &&
                LONGER(s->sweeps, s->sweep_count, k->bar_count) && LONGER(s->bodies, s->body_count, parts) &&
                LONGER(s->placed, s->placed_count, parts);
    for (uint32_t c = 0; c < s->channel_count && made; c++)
        made = !s->channels[c].names || LONGER(s->channels[c].names, s->channels[c].count, parts);
    return made ? MESO_OK : MESO_ERR_MEMORY;
}

static void add_ids(MesoScene *s, const MesoSketch *k)
{
    for (uint32_t i = 0; i < k->part_count; i++)
        for (uint32_t c = 0; c < s->channel_count; c++) {
            MesoIdChannel *channel = &s->channels[c];
            s->ids[(size_t)(s->id_row_count + i) * s->channel_count + c] = channel->count + i;
            if (channel->names)
                channel->names[channel->count + i] = k->parts[i].name;
        }
    for (uint32_t c = 0; c < s->channel_count; c++)
        s->channels[c].count += k->part_count;
    for (uint32_t i = 0; i < k->part_count; i++) {
        s->materials[s->material_count + i] = k->parts[i].material;
        s->material_names[s->material_count + i] = k->parts[i].name;
    }
}

/* A circle of radius 1 in units of the profiles. */
static void add_columns(MesoScene *s)
{
    for (uint32_t i = 0; i <= SIDES; i++) {
        double angle = -2 * PI * (i % SIDES) / SIDES;
        MesoVec2 n = {(float)cos(angle), (float)sin(angle)};
        s->columns[s->column_count + i] =
            (MesoSweepColumn){.start = n, .end = n, .start_normal = n, .end_normal = n, .u = (float)i / SIDES,
                              .joins_next = i < SIDES};
    }
}

static MesoSweepInstance sweep_of(const MesoSketchBar *bar, float scale, uint32_t ids)
{
    MesoVec3 way = meso_vec3_sub(bar->b, bar->a), along = meso_vec3_unit(way, (MesoVec3){0, 0, 1});
    MesoVec3 up = fabsf(along.y) < 0.7f ? (MesoVec3){0, 1, 0} : (MesoVec3){1, 0, 0};
    MesoSweepInstance sweep = {.up = {up, up}, .direction = {along, along}, .ids = ids,
                               .size = {bar->radius[0] / scale, bar->radius[1] / scale}};
    for (int i = 0; i < 4; i++)
        sweep.p[i] = meso_vec3_mad(bar->a, (float)i / 3, way);
    return sweep;
}

static void add_bars(MesoScene *s, const MesoSketch *k, uint32_t part)
{
    bool last = part + 1 == k->part_count;
    uint32_t begin = k->parts[part].bar_begin, end = last ? k->bar_count : k->parts[part + 1].bar_begin;
    if (begin == end)
        return;
    s->kinds[s->kind_count++] = (MesoSweptKind){
        .column_begin = s->column_count, .column_count = SIDES + 1, .joint_count = SIDES, .division_count = 2,
        .instance_begin = s->sweep_count, .instance_count = end - begin, .start_material = s->material_count + part,
        .end_material = s->material_count + part};
    for (uint32_t i = begin; i < end; i++)
        s->sweeps[s->sweep_count++] = sweep_of(&k->bars[i], s->section_scale, s->id_row_count + part);
}

static void add_body(MesoScene *s, const MesoSketch *k, uint32_t part)
{
    const MesoSketchPart *p = &k->parts[part], *next = part + 1 < k->part_count ? p + 1 : NULL;
    uint32_t vertices = (next ? next->vertex_begin : k->vertex_count) - p->vertex_begin;
    uint32_t faces = (next ? next->face_begin : k->face_count) - p->face_begin;
    if (faces == 0)
        return;
    s->placed[s->placed_count++] = (MesoPlacedBody){.body = s->body_count, .material = s->material_count + part,
                                                    .ids = s->id_row_count + part, .place = MESO_PLACED_HERE};
    s->bodies[s->body_count++] = (MesoBody){
        .vertex_count = vertices, .face_count = faces, .face_width = 4, .positions = k->positions + p->vertex_begin,
        .normals = k->normals + p->vertex_begin, .corners = k->faces[p->face_begin].v};
}

/* The scene keeps the arrays of bodies. */
static bool adopt(MesoSketch *k, MesoArena *arena, MesoError *error)
{
    void *const blocks[] = {k->positions, k->normals, k->faces};
    for (int i = 0; i < 3; i++) {
        if (blocks[i] && !meso_arena_adopt(arena, blocks[i], error))
            return false;
        if (i == 0)
            k->positions = NULL;
        else if (i == 1)
            k->normals = NULL;
        else
            k->faces = NULL;
    }
    return true;
}

/* What a scene without channels has is all one thing. */
static MesoStatus begin_channel(MesoScene *s, MesoArena *arena, MesoError *error)
{
    const char **names = MESO_NEW(arena, const char *, 1, error);
    s->ids = MESO_NEW(arena, uint32_t, s->id_row_count, error);
    if (!names || !s->ids)
        return MESO_ERR_MEMORY;
    names[0] = "shown";
    s->channels[s->channel_count++] = (MesoIdChannel){"part", s->id_row_count > 0, names};
    if (!(s->section_scale > 0))
        s->section_scale = 1;
    return MESO_OK;
}

MesoStatus meso_sketch_finish(MesoSketch *k, MesoScene *s, MesoArena *arena, MesoError *error)
{
    MesoStatus status = k->failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory") : MESO_OK;
    if (!status && s->channel_count == 0)
        status = begin_channel(s, arena, error);
    if (!status)
        status = lengthen(s, k, arena, error);
    if (!status) {
        add_ids(s, k);
        add_columns(s);
        for (uint32_t i = 0; i < k->part_count; i++) {
            add_bars(s, k, i);
            add_body(s, k, i);
        }
        s->column_count += SIDES + 1;
        s->material_count += k->part_count;
        s->id_row_count += k->part_count;
        status = adopt(k, arena, error) ? MESO_OK : MESO_ERR_MEMORY;
    }
    if (!status)
        meso_scene_measure(s);
    free(k->parts);
    free(k->bars);
    free(k->positions);
    free(k->normals);
    free(k->faces);
    *k = (MesoSketch){0};
    return status;
}
