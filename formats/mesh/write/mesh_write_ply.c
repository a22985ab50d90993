/* Binary PLY: rows of vertices, then of faces, with each attribute's bytes as they lie in memory. */
#include <string.h>

#include "formats/mesh/write/mesh_writers.h"

_Static_assert(__BYTE_ORDER__ == __ORDER_LITTLE_ENDIAN__, "rows are written as they lie in memory");

static const char *const types[MESO_SCALAR_KINDS] = {
    [MESO_SCALAR_FLOAT] = "float", [MESO_SCALAR_DOUBLE] = "double", [MESO_SCALAR_INT8] = "char",
    [MESO_SCALAR_UINT8] = "uchar", [MESO_SCALAR_INT16] = "short", [MESO_SCALAR_UINT16] = "ushort",
    [MESO_SCALAR_INT32] = "int", [MESO_SCALAR_UINT32] = "uint",
};

/* ---- names ---- */

/* Names of the components of what readers and writers agree on. */
static const struct {
    const char *name;
    const char *components[4];
    uint32_t low, high;         /* widths */
} known[] = {
    {"normal", {"nx", "ny", "nz"}, 3, 3},
    {"uv", {"s", "t"}, 2, 2},
    {"color", {"red", "green", "blue", "alpha"}, 3, 4},
};

static const char *known_component(const MesoAttribute *a, uint32_t component)
{
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcmp(a->name, known[i].name) == 0 && a->width >= known[i].low && a->width <= known[i].high)
            return known[i].components[component];
    return NULL;
}

static bool has_components(const MesoAttribute *a)
{
    for (uint32_t c = 0; c < a->width; c++)
        if (!a->components || !a->components[c])
            return false;
    return a->width > 0;
}

/* A name of a property, in `name` [size]; words end at blanks. */
static void name_component(char *name, size_t size, const MesoAttribute *a, uint32_t component)
{
    const char *given = has_components(a) ? a->components[component] : known_component(a, component);
    if (given)
        snprintf(name, size, "%s", given);
    else if (a->width <= 1)
        snprintf(name, size, "%s", a->name);
    else if (a->width == 3)
        snprintf(name, size, "%s_%c", a->name, "xyz"[component]);
    else
        snprintf(name, size, "%s_%u", a->name, component);
    for (char *c = name; *c; c++)
        if ((unsigned char)*c <= 0x20 || *c == 0x7f)
            *c = '_';
}

enum { NAME_BYTES = 256 };

static bool is_written(const MesoPolygonMesh *mesh, const MesoAttribute *attribute)
{
    char name[NAME_BYTES], other[NAME_BYTES];
    name_component(name, sizeof name, attribute, 0);
    if (attribute->domain == MESO_ON_VERTICES && (strcmp(name, "x") == 0 || strcmp(name, "y") == 0 ||
                                                  strcmp(name, "z") == 0))
        return false;
    for (const MesoAttribute *a = mesh->attributes; a < attribute; a++) {
        name_component(other, sizeof other, a, 0);
        if (a->domain == attribute->domain && strcmp(name, other) == 0)
            return false;
    }
    return true;
}

bool meso_mesh_ply_holds(const MesoPolygonMesh *mesh, const MesoAttribute *attribute)
{
    return is_written(mesh, attribute);
}

/* ---- header ---- */

static void put_property(MesoMeshSink *sink, const char *type, const char *name)
{
    meso_mesh_sink_text(sink, "property ");
    meso_mesh_sink_text(sink, type);
    meso_mesh_sink_character(sink, ' ');
    meso_mesh_sink_text(sink, name);
    meso_mesh_sink_character(sink, '\n');
}

static void put_properties(MesoMeshSink *sink, const MesoPolygonMesh *mesh, MesoAttributeDomain domain)
{
    for (uint32_t i = 0; i < mesh->attribute_count; i++) {
        const MesoAttribute *a = &mesh->attributes[i];
        char name[NAME_BYTES];
        if (a->domain != domain || !is_written(mesh, a))
            continue;
        for (uint32_t c = 0; c < (a->width ? a->width : 1); c++) {
            name_component(name, sizeof name, a, c);
            put_property(sink, a->width ? types[a->scalar] : "int", name);
        }
    }
}

/* The type of counts of lists: a byte where that is enough. */
static bool needs_wide_counts(const MesoPolygonMesh *mesh, uint32_t width)
{
    uint64_t most = mesh->side_count;
    for (uint32_t f = 0; f < mesh->face_count && mesh->face_begin; f++)
        most = meso_polygon_sides(mesh, f) > most ? meso_polygon_sides(mesh, f) : most;
    return most * width > UINT8_MAX;
}

