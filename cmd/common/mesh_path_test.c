/* Names of meshes: with blanks at the end, and seen from another folder. */
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "cmd/common/mesh_path.h"
#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;

static void touch(const char *path)
{
    FILE *file = fopen(path, "w");
    CHECK(file && fclose(file) == 0);
}

static bool leads_to(const char *folder, const char *file, const char *expected)
{
    bool found;
    const char *path = meso_mesh_path(folder, (int)strlen(folder), file, &found, &arena, &error);
    return strcmp(path, expected) == 0 && found == (access(expected, F_OK) == 0);
}

static void test_blanks(void)
{
    CHECK(leads_to("in", "knob.obj", "in/knob.obj") && leads_to("in/", "knob.obj \t", "in/knob.obj"));
    CHECK(leads_to("in", "blank.obj ", "in/blank.obj ") && leads_to("in", "blank.obj", "in/blank.obj"));
    CHECK(leads_to("in", "gone.obj ", "in/gone.obj ") && leads_to("in", "  ", "in/  "));
    CHECK(leads_to("", "in/knob.obj", "in/knob.obj") && leads_to("in", "/dev/null", "/dev/null"));
}

static const char *moved(const char *file, const char *from, const char *to)
{
    MesoInnerMesh inner = {.file = file};
    MesoTileSet set = {.inner_count = 1, .inners = &inner};
    CHECK(meso_mesh_paths_move(&set, from, to, &arena, &error) == MESO_OK);
    return inner.file;
}

static bool moves(const char *file, const char *from, const char *to, const char *expected)
{
    const char *name = moved(file, from, to);
    if (strcmp(name, expected) != 0)
        fprintf(stderr, "%s\n", name);
    return strcmp(name, expected) == 0;
}

static void test_moves(void)
{
    CHECK(moves("knob.obj", "in/t.json", "out/deep/t.json", "../../in/knob.obj"));
    CHECK(moves("knob.obj ", "in/t.json", "t.json", "in/knob.obj "));
    CHECK(moves("in/knob.obj", "t.json", "in/t.json", "../in/knob.obj"));
    CHECK(moves("../in/knob.obj", "out/t.json", "out/deep/t.json", "../../in/knob.obj"));
    CHECK(moves("knob.obj", "in/t.json", "inner/t.json", "../in/knob.obj"));
    CHECK(moves("knob.obj", "link/t.json", "in/u.json", "knob.obj"));
    CHECK(moves("knob.obj", "in/t.json", "out/link/t.json", "../../in/knob.obj"));

    CHECK(moves("gone.obj", "in/t.json", "out/t.json", "gone.obj"));
    CHECK(moves("/dev/null", "in/t.json", "out/t.json", "/dev/null") && moves("", "in/t.json", "out/t.json", ""));
    CHECK(moves("in/knob.obj", "-", "out/t.json", "in/knob.obj") && moves("knob.obj", "in/t.json", "-", "knob.obj"));
    CHECK(moves("knob.obj", "in/t.json", "missing/t.json", "knob.obj"));
}

int main(void)
{
    meso_arena_init(&arena);
    char folder[] = "mesh-path-XXXXXX";
    CHECK(mkdtemp(folder) && chdir(folder) == 0);
    CHECK(mkdir("in", 0777) == 0 && mkdir("inner", 0777) == 0 && mkdir("out", 0777) == 0 &&
          mkdir("out/deep", 0777) == 0);
    CHECK(symlink("in", "link") == 0 && symlink("deep", "out/link") == 0);
    touch("in/knob.obj");
    touch("in/blank.obj ");
    touch("in/blank.obj");
    test_blanks();
    test_moves();
    CHECK(unlink("in/knob.obj") == 0 && unlink("in/blank.obj ") == 0 && unlink("in/blank.obj") == 0);
    CHECK(unlink("link") == 0 && unlink("out/link") == 0 && rmdir("out/deep") == 0 && rmdir("out") == 0);
    CHECK(rmdir("in") == 0 && rmdir("inner") == 0 && chdir("..") == 0 && rmdir(folder) == 0);
    meso_arena_release(&arena);
    return 0;
}
