#include "libcore/decor/decor_scene.h"

#include <stdlib.h>
#include <string.h>

#include "libcore/base/grow.h"
#include "libcore/mesh/point/vertex_normals.h"

typedef struct Building {
    MesoScene *scene;
    MesoArena *arena;
    const MesoDecor *decor;
    const MesoPattern *pattern;
    const MesoDecorValues *values;
    MesoError *error;
    bool painted;               /* something is; else tags have looks of their own */

    uint32_t *leaves;           /* [leaf_count] in the tree's order */
    uint32_t leaf_count;
    uint32_t *begin, *triangles;    /* by leaf, in that order */

    MesoVec3 *positions, *normals;  /* [vertex_count] of all bodies, one after another */
    MesoVec2 *uvs;
    MesoMeshColor *colors;
    uint32_t *origins;              /* vertex of the mesh */
    uint32_t *next;                 /* further copy of the same vertex in the same body, or MESO_NO_INDEX */
    uint32_t *corners;
    uint32_t vertex_count, vertex_room;
} Building;

/* ---- leaves ---- */

static void add_leaf(void *context, uint32_t leaf)
{
    Building *b = context;
    b->leaves[b->leaf_count++] = leaf;
}

/* A region can have become empty of triangles only by being divided: leaves have some. */
static MesoStatus list_leaves(Building *b)
{
    const MesoRegionTree *tree = &b->decor->tree;
    MesoRegionLists lists;
    b->leaves = MESO_NEW(b->arena, uint32_t, tree->region_count, b->error);
    if (!b->leaves)
        return MESO_ERR_MEMORY;
    meso_region_each_leaf(tree, 0, add_leaf, b);
    if (b->leaf_count > UINT16_MAX)
        return meso_fail(b->error, MESO_ERR_LIMIT, "%u regions: files know %u at most", b->leaf_count, UINT16_MAX);
    MesoStatus status = meso_region_lists_build(&lists, b->arena, tree, &b->decor->mesh, b->error);
    b->begin = lists.begin;
    b->triangles = lists.triangles;
    return status;
}

/* ---- materials ---- */

/* What a tag looks like where the pattern says nothing: paper and ink. */
static const struct {
    const char *tag;
    MesoMaterial look[2];       /* by number among brothers, in turn */
} TAG_LOOKS[] = {
    {"surface", {{{0.72f, 0.68f, 0.60f}, 0.55f, 0}, {{0.72f, 0.68f, 0.60f}, 0.55f, 0}}},
    {"background", {{{0.80f, 0.76f, 0.67f}, 0.55f, 0}, {{0.80f, 0.76f, 0.67f}, 0.55f, 0}}},
    {"dot", {{{0.55f, 0.09f, 0.06f}, 0.45f, 0}, {{0.55f, 0.09f, 0.06f}, 0.45f, 0}}},
    {"band", {{{0.05f, 0.14f, 0.30f}, 0.45f, 0}, {{0.05f, 0.14f, 0.30f}, 0.45f, 0}}},
    {"inside", {{{0.82f, 0.77f, 0.66f}, 0.55f, 0}, {{0.82f, 0.77f, 0.66f}, 0.55f, 0}}},
    {"stripe", {{{0.06f, 0.20f, 0.32f}, 0.45f, 0}, {{0.80f, 0.72f, 0.55f}, 0.55f, 0}}},
    {"cell", {{{0.62f, 0.30f, 0.10f}, 0.5f, 0}, {{0.75f, 0.55f, 0.25f}, 0.5f, 0}}},
};
enum { TAG_LOOK_COUNT = sizeof TAG_LOOKS / sizeof *TAG_LOOKS };

static uint32_t tag_look(const MesoRegion *region)
{
    for (uint32_t i = 0; i < TAG_LOOK_COUNT; i++)
        if (strcmp(TAG_LOOKS[i].tag, region->tag) == 0)
            return 2 * i + region->number % 2;
    return 0;
}

/* A pair of the pattern's materials and the share of the second. */
typedef struct Mix {
    uint32_t material[2];
    float share;
} Mix;

static Mix mix_of(const Building *b, uint32_t leaf)
{
    const MesoRegionTree *tree = &b->decor->tree;
    if (!b->painted) {
        uint32_t look = tag_look(&tree->regions[leaf]);
        return (Mix){{look, look}, 0};
    }
    uint32_t painted = meso_region_painted(tree, leaf);
    if (painted == MESO_NO_INDEX)
        return (Mix){{0, 0}, 0};
    const MesoRegion *region = &tree->regions[painted];
    return (Mix){{region->material[0], region->material[1]}, region->mix};
}

