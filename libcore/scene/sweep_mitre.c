/* Which mitre or crease keeps a tube from folding. */
#include "libcore/math/bezier.h"
#include "libcore/scene/sweep.h"
#include "libcore/scene/sweep_section.h"

/* ---- which folds there are ---- */

enum { PLACES = 16, CLOSE_PLACES = 64, WAYS = 16, MOST_LINES = 3 * WAYS, LEVELS = 8, CLOSE_LEVELS = 29 };

/*
 * Of the trajectory's speed: how fast lines along a mitred sweep are to run forwards; and along a creased one, where
 * sections are steeper to them, and the normals of small faces off, the slower that is.
 */
static const float FORWARDS = 0.1f, CREASED_FORWARDS = 0.2f;

/* And along one whose rings lie across the trajectory, wherever they are looked at close by. */
static const float PLAIN_FORWARDS = 0.02f;

/*
 * Whether all bends are wider than the section reaches, as most sweeps' are, by the control points: no place is slower
 * than the slowest span along the way from end to end, and none bends more than the sharpest of their corners.
 */
static bool is_wide(const MesoSweepInstance *sweep, float reach)
{
    const float rounding = 0.99f * (1 - PLAIN_FORWARDS);
    const MesoVec3 *p = sweep->p;
    MesoVec3 d0 = meso_vec3_sub(p[1], p[0]), d1 = meso_vec3_sub(p[2], p[1]), d2 = meso_vec3_sub(p[3], p[2]);
    MesoVec3 along = meso_vec3_unit(meso_vec3_sub(p[3], p[0]), (MesoVec3){0, 0, 0});
    MesoVec3 c0 = meso_vec3_sub(d1, d0), c1 = meso_vec3_sub(d2, d1);
    float bend = fmaxf(meso_vec3_dot(c0, c0), meso_vec3_dot(c1, c1));
    float slowest = fminf(fminf(meso_vec3_dot(d0, along), meso_vec3_dot(d1, along)), meso_vec3_dot(d2, along));
    return slowest > 0 && reach * 6 * sqrtf(bend) < rounding * 9 * slowest * slowest;
}

/* X as the paper has it, but of any length. */
static MesoVec3 paper_x(const MesoSweepInstance *sweep, float v, MesoVec3 along)
{
    return meso_vec3_cross(meso_vec3_lerp(sweep->up[0], sweep->up[1], v), along);
}

/* Whether frames turn by over 30 degrees from one place to the next. */
static bool is_flip(MesoVec3 x, MesoVec3 next)
{
    float dot = meso_vec3_dot(x, next);
    return !(dot > 0 && 4 * dot * dot > 3 * meso_vec3_dot(x, x) * meso_vec3_dot(next, next));
}

/*
 * Whether frames cannot flip, as most sweeps' do not, by the control points of X, which is a cubic as the paper has it:
 * from one place to the next it goes no further than their longest step allows, and nowhere is it shorter than they all
 * are along the way that they point to.
 */
static bool is_steady(const MesoScene *scene, const MesoSweepInstance *sweep)
{
    if (scene->frame_rule != MESO_FRAME_PAPER)
        return true;
    const MesoVec3 *p = sweep->p, *up = sweep->up;
    MesoVec3 d0 = meso_vec3_sub(p[1], p[0]), d1 = meso_vec3_sub(p[2], p[1]), d2 = meso_vec3_sub(p[3], p[2]);
    MesoVec3 cross1 = meso_vec3_mad(meso_vec3_cross(up[1], d0), 2, meso_vec3_cross(up[0], d1));
    MesoVec3 cross2 = meso_vec3_mad(meso_vec3_cross(up[0], d2), 2, meso_vec3_cross(up[1], d1));
    MesoVec3 x[4] = {meso_vec3_cross(up[0], d0), meso_vec3_scale(cross1, 1.0f / 3), meso_vec3_scale(cross2, 1.0f / 3),
                     meso_vec3_cross(up[1], d2)};
    MesoVec3 along = meso_vec3_unit(meso_vec3_add(x[0], x[3]), (MesoVec3){0, 0, 0});
    float shortest = meso_vec3_dot(x[0], along), step = 0;
    for (uint32_t i = 1; i < 4; i++) {
        MesoVec3 way = meso_vec3_sub(x[i], x[i - 1]);
        shortest = fminf(shortest, meso_vec3_dot(x[i], along));
        step = fmaxf(step, meso_vec3_dot(way, way));
    }
    const float rounding = 0.99f, least_sine = 0.5f;
    return shortest > 0 && 3 * sqrtf(step) < rounding * least_sine * PLACES * shortest;
}

