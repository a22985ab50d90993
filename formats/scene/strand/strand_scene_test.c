/*
 * Strands made over: numbers of all parts; caps that start with the ring that
 * they close, to the bit; meshes that are closed but for open ends, wound
 * outward, and hold what their sweeps held.
 */
#include "formats/scene/strand/strand_scene.h"

#include <stdlib.h>
#include <string.h>

#include "formats/scene/scene_fixture.h"

enum { N = 4 };

static void test_numbers(SceneFixture *f)
{
    MesoScene scene, again;
    MesoStrands s;
    CHECK(meso_strands_find(&s, &f->arena, &f->scene, NULL) == MESO_OK);
    CHECK(meso_strand_scene_number(&scene, &f->arena, &f->scene, &s, NULL) == MESO_OK);
    CHECK(scene.channel_count == 3 && strcmp(scene.channels[2].name, "strand") == 0);
    CHECK(scene.channels[2].count == s.count + 1);
    for (uint32_t i = 0; i < scene.sweep_count; i++) {
        CHECK(meso_scene_id(&scene, scene.sweeps[i].ids, 2) == s.of_sweep[i]);
        for (uint32_t c = 0; c < 2; c++)
            CHECK(meso_scene_id(&scene, scene.sweeps[i].ids, c) == meso_scene_id(&f->scene, f->scene.sweeps[i].ids, c));
    }
    for (uint32_t i = 0; i < scene.placed_count; i++)
        CHECK(meso_scene_id(&scene, scene.placed[i].ids, 2) == s.count);
    CHECK(meso_strand_scene_number(&again, &f->arena, &scene, &s, NULL) == MESO_OK && again.channel_count == 3);
}

/* ---- borders of welded bodies ---- */

typedef struct Edge {
    uint32_t from, to;
} Edge;

static int compare_edges(const void *x, const void *y)
{
    const Edge *a = x, *b = y;
    return a->from != b->from ? (a->from > b->from) - (a->from < b->from) : (a->to > b->to) - (a->to < b->to);
}

/* Directed edges without one the other way; none may be there twice. Six times the volume around the origin too. */
static uint32_t border_of(const MesoBody *body, double *volume)
{
    Edge *edges = malloc(4 * (size_t)body->face_count * sizeof *edges);
    uint32_t count = 0, border = 0;
    CHECK(edges);
    for (uint32_t f = 0; f < body->face_count; f++) {
        const uint32_t *v = body->corners + 4 * (size_t)f, corners = v[3] == MESO_NO_INDEX ? 3 : 4;
        for (uint32_t k = 0; k < corners; k++)
            edges[count++] = (Edge){v[k], v[(k + 1) % corners]};
        for (uint32_t k = 2; k < corners; k++)
            *volume += (double)meso_vec3_dot(body->positions[v[0]], meso_vec3_cross(body->positions[v[k - 1]],
                                                                                     body->positions[v[k]]));
    }
    qsort(edges, count, sizeof *edges, compare_edges);
    for (uint32_t i = 0; i < count; i++) {
        Edge other = {edges[i].to, edges[i].from};
        CHECK(i == 0 || compare_edges(&edges[i], &edges[i - 1]) != 0);
        border += bsearch(&other, edges, count, sizeof *edges, compare_edges) == NULL;
    }
    free(edges);
    return border;
}

static void check_body(const MesoBody *body)
{
    for (uint32_t v = 0; v < body->vertex_count; v++)
        CHECK(fabsf(meso_vec3_length(body->normals[v]) - 1) < 1e-5f);
    for (uint32_t f = 0; f < body->face_count; f++)
        for (uint32_t k = 0; k < 4; k++)
            CHECK(body->corners[4 * (size_t)f + k] < body->vertex_count ||
                  (k == 3 && body->corners[4 * (size_t)f + 3] == MESO_NO_INDEX));
}

/* The sum of all, and how many are open. */
static double weld(SceneFixture *f, const MesoScene *scene, uint32_t *open)
{
    MesoScene welded, again;
    MesoStrands s;
    double volume = 0;
    CHECK(meso_strands_find(&s, &f->arena, scene, NULL) == MESO_OK);
    CHECK(meso_strand_scene_weld(&welded, &f->arena, scene, &s, 2, NULL) == MESO_OK);
    CHECK(meso_strand_scene_weld(&again, &f->arena, scene, &s, 1, NULL) == MESO_OK);
    CHECK(welded.sweep_count == 0 && welded.placed_count == s.count + scene->placed_count);
    *open = 0;
    for (uint32_t i = 0; i < s.count; i++) {
        const MesoBody *body = &welded.bodies[i], *same = &again.bodies[i];
        CHECK(meso_scene_id(&welded, welded.placed[i].ids, 0) == i);
        CHECK(body->vertex_count == same->vertex_count && body->face_count == same->face_count);
        CHECK(memcmp(body->positions, same->positions, body->vertex_count * sizeof *body->positions) == 0);
        check_body(body);
        *open += border_of(body, &volume) > 0;
    }
    return volume / 6;
}

/* Strands go from border to border, and caps of studs lie at borders by themselves; with caps, nothing is open. */
static void test_welds(SceneFixture *f)
{
    MesoScene capped;
    uint32_t open, closed;
    double before = weld(f, &f->scene, &open);
    CHECK(open > 0);
    CHECK(meso_strand_scene_cap(&capped, &f->arena, &f->scene, NULL) == MESO_OK);
    CHECK(capped.sweep_count > f->scene.sweep_count);
    double after = weld(f, &capped, &closed);
    CHECK(closed == 0 && after > 0 && fabs(after - before) < 0.5 * after);
}

/* The first ring of a cap is the last of what it closes: the strand is found through it, and no vertex is new there. */
static void test_caps(SceneFixture *f)
{
    MesoScene capped;
    MesoStrands before, after;
    CHECK(meso_strand_scene_cap(&capped, &f->arena, &f->scene, NULL) == MESO_OK);
    CHECK(meso_strands_find(&before, &f->arena, &f->scene, NULL) == MESO_OK);
    CHECK(meso_strands_find(&after, &f->arena, &capped, NULL) == MESO_OK);
    CHECK(after.count == before.count);
    for (uint32_t i = 0; i < f->scene.sweep_count; i++)
        CHECK(memcmp(&capped.sweeps[i], &f->scene.sweeps[i], sizeof *capped.sweeps) == 0);
    for (uint32_t s = 0; s < after.count; s++) {
        uint32_t last = after.pieces[after.begin[s + 1] - 1].sweep, first = after.pieces[after.begin[s]].sweep;
        if (after.begin[s + 1] - after.begin[s] == N + 2)
            CHECK(capped.kinds[meso_scene_kind(&capped, first)].cap &&
                  capped.kinds[meso_scene_kind(&capped, last)].cap);
    }
}

int main(void)
{
    SceneFixture fixture;
    scene_fixture_init(&fixture, N, 6, 0.05f);
    test_numbers(&fixture);
    test_caps(&fixture);
    test_welds(&fixture);
    scene_fixture_release(&fixture);
    return 0;
}
