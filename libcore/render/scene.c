#include "libcore/render/scene.h"

#include <stddef.h>

#include "libcore/render/detail.h"
#include "libcore/shell/tessellate.h"

extern const char meso_shader_sweep_vertex[], meso_shader_inner_vertex[];
extern const char meso_shader_surface_fragment[], meso_shader_depth_fragment[];

/* GL counts indices and base vertices in signed ints. */
static const uint64_t MAX_ELEMENTS = INT32_MAX;

/* Uniforms by the locations that the shaders give them. */
enum {
    CLIP_FROM_WORLD, DEPTH_AXIS, SECTION_SCALE, CAP_RISE, START_COLOR, END_COLOR,
    START_METALLIC, END_METALLIC, TILE
};

typedef struct PatternVertex {
    MesoVec2 start, end, start_normal, end_normal;
    float along;
} PatternVertex;

typedef struct InnerVertex {
    MesoVec3 position, normal;
    uint32_t slot;
} InnerVertex;

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

/* How far the surface of a kind lies from the control points of its instances. */
static float kind_reach(const MesoStructure *structure, const MesoSweepKind *kind)
{
    float reach = MESO_CAP_RISE;
    for (uint32_t c = 0; c < kind->column_count; c++) {
        const MesoSweepColumn *column = &structure->columns[kind->column_begin + c];
        reach = fmaxf(reach, fmaxf(meso_vec2_length(column->start), meso_vec2_length(column->end)));
    }
    return reach * structure->options.section_scale;
}

/* Scene units that one pixel shows at the kind's point nearest to the eye; 0 where the eye is inside. */
static float finest_pixel(const MesoStructure *structure, const MesoSweepKind *kind,
                          const MesoView *view, uint32_t height)
{
    float nearest = INFINITY;
    for (uint32_t i = 0; i < kind->instance_count; i++)
        for (uint32_t k = 0; k < 4; k++) {
            const MesoVec3 *p = &structure->instances[kind->instance_begin + i].p[k];
            nearest = fminf(nearest, meso_vec3_dot(meso_vec3_sub(*p, view->eye), view->forward));
        }
    nearest -= kind_reach(structure, kind);
    return nearest > 0 && isfinite(nearest) ? nearest * 2 * view->tan_half_fov / (float)height : 0;
}

static void count_pattern(Plan *plan, const MesoStructure *structure, uint32_t k)
{
    const MesoSweepKind *kind = &structure->kinds[k];
    const uint32_t *kept = plan->kept[k];
    uint64_t joints = 0;
    for (uint32_t i = 0; i + 1 < plan->kept_count[k]; i++)
        joints += structure->columns[kind->column_begin + kept[i]].joins_next != 0;
    plan->vertex_count += (uint64_t)plan->kept_count[k] * plan->ring_count[k];
    plan->index_count += 6 * joints * (plan->ring_count[k] - 1);
}

