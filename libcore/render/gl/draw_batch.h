/* Vertices that processors have made, and how GL draws them. */
#ifndef MESO_DRAW_BATCH_H
#define MESO_DRAW_BATCH_H

#include "libcore/render/gl/gl_functions.h"
#include "libcore/render/projection.h"
#include "libcore/render/raster/sift.h"

/* Uniforms of all vertex shaders by their locations. */
enum { MESO_GL_CLIP_FROM_WORLD, MESO_GL_DEPTH_AXIS };

void meso_gl_set_view(const MesoGl *gl, GLuint program, const MesoMatrix *clip_from_world, const MesoView *view);

/* The program for such vertices. `detailed`: fragments have uv and colour too. */
MesoStatus meso_gl_placed_program(GLuint *program, const MesoGl *gl, bool detailed, MesoError *error);

/* An array of MesoSiftVertex and indices in these buffers. */
GLuint meso_gl_placed_array(const MesoGl *gl, GLuint vertices, GLuint indices);

/* What draws batches, one after the other. */
typedef struct MesoDrawBatch {
    GLuint program, vertices, indices, array;
} MesoDrawBatch;

MesoStatus meso_draw_batch_init(MesoDrawBatch *draw, const MesoGl *gl, bool detailed, MesoError *error);
void meso_draw_batch_release(MesoDrawBatch *draw, const MesoGl *gl);

/* Uploads a batch's vertices, and draws what one sample of it has to the bound framebuffer. */
void meso_draw_batch_take(const MesoDrawBatch *draw, const MesoGl *gl, const MesoSiftBatch *batch);
void meso_draw_batch_sample(const MesoDrawBatch *draw, const MesoGl *gl, const MesoSiftBatch *batch, uint32_t sample,
                            const MesoMatrix *clip_from_world, const MesoView *view);

#endif
