#include "libcore/render/gl/draw_lists.h"

#include <stddef.h>

#include "libcore/render/gl/draw_batch.h"
#include "libcore/scene/cell.h"
#include "libcore/scene/detail.h"
#include "libcore/scene/parts.h"

extern const char meso_shader_sweep_vertex[], meso_shader_seen_fragment[];

/* GL counts indices and base vertices in signed ints. */
static const uint64_t MAX_ELEMENTS = INT32_MAX;

/* Every GL 4.5 has room for so many cages in one block. */
static const uint32_t MAX_CAGES = 1 << 20;

/* Uniforms of the sweeps by the locations that their shader gives them. */
enum {SECTION_SCALE = 2, CAP_RISE, TURN = 8, LEAST_TURN, MIDDLE, REACH};

typedef struct PatternVertex {
    MesoVec2 start, end, start_normal, end_normal;
    float along, around;
} PatternVertex;

/* A pattern in the making: which columns and how many rings of each kind. */
typedef struct Plan {
    uint32_t **kept;            /* [kind_count] each [column_count of the kind] */
    uint32_t *kept_count;       /* [kind_count] */
    uint32_t *ring_count;       /* [kind_count] */
    uint64_t vertex_count, index_count;
} Plan;

static GLuint upload(const MesoGl *gl, const void *data, size_t size)
{
    GLuint buffer = 0;
    gl->CreateBuffers(1, &buffer);
    gl->NamedBufferStorage(buffer, (GLsizeiptr)size, data, 0);
    return buffer;
}

/* How far the surface of a kind may lie from the control points of its instances, where these are. */
static float kind_reach(const MesoScene *scene, const MesoSweptKind *kind)
{
    float rise = MESO_CAP_RISE * scene->section_scale * meso_scene_kind_size(scene, kind);
    return fmaxf(meso_scene_kind_radius(scene, kind), rise);
}

/* Scene units that one pixel shows at the kind's point nearest to the eye; 0 where the eye is inside. */
static float finest_pixel(const MesoScene *scene, const MesoSweptKind *kind,
                          const MesoView *view, uint32_t height)
{
    float nearest = INFINITY, reach = kind_reach(scene, kind);
    for (uint32_t i = 0; i < kind->instance_count; i++) {
        MesoSweepHull hull = meso_sweep_hull(scene, &scene->sweeps[kind->instance_begin + i], reach);
        for (uint32_t k = 0; k < hull.count; k++)
            nearest = fminf(nearest, meso_vec3_dot(meso_vec3_sub(hull.points[k], view->eye), view->forward) -
                                     hull.reach);
    }
    if (view->parallel)
        return 2 * view->half_height / (float)height;
    return nearest > 0 && isfinite(nearest) ? nearest * 2 * view->half_height / (float)height : 0;
}

static void count_pattern(Plan *plan, const MesoScene *scene, uint32_t k)
{
    const MesoSweptKind *kind = &scene->kinds[k];
    const uint32_t *kept = plan->kept[k];
    uint64_t joints = 0;
    for (uint32_t i = 0; i + 1 < plan->kept_count[k]; i++)
        joints += scene->columns[kind->column_begin + kept[i]].joins_next != 0;
    plan->vertex_count += (uint64_t)plan->kept_count[k] * plan->ring_count[k];
    plan->index_count += 6 * joints * (plan->ring_count[k] - 1);
}

static MesoStatus make_plan(Plan *plan, MesoArena *arena, const MesoScene *scene,
                            const MesoView *view, uint32_t height, float tolerance_pixels,
                            MesoError *error)
{
    plan->kept = MESO_NEW(arena, uint32_t *, scene->kind_count, error);
    plan->kept_count = MESO_NEW(arena, uint32_t, scene->kind_count, error);
    plan->ring_count = MESO_NEW(arena, uint32_t, scene->kind_count, error);
    if (!plan->kept || !plan->kept_count || !plan->ring_count)
        return MESO_ERR_MEMORY;

    for (uint32_t k = 0; k < scene->kind_count; k++) {
        const MesoSweptKind *kind = &scene->kinds[k];
        float tolerance = tolerance_pixels > 0
            ? tolerance_pixels * finest_pixel(scene, kind, view, height) : 0;
        float scale = scene->section_scale * meso_scene_kind_size(scene, kind) * meso_kind_stretch(scene, kind).most;
        plan->kept[k] = MESO_NEW(arena, uint32_t, kind->column_count, error);
        if (!plan->kept[k])
            return MESO_ERR_MEMORY;
        plan->kept_count[k] = meso_detail_columns(&scene->columns[kind->column_begin],
                                                  kind->column_count, scale > 0 ? tolerance / scale : 0,
                                                  plan->kept[k]);
        plan->ring_count[k] = meso_detail_rings(scene, kind, tolerance);
        count_pattern(plan, scene, k);
    }
    if (plan->vertex_count > MAX_ELEMENTS || plan->index_count > MAX_ELEMENTS)
        return meso_fail(error, MESO_ERR_LIMIT, "sweeps have too many columns and divisions to draw "
                         "(%llu vertices)", (unsigned long long)plan->vertex_count);
    return MESO_OK;
}

