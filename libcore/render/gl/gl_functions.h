/*
 * The GL functions that the renderer calls, as typed pointers from whatever
 * driver the context has. One list serves both makers.
 */
#ifndef MESO_GL_FUNCTIONS_H
#define MESO_GL_FUNCTIONS_H

#include <GL/glcorearb.h>

#include "libcore/render/gl/gl_context.h"

#define MESO_GL_FUNCTIONS(X)                                                        \
    X(ATTACHSHADER, AttachShader)                                                   \
    X(BINDBUFFERBASE, BindBufferBase)                                               \
    X(BINDFRAMEBUFFER, BindFramebuffer)                                             \
    X(BINDVERTEXARRAY, BindVertexArray)                                             \
    X(CHECKNAMEDFRAMEBUFFERSTATUS, CheckNamedFramebufferStatus)                     \
    X(CLEARNAMEDFRAMEBUFFERFV, ClearNamedFramebufferfv)                             \
    X(CLEARNAMEDFRAMEBUFFERUIV, ClearNamedFramebufferuiv)                           \
    X(CLIPCONTROL, ClipControl)                                                     \
    X(COMPILESHADER, CompileShader)                                                 \
    X(CREATEBUFFERS, CreateBuffers)                                                 \
    X(CREATEFRAMEBUFFERS, CreateFramebuffers)                                       \
    X(CREATEPROGRAM, CreateProgram)                                                 \
    X(CREATESHADER, CreateShader)                                                   \
    X(CREATETEXTURES, CreateTextures)                                               \
    X(CREATEVERTEXARRAYS, CreateVertexArrays)                                       \
    X(DELETEBUFFERS, DeleteBuffers)                                                 \
    X(DELETEFRAMEBUFFERS, DeleteFramebuffers)                                       \
    X(DELETEPROGRAM, DeleteProgram)                                                 \
    X(DELETESHADER, DeleteShader)                                                   \
    X(DELETETEXTURES, DeleteTextures)                                               \
    X(DELETEVERTEXARRAYS, DeleteVertexArrays)                                       \
    X(DEPTHFUNC, DepthFunc)                                                         \
    X(DISABLE, Disable)                                                             \
    X(DRAWELEMENTSBASEVERTEX, DrawElementsBaseVertex)                               \
    X(DRAWELEMENTSINSTANCEDBASEVERTEXBASEINSTANCE, DrawElementsInstancedBaseVertexBaseInstance) \
    X(ENABLE, Enable)                                                               \
    X(ENABLEVERTEXARRAYATTRIB, EnableVertexArrayAttrib)                             \
    X(FLUSH, Flush)                                                                 \
    X(FRONTFACE, FrontFace)                                                         \
    X(GETERROR, GetError)                                                           \
    X(GETINTEGERV, GetIntegerv)                                                     \
    X(GETPROGRAMINFOLOG, GetProgramInfoLog)                                         \
    X(GETPROGRAMIV, GetProgramiv)                                                   \
    X(GETSHADERINFOLOG, GetShaderInfoLog)                                           \
    X(GETSHADERIV, GetShaderiv)                                                     \
    X(LINKPROGRAM, LinkProgram)                                                     \
    X(NAMEDBUFFERDATA, NamedBufferData)                                             \
    X(NAMEDBUFFERSTORAGE, NamedBufferStorage)                                       \
    X(NAMEDFRAMEBUFFERDRAWBUFFERS, NamedFramebufferDrawBuffers)                     \
    X(NAMEDFRAMEBUFFERREADBUFFER, NamedFramebufferReadBuffer)                       \
    X(NAMEDFRAMEBUFFERTEXTURE, NamedFramebufferTexture)                             \
    X(PIXELSTOREI, PixelStorei)                                                     \
    X(PROGRAMUNIFORM1F, ProgramUniform1f)                                           \
    X(PROGRAMUNIFORM1I, ProgramUniform1i)                                           \
    X(PROGRAMUNIFORM4F, ProgramUniform4f)                                           \
    X(PROGRAMUNIFORMMATRIX4FV, ProgramUniformMatrix4fv)                             \
    X(READPIXELS, ReadPixels)                                                       \
    X(SHADERSOURCE, ShaderSource)                                                   \
    X(TEXTURESTORAGE2D, TextureStorage2D)                                           \
    X(USEPROGRAM, UseProgram)                                                       \
    X(VERTEXARRAYATTRIBBINDING, VertexArrayAttribBinding)                           \
    X(VERTEXARRAYATTRIBFORMAT, VertexArrayAttribFormat)                             \
    X(VERTEXARRAYATTRIBIFORMAT, VertexArrayAttribIFormat)                           \
    X(VERTEXARRAYBINDINGDIVISOR, VertexArrayBindingDivisor)                         \
    X(VERTEXARRAYELEMENTBUFFER, VertexArrayElementBuffer)                           \
    X(VERTEXARRAYVERTEXBUFFER, VertexArrayVertexBuffer)                             \
    X(VIEWPORT, Viewport)

typedef struct MesoGl {
#define MESO_GL_MEMBER(type, name) PFNGL##type##PROC name;
    MESO_GL_FUNCTIONS(MESO_GL_MEMBER)
#undef MESO_GL_MEMBER
} MesoGl;

/* MESO_ERR_INTERNAL names the first function that the driver lacks. */
MesoStatus meso_gl_load(MesoGl *gl, const MesoGlContext *context, MesoError *error);

/* Fails where GL has recorded an error since the last call; `what` was being done. */
MesoStatus meso_gl_check(const MesoGl *gl, const char *what, MesoError *error);

/*
 * Compiles and links `vertex` and `fragment`, each after a #version line and
 * the text `defines`. MESO_ERR_INTERNAL with the driver's words.
 */
MesoStatus meso_gl_program(GLuint *program, const MesoGl *gl, const char *defines,
                           const char *vertex, const char *fragment, MesoError *error);

#endif