static uint32_t list_width(const MesoAttribute *a)
{
    return a->width ? a->width : 1;
}

static void put_list_property(MesoMeshSink *sink, bool wide, const char *type, const char *name)
{
    meso_mesh_sink_text(sink, wide ? "property list int " : "property list uchar ");
    meso_mesh_sink_text(sink, type);
    meso_mesh_sink_character(sink, ' ');
    meso_mesh_sink_name(sink, name, '_');
    meso_mesh_sink_character(sink, '\n');
}

static void put_lists(MesoMeshSink *sink, const MesoPolygonMesh *mesh)
{
    put_list_property(sink, needs_wide_counts(mesh, 1), "uint", "vertex_indices");
    for (uint32_t i = 0; i < mesh->attribute_count; i++) {
        const MesoAttribute *a = &mesh->attributes[i];
        bool texcoord = strcmp(a->name, "uv") == 0 && a->width == 2;
        if (a->domain == MESO_ON_CORNERS && is_written(mesh, a))
            put_list_property(sink, needs_wide_counts(mesh, list_width(a)), a->width ? types[a->scalar] : "int",
                              texcoord ? "texcoord" : a->name);
    }
}

static void put_names(MesoMeshSink *sink, const MesoPolygonMesh *mesh)
{
    for (uint32_t i = 0; i < mesh->attribute_count; i++) {
        const MesoAttribute *a = &mesh->attributes[i];
        for (uint32_t e = 0; e < a->entry_count && a->width == 0 && is_written(mesh, a); e++) {
            meso_mesh_sink_text(sink, "comment ");
            meso_mesh_sink_name(sink, a->name, '_');
            meso_mesh_sink_character(sink, ' ');
            meso_mesh_sink_number(sink, e);
            meso_mesh_sink_character(sink, ' ');
            meso_mesh_sink_name(sink, a->names[e], ' ');
            meso_mesh_sink_character(sink, '\n');
        }
    }
}

static void put_header(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance)
{
    meso_mesh_sink_text(sink, "ply\nformat binary_little_endian 1.0\n");
    meso_mesh_sink_provenance(sink, provenance, "comment ");
    put_names(sink, mesh);
    meso_mesh_sink_text(sink, "element vertex ");
    meso_mesh_sink_number(sink, mesh->vertex_count);
    meso_mesh_sink_text(sink, "\nproperty float x\nproperty float y\nproperty float z\n");
    put_properties(sink, mesh, MESO_ON_VERTICES);
    meso_mesh_sink_text(sink, "element face ");
    meso_mesh_sink_number(sink, mesh->face_count);
    meso_mesh_sink_character(sink, '\n');
    put_lists(sink, mesh);
    put_properties(sink, mesh, MESO_ON_FACES);
    meso_mesh_sink_text(sink, "end_header\n");
}

/* ---- rows ---- */

static void put_entry(MesoMeshSink *sink, const MesoAttribute *a, uint32_t element)
{
    static const double zero = 0;
    uint32_t entry = meso_attribute_entry(a, element);
    size_t size = meso_scalar_size(a->scalar);
    if (a->width == 0)
        meso_mesh_sink_put(sink, &(int32_t){entry == MESO_NO_INDEX ? -1 : (int32_t)entry}, sizeof(int32_t));
    else if (entry != MESO_NO_INDEX)
        meso_mesh_sink_put(sink, (const char *)a->values + size * a->width * entry, size * a->width);
    for (uint32_t c = 0; c < a->width && entry == MESO_NO_INDEX; c++)
        meso_mesh_sink_put(sink, &zero, size);
}

static void put_count(MesoMeshSink *sink, bool wide, uint32_t count)
{
    if (wide)
        meso_mesh_sink_put(sink, &count, sizeof count);
    else
        meso_mesh_sink_character(sink, (char)count);
}

/* What one row has behind its position or its vertices. */
typedef struct Columns {
    uint32_t count;
    const MesoAttribute **attributes;   /* [count] */
    bool *wide;                         /* [count] of lists */
} Columns;

static bool find_columns(Columns *columns, MesoMeshSink *sink, const MesoPolygonMesh *mesh, MesoAttributeDomain domain)
{
    columns->attributes = MESO_NEW(sink->scratch, const MesoAttribute *, mesh->attribute_count, sink->error);
    columns->wide = MESO_NEW(sink->scratch, bool, mesh->attribute_count, sink->error);
    columns->count = 0;
    if (!columns->attributes || !columns->wide) {
        sink->status = MESO_ERR_MEMORY;
        return false;
    }
    for (uint32_t i = 0; i < mesh->attribute_count; i++) {
        if (mesh->attributes[i].domain != domain || !is_written(mesh, &mesh->attributes[i]))
            continue;
        columns->wide[columns->count] = needs_wide_counts(mesh, list_width(&mesh->attributes[i]));
        columns->attributes[columns->count++] = &mesh->attributes[i];
    }
    return true;
}

