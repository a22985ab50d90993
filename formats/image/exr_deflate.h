/* ZIP chunks of OpenEXR by libdeflate, which takes half the time of zlib for files of the same size. */
#ifndef MESO_EXR_DEFLATE_H
#define MESO_EXR_DEFLATE_H

#include <OpenEXR/openexr.h>

/* A compressor of the Core library's pipelines: EXR_ERR_OUT_OF_MEMORY alone. What does not shrink stays as it is. */
exr_result_t meso_exr_deflate(exr_encode_pipeline_t *pipeline);

#endif