/* Whether some bend is narrower than the section reaches. */
static bool is_narrow(const MesoSweepInstance *sweep, float reach)
{
    const float most = (1 - PLAIN_FORWARDS) * (1 - PLAIN_FORWARDS);
    for (uint32_t i = 0; i <= CLOSE_PLACES; i++) {
        float v = (float)i / CLOSE_PLACES;
        MesoVec3 first = meso_bezier_derivative(sweep->p, v);
        MesoVec3 bend = meso_vec3_cross(first, meso_bezier_second_derivative(sweep->p, v));
        float square = meso_vec3_dot(first, first);
        if (!(reach * reach * meso_vec3_dot(bend, bend) < most * square * square * square))
            return true;
    }
    return false;
}

/* The curvature of the trajectory, towards the middle of its circle; (0, 0, 0) where it stands still. */
static MesoVec3 curvature(const MesoSweepInstance *sweep, float v)
{
    MesoVec3 first = meso_bezier_derivative(sweep->p, v), second = meso_bezier_second_derivative(sweep->p, v);
    float square = meso_vec3_dot(first, first);
    if (!(square > 0))
        return (MesoVec3){0, 0, 0};
    MesoVec3 bend = meso_vec3_mad(second, -meso_vec3_dot(second, first) / square, first);
    return meso_vec3_scale(bend, 1 / square);
}

/* Whether a section reaches beyond where rings meet that lie across the trajectory, which bends so. */
static bool meets_at(const MesoScene *scene, const MesoSweepTrack *track, MesoVec3 bend, float v)
{
    const MesoSweepColumn *columns = scene->columns + track->kind->column_begin;
    const float *size = track->sweep->size;
    MesoSweepPlane plane = meso_sweep_plane(&track->frames, v);
    MesoSweepBlend blend = meso_sweep_blend(track, v);
    MesoVec2 b = {meso_vec3_dot(bend, plane.x), meso_vec3_dot(bend, plane.y)};
    float most = 0;
    for (uint32_t c = 0; c < track->kind->column_count; c++) {
        MesoVec2 s = meso_sweep_place_on(track, &blend, meso_vec2_scale(columns[c].start, size[0]),
                                         meso_vec2_scale(columns[c].end, size[1]));
        most = fmaxf(most, s.x * b.x + s.y * b.y);
    }
    return scene->section_scale * most > 1 - PLAIN_FORWARDS;
}

/* Whether a line along a sweep without a mitre runs backwards, or nearly so, where bends are narrow. */
static bool runs_backwards(const MesoScene *scene, const MesoSweepTrack *track, float reach)
{
    const float narrow = 1 - PLAIN_FORWARDS;
    for (uint32_t i = 0; i <= CLOSE_PLACES; i++) {
        float v = (float)i / CLOSE_PLACES;
        MesoVec3 bend = curvature(track->sweep, v);
        if (reach * reach * meso_vec3_dot(bend, bend) >= narrow * narrow && meets_at(scene, track, bend, v))
            return true;
    }
    return false;
}

/* Whether the frame flips as drawn. */
static bool flips_drawn(const MesoSweepInstance *sweep)
{
    bool any = false;
    MesoVec3 x = paper_x(sweep, 0, meso_bezier_derivative(sweep->p, 0));
    for (uint32_t i = 1; i <= PLACES && !any; i++) {
        float v = (float)i / PLACES;
        MesoVec3 next = paper_x(sweep, v, meso_bezier_derivative(sweep->p, v));
        any = is_flip(x, next);
        x = next;
    }
    return any;
}

