#include "formats/replicate/usda_file.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "formats/file/float_text.h"
#include "formats/file/temporary.h"

enum { BUFFER = 1 << 16, ITEM = 512, NAME = 80 };

/* What has time samples. */
typedef enum Attribute {
    PROTOTYPES, IDS, BIRTHS, POSITIONS, ORIENTATIONS, SCALES, POINTS, NORMALS, ATTRIBUTES
} Attribute;

static const char *const headings[ATTRIBUTES] = {
    "int[] protoIndices", "int64[] ids", "int[] primvars:birth", "point3f[] positions", "quath[] orientations",
    "float3[] scales", "point3f[] points", "normal3f[] normals",
};

/* Text that waits in a file without a name. */
typedef struct Spill {
    int file;               /* -1: none */
    char *buffer;           /* [BUFFER] */
    size_t used;
    int failed;             /* errno */
} Spill;

struct MesoUsda {
    const MesoInstanceScene *scene;
    double frames_per_second;
    Spill spills[ATTRIBUTES];
    int32_t first, last;
    uint32_t frame_count;
};

/* ---- waiting text ---- */

static void flush(Spill *spill)
{
    for (size_t done = 0; done < spill->used && !spill->failed;) {
        ssize_t size = write(spill->file, spill->buffer + done, spill->used - done);
        if (size < 0 && errno != EINTR)
            spill->failed = errno;
        done += size > 0 ? (size_t)size : 0;
    }
    spill->used = 0;
}

/* Room for one item more. */
static char *item(Spill *spill)
{
    if (spill->used + ITEM > BUFFER)
        flush(spill);
    return spill->buffer + spill->used;
}

static void put_text(Spill *spill, const char *text)
{
    char *out = item(spill);
    size_t size = strlen(text);
    memcpy(out, text, size);
    spill->used += size;
}

static void put_whole(Spill *spill, int64_t value, bool first)
{
    spill->used += (size_t)sprintf(item(spill), "%s%lld", first ? "" : ", ", (long long)value);
}

static void put_tuple(Spill *spill, const float *values, int count, bool first)
{
    char *begin = item(spill), *out = begin + sprintf(begin, "%s(", first ? "" : ", ");
    for (int i = 0; i < count; i++) {
        if (i) {
            *out++ = ',';
            *out++ = ' ';
        }
        out = meso_float_text(values[i], out);
    }
    *out++ = ')';
    spill->used += (size_t)(out - begin);
}

static void put_vector(Spill *spill, MesoVec3 v, bool first)
{
    put_tuple(spill, (const float[]){v.x, v.y, v.z}, 3, first);
}

static MesoStatus open_spill(Spill *spill, const char *near, MesoError *error)
{
    const char *slash = strrchr(near, '/');
    MesoTemporary temporary;
    spill->buffer = malloc(BUFFER);
    if (!spill->buffer)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    spill->file = meso_temporary_create(&temporary, near, slash ? (int)(slash + 1 - near) : 0);
    if (spill->file < 0)
        return meso_fail(error, MESO_ERR_OUTPUT, "cannot write beside '%s': %s", near, strerror(errno));
    meso_temporary_remove(&temporary);
    return MESO_OK;
}

static MesoStatus copy_spill(Spill *spill, MesoOutput *output, MesoError *error)
{
    flush(spill);
    if (spill->failed || lseek(spill->file, 0, SEEK_SET) < 0)
        return meso_fail(error, MESO_ERR_OUTPUT, "cannot write: %s", strerror(spill->failed ? spill->failed : errno));
    for (;;) {
        ssize_t size = read(spill->file, spill->buffer, BUFFER);
        if (size < 0 && errno == EINTR)
            continue;
        if (size < 0)
            return meso_fail(error, MESO_ERR_OUTPUT, "cannot read what was written: %s", strerror(errno));
        MesoStatus status = meso_output_write(output, spill->buffer, (size_t)size, error);
        if (status || size == 0)
            return status;
    }
}

/* ---- frames ---- */

/* Halves have eleven bits: four digits say them. */
static void put_orientation(Spill *spill, const MesoInstance *instance, bool first)
{
    const float *q = instance->rotation;
    float wxyz[] = {q[3], q[0], q[1], q[2]};
    for (int i = 0; i < 4; i++)
        wxyz[i] = roundf(10000 * wxyz[i]) / 10000 + 0.0f;
    put_tuple(spill, wxyz, 4, first);
}

static void put_details(MesoUsda *usda, const MesoInstanceFrame *frame)
{
    Spill *spills = usda->spills;
    bool first = true;
    for (uint32_t d = 0; d < frame->count; d++) {
        if (!meso_instance_shown(usda->scene, frame, d))
            continue;
        MesoInstance instance = meso_instance_of(&frame->placed[d]);
        put_whole(&spills[PROTOTYPES], frame->details[d].kind, first);
        put_whole(&spills[IDS], d, first);
        put_whole(&spills[BIRTHS], meso_instance_birth(&frame->details[d]), first);
        put_vector(&spills[POSITIONS], instance.position, first);
        put_orientation(&spills[ORIENTATIONS], &instance, first);
        put_vector(&spills[SCALES], instance.scale, first);
        first = false;
    }
}

