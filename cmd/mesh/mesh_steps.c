#include "cmd/mesh/mesh_steps.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "libcore/base/nearest.h"
#include "libcore/mesh/edit/origins.h"

/* ---- arguments ---- */

static bool parse_number(const char *text, double *number)
{
    char *end;
    if (!*text || text[strspn(text, "0123456789.eE+-")] != 0)
        return false;
    *number = strtod(text, &end);
    return *end == 0;
}

static MesoStatus parse_nothing(MesoMeshStep *step, const char *argument, MesoError *error)
{
    if (!argument)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "step '%s' takes no argument", step->kind->word);
}

static MesoStatus parse_distance(MesoMeshStep *step, const char *argument, MesoError *error)
{
    if (!argument || (parse_number(argument, &step->number) && step->number >= 1e-30 && step->number <= 1e18))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "step 'weld': '%s' is no distance from 1e-30 to 1e18", argument);
}

static bool parse_levels(const char *text, uint32_t *count)
{
    double number;
    if (!parse_number(text, &number) || number < 1 || number > 16 || number != (double)(uint32_t)number)
        return false;
    *count = (uint32_t)number;
    return true;
}

static bool parse_scheme(const char *text, size_t length, MesoScheme *scheme)
{
    static const char *const names[] = {[MESO_CATMULL_CLARK] = "catmull-clark", [MESO_LOOP] = "loop",
                                        [MESO_LINEAR] = "linear"};
    for (int i = 0; i < 3; i++)
        if (strlen(names[i]) == length && memcmp(names[i], text, length) == 0) {
            *scheme = (MesoScheme)i;
            return true;
        }
    return false;
}

/* SCHEME, or N, or SCHEME,N */
static MesoStatus parse_subdivision(MesoMeshStep *step, const char *argument, MesoError *error)
{
    step->scheme = MESO_CATMULL_CLARK;
    step->level_count = 1;
    if (!argument || parse_levels(argument, &step->level_count))
        return MESO_OK;
    size_t length = strcspn(argument, ",");
    if (!parse_scheme(argument, length, &step->scheme))
        return meso_fail(error, MESO_ERR_USAGE,
                         "step 'subdivide': '%.*s' is not catmull-clark, loop, linear, or a number of times "
                         "from 1 to 16", (int)(length < 40 ? length : 40), argument);
    if (argument[length] == 0 || parse_levels(argument + length + 1, &step->level_count))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "step 'subdivide': '%s' is no number of times from 1 to 16",
                     argument + length + 1);
}

static MesoStatus parse_quads(MesoMeshStep *step, const char *argument, MesoError *error)
{
    step->scheme = MESO_CATMULL_CLARK;
    step->level_count = 1;
    if (argument && strcmp(argument, "linear") == 0)
        step->scheme = MESO_LINEAR_QUADS;
    if (!argument || strcmp(argument, "linear") == 0 || strcmp(argument, "catmull-clark") == 0)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "step 'quads': '%s' is not catmull-clark or linear", argument);
}

static MesoStatus parse_target(MesoMeshStep *step, const char *argument, MesoError *error)
{
    char number[40] = "";
    if (!argument)
        return meso_fail(error, MESO_ERR_USAGE,
                         "step 'decimate' needs a number of faces or a percentage, as in decimate=5000 or "
                         "decimate=50%%");
    size_t length = strlen(argument);
    step->percent = length > 0 && argument[length - 1] == '%';
    snprintf(number, sizeof number, "%.*s", (int)(length - step->percent < 39 ? length - step->percent : 39), argument);
    double high = step->percent ? 100 : 4294967294.0;
    if (length < 39 && parse_number(number, &step->number) && step->number > 0 && step->number <= high &&
        (step->percent || step->number == (double)(uint32_t)step->number))
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE, "step 'decimate': '%s' is no number of faces, nor a percentage up to 100%%",
                     argument);
}

/* ---- the steps ---- */