/* How far the rim of a section goes aside as frames turn that are mitred, in parts of what the trajectory goes on. */
static const float ASIDE = 0.3f;

/* Whether frames flip, or turn by more than the normals of mitres, which leave that out, can bear. */
static bool flips(const MesoScene *scene, const MesoSweepInstance *sweep, float reach)
{
    if (scene->frame_rule != MESO_FRAME_PAPER)
        return false;
    MesoSweepFrames frames = meso_sweep_frames(scene->frame_rule, sweep);
    bool any = false;
    MesoSweepPlane plane = meso_sweep_plane(&frames, 0);
    for (uint32_t i = 1; i <= PLACES && !any; i++) {
        MesoSweepPlane next = meso_sweep_plane(&frames, (float)i / PLACES);
        float aside = reach * fabsf(meso_vec3_dot(next.x, plane.y));
        any = is_flip(plane.x, next.x) ||
              (sweep->mitre > 0 && aside > ASIDE * meso_vec3_length(meso_vec3_sub(next.origin, plane.origin)));
        plane = next;
    }
    return any;
}

/* Points of some lines along a sweep, in the planes of its rings, which a mitre turns and leaves what they are. */
typedef struct Lines {
    uint32_t count;
    MesoVec2 at[PLACES + 1][MOST_LINES];
} Lines;

/*
 * Columns of which some section reaches furthest in one of several directions: lines between them run no slower than
 * the slowest of these. Three places will do, as sections between them are blends. All, where these are few.
 */
static uint32_t outer_columns(const MesoScene *scene, const MesoSweepTrack *track, uint32_t outer[MOST_LINES])
{
    const MesoSweepColumn *columns = scene->columns + track->kind->column_begin;
    uint32_t column_count = track->kind->column_count, count = 0;
    for (uint32_t c = 0; column_count <= MOST_LINES && c < column_count; c++)
        outer[count++] = c;
    for (uint32_t k = 0; column_count > MOST_LINES && k < MOST_LINES; k++) {
        MesoSweepBlend blend = meso_sweep_blend(track, 0.5f * (float)(k / WAYS));
        MesoSweepAngle way = meso_sweep_angle((float)(2 * MESO_PI / WAYS) * (float)(k % WAYS));
        float furthest = -INFINITY;
        uint32_t column = 0, i = 0;
        for (uint32_t c = 0; c < column_count; c++) {
            MesoVec2 s = meso_sweep_place_on(track, &blend, meso_vec2_scale(columns[c].start, track->sweep->size[0]),
                                             meso_vec2_scale(columns[c].end, track->sweep->size[1]));
            float far = s.x * way.c + s.y * way.s;
            column = far > furthest ? c : column;
            furthest = fmaxf(far, furthest);
        }
        while (i < count && outer[i] != column)
            i++;
        outer[i] = column;
        count = i == count ? count + 1 : count;
    }
    return count;
}

static void take_lines(Lines *lines, const MesoScene *scene, const MesoSweepTrack *track)
{
    const MesoSweepColumn *columns = scene->columns + track->kind->column_begin;
    uint32_t outer[MOST_LINES];
    lines->count = outer_columns(scene, track, outer);
    for (uint32_t i = 0; i <= PLACES; i++) {
        MesoSweepBlend blend = meso_sweep_blend(track, (float)i / PLACES);
        for (uint32_t k = 0; k < lines->count; k++) {
            MesoVec2 start = meso_vec2_scale(columns[outer[k]].start, track->sweep->size[0]);
            MesoVec2 end = meso_vec2_scale(columns[outer[k]].end, track->sweep->size[1]);
            lines->at[i][k] = meso_vec2_scale(meso_sweep_place_on(track, &blend, start, end), scene->section_scale);
        }
    }
}

/* Along a direction, from a point of one plane to one of another. */
typedef struct Step {
    float origin, before_x, before_y, after_x, after_y;
} Step;

static Step step_along(const MesoSweepPlane *before, const MesoSweepPlane *after, MesoVec3 along)
{
    return (Step){meso_vec3_dot(meso_vec3_sub(after->origin, before->origin), along),
                  meso_vec3_dot(before->x, along), meso_vec3_dot(before->y, along),
                  meso_vec3_dot(after->x, along), meso_vec3_dot(after->y, along)};
}

