#include "formats/model/scene_of_mesh.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "formats/json/json_text.h"

static const char *const CHANNEL_NAMES[] = {"slot", "tile", "strand", "region", "element", "detail"};
enum { CHANNEL_NAME_COUNT = sizeof CHANNEL_NAMES / sizeof *CHANNEL_NAMES };

static const MesoMaterial GREY = {{0.8f, 0.8f, 0.8f}, 0.5f, 0}, WHITE = {{1, 1, 1}, 0.5f, 0};

/* What a face is sorted by. */
typedef struct FaceKey {
    uint32_t material, ids[MESO_ID_CHANNELS];
    uint32_t face;
} FaceKey;

/* A vertex of the scene in the making: what its corners have in common. */
typedef struct Split {
    uint32_t source;                    /* vertex of the mesh */
    uint32_t normal, uv, color;         /* entries, or MESO_NO_INDEX */
    uint32_t next;                      /* the source's next one in this body, or MESO_NO_INDEX */
    uint32_t number;                    /* in the body */
} Split;

typedef struct Builder {
    const MesoPolygonMesh *mesh;
    MesoScene *scene;
    MesoArena *arena, *scratch;
    const MesoAttribute *normal, *uv, *color, *material;
    const MesoAttribute *albedo, *roughness, *metallic;
    const MesoAttribute *ids[MESO_ID_CHANNELS];
    FaceKey *keys;          /* [face_count] sorted */
    MesoVec3 *areas;        /* [vertex_count] sums of the areas' vectors; NULL until they are wanted */
    uint32_t *first;        /* [vertex_count] of the current body's splits, or MESO_NO_INDEX */
    Split *splits;          /* [corner_count] of the current body */
    uint32_t split_count;
    uint32_t *split_of;     /* [corner_count] of the mesh */
    uint32_t *order;        /* [corner_count] scratch */
    /* what bodies point into */
    MesoVec3 *positions, *normals;
    MesoVec2 *uvs;
    MesoMeshColor *colors;
    uint32_t *corners;
    uint64_t vertex_count, face_count;
} Builder;

/* ---- attributes ---- */

static bool is_whole(const MesoAttribute *attribute)
{
    return attribute->scalar != MESO_SCALAR_FLOAT && attribute->scalar != MESO_SCALAR_DOUBLE && !attribute->normalized;
}

static const MesoAttribute *find_numbers(const MesoPolygonMesh *mesh, const char *name, uint32_t least_width)
{
    static const MesoAttributeDomain domains[] = {MESO_ON_CORNERS, MESO_ON_VERTICES, MESO_ON_FACES};
    for (int i = 0; i < 3; i++) {
        const MesoAttribute *attribute = meso_polygon_attribute_on(mesh, name, domains[i]);
        if (attribute && attribute->width >= least_width)
            return attribute;
    }
    return NULL;
}

/* Of faces, with as many numbers. */
static const MesoAttribute *find_look(const MesoPolygonMesh *mesh, const char *name, uint32_t width)
{
    const MesoAttribute *attribute = meso_polygon_attribute_on(mesh, name, MESO_ON_FACES);
    return attribute && attribute->width == width ? attribute : NULL;
}

static void find_attributes(Builder *b)
{
    const MesoAttribute *material = meso_polygon_attribute_on(b->mesh, "material", MESO_ON_FACES);
    b->normal = meso_polygon_normals(b->mesh);
    b->uv = find_numbers(b->mesh, "uv", 2);
    b->color = find_numbers(b->mesh, "color", 3);
    b->material = material && (material->width == 0 || (material->width == 1 && is_whole(material))) ? material : NULL;
    b->albedo = find_look(b->mesh, "albedo", 3);
    b->roughness = find_look(b->mesh, "roughness", 1);
    b->metallic = find_look(b->mesh, "metallic", 1);
    for (int i = 0; i < CHANNEL_NAME_COUNT && b->scene->channel_count < MESO_ID_CHANNELS; i++) {
        const MesoAttribute *ids = meso_polygon_attribute_on(b->mesh, CHANNEL_NAMES[i], MESO_ON_FACES);
        if (!ids || (ids->width && (ids->width != 1 || !is_whole(ids))))
            continue;
        b->ids[b->scene->channel_count] = ids;
        b->scene->channels[b->scene->channel_count++] = (MesoIdChannel){CHANNEL_NAMES[i], 0, NULL};
    }
}

