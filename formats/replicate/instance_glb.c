/* The binary part is written straight from the arrays, in the order in which the JSON part has named its pieces. */
#include "formats/replicate/instance_glb.h"

#include <string.h>

#include "formats/replicate/instance_glb_parts.h"

enum { CHUNK = 4096 };

typedef struct Glb {
    const MesoInstanceScene *scene;
    const MesoInstanceFrame *frame;
    MesoGlbParts parts;
} Glb;

/* ---- the JSON part ---- */

static uint32_t count_instances(const Glb *glb, uint32_t shape)
{
    uint32_t count = 0;
    for (uint32_t d = 0; d < glb->frame->count; d++)
        count += glb->frame->details[d].kind == shape && meso_instance_shown(glb->scene, glb->frame, d);
    return count;
}

static void add_instances(Glb *glb, json_t *node, uint32_t count)
{
    static const struct { const char *name, *type; int component; uint32_t width; } attributes[] = {
        {"TRANSLATION", "VEC3", MESO_GLB_FLOAT, 3}, {"ROTATION", "VEC4", MESO_GLB_FLOAT, 4},
        {"SCALE", "VEC3", MESO_GLB_FLOAT, 3},
        {"_ID", "SCALAR", MESO_GLB_UINT, 1}, {"_BIRTH", "SCALAR", MESO_GLB_FLOAT, 1}};
    json_t *object = json_object();
    for (uint32_t i = 0; i < 5; i++) {
        uint32_t accessor = meso_glb_accessor(&glb->parts, attributes[i].type, attributes[i].component, count,
                                              attributes[i].width, 0);
        glb->parts.failed |= json_object_set_new(object, attributes[i].name, json_integer((json_int_t)accessor));
    }
    glb->parts.failed |= json_object_set_new(node, "extensions",
                                       json_pack("{s:{s:o}}", "EXT_mesh_gpu_instancing", "attributes", object));
}

static void describe(Glb *glb)
{
    const MesoInstanceScene *scene = glb->scene;
    bool instanced = false;
    meso_glb_begin(&glb->parts);
    if (scene->surface)
        meso_glb_mesh(&glb->parts, scene->surface, glb->frame->positions, glb->frame->normals);
    for (uint32_t s = 0; s < scene->shape_count; s++) {
        uint32_t count = count_instances(glb, s);
        const MesoInstanceShape *shape = &scene->shapes[s];
        if (count == 0)
            continue;
        add_instances(glb, meso_glb_mesh(&glb->parts, shape, shape->positions, shape->normals), count);
        instanced = true;
    }
    for (int i = 0; i < 2 && instanced; i++)
        glb->parts.failed |= json_object_set_new(glb->parts.root, i ? "extensionsRequired" : "extensionsUsed",
                                                 json_pack("[s]", "EXT_mesh_gpu_instancing"));
}

/* ---- the binary part ---- */

/* The words of an attribute of one detail; how many they are. */
static uint32_t words_of(const Glb *glb, uint32_t detail, int attribute, void *words)
{
    MesoInstance instance = meso_instance_of(&glb->frame->placed[detail]);
    const float birth = (float)meso_instance_birth(&glb->frame->details[detail]);
    const void *from[] = {&instance.position, instance.rotation, &instance.scale, &detail, &birth};
    static const uint32_t widths[] = {3, 4, 3, 1, 1};
    memcpy(words, from[attribute], 4 * (size_t)widths[attribute]);
    return widths[attribute];
}

static MesoStatus write_instances(const Glb *glb, uint32_t shape, int attribute, MesoOutput *output, MesoError *error)
{
    uint32_t words[CHUNK], used = 0;
    MesoStatus status = MESO_OK;
    for (uint32_t d = 0; d < glb->frame->count && !status; d++) {
        if (glb->frame->details[d].kind != shape || !meso_instance_shown(glb->scene, glb->frame, d))
            continue;
        used += words_of(glb, d, attribute, words + used);
        if (used + 4 > CHUNK) {
            status = meso_output_write(output, words, 4 * (size_t)used, error);
            used = 0;
        }
    }
    return status ? status : meso_output_write(output, words, 4 * (size_t)used, error);
}

static MesoStatus write_pieces(const Glb *glb, MesoOutput *output, MesoError *error)
{
    const MesoInstanceScene *scene = glb->scene;
    MesoStatus status = MESO_OK;
    if (scene->surface)
        status = meso_glb_write_mesh(scene->surface, glb->frame->positions, glb->frame->normals, output, error);
    for (uint32_t s = 0; s < scene->shape_count && !status; s++) {
        const MesoInstanceShape *shape = &scene->shapes[s];
        if (count_instances(glb, s) == 0)
            continue;
        status = meso_glb_write_mesh(shape, shape->positions, shape->normals, output, error);
        for (int attribute = 0; attribute < 5 && !status; attribute++)
            status = write_instances(glb, s, attribute, output, error);
    }
    return status;
}

/* ---- the file ---- */

MesoStatus meso_instance_glb_write(const MesoInstanceScene *scene, const MesoInstanceFrame *frame, MesoOutput *output,
                                   MesoError *error)
{
    Glb glb = {.scene = scene, .frame = frame};
    describe(&glb);
    MesoStatus status = meso_glb_finish(&glb.parts, scene, output, error);
    if (!status)
        status = write_pieces(&glb, output, error);
    meso_glb_release(&glb.parts);
    return status;
}
