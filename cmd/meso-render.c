/* meso-render: draws a model to an OpenEXR image with its arbitrary output variables, or to a PNG. */
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "cmd/common/scene_report.h"
#include "cmd/render/picture_files.h"
#include "cmd/render/render_backdrop.h"
#include "cmd/render/render_frames.h"
#include "cmd/render/render_light.h"
#include "cmd/render/render_maker.h"
#include "cmd/render/render_source.h"
#include "formats/file/claim.h"
#include "formats/json/json_text.h"
#include "libcore/base/clock.h"
#include "libcore/base/index.h"
#include "libcore/base/kept_memory.h"
#include "libcore/render/picture/apart.h"
#include "libcore/render/picture/motion.h"
#include "libcore/render/picture/painter.h"

/* Of 116 bytes each: models of more are drawn without holding them. */
enum { STORED_SWEEPS = 1 << 19 };

static const MesoToolInfo RENDER_TOOL = {
    .name = "meso-render",
    .synopsis = "meso-render [options] MODEL -o OUT.exr|.png\n"
                "meso-render --show WHAT [TILES] SURFACE|MODEL [SLOTS...] -o OUT.exr|.png\n"
                "meso-render [options] --tiles TILES -o OUT.exr|.png",
    .purpose = "Draw a model or a mesh to an image: colour, depth, normals, albedo, ids.",
    .examples = "meso-render vase.meso -o vase.exr --png vase.png\n"
                "meso-render --size 640x360 --eye 0,1,4 --target 0,0,0 vase.meso -o vase.png\n"
                "meso-render --turntable 48 --resume vase.meso -o turn-%04d.png",
    .words = "1 .meso .obj .ply .off .json\n"
             "2 .slots .obj .ply .off\n"
             "3 .slots\n"
             "4 .slots\n"
             "--show macro failures tiles difference strands id:\n"
             "--report .json\n"
             "--output .exr .png\n"
             "--json .json\n"
             "--tiles .json\n"
             "--keys .json .bin\n"
             "--camera .glb .gltf .bin\n"
             "--png .png\n"
             "--background none light .png .exr .hdr\n"
             "--light camera studio sky .exr .hdr",
    .operands_low = 0,
    .operands_high = 4,
};

/* Words with commas between. */
static MesoStatus parse_extras(MesoRenderArguments *a, MesoError *error)
{
    static const struct {
        const char *word;
        unsigned extras;
    } known[] = {{"position", MESO_EXTRA_POSITION}, {"uv", MESO_EXTRA_UV}, {"occlusion", MESO_EXTRA_OCCLUSION},
                 {"material", MESO_EXTRA_MATERIAL}, {"cryptomatte", MESO_EXTRA_MATTES}, {"motion", MESO_EXTRA_MOTION},
                 {"all", ~0u & ~(unsigned)MESO_EXTRA_MOTION}};
    for (const char *word = a->aov; word && *word;) {
        size_t length = strcspn(word, ","), k = 0, count = sizeof known / sizeof *known;
        while (k < count && (strlen(known[k].word) != length || strncmp(known[k].word, word, length) != 0))
            k++;
        if (k == count)
            return meso_fail(error, MESO_ERR_USAGE, "--aov: '%.*s' is none of position, uv, occlusion, material, "
                             "cryptomatte, motion, all", (int)length, word);
        a->extras |= known[k].extras;
        word += length + (word[length] == ',');
    }
    return MESO_OK;
}

/* N or N/D. */
static MesoStatus parse_fps(MesoRenderArguments *a, MesoError *error)
{
    const char *text = a->fps_text;
    a->rate[1] = 1;
    for (int i = 0; text && i < 2; i++) {
        char *end;
        unsigned long value = *text >= '0' && *text <= '9' ? strtoul(text, &end, 10) : 0;
        bool last = value && *end == 0;
        if (value == 0 || value > 1000000 || !(last || (i == 0 && *end == '/')))
            return meso_fail(error, MESO_ERR_USAGE,
                             "--fps '%s' is neither a number nor a fraction, such as 24 or 30000/1001", a->fps_text);
        a->rate[i] = (uint32_t)value;
        text = last ? NULL : end + 1;
    }
    return MESO_OK;
}