/* Entry at a corner of a face, or MESO_NO_INDEX. */
static uint32_t entry_at(const Builder *b, const MesoAttribute *attribute, uint32_t face, uint32_t corner)
{
    if (!attribute)
        return MESO_NO_INDEX;
    uint32_t element = attribute->domain == MESO_ON_CORNERS ? corner
                     : attribute->domain == MESO_ON_FACES   ? face
                                                            : b->mesh->corners[corner];
    return meso_attribute_entry(attribute, element);
}

static uint8_t to_byte(double x)
{
    return x > 0 ? (uint8_t)(fmin(x, 1) * 255 + 0.5) : 0;   /* 0 for what is no number */
}

static MesoMeshColor color_of(const MesoAttribute *attribute, uint32_t entry)
{
    double most = !is_whole(attribute) ? 1
                : meso_scalar_size(attribute->scalar) == 1 ? UINT8_MAX
                : meso_scalar_size(attribute->scalar) == 2 ? UINT16_MAX : UINT32_MAX;
    return (MesoMeshColor){to_byte(meso_attribute_number(attribute, entry, 0) / most),
                           to_byte(meso_attribute_number(attribute, entry, 1) / most),
                           to_byte(meso_attribute_number(attribute, entry, 2) / most)};
}

/* ---- materials and ids ---- */

/* Numbers of materials are made dense: the names say what they were. `at` gets [face_count] materials. */
static MesoStatus number_materials(const Builder *b, uint32_t *at, uint32_t *count, MesoError *error)
{
    uint32_t most = 0;
    for (uint32_t f = 0; f < b->mesh->face_count; f++) {
        uint32_t entry = b->material ? meso_attribute_entry(b->material, f) : MESO_NO_INDEX;
        bool numbers = b->material && b->material->width == 1 && entry != MESO_NO_INDEX;
        double value = numbers ? meso_attribute_number(b->material, entry, 0) : (double)entry;
        if (entry == MESO_NO_INDEX || value < 0 || value >= (double)UINT32_MAX)
            at[f] = MESO_NO_INDEX;      /* of no material */
        else
            at[f] = (uint32_t)value;
        if (at[f] != MESO_NO_INDEX && at[f] >= most)
            most = at[f] + 1;
    }
    if (most >= UINT16_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "numbers of materials up to %u; at most %u", most - 1, UINT16_MAX - 2);
    *count = most;
    return MESO_OK;
}

/* Names of a scene are UTF-8, those of files need not be. */
static const char *copy_name(MesoArena *arena, const char *name, MesoError *error)
{
    json_t *text = meso_json_string(name);
    const char *copy = NULL;
    if (text)
        copy = meso_arena_copy_text(arena, json_string_value(text), error);
    else
        meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    json_decref(text);
    return copy;
}

static const char *material_name(const Builder *b, uint32_t material, MesoError *error)
{
    if (b->material->width == 0)
        return copy_name(b->arena, b->material->names[material], error);
    return meso_arena_print(b->arena, error, "material %u", material);
}

/* A number in [0, 1] that a face has; `otherwise` where it has none. */
static float look_number(const MesoAttribute *attribute, uint32_t face, uint32_t component, float otherwise)
{
    uint32_t entry = attribute ? meso_attribute_entry(attribute, face) : MESO_NO_INDEX;
    if (entry == MESO_NO_INDEX)
        return otherwise;
    double x = meso_attribute_number(attribute, entry, component);
    return x > 0 ? (float)fmin(x, 1) : 0;
}

static MesoMaterial look_of(const Builder *b, uint32_t face)
{
    MesoMaterial look = b->color ? WHITE : GREY;
    for (uint32_t c = 0; c < 3; c++)
        look.albedo[c] = look_number(b->albedo, face, c, look.albedo[c]);
    look.roughness = look_number(b->roughness, face, 0, look.roughness);
    look.metallic = look_number(b->metallic, face, 0, look.metallic);
    return look;
}

