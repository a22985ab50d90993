/*
 * USD as text: strands as curves, one prim for each material, and bodies as
 * meshes. Each attribute is written by a walk over the strands or the parts, so
 * that nothing is held but one part.
 */
#include "formats/scene/strand/usda_scene.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "formats/file/float_text.h"
#include "formats/scene/mesh_window.h"
#include "formats/scene/strand/sweep_strands.h"
#include "libcore/scene/cell.h"

enum { BUFFER = 1 << 16, ITEM = 1 << 10 };

static const char BINDING[] = "(\n        prepend apiSchemas = [\"MaterialBindingAPI\"]\n    )\n    {\n";

/* A stretch of a strand of one material: what becomes one curve. */
typedef struct Curve {
    uint32_t strand, begin, end;    /* pieces [begin, end) of the strands */
    uint32_t material;
} Curve;

typedef struct Writer {
    const MesoSceneParts *parts;
    const MesoMeshWriteOptions *options;
    MesoStrands strands;
    uint32_t strand_channel;        /* the one called "strand", or MESO_NO_INDEX */
    uint32_t curve_count;
    Curve *curves;                  /* [curve_count] */
    MesoMeshVertex *vertices;       /* [of the largest body] */
    MesoMeshFace *faces;
    MesoOutput *output;
    char *buffer;                   /* [BUFFER] */
    size_t used;
    bool first;                     /* of the array that is being written */
    MesoStatus status;
    MesoError *error;
} Writer;

/* ---- text ---- */

static void pass_on(Writer *w)
{
    if (!w->status)
        w->status = meso_output_write(w->output, w->buffer, w->used, w->error);
    w->used = 0;
}

__attribute__((format(printf, 2, 3)))
static void print(Writer *w, const char *format, ...)
{
    va_list arguments;
    if (w->used + ITEM > BUFFER)
        pass_on(w);
    va_start(arguments, format);
    int size = vsnprintf(w->buffer + w->used, ITEM, format, arguments);
    va_end(arguments);
    w->used += size < ITEM ? (size_t)size : ITEM - 1;
}

static void print_string(Writer *w, const char *text)
{
    print(w, "\"");
    for (const char *c = text; *c; c++) {
        if (w->used + ITEM > BUFFER)
            pass_on(w);
        if (*c == '"' || *c == '\\')
            w->buffer[w->used++] = '\\';
        w->buffer[w->used++] = (unsigned char)*c < 0x20 ? ' ' : *c;
    }
    print(w, "\"");
}

static void begin_array(Writer *w, const char *declaration)
{
    print(w, "        %s = [", declaration);
    w->first = true;
}

static void end_array(Writer *w, const char *interpolation)
{
    if (interpolation)
        print(w, "] (interpolation = \"%s\")\n", interpolation);
    else
        print(w, "]\n");
}

static void put_whole(Writer *w, uint32_t value)
{
    print(w, w->first ? "%u" : ", %u", value);
    w->first = false;
}

/* One number as it is, several in brackets. */
static void put_floats(Writer *w, const float *values, int count)
{
    char text[4 * (MESO_FLOAT_TEXT + 2) + 4], *out = text;
    for (int i = 0; i < count; i++) {
        if (i > 0) {
            *out++ = ',';
            *out++ = ' ';
        }
        out = meso_float_text(values[i], out);
    }
    *out = 0;
    print(w, count > 1 ? "%s(%s)" : "%s%s", w->first ? "" : ", ", text);
    w->first = false;
}

static void put_vector(Writer *w, MesoVec3 v)
{
    put_floats(w, (const float[]){v.x, v.y, v.z}, 3);
}

/* ---- curves ---- */

static const MesoSweptKind *kind_of(const Writer *w, uint32_t sweep)
{
    const MesoScene *scene = w->parts->scene;
    return &scene->kinds[meso_scene_kind(scene, sweep)];
}

/* Caps are no part of a curve. */
static bool is_drawn(const Writer *w, uint32_t piece)
{
    return !kind_of(w, w->strands.pieces[piece].sweep)->cap;
}

static uint32_t material_of(const Writer *w, uint32_t piece)
{
    return kind_of(w, w->strands.pieces[piece].sweep)->start_material;
}

/* `curves` NULL only counts. */
static uint32_t cut_curves(const Writer *w, Curve *curves)
{
    uint32_t count = 0;
    for (uint32_t s = 0; s < w->strands.count; s++)
        for (uint32_t i = w->strands.begin[s]; i < w->strands.begin[s + 1];) {
            Curve curve = {s, i, i, material_of(w, i)};
            if (!is_drawn(w, i)) {
                i++;
                continue;
            }
            while (i < w->strands.begin[s + 1] && is_drawn(w, i) && material_of(w, i) == curve.material)
                i++;
            curve.end = i;
            if (curves)
                curves[count] = curve;
            count++;
        }
    return count;
}

