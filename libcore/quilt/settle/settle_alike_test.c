#include <string.h>

#include "libcore/base/check.h"
#include "libcore/mesh/cut/triangulation_fixture.h"
#include "libcore/quilt/settle/settle_work.h"
#include "libcore/quilt/swatch/swatch_make.h"

/* Kinds of a swatch of ours. */
typedef struct Case {
    MesoArena arena;
    MesoSwatch swatch;
    MesoSettleWork work;
} Case;

static void init(Case *c, const char *name)
{
    MesoError error;
    MesoPolygonMesh mesh;
    const MesoSwatchRecipe recipe = {.name = name, .jitter = 0.05f};
    *c = (Case){0};
    meso_arena_init(&c->arena);
    CHECK(meso_swatch_make(&mesh, &c->arena, &recipe, &error) == MESO_OK);
    CHECK(meso_swatch_build(&c->swatch, &c->arena, &mesh, &(MesoSwatchOptions){.up = 2}, &error) == MESO_OK);
    c->work = (MesoSettleWork){.swatch = &c->swatch, .options = {.scale = 1, .height_scale = 1}, .alone = true,
                               .arena = &c->arena};
    CHECK(meso_settle_find_kinds(&c->work, &error) == MESO_OK);
}

static uint32_t count_likenesses(const Case *c)
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < c->work.kind_count; k++)
        count += c->work.kinds[k].likeness == k;
    return count;
}

/* Rows lean to the one side and to the other; those at the sides have around them what all have. */
static void test_mail(void)
{
    Case c;
    init(&c, "mail");
    const MesoSettleWork *w = &c.work;
    CHECK(w->linked && !w->fixed && count_likenesses(&c) == 2);
    for (uint32_t k = 0; k < w->kind_count; k++) {
        const MesoSettleKind *kind = &w->kinds[k];
        CHECK(kind->relation_end - kind->relation_begin == 6);
        for (uint32_t r = kind->relation_begin; r < kind->relation_end; r++) {
            bool same = w->kinds[w->relations[r].kind].likeness == kind->likeness;
            CHECK(same == (fabsf(w->relations[r].offset.x) < 0.25f));   /* of its own column */
        }
    }
    meso_arena_release(&c.arena);
}

/* However they are turned, nuts are alike: six around each, about one pitch away. */
static void test_nuts(void)
{
    Case c;
    init(&c, "nuts");
    CHECK(!c.work.linked && count_likenesses(&c) == 1);
    for (uint32_t k = 0; k < c.work.kind_count; k++) {
        CHECK(c.work.kinds[k].relation_end - c.work.kinds[k].relation_begin == 6);
        for (uint32_t r = c.work.kinds[k].relation_begin; r < c.work.kinds[k].relation_end; r++)
            CHECK(fabsf(meso_vec3_length(c.work.relations[r].offset) - 1) < 0.15f);
    }
    meso_arena_release(&c.arena);
}

/* A ring that is turned by half is like those that lean to the other side. */
static void test_turned(void)
{
    Case c;
    init(&c, "mail");
    const MesoPose axes = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}};
    MesoSettleBody body = {.kind = 0, .pose = axes};
    body.pose.x.x = body.pose.y.y = -1;
    MesoSettleSpread spread = meso_settle_spread(&c.work, &body, &axes);
    for (uint32_t k = 0; k < c.work.kind_count; k++)
        CHECK(meso_settle_alike(&spread, &c.work.kinds[k].spread) == (c.work.kinds[k].likeness != 0));
    meso_arena_release(&c.arena);
}

int main(void)
{
    test_mail();
    test_nuts();
    test_turned();
    return 0;
}
