#include "formats/replicate/replica_file.h"

#include <stddef.h>
#include <string.h>
#include <xxhash.h>

enum { MINOR = 0 };

static const char STATE[] = "state", PLAN[] = "plan";

typedef struct StoredHead {
    uint32_t steps, nodes, triangles, near, frames, vertices, mergings, reserved;
    double power;
    int64_t last;
} StoredHead;

_Static_assert(sizeof(StoredHead) == 48 && sizeof(MesoReplicaPair) == 12 && sizeof(MesoReplicaRoom) == 12 &&
               sizeof(MesoDetail) == 48 &&
               sizeof(MesoNeighbour) == 8 && sizeof(MesoReplicaLife) == 12 && sizeof(MesoReplicaSettings) == 64 &&
               sizeof(MesoReplicaMark) == 32 && sizeof(MesoDetailFate) == 8, "layout of the chunks");

/* ---- marks ---- */

static void take_hash(XXH128_hash_t hash, uint64_t out[2])
{
    out[0] = hash.high64;
    out[1] = hash.low64;
}

/* What the run has found out of an original is not part of it. */
MesoReplicaMark meso_replica_mark(const MesoTriangulation *rest, const MesoDetail *originals, uint32_t count)
{
    MesoReplicaMark mark;
    XXH128_hash_t hash = XXH3_128bits(rest->positions, rest->vertex_count * sizeof *rest->positions);
    take_hash(XXH3_128bits_withSeed(rest->corners, 3 * (size_t)rest->triangle_count * sizeof *rest->corners,
                                    hash.high64 ^ hash.low64), mark.surface);
    hash = (XXH128_hash_t){0, count};
    for (uint32_t i = 0; i < count; i++)
        hash = XXH3_128bits_withSeed(&originals[i], offsetof(MesoDetail, copied), hash.high64 ^ hash.low64);
    take_hash(hash, mark.details);
    return mark;
}

MesoStatus meso_replica_compare(const char *path, const MesoReplicaMark *mark, const MesoReplicaSettings *settings,
                                const MesoReplicaMark *wanted, const MesoReplicaSettings *o, MesoError *error)
{
    const char *other = memcmp(mark->surface, wanted->surface, sizeof mark->surface) != 0 ? "of another surface"
        : settings->seed != o->seed         ? "of another --seed"
        : memcmp(mark->details, wanted->details, sizeof mark->details) != 0 ? "of other details"
        : settings->mode != o->mode         ? "of another --mode"
        : settings->substeps != o->substeps ? "of other --substeps"
        : settings->alpha != o->alpha       ? "of another --alpha"
        : settings->births != o->births     ? "of other --births"
        : settings->beta != o->beta         ? "of another --beta"
        : settings->gamma != o->gamma       ? "of another --gamma"
        : settings->mu != o->mu             ? "of another --mu"
        : settings->ramp != o->ramp         ? "of another --ramp" : NULL;
    return other ? meso_fail(error, MESO_ERR_INPUT, "%s: it is %s", path, other) : MESO_OK;
}

/* ---- writing ---- */

static void add_shared(MesoContainer *c, const char *provenance, const MesoReplicaMark *mark,
                       const MesoReplicaSettings *settings, const MesoDetail *details, uint32_t count)
{
    meso_container_add(c, "prov", provenance, strlen(provenance));
    meso_container_add(c, "mark", mark, sizeof *mark);
    meso_container_add(c, "setting", settings, sizeof *settings);
    meso_container_add(c, "detail", details, count * sizeof *details);
}

MesoStatus meso_replica_state_write(const MesoReplicaStateFile *f, const MesoProvenance *provenance,
                                    MesoOutput *output, MesoError *error)
{
    const MesoReplicaState *s = &f->state;
    const uint64_t n = s->detail_count, index = sizeof(uint32_t);
    const StoredHead head = {s->step_count, s->node_count, s->triangle_count, s->near_begin[n], f->history_count,
                             f->vertex_count, s->merging_count, 0, s->power, s->last_frame};
    MesoContainer c = {.major = MESO_REPLICA_MAJOR, .minor = MINOR};
    MesoArena arena;
    meso_arena_init(&arena);
    const char *text = meso_provenance_text(provenance, &arena, error);
    memcpy(c.kind, STATE, sizeof STATE);
    MesoStatus status = text ? MESO_OK : MESO_ERR_MEMORY;
    if (!status) {
        add_shared(&c, text, &f->mark, &f->settings, s->details, s->detail_count);
        meso_container_add(&c, "head", &head, sizeof head);
        meso_container_add(&c, "block", s->blocks, n * index);
        meso_container_add(&c, "nearbeg", s->near_begin, (n + 1) * index);
        meso_container_add(&c, "near", s->near, head.near * sizeof *s->near);
        meso_container_add(&c, "node", s->node_corner, head.nodes * index);
        meso_container_add(&c, "corner", s->corners, 3 * index * head.triangles);
        meso_container_add(&c, "twin", s->twins, 3 * index * head.triangles);
        meso_container_add(&c, "grown", s->grown, n * sizeof *s->grown);
        meso_container_add(&c, "fate", s->fates, n * sizeof *s->fates);
        meso_container_add(&c, "merging", s->mergings, head.mergings * sizeof *s->mergings);
        meso_container_add(&c, "life", f->lives, n * sizeof *f->lives);
        meso_container_add(&c, "frames", f->history, f->history_count * sizeof *f->history);
        meso_container_add(&c, "places", f->positions, f->vertex_count * sizeof *f->positions);
        status = meso_container_write(&c, output, error);
    }
    meso_arena_release(&arena);
    return status;
}

