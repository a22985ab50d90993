/* Wavefront OBJ: all vertices, all texture coordinates, all normals, then the faces, each with its own numbers. */
#include <string.h>

#include "formats/mesh/write/mesh_writers.h"

/* An attribute whose entries have numbers of their own, from 1, in the order of the first use. */
typedef struct Numbered {
    const MesoAttribute *attribute;     /* NULL: none */
    uint32_t *number_of;                /* [entry_count] 0: unused */
    uint32_t *entries;                  /* [count] */
    uint32_t count;
} Numbered;

static const MesoAttribute *find_numbered(const MesoPolygonMesh *mesh, const char *name, uint32_t low, uint32_t high)
{
    const MesoAttribute *a = meso_polygon_attribute_on(mesh, name, MESO_ON_CORNERS);
    if (!a || a->width < low || a->width > high)
        a = meso_polygon_attribute_on(mesh, name, MESO_ON_VERTICES);
    return a && a->width >= low && a->width <= high ? a : NULL;
}

static const MesoAttribute *find_uv(const MesoPolygonMesh *mesh)
{
    return find_numbered(mesh, "uv", 2, 3);
}

static const MesoAttribute *find_normals(const MesoPolygonMesh *mesh)
{
    return find_numbered(mesh, "normal", 3, 3);
}

static const MesoAttribute *find_colors(const MesoPolygonMesh *mesh)
{
    const MesoAttribute *a = meso_polygon_attribute_on(mesh, "color", MESO_ON_VERTICES);
    return a && a->width >= 3 ? a : NULL;
}

/* Statements that name faces. */
static const struct {
    const char *statement, *name;
} statements[] = {{"o", "object"}, {"g", "group"}, {"usemtl", "material"}};

enum { STATEMENT_COUNT = sizeof statements / sizeof *statements };

static const MesoAttribute *find_names(const MesoPolygonMesh *mesh, int statement)
{
    const MesoAttribute *a = meso_polygon_attribute_on(mesh, statements[statement].name, MESO_ON_FACES);
    return a && a->width == 0 ? a : NULL;
}

bool meso_mesh_obj_holds(const MesoPolygonMesh *mesh, const MesoAttribute *attribute)
{
    bool holds = attribute == find_uv(mesh) || attribute == find_normals(mesh) || attribute == find_colors(mesh);
    for (int i = 0; i < STATEMENT_COUNT; i++)
        holds |= attribute == find_names(mesh, i);
    return holds;
}

/* ---- vertices ---- */

static void put_entry(MesoMeshSink *sink, const MesoAttribute *a, uint32_t entry, uint32_t width)
{
    for (uint32_t c = 0; c < width; c++) {
        meso_mesh_sink_character(sink, ' ');
        meso_mesh_sink_float(sink, entry == MESO_NO_INDEX ? 0 : (float)meso_attribute_number(a, entry, c));
    }
}

static void put_vertices(MesoMeshSink *sink, const MesoPolygonMesh *mesh)
{
    const MesoAttribute *colors = find_colors(mesh);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float p[3] = {mesh->positions[v].x, mesh->positions[v].y, mesh->positions[v].z};
        meso_mesh_sink_character(sink, 'v');
        for (int k = 0; k < 3; k++) {
            meso_mesh_sink_character(sink, ' ');
            meso_mesh_sink_float(sink, p[k]);
        }
        if (colors)
            put_entry(sink, colors, meso_attribute_entry(colors, v), 3);
        meso_mesh_sink_character(sink, '\n');
    }
}

static uint32_t corner_entry(const Numbered *numbered, const MesoPolygonMesh *mesh, uint32_t corner)
{
    const MesoAttribute *a = numbered->attribute;
    return meso_attribute_entry(a, a->domain == MESO_ON_CORNERS ? corner : mesh->corners[corner]);
}

