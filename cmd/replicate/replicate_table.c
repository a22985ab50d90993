#include "cmd/replicate/replicate_table.h"

#include <stdlib.h>
#include <string.h>

#include "formats/json/json_text.h"

/* Pairs are counted up to so many mean distances. */
static const double REACH = 4;

/* ---- frames ---- */

/* Those that have a size; but frame by frame those that live: the newborn, too, and none that shrinks. */
static uint32_t count_points(MesoReplicateTable *table, const MesoReplicateRun *r)
{
    uint32_t shown = 0, count = r->count;
    const MesoDetailFate *fates = r->way == MESO_WAY_PLAY ? NULL : meso_replicate_fates(r->replication);
    if (fates)
        meso_replicate_details(r->replication, &count);
    for (uint32_t i = 0; i < count; i++)
        if (fates ? fates[i].died == MESO_DETAIL_LIVES : r->grown[i] > 0)
            table->points[shown++] = r->details[i].point;
    return shown;
}

/* Distances are in mean ones of each frame: so a surface that has grown is compared with the one it was. */
static MesoStatus correlate(MesoReplicateTable *table, const MesoReplicateRun *r, uint32_t shown, double area)
{
    MesoTool *tool = r->tool;
    const MesoPointSet set = {&r->clip->rest, r->clip->positions, table->points, NULL, shown};
    const MesoPairOptions options = {.radius = REACH * sqrt(area / shown)};
    bool first = json_array_size(table->frames) == 0;
    MesoArenaMark mark = meso_arena_mark(&tool->arena);
    MesoPairCorrelation now;
    MesoStatus status = meso_pair_correlation(first ? &table->first : &now, &tool->arena, &set, &options, &tool->error);
    if (!status && !first && table->first.bin_count)
        table->difference = meso_pair_difference(&table->first, &now);
    if (!first)
        meso_arena_rewind(&tool->arena, mark);
    return status;
}

static void count_changes(const MesoReplicateRun *r, uint32_t *born, uint32_t *died)
{
    uint32_t count = r->count;
    const MesoDetailFate *fates = r->way == MESO_WAY_PLAY ? NULL : meso_replicate_fates(r->replication);
    *born = *died = 0;
    if (fates)
        meso_replicate_details(r->replication, &count);
    for (uint32_t i = 0; i < count; i++) {
        *born += r->details[i].born != MESO_DETAIL_ORIGINAL
                 && (fates ? r->details[i].born : r->lives[i].first) == r->clip->number;
        *died += (fates ? fates[i].died : r->lives[i].died) == r->clip->number;
    }
}

MesoStatus meso_replicate_table_frame(MesoReplicateTable *table, const MesoReplicateRun *r)
{
    if (!table->frames)
        return MESO_OK;
    if (r->count > table->room) {
        table->room = r->count + r->count / 2;
        table->points = MESO_NEW(&r->tool->arena, MesoMeshPoint, table->room, &r->tool->error);
    }
    if (!table->points)
        return MESO_ERR_MEMORY;
    uint32_t born, died, shown = count_points(table, r);
    double area = meso_surface_area(&r->clip->rest, r->clip->positions);
    MesoStatus status = shown > 1 && area > 0 ? correlate(table, r, shown, area) : MESO_OK;
    count_changes(r, &born, &died);
    json_t *frame = json_pack("{s:i, s:I, s:I, s:I, s:o, s:o}", "frame", r->clip->number, "details", (json_int_t)shown,
                              "born", (json_int_t)born, "died", (json_int_t)died, "area",
                              meso_json_shortest((float)area), "density",
                              meso_json_shortest((float)(area > 0 ? shown / area : 0)));
    if (r->replication && r->way != MESO_WAY_PLAY) {
        MesoWebEdges edges = meso_web_edges(meso_replicate_web(r->replication));
        json_object_set_new(frame, "mean_edge", meso_json_shortest((float)edges.mean));
        json_object_set_new(frame, "edge_deviation", meso_json_shortest((float)edges.deviation));
    }
    json_array_append_new(table->frames, frame);
    return status;
}

/* ---- details ---- */

static json_t *number_or_null(int32_t number)
{
    return number == MESO_NEVER ? json_null() : json_integer(number);
}

static json_t *detail_of(const MesoReplicateRun *r, uint32_t i, const char *const *kind_names)
{
    const MesoDetail *d = &r->details[i];
    const MesoReplicaLife *life = &r->lives[i];
    json_t *merged = life->merged == MESO_NO_INDEX ? json_null() : json_integer((json_int_t)life->merged);
    return json_pack("{s:I, s:o, s:I, s:o, s:o, s:o, s:o}", "id", (json_int_t)i, "kind",
                     meso_json_string(kind_names[d->kind]), "copy_of", (json_int_t)d->copied, "born",
                     number_or_null(d->born), "first", number_or_null(life->first), "died", number_or_null(life->died),
                     "merged_into", merged);
}

static json_t *describe(const MesoReplicateTable *table, const MesoReplicateRun *r, const char *const *kind_names)
{
    json_t *root = json_object(), *details = json_array();
    json_object_set_new(root, "format", json_string("meso-replication"));
    json_object_set_new(root, "version", json_integer(1));
    json_object_set_new(root, "provenance", meso_provenance_json(&r->tool->provenance));
    json_object_set_new(root, "mode", json_string(r->arguments->mode));
    json_object_set(root, "frames", table->frames);
    json_object_set_new(root, "pair_correlation_difference", meso_json_shortest((float)table->difference));
    for (uint32_t i = 0; i < r->count; i++)
        json_array_append_new(details, detail_of(r, i, kind_names));
    json_object_set_new(root, "details", details);
    return root;
}

static MesoStatus write(const MesoReplicateTable *table, const MesoReplicateRun *r, const char *const *kind_names)
{
    MesoTool *tool = r->tool;
    MesoOutput *output = NULL;
    json_t *root = describe(table, r, kind_names);
    char *text = json_dumps(root, JSON_INDENT(1) | JSON_REAL_PRECISION(9));
    MesoStatus status = text ? meso_output_open(&output, r->arguments->report, &tool->error)
                             : meso_fail(&tool->error, MESO_ERR_MEMORY, "out of memory for the report");
    if (!status)
        status = meso_output_write(output, text, strlen(text), &tool->error);
    if (!status)
        status = meso_output_write(output, "\n", 1, &tool->error);
    free(text);
    json_decref(root);
    return meso_output_finish(output, status, &tool->error);
}

MesoStatus meso_replicate_table_end(MesoReplicateTable *table, const MesoReplicateRun *r,
                                    const char *const *kind_names, MesoStatus status)
{
    if (table->frames && !status)
        status = write(table, r, kind_names);
    json_decref(table->frames);
    table->frames = NULL;
    return status;
}