MesoStatus meso_usda_frame(MesoUsda *usda, int32_t number, const MesoInstanceFrame *frame, MesoError *error)
{
    const MesoInstanceShape *surface = usda->scene->surface;
    usda->first = usda->frame_count ? usda->first : number;
    usda->last = number;
    usda->frame_count++;
    for (int a = 0; a < ATTRIBUTES; a++)
        usda->spills[a].used += (size_t)sprintf(item(&usda->spills[a]), "            %d: [", number);
    put_details(usda, frame);
    for (uint32_t v = 0; surface && v < surface->vertex_count; v++) {
        put_vector(&usda->spills[POINTS], frame->positions[v], v == 0);
        put_vector(&usda->spills[NORMALS], frame->normals[v], v == 0);
    }
    for (int a = 0; a < ATTRIBUTES; a++) {
        put_text(&usda->spills[a], "],\n");
        if (usda->spills[a].failed)
            return meso_fail(error, MESO_ERR_OUTPUT, "cannot write: %s", strerror(usda->spills[a].failed));
    }
    return MESO_OK;
}

/* ---- what stays ---- */

/* For one more item to be put there, and taken to the output where it is full. */
typedef struct Text {
    Spill spill;
    MesoOutput *output;
    MesoStatus status;
    MesoError *error;
} Text;

static void pass_on(Text *text)
{
    if (!text->status)
        text->status = meso_output_write(text->output, text->spill.buffer, text->spill.used, text->error);
    text->spill.used = 0;
}

static void make_room(Text *text)
{
    if (text->spill.used + ITEM > BUFFER)
        pass_on(text);
}

__attribute__((format(printf, 2, 3)))
static void print(Text *text, const char *format, ...)
{
    va_list arguments;
    make_room(text);
    va_start(arguments, format);
    int size = vsnprintf(text->spill.buffer + text->spill.used, ITEM, format, arguments);
    va_end(arguments);
    text->spill.used += size < ITEM ? (size_t)size : ITEM - 1;
}

static void print_vectors(Text *text, const MesoVec3 *vectors, uint32_t count)
{
    print(text, " = [");
    for (uint32_t i = 0; i < count; i++) {
        make_room(text);
        put_vector(&text->spill, vectors[i], i == 0);
    }
    print(text, "]");
}

static void print_faces(Text *text, const MesoInstanceShape *shape, const char *indent)
{
    print(text, "%sint[] faceVertexCounts = [", indent);
    for (uint32_t t = 0; t < shape->triangle_count; t++)
        print(text, t ? ", 3" : "3");
    print(text, "]\n%sint[] faceVertexIndices = [", indent);
    for (uint32_t c = 0; c < 3 * shape->triangle_count; c++)
        print(text, c ? ", %u" : "%u", shape->corners[c]);
    print(text, "]\n%suniform token subdivisionScheme = \"none\"\n", indent);
}

static void print_look(Text *text, uint32_t look, const MesoMaterial *m)
{
    char number[3][MESO_FLOAT_TEXT + 1];
    print(text, "        def Material \"look_%u\"\n        {\n", look);
    print(text, "            token outputs:surface.connect = </World/Looks/look_%u/preview.outputs:surface>\n", look);
    print(text, "            def Shader \"preview\"\n            {\n");
    print(text, "                uniform token info:id = \"UsdPreviewSurface\"\n");
    print(text, "                color3f inputs:diffuseColor = ");
    make_room(text);
    put_tuple(&text->spill, m->albedo, 3, true);
    *meso_float_text(m->roughness, number[0]) = '\0';
    *meso_float_text(m->metallic, number[1]) = '\0';
    print(text, "\n                float inputs:roughness = %s\n", number[0]);
    print(text, "                float inputs:metallic = %s\n", number[1]);
    print(text, "                token outputs:surface\n            }\n        }\n");
}

static void print_binding(Text *text, uint32_t look, const char *indent)
{
    print(text, "%srel material:binding = </World/Looks/look_%u>\n", indent, look);
}

/* Looks are numbered as shapes; the surface's comes behind. */
static void print_looks(Text *text, const MesoInstanceScene *scene)
{
    print(text, "    def Scope \"Looks\"\n    {\n");
    for (uint32_t s = 0; s < scene->shape_count; s++)
        print_look(text, s, scene->shapes[s].material);
    if (scene->surface)
        print_look(text, scene->shape_count, scene->surface->material);
    print(text, "    }\n\n");
}

static void print_prototype(Text *text, const MesoInstanceShape *shape, uint32_t number)
{
    static const char indent[] = "                ";
    char name[NAME];
    meso_instance_name(shape->name, number, name, sizeof name);
    print(text, "            def Mesh \"%s\" (prepend apiSchemas = [\"MaterialBindingAPI\"])\n            {\n", name);
    print_faces(text, shape, indent);
    print(text, "%spoint3f[] points", indent);
    print_vectors(text, shape->positions, shape->vertex_count);
    if (shape->normals) {
        print(text, "\n%snormal3f[] normals", indent);
        print_vectors(text, shape->normals, shape->vertex_count);
        print(text, " (interpolation = \"vertex\")");
    }
    print(text, "\n");
    print_binding(text, number, indent);
    print(text, "            }\n");
}

