/* Strands joined across the seam: deformed onto common sections, zipped, and what has no partner closed. */
#include "libcore/quilt/quilt_work.h"
#include "libcore/quilt/seam/band_deform.h"

#include <string.h>

/* Rings of triangles on both sides that the deformation spreads over. */
#define BAND_RINGS 10

/* Weight of the places of a section against the shape of its strand: they are to be met. */
#define SECTION_WEIGHT 1e4

/* Moves that are not worth it, in mean edges of the swatch. */
#define MOVE_LEAST 1e-4f

/* Cosine of a turn that is not worth it. */
#define TURN_LEAST 0.9999999f

typedef struct Joiner {
    const MesoStrandSide *old_side, *new_side;
    const MesoQuiltStep *step;
    MesoQuiltWork *work;
    MesoArena *arena;
    uint32_t *old_names, *new_names;    /* clip vertices to those of the composite */
} Joiner;

/* ---- moves ---- */

/* How far vertices have moved, those that have. */
static void count_moves(MesoQuiltTally *tally, float edge, const MesoVec3 *before, const MesoVec3 *after, uint32_t count)
{
    for (uint32_t v = 0; v < count; v++) {
        MesoVec3 move = meso_vec3_sub(after[v], before[v]);
        double length = meso_vec3_length(move) / edge;
        if (!(length > 0))
            continue;
        tally->square_sum += length * length;
        tally->moved_count++;
        if (length > tally->report.deformation_largest)
            tally->report.deformation_largest = length;
    }
}

/* `v` turned by what turns the direction `from` into `to`. */
static MesoVec3 turned(MesoVec3 v, MesoVec3 from, MesoVec3 to)
{
    MesoVec3 sum = meso_vec3_add(from, to);
    float share = meso_vec3_dot(v, sum) / (1 + meso_vec3_dot(from, to));
    return meso_vec3_mad(meso_vec3_mad(v, -share, sum), 2 * meso_vec3_dot(v, from), to);
}

/* Moves the sections that have a partner; the strands behind follow over some rings. */
static MesoStatus deform_side(MesoStrandSide *side, const MesoQuiltWork *work, MesoArena *arena, MesoError *error)
{
    uint32_t pull_count = 0, count = side->clip.kept_count + side->clip.made_count;
    MesoBandPull *pulls = MESO_NEW(arena, MesoBandPull, side->clip.made_count, error);
    MesoVec3 *moved = MESO_NEW(arena, MesoVec3, count, error);
    if (!pulls || !moved)
        return MESO_ERR_MEMORY;
    for (uint32_t s = 0; s < side->section_count; s++) {
        const MesoSection *section = &side->sections[s];
        if (side->partners[s] == MESO_NO_INDEX ||
            (meso_vec3_length(side->moves[s]) < MOVE_LEAST * work->swatch->mean_edge &&
             meso_vec3_dot(side->axes[s], side->turns[s]) > TURN_LEAST))
            continue;
        for (uint32_t i = 0; i < section->count; i++) {
            uint32_t v = section->vertices[i];
            MesoVec3 off = turned(meso_vec3_sub(side->clipped[v], section->centre), side->axes[s], side->turns[s]);
            MesoVec3 target = meso_vec3_add(meso_vec3_add(section->centre, off), side->moves[s]);
            pulls[pull_count++] = (MesoBandPull){{v, 0, 0}, {1, 0, 0}, target};
        }
    }
    if (!pull_count)
        return MESO_OK;
    for (uint32_t v = 0; v < count; v++)
        moved[v] = side->clipped[v];
    MesoStatus status = meso_band_deform(moved, arena, count, side->clip.corners, side->clip.triangle_count, pulls,
                                         pull_count, BAND_RINGS, SECTION_WEIGHT * work->options.mu, NULL, NULL, error);
    if (!status)
        side->clipped = moved;
    return status;
}

typedef struct Deforming {
    MesoStrandSide *sides[2];
    const MesoQuiltWork *work;
} Deforming;

static MesoStatus deform_one(void *context, int side, MesoArena *arena, MesoError *error)
{
    const Deforming *d = context;
    return deform_side(d->sides[side], d->work, arena, error);
}