static void fill_vertices(PatternVertex *out, const MesoSweepColumn *columns, const uint32_t *kept,
                          uint32_t kept_count, uint32_t ring_count)
{
    for (uint32_t r = 0; r < ring_count; r++)
        for (uint32_t c = 0; c < kept_count; c++) {
            const MesoSweepColumn *column = &columns[kept[c]];
            bool own = column->own && r > 0 && r + 1 < ring_count;
            *out++ = (PatternVertex){column->start, column->end,
                                     own ? column->own_normals[0] : column->start_normal,
                                     own ? column->own_normals[1] : column->end_normal,
                                     (float)r / (float)(ring_count - 1), column->u};
        }
}

/* Columns run clockwise around the trajectory: along, then around is counter-clockwise from outside. */
static uint32_t fill_indices(uint32_t *out, const MesoSweepColumn *columns, const uint32_t *kept,
                             uint32_t kept_count, uint32_t ring_count)
{
    uint32_t *begin = out;
    for (uint32_t r = 0; r + 1 < ring_count; r++)
        for (uint32_t c = 0; c + 1 < kept_count; c++) {
            if (!columns[kept[c]].joins_next)
                continue;
            uint32_t a = r * kept_count + c, b = a + kept_count;
            uint32_t quad[6] = {a, b, b + 1, a, b + 1, a + 1};
            for (uint32_t i = 0; i < 6; i++)
                *out++ = quad[i];
        }
    return (uint32_t)(out - begin);
}

static void describe_sweeps(MesoDrawLists *lists)
{
    const MesoGl *gl = lists->gl;
    static const struct { GLuint size, offset; } shared[] = {
        {4, offsetof(PatternVertex, start)}, {4, offsetof(PatternVertex, start_normal)},
        {1, offsetof(PatternVertex, along)}, {1, offsetof(PatternVertex, around)}};

    gl->CreateVertexArrays(1, &lists->sweep_array);
    GLuint array = lists->sweep_array;
    gl->VertexArrayVertexBuffer(array, 0, lists->pattern_vertices, 0, sizeof(PatternVertex));
    gl->VertexArrayVertexBuffer(array, 1, lists->instances, 0, sizeof(MesoSweepInstance));
    gl->VertexArrayBindingDivisor(array, 1, 1);
    gl->VertexArrayElementBuffer(array, lists->pattern_indices);
    for (GLuint i = 0; i < 15; i++) {
        bool is_shared = i < 3 || i == 14;
        GLuint k = i < 3 ? i : 3;
        gl->EnableVertexArrayAttrib(array, i);
        gl->VertexArrayAttribBinding(array, i, is_shared ? 0 : 1);
        if (is_shared)
            gl->VertexArrayAttribFormat(array, i, (GLint)shared[k].size, GL_FLOAT, GL_FALSE, shared[k].offset);
        else if (i < 11)    /* p[4], up[2], direction[2] follow each other */
            gl->VertexArrayAttribFormat(array, i, 3, GL_FLOAT, GL_FALSE,
                                        (i - 3) * (GLuint)sizeof(MesoVec3));
        else if (i == 11 || i == 13)
            gl->VertexArrayAttribIFormat(array, i, 1, GL_UNSIGNED_INT, i == 11 ? offsetof(MesoSweepInstance, ids)
                                                                               : offsetof(MesoSweepInstance, cage));
        else                /* size[2], twist and mitre */
            gl->VertexArrayAttribFormat(array, i, 4, GL_FLOAT, GL_FALSE, offsetof(MesoSweepInstance, size));
    }
}