static void put_vertices(MesoMeshSink *sink, const MesoPolygonMesh *mesh)
{
    Columns columns;
    if (!find_columns(&columns, sink, mesh, MESO_ON_VERTICES))
        return;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        meso_mesh_sink_put(sink, &mesh->positions[v], sizeof mesh->positions[v]);
        for (uint32_t i = 0; i < columns.count; i++)
            put_entry(sink, columns.attributes[i], v);
    }
}

static void put_faces(MesoMeshSink *sink, const MesoPolygonMesh *mesh)
{
    Columns lists, columns;
    bool wide = needs_wide_counts(mesh, 1);
    if (!find_columns(&lists, sink, mesh, MESO_ON_CORNERS) || !find_columns(&columns, sink, mesh, MESO_ON_FACES))
        return;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        uint32_t begin = meso_polygon_begin(mesh, f), sides = meso_polygon_sides(mesh, f);
        put_count(sink, wide, sides);
        meso_mesh_sink_put(sink, mesh->corners + begin, sides * sizeof *mesh->corners);
        for (uint32_t i = 0; i < lists.count; i++) {
            put_count(sink, lists.wide[i], sides * list_width(lists.attributes[i]));
            for (uint32_t c = begin; c < begin + sides; c++)
                put_entry(sink, lists.attributes[i], c);
        }
        for (uint32_t i = 0; i < columns.count; i++)
            put_entry(sink, columns.attributes[i], f);
    }
}

/* ---- corners that agree ---- */

static bool same_bytes(const MesoAttribute *a, uint32_t i, uint32_t j)
{
    size_t size = (size_t)a->width * meso_scalar_size(a->scalar);
    if (i == j || i == MESO_NO_INDEX || j == MESO_NO_INDEX || a->width == 0)
        return i == j;
    return memcmp((const char *)a->values + size * i, (const char *)a->values + size * j, size) == 0;
}

/* entry_of[v] [vertex_count] becomes that of all corners at v; false where two of them differ. */
static bool agree_at_vertices(uint32_t *entry_of, const MesoPolygonMesh *mesh, const MesoAttribute *a, bool *met)
{
    memset(entry_of, 0xff, mesh->vertex_count * sizeof *entry_of);
    memset(met, 0, mesh->vertex_count);
    for (uint32_t c = 0; c < mesh->corner_count; c++) {
        uint32_t v = mesh->corners[c], entry = meso_attribute_entry(a, c);
        if (met[v] && !same_bytes(a, entry_of[v], entry))
            return false;
        if (!met[v])
            entry_of[v] = entry;
        met[v] = true;
    }
    return true;
}

/*
 * Few readers know lists of corners, and all know numbers of vertices: what is the same all around each vertex is
 * written there, unless vertices have one of its name.
 */
static bool move_to_vertices(MesoPolygonMesh *moved, MesoMeshSink *sink, const MesoPolygonMesh *mesh)
{
    bool *met = MESO_NEW(sink->scratch, bool, mesh->vertex_count, sink->error);
    *moved = *mesh;
    moved->attributes = MESO_NEW(sink->scratch, MesoAttribute, mesh->attribute_count, sink->error);
    if (!met || !moved->attributes)
        return false;
    for (uint32_t i = 0; i < mesh->attribute_count; i++) {
        MesoAttribute *a = &moved->attributes[i];
        *a = mesh->attributes[i];
        if (a->domain != MESO_ON_CORNERS || meso_polygon_attribute_on(mesh, a->name, MESO_ON_VERTICES))
            continue;
        MesoArenaMark mark = meso_arena_mark(sink->scratch);
        uint32_t *entry_of = MESO_NEW(sink->scratch, uint32_t, mesh->vertex_count, sink->error);
        if (!entry_of)
            return false;
        if (agree_at_vertices(entry_of, mesh, a, met)) {
            a->domain = MESO_ON_VERTICES;
            a->entry_of = entry_of;
        } else {
            meso_arena_rewind(sink->scratch, mark);
        }
    }
    return true;
}

void meso_mesh_write_ply(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance)
{
    MesoPolygonMesh moved;
    if (!move_to_vertices(&moved, sink, mesh)) {
        sink->status = MESO_ERR_MEMORY;
        return;
    }
    put_header(sink, &moved, provenance);
    put_vertices(sink, &moved);
    put_faces(sink, &moved);
}