/* Materials that faces use, in the order of their numbers, and "none" for faces without. */
static MesoStatus make_materials(Builder *b, MesoError *error)
{
    MesoScene *scene = b->scene;
    uint32_t count = 0, faces = b->mesh->face_count;
    uint32_t *at = MESO_NEW(b->scratch, uint32_t, faces, error);
    MesoStatus status = at ? number_materials(b, at, &count, error) : MESO_ERR_MEMORY;
    if (status)
        return status;
    uint32_t *dense = MESO_NEW(b->scratch, uint32_t, (size_t)count + 1, error);
    scene->materials = MESO_NEW(b->arena, MesoMaterial, (size_t)count + 1, error);
    scene->material_names = MESO_NEW(b->arena, const char *, (size_t)count + 1, error);
    if (!dense || !scene->materials || !scene->material_names)
        return MESO_ERR_MEMORY;
    for (uint32_t f = faces; f-- > 0;)
        dense[at[f] == MESO_NO_INDEX ? count : at[f]] = f + 1;      /* the first at last */
    for (uint32_t m = 0; m <= count; m++) {
        if (!dense[m])
            continue;
        scene->materials[scene->material_count] = look_of(b, dense[m] - 1);
        dense[m] = scene->material_count;
        const char *name = m < count ? material_name(b, m, error) : "none";
        if (!name)
            return MESO_ERR_MEMORY;
        scene->material_names[scene->material_count++] = name;
    }
    for (uint32_t f = 0; f < faces; f++)
        b->keys[f].material = dense[at[f] == MESO_NO_INDEX ? count : at[f]];
    return MESO_OK;
}

/* Names are kept where 16 bits are enough for all. */
static MesoStatus name_channel(Builder *b, uint32_t c, MesoError *error)
{
    MesoIdChannel *channel = &b->scene->channels[c];
    const MesoAttribute *ids = b->ids[c];
    if (ids->width || ids->entry_count == 0 || ids->entry_count > UINT16_MAX + 1)
        return MESO_OK;
    channel->count = ids->entry_count;
    channel->names = MESO_NEW(b->arena, const char *, channel->count, error);
    for (uint32_t i = 0; channel->names && i < channel->count; i++)
        if (!(channel->names[i] = copy_name(b->arena, ids->names[i], error)))
            return MESO_ERR_MEMORY;
    return channel->names ? MESO_OK : MESO_ERR_MEMORY;
}

/* A face without an id has 0. */
static MesoStatus read_ids(Builder *b, MesoError *error)
{
    for (uint32_t f = 0; f < b->mesh->face_count; f++)
        for (uint32_t c = 0; c < b->scene->channel_count; c++) {
            MesoIdChannel *channel = &b->scene->channels[c];
            uint32_t entry = meso_attribute_entry(b->ids[c], f);
            double value = entry == MESO_NO_INDEX ? 0
                         : b->ids[c]->width       ? meso_attribute_number(b->ids[c], entry, 0)
                                                  : (double)entry;
            if (!(value >= 0 && value < UINT32_MAX - 1))
                return meso_fail(error, MESO_ERR_INPUT, "face %u: its %s is %.0f", f + 1, channel->name, value);
            b->keys[f].ids[c] = (uint32_t)value;
            if (channel->count <= (uint32_t)value)
                channel->count = (uint32_t)value + 1;
        }
    MesoStatus status = MESO_OK;
    for (uint32_t c = 0; c < b->scene->channel_count && !status; c++)
        status = name_channel(b, c, error);
    return status;
}

static int compare_kinds(const FaceKey *x, const FaceKey *y)
{
    if (x->material != y->material)
        return x->material < y->material ? -1 : 1;
    for (uint32_t c = 0; c < MESO_ID_CHANNELS; c++)
        if (x->ids[c] != y->ids[c])
            return x->ids[c] < y->ids[c] ? -1 : 1;
    return 0;
}