static MesoMaterial material_of(const Building *b, uint32_t number)
{
    return b->painted ? b->pattern->materials[number] : TAG_LOOKS[number / 2].look[number % 2];
}

static const char *material_name(const Building *b, uint32_t number)
{
    if (b->painted)
        return b->pattern->material_names[number];
    return meso_arena_print(b->arena, b->error, "%s%s", TAG_LOOKS[number / 2].tag, number % 2 ? " 2" : "");
}

static MesoMaterial blended(MesoMaterial x, MesoMaterial y, float t)
{
    for (int c = 0; c < 3; c++)
        x.albedo[c] += t * (y.albedo[c] - x.albedo[c]);
    x.roughness += t * (y.roughness - x.roughness);
    x.metallic += t * (y.metallic - x.metallic);
    return x;
}

/* Number of a mix among the scene's materials; added where it is new. */
static uint32_t find_mix(Building *b, Mix *mixes, Mix mix)
{
    MesoScene *scene = b->scene;
    for (uint32_t i = 0; i < scene->material_count; i++)
        if (memcmp(&mixes[i], &mix, sizeof mix) == 0)
            return i;
    uint32_t number = scene->material_count++;
    mixes[number] = mix;
    MesoMaterial first = material_of(b, mix.material[0]);
    scene->materials[number] = mix.share > 0 ? blended(first, material_of(b, mix.material[1]), mix.share) : first;
    const char *name = material_name(b, mix.material[0]);
    scene->material_names[number] = mix.share > 0 && name
        ? meso_arena_print(b->arena, b->error, "%s-%s-%.0f", name, material_name(b, mix.material[1]),
                           100 * (double)mix.share)
        : name;
    return number;
}

