#include "cmd/common/surface_judge.h"

#include <stdarg.h>
#include <stdio.h>

#include "libcore/mesh/surface_check.h"
#include "libcore/shell/hexahedra.h"

/* Faces that a message names. */
enum { NAMED = 5 };

typedef struct Walls {
    uint32_t count;             /* faces with a side without a wall */
    uint32_t faces[NAMED];      /* the first of them */
} Walls;

static const char *plural(uint32_t count)
{
    return count == 1 ? "" : "s";
}

/* A line of warning, or the error where warnings are; after an error nothing more. */
__attribute__((format(printf, 4, 5)))
static void tell(MesoTool *tool, const MesoSurfaceJudge *judge, bool is_error, const char *format, ...)
{
    char text[sizeof tool->error.message];
    va_list arguments;
    if (tool->error.status)
        return;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (is_error || judge->strict)
        meso_fail(&tool->error, MESO_ERR_INPUT, "'%s': %s", judge->path, text);
    else
        meso_tool_say(tool, "warning: '%s': %s", judge->path, text);
}

static bool has_plain_interface(const MesoTileSet *set)
{
    for (uint32_t i = 0; i < set->interface_count; i++)
        if (set->interfaces[i].section_count == 0)
            return true;
    return false;
}

static bool has_coinciding_corners(const MesoQuadMesh *mesh, uint32_t face)
{
    for (uint32_t i = 0; i < 4; i++) {
        MesoVec3 a = mesh->positions[mesh->face_vertices[4 * face + i]];
        MesoVec3 b = mesh->positions[mesh->face_vertices[4 * face + ((i + 1) & 3)]];
        if (a.x == b.x && a.y == b.y && a.z == b.z)
            return true;
    }
    return false;
}

/* At the thickness of meso-map's default: a wall without a direction has none at others, but by rare chance. */
static Walls find_walls(const MesoSurfaceJudge *judge)
{
    Walls walls;
    MesoShell shell = meso_shell_make(judge->mesh, judge->graph, 0, judge->mesh->mean_edge_length);
    walls.count = meso_shell_without_walls(&shell, walls.faces, NAMED);
    return walls;
}