static int compare_keys(const void *a, const void *b)
{
    const FaceKey *x = a, *y = b;
    int order = compare_kinds(x, y);
    return order ? order : x->face < y->face ? -1 : x->face > y->face;
}

static MesoStatus sort_faces(Builder *b, MesoError *error)
{
    uint32_t faces = b->mesh->face_count;
    b->keys = MESO_NEW(b->scratch, FaceKey, faces, error);
    MesoStatus status = b->keys ? make_materials(b, error) : MESO_ERR_MEMORY;
    if (!status)
        status = read_ids(b, error);
    if (status)
        return status;
    for (uint32_t f = 0; f < faces; f++)
        b->keys[f].face = f;
    if (faces)
        qsort(b->keys, faces, sizeof *b->keys, compare_keys);
    return MESO_OK;
}

static uint32_t body_end(const Builder *b, uint32_t begin)
{
    uint32_t end = begin + 1;
    while (end < b->mesh->face_count && compare_kinds(&b->keys[begin], &b->keys[end]) == 0)
        end++;
    return end;
}

/* ---- normals that the mesh lacks ---- */

/* Twice the area's vector: the cross products of the fan. */
static MesoVec3 area_vector(const MesoPolygonMesh *mesh, uint32_t begin, uint32_t sides)
{
    double sum[3] = {0, 0, 0};
    MesoVec3 o = mesh->positions[mesh->corners[begin]];
    for (uint32_t k = 1; k + 1 < sides; k++) {
        MesoVec3 p = mesh->positions[mesh->corners[begin + k]], q = mesh->positions[mesh->corners[begin + k + 1]];
        double a[3] = {(double)p.x - o.x, (double)p.y - o.y, (double)p.z - o.z};
        double b[3] = {(double)q.x - o.x, (double)q.y - o.y, (double)q.z - o.z};
        for (int i = 0; i < 3; i++)
            sum[i] += a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3];
    }
    return (MesoVec3){(float)sum[0], (float)sum[1], (float)sum[2]};
}

static MesoStatus sum_areas(Builder *b, MesoError *error)
{
    const MesoPolygonMesh *mesh = b->mesh;
    double *sums = MESO_NEW(b->scratch, double, 3 * (size_t)mesh->vertex_count, error);
    b->areas = MESO_NEW(b->scratch, MesoVec3, mesh->vertex_count, error);
    if (!sums || !b->areas)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        MesoVec3 area = area_vector(mesh, begin, sides);
        for (uint32_t c = begin; c < begin + sides; c++) {
            double *sum = &sums[3 * (size_t)mesh->corners[c]];
            sum[0] += (double)area.x;
            sum[1] += (double)area.y;
            sum[2] += (double)area.z;
        }
    }
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        const double *sum = &sums[3 * (size_t)v];
        double length = sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
        b->areas[v] = length > 0 && isfinite(length)
            ? (MesoVec3){(float)(sum[0] / length), (float)(sum[1] / length), (float)(sum[2] / length)}
            : (MesoVec3){0, 0, 1};
    }
    return MESO_OK;
}

/* ---- vertices and faces of one body ---- */

/* Entries that say the same are one, however many times the file has it. */
static bool says_the_same(const MesoAttribute *attribute, uint32_t x, uint32_t y)
{
    if (x == y || x == MESO_NO_INDEX || y == MESO_NO_INDEX)
        return x == y;
    for (uint32_t k = 0; k < attribute->width && k < 3; k++)
        if (meso_attribute_number(attribute, x, k) != meso_attribute_number(attribute, y, k))
            return false;
    return true;
}

/* The split of a corner, made where there is none like it yet. */
static uint32_t split_at(Builder *b, uint32_t face, uint32_t corner)
{
    Split wanted = {.source = b->mesh->corners[corner],
                    .normal = entry_at(b, b->normal, face, corner),
                    .uv = entry_at(b, b->uv, face, corner),
                    .color = entry_at(b, b->color, face, corner)};
    for (uint32_t i = b->first[wanted.source]; i != MESO_NO_INDEX; i = b->splits[i].next) {
        const Split *s = &b->splits[i];
        if (says_the_same(b->normal, s->normal, wanted.normal) && says_the_same(b->uv, s->uv, wanted.uv) &&
            says_the_same(b->color, s->color, wanted.color))
            return i;
    }
    wanted.next = b->first[wanted.source];
    b->splits[b->split_count] = wanted;
    b->first[wanted.source] = b->split_count;
    return b->split_count++;
}