/* Calls `put` for each curve of a material. */
static void each_curve(Writer *w, uint32_t material, void (*put)(Writer *w, const Curve *curve))
{
    for (uint32_t c = 0; c < w->curve_count; c++)
        if (w->curves[c].material == material)
            put(w, &w->curves[c]);
}

static void put_count(Writer *w, const Curve *curve)
{
    put_whole(w, 3 * (curve->end - curve->begin) + 1);
}

static void put_points(Writer *w, const Curve *curve)
{
    for (uint32_t i = curve->begin; i < curve->end; i++) {
        MesoStrandPiece piece = w->strands.pieces[i];
        MesoVec3 p[4];
        meso_sweep_trajectory(w->parts->scene, &w->parts->scene->sweeps[piece.sweep], p);
        for (int k = i == curve->begin ? 0 : 1; k < 4; k++)
            put_vector(w, p[piece.reversed ? 3 - k : k]);
    }
}

/* At the start of each piece, and at the end of the last. */
static void put_widths(Writer *w, const Curve *curve)
{
    for (uint32_t i = curve->begin; i <= curve->end; i++) {
        MesoStrandPiece piece = w->strands.pieces[i < curve->end ? i : i - 1];
        bool at_end = piece.reversed != (i == curve->end);
        float width = 2 * meso_strand_radius(w->parts->scene, kind_of(w, piece.sweep), at_end) *
                      w->parts->scene->sweeps[piece.sweep].size[at_end] *
                      meso_sweep_growth(w->parts->scene, &w->parts->scene->sweeps[piece.sweep], at_end);
        put_floats(w, &width, 1);
    }
}

/* As the channel numbers it, where there is one. */
static void put_strand(Writer *w, const Curve *curve)
{
    const MesoScene *scene = w->parts->scene;
    uint32_t row = scene->sweeps[w->strands.pieces[curve->begin].sweep].ids;
    put_whole(w, w->strand_channel == MESO_NO_INDEX ? curve->strand : meso_scene_id(scene, row, w->strand_channel));
}

static void put_length(Writer *w, const Curve *curve)
{
    put_floats(w, &w->strands.length[curve->strand], 1);
}

static void put_curve_ids(Writer *w, const Curve *curve, uint32_t channel)
{
    const MesoScene *scene = w->parts->scene;
    for (uint32_t i = curve->begin; i <= curve->end; i++) {
        uint32_t sweep = w->strands.pieces[i < curve->end ? i : i - 1].sweep;
        put_whole(w, meso_scene_id(scene, scene->sweeps[sweep].ids, channel));
    }
}

static bool has_curves(const Writer *w, uint32_t material)
{
    for (uint32_t c = 0; c < w->curve_count; c++)
        if (w->curves[c].material == material)
            return true;
    return false;
}

static void print_binding(Writer *w, uint32_t material)
{
    print(w, "        rel material:binding = </World/Looks/look_%u>\n", material);
}

static void print_channel(Writer *w, uint32_t channel)
{
    char name[MESO_CHANNEL_NAME + 32];
    snprintf(name, sizeof name, "int[] primvars:%s", w->parts->scene->channels[channel].name);
    begin_array(w, name);
}

static void print_curves(Writer *w, uint32_t material)
{
    if (!has_curves(w, material))
        return;
    print(w, "    def BasisCurves \"Strands_%u\" %s", material, BINDING);
    print(w, "        uniform token type = \"cubic\"\n        uniform token basis = \"bezier\"\n"
             "        uniform token wrap = \"nonperiodic\"\n");
    begin_array(w, "int[] curveVertexCounts");
    each_curve(w, material, put_count);
    end_array(w, NULL);
    begin_array(w, "point3f[] points");
    each_curve(w, material, put_points);
    end_array(w, NULL);
    begin_array(w, "float[] widths");
    each_curve(w, material, put_widths);
    end_array(w, "varying");
    begin_array(w, "int[] primvars:strand");
    each_curve(w, material, put_strand);
    end_array(w, "uniform");
    begin_array(w, "float[] primvars:strand_length");
    each_curve(w, material, put_length);
    end_array(w, "uniform");
    for (uint32_t channel = 0; channel < w->parts->scene->channel_count; channel++) {
        if (channel == w->strand_channel)
            continue;
        print_channel(w, channel);
        for (uint32_t c = 0; c < w->curve_count; c++)
            if (w->curves[c].material == material)
                put_curve_ids(w, &w->curves[c], channel);
        end_array(w, "varying");
    }
    print_binding(w, material);
    print(w, "    }\n\n");
}

/* ---- bodies ---- */

