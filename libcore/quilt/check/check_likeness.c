#include "libcore/quilt/check/check_likeness.h"

#include <string.h>

#include "libcore/quilt/check/check_layer.h"

enum {
    WINDOWS = 32,
    TRIES = 32,             /* for each: some places are too near to a border, or have nothing over them */
    LEAST_POINTS = 12,
    MOST_POINTS = 128,
    PLACES = 16,            /* of the swatch that are looked at more closely */
    SLIDES = 2,             /* of them from where a better one is looked for nearby */
    TURN_BINS = 72,
    TURNS = 3               /* that a window may have patches of */
};

/* Radius of a window as a share of the tile's shorter side. */
#define RADIUS 0.15f

/* Voxels along the longer side of the tile. */
#define VOXELS 72

/* The finest steps of sliding, in voxels; of that from places of which one is to be chosen, as a part. */
#define FINEST 0.015f
#define COARSE 8

/* Edges that are longer than they are in the swatch by more, or shorter, lie between patches. */
#define EDGE_RATIO 2.0f

/* Turns of a window's patches count from a share of its edges on; alike are those so many bins apart. */
#define TURN_SHARE 0.15
#define TURN_WIDTH 2

typedef struct Comparison {
    const MesoQuilt *quilt;
    const MesoSwatch *swatch;
    const MesoLikenessOptions *options;
    MesoArena *scratch;
    MesoCheckLayer layer;
    MesoMatchField field;
    MesoNearestMesh sample;         /* the swatch */
    MesoMatchPoint *sample_points;
    uint32_t *sample_locals;
    MesoWindowSize size;
    double squares, laid_squares;   /* of distances, summed */
} Comparison;

/* Where a window is laid on the swatch. */
typedef struct Placing {
    double turn;            /* of the swatch in the window */
    MesoVec2 shift;         /* the place on the swatch that is under the window's middle */
} Placing;

static MesoStatus prepare_swatch(Comparison *c, MesoError *error)
{
    const MesoSwatch *swatch = c->swatch;
    c->sample_points = MESO_NEW(c->scratch, MesoMatchPoint, swatch->vertex_count, error);
    c->sample_locals = MESO_NEW(c->scratch, uint32_t, swatch->vertex_count, error);
    if (!c->sample_points || !c->sample_locals)
        return MESO_ERR_MEMORY;
    memset(c->sample_locals, 0xff, swatch->vertex_count * sizeof *c->sample_locals);
    for (uint32_t v = 0; v < swatch->vertex_count; v++)
        c->sample_points[v] = (MesoMatchPoint){swatch->positions[v], swatch->normals[v]};
    float radius = RADIUS * fminf(swatch->size.x, swatch->size.y);
    c->size = (MesoWindowSize){radius, radius + 2 * swatch->mean_edge, radius + meso_window_border(swatch)};
    MesoStatus status = meso_nearest_mesh_build(&c->sample, c->scratch, c->sample_points, swatch->corners,
                                                swatch->triangle_count, error);
    float longer = fmaxf(swatch->size.x, swatch->size.y);
    return status ? status : meso_match_field_build(&c->field, c->scratch, swatch, 1 / swatch->mean_edge,
                                                    longer / VOXELS, c->options->thread_count, error);
}

/* ---- how the swatch is turned in a window ---- */

/* Edges by how far they are turned, their lengths as weights. */
typedef struct TurnBins {
    double cosines[TURN_BINS], sines[TURN_BINS], weights[TURN_BINS];
} TurnBins;

/*
 * What an edge says of the turn: itself against where it is from in the swatch. One between patches has ends that are
 * from different places there, and says nothing.
 */
static void add_edge(TurnBins *bins, MesoVec3 here, MesoVec3 there)
{
    float length = meso_vec3_length(here), original = meso_vec3_length(there);
    if (!(length < EDGE_RATIO * original && original < EDGE_RATIO * length))
        return;
    double cosine = (double)(here.x * there.x + here.y * there.y), sine = (double)(there.x * here.y - there.y * here.x);
    int bin = (int)floor((atan2(sine, cosine) / (2 * MESO_PI) + 1) * TURN_BINS) % TURN_BINS;
    bins->cosines[bin] += cosine;
    bins->sines[bin] += sine;
    bins->weights[bin] += sqrt(cosine * cosine + sine * sine);
}

