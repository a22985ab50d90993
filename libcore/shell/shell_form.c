#include "libcore/shell/shell_form.h"

#include <math.h>

#include "libcore/base/disjoint_sets.h"

const char *const meso_shell_normals_names[] = {"file", "smooth", "flat", NULL};
const char *const meso_shell_side_names[] = {"outside", "both", "inside", NULL};

/* ---- normals ---- */

/* Twice the area vector of a face: the cross product of its diagonals. */
static MesoVec3 face_area(const MesoQuadMesh *mesh, uint32_t face)
{
    const uint32_t *v = mesh->face_vertices + 4 * (size_t)face;
    return meso_vec3_cross(meso_vec3_sub(mesh->positions[v[2]], mesh->positions[v[0]]),
                           meso_vec3_sub(mesh->positions[v[3]], mesh->positions[v[1]]));
}

/* 1, or -1 for a face that its normals in the file look into: what is made anew looks to the same side. */
static float side_of(const MesoQuadMesh *mesh, uint32_t face, MesoVec3 area)
{
    float along = 0;
    for (uint32_t i = 0; i < 4; i++)
        along += meso_vec3_dot(mesh->normals[mesh->face_normals[4 * (size_t)face + i]], area);
    return along < 0 ? -1 : 1;
}

static MesoStatus make_normals(MesoShell *shell, MesoArena *arena, bool flat, MesoError *error)
{
    const MesoQuadMesh *mesh = shell->mesh;
    uint32_t count = flat ? mesh->face_count : mesh->vertex_count;
    MesoVec3 *normals = MESO_NEW(arena, MesoVec3, count, error);
    uint32_t *face_normals = flat ? MESO_NEW(arena, uint32_t, 4 * (size_t)count, error) : mesh->face_vertices;
    if (!normals || !face_normals)
        return MESO_ERR_MEMORY;
    for (uint32_t f = 0; f < mesh->face_count; f++) {
        MesoVec3 area = face_area(mesh, f);
        area = meso_vec3_scale(area, side_of(mesh, f, area));
        for (uint32_t i = 0; i < 4; i++) {
            size_t corner = 4 * (size_t)f + i;
            if (flat)
                face_normals[corner] = f;
            MesoVec3 *sum = &normals[face_normals[corner]];
            *sum = flat ? area : meso_vec3_add(*sum, area);
        }
    }
    for (uint32_t n = 0; n < count; n++)
        normals[n] = meso_vec3_unit(normals[n], (MesoVec3){0, 0, 1});
    shell->normals = normals;
    shell->face_normals = face_normals;
    return MESO_OK;
}

/* Corners of faces that meet in a vertex, across edges along which both run in opposite directions, are one. */
static void join_corners(const MesoShell *shell, uint32_t *parent)
{
    const uint32_t *corners = shell->mesh->face_vertices;
    uint32_t count = 4 * shell->mesh->face_count;
    meso_sets_init(parent, count);
    for (uint32_t half = 0; half < count; half++) {
        uint32_t twin = shell->graph->twin[half], next = half % 4 == 3 ? half - 3 : half + 1;
        if (twin == MESO_NO_INDEX || corners[twin] != corners[next])
            continue;
        meso_sets_join(parent, half, twin % 4 == 3 ? twin - 3 : twin + 1);
        meso_sets_join(parent, next, twin);
    }
}

/* One normal for all of them, the very same where they had one. */
static MesoStatus share_normals(MesoShell *shell, MesoArena *arena, MesoError *error)
{
    size_t count = 4 * (size_t)shell->mesh->face_count;
    uint32_t *parent = MESO_NEW(arena, uint32_t, count, error);
    MesoVec3 *normals = MESO_NEW(arena, MesoVec3, count, error);
    bool *differ = MESO_NEW(arena, bool, count, error);
    if (!parent || !normals || !differ)
        return MESO_ERR_MEMORY;
    join_corners(shell, parent);
    for (uint32_t c = 0; c < count; c++) {
        uint32_t root = meso_sets_root(parent, c);
        MesoVec3 own = shell->normals[shell->face_normals[c]], first = shell->normals[shell->face_normals[root]];
        normals[root] = meso_vec3_add(normals[root], own);
        differ[root] |= own.x != first.x || own.y != first.y || own.z != first.z;
    }
    for (uint32_t c = 0; c < count; c++) {
        MesoVec3 own = shell->normals[shell->face_normals[c]];
        if (parent[c] == c)
            normals[c] = differ[c] ? meso_vec3_unit(normals[c], own) : own;
    }
    for (uint32_t c = 0; c < count; c++)
        parent[c] = meso_sets_root(parent, c);
    shell->normals = normals;
    shell->face_normals = parent;
    return MESO_OK;
}