static MesoStatus deform_sides(MesoStrandJoint *joint, const MesoQuiltStep *step, const MesoQuiltWork *work,
                               MesoArena *arena, MesoError *error)
{
    Deforming d = {{&joint->old_side, &joint->new_side}, work};
    const MesoVec3 *before[2] = {joint->old_side.clipped, joint->new_side.clipped};
    MesoStatus status = meso_quilt_both(deform_one, &d, step, work, arena, error);
    for (int i = 0; i < 2 && !status; i++)
        if (d.sides[i]->clipped != before[i])
            count_moves(step->tally, work->swatch->mean_edge, before[i], d.sides[i]->clipped,
                        d.sides[i]->clip.kept_count + d.sides[i]->clip.made_count);
    return status;
}

/* ---- to the composite ---- */

static MesoStatus fail(MesoError *error)
{
    return error ? error->status : MESO_ERR_MEMORY;
}

/* Vertices of the older side have moved; where two ends of strands touch in one, the second gets a new one. */
static MesoStatus commit_old_vertices(Joiner *j, MesoError *error)
{
    const MesoStrandSide *side = j->old_side;
    const MesoClip *clip = &side->clip;
    MesoComposite *composite = &j->work->composite;
    uint8_t *taken = MESO_NEW(j->arena, uint8_t, side->vertex_count, error);
    if (!taken)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < clip->kept_count + clip->made_count; i++) {
        uint32_t local = i < clip->kept_count ? clip->vertices[i] : clip->ends[2 * (size_t)(i - clip->kept_count)];
        uint32_t name = side->vertices[local];
        MesoVec3 a = side->positions[local], b = side->clipped[i];
        MesoQuiltVertex place = composite->vertices[name];
        if (a.x != b.x || a.y != b.y || a.z != b.z)
            meso_quilt_plane_from(&j->step->plane, b, &place);      /* at the rim it stays where it is */
        if (taken[local])
            name = meso_composite_add_vertex(composite, place, composite->vertex_origins[name], error);
        if (name == MESO_NO_INDEX)
            return fail(error);
        composite->vertices[name] = place;
        taken[local] = 1;
        j->old_names[i] = name;
    }
    return MESO_OK;
}

static MesoStatus commit_new_vertices(Joiner *j, MesoError *error)
{
    const MesoStrandSide *side = j->new_side;
    const MesoClip *clip = &side->clip;
    MesoComposite *composite = &j->work->composite;
    MesoQuiltVertex last = {.triangle = j->step->seed};
    for (uint32_t i = 0; i < clip->kept_count + clip->made_count; i++) {
        uint32_t local = i < clip->kept_count ? clip->vertices[i] : clip->ends[2 * (i - clip->kept_count)];
        MesoQuiltVertex place;
        if (!meso_quilt_plane_from(&j->step->plane, side->clipped[i], &place) &&
            !meso_quilt_plane_from(&j->step->plane, side->positions[local], &place))
            place = last;
        last = place;
        j->new_names[i] = meso_composite_add_vertex(composite, place, side->vertices[local], error);
        if (j->new_names[i] == MESO_NO_INDEX)
            return fail(error);
    }
    return MESO_OK;
}

/* Old triangles that are not kept die; those that have another vertex now come anew. */
static MesoStatus commit_old_triangles(Joiner *j, MesoError *error)
{
    const MesoStrandSide *side = j->old_side;
    const MesoClip *clip = &side->clip;
    MesoComposite *composite = &j->work->composite;
    for (uint32_t t = 0; t < side->triangle_count; t++) {
        const uint32_t *corner = &side->corners[3 * (size_t)t];
        if (!(side->values[corner[0]] > 0 && side->values[corner[1]] > 0 && side->values[corner[2]] > 0))
            composite->corners[3 * (size_t)side->triangles[t]] = MESO_NO_INDEX;
    }
    for (uint32_t t = 0; t < clip->triangle_count; t++) {
        const uint32_t *corner = &clip->corners[3 * (size_t)t];
        uint32_t from = side->triangles[clip->origins[t]];
        uint32_t names[3] = {j->old_names[corner[0]], j->old_names[corner[1]], j->old_names[corner[2]]};
        if (memcmp(names, &composite->corners[3 * (size_t)from], sizeof names) == 0)
            continue;
        if (meso_composite_add_triangle(composite, names, composite->triangle_origins[from], composite->patches[from],
                                        error) == MESO_NO_INDEX)
            return fail(error);
        composite->corners[3 * (size_t)from] = MESO_NO_INDEX;
    }
    return MESO_OK;
}

