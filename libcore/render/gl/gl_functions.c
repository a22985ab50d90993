#include "libcore/render/gl/gl_functions.h"

#include <stddef.h>

MesoStatus meso_gl_load(MesoGl *gl, const MesoGlContext *context, MesoError *error)
{
#define MESO_GL_LOAD(type, name)                                                         \
    gl->name = (PFNGL##type##PROC)context->find("gl" #name);                             \
    if (!gl->name)                                                                       \
        return meso_fail(error, MESO_ERR_INTERNAL, "GL driver '%s' lacks gl" #name, context->renderer);
    MESO_GL_FUNCTIONS(MESO_GL_LOAD)
#undef MESO_GL_LOAD
    return MESO_OK;
}

MesoStatus meso_gl_check(const MesoGl *gl, const char *what, MesoError *error)
{
    GLenum code = gl->GetError();
    if (code == GL_NO_ERROR)
        return MESO_OK;
    while (gl->GetError() != GL_NO_ERROR)
        continue;
    if (code == GL_OUT_OF_MEMORY)
        return meso_fail(error, MESO_ERR_MEMORY, "GL driver is out of memory: %s", what);
    return meso_fail(error, MESO_ERR_INTERNAL, "GL error 0x%04x: %s", code, what);
}

static MesoStatus compile(GLuint *shader, const MesoGl *gl, GLenum stage, const char *defines,
                          const char *source, MesoError *error)
{
    const char *texts[] = {"#version 450 core\n", defines, source};
    GLint compiled = 0;
    *shader = gl->CreateShader(stage);
    gl->ShaderSource(*shader, 3, texts, NULL);
    gl->CompileShader(*shader);
    gl->GetShaderiv(*shader, GL_COMPILE_STATUS, &compiled);
    if (compiled)
        return MESO_OK;

    char log[400] = "";
    gl->GetShaderInfoLog(*shader, sizeof log, NULL, log);
    gl->DeleteShader(*shader);
    *shader = 0;
    return meso_fail(error, MESO_ERR_INTERNAL, "GL shader does not compile: %s", log);
}

static MesoStatus link_shaders(GLuint *program, const MesoGl *gl, GLuint vertex, GLuint fragment,
                               MesoError *error)
{
    GLint linked = 0;
    *program = gl->CreateProgram();
    gl->AttachShader(*program, vertex);
    gl->AttachShader(*program, fragment);
    gl->LinkProgram(*program);
    gl->GetProgramiv(*program, GL_LINK_STATUS, &linked);
    if (linked)
        return MESO_OK;

    char log[400] = "";
    gl->GetProgramInfoLog(*program, sizeof log, NULL, log);
    gl->DeleteProgram(*program);
    *program = 0;
    return meso_fail(error, MESO_ERR_INTERNAL, "GL program does not link: %s", log);
}

MesoStatus meso_gl_program(GLuint *program, const MesoGl *gl, const char *defines,
                           const char *vertex, const char *fragment, MesoError *error)
{
    GLuint shaders[2] = {0};
    *program = 0;
    MesoStatus status = compile(&shaders[0], gl, GL_VERTEX_SHADER, defines, vertex, error);
    if (!status)
        status = compile(&shaders[1], gl, GL_FRAGMENT_SHADER, defines, fragment, error);
    if (!status)
        status = link_shaders(program, gl, shaders[0], shaders[1], error);
    gl->DeleteShader(shaders[0]);
    gl->DeleteShader(shaders[1]);
    return status;
}