static MesoStatus choose_product(MesoRenderArguments *a, MesoError *error)
{
    const char *output = a->tool.output, *kind = a->to;
    if (!output)
        return meso_fail(error, MESO_ERR_USAGE, "no output given: -o OUT.exr or -o OUT.png");
    const char *dot = strrchr(output, '.');
    if (!kind)
        kind = dot ? dot + 1 : "";
    a->exr_product = strcasecmp(kind, "exr") == 0;
    if (a->exr_product || strcasecmp(kind, "png") == 0)
        return MESO_OK;
    return meso_fail(error, MESO_ERR_USAGE,
                     "no kind of image is known by the name '%s': end it in .exr or .png, or give --to",
                     output);
}

static json_t *point_json(MesoVec3 p)
{
    return json_pack("[f, f, f]", (double)p.x, (double)p.y, (double)p.z);
}

static void report_image(MesoTool *tool, const MesoRenderOptions *options, const MesoScene *scene,
                         const char *renderer, uint64_t covered)
{
    const MesoCamera *camera = &options->camera;
    json_t *report = tool->report;
    json_object_set_new(report, "width", json_integer(options->width));
    json_object_set_new(report, "height", json_integer(options->height));
    json_object_set_new(report, "renderer", meso_json_string(renderer));
    meso_scene_report_ids(report, scene);
    json_object_set_new(report, "sweeps", json_integer(scene->sweep_count));
    json_object_set_new(report, "inner_meshes", json_integer(scene->placed_count));
    json_object_set_new(report, "covered_pixels", json_integer((json_int_t)covered));
    json_object_set_new(report, "camera",
                        json_pack("{s:o, s:o, s:o, s:f}", "eye", point_json(camera->eye), "target",
                                  point_json(camera->target), "up", point_json(camera->up),
                                  camera->height > 0 ? "ortho_height" : "fov_degrees",
                                  (double)(camera->height > 0 ? camera->height : camera->fov_degrees)));
    if (covered == 0)
        meso_tool_say(tool, "warning: nothing of the model is on the image");
}

/* How a picture comes about: times in seconds. */
typedef struct Drawing {
    MesoRenderOptions options;
    bool numbered;              /* it is a frame */
    MesoPictureFiles files;
    const char *renderer;
    bool begun;                 /* there is a picture to write */
    double context, drawing, writing;
} Drawing;

static void say_times(const MesoTool *tool, const Drawing *d, double model)
{
    if (tool->verbose)
        meso_tool_say(tool, "model %.0f ms, context %.0f ms, drawing %.0f ms, writing %.0f ms", 1e3 * model,
                      1e3 * d->context, 1e3 * d->drawing, 1e3 * d->writing);
}

/* Seconds since `*at`, which becomes now. */
static double lap(double *at)
{
    double now = meso_seconds(), passed = now - *at;
    *at = now;
    return passed;
}

static MesoStatus check_maker(const MesoRenderArguments *a, MesoError *error)
{
    if (meso_render_wants_gl(a) && a->extras & MESO_EXTRA_MOTION)
        return meso_fail(error, MESO_ERR_USAGE, "--aov motion is for --visibility tiles; GL finds none");
    if (strcmp(a->visibility, "tiles") == 0 && a->context_given)
        return meso_fail(error, MESO_ERR_USAGE, "--context is for --visibility gl; tiles need none");
    return MESO_OK;
}

static bool tight(const MesoRenderArguments *a)
{
    return strcmp(a->data_window, "tight") == 0;
}

/* What frames share: a model is read once, but where each has its own. */
typedef struct Work {
    MesoRenderArguments *a;
    MesoRenderFrames frames;
    MesoRenderSource source;
    MesoRenderSource next;      /* of the next frame, where there is one and motion is asked for */
    bool read, next_read;       /* the sources are */
    const MesoEnvironment *environment;     /* NULL: light that comes with the camera */
    MesoRenderBackdrop backdrop;
    MesoRenderMaker maker;
    bool chosen;                /* the maker is, for all frames */
    uint32_t input_count;       /* of the provenance, without the model */
    uint32_t drawn, skipped;    /* frames */
} Work;