static float shortest_step(const Step *step, const MesoVec2 *before, const MesoVec2 *after, uint32_t count)
{
    float shortest = INFINITY, lengths[MOST_LINES];
    for (uint32_t c = 0; c < count; c++)
        lengths[c] = step->origin + after[c].x * step->after_x + after[c].y * step->after_y -
                     before[c].x * step->before_x - before[c].y * step->before_y;
    for (uint32_t c = 0; c < count; c++)
        shortest = lengths[c] < shortest ? lengths[c] : shortest;
    return shortest;
}

/* How far lines go forwards at least, in parts of what the trajectory does; or less than `enough`, if it is that. */
static float least_forwards(const MesoSweepTrack *track, const Lines *lines, float enough)
{
    float least = INFINITY;
    MesoSweepPlane plane = meso_sweep_plane(&track->frames, 0);
    for (uint32_t i = 1; i <= PLACES && least > enough; i++) {
        MesoSweepPlane next = meso_sweep_plane(&track->frames, (float)i / PLACES);
        MesoVec3 along = meso_vec3_unit(meso_vec3_add(plane.tangent, next.tangent), plane.tangent);
        float length = meso_vec3_length(meso_vec3_sub(next.origin, plane.origin));
        Step step = step_along(&plane, &next, along);
        least = fminf(least, shortest_step(&step, lines->at[i - 1], lines->at[i], lines->count) / length);
        plane = next;
    }
    return least;
}

/* The points of one place, which the lines have as they are without a twist, with that of the track, and creased. */
static void crease_points(MesoVec2 *out, const Lines *lines, const MesoSweepTrack *track, const MesoSweepPlane *plane,
                          uint32_t place)
{
    MesoSweepBlend blend = meso_sweep_blend(track, (float)place / PLACES);
    meso_sweep_crease(&blend, track, meso_sweep_bend(&track->frames, plane, blend.v));
    MesoSweepAngle twist = blend.turns ? blend.twist : meso_sweep_angle(0);
    for (uint32_t c = 0; c < lines->count; c++)
        out[c] = meso_sweep_creased(&blend, meso_sweep_turned(lines->at[place][c], twist));
}

enum { SPANS = 2 };

/*
 * The same where there is a crease: off both rings that lines go between, as the triangles have a side on either; and
 * between rings further apart, too.
 */
static float least_creased(const MesoSweepTrack *track, const Lines *lines, float enough)
{
    float least = INFINITY;
    MesoVec2 points[PLACES + 1][MOST_LINES];
    MesoSweepPlane planes[PLACES + 1];
    for (uint32_t i = 0; i <= PLACES && least > enough; i++) {
        planes[i] = meso_sweep_plane(&track->frames, (float)i / PLACES);
        crease_points(points[i], lines, track, &planes[i], i);
        for (uint32_t k = i < SPANS ? 0 : i - SPANS; k < i; k++) {
            float length = meso_vec3_length(meso_vec3_sub(planes[i].origin, planes[k].origin));
            Step off = step_along(&planes[k], &planes[i], planes[k].tangent);
            Step onto = step_along(&planes[k], &planes[i], planes[i].tangent);
            least = fminf(least, shortest_step(&off, points[k], points[i], lines->count) / length);
            least = fminf(least, shortest_step(&onto, points[k], points[i], lines->count) / length);
        }
    }
    return least;
}

/* ---- which mitre ---- */

/* The twist of a crease; of two that end alike, that with which a section that turns by half at most does so least. */
static float creased_twist(const MesoSweptKind *kind, const MesoSweepFrames *frames)
{
    float half = (float)MESO_PI, twist = meso_sweep_frames_twist(frames), sum = twist + kind->turn;
    return fabsf(kind->turn) > half || fabsf(sum) <= half ? twist : sum > 0 ? twist - 2 * half : twist + 2 * half;
}

/* Creases of a sweep that are tried. */
typedef struct Creases {
    MesoSweepInstance trial;
    MesoSweepTrack track;
    Lines lines;
    float forwards;             /* of the best so far */
} Creases;

