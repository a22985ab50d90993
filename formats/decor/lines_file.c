#include "formats/decor/lines_file.h"

#include <string.h>

#include "formats/product/svg_frame.h"
#include "libcore/math/box.h"

static MesoStatus put_provenance(const MesoProvenance *provenance, const char *mark, const char *end,
                                 MesoOutput *output, MesoError *error)
{
    MesoArena arena;
    meso_arena_init(&arena);
    const char *text = meso_provenance_lines(provenance, mark, &arena, error);
    MesoStatus status = text ? meso_output_write(output, text, strlen(text), error) : MESO_ERR_MEMORY;
    if (!status)
        status = meso_output_write(output, end, strlen(end), error);
    meso_arena_release(&arena);
    return status;
}

MesoStatus meso_lines_obj_write(const MesoDecor *decor, const MesoProvenance *provenance, MesoOutput *output,
                                MesoError *error)
{
    MesoStatus status = put_provenance(provenance, "# ", "", output, error);
    for (uint32_t i = 0; i < 2 * decor->line_count && !status; i++)
        status = meso_output_print(output, error, "v %.9g %.9g %.9g\n", (double)decor->lines[i].x,
                                   (double)decor->lines[i].y, (double)decor->lines[i].z);
    for (uint32_t i = 0; i < decor->line_count && !status; i++) {
        if (i == 0 || decor->line_steps[i] != decor->line_steps[i - 1])
            status = meso_output_print(output, error, "g operation.%u\n", decor->line_steps[i]);
        if (!status)
            status = meso_output_print(output, error, "l %u %u\n", 2 * i + 1, 2 * i + 2);
    }
    return status;
}

/* ---- SVG ---- */

typedef struct View {
    MesoBox box;
    double scale, middle;
} View;

static View view_of(const MesoDecor *decor)
{
    View view = {.box = meso_box_empty(), .scale = 1};
    for (uint32_t i = 0; i < 2 * decor->line_count; i++)
        meso_box_add(&view.box, decor->lines[i]);
    double width = (double)view.box.high.x - view.box.low.x, height = (double)view.box.high.y - view.box.low.y;
    double size = width > height ? width : height;
    view.scale = size > 0 ? 1000 / size : 1;
    view.middle = ((double)view.box.low.z + view.box.high.z) / 2;
    return view;
}

/* Segments of one operation, those in front or those behind, as one path; joined where one goes on from another. */
static MesoStatus put_path(const MesoDecor *decor, const View *view, uint32_t begin, uint32_t end, bool front,
                           MesoOutput *output, MesoError *error)
{
    MesoStatus status = meso_output_print(output, error, "<path class=\"%s\" d=\"", front ? "front" : "back");
    for (uint32_t i = begin; i < end && !status; i++) {
        const MesoVec3 *p = &decor->lines[2 * (size_t)i];
        if (((double)p[0].z + p[1].z >= 2 * view->middle) != front)
            continue;
        double at[4];
        for (int k = 0; k < 2; k++) {
            at[2 * k] = ((double)p[k].x - view->box.low.x) * view->scale;
            at[2 * k + 1] = ((double)view->box.high.y - p[k].y) * view->scale;
        }
        status = meso_output_print(output, error, "M%.2f %.2fL%.2f %.2f", at[0], at[1], at[2], at[3]);
    }
    return status ? status : meso_output_print(output, error, "\"/>\n");
}

static MesoStatus put_operations(const MesoDecor *decor, const View *view, MesoOutput *output, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t begin = 0, end; begin < decor->line_count && !status; begin = end) {
        for (end = begin + 1; end < decor->line_count && decor->line_steps[end] == decor->line_steps[begin]; end++)
            ;
        status = meso_output_print(output, error, "<g id=\"operation.%u\">\n", decor->line_steps[begin]);
        if (!status)
            status = put_path(decor, view, begin, end, false, output, error);
        if (!status)
            status = put_path(decor, view, begin, end, true, output, error);
        if (!status)
            status = meso_output_print(output, error, "</g>\n");
    }
    return status;
}

MesoStatus meso_lines_svg_write(const MesoDecor *decor, const MesoProvenance *provenance, MesoOutput *output,
                                MesoError *error)
{
    View view = view_of(decor);
    double width = decor->line_count ? ((double)view.box.high.x - view.box.low.x) * view.scale : 0;
    double height = decor->line_count ? ((double)view.box.high.y - view.box.low.y) * view.scale : 0;
    MesoStatus status = meso_svg_begin(width, height, provenance,
                                       "path{fill:none;stroke:#124;stroke-width:1}.back{stroke:#bcd}", output, error);
    if (!status)
        status = put_operations(decor, &view, output, error);
    return status ? status : meso_svg_end(output, error);
}
