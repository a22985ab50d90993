#include "formats/product/svg_metadata.h"

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

MesoStatus meso_svg_metadata(const MesoProvenance *provenance, MesoOutput *output, MesoError *error)
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
