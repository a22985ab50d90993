#include "libcore/render/gl/draw_batch.h"

#include <stddef.h>

extern const char meso_shader_placed_vertex[], meso_shader_seen_fragment[];

void meso_gl_set_view(const MesoGl *gl, GLuint program, const MesoMatrix *clip_from_world, const MesoView *view)
{
    gl->ProgramUniformMatrix4fv(program, MESO_GL_CLIP_FROM_WORLD, 1, GL_FALSE, clip_from_world->m);
    gl->ProgramUniform4f(program, MESO_GL_DEPTH_AXIS, view->forward.x, view->forward.y, view->forward.z,
                         -meso_vec3_dot(view->forward, meso_vec3_sub(view->eye, view->anchor)));
}

MesoStatus meso_gl_placed_program(GLuint *program, const MesoGl *gl, bool detailed, MesoError *error)
{
    return meso_gl_program(program, gl, detailed ? "#define DETAILED\n" : "", meso_shader_placed_vertex,
                           meso_shader_seen_fragment, error);
}

GLuint meso_gl_placed_array(const MesoGl *gl, GLuint vertices, GLuint indices)
{
    GLuint array = 0;
    gl->CreateVertexArrays(1, &array);
    gl->VertexArrayVertexBuffer(array, 0, vertices, 0, sizeof(MesoSiftVertex));
    gl->VertexArrayElementBuffer(array, indices);
    gl->VertexArrayAttribFormat(array, 0, 3, GL_FLOAT, GL_FALSE, offsetof(MesoSiftVertex, position));
    gl->VertexArrayAttribFormat(array, 1, 3, GL_FLOAT, GL_FALSE, offsetof(MesoSiftVertex, normal));
    gl->VertexArrayAttribIFormat(array, 2, 1, GL_UNSIGNED_INT, offsetof(MesoSiftVertex, shape));
    gl->VertexArrayAttribFormat(array, 3, 3, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(MesoSiftVertex, color));
    gl->VertexArrayAttribFormat(array, 4, 2, GL_FLOAT, GL_FALSE, offsetof(MesoSiftVertex, uv));
    for (GLuint i = 0; i < 5; i++) {
        gl->EnableVertexArrayAttrib(array, i);
        gl->VertexArrayAttribBinding(array, i, 0);
    }
    return array;
}

MesoStatus meso_draw_batch_init(MesoDrawBatch *draw, const MesoGl *gl, bool detailed, MesoError *error)
{
    *draw = (MesoDrawBatch){0};
    MesoStatus status = meso_gl_placed_program(&draw->program, gl, detailed, error);
    if (status)
        return status;
    gl->CreateBuffers(1, &draw->vertices);
    gl->CreateBuffers(1, &draw->indices);
    draw->array = meso_gl_placed_array(gl, draw->vertices, draw->indices);
    return MESO_OK;
}

void meso_draw_batch_release(MesoDrawBatch *draw, const MesoGl *gl)
{
    gl->DeleteVertexArrays(1, &draw->array);
    gl->DeleteBuffers(1, &draw->vertices);
    gl->DeleteBuffers(1, &draw->indices);
    gl->DeleteProgram(draw->program);
    *draw = (MesoDrawBatch){0};
}

void meso_draw_batch_take(const MesoDrawBatch *draw, const MesoGl *gl, const MesoSiftBatch *batch)
{
    gl->NamedBufferData(draw->vertices, (GLsizeiptr)(batch->vertex_count * sizeof *batch->vertices), batch->vertices,
                        GL_STREAM_DRAW);
    gl->BindVertexArray(draw->array);
    gl->UseProgram(draw->program);
}

void meso_draw_batch_sample(const MesoDrawBatch *draw, const MesoGl *gl, const MesoSiftBatch *batch, uint32_t sample,
                            const MesoMatrix *clip_from_world, const MesoView *view)
{
    uint32_t count = batch->index_counts[sample];
    if (count == 0)
        return;
    gl->NamedBufferData(draw->indices, (GLsizeiptr)(count * sizeof *batch->indices[sample]), batch->indices[sample],
                        GL_STREAM_DRAW);
    meso_gl_set_view(gl, draw->program, clip_from_world, view);
    gl->DrawElementsBaseVertex(GL_TRIANGLES, (GLsizei)count, GL_UNSIGNED_INT, NULL, 0);
}