static void print_samples(Text *text, MesoUsda *usda, Attribute attribute)
{
    print(text, "        %s.timeSamples = {\n", headings[attribute]);
    pass_on(text);
    if (!text->status)
        text->status = copy_spill(&usda->spills[attribute], text->output, text->error);
    print(text, "        }\n");
}

static void print_surface(Text *text, MesoUsda *usda)
{
    const MesoInstanceScene *scene = usda->scene;
    print(text, "    def Mesh \"Surface\" (prepend apiSchemas = [\"MaterialBindingAPI\"])\n    {\n");
    print_faces(text, scene->surface, "        ");
    print_binding(text, scene->shape_count, "        ");
    print_samples(text, usda, POINTS);
    print(text, "        normal3f[] normals (interpolation = \"vertex\")\n");
    print_samples(text, usda, NORMALS);
    print(text, "    }\n\n");
}

static void print_instancer(Text *text, MesoUsda *usda)
{
    const MesoInstanceScene *scene = usda->scene;
    print(text, "    def PointInstancer \"Details\"\n    {\n        rel prototypes = [");
    for (uint32_t s = 0; s < scene->shape_count; s++) {
        char name[NAME];
        meso_instance_name(scene->shapes[s].name, s, name, sizeof name);
        print(text, "%s</World/Details/Prototypes/", s ? ", " : "");
        print(text, "%s>", name);
    }
    print(text, "]\n        int[] primvars:birth (interpolation = \"vertex\")\n");
    for (int a = PROTOTYPES; a <= SCALES; a++)
        print_samples(text, usda, (Attribute)a);
    print(text, "        def Scope \"Prototypes\"\n        {\n");
    for (uint32_t s = 0; s < scene->shape_count; s++)
        print_prototype(text, &scene->shapes[s], s);
    print(text, "        }\n    }\n");
}

static void print_head(Text *text, const MesoUsda *usda)
{
    char rate[MESO_FLOAT_TEXT + 1], unit[MESO_FLOAT_TEXT + 1];
    *meso_float_text((float)usda->frames_per_second, rate) = '\0';
    *meso_float_text(meso_instance_unit(usda->scene), unit) = '\0';
    print(text, "    defaultPrim = \"World\"\n    startTimeCode = %d\n    endTimeCode = %d\n", usda->first, usda->last);
    print(text, "    timeCodesPerSecond = %s\n    framesPerSecond = %s\n", rate, rate);
    print(text, "    metersPerUnit = %s\n    upAxis = \"%s\"\n)\n\ndef Xform \"World\"\n{\n", unit,
          usda->scene->z_up ? "Z" : "Y");
}

/* Comment lines stand behind the first one, which says what the file is. */
static MesoStatus write_provenance(const MesoInstanceScene *scene, MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    const char *lines = meso_provenance_lines(scene->provenance, "# ", &arena, error);
    MesoStatus status = lines ? meso_output_write(output, "#usda 1.0\n", 10, error) : MESO_ERR_MEMORY;
    if (!status)
        status = meso_output_write(output, lines, strlen(lines), error);
    meso_arena_release(&arena);
    return status ? status : meso_output_write(output, "(\n", 2, error);
}

MesoStatus meso_usda_write(MesoUsda *usda, MesoOutput *output, MesoError *error)
{
    Text text = {.output = output, .error = error, .spill = {.buffer = malloc(BUFFER)}};
    if (!text.spill.buffer)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    text.status = write_provenance(usda->scene, output, error);
    print_head(&text, usda);
    print_looks(&text, usda->scene);
    if (usda->scene->surface)
        print_surface(&text, usda);
    print_instancer(&text, usda);
    print(&text, "}\n");
    pass_on(&text);
    free(text.spill.buffer);
    return text.status;
}

MesoStatus meso_usda_begin(MesoUsda **usda, const MesoInstanceScene *scene, double frames_per_second,
                           const char *near, MesoError *error)
{
    MesoStatus status = MESO_OK;
    *usda = calloc(1, sizeof **usda);
    if (!*usda)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    (*usda)->scene = scene;
    (*usda)->frames_per_second = frames_per_second;
    for (int a = 0; a < ATTRIBUTES; a++)
        (*usda)->spills[a].file = -1;
    for (int a = 0; a < ATTRIBUTES && !status; a++)
        status = open_spill(&(*usda)->spills[a], near, error);
    if (status) {
        meso_usda_release(*usda);
        *usda = NULL;
    }
    return status;
}

void meso_usda_release(MesoUsda *usda)
{
    for (int a = 0; usda && a < ATTRIBUTES; a++) {
        if (usda->spills[a].file >= 0)
            close(usda->spills[a].file);
        free(usda->spills[a].buffer);
    }
    free(usda);
}
