#include "formats/growth/growth_svg.h"

#include "formats/product/svg_frame.h"
#include "libcore/math/box.h"

/* A stroke is no thinner than this, in units of the drawing. */
static const double LEAST_STROKE = 0.25;

typedef struct View {
    MesoBox box;
    double scale;
} View;

static View view_of(const MesoGrown *grown)
{
    View view = {.box = meso_box_empty(), .scale = 1};
    for (uint32_t i = 0; i < grown->joint_count; i++)
        meso_box_add(&view.box, grown->joints[i].position);
    double width = (double)view.box.high.x - view.box.low.x, height = (double)view.box.high.y - view.box.low.y;
    double size = fmax(width, height);
    view.scale = size > 0 ? 1000 / size : 1;
    return view;
}

static MesoStatus put_curve(const MesoGrown *grown, const MesoGrammar *grammar, const View *view,
                            const MesoGrowthElement *element, MesoOutput *output, MesoError *error)
{
    const MesoJoint *from = &grown->joints[element->span.from], *to = &grown->joints[element->span.to];
    MesoVec3 p[4];
    double at[8];
    meso_bend_curve(from, to, p);
    for (int k = 0; k < 4; k++) {
        at[2 * k] = ((double)p[k].x - view->box.low.x) * view->scale;
        at[2 * k + 1] = ((double)view->box.high.y - p[k].y) * view->scale;
    }
    const char *shape = element->shape == MESO_NO_INDEX ? "none" : grammar->shapes[element->shape].name;
    double width = 0.5 * ((double)from->width + to->width) * view->scale;
    return meso_output_print(output, error, "<path class=\"%.64s\" stroke-width=\"%.2f\" d=\"M%.2f %.2fC%.2f %.2f %.2f "
                             "%.2f %.2f %.2f\"/>\n", shape ? shape : "shape", fmax(width, LEAST_STROKE), at[0], at[1],
                             at[2], at[3], at[4], at[5], at[6], at[7]);
}

static bool looks_here(const MesoGrown *grown, const MesoGrowthElement *element)
{
    return grown->joints[element->span.from].normal.z + grown->joints[element->span.to].normal.z >= 0;
}

static MesoStatus put_side(const MesoGrown *grown, const MesoGrammar *grammar, const View *view, bool front,
                           MesoOutput *output, MesoError *error)
{
    MesoStatus status = meso_output_print(output, error, "<g class=\"%s\">\n", front ? "front" : "back");
    for (uint32_t i = 0; i < grown->element_count && !status; i++)
        if (looks_here(grown, &grown->elements[i]) == front)
            status = put_curve(grown, grammar, view, &grown->elements[i], output, error);
    return status ? status : meso_output_print(output, error, "</g>\n");
}

MesoStatus meso_growth_svg_write(const MesoGrown *grown, const MesoGrammar *grammar, const MesoProvenance *provenance,
                                 MesoOutput *output, MesoError *error)
{
    View view = view_of(grown);
    double width = grown->joint_count ? ((double)view.box.high.x - view.box.low.x) * view.scale : 0;
    double height = grown->joint_count ? ((double)view.box.high.y - view.box.low.y) * view.scale : 0;
    MesoStatus status = meso_svg_begin(width, height, provenance,
                                       "path{fill:none;stroke:#124;stroke-linecap:round}.back path{stroke:#bcd}", output,
                                       error);
    if (!status)
        status = put_side(grown, grammar, &view, false, output, error);
    if (!status)
        status = put_side(grown, grammar, &view, true, output, error);
    return status ? status : meso_svg_end(output, error);
}