static MesoStatus commit_new_triangles(Joiner *j, MesoError *error)
{
    const MesoClip *clip = &j->new_side->clip;
    for (uint32_t t = 0; t < clip->triangle_count; t++) {
        const uint32_t *corner = &clip->corners[3 * (size_t)t];
        uint32_t names[3] = {j->new_names[corner[0]], j->new_names[corner[1]], j->new_names[corner[2]]};
        if (meso_composite_add_triangle(&j->work->composite, names, j->new_side->triangles[clip->origins[t]],
                                        j->step->patch, error) == MESO_NO_INDEX)
            return fail(error);
    }
    return MESO_OK;
}

static MesoStatus add_all(Joiner *j, const uint32_t *corners, uint32_t count, uint32_t origin, MesoError *error)
{
    for (uint32_t t = 0; t < count; t++)
        if (meso_composite_add_triangle(&j->work->composite, &corners[3 * (size_t)t], origin, j->step->patch, error) ==
            MESO_NO_INDEX)
            return fail(error);
    return MESO_OK;
}

/* A triangle of the swatch that looks as a section's vertex does. */
static uint32_t look_of(const MesoStrandSide *side, const uint32_t *made_triangles, const MesoSection *section)
{
    return made_triangles[section->vertices[0] - side->clip.kept_count];
}

/* For each made vertex a triangle of the swatch next to it. */
static MesoStatus find_looks(uint32_t **looks, const MesoStrandSide *side, const uint32_t *origins, MesoArena *arena,
                             MesoError *error)
{
    const MesoClip *clip = &side->clip;
    *looks = MESO_NEW(arena, uint32_t, clip->made_count, error);
    if (!*looks)
        return MESO_ERR_MEMORY;
    for (uint32_t t = 0; t < clip->triangle_count; t++)
        for (size_t k = 0; k < 3; k++) {
            uint32_t v = clip->corners[3 * (size_t)t + k], triangle = side->triangles[clip->origins[t]];
            if (v >= clip->kept_count)
                (*looks)[v - clip->kept_count] = origins ? origins[triangle] : triangle;
        }
    return MESO_OK;
}

static MesoStatus zip_pair(Joiner *j, uint32_t old_section, uint32_t look, MesoError *error)
{
    /* both loops in the composite's numbers: the places of both stay where they are */
    const MesoSection *a = &j->old_side->sections[old_section];
    const MesoSection *b = &j->new_side->sections[j->old_side->partners[old_section]];
    MesoArenaMark mark = meso_arena_mark(j->arena);
    uint32_t count = a->count + b->count;
    uint32_t *corners = MESO_NEW(j->arena, uint32_t, 3 * (size_t)count, error);
    if (!corners)
        return MESO_ERR_MEMORY;
    uint32_t offset = j->old_side->clip.kept_count + j->old_side->clip.made_count;
    meso_section_zip(corners, a, b, meso_section_align(a, b), offset);
    for (uint32_t i = 0; i < 3 * count; i++)
        corners[i] = corners[i] < offset ? j->old_names[corners[i]] : j->new_names[corners[i] - offset];
    MesoStatus status = add_all(j, corners, count, look, error);
    meso_arena_rewind(j->arena, mark);
    j->step->tally->report.join_count++;
    return status;
}

/* A fan around a new vertex in the middle: whatever the section looks like, no edge is there twice. */
static MesoStatus cap_section(Joiner *j, const MesoSection *section, const uint32_t *names, uint32_t look,
                              MesoError *error)
{
    MesoComposite *composite = &j->work->composite;
    uint32_t first = names[section->vertices[0]];
    MesoQuiltVertex place;
    if (!meso_quilt_plane_from(&j->step->plane, section->centre, &place))
        place = composite->vertices[first];
    uint32_t middle = meso_composite_add_vertex(composite, place, composite->vertex_origins[first], error);
    if (middle == MESO_NO_INDEX || meso_composite_add_cap(composite, composite->triangle_count, error))
        return fail(error);
    for (uint32_t i = 0; i < section->count; i++) {
        uint32_t corners[3] = {names[section->vertices[(i + 1) % section->count]], names[section->vertices[i]], middle};
        if (meso_composite_add_triangle(composite, corners, look, j->step->patch, error) == MESO_NO_INDEX)
            return fail(error);
    }
    return MESO_OK;
}