static MesoStatus set_materials(Building *b)
{
    MesoScene *scene = b->scene;
    Mix *mixes = MESO_NEW(b->arena, Mix, b->leaf_count, b->error);
    scene->materials = MESO_NEW(b->arena, MesoMaterial, b->leaf_count, b->error);
    scene->material_names = MESO_NEW(b->arena, const char *, b->leaf_count, b->error);
    if (!mixes || !scene->materials || !scene->material_names)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < b->leaf_count; i++) {
        scene->placed[i].material = find_mix(b, mixes, mix_of(b, b->leaves[i]));
        if (!scene->material_names[scene->placed[i].material])
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

/* ---- ids ---- */

static uint32_t find_tag(const char **tags, uint32_t *count, const char *tag)
{
    for (uint32_t i = 0; i < *count; i++)
        if (strcmp(tags[i], tag) == 0)
            return i;
    tags[*count] = tag;
    return (*count)++;
}

static MesoStatus set_ids(Building *b)
{
    MesoScene *scene = b->scene;
    const MesoRegionTree *tree = &b->decor->tree;
    const char **paths = MESO_NEW(b->arena, const char *, b->leaf_count, b->error);
    const char **tags = MESO_NEW(b->arena, const char *, b->leaf_count, b->error);
    scene->ids = MESO_NEW(b->arena, uint32_t, 2 * (size_t)b->leaf_count, b->error);
    if (!paths || !tags || !scene->ids)
        return MESO_ERR_MEMORY;
    uint32_t tag_count = 0;
    for (uint32_t i = 0; i < b->leaf_count; i++) {
        paths[i] = meso_region_path(tree, b->arena, b->leaves[i], b->error);
        if (!paths[i])
            return MESO_ERR_MEMORY;
        scene->ids[2 * i] = i;
        scene->ids[2 * i + 1] = find_tag(tags, &tag_count, tree->regions[b->leaves[i]].tag);
        scene->placed[i].ids = i;
    }
    scene->id_row_count = b->leaf_count;
    scene->channel_count = 2;
    scene->channels[0] = (MesoIdChannel){"region", b->leaf_count, paths};
    scene->channels[1] = (MesoIdChannel){"tag", tag_count, tags};
    return MESO_OK;
}

/* ---- shape ---- */

static MesoVec2 uv_at(const Building *b, uint32_t corner)
{
    const MesoTriangulation *mesh = &b->decor->mesh;
    const float *uv = NULL;
    if (b->values->corner_uv != MESO_NO_INDEX)
        uv = &mesh->corner_values[(size_t)mesh->corner_width * corner + b->values->corner_uv];
    else if (b->values->vertex_uv != MESO_NO_INDEX)
        uv = &mesh->vertex_values[(size_t)mesh->vertex_width * mesh->corners[corner] + b->values->vertex_uv];
    return uv ? (MesoVec2){uv[0], uv[1]} : (MesoVec2){0, 0};
}

static uint8_t byte_of(float value)
{
    return (uint8_t)lrintf(255 * (value > 0 ? value < 1 ? value : 1 : 0));
}

static MesoMeshColor color_at(const Building *b, uint32_t vertex)
{
    const MesoTriangulation *mesh = &b->decor->mesh;
    const float *c = &mesh->vertex_values[(size_t)mesh->vertex_width * vertex + b->values->vertex_color];
    return (MesoMeshColor){byte_of(c[0]), byte_of(c[1]), byte_of(c[2])};
}

/* Counts what all bodies together need: a vertex for each region that it borders, and for each pair of coordinates. */
static MesoStatus reserve(Building *b)
{
    const MesoTriangulation *mesh = &b->decor->mesh;
    b->vertex_room = mesh->vertex_count + mesh->vertex_count / 4 + 64;
    bool uvs = b->values->corner_uv != MESO_NO_INDEX || b->values->vertex_uv != MESO_NO_INDEX;
    b->positions = MESO_NEW(b->arena, MesoVec3, b->vertex_room, b->error);
    b->normals = MESO_NEW(b->arena, MesoVec3, b->vertex_room, b->error);
    b->origins = MESO_NEW(b->arena, uint32_t, b->vertex_room, b->error);
    b->next = MESO_NEW(b->arena, uint32_t, b->vertex_room, b->error);
    b->uvs = uvs ? MESO_NEW(b->arena, MesoVec2, b->vertex_room, b->error) : NULL;
    b->corners = MESO_NEW(b->arena, uint32_t, 3 * (size_t)mesh->triangle_count, b->error);
    return b->positions && b->normals && b->origins && b->next && b->corners && (!uvs || b->uvs) ? MESO_OK
                                                                                               : MESO_ERR_MEMORY;
}

#define ENLARGE(b, array)                                                                       \
    ((b)->array = meso_arena_enlarge((b)->arena, (b)->array, (b)->vertex_count, (b)->vertex_room, \
                                     sizeof *(b)->array, (b)->error))

static MesoStatus add_vertex(Building *b, const MesoVec3 *sums, uint32_t vertex, MesoVec2 uv)
{
    if (b->vertex_count == b->vertex_room) {
        b->vertex_room = b->vertex_room > UINT32_MAX / 2 ? UINT32_MAX : 2 * b->vertex_room;
        if (!ENLARGE(b, positions) || !ENLARGE(b, normals) || !ENLARGE(b, origins) || !ENLARGE(b, next) ||
            (b->uvs && !ENLARGE(b, uvs)))
            return MESO_ERR_MEMORY;
    }
    b->positions[b->vertex_count] = b->decor->mesh.positions[vertex];
    b->normals[b->vertex_count] = meso_vec3_direction(sums[vertex], (MesoVec3){0, 0, 1});
    b->origins[b->vertex_count] = vertex;
    b->next[b->vertex_count] = MESO_NO_INDEX;
    if (b->uvs)
        b->uvs[b->vertex_count] = uv;
    b->vertex_count++;
    return MESO_OK;
}

/* The copy of a corner's vertex in the body that begins at `first`, by its coordinates. */
static MesoStatus find_vertex(Building *b, const MesoVec3 *sums, uint32_t *copy_of, uint32_t first, uint32_t corner,
                              uint32_t *found)
{
    uint32_t vertex = b->decor->mesh.corners[corner], last = MESO_NO_INDEX;
    uint32_t copy = copy_of[vertex];
    MesoVec2 uv = uv_at(b, corner);
    if (copy != MESO_NO_INDEX && (copy < first || b->origins[copy] != vertex))
        copy = MESO_NO_INDEX;       /* of another body */
    while (copy != MESO_NO_INDEX && b->uvs && memcmp(&b->uvs[copy], &uv, sizeof uv) != 0) {
        last = copy;
        copy = b->next[copy];
    }
    if (copy == MESO_NO_INDEX) {
        copy = b->vertex_count;
        MesoStatus status = add_vertex(b, sums, vertex, uv);
        if (status)
            return status;
        if (last == MESO_NO_INDEX)
            copy_of[vertex] = copy;
        else
            b->next[last] = copy;
    }
    *found = copy - first;
    return MESO_OK;
}

/* Regions meet at an angle where one is displaced, and hardly anywhere else: 30 degrees. */
static const float CREASE_COSINE = 0.866f;

/*
 * A vertex where a region meets the others at an angle, the foot of a bump, has the normal of each side in its copies:
 * one for all would shade the row of triangles beside it, whose widths a cut leaves to chance. `own` is room.
 */
static void crease(Building *b, uint32_t leaf, uint32_t first, const MesoVec3 *sums, MesoVec3 *own)
{
    const MesoVec3 none = {0, 0, 0};
    for (uint32_t v = first; v < b->vertex_count; v++)
        own[b->origins[v]] = none;
    for (uint32_t k = b->begin[leaf]; k < b->begin[leaf + 1]; k++)
        meso_vertex_normals_add(own, &b->decor->mesh, b->triangles[k]);
    for (uint32_t v = first; v < b->vertex_count; v++) {
        uint32_t vertex = b->origins[v];
        MesoVec3 side = meso_vec3_direction(own[vertex], none);
        MesoVec3 others = meso_vec3_direction(meso_vec3_sub(sums[vertex], own[vertex]), side);
        if (meso_vec3_dot(side, side) > 0 && meso_vec3_dot(side, others) < CREASE_COSINE)
            b->normals[v] = side;
    }
}

static MesoStatus build_bodies(Building *b, uint32_t *first_vertex)
{
    const MesoTriangulation *mesh = &b->decor->mesh;
    MesoScene *scene = b->scene;
    MesoVec3 *sums = MESO_NEW(b->arena, MesoVec3, mesh->vertex_count, b->error);
    MesoVec3 *own = sums ? MESO_NEW(b->arena, MesoVec3, mesh->vertex_count, b->error) : NULL;
    uint32_t *copy_of = own ? MESO_NEW(b->arena, uint32_t, mesh->vertex_count, b->error) : NULL;
    uint32_t corner_count = 0;
    if (!copy_of)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < mesh->triangle_count; t++)
        meso_vertex_normals_add(sums, mesh, t);
    memset(copy_of, 0xff, mesh->vertex_count * sizeof *copy_of);
    MesoStatus status = reserve(b);
    for (uint32_t i = 0; i < b->leaf_count && !status; i++) {
        uint32_t leaf = b->leaves[i], first = b->vertex_count;
        scene->bodies[i] = (MesoBody){.face_width = 3, .face_count = b->begin[leaf + 1] - b->begin[leaf],
                                      .corners = b->corners + corner_count};
        for (uint32_t k = b->begin[leaf]; k < b->begin[leaf + 1] && !status; k++)
            for (uint32_t c = 3 * b->triangles[k], n = 0; n < 3 && !status; c++, n++)
                status = find_vertex(b, sums, copy_of, first, c, &b->corners[corner_count++]);
        if (!status)
            crease(b, leaf, first, sums, own);
        scene->bodies[i].vertex_count = b->vertex_count - first;
        scene->placed[i].body = i;
        first_vertex[i] = first;
    }
    return status;
}