/* By GL, in a process apart, whole. */
static MesoStatus draw_apart(Work *work, Drawing *d, MesoArena *arena, const MesoRenderFrame *frame, MesoError *error)
{
    MesoRenderArguments *a = work->a;
    MesoApartPicture *picture;
    double at = meso_seconds();
    MesoStatus status = meso_apart_picture_init(&picture, arena, work->maker.context, a->tool.threads,
                                                &work->source.scene, &d->options, error);
    if (status)
        return status;
    d->begun = true;
    d->renderer = meso_arena_copy_text(&a->tool.arena, picture->renderer, error);
    if (work->maker.tried)
        a->tool.provenance.command_line = meso_render_frame_gpu_command(&work->frames, frame, &a->tool.arena, error);
    d->drawing = meso_seconds() - picture->context_made;
    d->context = lap(&at) - d->drawing;
    status = d->renderer && a->tool.provenance.command_line
                 ? meso_picture_files_begin(&d->files, a, frame, d->numbered, &work->backdrop, &picture->image,
                                            d->options.height, error)
                 : MESO_ERR_MEMORY;
    if (!status)
        status = meso_picture_files_band(&d->files, error);
    status = meso_picture_files_end(&d->files, status, error);
    d->writing = lap(&at);
    meso_apart_picture_release(picture);
    return status;
}

/*
 * Low bands keep the picture small beside the lights' maps, of which many samples have more, and lower tiles; not where
 * all of it would be looked through before the first of several.
 */
static uint32_t choose_rows(const MesoRenderArguments *a, const MesoScene *scene, const MesoRenderOptions *options)
{
    uint32_t most = meso_paint_band_rows(scene, options), low = options->samples > 4 ? 64 : 256;
    bool looked_through = options->find_covered || options->extras & MESO_EXTRA_MATTES;
    return a->band_rows || looked_through || most <= low ? a->band_rows : low;
}

/* By tiles: each band is painted and written. */
static MesoStatus draw_bands(Work *work, Drawing *d, MesoArena *arena, const MesoRenderFrame *frame, MesoError *error)
{
    MesoRenderArguments *a = work->a;
    const MesoScene *scene = &work->source.scene;
    MesoPainter *painter;
    MesoImage band;
    double at = meso_seconds();
    d->renderer = "tiles";
    d->options.band_rows = choose_rows(a, scene, &d->options);
    MesoStatus status = meso_painter_init(&painter, &band, arena, scene, &d->options, a->tool.threads, error);
    d->drawing = lap(&at);
    if (status)
        return status;
    for (uint32_t row = 0; row < d->options.height && !status; row += band.height) {
        status = meso_paint(painter, &band, row, error);
        d->drawing += lap(&at);
        if (!status && row == 0)
            status = meso_picture_files_begin(&d->files, a, frame, d->numbered, &work->backdrop, &band,
                                              d->options.height, error);
        if (!status)
            status = meso_picture_files_band(&d->files, error);
        d->writing += lap(&at);
    }
    status = meso_picture_files_end(&d->files, status, error);
    d->writing += lap(&at);
    return status;
}

static void close_model(Work *work)
{
    meso_render_source_close(&work->source);
    meso_render_source_close(&work->next);
    work->read = work->next_read = false;
}

static MesoStatus read_model(Work *work, const char *path, MesoError *error)
{
    close_model(work);
    work->a->tool.provenance.input_count = work->input_count;
    MesoStatus status = meso_render_source_read(&work->source, work->a, path, error);
    work->read = status == MESO_OK;
    return status;
}

/* The model of the next number, if it is there and is alike. */
static MesoStatus read_next(Work *work, const MesoRenderFrame *frame, MesoError *error)
{
    MesoRenderArguments *a = work->a;
    if (!work->frames.many_models || !(a->extras & MESO_EXTRA_MOTION))
        return MESO_OK;
    const char *path = meso_frame_path(a->model, frame->number + 1, &a->tool.arena, error);
    if (!path || access(path, F_OK) != 0)
        return path ? MESO_OK : MESO_ERR_MEMORY;
    MesoStatus status = meso_render_source_read(&work->next, a, path, error);
    work->next_read = status == MESO_OK;
    if (!status && !meso_motion_alike(&work->source.scene, &work->next.scene))
        meso_tool_say_of(&a->tool, frame->output, "warning: '%s' has another structure than '%s': motion is the "
                         "camera's alone", path, frame->model);
    return status;
}

/* What motion leads to. */
static void look_ahead(const Work *work, const MesoRenderFrame *frame, MesoRenderOptions *options)
{
    MesoRenderFrame next = *frame;
    next.number++;
    bool moves = work->next_read && meso_motion_alike(&work->source.scene, &work->next.scene);
    options->next_scene = moves ? &work->next.scene : NULL;
    options->next_camera = meso_render_frame_camera(&work->frames, &next,
                                                    work->next_read ? &work->next.scene : &work->source.scene);
}