static void split_vertices(Builder *b, uint32_t begin, uint32_t end)
{
    b->split_count = 0;
    for (uint32_t k = begin; k < end; k++) {
        uint32_t face = b->keys[k].face, first = meso_polygon_begin(b->mesh, face);
        for (uint32_t i = 0; i < meso_polygon_sides(b->mesh, face); i++)
            b->split_of[first + i] = split_at(b, face, first + i);
    }
}

static int compare_sources(const void *a, const void *b)
{
    uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
    return x < y ? -1 : x > y;
}

/* By vertex of the mesh, then by first corner; the vertices' lists are empty again after it. */
static MesoStatus number_vertices(Builder *b, MesoError *error)
{
    MesoArenaMark mark = meso_arena_mark(b->scratch);
    uint64_t *places = MESO_NEW(b->scratch, uint64_t, b->split_count, error);
    if (!places)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < b->split_count; i++) {
        places[i] = (uint64_t)b->splits[i].source << 32 | i;
        b->first[b->splits[i].source] = MESO_NO_INDEX;
    }
    qsort(places, b->split_count, sizeof *places, compare_sources);
    for (uint32_t i = 0; i < b->split_count; i++) {
        b->order[i] = (uint32_t)places[i];
        b->splits[b->order[i]].number = i;
    }
    meso_arena_rewind(b->scratch, mark);
    return MESO_OK;
}

static MesoVec2 finite_or_zero(MesoVec2 v)
{
    return (MesoVec2){isfinite(v.x) ? v.x : 0, isfinite(v.y) ? v.y : 0};
}

static void fill_vertices(Builder *b)
{
    static const MesoMeshColor white = {255, 255, 255};
    for (uint32_t i = 0; i < b->split_count; i++) {
        const Split *s = &b->splits[b->order[i]];
        uint64_t at = b->vertex_count++;
        b->positions[at] = b->mesh->positions[s->source];
        b->normals[at] = b->areas[s->source];
        if (s->normal != MESO_NO_INDEX)
            b->normals[at] = meso_vec3_direction(meso_attribute_vec3(b->normal, s->normal), b->normals[at]);
        if (b->uvs && s->uv != MESO_NO_INDEX)
            b->uvs[at] = finite_or_zero(meso_attribute_vec2(b->uv, s->uv));
        if (b->colors)
            b->colors[at] = s->color == MESO_NO_INDEX ? white : color_of(b->color, s->color);
    }
}

static void put_face(Builder *b, uint32_t a, uint32_t c, uint32_t d, uint32_t e)
{
    const MesoMeshFace face = {{a, c, d, e}};
    memcpy(b->corners + 4 * b->face_count++, face.v, sizeof face.v);
}

static uint32_t number_at(const Builder *b, uint32_t corner)
{
    return b->splits[b->split_of[corner]].number;
}

/* Quads stay; larger polygons become fans. */
static void fill_faces(Builder *b, uint32_t begin, uint32_t end)
{
    for (uint32_t k = begin; k < end; k++) {
        uint32_t face = b->keys[k].face, first = meso_polygon_begin(b->mesh, face);
        uint32_t sides = meso_polygon_sides(b->mesh, face), apex = number_at(b, first);
        if (sides == 4) {
            put_face(b, apex, number_at(b, first + 1), number_at(b, first + 2), number_at(b, first + 3));
            continue;
        }
        for (uint32_t i = 1; i + 1 < sides; i++)
            put_face(b, apex, number_at(b, first + i), number_at(b, first + i + 1), MESO_NO_INDEX);
    }
}