static void begin_creases(Creases *creases, const MesoScene *scene, const MesoSweptKind *kind,
                          const MesoSweepInstance *sweep)
{
    creases->trial = *sweep;
    creases->trial.mitre = MESO_CREASED;
    creases->trial.twist = 0;
    creases->track = meso_sweep_track(scene, kind, &creases->trial);
    creases->forwards = -INFINITY;
    take_lines(&creases->lines, scene, &creases->track);
}

/* The i-th of so many of each k. */
static void try_crease(Creases *creases, const MesoScene *scene, const MesoSweptKind *kind, uint32_t i, uint32_t levels)
{
    creases->trial.mitre = MESO_CREASED * (float)(1 + i / levels) + (float)(i % levels) / (float)(levels - 1);
    creases->track.frames = meso_sweep_frames(scene->frame_rule, &creases->trial);
    creases->trial.twist = creased_twist(kind, &creases->track.frames);
}

static void take_crease(Creases *creases, float forwards, MesoSweepInstance *sweep)
{
    creases->forwards = forwards;
    sweep->mitre = creases->trial.mitre;
    sweep->twist = creases->trial.twist;
}

/*
 * The first crease whose lines run forwards as fast as they are to, or else that whose lines run fastest; those whose
 * rings turn next to the ends, too, come last. Where faces are against their normals nevertheless, the one of which
 * fewest are, and of these that whose lines run fastest.
 */
static void add_crease(const MesoScene *scene, const MesoSweptKind *kind, MesoSweepInstance *sweep)
{
    Creases creases;
    begin_creases(&creases, scene, kind, sweep);
    for (uint32_t i = 0; i < (MESO_CREASE_EASES - 1) * LEVELS && creases.forwards < CREASED_FORWARDS; i++) {
        try_crease(&creases, scene, kind, i, LEVELS);
        float forwards = least_creased(&creases.track, &creases.lines, creases.forwards);
        if (forwards > creases.forwards)
            take_crease(&creases, forwards, sweep);
    }
    uint32_t fewest = meso_sweep_against(scene, kind, sweep, UINT32_MAX);
    for (uint32_t i = 0, count = fewest > 0 ? MESO_CREASE_EASES * CLOSE_LEVELS : 0; i < count; i++) {
        try_crease(&creases, scene, kind, i, CLOSE_LEVELS);
        uint32_t against = meso_sweep_against(scene, kind, &creases.trial, fewest);
        if (against > fewest)
            continue;
        float forwards = least_creased(&creases.track, &creases.lines, -INFINITY);
        if (against < fewest || forwards > creases.forwards) {
            fewest = against;
            take_crease(&creases, forwards, sweep);
        }
    }
}

/* The least mitre whose lines run forwards as fast as they are to; false if there is none. */
static bool add_mitre(const MesoScene *scene, const MesoSweptKind *kind, float reach, MesoSweepInstance *sweep)
{
    MesoSweepTrack track = meso_sweep_track(scene, kind, sweep);
    Lines lines;
    take_lines(&lines, scene, &track);
    if (!runs_backwards(scene, &track, reach) && least_forwards(&track, &lines, -INFINITY) >= 0)
        return true;
    for (uint32_t i = 1; i <= LEVELS; i++) {
        sweep->mitre = (float)i / LEVELS;
        track.frames = meso_sweep_frames(scene->frame_rule, sweep);
        if (least_forwards(&track, &lines, FORWARDS) >= FORWARDS)
            return true;
    }
    return false;
}

void meso_sweep_add_mitre(const MesoScene *scene, const MesoSweptKind *kind, MesoKindReach reach,
                          MesoSweepInstance *sweep)
{
    float radius = meso_sweep_reach(scene, sweep, reach);
    sweep->mitre = 0;
    bool flip = !is_steady(scene, sweep) && flips_drawn(sweep);
    if (!flip && (is_wide(sweep, radius) || !is_narrow(sweep, radius)))
        return;
    if (flip || !add_mitre(scene, kind, radius, sweep) || flips(scene, sweep, radius))
        add_crease(scene, kind, sweep);
}
