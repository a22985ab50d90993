/* Steps one after the other: what came before goes, and what comes of it is whole. */
#include "cmd/mesh/mesh_steps.h"

#include "libcore/mesh/edit/mesh_fixture.h"

static void work_init(MesoMeshWork *work, MesoTool *tool)
{
    *tool = (MesoTool){.quiet = true, .json = "", .threads = 1};
    *work = (MesoMeshWork){.tool = tool, .crease = MESO_NO_CREASE, .infos = json_array()};
    work->mesh = make_torus(&work->arena, 12, 9, NULL);
    add_attributes(&work->mesh, &work->arena);
}

static void work_end(MesoMeshWork *work)
{
    json_decref(work->infos);
    meso_mesh_work_release(work);
    CHECK(work->tool->arena.used == 0);
}

static void run(MesoMeshWork *work, const char *text)
{
    MesoMeshStep step;
    MesoError *error = &work->tool->error;
    CHECK(meso_mesh_step_parse(&step, text, error) == MESO_OK && meso_mesh_step_run(&step, work) == MESO_OK);
    CHECK(is_checked(&work->mesh));
}

/* Any number of steps takes as much as one. */
static void test_memory(void)
{
    MesoTool tool;
    MesoMeshWork work;
    static const char *const texts[] = {"weld", "clean", "separate", "orient", "info", "convert"};
    work_init(&work, &tool);
    run(&work, "orient");
    size_t used = work.arena.used;
    for (uint32_t i = 0; i < 30; i++)
        run(&work, texts[i % 6]);
    CHECK(work.arena.used == used && work.next.used == 0);
    check_attributes(&work.mesh, 108);
    work_end(&work);
}

/* A step that fails leaves the mesh of the one before. */
static void test_failure(void)
{
    MesoTool tool;
    MesoMeshWork work;
    MesoMeshStep step;
    work_init(&work, &tool);
    run(&work, "weld");
    CHECK(meso_mesh_step_parse(&step, "subdivide=loop", &tool.error) == MESO_OK);
    CHECK(meso_mesh_step_run(&step, &work) == MESO_ERR_INPUT &&
          strncmp(tool.error.message, "subdivide=loop: ", 16) == 0);
    CHECK(work.mesh.face_count == 108 && is_checked(&work.mesh));
    run(&work, "triangulate");
    run(&work, "subdivide=linear,2");
    run(&work, "decimate=50%");
    CHECK(work.mesh.face_count <= 1728 && work.mesh.face_count >= 1726);
    check_attributes(&work.mesh, 108);
    work_end(&work);
}

int main(void)
{
    test_memory();
    test_failure();
    return 0;
}