static MesoStatus make_body(Builder *b, uint32_t begin, uint32_t end, MesoError *error)
{
    MesoScene *scene = b->scene;
    uint64_t vertex = b->vertex_count, face = b->face_count;
    split_vertices(b, begin, end);
    MesoStatus status = number_vertices(b, error);
    if (status)
        return status;
    fill_vertices(b);
    fill_faces(b, begin, end);
    uint32_t number = scene->body_count++;
    scene->bodies[number] = (MesoBody){
        .vertex_count = b->split_count, .face_count = (uint32_t)(b->face_count - face), .face_width = 4,
        .positions = b->positions + vertex, .normals = b->normals + vertex, .uvs = b->uvs ? b->uvs + vertex : NULL,
        .colors = b->colors ? b->colors + vertex : NULL, .corners = b->corners + 4 * face};
    scene->placed[number] = (MesoPlacedBody){.body = number, .material = b->keys[begin].material, .ids = number};
    memcpy(scene->ids + (size_t)number * scene->channel_count, b->keys[begin].ids,
           scene->channel_count * sizeof *scene->ids);
    return MESO_OK;
}

/* ---- all of it ---- */

/* Faces with quads whole and fans of the others; corners bound the vertices. */
static MesoStatus allocate(Builder *b, uint32_t body_count, MesoError *error)
{
    const MesoPolygonMesh *mesh = b->mesh;
    uint32_t corners = mesh->corner_count;
    uint64_t faces = 0;
    for (uint32_t f = 0; f < mesh->face_count; f++)
        faces += meso_polygon_sides(mesh, f) == 4 ? 1 : meso_polygon_sides(mesh, f) - 2;
    b->first = MESO_NEW(b->scratch, uint32_t, mesh->vertex_count, error);
    b->splits = MESO_NEW(b->scratch, Split, corners, error);
    b->split_of = MESO_NEW(b->scratch, uint32_t, corners, error);
    b->order = MESO_NEW(b->scratch, uint32_t, corners, error);
    b->positions = MESO_NEW(b->arena, MesoVec3, corners, error);
    b->normals = MESO_NEW(b->arena, MesoVec3, corners, error);
    b->uvs = b->uv ? MESO_NEW(b->arena, MesoVec2, corners, error) : NULL;
    b->colors = b->color ? MESO_NEW(b->arena, MesoMeshColor, corners, error) : NULL;
    b->corners = MESO_NEW(b->arena, uint32_t, 4 * faces, error);
    b->scene->bodies = MESO_NEW(b->arena, MesoBody, body_count, error);
    b->scene->placed = MESO_NEW(b->arena, MesoPlacedBody, body_count, error);
    b->scene->ids = MESO_NEW(b->arena, uint32_t, (size_t)body_count * b->scene->channel_count, error);
    if (!b->first || !b->splits || !b->split_of || !b->order || !b->positions || !b->normals || (b->uv && !b->uvs) ||
        (b->color && !b->colors) || !b->corners || !b->scene->bodies || !b->scene->placed || !b->scene->ids)
        return MESO_ERR_MEMORY;
    memset(b->first, 0xff, mesh->vertex_count * sizeof *b->first);
    return MESO_OK;
}

static MesoStatus build(Builder *b, MesoError *error)
{
    uint32_t faces = b->mesh->face_count, body_count = 0;
    find_attributes(b);
    MesoStatus status = sort_faces(b, error);
    if (status)
        return status;
    for (uint32_t f = 0; f < faces; f = body_end(b, f))
        body_count++;
    status = allocate(b, body_count, error);
    if (!status)
        status = sum_areas(b, error);
    for (uint32_t f = 0; f < faces && !status; f = body_end(b, f))
        status = make_body(b, f, body_end(b, f), error);
    b->scene->placed_count = b->scene->id_row_count = body_count;
    if (!status)
        meso_scene_measure(b->scene);
    return status;
}

MesoStatus meso_scene_of_mesh(MesoScene *scene, MesoArena *arena, const MesoPolygonMesh *mesh, MesoError *error)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    *scene = (MesoScene){0};
    Builder builder = {.mesh = mesh, .scene = scene, .arena = arena, .scratch = &scratch};
    MesoStatus status = build(&builder, error);
    meso_arena_release(&scratch);
    return status;
}