static void tell_walls(MesoTool *tool, const MesoSurfaceJudge *judge, const Walls *walls)
{
    char names[NAMED * 12 + 8];
    size_t used = 0;
    for (uint32_t i = 0; i < walls->count && i < NAMED; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%u", i ? ", " : "", walls->faces[i] + 1);
    if (walls->count > NAMED)
        snprintf(names + used, sizeof names - used, ", ...");
    bool some = has_plain_interface(judge->set), collapsed = has_coinciding_corners(judge->mesh, walls->faces[0]);
    const char *why = collapsed ? "its corners lie on one point"
                      : judge->graph->reversed_count ? "faces wound against each other leave it no normal"
                                                     : "its normals are opposite or run along it";
    const char *step = collapsed ? "clean" : judge->graph->reversed_count ? "orient" : NULL;
    tell(tool, judge, !some, "face%s %s: no strand can end at a side, as %s%s; %s%s%s%s%s", plural(walls->count), names,
         why, some ? ", and meso-map will refuse what shows a cross-section there" : "",
         step ? "'meso-mesh " : "give it normals that point off the surface", step ? step : "", step ? " " : "",
         step ? judge->path : "", step ? " -o OUT.obj' mends that" : "");
}

static void tell_windings(MesoTool *tool, const MesoSurfaceJudge *judge, const MesoSurfaceFlaws *f)
{
    if (f->one_sided_pieces > 0)
        tell(tool, judge, f->blurred_edges > 0,
             "not orientable, %u piece%s one side only, like a Moebius band: faces %u "
             "and %u are wound against each other, and turning faces over only moves that; %s; cut it open there",
             f->one_sided_pieces, f->one_sided_pieces == 1 ? " has" : "s have",
             f->one_sided_faces[0] + 1, f->one_sided_faces[1] + 1,
             f->blurred_edges > 0 ? "the normals there cancel, and there is no outside to grow strands on"
                                  : "strands do not meet there");
    else if (f->reversed_edges > 0)
        tell(tool, judge, false, "faces are wound against each other along %u edge%s (first faces %u and %u), where "
             "strands do not meet; 'meso-mesh orient %s -o OUT.obj' turns them over", f->reversed_edges,
             plural(f->reversed_edges), f->reversed_faces[0] + 1, f->reversed_faces[1] + 1, judge->path);
}

/* What was turned over or cut open for the work, and is not in the file. */
static void tell_wound(MesoTool *tool, const MesoSurfaceJudge *judge, const MesoWindCounts *w)
{
    if (w->faces_turned > 0)
        tell(tool, judge, false, "%u face%s wound against %s neighbours (first face %u), turned over here; 'meso-mesh "
             "orient %s -o OUT.obj' does it for good", w->faces_turned, w->faces_turned == 1 ? " is" : "s are",
             w->faces_turned == 1 ? "its" : "their", w->turned_face + 1, judge->path);
    if (w->edges_cut > 0)
        tell(tool, judge, false, "not orientable, like a Moebius band: cut open along %u edge%s (first between faces %u "
             "and %u), where strands end as at a border", w->edges_cut, plural(w->edges_cut), w->cut_faces[0] + 1,
             w->cut_faces[1] + 1);
}

static void tell_flaws(MesoTool *tool, const MesoSurfaceJudge *judge, const MesoSurfaceFlaws *f)
{
    bool cut = judge->wound && judge->wound->edges_cut > 0;     /* which splits edges, and was told */
    if (f->split_edges > 0 && !cut)
        tell(tool, judge, false, "%u border edges lie on one another and are not joined (%u piece%s; first faces %u and "
             "%u), so that strands end there; 'meso-mesh weld %s -o OUT.obj' joins them", f->split_edges,
             f->pieces, plural(f->pieces), f->split_faces[0] + 1, f->split_faces[1] + 1, judge->path);
    if (f->flat_faces > 0)
        tell(tool, judge, false, "%u face%s without area (first face %u); 'meso-mesh clean %s -o OUT.obj' takes %s out",
             f->flat_faces, plural(f->flat_faces), f->flat_face + 1, judge->path, f->flat_faces == 1 ? "it" : "them");
    if (f->bare_corners > 0)
        tell(tool, judge, false, "%u corner%s without a normal (first face %u) where others have one; they get that of "
             "their vertex, which may not fit; 'meso-mesh clean %s -o OUT.obj' makes all anew", f->bare_corners,
             plural(f->bare_corners), f->bare_face + 1, judge->path);
    if (f->lost_normals > 0 && f->reversed_edges == 0 && f->flat_faces == 0)   /* else those are why */
        tell(tool, judge, false, "the normals of %u vert%s cancel, as faces fold back on each other; strands there point "
             "anywhere", f->lost_normals, f->lost_normals == 1 ? "ex" : "ices");
}

static MesoStatus report(MesoTool *tool, const MesoSurfaceFlaws *f, const MesoWindCounts *wound, const Walls *walls)
{
    json_t *object = json_pack("{sIsIsIsIsIsIsIsIsIsI}", "pieces", (json_int_t)f->pieces,
                               "faces_turned_over", (json_int_t)wound->faces_turned,
                               "edges_cut_open", (json_int_t)wound->edges_cut,
                               "split_edges", (json_int_t)f->split_edges,
                               "reversed_edges", (json_int_t)f->reversed_edges,
                               "one_sided_pieces", (json_int_t)f->one_sided_pieces,
                               "flat_faces", (json_int_t)f->flat_faces,
                               "corners_without_normal", (json_int_t)f->bare_corners,
                               "lost_normals", (json_int_t)f->lost_normals,
                               "faces_without_wall", (json_int_t)walls->count);
    if (json_object_set_new(tool->report, "surface", object) != 0)
        return meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the report");
    return MESO_OK;
}

MesoStatus meso_tool_judge_surface(MesoTool *tool, const MesoSurfaceJudge *judge)
{
    MesoSurfaceFlaws flaws;
    MesoStatus status = meso_surface_check(&flaws, &tool->arena, judge->mesh, judge->graph, &tool->error);
    if (status)
        return status;
    Walls walls = find_walls(judge);
    const MesoWindCounts nothing = {0}, *wound = judge->wound ? judge->wound : &nothing;
    status = report(tool, &flaws, wound, &walls);
    if (status)
        return status;
    tool->error.status = MESO_OK;
    tell_wound(tool, judge, wound);
    if (flaws.blurred_edges > 0)
        tell_windings(tool, judge, &flaws);
    if (judge->set && walls.count > 0)
        tell_walls(tool, judge, &walls);
    if (flaws.blurred_edges == 0)
        tell_windings(tool, judge, &flaws);
    tell_flaws(tool, judge, &flaws);
    return tool->error.status;
}
