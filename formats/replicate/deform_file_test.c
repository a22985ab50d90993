/* Files of deformations: what they say, what they leave out, and what is said of wrong ones. */
#include "formats/replicate/deform_file.h"

#include <math.h>

#include "libcore/base/check.h"

static MesoArena arena;
static MesoError error;
static MesoDeformFile file;

/* 4 x 2 x 1 */
static const MesoVec3 box[] = {{0, 0, 0}, {4, 2, 1}};

static MesoStatus read(const char *steps)
{
    MesoInput input;
    const char *text = meso_arena_print(&arena, NULL, "{\"format\": \"meso-deform\", \"version\": 1, \"steps\": [%s]}",
                                        steps);
    meso_input_wrap(&input, "d.json", text, strlen(text));
    return meso_deform_read(&file, &arena, &input, box, 2, &error);
}

static const MesoDeformStep *step(const char *text)
{
    MesoStatus status = read(text);
    if (status)
        fprintf(stderr, "%s\n", error.message);
    CHECK(status == MESO_OK && file.step_count == 1);
    return &file.steps[0];
}

static void bad(const char *text, const char *message)
{
    CHECK(read(text) == MESO_ERR_INPUT);
    CHECK_TEXT(error.message, message);
}

static bool is(MesoVec3 v, float x, float y, float z)
{
    return fabsf(v.x - x) < 1e-6f && fabsf(v.y - y) < 1e-6f && fabsf(v.z - z) < 1e-6f;
}

static void test_steps(void)
{
    const MesoDeformStep *s = step("{\"stretch\": {}}");
    CHECK(s->kind == MESO_DEFORM_STRETCH && is(s->axis, 1, 0, 0) && s->amount == 2 && !s->centered);
    CHECK(s->key_count == 0);
    s = step("{\"stretch\": {\"axis\": [0, 3, 4], \"factor\": 3, \"center\": [0, 0, 0], \"keys\": [[0, 1], [1, 0]]}}");
    CHECK(is(s->axis, 0, 0.6f, 0.8f) && s->amount == 3 && s->centered && s->key_count == 2 && s->keys[0].share == 1);
    CHECK(fabsf(meso_vec3_dot(s->axis, s->up)) < 1e-6f);
    CHECK(step("{\"scale\": {\"factor\": 0.5}}")->amount == 0.5f);
    s = step("{\"twist\": {\"axis\": \"z\", \"degrees\": -90}}");
    CHECK(s->kind == MESO_DEFORM_TWIST && is(s->axis, 0, 0, 1) && fabsf(s->amount + 1.5707964f) < 1e-6f);
    CHECK(fabsf(meso_vec3_dot(s->axis, s->up)) < 1e-6f && fabsf(meso_vec3_length(s->up) - 1) < 1e-6f);
    s = step("{\"bend\": {\"axis\": \"y\", \"up\": [1, 1, 0]}}");
    CHECK(s->kind == MESO_DEFORM_BEND && is(s->axis, 0, 1, 0) && is(s->up, 1, 0, 0));
    s = step("{\"inflate\": {\"center\": [4, 1, 1], \"radius\": 2, \"by\": 0.5}}");
    CHECK(s->kind == MESO_DEFORM_INFLATE && is(s->center, 4, 1, 1) && s->radius == 2 && s->amount == 0.5f);
    CHECK(read("{\"twist\": {}}, {\"bend\": {}, \"comment\": 1}") == MESO_OK && file.step_count == 2);
    CHECK(file.steps[1].kind == MESO_DEFORM_BEND);
}

static void test_wrong(void)
{
    bad("", "d.json: steps: 0 items; from 1 to 1024 are possible");
    bad("{}", "d.json: steps[0]: a deformation is needed here");
    bad("{\"strech\": {}}", "d.json: steps[0]: no deformation 'strech'; did you mean 'stretch'?");
    bad("{\"stretch\": {}, \"bend\": {}}", "d.json: steps[0]: \"stretch\" and \"bend\": a step has one deformation");
    bad("{\"twist\": {\"factor\": 2}}", "d.json: steps[0].twist: unknown key \"factor\"; there are \"axis\", "
        "\"degrees\", \"center\", \"keys\"");
    bad("{\"bend\": {\"axis\": \"x\", \"up\": \"x\"}}", "d.json: steps[0].bend.up: it runs along the axis");
    bad("{\"bend\": {\"axis\": [0, 0, 0]}}", "d.json: steps[0].bend.axis: [0, 0, 0] is no direction");
    bad("{\"bend\": {\"axis\": \"w\"}}", "d.json: steps[0].bend.axis: no axis 'w'; there are \"x\", \"y\", \"z\"");
    bad("{\"scale\": {\"factor\": 0}}", "d.json: steps[0].scale.factor: 0; it must be between 0 and 1e+06");
    bad("{\"scale\": {\"keys\": [[0.5, 0], [0.5, 1]]}}", "d.json: steps[0].scale.keys[1][0]: 0.5 does not come after "
        "0.5");
    bad("{\"scale\": {\"keys\": [[2, 0]]}}", "d.json: steps[0].scale.keys[0][0]: 2; it must be from 0 to 1");
    bad("{\"scale\": {\"keys\": []}}", "d.json: steps[0].scale.keys: 0 items; from 1 to 65536 are possible");
}

int main(void)
{
    meso_arena_init(&arena);
    test_steps();
    test_wrong();
    meso_arena_release(&arena);
    return 0;
}