/* Calls `put` for each placed body of a material, with the number of vertices of those before. */
static void each_body(Writer *w, uint32_t material, void (*put)(Writer *w, uint32_t part, uint32_t base))
{
    const MesoSceneParts *parts = w->parts;
    uint32_t base = 0;
    for (uint32_t part = parts->scene->sweep_count; part < parts->part_count; part++) {
        if (meso_scene_part(parts, part).material != material)
            continue;
        put(w, part, base);
        base += (uint32_t)(parts->vertex_begin[part + 1] - parts->vertex_begin[part]);
    }
}

static void put_face_counts(Writer *w, uint32_t part, uint32_t base)
{
    uint64_t count = w->parts->face_begin[part + 1] - w->parts->face_begin[part];
    meso_scene_faces(w->parts, part, part + 1, base, w->faces);
    for (uint64_t f = 0; f < count; f++)
        put_whole(w, w->faces[f].v[3] == MESO_NO_INDEX ? 3 : 4);
}

static void put_corners(Writer *w, uint32_t part, uint32_t base)
{
    uint64_t count = w->parts->face_begin[part + 1] - w->parts->face_begin[part];
    meso_scene_faces(w->parts, part, part + 1, base, w->faces);
    for (uint64_t f = 0; f < count; f++)
        for (int k = 0; k < 4 && w->faces[f].v[k] != MESO_NO_INDEX; k++)
            put_whole(w, w->faces[f].v[k]);
}

static uint64_t make_vertices(Writer *w, uint32_t part)
{
    meso_scene_vertices(w->parts, part, part + 1, w->vertices);
    return w->parts->vertex_begin[part + 1] - w->parts->vertex_begin[part];
}

static void put_positions(Writer *w, uint32_t part, uint32_t base)
{
    uint64_t count = make_vertices(w, part);
    (void)base;
    for (uint64_t v = 0; v < count; v++)
        put_vector(w, w->vertices[v].position);
}

static void put_normals(Writer *w, uint32_t part, uint32_t base)
{
    uint64_t count = make_vertices(w, part);
    (void)base;
    for (uint64_t v = 0; v < count; v++)
        put_vector(w, w->vertices[v].normal);
}

static void put_uvs(Writer *w, uint32_t part, uint32_t base)
{
    uint64_t count = make_vertices(w, part);
    (void)base;
    for (uint64_t v = 0; v < count; v++)
        put_floats(w, &w->vertices[v].uv.x, 2);
}

static void put_face_ids(Writer *w, uint32_t material, uint32_t channel)
{
    const MesoSceneParts *parts = w->parts;
    for (uint32_t part = parts->scene->sweep_count; part < parts->part_count; part++) {
        MesoPart of = meso_scene_part(parts, part);
        uint64_t count = parts->face_begin[part + 1] - parts->face_begin[part];
        for (uint64_t f = 0; f < count && of.material == material; f++)
            put_whole(w, meso_scene_id(parts->scene, of.ids, channel));
    }
}

static bool has_bodies(const Writer *w, uint32_t material)
{
    for (uint32_t part = w->parts->scene->sweep_count; part < w->parts->part_count; part++)
        if (meso_scene_part(w->parts, part).material == material)
            return true;
    return false;
}

static void print_bodies(Writer *w, uint32_t material)
{
    static const struct {
        const char *declaration, *interpolation;
        void (*put)(Writer *w, uint32_t part, uint32_t base);
    } arrays[] = {
        {"int[] faceVertexCounts", NULL, put_face_counts},
        {"int[] faceVertexIndices", NULL, put_corners},
        {"point3f[] points", NULL, put_positions},
        {"normal3f[] normals", "vertex", put_normals},
        {"texCoord2f[] primvars:st", "vertex", put_uvs},
    };
    if (!has_bodies(w, material))
        return;
    print(w, "    def Mesh \"Bodies_%u\" %s", material, BINDING);
    print(w, "        uniform token subdivisionScheme = \"none\"\n");
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) {
        begin_array(w, arrays[i].declaration);
        each_body(w, material, arrays[i].put);
        end_array(w, arrays[i].interpolation);
    }
    for (uint32_t channel = 0; channel < w->parts->scene->channel_count; channel++) {
        print_channel(w, channel);
        put_face_ids(w, material, channel);
        end_array(w, "uniform");
    }
    print_binding(w, material);
    print(w, "    }\n\n");
}

/* ---- the file ---- */

static void print_look(Writer *w, uint32_t number)
{
    const MesoMaterial *m = &w->parts->scene->materials[number];
    char name[MESO_MESH_NAME];
    meso_mesh_material_name(w->parts->scene, number, name);
    print(w, "        def Material \"look_%u\"\n        {\n            custom string meso:name = ", number);
    print_string(w, name);
    print(w, "\n            token outputs:surface.connect = </World/Looks/look_%u/preview.outputs:surface>\n", number);
    print(w, "            def Shader \"preview\"\n            {\n"
             "                uniform token info:id = \"UsdPreviewSurface\"\n"
             "                color3f inputs:diffuseColor = ");
    w->first = true;
    put_floats(w, m->albedo, 3);
    print(w, "\n                float inputs:roughness = ");
    w->first = true;
    put_floats(w, &m->roughness, 1);
    print(w, "\n                float inputs:metallic = ");
    w->first = true;
    put_floats(w, &m->metallic, 1);
    print(w, "\n                token outputs:surface\n            }\n        }\n");
}