static MesoStatus make_plan(Plan *plan, MesoArena *arena, const MesoStructure *structure,
                            const MesoView *view, uint32_t height, float tolerance_pixels,
                            MesoError *error)
{
    plan->kept = MESO_NEW(arena, uint32_t *, structure->kind_count, error);
    plan->kept_count = MESO_NEW(arena, uint32_t, structure->kind_count, error);
    plan->ring_count = MESO_NEW(arena, uint32_t, structure->kind_count, error);
    if (!plan->kept || !plan->kept_count || !plan->ring_count)
        return MESO_ERR_MEMORY;

    float scale = structure->options.section_scale;
    for (uint32_t k = 0; k < structure->kind_count; k++) {
        const MesoSweepKind *kind = &structure->kinds[k];
        float tolerance = tolerance_pixels > 0
            ? tolerance_pixels * finest_pixel(structure, kind, view, height) : 0;
        plan->kept[k] = MESO_NEW(arena, uint32_t, kind->column_count, error);
        if (!plan->kept[k])
            return MESO_ERR_MEMORY;
        plan->kept_count[k] = meso_detail_columns(&structure->columns[kind->column_begin],
                                                  kind->column_count, scale > 0 ? tolerance / scale : 0,
                                                  plan->kept[k]);
        plan->ring_count[k] = meso_detail_rings(structure, kind, tolerance);
        count_pattern(plan, structure, k);
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
            *out++ = (PatternVertex){column->start, column->end, column->start_normal,
                                     column->end_normal, (float)r / (float)(ring_count - 1)};
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

static void describe_sweeps(MesoScene *scene)
{
    const MesoGl *gl = scene->gl;
    static const struct { GLuint size, offset; } shared[] = {
        {4, offsetof(PatternVertex, start)}, {4, offsetof(PatternVertex, start_normal)},
        {1, offsetof(PatternVertex, along)}};

    gl->CreateVertexArrays(1, &scene->sweep_array);
    GLuint array = scene->sweep_array;
    gl->VertexArrayVertexBuffer(array, 0, scene->pattern_vertices, 0, sizeof(PatternVertex));
    gl->VertexArrayVertexBuffer(array, 1, scene->instances, 0, sizeof(MesoSweepInstance));
    gl->VertexArrayBindingDivisor(array, 1, 1);
    gl->VertexArrayElementBuffer(array, scene->pattern_indices);
    for (GLuint i = 0; i < 12; i++) {
        gl->EnableVertexArrayAttrib(array, i);
        gl->VertexArrayAttribBinding(array, i, i < 3 ? 0 : 1);
        if (i < 3)
            gl->VertexArrayAttribFormat(array, i, (GLint)shared[i].size, GL_FLOAT, GL_FALSE,
                                        shared[i].offset);
        else if (i < 11)    /* p[4], up[2], direction[2] follow each other */
            gl->VertexArrayAttribFormat(array, i, 3, GL_FLOAT, GL_FALSE,
                                        (i - 3) * (GLuint)sizeof(MesoVec3));
        else
            gl->VertexArrayAttribIFormat(array, i, 1, GL_UNSIGNED_INT,
                                         offsetof(MesoSweepInstance, slot));
    }
}

static MesoStatus upload_sweeps(MesoScene *scene, MesoArena *arena, const Plan *plan, MesoError *error)
{
    const MesoStructure *structure = scene->structure;
    PatternVertex *vertices = MESO_NEW(arena, PatternVertex, plan->vertex_count, error);
    uint32_t *indices = MESO_NEW(arena, uint32_t, plan->index_count, error);
    if (!vertices || !indices)
        return MESO_ERR_MEMORY;

    uint32_t vertex = 0, index = 0;
    for (uint32_t k = 0; k < structure->kind_count; k++) {
        const MesoSweepKind *kind = &structure->kinds[k];
        const MesoSweepColumn *columns = &structure->columns[kind->column_begin];
        const uint32_t *kept = plan->kept[k];
        uint32_t kept_count = plan->kept_count[k], ring_count = plan->ring_count[k];
        MesoDrawSweep *draw = &scene->sweeps[k];

        draw->kind = k;
        draw->reach = kind_reach(structure, kind);
        draw->base_vertex = vertex;
        draw->index_begin = index;
        fill_vertices(&vertices[vertex], columns, kept, kept_count, ring_count);
        draw->index_count = fill_indices(&indices[index], columns, kept, kept_count, ring_count);
        vertex += kept_count * ring_count;
        index += draw->index_count;
    }
    scene->sweep_count = structure->kind_count;
    scene->pattern_vertices = upload(scene->gl, vertices, vertex * sizeof *vertices);
    scene->pattern_indices = upload(scene->gl, indices, index * sizeof *indices);
    scene->gl->CreateBuffers(1, &scene->instances);
    describe_sweeps(scene);
    meso_scene_select(scene, NULL);
    return meso_gl_check(scene->gl, "upload of the sweeps", error);
}

static void describe_inners(MesoScene *scene)
{
    const MesoGl *gl = scene->gl;
    gl->CreateVertexArrays(1, &scene->inner_array);
    GLuint array = scene->inner_array;
    gl->VertexArrayVertexBuffer(array, 0, scene->inner_vertices, 0, sizeof(InnerVertex));
    gl->VertexArrayElementBuffer(array, scene->inner_indices);
    gl->VertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(InnerVertex, position));
    gl->VertexArrayAttribFormat(array, 1, 3, GL_FLOAT, GL_FALSE, offsetof(InnerVertex, normal));
    gl->VertexArrayAttribIFormat(array, 2, 1, GL_UNSIGNED_INT, offsetof(InnerVertex, slot));
    for (GLuint i = 0; i < 3; i++) {
        gl->EnableVertexArrayAttrib(array, i);
        gl->VertexArrayAttribBinding(array, i, 0);
    }
}

/* One draw for consecutive parts of one tile and material. */
static void add_inner_draw(MesoScene *scene, const MesoMeshPart *part, uint32_t index_begin,
                           uint32_t index_end)
{
    MesoDrawInner *last = scene->inner_count ? &scene->inners[scene->inner_count - 1] : NULL;
    if (last && last->tile == part->tile && last->material == part->material) {
        last->index_count += index_end - index_begin;
        return;
    }
    scene->inners[scene->inner_count++] =
        (MesoDrawInner){part->tile, part->material, 0, index_begin, index_end - index_begin};
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

static MesoStatus upload_inners(MesoScene *scene, MesoArena *arena, MesoVec3 anchor, MesoError *error)
{
    const MesoStructure *structure = scene->structure;
    MesoTessellation mesh;
    MesoStatus status = meso_tessellation_init(&mesh, arena, structure, error);
    if (status)
        return status;
    uint32_t begin = structure->instance_count, end = mesh.part_count;
    uint64_t vertex_count = mesh.vertex_begin[end] - mesh.vertex_begin[begin];
    uint64_t face_count = mesh.face_begin[end] - mesh.face_begin[begin];
    if (vertex_count > MAX_ELEMENTS || face_count > MAX_ELEMENTS / 6)
        return meso_fail(error, MESO_ERR_LIMIT, "inner meshes have too many vertices to draw (%llu)",
                         (unsigned long long)vertex_count);
    if (face_count == 0)
        return MESO_OK;

    MesoMeshVertex *points = MESO_NEW(arena, MesoMeshVertex, vertex_count, error);
    MesoMeshFace *faces = MESO_NEW(arena, MesoMeshFace, face_count, error);
    InnerVertex *vertices = MESO_NEW(arena, InnerVertex, vertex_count, error);
    uint32_t *indices = MESO_NEW(arena, uint32_t, 6 * face_count, error);
    if (!points || !faces || !vertices || !indices)
        return MESO_ERR_MEMORY;
    meso_tessellation_vertices(&mesh, begin, end, points);
    meso_tessellation_faces(&mesh, begin, end, 0, faces);

    uint32_t index = 0;
    uint64_t vertex = 0, face = 0;
    for (uint32_t p = begin; p < end; p++) {
        MesoMeshPart part = meso_tessellation_part(&mesh, p);
        uint32_t index_begin = index;
        for (; vertex < mesh.vertex_begin[p + 1] - mesh.vertex_begin[begin]; vertex++)
            vertices[vertex] = (InnerVertex){meso_vec3_sub(points[vertex].position, anchor),
                                             points[vertex].normal, part.slot};
        for (; face < mesh.face_begin[p + 1] - mesh.face_begin[begin]; face++)
            index += add_triangles(&indices[index], &faces[face]);
        add_inner_draw(scene, &part, index_begin, index);
    }
    scene->inner_vertices = upload(scene->gl, vertices, vertex_count * sizeof *vertices);
    scene->inner_indices = upload(scene->gl, indices, index * sizeof *indices);
    describe_inners(scene);
    return meso_gl_check(scene->gl, "upload of the inner meshes", error);
}

static bool is_zero(MesoVec3 v)
{
    return v.x == 0 && v.y == 0 && v.z == 0;
}

/* The instances relative to `anchor`; NULL where memory is out. */
static const MesoSweepInstance *place_instances(const MesoStructure *structure, MesoVec3 anchor,
                                                MesoArena *arena, MesoError *error)
{
    if (is_zero(anchor) || structure->instance_count == 0)
        return structure->instances;
    MesoSweepInstance *placed = MESO_NEW(arena, MesoSweepInstance, structure->instance_count, error);
    for (uint32_t i = 0; placed && i < structure->instance_count; i++) {
        placed[i] = structure->instances[i];
        for (uint32_t k = 0; k < 4; k++)
            placed[i].p[k] = meso_vec3_sub(placed[i].p[k], anchor);
    }
    return placed;
}

MesoStatus meso_scene_init(MesoScene *scene, MesoArena *arena, const MesoGl *gl,
                           const MesoStructure *structure, const MesoView *view, uint32_t height,
                           float tolerance_pixels, MesoError *error)
{
    *scene = (MesoScene){.gl = gl, .structure = structure};
    meso_structure_bounds(structure, &scene->low, &scene->high);
    scene->low = meso_vec3_sub(scene->low, view->anchor);
    scene->high = meso_vec3_sub(scene->high, view->anchor);
    scene->placed = place_instances(structure, view->anchor, arena, error);
    scene->sweeps = MESO_NEW(arena, MesoDrawSweep, structure->kind_count, error);
    scene->inners = MESO_NEW(arena, MesoDrawInner, structure->inner_count, error);
    scene->selected = MESO_NEW(arena, MesoSweepInstance, structure->instance_count, error);
    if ((structure->instance_count && !scene->placed) || !scene->sweeps || !scene->inners || !scene->selected)
        return MESO_ERR_MEMORY;

    MesoArenaMark mark = meso_arena_mark(arena);
    Plan plan = {0};
    MesoStatus status = make_plan(&plan, arena, structure, view, height, tolerance_pixels, error);
    if (!status && plan.index_count && structure->instance_count)
        status = upload_sweeps(scene, arena, &plan, error);
    if (!status && structure->inner_count)
        status = upload_inners(scene, arena, view->anchor, error);
    meso_arena_rewind(arena, mark);
    if (status)
        meso_scene_release(scene);
    return status;
}

void meso_scene_release(MesoScene *scene)
{
    if (!scene->gl)
        return;
    const GLuint buffers[] = {scene->pattern_vertices, scene->pattern_indices, scene->instances,
                              scene->inner_vertices, scene->inner_indices};
    const GLuint arrays[] = {scene->sweep_array, scene->inner_array};
    scene->gl->DeleteVertexArrays(sizeof arrays / sizeof *arrays, arrays);
    scene->gl->DeleteBuffers(sizeof buffers / sizeof *buffers, buffers);
    *scene = (MesoScene){0};
}

MesoStatus meso_scene_programs_init(MesoScenePrograms *programs, const MesoGl *gl,
                                    MesoScenePurpose purpose, MesoError *error)
{
    static const char *const defines[][2] = {
        [MESO_DRAW_SURFACE] = {"", "#define CAP\n"},
        [MESO_DRAW_PACKED] = {"#define PACKED\n", "#define CAP\n#define PACKED\n"},
        [MESO_DRAW_DEPTH] = {"", "#define CAP\n"},
    };
    const char *const *text = defines[purpose];
    const char *sweep = meso_shader_sweep_vertex, *inner = meso_shader_inner_vertex;
    const char *fragment = purpose == MESO_DRAW_DEPTH ? meso_shader_depth_fragment
                                                      : meso_shader_surface_fragment;
    *programs = (MesoScenePrograms){0};
    MesoStatus status = meso_gl_program(&programs->sweep, gl, text[0], sweep, fragment, error);
    if (!status)
        status = meso_gl_program(&programs->cap, gl, text[1], sweep, fragment, error);
    if (!status)
        status = meso_gl_program(&programs->inner, gl, text[0], inner, fragment, error);
    if (status)
        meso_scene_programs_release(programs, gl);
    return status;
}

void meso_scene_programs_release(MesoScenePrograms *programs, const MesoGl *gl)
{
    gl->DeleteProgram(programs->sweep);
    gl->DeleteProgram(programs->cap);
    gl->DeleteProgram(programs->inner);
    *programs = (MesoScenePrograms){0};
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

/* The curve lies within the hull of its control points. */
static bool may_show(const Plane planes[5], const MesoSweepInstance *instance, float reach)
{
    for (uint32_t i = 0; i < 5; i++) {
        float furthest = -INFINITY;
        for (uint32_t k = 0; k < 4; k++)
            furthest = fmaxf(furthest, meso_vec3_dot(planes[i].normal, instance->p[k]));
        if (furthest + planes[i].distance < -reach)
            return false;
    }
    return true;
}

void meso_scene_select(MesoScene *scene, const MesoMatrix *clip_from_world)
{
    const MesoStructure *structure = scene->structure;
    const MesoSweepInstance *shown = scene->placed;
    uint32_t count = structure->instance_count;
    if (scene->sweep_count == 0)
        return;
    if (clip_from_world) {
        Plane planes[5];
        frustum_planes(planes, clip_from_world);
        shown = scene->selected;
        count = 0;
        for (uint32_t d = 0; d < scene->sweep_count; d++) {
            MesoDrawSweep *draw = &scene->sweeps[d];
            const MesoSweepKind *kind = &structure->kinds[draw->kind];
            draw->instance_begin = count;
            for (uint32_t i = 0; i < kind->instance_count; i++) {
                const MesoSweepInstance *instance = &scene->placed[kind->instance_begin + i];
                if (may_show(planes, instance, draw->reach))
                    scene->selected[count++] = *instance;
            }
            draw->instance_count = count - draw->instance_begin;
        }
    } else {
        for (uint32_t d = 0; d < scene->sweep_count; d++) {
            const MesoSweepKind *kind = &structure->kinds[scene->sweeps[d].kind];
            scene->sweeps[d].instance_begin = kind->instance_begin;
            scene->sweeps[d].instance_count = kind->instance_count;
        }
    }
    scene->gl->NamedBufferData(scene->instances, (GLsizeiptr)(count * sizeof *shown), shown, GL_STATIC_DRAW);
}

/* ---- drawing ---- */

static void set_materials(const MesoScene *scene, GLuint program, uint32_t start, uint32_t end,
                          uint32_t tile)
{
    const MesoGl *gl = scene->gl;
    const MesoMaterial *a = meso_structure_material(scene->structure, start);
    const MesoMaterial *b = meso_structure_material(scene->structure, end);
    gl->ProgramUniform4f(program, START_COLOR, a->albedo[0], a->albedo[1], a->albedo[2], a->roughness);
    gl->ProgramUniform4f(program, END_COLOR, b->albedo[0], b->albedo[1], b->albedo[2], b->roughness);
    gl->ProgramUniform1f(program, START_METALLIC, a->metallic);
    gl->ProgramUniform1f(program, END_METALLIC, b->metallic);
    gl->ProgramUniform1ui(program, TILE, tile);
}

static void set_view(const MesoScene *scene, GLuint program, const MesoMatrix *clip_from_world,
                     const MesoView *view)
{
    const MesoGl *gl = scene->gl;
    gl->ProgramUniformMatrix4fv(program, CLIP_FROM_WORLD, 1, GL_FALSE, clip_from_world->m);
    if (view)
        gl->ProgramUniform4f(program, DEPTH_AXIS, view->forward.x, view->forward.y, view->forward.z,
                             -meso_vec3_dot(view->forward, meso_vec3_sub(view->eye, view->anchor)));
}

static const void *index_offset(uint32_t index)
{
    return (const void *)(sizeof(uint32_t) * (uintptr_t)index);
}

static void draw_sweep(const MesoScene *scene, const MesoDrawSweep *draw, GLuint program, bool shaded)
{
    const MesoGl *gl = scene->gl;
    const MesoSweepKind *kind = &scene->structure->kinds[draw->kind];
    if (draw->index_count == 0 || draw->instance_count == 0)
        return;
    if (shaded)
        set_materials(scene, program, kind->start_section,
                      kind->cap ? kind->start_section : kind->end_section, kind->tile);
    gl->UseProgram(program);
    gl->DrawElementsInstancedBaseVertexBaseInstance(
        GL_TRIANGLES, (GLsizei)draw->index_count, GL_UNSIGNED_INT, index_offset(draw->index_begin),
        (GLsizei)draw->instance_count, (GLint)draw->base_vertex, draw->instance_begin);
}

static void draw_inner(const MesoScene *scene, const MesoDrawInner *draw, GLuint program, bool shaded)
{
    const MesoGl *gl = scene->gl;
    if (shaded)
        set_materials(scene, program, draw->material, draw->material, draw->tile);
    gl->UseProgram(program);
    gl->DrawElementsBaseVertex(GL_TRIANGLES, (GLsizei)draw->index_count, GL_UNSIGNED_INT,
                               index_offset(draw->index_begin), (GLint)draw->base_vertex);
}

void meso_scene_draw(const MesoScene *scene, const MesoScenePrograms *programs,
                     const MesoMatrix *clip_from_world, const MesoView *view)
{
    const MesoGl *gl = scene->gl;
    const GLuint all[] = {programs->sweep, programs->cap, programs->inner};
    for (uint32_t i = 0; i < 3; i++)
        set_view(scene, all[i], clip_from_world, view);
    for (uint32_t i = 0; i < 2; i++) {
        gl->ProgramUniform1f(all[i], SECTION_SCALE, scene->structure->options.section_scale);
        if (all[i] == programs->cap)
            gl->ProgramUniform1f(all[i], CAP_RISE, MESO_CAP_RISE);
    }

    gl->BindVertexArray(scene->sweep_array);
    for (uint32_t i = 0; i < scene->sweep_count; i++) {
        bool cap = scene->structure->kinds[scene->sweeps[i].kind].cap;
        draw_sweep(scene, &scene->sweeps[i], cap ? programs->cap : programs->sweep, view);
    }
    gl->BindVertexArray(scene->inner_array);
    for (uint32_t i = 0; i < scene->inner_count; i++)
        draw_inner(scene, &scene->inners[i], programs->inner, view);
}