MesoStatus meso_replica_plan_write(const MesoReplicaPlanFile *f, const MesoProvenance *provenance,
                                   MesoOutput *output, MesoError *error)
{
    const MesoReplicaPlan *plan = &f->plan;
    const uint32_t n = plan->detail_count, count = plan->pair_begin[n];
    MesoContainer c = {.major = MESO_REPLICA_MAJOR, .minor = MINOR};
    MesoArena arena;
    meso_arena_init(&arena);
    const char *text = meso_provenance_text(provenance, &arena, error);
    memcpy(c.kind, PLAN, sizeof PLAN);
    MesoStatus status = text ? MESO_OK : MESO_ERR_MEMORY;
    if (!status) {
        add_shared(&c, text, &f->mark, &f->settings, plan->details, n);
        meso_container_add(&c, "pairbeg", plan->pair_begin, ((uint64_t)n + 1) * sizeof *plan->pair_begin);
        meso_container_add(&c, "pair", plan->pairs, count * sizeof *plan->pairs);
        meso_container_add(&c, "room", plan->rooms, n * sizeof *plan->rooms);
        status = meso_container_write(&c, output, error);
    }
    meso_arena_release(&arena);
    return status;
}

/* ---- reading ---- */

typedef struct Reading {
    MesoContainer container;
    MesoArena *arena;
    const char *path;
    MesoError *error;
} Reading;

/* A copy of a chunk of `count` elements; NULL, with the error filled, where it is not there. */
static void *take(const Reading *in, const char *name, uint64_t count, uint64_t size)
{
    const void *data = meso_container_require(&in->container, in->path, name, count, size, in->error);
    void *copy = data ? meso_arena_alloc(in->arena, count, size, in->error) : NULL;
    return copy && count ? memcpy(copy, data, count * size) : copy;
}

static MesoStatus take_into(const Reading *in, const char *name, void *out, size_t size)
{
    const void *data = meso_container_require(&in->container, in->path, name, 1, size, in->error);
    if (!data)
        return in->error->status;
    memcpy(out, data, size);
    return MESO_OK;
}

static MesoStatus fail(const Reading *in, const char *name)
{
    return meso_fail(in->error, MESO_ERR_INPUT, "%s: chunk '%s' is broken", in->path, name);
}

static MesoStatus take_details(const Reading *in, MesoDetail **details, uint32_t *count)
{
    uint64_t size = 0;
    if (!meso_container_require(&in->container, in->path, "detail", 0, 0, in->error))
        return in->error->status;
    meso_container_find(&in->container, "detail", &size);
    if (size % sizeof **details != 0 || size / sizeof **details >= MESO_REPLICA_MOST || size == 0)
        return fail(in, "detail");
    *count = (uint32_t)(size / sizeof **details);
    MesoDetail *all = *details = take(in, "detail", *count, sizeof **details);
    if (!all)
        return in->error->status;
    for (uint32_t i = 0; i < *count; i++) {
        const float *w = all[i].point.weight;
        if (!(w[0] >= 0 && w[1] >= 0 && w[2] >= 0 && fabsf(w[0] + w[1] + w[2] - 1) < 1e-3f) ||
            !isfinite(all[i].angle) || !(all[i].size > 0 && all[i].size <= 1e18f) ||
            !(all[i].width > 0 && all[i].width <= 1e20f))
            return fail(in, "detail");
    }
    return MESO_OK;
}

static MesoStatus begin(Reading *in, const char *kind, const MesoInput *input, MesoReplicaMark *mark,
                        MesoReplicaSettings *settings)
{
    MesoStatus status = meso_container_read(&in->container, input, kind, MESO_REPLICA_MAJOR, in->error);
    if (!status && !meso_container_require(&in->container, in->path, "prov", 0, 0, in->error))
        status = in->error->status;
    if (!status)
        status = take_into(in, "mark", mark, sizeof *mark);
    return status ? status : take_into(in, "setting", settings, sizeof *settings);
}

/* From 0 up to `end`, never less than before. */
static MesoStatus check_ranges(const Reading *in, const char *name, const uint32_t *begin, uint32_t count,
                               uint64_t end)
{
    bool good = begin[0] == 0 && begin[count] == end;
    for (uint32_t i = 0; i < count && good; i++)
        good = begin[i] <= begin[i + 1];
    return good ? MESO_OK : fail(in, name);
}