static MesoStatus upload_cages(MesoDrawLists *lists, MesoArena *arena, MesoError *error)
{
    const MesoScene *near = &lists->shapes->near;
    if (near->cage_count > MAX_CAGES)
        return meso_fail(error, MESO_ERR_LIMIT, "sections deform in too many slots to draw by GL (%u)",
                         near->cage_count);
    float *corners = MESO_NEW(arena, float, 32 * (size_t)near->cage_count, error), *out = corners;
    for (uint32_t i = 0; corners && i < 8 * near->cage_count; i++) {
        MesoVec3 p = meso_cage_corner(&near->cages[i / 8], i % 8);
        *out++ = p.x;
        *out++ = p.y;
        *out++ = p.z;
        *out++ = 0;
    }
    if (corners)
        lists->cages = upload(lists->gl, corners, 32 * (size_t)near->cage_count * sizeof *corners);
    return corners ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus upload_sweeps(MesoDrawLists *lists, MesoArena *arena, const Plan *plan, MesoError *error)
{
    const MesoScene *scene = lists->shapes->scene;
    PatternVertex *vertices = MESO_NEW(arena, PatternVertex, plan->vertex_count, error);
    uint32_t *indices = MESO_NEW(arena, uint32_t, plan->index_count, error);
    if (!vertices || !indices)
        return MESO_ERR_MEMORY;

    uint32_t vertex = 0, index = 0;
    for (uint32_t k = 0; k < scene->kind_count; k++) {
        const MesoSweptKind *kind = &scene->kinds[k];
        const MesoSweepColumn *columns = &scene->columns[kind->column_begin];
        const uint32_t *kept = plan->kept[k];
        uint32_t kept_count = plan->kept_count[k], ring_count = plan->ring_count[k];
        MesoDrawSweep *draw = &lists->sweeps[k];

        draw->kind = k;
        draw->reach = kind_reach(scene, kind);
        draw->profiles = meso_sweep_kind_reach(scene, kind);
        draw->base_vertex = vertex;
        draw->index_begin = index;
        fill_vertices(&vertices[vertex], columns, kept, kept_count, ring_count);
        draw->index_count = fill_indices(&indices[index], columns, kept, kept_count, ring_count);
        vertex += kept_count * ring_count;
        index += draw->index_count;
    }
    lists->sweep_count = scene->kind_count;
    lists->pattern_vertices = upload(lists->gl, vertices, vertex * sizeof *vertices);
    lists->pattern_indices = upload(lists->gl, indices, index * sizeof *indices);
    lists->gl->CreateBuffers(1, &lists->instances);
    MesoStatus status = scene->deform == MESO_SWEEP_SHAPE ? upload_cages(lists, arena, error) : MESO_OK;
    if (status)
        return status;
    describe_sweeps(lists);
    return meso_gl_check(lists->gl, "upload of the sweeps", error);
}

static uint32_t add_triangles(uint32_t *indices, const MesoMeshFace *face)
{
    indices[0] = face->v[0];
    indices[1] = face->v[1];
    indices[2] = face->v[2];
    if (face->v[3] == MESO_NO_INDEX)
        return 3;
    indices[3] = face->v[0];
    indices[4] = face->v[2];
    indices[5] = face->v[3];
    return 6;
}

/* All placed bodies, one after the other. */
typedef struct BodyArrays {
    MesoMeshVertex *points;
    MesoMeshColor *colors;
    MesoMeshFace *faces;
    MesoSiftVertex *vertices;
    uint32_t *indices;
} BodyArrays;

static MesoStatus make_bodies(BodyArrays *arrays, MesoArena *arena, const MesoSceneParts *parts, MesoError *error)
{
    uint32_t begin = parts->scene->sweep_count, end = parts->part_count;
    uint64_t vertex_count = parts->vertex_begin[end] - parts->vertex_begin[begin];
    uint64_t face_count = parts->face_begin[end] - parts->face_begin[begin];
    if (vertex_count > MAX_ELEMENTS || face_count > MAX_ELEMENTS / 6)
        return meso_fail(error, MESO_ERR_LIMIT, "bodies have too many vertices to draw (%llu)",
                         (unsigned long long)vertex_count);
    arrays->points = MESO_NEW(arena, MesoMeshVertex, vertex_count, error);
    arrays->colors = MESO_NEW(arena, MesoMeshColor, vertex_count, error);
    arrays->faces = MESO_NEW(arena, MesoMeshFace, face_count, error);
    arrays->vertices = MESO_NEW(arena, MesoSiftVertex, vertex_count, error);
    arrays->indices = MESO_NEW(arena, uint32_t, 6 * face_count, error);
    if (!arrays->points || !arrays->colors || !arrays->faces || !arrays->vertices || !arrays->indices)
        return MESO_ERR_MEMORY;
    meso_scene_vertices(parts, begin, end, arrays->points);
    meso_scene_colors(parts, begin, end, arrays->colors);
    meso_scene_faces(parts, begin, end, 0, arrays->faces);
    return MESO_OK;
}

/* The first run of faces of each placed body stands for all of it: they look alike. */
static void fill_vertices_of(MesoSiftVertex *out, const BodyArrays *arrays, const MesoSceneParts *parts,
                             const MesoShapes *shapes)
{
    uint32_t first = parts->scene->sweep_count;
    uint64_t vertex = 0;
    for (uint32_t p = first, run = 0; p < parts->part_count; p++) {
        while (first + run + 1 < shapes->count && shapes->runs[run].placed < p - first)
            run++;
        for (; vertex < parts->vertex_begin[p + 1] - parts->vertex_begin[first]; vertex++) {
            MesoMeshVertex v = arrays->points[vertex];
            MesoMeshColor c = arrays->colors[vertex];
            out[vertex] = (MesoSiftVertex){meso_vec3_sub(v.position, shapes->anchor), v.normal, first + run,
                                       {c.r, c.g, c.b, 255}, v.uv};
        }
    }
}

static MesoStatus upload_bodies(MesoDrawLists *lists, MesoArena *arena, MesoError *error)
{
    MesoSceneParts parts;
    BodyArrays arrays = {0};
    MesoStatus status = meso_scene_parts_init(&parts, arena, lists->shapes->scene, error);
    if (!status)
        status = make_bodies(&arrays, arena, &parts, error);
    if (status)
        return status;

    uint32_t first = parts.scene->sweep_count;
    uint64_t vertex_count = parts.vertex_begin[parts.part_count] - parts.vertex_begin[first];
    uint64_t face_count = parts.face_begin[parts.part_count] - parts.face_begin[first];
    for (uint64_t face = 0; face < face_count; face++)
        lists->body_index_count += add_triangles(&arrays.indices[lists->body_index_count], &arrays.faces[face]);
    if (lists->body_index_count == 0)
        return MESO_OK;
    fill_vertices_of(arrays.vertices, &arrays, &parts, lists->shapes);
    lists->body_vertices = upload(lists->gl, arrays.vertices, vertex_count * sizeof *arrays.vertices);
    lists->body_indices = upload(lists->gl, arrays.indices, lists->body_index_count * sizeof *arrays.indices);
    lists->body_array = meso_gl_placed_array(lists->gl, lists->body_vertices, lists->body_indices);
    return meso_gl_check(lists->gl, "upload of the bodies", error);
}

MesoStatus meso_draw_lists_init(MesoDrawLists *lists, MesoArena *arena, const MesoGl *gl, const MesoShapes *shapes,
                                const MesoView *view, uint32_t height, float tolerance_pixels, MesoError *error)
{
    const MesoScene *scene = shapes->scene;
    *lists = (MesoDrawLists){.gl = gl, .shapes = shapes};
    lists->sweeps = MESO_NEW(arena, MesoDrawSweep, scene->kind_count, error);
    lists->selected = MESO_NEW(arena, MesoSweepInstance, scene->sweep_count, error);
    if (!lists->sweeps || !lists->selected)
        return MESO_ERR_MEMORY;

    MesoArenaMark mark = meso_arena_mark(arena);
    Plan plan = {0};
    MesoStatus status = make_plan(&plan, arena, scene, view, height, tolerance_pixels, error);
    if (!status && plan.index_count && scene->sweep_count)
        status = upload_sweeps(lists, arena, &plan, error);
    if (!status && scene->placed_count)
        status = upload_bodies(lists, arena, error);
    meso_arena_rewind(arena, mark);
    if (status)
        meso_draw_lists_release(lists);
    return status;
}

void meso_draw_lists_release(MesoDrawLists *lists)
{
    if (!lists->gl)
        return;
    const GLuint buffers[] = {lists->pattern_vertices, lists->pattern_indices, lists->instances, lists->cages,
                              lists->body_vertices, lists->body_indices};
    const GLuint arrays[] = {lists->sweep_array, lists->body_array};
    lists->gl->DeleteVertexArrays(sizeof arrays / sizeof *arrays, arrays);
    lists->gl->DeleteBuffers(sizeof buffers / sizeof *buffers, buffers);
    *lists = (MesoDrawLists){0};
}

static bool has_creases(const MesoScene *scene)
{
    bool any = false;
    for (uint32_t i = 0; i < scene->sweep_count && !any; i++)
        any = scene->sweeps[i].mitre >= MESO_CREASED;
    return any;
}

MesoStatus meso_draw_programs_init(MesoDrawPrograms *programs, const MesoGl *gl, const MesoScene *scene, bool detailed,
                                   MesoError *error)
{
#define BENT "#define BENT\n"
#define CAP "#define CAP\n"
#define DETAILED "#define DETAILED\n"
#define CREASED "#define CREASED\n"
    /* Sweeps, those with creases, caps, and all these when they are bent; and with details. */
    static const char *const defines[2][6] = {
        {"", CREASED, CAP, BENT, BENT CREASED, BENT CAP},
        {DETAILED, DETAILED CREASED, DETAILED CAP, DETAILED BENT, DETAILED BENT CREASED, DETAILED BENT CAP},
    };
    const char *const *text = defines[detailed];
    const char *sweep = meso_shader_sweep_vertex, *fragment = meso_shader_seen_fragment;
    uint32_t bent = scene->deform == MESO_SWEEP_SHAPE ? 3 : 0;
    *programs = (MesoDrawPrograms){.creased = has_creases(scene)};
    MesoStatus status = meso_gl_program(&programs->sweep, gl, text[bent + programs->creased], sweep, fragment, error);
    if (!status)
        status = meso_gl_program(&programs->cap, gl, text[bent + 2], sweep, fragment, error);
    if (!status)
        status = meso_gl_placed_program(&programs->body, gl, detailed, error);
    if (status)
        meso_draw_programs_release(programs, gl);
    return status;
}

void meso_draw_programs_release(MesoDrawPrograms *programs, const MesoGl *gl)
{
    gl->DeleteProgram(programs->sweep);
    gl->DeleteProgram(programs->cap);
    gl->DeleteProgram(programs->body);
    *programs = (MesoDrawPrograms){0};
}

/* ---- selection ---- */

typedef struct Plane {
    MesoVec3 normal;    /* unit length, inward */
    float distance;
} Plane;

/* Planes of the frustum but the far one: w + x, w - x, w + y, w - y and w of the clip coordinates. */
static void frustum_planes(Plane planes[5], const MesoMatrix *clip)
{
    static const float signs[5][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {0, 0}};
    for (uint32_t i = 0; i < 5; i++) {
        float p[4];
        for (uint32_t column = 0; column < 4; column++) {
            const float *m = &clip->m[4 * column];
            p[column] = m[3] + signs[i][0] * m[0] + signs[i][1] * m[1];
        }
        MesoVec3 normal = {p[0], p[1], p[2]};
        float length = meso_vec3_length(normal);
        float scale = length > 0 ? 1 / length : 0;
        planes[i] = (Plane){meso_vec3_scale(normal, scale), length > 0 ? p[3] * scale : 1};
    }
}

static bool may_show(const Plane planes[5], const MesoSweepHull *hull)
{
    for (uint32_t i = 0; i < 5; i++) {
        float furthest = -INFINITY;
        for (uint32_t k = 0; k < hull->count; k++)
            furthest = fmaxf(furthest, meso_vec3_dot(planes[i].normal, hull->points[k]));
        if (furthest + planes[i].distance < -hull->reach)
            return false;
    }
    return true;
}

/* With its number among the shapes in the place of its ids. */
static MesoSweepInstance instance_of(const MesoShapes *shapes, uint32_t sweep)
{
    MesoSweepInstance instance = shapes->near.sweeps[sweep];
    for (uint32_t k = 0; k < 4 && shapes->near.deform != MESO_SWEEP_SHAPE; k++)
        instance.p[k] = meso_vec3_sub(instance.p[k], shapes->anchor);
    instance.ids = sweep;
    return instance;
}

void meso_draw_lists_select(MesoDrawLists *lists, const MesoMatrix *clip_from_world)
{
    const MesoShapes *shapes = lists->shapes;
    uint32_t count = 0;
    Plane planes[5];
    if (lists->sweep_count == 0)
        return;
    frustum_planes(planes, clip_from_world);
    for (uint32_t d = 0; d < lists->sweep_count; d++) {
        MesoDrawSweep *draw = &lists->sweeps[d];
        const MesoSweptKind *kind = &shapes->scene->kinds[draw->kind];
        draw->instance_begin = count;
        for (uint32_t i = 0; i < kind->instance_count; i++) {
            MesoSweepInstance instance = instance_of(shapes, kind->instance_begin + i);
            MesoSweepHull hull = meso_sweep_hull(&shapes->near, &instance, draw->reach);
            if (may_show(planes, &hull))
                lists->selected[count++] = instance;
        }
        draw->instance_count = count - draw->instance_begin;
    }
    lists->gl->NamedBufferData(lists->instances, (GLsizeiptr)(count * sizeof *lists->selected), lists->selected,
                               GL_STATIC_DRAW);
}

/* ---- drawing ---- */

static const void *index_offset(uint32_t index)
{
    return (const void *)(sizeof(uint32_t) * (uintptr_t)index);
}

static void draw_sweep(const MesoDrawLists *lists, const MesoDrawSweep *draw, const MesoDrawPrograms *programs)
{
    const MesoGl *gl = lists->gl;
    const MesoSweptKind *kind = &lists->shapes->scene->kinds[draw->kind];
    if (draw->index_count == 0 || draw->instance_count == 0)
        return;
    GLuint program = kind->cap ? programs->cap : programs->sweep;
    if (!kind->cap) {
        gl->ProgramUniform1f(program, TURN, kind->turn);
        gl->ProgramUniform4f(program, MIDDLE, kind->middle[0].x, kind->middle[0].y, kind->middle[1].x,
                             kind->middle[1].y);
    }
    if (!kind->cap && programs->creased)
        gl->ProgramUniform4f(program, REACH, draw->profiles.start, draw->profiles.end, 0, 0);
    gl->UseProgram(program);
    gl->DrawElementsInstancedBaseVertexBaseInstance(
        GL_TRIANGLES, (GLsizei)draw->index_count, GL_UNSIGNED_INT, index_offset(draw->index_begin),
        (GLsizei)draw->instance_count, (GLint)draw->base_vertex, draw->instance_begin);
}

void meso_draw_lists_draw(const MesoDrawLists *lists, const MesoDrawPrograms *programs,
                          const MesoMatrix *clip_from_world, const MesoView *view)
{
    const MesoGl *gl = lists->gl;
    const MesoScene *scene = lists->shapes->scene;
    const GLuint all[] = {programs->sweep, programs->cap, programs->body};
    for (uint32_t i = 0; i < 3; i++)
        meso_gl_set_view(gl, all[i], clip_from_world, view);
    for (uint32_t i = 0; i < 2; i++) {
        gl->ProgramUniform1f(all[i], SECTION_SCALE, scene->section_scale);
        if (all[i] == programs->cap)
            gl->ProgramUniform1f(all[i], CAP_RISE, MESO_CAP_RISE);
        else
            gl->ProgramUniform1i(all[i], LEAST_TURN, scene->frame_rule == MESO_FRAME_MINIMAL);
    }

    gl->BindVertexArray(lists->sweep_array);
    if (lists->cages)
        gl->BindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, lists->cages);
    for (uint32_t i = 0; i < lists->sweep_count; i++)
        draw_sweep(lists, &lists->sweeps[i], programs);
    if (!lists->body_array)
        return;
    gl->BindVertexArray(lists->body_array);
    gl->UseProgram(programs->body);
    gl->DrawElementsBaseVertex(GL_TRIANGLES, (GLsizei)lists->body_index_count, GL_UNSIGNED_INT, index_offset(0), 0);
}