const MesoMeshStepKind meso_mesh_step_kinds[] = {
    {"info", NULL, "print what the mesh is like now, and what is wrong with it, as JSON", parse_nothing,
     meso_mesh_run_info},
    {"weld", "[=DISTANCE]", "make vertices in one place one, or those within a distance; what differs\n"
     "between them (texture seams, hard edges) stays at the corners", parse_distance, meso_mesh_run_weld},
    {"clean", NULL, "drop repeated corners, flat and double faces, and unused vertices", parse_nothing,
     meso_mesh_run_clean},
    {"separate", NULL, "take apart what meets in edges of three faces or more, or in a point", parse_nothing,
     meso_mesh_run_separate},
    {"orient", NULL, "wind neighbours alike, and closed pieces outward", parse_nothing, meso_mesh_run_orient},
    {"triangulate", NULL, "cut faces into triangles", parse_nothing, meso_mesh_run_triangulate},
    {"pair", NULL, "make quads of triangles that follow each other: faces 1 and 2, 3 and 4, ...", parse_nothing,
     meso_mesh_run_pair},
    {"quads", "[=SCHEME]", "make quads of all faces: one step of catmull-clark (default), or linear,\nwhich keeps the shape",
     parse_quads, meso_mesh_run_subdivide},
    {"subdivide", "[=SCHEME][,N]", "subdivide N times (1): catmull-clark (default), loop, which wants\n"
     "triangles, or linear", parse_subdivision, meso_mesh_run_subdivide},
    {"decimate", "=N|P%", "collapse edges until N triangles are left, or P percent", parse_target,
     meso_mesh_run_decimate},
    {"convert", NULL, "nothing: -o alone says what to write", parse_nothing, meso_mesh_run_convert},
    {0},
};

static const MesoMeshStepKind *find_kind(const char *text, size_t length)
{
    for (const MesoMeshStepKind *kind = meso_mesh_step_kinds; kind->word; kind++)
        if (strlen(kind->word) == length && memcmp(kind->word, text, length) == 0)
            return kind;
    return NULL;
}

static MesoStatus refuse_word(const char *text, size_t length, MesoError *error)
{
    MesoNearest nearest = meso_nearest(text, length);
    int shown = (int)(length < 80 ? length : 80);
    for (const MesoMeshStepKind *kind = meso_mesh_step_kinds; kind->word; kind++)
        meso_nearest_try(&nearest, kind->word);
    if (nearest.best)
        return meso_fail(error, MESO_ERR_USAGE, "no step '%.*s'; did you mean '%s'?", shown, text, nearest.best);
    return meso_fail(error, MESO_ERR_USAGE,
                     "no step '%.*s'; steps come first, and one surface last: see meso-mesh help", shown, text);
}

MesoStatus meso_mesh_step_parse(MesoMeshStep *step, const char *text, MesoError *error)
{
    size_t length = strcspn(text, "=");
    *step = (MesoMeshStep){.kind = find_kind(text, length), .text = text};
    if (!step->kind)
        return refuse_word(text, length, error);
    return step->kind->parse(step, text[length] ? text + length + 1 : NULL, error);
}

/* ---- work ---- */

MesoStatus meso_mesh_step_run(const MesoMeshStep *step, MesoMeshWork *work)
{
    MesoPolygonMesh result;
    MesoError *error = &work->tool->error;
    work->count_count = 0;
    if (step->kind->run(step, work, &result))
        return meso_fail_prefix(error, step->text);
    if (result.corners == work->mesh.corners)
        return MESO_OK;
    if (meso_mesh_detach(&result, &work->next, &work->mesh, error))
        return MESO_ERR_MEMORY;
    meso_arena_release(&work->arena);
    work->arena = work->next;
    meso_arena_init(&work->next);
    work->mesh = result;
    return MESO_OK;
}

void meso_mesh_work_release(MesoMeshWork *work)
{
    meso_arena_release(&work->arena);
    meso_arena_release(&work->next);
}

/* ---- help ---- */

static void print_kind(const MesoMeshStepKind *kind)
{
    printf("  %s%s\n", kind->word, kind->argument ? kind->argument : "");
    for (const char *line = kind->help; *line;) {
        int length = (int)strcspn(line, "\n");
        printf("      %.*s\n", length, line);
        line += length;
        line += *line == '\n';
    }
}

MesoStatus meso_mesh_steps_help(const char *word, MesoError *error)
{
    const MesoMeshStepKind *only = word ? find_kind(word, strlen(word)) : NULL;
    if (word && !only)
        return refuse_word(word, strlen(word), error);
    printf("Steps of meso-mesh, done in the order given:\n");
    for (const MesoMeshStepKind *kind = meso_mesh_step_kinds; kind->word; kind++)
        if (!only || kind == only)
            print_kind(kind);
    return MESO_OK;
}
