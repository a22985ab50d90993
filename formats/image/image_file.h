/* Pictures out: OpenEXR through its Core C API, PNG through libpng. */
#ifndef MESO_IMAGE_FILE_H
#define MESO_IMAGE_FILE_H

#include "formats/file/output.h"
#include "formats/product/provenance.h"
#include "libcore/render/picture/tone.h"
#include "libcore/render/image.h"

/*
 * One part, scan lines, ZIP: R G B A (half, linear, premultiplied), Z (float,
 * distance along the view axis, +inf where empty), N.X N.Y N.Z (half, world
 * space), albedo.R albedo.G albedo.B (half), and one layer for each channel of
 * ids after its name: slot, tile (uint, id + 1, 0 where empty). String
 * attributes "meso:provenance" (JSON) and, for each channel with names,
 * "meso:tiles" (the names, one a line); "worldToCamera" is the camera's, with x to
 * the right, y up, and z into the picture, as in Z; "worldToNDC" has (0,0) at the
 * upper left corner of the picture and (1,1) at the lower right one;
 * "screenWindowWidth" is that of its field of view. Extras: P.X P.Y P.Z, uv.U uv.V (float), AO, roughness, metallic
 * (half), forward.u forward.v (float), and mattes as Cryptomatte has them, crypto_NAME00 to 02 (float). Colours are by
 * Rec. 709. Uses `thread_count` threads (0: all cores); the bytes do not depend on it.
 * MESO_ERR_OUTPUT where `output` takes no more.
 */
MesoStatus meso_exr_write(const MesoImage *image, const MesoProvenance *provenance, uint32_t thread_count,
                          MesoOutput *output, MesoError *error);

/* What an EXR may be beside that; NULL or zeroed: nothing of it. */
typedef struct MesoExrOptions {
    bool multipart;             /* a part for each layer: rgba, depth, N, albedo, id, P, uv, material, AO, forward and
                                   crypto_NAME; channels keep their names */
    MesoWindow window;          /* of the picture that has data, its top moved up to a multiple of 16 rows; the display
                                   window is the whole. Empty: all of it */
    bool numbered;              /* "imageCounter" is `frame`, "framesPerSecond" `rate`, a fraction */
    int32_t frame;
    uint32_t rate[2];
} MesoExrOptions;

/*
 * The same in bands of rows from the top, a multiple of 16 in each but the last: `band` has the arrays that each is put
 * into, and all that is the same for all of them, what mattes have seen among it; `height` is the whole picture's. The
 * end frees the writer, which may be NULL, and gives back `status`, or its own failure.
 */
typedef struct MesoExrWriter MesoExrWriter;
MesoStatus meso_exr_begin(MesoExrWriter **writer, const MesoImage *band, uint32_t height, const MesoExrOptions *options,
                          const MesoProvenance *provenance, uint32_t thread_count, MesoOutput *output,
                          MesoError *error);
MesoStatus meso_exr_band(MesoExrWriter *writer, uint32_t rows, MesoError *error);
MesoStatus meso_exr_end(MesoExrWriter *writer, MesoStatus status, MesoError *error);

/* Puts a row of what is behind a picture, 3 numbers a pixel, linear, 0 to 1. */
typedef void MesoBackdropRow(void *context, uint32_t y, float *row);

typedef struct MesoPngLook {
    MesoTone tone;              /* of the picture, not of what is behind it */
    bool transparent;           /* with alpha, and nothing behind */
    float background[3];        /* linear */
    MesoBackdropRow *backdrop;  /* in place of that; NULL: none */
    void *context;
} MesoPngLook;

/* 8 bits, sRGB. Provenance as text. */
MesoStatus meso_png_write(const MesoImage *image, const MesoPngLook *look, const MesoProvenance *provenance,
                          MesoOutput *output, MesoError *error);

/* The same in bands, of any number of rows, as meso_exr_begin(); the look must outlive it. */
typedef struct MesoPngWriter MesoPngWriter;
MesoStatus meso_png_begin(MesoPngWriter **writer, const MesoImage *band, uint32_t height, const MesoPngLook *look,
                          const MesoProvenance *provenance, MesoOutput *output, MesoError *error);
MesoStatus meso_png_band(MesoPngWriter *writer, uint32_t rows, MesoError *error);
MesoStatus meso_png_end(MesoPngWriter *writer, MesoStatus status, MesoError *error);

/* Numbers, or NaN where there are none. */
typedef struct MesoImageValues {
    uint32_t width, height;
    const float *values;        /* [width * height] rows from the top */
    float low, high;            /* of PNGs: black and white, not equal */
} MesoImageValues;

/*
 * `low` is black, `high` is white, with nothing in between but a line; transparent where there are none. Of 16 bits,
 * grey and alpha, with provenance: image_read.h finds the shares between `low` and `high` again.
 */
MesoStatus meso_png_write_values(const MesoImageValues *values, const MesoProvenance *provenance, MesoOutput *output,
                                 MesoError *error);

/* The numbers as they are: Y (float, 0 where there are none), and A (half, 0 there, and 1 elsewhere). As
 * meso_exr_write(). */
MesoStatus meso_exr_write_values(const MesoImageValues *values, const MesoProvenance *provenance,
                                 uint32_t thread_count, MesoOutput *output, MesoError *error);

#endif