/* ---- heights ---- */

static MesoStatus make_levels(MesoShell *shell, float **levels, MesoArena *arena, const MesoShellForm *form,
                              MesoError *error)
{
    float low = shell->bottom - form->offset, high = shell->top - form->offset;
    *levels = MESO_NEW(arena, float, 2 * (size_t)shell->mesh->vertex_count, error);
    if (!*levels)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < shell->mesh->vertex_count; v++) {
        float factor = form->factors ? form->factors[v] : 1, lift = form->lifts ? form->lifts[v] : 0;
        (*levels)[2 * (size_t)v] = form->offset + lift + factor * low;
        (*levels)[2 * (size_t)v + 1] = form->offset + lift + factor * high;
    }
    shell->levels = *levels;
    return MESO_OK;
}

/* ---- folds ---- */

static double spanned(MesoVec3 at, MesoVec3 next, MesoVec3 previous, MesoVec3 normal)
{
    MesoVec3 a = meso_vec3_sub(next, at), b = meso_vec3_sub(previous, at);
    return ((double)a.y * b.z - (double)a.z * b.y) * normal.x + ((double)a.z * b.x - (double)a.x * b.z) * normal.y +
           ((double)a.x * b.y - (double)a.y * b.x) * normal.z;
}

static double span_on_surface(const MesoShell *shell, uint32_t slot, uint32_t corner)
{
    const uint32_t *v = shell->mesh->face_vertices + 4 * (size_t)slot;
    const MesoVec3 *p = shell->mesh->positions;
    return spanned(p[v[corner]], p[v[(corner + 1) & 3]], p[v[(corner + 3) & 3]],
                   shell->normals[shell->face_normals[4 * (size_t)slot + corner]]);
}

static double span_on_level(const MesoShell *shell, uint32_t slot, uint32_t corner, bool top)
{
    return spanned(meso_shell_corner(shell, slot, corner, top), meso_shell_corner(shell, slot, corner + 1, top),
                   meso_shell_corner(shell, slot, corner + 3, top),
                   shell->normals[shell->face_normals[4 * (size_t)slot + corner]]);
}

/* Which way the face runs about its normals. */
static double sense_of(const MesoShell *shell, uint32_t slot)
{
    double sum = 0;
    for (uint32_t i = 0; i < 4; i++)
        sum += span_on_surface(shell, slot, i);
    return sum < 0 ? -1 : 1;
}

static bool folds(const MesoShell *shell, uint32_t slot)
{
    double sense = sense_of(shell, slot);
    for (uint32_t i = 0; i < 8; i++)
        if (!(sense * span_on_level(shell, slot, i & 3, i & 4) > 0))
            return true;
    return false;
}

uint32_t meso_shell_folds(const MesoShell *shell, uint32_t *slots, uint32_t room)
{
    uint32_t count = 0;
    for (uint32_t slot = 0; slot < shell->mesh->face_count; slot++) {
        if (!folds(shell, slot))
            continue;
        if (count < room)
            slots[count] = slot;
        count++;
    }
    return count;
}

/* ---- their limit ---- */

enum { ROUNDS = 64 };

typedef struct Limit {
    MesoShell *shell;
    float *levels;              /* [2 * vertex_count] of the shell, */
    const float *wanted;        /* which are these, scaled */
    float *scale;               /* [vertex_count] */
} Limit;