/* One maker for all frames; a GPU gets what GL holds. */
static void choose_maker(Work *work, const Drawing *d)
{
    const MesoScene *scene = &work->source.scene;
    bool held = !scene->maker && meso_paint_band_rows(scene, &d->options) == d->options.height;
    if (!work->chosen)
        work->maker = meso_render_maker(work->a, held);
    if (work->maker.tried)
        work->a->stored_sweeps = 0;
    work->chosen = true;
}

/* By the maker; a GPU that was found, and draws no first picture, leaves it to tiles. */
static MesoStatus draw_by_maker(Work *work, Drawing *d, MesoArena *arena, const MesoRenderFrame *frame,
                                MesoError *error)
{
    if (!work->maker.context)
        return draw_bands(work, d, arena, frame, error);
    MesoStatus status = draw_apart(work, d, arena, frame, error);
    if (!status || d->begun || !work->maker.tried || work->drawn)
        return status;
    work->maker = (MesoRenderMaker){.why = meso_arena_copy_text(&work->a->tool.arena, error->message, NULL)};
    *error = (MesoError){0};
    return draw_bands(work, d, arena, frame, error);
}

static void say_maker(const Work *work, const Drawing *d)
{
    const char *why = work->maker.why;
    if (work->a->tool.verbose)
        meso_tool_say(&work->a->tool, "drawn by %s%s%s", d->renderer, why ? ": " : "", why ? why : "");
}

static MesoStatus draw(Work *work, Drawing *d, MesoArena *arena, const MesoRenderFrame *frame, MesoError *error)
{
    MesoRenderArguments *a = work->a;
    const MesoScene *scene = &work->source.scene;
    uint32_t channel = work->source.color_channel;
    *d = (Drawing){.options = {
        .width = a->camera.size[0],
        .height = a->camera.size[1],
        .camera = meso_render_frame_camera(&work->frames, frame, scene),
        .samples = (uint32_t)strtoul(a->samples_text, NULL, 10),
        .ground = strcmp(a->ground, "shadow") == 0,
        .extras = a->extras,
        .vary = a->vary,
        .environment = work->environment,
        .up = a->camera.world_up,
        .color_ids = channel == MESO_NO_INDEX ? 0 : channel + 1,
        .band_rows = a->band_rows,
        .find_covered = tight(a),
        .full_detail = strcmp(a->detail, "full") == 0,
    }, .numbered = work->frames.numbered};
    if (a->extras & MESO_EXTRA_MOTION)
        look_ahead(work, frame, &d->options);
    choose_maker(work, d);
    return draw_by_maker(work, d, arena, frame, error);
}

static MesoStatus draw_frame(Work *work, const MesoRenderFrame *frame, double start, MesoError *error)
{
    MesoRenderArguments *a = work->a;
    MesoArena scratch;
    Drawing drawing;
    double model = lap(&start);
    meso_arena_init(&scratch);
    MesoStatus status = draw(work, &drawing, &scratch, frame, error);
    if (!status) {
        report_image(&a->tool, &drawing.options, &work->source.scene, drawing.renderer, drawing.files.covered);
        say_maker(work, &drawing);
        say_times(&a->tool, &drawing, model);
        work->drawn++;
    }
    meso_arena_release(&scratch);
    return status;
}

/* Where others may be at work on the same frames, each is drawn by whoever claims it first, if it is not done. */
static MesoStatus resume_frame(Work *work, const MesoRenderFrame *frame, double start, MesoError *error)
{
    MesoClaim claim = {0};
    bool taken, done;
    MesoStatus status = meso_render_frame_is_done(&done, frame, &work->a->tool.provenance, error);
    if (status || done) {
        work->skipped += done;
        return status;
    }
    status = meso_claim_take(&claim, frame->output, &taken, error);
    if (!status && taken)
        status = meso_render_frame_is_done(&done, frame, &work->a->tool.provenance, error);
    if (!status && taken && !done)
        status = draw_frame(work, frame, start, error);
    else if (!status)
        work->skipped++;
    meso_claim_release(&claim);
    return status;
}