static void print_names(Writer *w, const MesoIdChannel *channel)
{
    print(w, "        string[] %ss = [", channel->name);
    for (uint32_t i = 0; i < channel->count; i++) {
        print(w, "%s", i ? ", " : "");
        print_string(w, channel->names[i]);
    }
    print(w, "]\n");
}

static void print_head(Writer *w, const char *provenance)
{
    const MesoScene *scene = w->parts->scene;
    float unit = w->options->unit > 0 ? w->options->unit : 1;
    print(w, "#usda 1.0\n(\n    customLayerData = {\n");
    for (uint32_t c = 0; c < scene->channel_count; c++)
        if (scene->channels[c].names)
            print_names(w, &scene->channels[c]);
    if (*provenance) {
        print(w, "        string provenance = ");
        print_string(w, provenance);
        print(w, "\n");
    }
    print(w, "    }\n    defaultPrim = \"World\"\n    metersPerUnit = ");
    w->first = true;
    put_floats(w, &unit, 1);
    print(w, "\n    upAxis = \"%s\"\n)\n\ndef Xform \"World\"\n{\n", w->options->z_up ? "Z" : "Y");
}

static void report(const Writer *w, uint64_t done)
{
    if (w->options->progress)
        w->options->progress(w->options->progress_context, done, w->parts->scene->material_count);
}

static void print_all(Writer *w, const char *provenance)
{
    const MesoScene *scene = w->parts->scene;
    print_head(w, provenance);
    print(w, "    def Scope \"Looks\"\n    {\n");
    for (uint32_t m = 0; m < scene->material_count; m++)
        print_look(w, m);
    print(w, "    }\n\n");
    for (uint32_t m = 0; m < scene->material_count && !w->status; m++) {
        print_curves(w, m);
        print_bodies(w, m);
        report(w, m + 1);
    }
    print(w, "}\n");
    pass_on(w);
}

static MesoStatus allocate(Writer *w, MesoArena *arena, MesoError *error)
{
    const MesoSceneParts *parts = w->parts;
    uint64_t vertices = 0, faces = 0;
    for (uint32_t part = parts->scene->sweep_count; part < parts->part_count; part++) {
        uint64_t v = parts->vertex_begin[part + 1] - parts->vertex_begin[part];
        uint64_t f = parts->face_begin[part + 1] - parts->face_begin[part];
        vertices = v > vertices ? v : vertices;
        faces = f > faces ? f : faces;
    }
    w->strand_channel = MESO_NO_INDEX;
    for (uint32_t c = 0; c < parts->scene->channel_count; c++)
        if (strcmp(parts->scene->channels[c].name, "strand") == 0)
            w->strand_channel = c;
    w->curve_count = cut_curves(w, NULL);
    w->curves = MESO_NEW(arena, Curve, w->curve_count, error);
    w->vertices = MESO_NEW(arena, MesoMeshVertex, vertices, error);
    w->faces = MESO_NEW(arena, MesoMeshFace, faces, error);
    w->buffer = MESO_NEW(arena, char, BUFFER, error);
    if (!w->curves || !w->vertices || !w->faces || !w->buffer)
        return MESO_ERR_MEMORY;
    cut_curves(w, w->curves);
    return MESO_OK;
}

/* Text formats cannot say what is not finite. */
static MesoStatus check(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoError *error)
{
    MesoBox box;
    MesoStatus status = meso_mesh_check_counts(parts, options, "a USD file", error);
    return status ? status : meso_scene_parts_box(parts, options->thread_count, &box, error);
}

MesoStatus meso_usda_scene_write(const MesoSceneParts *parts, const MesoMeshWriteOptions *options, MesoOutput *output,
                                 MesoError *error)
{
    MesoArena arena;
    Writer w = {.parts = parts, .options = options, .output = output, .error = error};
    meso_arena_init(&arena);
    const char *provenance = meso_mesh_provenance(options, &arena, error);
    MesoStatus status = provenance ? check(parts, options, error) : MESO_ERR_MEMORY;
    if (!status)
        status = meso_strands_find(&w.strands, &arena, parts->scene, error);
    if (!status)
        status = allocate(&w, &arena, error);
    if (!status) {
        print_all(&w, provenance);
        status = w.status;
    }
    meso_arena_release(&arena);
    return status;
}
