/* Who draws: whom the arguments name, and a GPU where a node of one is there and nothing wants tiles. */
#include "cmd/render/render_maker.h"

#include <sys/stat.h>

#include "cmd/render/render_frames.h"
#include "formats/file/test_folder.h"
#include "libcore/render/image.h"

static TestFolder folder;

static void put(const char *name)
{
    FILE *file = fopen(test_path(&folder, name), "w");
    CHECK(file && fclose(file) == 0);
}

static void test_nodes(void)
{
    CHECK(!meso_gpu_is_there(test_path(&folder, "none")) && !meso_gpu_is_there(folder.path));
    CHECK(mkdir(test_path(&folder, "dri"), 0700) == 0);
    put("nvidiactl");           /* the driver's, without a GPU */
    put("dxgi");
    put("dri/card0");           /* what draws on a screen alone */
    CHECK(!meso_gpu_is_there(folder.path));
    put("dri/renderD128");
    CHECK(meso_gpu_is_there(folder.path));
    CHECK(chmod(test_path(&folder, "dri/renderD128"), 0) == 0);
    CHECK(geteuid() == 0 || !meso_gpu_is_there(folder.path));
    CHECK(unlink(test_path(&folder, "dri/renderD128")) == 0);
    put("dxg");
    CHECK(meso_gpu_is_there(folder.path));
    CHECK(unlink(test_path(&folder, "dxg")) == 0);
    CHECK(!meso_gpu_is_there(folder.path));
    put("nvidia0");
    CHECK(meso_gpu_is_there(folder.path));
}

static bool is_tiles(const MesoRenderArguments *a, bool held, bool says_why)
{
    MesoRenderMaker maker = meso_render_maker(a, held);
    return !maker.context && !maker.tried && (maker.why != NULL) == says_why;
}

/* In a folder that has a GPU. */
static void test_choice(void)
{
    const MesoRenderArguments plain = {.visibility = "auto", .context = "osmesa", .devices = folder.path};
    MesoRenderArguments a = plain;
    MesoRenderMaker maker = meso_render_maker(&a, true);
    CHECK(maker.tried && strcmp(maker.context, "gpu") == 0);
    CHECK(is_tiles(&a, false, true));
    a.devices = "/none";
    CHECK(is_tiles(&a, true, true));
    a = plain;
    a.resume = true;
    CHECK(is_tiles(&a, true, true));
    a = plain;
    a.extras = MESO_EXTRA_MOTION;
    CHECK(is_tiles(&a, true, true));
    a = plain;
    a.visibility = "tiles";
    CHECK(is_tiles(&a, true, false));
    a.visibility = "gl";
    maker = meso_render_maker(&a, false);
    CHECK(!maker.tried && strcmp(maker.context, "osmesa") == 0);
    a = plain;
    a.context = "egl";
    a.context_given = true;
    maker = meso_render_maker(&a, true);
    CHECK(!maker.tried && strcmp(maker.context, "egl") == 0);
}

/* A picture by a GPU that was found says what asks for one: it is none that tiles made. */
static void test_command(void)
{
    static const MesoToolInfo info = {.name = "meso-render", .synopsis = "", .purpose = "", .operands_high = 1};
    MesoRenderArguments a = {.visibility = "auto", .context = "osmesa"};
    const MesoOption options[] = {
        MESO_CHOICE(0, "visibility", "MAKER", "", &a.visibility, "auto|tiles|gl"),
        MESO_CHOICE(0, "context", "MAKER", "", &a.context, "auto|osmesa|egl", .given = &a.context_given),
        MESO_TEXT(0, "frames", "LIST", "", &a.frames),
        MESO_TOOL_OPTIONS(a.tool),
        {0},
    };
    char *words[] = {"meso-render", "--frames", "1-9", "a.meso", "-q"};
    CHECK(meso_tool_start(&a.tool, &info, options, 5, words));
    const MesoRenderFrames frames = {.a = &a, .numbered = true};
    const MesoRenderFrame frame = {.number = 3};
    const char *by_gpu = meso_render_frame_gpu_command(&frames, &frame, &a.tool.arena, &a.tool.error);
    char *same[] = {"meso-render", "--visibility", "gl", "--context", "auto", "--frames", "3", "a.meso"};
    MesoRenderArguments b = {.visibility = "auto", .context = "osmesa"};
    const MesoOption others[] = {
        MESO_CHOICE(0, "visibility", "MAKER", "", &b.visibility, "auto|tiles|gl"),
        MESO_CHOICE(0, "context", "MAKER", "", &b.context, "auto|osmesa|egl", .given = &b.context_given),
        MESO_TEXT(0, "frames", "LIST", "", &b.frames),
        MESO_TOOL_OPTIONS(b.tool),
        {0},
    };
    CHECK(meso_tool_start(&b.tool, &info, others, 8, same));
    CHECK(by_gpu && strcmp(by_gpu, b.tool.provenance.command_line) == 0);
    CHECK(meso_tool_finish(&a.tool) == 0 && meso_tool_finish(&b.tool) == 0);
}

int main(void)
{
    folder = test_folder_make();
    test_nodes();
    test_choice();
    test_command();
    CHECK(unlink(test_path(&folder, "dri/card0")) == 0 && rmdir(test_path(&folder, "dri")) == 0);
    test_folder_remove(&folder);
    return 0;
}