static MesoStatus render_frame(Work *work, uint32_t i, MesoError *error)
{
    MesoTool *tool = &work->a->tool;
    MesoRenderFrame frame;
    double start = meso_seconds();
    MesoStatus status = meso_render_frame(&frame, &work->frames, i, &tool->arena, error);
    if (!status && (work->frames.many_models || !work->read))
        status = read_model(work, frame.model, error);
    if (!status)
        status = read_next(work, &frame, error);
    if (status)
        return status;
    if (work->frames.numbered) {
        status = meso_tool_check_output(tool, "-o", frame.output);
        if (!status && frame.png)
            status = meso_tool_check_output(tool, "--png", frame.png);
    }
    tool->provenance.command_line = frame.command;
    if (status)
        return status;
    return work->a->resume ? resume_frame(work, &frame, start, error) : draw_frame(work, &frame, start, error);
}

static MesoStatus render(Work *work, MesoError *error)
{
    MesoTool *tool = &work->a->tool;
    MesoStatus status = MESO_OK;
    uint32_t count = work->frames.list.count;
    const char *command = tool->provenance.command_line;
    if (work->frames.numbered)
        meso_tool_progress_begin(tool, "frames", "frames");
    for (uint32_t i = 0; i < count && !status; i++) {
        MesoArenaMark mark = meso_arena_mark(&tool->arena);
        status = render_frame(work, i, error);
        if (status && work->frames.numbered)
            meso_fail_prefix(error, meso_arena_print(&tool->arena, NULL, "frame %d", work->frames.list.frames[i]));
        if (work->frames.many_models) {
            close_model(work);
            tool->provenance.input_count = work->input_count;
            meso_arena_rewind(&tool->arena, mark);
        }
        if (work->frames.numbered)
            meso_tool_progress(tool, i + 1, count);
    }
    tool->provenance.command_line = command;
    if (!status && (work->frames.numbered || work->a->resume)) {
        json_object_set_new(tool->report, "frames_drawn", json_integer(work->drawn));
        json_object_set_new(tool->report, "frames_skipped", json_integer(work->skipped));
        meso_tool_say(tool, "%u frame%s drawn, %u done before", work->drawn, work->drawn == 1 ? "" : "s",
                      work->skipped);
    }
    return status;
}

static MesoStatus run(MesoRenderArguments *a, MesoError *error)
{
    Work work = {.a = a};
    MesoStatus status = choose_product(a, error);
    if (!status)
        status = meso_render_source_check(a, error);
    if (!status)
        status = parse_extras(a, error);
    if (!status)
        status = parse_fps(a, error);
    if (!status)
        status = check_maker(a, error);
    if (!status)
        status = meso_render_light_init(&work.environment, a, error);
    if (!status)
        status = meso_render_backdrop_init(&work.backdrop, a, work.environment, error);
    if (!status)
        status = meso_render_frames_init(&work.frames, a, error);
    if (!status && a->extras & MESO_EXTRA_MOTION && !work.frames.numbered)
        status = meso_fail(error, MESO_ERR_USAGE,
                           "--aov motion is for frames: --turntable, --keys or a MODEL by number");
    if (meso_render_wants_gl(a) && strcmp(a->context, "osmesa") != 0)   /* a GPU has them all in its buffers */
        a->stored_sweeps = 0;
    work.backdrop.up = a->camera.world_up;
    work.input_count = a->tool.provenance.input_count;
    if (!status)
        status = render(&work, error);
    close_model(&work);
    return status;
}