static void put_numbered(Numbered *numbered, MesoMeshSink *sink, const MesoPolygonMesh *mesh, const char *statement)
{
    const MesoAttribute *a = numbered->attribute;
    if (!a)
        return;
    numbered->number_of = MESO_NEW(sink->scratch, uint32_t, a->entry_count, sink->error);
    numbered->entries = MESO_NEW(sink->scratch, uint32_t, a->entry_count, sink->error);
    if (!numbered->number_of || !numbered->entries) {
        sink->status = MESO_ERR_MEMORY;
        return;
    }
    for (uint32_t c = 0; c < mesh->corner_count; c++) {
        uint32_t entry = corner_entry(numbered, mesh, c);
        if (entry == MESO_NO_INDEX || numbered->number_of[entry])
            continue;
        numbered->entries[numbered->count++] = entry;
        numbered->number_of[entry] = numbered->count;
    }
    for (uint32_t i = 0; i < numbered->count; i++) {
        meso_mesh_sink_text(sink, statement);
        put_entry(sink, a, numbered->entries[i], a->width);
        meso_mesh_sink_character(sink, '\n');
    }
}

/* ---- faces ---- */

/* The number of a corner, or 0. */
static uint32_t corner_number(const Numbered *numbered, const MesoPolygonMesh *mesh, uint32_t corner)
{
    uint32_t entry = numbered->attribute ? corner_entry(numbered, mesh, corner) : MESO_NO_INDEX;
    return entry == MESO_NO_INDEX ? 0 : numbered->number_of[entry];
}

/* A face has texture coordinates at all corners or at none, and so normals. */
static bool is_whole(const Numbered *numbered, const MesoPolygonMesh *mesh, uint32_t begin, uint32_t end)
{
    for (uint32_t c = begin; c < end; c++)
        if (!corner_number(numbered, mesh, c))
            return false;
    return true;
}

static void put_face(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const Numbered *uv, const Numbered *normals,
                     uint32_t face)
{
    uint32_t begin = meso_polygon_begin(mesh, face), end = begin + meso_polygon_sides(mesh, face);
    bool has_uv = is_whole(uv, mesh, begin, end), has_normals = is_whole(normals, mesh, begin, end);
    meso_mesh_sink_character(sink, 'f');
    for (uint32_t c = begin; c < end; c++) {
        meso_mesh_sink_character(sink, ' ');
        meso_mesh_sink_number(sink, (uint64_t)mesh->corners[c] + 1);
        if (has_uv || has_normals)
            meso_mesh_sink_character(sink, '/');
        if (has_uv)
            meso_mesh_sink_number(sink, corner_number(uv, mesh, c));
        if (has_normals) {
            meso_mesh_sink_character(sink, '/');
            meso_mesh_sink_number(sink, corner_number(normals, mesh, c));
        }
    }
    meso_mesh_sink_character(sink, '\n');
}

/* The statements that change with a face. One that had a name cannot lose it: it gets an empty one. */
static void put_statements(MesoMeshSink *sink, const MesoAttribute *const names[STATEMENT_COUNT],
                           uint32_t current[STATEMENT_COUNT], uint32_t face)
{
    for (int i = 0; i < STATEMENT_COUNT; i++) {
        uint32_t entry = names[i] ? meso_attribute_entry(names[i], face) : MESO_NO_INDEX;
        if (entry == current[i])
            continue;
        current[i] = entry;
        meso_mesh_sink_text(sink, statements[i].statement);
        if (entry != MESO_NO_INDEX) {
            meso_mesh_sink_character(sink, ' ');
            meso_mesh_sink_name(sink, names[i]->names[entry], ' ');
        }
        meso_mesh_sink_character(sink, '\n');
    }
}

void meso_mesh_write_obj(MesoMeshSink *sink, const MesoPolygonMesh *mesh, const MesoProvenance *provenance)
{
    Numbered uv = {.attribute = find_uv(mesh)}, normals = {.attribute = find_normals(mesh)};
    const MesoAttribute *names[STATEMENT_COUNT];
    uint32_t current[STATEMENT_COUNT];
    meso_mesh_sink_provenance(sink, provenance, "# ");
    put_vertices(sink, mesh);
    put_numbered(&uv, sink, mesh, "vt");
    put_numbered(&normals, sink, mesh, "vn");
    for (int i = 0; i < STATEMENT_COUNT; i++) {
        names[i] = find_names(mesh, i);
        current[i] = MESO_NO_INDEX;
    }
    for (uint32_t f = 0; f < mesh->face_count && !sink->status; f++) {
        put_statements(sink, names, current, f);
        put_face(sink, mesh, &uv, &normals, f);
    }
}
