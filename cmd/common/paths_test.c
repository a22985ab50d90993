/* Files that are the same under other names. */
#include "cmd/common/paths.h"

#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "formats/file/test_folder.h"

static TestFolder folder;

/* `input` is read; `output` and then `second` (NULL: none) are written. */
static MesoStatus try(const char *input, const char *output, const char *second, MesoError *error)
{
    MesoArena arena;
    MesoPaths paths = {0};
    meso_arena_init(&arena);
    MesoStatus status = meso_paths_add_input(&paths, input, &arena, error);
    if (!status)
        status = meso_paths_add_output(&paths, "-o", output, &arena, error);
    if (!status && second)
        status = meso_paths_check_output(&paths, "--report", second, error);
    meso_arena_release(&arena);
    return status;
}

static void expect_clash(const char *input, const char *output, const char *second, const char *message)
{
    MesoError error = {0};
    MesoStatus status = try(input, output, second, &error);
    if (!message) {
        CHECK(status == MESO_OK);
        return;
    }
    CHECK(status == MESO_ERR_USAGE);
    CHECK(strcmp(error.message, message) == 0);
}

int main(void)
{
    folder = test_folder_make();
    test_file_write(test_path(&folder, "in"), "input", 5);
    CHECK(chdir(folder.path) == 0 && mkdir("sub", 0700) == 0);
    CHECK(link("in", "hard") == 0 && symlink("in", "soft") == 0 && symlink("new", "dangling") == 0);
    CHECK(symlink("sub", "folder") == 0 && symlink("loop", "loop") == 0);

    expect_clash("in", "in", NULL, "-o 'in' would write over the input 'in': name another file");
    expect_clash("in", "./in", NULL, "-o './in' would write over the input 'in': name another file");
    expect_clash("in", "hard", NULL, "-o 'hard' would write over the input 'in': name another file");
    expect_clash("soft", "in", NULL, "-o 'in' would write over the input 'soft': name another file");
    expect_clash("in", "sub/../soft", NULL, "-o 'sub/../soft' would write over the input 'in': name another file");
    expect_clash("in", "x", "./x", "-o and --report would both write './x', and one be lost: name another file");
    expect_clash("in", "new", "dangling",
                 "-o and --report would both write 'dangling', and one be lost: name another file");
    expect_clash("in", "sub/x", "folder/x",
                 "-o and --report would both write 'folder/x', and one be lost: name another file");
    expect_clash("in", "x", "in", "--report 'in' would write over the input 'in': name another file");
    expect_clash("in", "x", "sub/x", NULL);
    expect_clash("in", "x", "y", NULL);
    expect_clash("in", "loop", "loop", NULL);       /* nothing could be written there */
    expect_clash("in", "no/x", "no/x", NULL);
    expect_clash("in", "/dev/null", "/dev/null", NULL);
    expect_clash("missing", "x", NULL, NULL);
    expect_clash("missing", "missing", NULL,
                 "-o 'missing' would write over the input 'missing': name another file");
    expect_clash("in", "-", "-", NULL);     /* for the tool to judge */

    unlink("hard");
    unlink("soft");
    unlink("dangling");
    unlink("folder");
    unlink("loop");
    CHECK(rmdir("sub") == 0);
    test_folder_remove(&folder);
    return 0;
}