/* The sum around a bin. */
static double around(const double *values, int bin)
{
    double sum = 0;
    for (int i = bin - TURN_WIDTH; i <= bin + TURN_WIDTH; i++)
        sum += values[(i + TURN_BINS) % TURN_BINS];
    return sum;
}

/* The commonest turns, each the mean of those alike; what is in none is left out. */
static uint32_t take_turns(double turns[TURNS], TurnBins *bins)
{
    double total = 0;
    uint32_t count = 0;
    for (int i = 0; i < TURN_BINS; i++)
        total += bins->weights[i];
    for (; count < TURNS; count++) {
        int best = 0;
        for (int i = 1; i < TURN_BINS; i++)
            best = around(bins->weights, i) > around(bins->weights, best) ? i : best;
        if (count && !(around(bins->weights, best) > TURN_SHARE * total))
            break;
        turns[count] = atan2(around(bins->sines, best), around(bins->cosines, best));
        for (int i = best - 2 * TURN_WIDTH; i <= best + 2 * TURN_WIDTH; i++) {
            int bin = (i + TURN_BINS) % TURN_BINS;
            bins->weights[bin] = bins->cosines[bin] = bins->sines[bin] = 0;
        }
    }
    return count;
}

static uint32_t find_turns(double turns[TURNS], const Comparison *c, const MesoWindow *window)
{
    TurnBins bins = {0};
    const MesoVec3 *originals = c->swatch->positions;
    for (uint32_t h = 0; h < 3 * window->triangle_count; h++) {
        uint32_t a = window->corners[h], b = window->corners[meso_next_corner(h)];
        add_edge(&bins, meso_vec3_sub(window->points[b].position, window->points[a].position),
                 meso_vec3_sub(originals[c->quilt->origins[window->vertices[b]]],
                               originals[c->quilt->origins[window->vertices[a]]]));
    }
    return take_turns(turns, &bins);
}

/* ---- a window on the swatch ---- */

/* The axis of a window that is turned. */
static MesoVec2 axis_of(double turn)
{
    return (MesoVec2){(float)cos(turn), (float)sin(turn)};
}

static MesoVec3 turned_back(MesoVec3 p, MesoVec2 axis)
{
    return (MesoVec3){axis.x * p.x + axis.y * p.y, axis.x * p.y - axis.y * p.x, p.z};
}

/* What of a window is compared. */
typedef struct Sample {
    const MesoWindow *window;
    uint32_t count;
    MesoMatchPoint *points;     /* [count] in the window */
    MesoMatchPoint *turned;     /* [count] turned back onto the swatch */
    bool is_quilt;              /* its points have origins */
    double turn;                /* else how it is turned, */
    MesoVec2 home;              /* and where it is from: places within a radius do not count */
} Sample;

static void turn_back(Sample *sample, double turn)
{
    MesoVec2 axis = axis_of(turn);
    for (uint32_t i = 0; i < sample->count; i++)
        sample->turned[i] = (MesoMatchPoint){turned_back(sample->points[i].position, axis),
                                             turned_back(sample->points[i].normal, axis)};
}

static bool is_at_home(const Sample *sample, MesoVec2 shift, const Comparison *c)
{
    return !sample->is_quilt && meso_vec2_length(meso_vec2_sub(shift, sample->home)) < c->size.radius;
}

static float cost_at(Sample *sample, const Comparison *c, const Placing *placing)
{
    if (is_at_home(sample, placing->shift, c))
        return INFINITY;
    turn_back(sample, placing->turn);
    return meso_match_cost(&c->field, sample->turned, NULL, sample->count, placing->shift, 0, 1);
}

/* Moves and turns a window as long as that makes it better, by steps, at its rim, from one down to another; returns its
 * cost. */