static MesoStatus take_web(const Reading *in, MesoReplicaState *s)
{
    if (!(s->node_corner = take(in, "node", s->node_count, sizeof(uint32_t))) ||
        !(s->corners = take(in, "corner", s->triangle_count, 3 * sizeof(uint32_t))) ||
        !(s->twins = take(in, "twin", s->triangle_count, 3 * sizeof(uint32_t))))
        return in->error->status;
    return s->triangle_count < UINT32_MAX / 3 ? MESO_OK : fail(in, "corner");
}

static MesoStatus take_lists(const Reading *in, MesoReplicaStateFile *f, uint32_t near_count)
{
    MesoReplicaState *s = &f->state;
    const uint64_t n = s->detail_count;
    if (!(s->blocks = take(in, "block", n, sizeof *s->blocks)) ||
        !(s->near_begin = take(in, "nearbeg", n + 1, sizeof *s->near_begin)) ||
        !(s->near = take(in, "near", near_count, sizeof *s->near)) ||
        !(s->grown = take(in, "grown", n, sizeof *s->grown)) || !(s->fates = take(in, "fate", n, sizeof *s->fates)) ||
        !(s->mergings = take(in, "merging", s->merging_count, sizeof *s->mergings)) ||
        !(f->lives = take(in, "life", n, sizeof *f->lives)) ||
        !(f->history = take(in, "frames", f->history_count, sizeof *f->history)) ||
        !(f->positions = take(in, "places", f->vertex_count, sizeof *f->positions)))
        return in->error->status;
    return check_ranges(in, "nearbeg", s->near_begin, s->detail_count, near_count);
}

static MesoStatus check_values(const Reading *in, const MesoReplicaStateFile *f)
{
    for (uint32_t i = 0; i < f->state.detail_count; i++) {
        if (!(f->state.grown[i] >= 0 && f->state.grown[i] <= 1))
            return fail(in, "grown");
        if (f->lives[i].merged >= f->state.detail_count && f->lives[i].merged != MESO_NO_INDEX)
            return fail(in, "life");
    }
    for (uint32_t v = 0; v < f->vertex_count; v++)
        if (!meso_vec3_finite(f->positions[v]))
            return fail(in, "places");
    for (uint32_t i = 0; i < f->history_count; i++)
        if (f->history[i] < 0)
            return fail(in, "frames");
    return f->history_count ? MESO_OK : fail(in, "frames");
}

MesoStatus meso_replica_state_read(MesoReplicaStateFile *f, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    Reading in = {.arena = arena, .path = input->path, .error = error};
    StoredHead head;
    MesoDetail *details = NULL;
    *f = (MesoReplicaStateFile){0};
    MesoStatus status = begin(&in, STATE, input, &f->mark, &f->settings);
    if (!status)
        status = take_into(&in, "head", &head, sizeof head);
    if (!status)
        status = take_details(&in, &details, &f->state.detail_count);
    if (status)
        return status;
    f->state.step_count = head.steps;
    f->state.power = head.power;
    f->state.last_frame = head.last;
    f->state.merging_count = head.mergings;
    f->state.details = details;
    f->state.node_count = head.nodes;
    f->state.triangle_count = head.triangles;
    f->history_count = head.frames;
    f->vertex_count = head.vertices;
    status = take_lists(&in, f, head.near);
    if (!status)
        status = take_web(&in, &f->state);
    return status ? status : check_values(&in, f);
}

MesoStatus meso_replica_plan_read(MesoReplicaPlanFile *f, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    Reading in = {.arena = arena, .path = input->path, .error = error};
    MesoReplicaPlan *plan = &f->plan;
    uint64_t size = 0;
    *f = (MesoReplicaPlanFile){0};
    MesoStatus status = begin(&in, PLAN, input, &f->mark, &f->settings);
    if (!status)
        status = take_details(&in, &plan->details, &plan->detail_count);
    if (status)
        return status;
    if (!(plan->pair_begin = take(&in, "pairbeg", (uint64_t)plan->detail_count + 1, sizeof *plan->pair_begin)))
        return error->status;
    if (!meso_container_require(&in.container, in.path, "pair", 0, 0, error))
        return error->status;
    meso_container_find(&in.container, "pair", &size);
    uint64_t count = size / sizeof *plan->pairs;
    if (size % sizeof *plan->pairs != 0)
        return fail(&in, "pair");
    if (!(plan->pairs = take(&in, "pair", count, sizeof *plan->pairs)) ||
        !(plan->rooms = take(&in, "room", plan->detail_count, sizeof *plan->rooms)))
        return error->status;
    return check_ranges(&in, "pairbeg", plan->pair_begin, plan->detail_count, count);
}

static bool is_kind(const MesoInput *input, const char *kind, size_t size)
{
    enum { KIND_AT = 8 };
    return meso_container_recognise(input) && input->size >= KIND_AT + MESO_CHUNK_NAME &&
           memcmp((const char *)input->data + KIND_AT, kind, size) == 0;
}

bool meso_replica_is_state(const MesoInput *input) { return is_kind(input, STATE, sizeof STATE); }
bool meso_replica_is_plan(const MesoInput *input) { return is_kind(input, PLAN, sizeof PLAN); }
