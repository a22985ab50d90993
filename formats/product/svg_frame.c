#include "formats/product/svg_frame.h"

/* Text in XML. */
static MesoStatus put_escaped(const char *text, MesoOutput *output, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (; *text && !status; text++) {
        const char *escape = *text == '<' ? "&lt;" : *text == '&' ? "&amp;" : *text == '>' ? "&gt;" : NULL;
        status = meso_output_print(output, error, escape ? "%s" : "%.1s", escape ? escape : text);
    }
    return status;
}

static MesoStatus put_metadata(const MesoProvenance *provenance, MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    const char *text = meso_provenance_text(provenance, &arena, error);
    MesoStatus status = text ? meso_output_print(output, error, "<metadata>") : MESO_ERR_MEMORY;
    if (!status)
        status = put_escaped(text, output, error);
    meso_arena_release(&arena);
    return status ? status : meso_output_print(output, error, "</metadata>\n");
}

MesoStatus meso_svg_begin(double width, double height, const MesoProvenance *provenance, const char *style,
                          MesoOutput *output, MesoError *error)
{
    MesoStatus status = meso_output_print(output, error,
                                          "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-10 -10 %.2f %.2f\">\n",
                                          width + 20, height + 20);
    if (!status)
        status = put_metadata(provenance, output, error);
    return status ? status : meso_output_print(output, error, "<style>%s</style>\n", style);
}

MesoStatus meso_svg_end(MesoOutput *output, MesoError *error)
{
    return meso_output_print(output, error, "</svg>\n");
}