static float slide(Placing *placing, float step, float finest, Sample *sample, const Comparison *c)
{
    static const float ways[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    float cost = cost_at(sample, c, placing);
    for (int failures = 0, way = 0; step > finest;) {
        Placing next = {placing->turn + (double)(step / c->size.radius * ways[way][2]),
                        {placing->shift.x + step * ways[way][0], placing->shift.y + step * ways[way][1]}};
        float price = cost_at(sample, c, &next);
        if (price < cost) {
            *placing = next;
            cost = price;
            failures = 0;
            continue;
        }
        way = (way + 1) % 6;
        if (++failures == 6) {
            failures = 0;
            step /= 2;
        }
    }
    return cost;
}

/* Where the point nearest to the middle is in the swatch: a place to begin with. */
static MesoVec2 origin_of(const Comparison *c, const MesoWindow *window, double turn)
{
    uint32_t nearest = window->inside[0];
    for (uint32_t i = 0; i < window->inside_count; i++) {
        MesoVec3 p = window->points[window->inside[i]].position, q = window->points[nearest].position;
        nearest = p.x * p.x + p.y * p.y < q.x * q.x + q.y * q.y ? window->inside[i] : nearest;
    }
    MesoVec3 at = c->swatch->positions[c->quilt->origins[window->vertices[nearest]]];
    MesoVec3 p = turned_back(window->points[nearest].position, axis_of(turn));
    return (MesoVec2){at.x - p.x, at.y - p.y};
}

/* Places to slide from, of one turn. */
static MesoStatus find_places(MesoVec2 *shifts, uint32_t *found, Sample *sample, const Comparison *c, double turn,
                              MesoError *error)
{
    MesoMatch matches[PLACES];
    uint32_t match_count = 0, kept = 0;
    const float r = c->size.radius;
    turn_back(sample, turn);
    MesoStatus status = meso_match_search(matches, &match_count, PLACES, 2 * c->field.voxel, &c->field, c->scratch,
                                          sample->turned, NULL, sample->count, (MesoVec2){-r, -r}, (MesoVec2){r, r}, 0,
                                          1, error);
    if (status)
        return status;
    for (uint32_t i = 0; i < match_count; i++)
        if (!is_at_home(sample, matches[i].shift, c))
            matches[kept++] = matches[i];
    if (kept)
        kept = meso_match_refine(matches, kept, kept < SLIDES ? kept : SLIDES, &c->field, sample->turned, NULL,
                                 sample->count, 1);
    *found = 0;
    for (uint32_t i = 0; i < kept; i++)
        shifts[(*found)++] = matches[i].shift;
    if (!sample->is_quilt)
        return MESO_OK;
    MesoVec2 origin = origin_of(c, sample->window, turn);
    bool known = false;
    for (uint32_t i = 0; i < *found; i++)
        known |= meso_vec2_length(meso_vec2_sub(shifts[i], origin)) < c->field.voxel;
    if (!known)
        shifts[(*found)++] = origin;
    return MESO_OK;
}

/* The best place for a window, by any of its turns. */
static MesoStatus find_place(Placing *best, bool *found, Sample *sample, const Comparison *c, MesoError *error)
{
    double turns[TURNS] = {sample->turn};
    uint32_t turn_count = sample->is_quilt ? find_turns(turns, c, sample->window) : 1;
    float least = INFINITY;
    *found = false;
    for (uint32_t t = 0; t < turn_count; t++) {
        MesoVec2 shifts[SLIDES + 1];
        uint32_t shift_count;
        MesoStatus status = find_places(shifts, &shift_count, sample, c, turns[t], error);
        if (status)
            return status;
        for (uint32_t i = 0; i < shift_count; i++) {
            Placing placing = {turns[t], shifts[i]};
            float cost = slide(&placing, c->field.voxel / 2, c->field.voxel / COARSE, sample, c);
            if (!(cost < least))
                continue;
            least = cost;
            *best = placing;
            *found = true;
        }
    }
    if (*found)
        slide(best, c->field.voxel / COARSE, FINEST * c->field.voxel, sample, c);
    return MESO_OK;
}

/* Mean distances both ways. */
static MesoStatus compare(double *distance, Sample *sample, const Comparison *c, const Placing *placing,
                          MesoError *error)
{
    const MesoWindow *window = sample->window;
    MesoNearestMesh there;
    MesoStatus status = meso_nearest_mesh_build(&there, c->scratch, window->points, window->corners,
                                                window->triangle_count, error);
    if (status)
        return status;
    double to = 0, from = 0;
    uint32_t from_count = 0;
    const MesoVec3 shift = {placing->shift.x, placing->shift.y, 0};
    const MesoVec2 back = axis_of(-placing->turn);
    const float most = c->size.radius;
    turn_back(sample, placing->turn);
    for (uint32_t i = 0; i < sample->count; i++)
        to += (double)meso_nearest_distance(&c->sample, meso_vec3_add(sample->turned[i].position, shift), most);
    for (uint32_t v = 0; v < c->swatch->vertex_count; v++) {
        MesoVec3 p = meso_vec3_sub(c->swatch->positions[v], shift);
        if (p.x * p.x + p.y * p.y > most * most)
            continue;
        from += (double)meso_nearest_distance(&there, turned_back(p, back), most);
        from_count++;
    }
    *distance = 0.5 * (to / sample->count + (from_count ? from / from_count : 0));
    return MESO_OK;
}

/* The distance of a window from its best place; found: there is such. */
static MesoStatus measure(double *distance, bool *found, Sample *sample, const Comparison *c, MesoError *error)
{
    const MesoWindow *window = sample->window;
    uint32_t stride = window->inside_count / MOST_POINTS + 1;
    Placing placing;
    *found = false;
    if (window->inside_count < LEAST_POINTS)
        return MESO_OK;
    sample->points = MESO_NEW(c->scratch, MesoMatchPoint, window->inside_count, error);
    sample->turned = MESO_NEW(c->scratch, MesoMatchPoint, window->inside_count, error);
    if (!sample->points || !sample->turned)
        return MESO_ERR_MEMORY;
    for (uint32_t i = 0; i < window->inside_count; i += stride)
        sample->points[sample->count++] = window->points[window->inside[i]];
    MesoStatus status = find_place(&placing, found, sample, c, error);
    return status || !*found ? status : compare(distance, sample, c, &placing, error);
}

/* ---- all windows ---- */

static MesoVec2 random_home(const Comparison *c, MesoRandom *random)
{
    const float r = c->size.radius;
    return (MesoVec2){r + (c->swatch->size.x - 2 * r) * (float)meso_random_share(random),
                      r + (c->swatch->size.y - 2 * r) * (float)meso_random_share(random)};
}

static MesoStatus measure_laid_window(MesoLikeness *likeness, Comparison *c, MesoRandom *random, MesoRandom *homes,
                                      MesoError *error)
{
    MesoWindow window;
    bool found;
    double distance, turn;
    MesoLaidSwatch laid = {c->swatch, random_home(c, homes), c->sample_locals};
    MesoStatus status = meso_check_layer_laid(&window, &found, &turn, &c->layer, &laid, c->scratch, random, c->size,
                                              error);
    if (!status && found)
        status = measure(&distance, &found, &(Sample){.window = &window, .turn = turn, .home = laid.home}, c, error);
    if (status || !found)
        return status;
    likeness->laid_distance += distance;
    c->laid_squares += distance * distance;
    likeness->laid_window_count++;
    return MESO_OK;
}

static MesoStatus measure_quilt_window(MesoLikeness *likeness, Comparison *c, MesoRandom *random, MesoRandom *homes,
                                       MesoError *error)
{
    MesoWindow window;
    MesoRandom same = *random;
    bool found;
    double distance;
    MesoStatus status = meso_check_layer_window(&window, &found, &c->layer, c->scratch, random, c->size, error);
    if (!status && found)
        status = measure(&distance, &found, &(Sample){.window = &window, .is_quilt = true}, c, error);
    if (status || !found)
        return status;
    likeness->distance += distance;
    c->squares += distance * distance;
    likeness->largest_distance = fmax(likeness->largest_distance, distance);
    likeness->window_count++;
    return measure_laid_window(likeness, c, &same, homes, error);
}

static MesoStatus measure_swatch_window(MesoLikeness *likeness, Comparison *c, MesoRandom *homes, MesoError *error)
{
    const MesoSwatch *swatch = c->swatch;
    MesoVec2 home = random_home(c, homes);
    const MesoVec3 middle = {home.x, home.y, 0};
    MesoWindow window;
    MesoStatus status = meso_window_init(&window, c->scratch, swatch->triangle_count, c->size.radius, c->size.reach,
                                         c->sample_locals, error);
    if (status)
        return status;
    for (uint32_t t = 0; t < swatch->triangle_count; t++) {
        const uint32_t *v = &swatch->corners[3 * (size_t)t];
        const MesoVec3 places[3] = {meso_vec3_sub(swatch->positions[v[0]], middle),
                                    meso_vec3_sub(swatch->positions[v[1]], middle),
                                    meso_vec3_sub(swatch->positions[v[2]], middle)};
        meso_window_add(&window, v, places);
    }
    meso_window_finish(&window);
    double distance = 0;
    bool found;
    status = measure(&distance, &found, &(Sample){.window = &window, .home = home}, c, error);
    if (status || !found)
        return status;
    likeness->swatch_distance += distance;
    likeness->swatch_window_count++;
    return MESO_OK;
}

static double mean(double sum, uint32_t count)
{
    return count ? sum / count : 0;
}

/* Distances to be told apart are no less than what sliding leaves. */
static double ratio_of(const MesoLikeness *likeness, double resolution)
{
    double laid = likeness->laid_window_count ? likeness->laid_distance : likeness->swatch_distance;
    return (likeness->distance + resolution) / (laid + resolution);
}

/* Of a mean, squared, as a share of `unit`. */
static double variance(double squares, double mean, uint32_t count, double unit)
{
    return count > 1 ? fmax(squares / count - mean * mean, 0) / (count - 1) / (unit * unit) : 0;
}

/* Of a quotient of two means: as if they were of different places, which is the most that it can be. */
static double error_of_ratio(const MesoLikeness *likeness, const Comparison *c, double resolution)
{
    const MesoLikeness *k = likeness;
    double laid = variance(c->laid_squares, k->laid_distance, k->laid_window_count, k->laid_distance + resolution);
    return k->ratio * sqrt(variance(c->squares, k->distance, k->window_count, k->distance + resolution) + laid);
}

static MesoStatus measure_all(MesoLikeness *likeness, Comparison *c, MesoError *error)
{
    MesoStatus status = MESO_OK;
    MesoRandom places, homes;
    uint32_t wanted = c->options->window_count ? c->options->window_count : WINDOWS;
    meso_random_init(&places, 1, 0);
    meso_random_init(&homes, 1, 1);
    for (uint32_t i = 0; i < TRIES * wanted && likeness->window_count < wanted && !status; i++) {
        MesoArenaMark mark = meso_arena_mark(c->scratch);
        status = measure_quilt_window(likeness, c, &places, &homes, error);
        meso_arena_rewind(c->scratch, mark);
    }
    for (uint32_t i = 0; i < TRIES * wanted && likeness->swatch_window_count < wanted && !status; i++) {
        MesoArenaMark mark = meso_arena_mark(c->scratch);
        status = measure_swatch_window(likeness, c, &homes, error);
        meso_arena_rewind(c->scratch, mark);
    }
    likeness->distance = mean(likeness->distance, likeness->window_count);
    likeness->laid_distance = mean(likeness->laid_distance, likeness->laid_window_count);
    likeness->swatch_distance = mean(likeness->swatch_distance, likeness->swatch_window_count);
    likeness->ratio = ratio_of(likeness, (double)(c->field.voxel * FINEST));
    likeness->ratio_error = error_of_ratio(likeness, c, (double)(c->field.voxel * FINEST));
    likeness->radius = (double)c->size.radius;
    return status;
}

MesoStatus meso_check_likeness(MesoLikeness *likeness, MesoArena *scratch, const MesoQuilt *quilt,
                               const MesoSwatch *swatch, const MesoVec3 *positions, const MesoTriangulation *base,
                               const MesoLikenessOptions *options, MesoError *error)
{
    *likeness = (MesoLikeness){0};
    if (quilt->triangle_count == 0 || base->triangle_count == 0)
        return MESO_OK;
    Comparison c = {.quilt = quilt, .swatch = swatch, .options = options, .scratch = scratch};
    MesoArenaMark mark = meso_arena_mark(scratch);
    MesoStatus status = meso_check_layer_init(&c.layer, scratch, quilt, swatch, positions, base, options->scale,
                                              options->height_scale, options->offset, error);
    if (!status)
        status = prepare_swatch(&c, error);
    if (!status)
        status = measure_all(likeness, &c, error);
    meso_check_layer_release(&c.layer);
    meso_arena_rewind(scratch, mark);
    return status;
}