int main(int argc, char **argv)
{
    MesoRenderArguments a = {.camera = MESO_CAMERA_DEFAULTS, .samples_text = "4", .context = "osmesa",
                         .visibility = "auto", .devices = "/dev", .ground = "none", .data_window = "full",
                         .detail = "picture", .rate = {24, 1}, .light = "camera", .light_strength = 1,
                         .tone = "shoulder", .stored_sweeps = STORED_SWEEPS};
    const MesoOption options[] = {
        MESO_CHOICE(0, "to", "KIND", "kind of the product (default: the extension of the output)", &a.to,
                    "exr|png", .more = MESO_OPTION_OUTWARD),
        MESO_OUTPUT_FILE(0, "png", "FILE", "write the colour as PNG there too", &a.png),
        MESO_TEXT(0, "show", "WHAT", "draw macro, failures, tiles or difference of a surface, or strands or id:NAME of "
                  "a model", &a.show),
        MESO_INPUT_FILE(0, "report", "FILE", "of meso-solve, for --show failures", &a.report),
        MESO_INPUT_FILE(0, "tiles", "TILES", "draw a sheet of a tile set: each tile in a cell, with its name",
                        &a.tiles),
        MESO_FOLDER(0, "mesh-path", "DIR", "folder of the tiles' meshes that are not beside TILES", &a.mesh_path,
                    .more = MESO_OPTION_OUTWARD),
        MESO_CAMERA_OPTIONS(a.camera),
        MESO_GROUP("Frames; the names of files, and of MODEL, have their number in %04d"),
        MESO_TEXT(0, "frames", "LIST", "which: 1-100, 1-99x2, 3,10-20 (default: all that there are)", &a.frames),
        MESO_COUNT(0, "turntable", "N", "N frames, 1 to N, for a full turn around the model", &a.turntable, 1, 1000000),
        MESO_INPUT_FILE(0, "keys", "FILE", "the camera goes through key frames of a .camera.json, or view matrices "
                        "(.bin)", &a.keys),
        MESO_FLAG(0, "resume", "leave frames that are done, and those that another process works on", &a.resume,
                  .more = MESO_OPTION_SILENT),
        MESO_GROUP("Picture"),
        MESO_CHOICE(0, "samples", "N", "samples of the colour a pixel, 1, 4 (default) or 16", &a.samples_text,
                    "1|4|16"),
        MESO_CHOICE(0, "ground", "WHAT", "under the model: none (default), or one that shadow falls on", &a.ground,
                    "none|shadow"),
        MESO_TEXT(0, "light", "WHAT", "camera (default: it comes with it), studio, sky, or a lat-long FILE (.exr, "
                  ".hdr)", &a.light),
        MESO_NUMBER(0, "light-turn", "DEGREES", "turn that light about the direction that is up", &a.light_turn, -36000,
                    36000, .given = &a.light_turn_given),
        MESO_NUMBER(0, "light-strength", "X", "times as much of it (default 1)", &a.light_strength, 0, 1e6,
                    .given = &a.light_strength_given),
        MESO_NUMBER(0, "vary", "AMOUNT", "how much colours differ from strand to strand, or element to element, 0 "
                    "(default) to 1", &a.vary, 0, 1),
        MESO_CHOICE(0, "visibility", "MAKER", "of what is seen: tiles, by this program, gl, or auto (default): a GPU "
                    "where there is one, tiles otherwise", &a.visibility, "auto|tiles|gl"),
        MESO_CHOICE(0, "detail", "HOW", "columns and rings of sweeps: as many as the picture and its light need "
                    "(picture, default), or all (full)", &a.detail, "picture|full"),
        MESO_TEXT(0, "aov", "LIST", "more variables in the EXR: position, uv, occlusion, material, cryptomatte, "
                  "motion, or all, which is without motion",
                  &a.aov),
        MESO_FLAG(0, "multipart", "an EXR of a part for each layer", &a.multipart),
        MESO_CHOICE(0, "data-window", "HOW", "of the EXR: full (default), or tight around what is there",
                    &a.data_window,
                    "full|tight"),
        MESO_TEXT(0, "fps", "RATE", "frames a second, as the EXRs of frames say: 24 (default), 30000/1001",
                  &a.fps_text),
        MESO_TEXT(0, "background", "WHAT", "of the PNG: R,G,B, linear, 0 to 1 (default: light grey), none, the light, "
                  "or a picture FILE that is to cover it", &a.background_text),
        MESO_CHOICE(0, "tone", "CURVE", "of the PNG's highlights: shoulder (default), none, neutral, agx or filmic",
                    &a.tone,
                    "shoulder|none|neutral|agx|filmic"),
        MESO_CHOICE(0, "context", "MAKER",
                    "of the GL context: osmesa (default), egl, or auto for a GPU where there is one",
                    &a.context, "auto|osmesa|egl", .given = &a.context_given),
        MESO_TEXT(0, "devices", "DIR", 0, &a.devices, .more = MESO_OPTION_SILENT),
        MESO_COUNT(0, "band-rows", "N", 0, &a.band_rows, 0, 16384, .more = MESO_OPTION_SILENT),
        MESO_COUNT(0, "stored-sweeps", "N", 0, &a.stored_sweeps, 0, UINT32_MAX, .more = MESO_OPTION_SILENT),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    meso_kept_memory();
    if (!meso_tool_start(&a.tool, &RENDER_TOOL, options, argc, argv))
        return meso_tool_finish(&a.tool);
    a.tool.status = run(&a, &a.tool.error);
    return meso_tool_finish(&a.tool);
}