/* Arrays have stopped moving. */
static MesoStatus point_bodies(Building *b, const uint32_t *first_vertex)
{
    MesoScene *scene = b->scene;
    if (b->values->vertex_color != MESO_NO_INDEX) {
        b->colors = MESO_NEW(b->arena, MesoMeshColor, b->vertex_count, b->error);
        if (!b->colors)
            return MESO_ERR_MEMORY;
        for (uint32_t v = 0; v < b->vertex_count; v++)
            b->colors[v] = color_at(b, b->origins[v]);
    }
    for (uint32_t i = 0; i < b->leaf_count; i++) {
        scene->bodies[i].positions = b->positions + first_vertex[i];
        scene->bodies[i].normals = b->normals + first_vertex[i];
        scene->bodies[i].uvs = b->uvs ? b->uvs + first_vertex[i] : NULL;
        scene->bodies[i].colors = b->colors ? b->colors + first_vertex[i] : NULL;
    }
    return MESO_OK;
}

MesoStatus meso_decor_scene(MesoScene *scene, MesoArena *arena, const MesoDecor *decor, const MesoPattern *pattern,
                            const MesoDecorValues *values, MesoError *error)
{
    Building b = {.scene = scene, .arena = arena, .decor = decor, .pattern = pattern, .values = values, .error = error};
    *scene = (MesoScene){0};
    for (uint32_t r = 0; r < decor->tree.region_count; r++)
        b.painted |= decor->tree.regions[r].material[0] != MESO_NO_INDEX;
    MesoStatus status = list_leaves(&b);
    if (status)
        return status;
    uint32_t *first_vertex = MESO_NEW(arena, uint32_t, b.leaf_count, error);
    scene->body_count = scene->placed_count = b.leaf_count;
    scene->bodies = MESO_NEW(arena, MesoBody, b.leaf_count, error);
    scene->placed = MESO_NEW(arena, MesoPlacedBody, b.leaf_count, error);
    if (!first_vertex || !scene->bodies || !scene->placed)
        return MESO_ERR_MEMORY;
    status = build_bodies(&b, first_vertex);
    if (!status)
        status = point_bodies(&b, first_vertex);
    if (!status)
        status = set_materials(&b);
    if (!status)
        status = set_ids(&b);
    if (!status)
        meso_scene_measure(scene);
    return status;
}