/* After the deformation the sections lie elsewhere. */
static void measure_again(MesoStrandSide *side)
{
    for (uint32_t s = 0; s < side->section_count; s++) {
        side->sections[s].positions = side->clipped;
        meso_section_measure(&side->sections[s]);
    }
}

static MesoStatus close_sections(Joiner *j, const uint32_t *old_looks, const uint32_t *new_looks, MesoError *error)
{
    MesoStatus status = MESO_OK;
    for (uint32_t s = 0; !status && s < j->old_side->section_count; s++) {
        const MesoSection *section = &j->old_side->sections[s];
        uint32_t look = look_of(j->old_side, old_looks, section);
        status = j->old_side->partners[s] != MESO_NO_INDEX ? zip_pair(j, s, look, error)
                                                           : cap_section(j, section, j->old_names, look, error);
    }
    for (uint32_t s = 0; !status && s < j->new_side->section_count; s++)
        if (j->new_side->partners[s] == MESO_NO_INDEX) {
            const MesoSection *section = &j->new_side->sections[s];
            status = cap_section(j, section, j->new_names, look_of(j->new_side, new_looks, section), error);
        }
    j->step->tally->report.open_count += j->old_side->clip.open_count + j->new_side->clip.open_count;
    return status;
}

MesoStatus meso_strands_plan(MesoStrandJoint *joint, const MesoStrandSide *old_side, const MesoStrandSide *new_side,
                             MesoRingShares *shares, const MesoQuiltStep *step, const MesoQuiltWork *work,
                             MesoArena *arena, MesoError *error)
{
    *joint = (MesoStrandJoint){.old_side = *old_side, .new_side = *new_side};
    MesoStatus status = MESO_OK;
    if (meso_strands_draw_back(shares, old_side, new_side, step, work)) {
        float flaws;
        meso_arena_rewind(arena, step->before_sides[0]);
        meso_arena_rewind(step->beside, step->before_sides[1]);
        status = meso_strands_cut_shared(&joint->old_side, &joint->new_side, MESO_CUT_ALL, shares, step, work, arena,
                                         error);
        if (!status)
            status = meso_strands_pair(&joint->old_side, &joint->new_side, &flaws, MESO_REACH_LAST, shares, step, work,
                                       arena, error);
    }
    if (!status)
        status = deform_sides(joint, step, work, arena, error);
    if (status)
        return status;
    measure_again(&joint->old_side);
    measure_again(&joint->new_side);
    return MESO_OK;
}

MesoStatus meso_strands_commit(const MesoStrandJoint *joint, const MesoQuiltStep *step, MesoQuiltWork *work,
                               MesoArena *arena, MesoError *error)
{
    Joiner j = {.old_side = &joint->old_side, .new_side = &joint->new_side, .step = step, .work = work, .arena = arena};
    const MesoClip *old_clip = &j.old_side->clip, *new_clip = &j.new_side->clip;
    uint32_t *old_looks, *new_looks;
    j.old_names = MESO_NEW(arena, uint32_t, (size_t)old_clip->kept_count + old_clip->made_count, error);
    j.new_names = MESO_NEW(arena, uint32_t, (size_t)new_clip->kept_count + new_clip->made_count, error);
    if (!j.old_names || !j.new_names)
        return MESO_ERR_MEMORY;
    MesoStatus status = find_looks(&old_looks, j.old_side, work->composite.triangle_origins, arena, error);
    if (!status)
        status = find_looks(&new_looks, j.new_side, NULL, arena, error);
    if (!status)
        status = commit_old_vertices(&j, error);
    if (!status)
        status = commit_new_vertices(&j, error);
    if (!status)
        status = commit_old_triangles(&j, error);
    if (!status)
        status = commit_new_triangles(&j, error);
    return status ? status : close_sections(&j, old_looks, new_looks, error);
}