/* Lowers a corner, and those of its slot, where too little is left of it. True if any was. */
static bool lower_slot(const Limit *limit, uint32_t slot, float *next)
{
    const uint32_t *v = limit->shell->mesh->face_vertices + 4 * (size_t)slot;
    double sense = sense_of(limit->shell, slot);
    bool lowered = false;
    for (uint32_t i = 0; i < 4; i++) {
        double whole = sense * span_on_surface(limit->shell, slot, i);
        double left = fmin(sense * span_on_level(limit->shell, slot, i, false),
                           sense * span_on_level(limit->shell, slot, i, true));
        if (!(whole > 0) || left > 0.05 * whole)
            continue;
        for (uint32_t k = 0; k < 4; k++) {
            float lower = fmaxf(0.8f * limit->scale[v[k]], MESO_LIMIT_LEAST);
            lowered |= lower < next[v[k]];
            next[v[k]] = fminf(next[v[k]], lower);
        }
    }
    return lowered;
}

/* No corner of a face is higher than another one by more than the slope. */
static void smooth(const Limit *limit)
{
    bool changed = true;
    while (changed) {
        changed = false;
        for (uint32_t slot = 0; slot < limit->shell->mesh->face_count; slot++) {
            const uint32_t *v = limit->shell->mesh->face_vertices + 4 * (size_t)slot;
            float least = fminf(fminf(limit->scale[v[0]], limit->scale[v[1]]),
                                fminf(limit->scale[v[2]], limit->scale[v[3]])) + MESO_LIMIT_SLOPE;
            for (uint32_t k = 0; k < 4; k++) {
                changed |= limit->scale[v[k]] > least;
                limit->scale[v[k]] = fminf(limit->scale[v[k]], least);
            }
        }
    }
}

static void apply(const Limit *limit)
{
    for (uint32_t v = 0; v < limit->shell->mesh->vertex_count; v++)
        for (uint32_t k = 0; k < 2; k++)
            limit->levels[2 * (size_t)v + k] = limit->scale[v] * limit->wanted[2 * (size_t)v + k];
}

static bool lower_all(Limit *limit, float *next)
{
    bool lowered = false;
    for (uint32_t v = 0; v < limit->shell->mesh->vertex_count; v++)
        next[v] = limit->scale[v];
    for (uint32_t slot = 0; slot < limit->shell->mesh->face_count; slot++)
        lowered |= lower_slot(limit, slot, next);
    for (uint32_t v = 0; v < limit->shell->mesh->vertex_count; v++)
        limit->scale[v] = next[v];
    return lowered;
}

static MesoStatus limit_folds(MesoShell *shell, float *levels, MesoArena *scratch, MesoError *error)
{
    size_t count = shell->mesh->vertex_count;
    float *wanted = MESO_NEW(scratch, float, 2 * count, error);
    float *next = MESO_NEW(scratch, float, count, error);
    Limit limit = {.shell = shell, .levels = levels, .wanted = wanted, .scale = MESO_NEW(scratch, float, count, error)};
    if (!wanted || !next || !limit.scale)
        return MESO_ERR_MEMORY;
    for (size_t i = 0; i < 2 * count; i++)
        wanted[i] = levels[i];
    for (size_t v = 0; v < count; v++)
        limit.scale[v] = 1;
    for (uint32_t round = 0; round < ROUNDS && lower_all(&limit, next); round++) {
        smooth(&limit);
        apply(&limit);
    }
    return MESO_OK;
}

/* ---- all of it ---- */

MesoStatus meso_shell_build(MesoShell *shell, MesoArena *arena, const MesoQuadMesh *mesh, const MesoSlotGraph *graph,
                            const MesoShellForm *form, MesoError *error)
{
    const float below[] = {[MESO_SHELL_BOTH] = 0.25f, [MESO_SHELL_INSIDE] = 0.5f, [MESO_SHELL_OUTSIDE] = 0};
    float *levels = NULL;
    *shell = meso_shell_make(mesh, graph, form->offset - below[form->side] * form->thickness, form->thickness);
    MesoStatus status = MESO_OK;
    if (form->normals != MESO_NORMALS_FILE)
        status = make_normals(shell, arena, form->normals == MESO_NORMALS_FLAT, error);
    if (!status && form->shared)
        status = share_normals(shell, arena, error);
    if (!status && (form->factors || form->lifts || form->limit_folds))
        status = make_levels(shell, &levels, arena, form, error);
    if (status || !form->limit_folds)
        return status;
    MesoArena scratch;
    meso_arena_init(&scratch);
    status = limit_folds(shell, levels, &scratch, error);
    meso_arena_release(&scratch);
    return status;
}
