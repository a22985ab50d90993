#include "libcore/growth/engine/growth_work.h"

static const MesoFour nowhere = {0, 0, 0, 0};

/* As meso_growth_normal() has it, where all is wound alike. */
static MesoFour normal_at(const MesoGrowthGround *ground, const MesoTip *at, const uint32_t corners[3])
{
    MesoFour sum = nowhere;
    for (uint32_t k = 0; k < 3; k++)
        sum = meso_four_mad(sum, (float)(at->turned ? -at->weight[k] : at->weight[k]),
                            meso_four_of(ground->normals[corners[k]]));
    float length = sqrtf(meso_four_dot(sum, sum));
    if (ground->against || !(length > 1e-6f))
        return meso_four_of(meso_growth_normal(ground, at->triangle, at->weight, at->turned));
    return meso_four_scale(sum, 1 / length);
}

/* As meso_frame() has it, by what the walk knows of the triangle. */
static inline void set_foot(MesoGrowthFooting *foot, const MesoGrowthGround *ground, const MesoTip *at)
{
    const MesoTriangulation *mesh = ground->mesh;
    const MesoWalkFace *face = &ground->walk.faces[at->triangle];
    const uint32_t *c = &mesh->corners[3 * (size_t)at->triangle];
    uint32_t base = meso_walk_base(face), next = meso_next_side(base), far = meso_previous_side(base);
    MesoFour origin = meso_four_of(mesh->positions[c[base]]);
    MesoFour along = meso_four_of(mesh->positions[c[next]]) - origin;
    MesoFour over = meso_four_of(mesh->positions[c[far]]) - origin;
    float length = (float)ground->walk.lengths[at->triangle];
    MesoComplex apex = face->apexes[base];
    float height = length * (float)apex.im;
    MesoFour position = nowhere;
    for (uint32_t k = 0; k < 3; k++)
        position = meso_four_mad(position, (float)at->weight[k], meso_four_of(mesh->positions[c[k]]));
    foot->position = position;
    foot->normal = normal_at(ground, at, c);
    foot->x = meso_four_scale(along, length > 0 ? 1 / length : 0);
    foot->y = meso_four_scale(meso_four_mad(over, -(float)apex.re, along), height > 0 ? 1 / height : 0);
}

MesoGrowthFooting meso_growth_foot(const MesoGrowthGround *ground, const MesoTip *at)
{
    MesoGrowthFooting foot;
    set_foot(&foot, ground, at);
    return foot;
}

static inline MesoFour in_space(const MesoGrowthFooting *foot, MesoComplex direction)
{
    return meso_four_mad(meso_four_scale(foot->x, (float)direction.re), (float)direction.im, foot->y);
}

static bool is_given(const MesoGrowthCommand *command, MesoGrowthValue value)
{
    return command->given >> value & 1;
}

static float width_from(const MesoGrowthCommand *command, double otherwise)
{
    double width = is_given(command, MESO_GROWTH_WIDTH) ? command->values[MESO_GROWTH_WIDTH] : otherwise;
    return width > 0 ? (float)width : 0;
}

static float width_to(const MesoGrowthCommand *command, float from)
{
    double width = command->values[MESO_GROWTH_END_WIDTH];
    return !is_given(command, MESO_GROWTH_END_WIDTH) ? from : width > 0 ? (float)width : 0;
}

static void roll_seat(MesoGrowthSeat *seat, float roll)
{
    if (roll != 0)
        *seat = meso_seat_of(meso_joint_roll(meso_seat_joint(seat), roll));
}

/* Of length 1, and across the normal; 0 where it has no such part. */
static inline MesoFour laid_flat(MesoFour v, MesoFour normal)
{
    MesoFour flat = meso_four_mad(v, -meso_four_dot(v, normal), normal);
    float square = meso_four_dot(flat, flat);
    return meso_four_scale(flat, square > 1e-12f ? 1 / sqrtf(square) : 0);
}

/* Where a branch turns back, or stands. */
static void seat_back(MesoGrowthSeat *seat, const MesoGrowthFooting *foot, MesoFour in, MesoFour out, float width,
                      float lift)
{
    *seat = meso_seat_of(meso_joint(meso_four_vec3(foot->position), meso_four_vec3(foot->normal), meso_four_vec3(in),
                                    meso_four_vec3(out), width, lift));
}

/* As meso_joint() makes it, of directions that are laid flat. */
static inline void set_seat(MesoGrowthSeat *seat, const MesoGrowthFooting *foot, MesoFour in, MesoFour out,
                            float width, float lift)
{
    MesoFour sum = in + out;
    float square = meso_four_dot(sum, sum);
    if (!(square > 1e-6f)) {
        seat_back(seat, foot, in, out, width, lift);
        return;
    }
    seat->position = meso_four_mad(foot->position, lift, foot->normal);
    seat->tangent = meso_four_scale(sum, 1 / sqrtf(square));
    seat->normal = foot->normal;
    seat->width = width;
}

MesoGrowthSeat meso_growth_joint_on(const MesoGrowthGround *ground, const MesoTip *at, float width, float lift,
                                    float roll)
{
    MesoGrowthFooting foot;
    MesoGrowthSeat seat;
    set_foot(&foot, ground, at);
    set_seat(&seat, &foot, nowhere, laid_flat(in_space(&foot, at->heading), foot.normal), width, lift);
    roll_seat(&seat, roll);
    return seat;
}

/* Whether a shape is the same all along, so that several of it are one. */
static bool is_alike_along(const MesoGrammar *grammar, uint32_t shape)
{
    return shape == MESO_NO_INDEX || grammar->shapes[shape].kind == MESO_SHAPE_TUBE ||
           grammar->shapes[shape].kind == MESO_SHAPE_SECTION;
}

/* Where a step's own width begins with another than the joint has, it has a joint of its own in the same place. */
static void join_step(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn, MesoFour out)
{
    const MesoGrowthCommand *command = &turn->command;
    bool has = tip->joint != MESO_NO_INDEX;
    float had = (float)tip->state[MESO_STATE_WIDTH], width = width_from(command, has ? had : 0);
    float lift = is_given(command, MESO_GROWTH_LIFT) ? (float)command->values[MESO_GROWTH_LIFT] : tip->lift;
    float roll = is_given(command, MESO_GROWTH_ROLL) ? (float)command->values[MESO_GROWTH_ROLL] : tip->roll;
    float lift_from = has ? tip->lift : lift, roll_from = has ? tip->roll : roll;
    turn->lift = lift;
    turn->roll = roll;
    turn->had = had;
    turn->shares = has && (width == had || (tip->open && tip->shape == command->shape));
    set_seat(&turn->from, &tip->foot, tip->arrive, out, width, lift_from + (has ? tip->raise : 0));
    set_seat(&turn->to, &turn->foot, turn->arrive, nowhere, width_to(command, width), lift);
    roll_seat(&turn->from, roll_from);
    roll_seat(&turn->to, roll);
    meso_growth_surface(work, tip, turn, is_alike_along(work->grammar, command->shape), lift_from, roll_from);
}

/* Turns a vector about a unit axis. */
static MesoFour turned_about(MesoFour v, MesoFour axis, float sine, float cosine)
{
    MesoFour out = meso_four_mad(meso_four_scale(v, cosine), sine, meso_four_cross(axis, v));
    return meso_four_mad(out, meso_four_dot(axis, v) * (1 - cosine), axis);
}

/* Tilted up, about the left of where the shape begins. */
static void tilt(MesoGrowthTurn *turn, float angle)
{
    MesoFour left = meso_four_cross(turn->from.normal, turn->from.tangent), start = turn->from.position;
    float sine = sinf(-angle), cosine = cosf(angle);
    turn->to.position = start + turned_about(turn->to.position - start, left, sine, cosine);
    for (int end = 0; end < 2; end++) {
        MesoGrowthSeat *seat = end ? &turn->to : &turn->from;
        seat->tangent = turned_about(seat->tangent, left, sine, cosine);
        seat->normal = turned_about(seat->normal, left, sine, cosine);
    }
}

/* Placed shapes are raised for themselves alone. */
static void join_place(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn, MesoFour out)
{
    const MesoGrowthCommand *command = &turn->command;
    float width = width_from(command, turn->length), lift = (float)command->values[MESO_GROWTH_LIFT];
    float roll = (float)command->values[MESO_GROWTH_ROLL], angle = (float)command->values[MESO_GROWTH_ANGLE];
    set_seat(&turn->from, &tip->foot, nowhere, out, width, lift);
    set_seat(&turn->to, &turn->foot, turn->arrive, nowhere, width_to(command, width), lift);
    turn->to.position = meso_four_mad(turn->to.position, (float)turn->rest, turn->arrive);
    if (angle != 0) {
        tilt(turn, angle);
    } else {
        MesoGrowthTip apart = *tip;
        apart.raise = 0;
        meso_growth_surface(work, &apart, turn, false, lift, roll);
    }
    roll_seat(&turn->from, roll);
    roll_seat(&turn->to, roll);
}

void meso_growth_join(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn)
{
    turn->middle_count = 0;
    set_foot(&turn->foot, work->ground, &turn->end);
    if (turn->outcome == MESO_GROWTH_MOVES)
        return;
    MesoTip start = {.turned = tip->at.turned, .heading = tip->at.heading};
    if (turn->try > 0 && turn->outcome == MESO_GROWTH_STEPS)
        meso_tip_turn(&start, meso_growth_retry_angle(tip, turn, turn->try));
    MesoFour out = laid_flat(in_space(&tip->foot, start.heading), tip->foot.normal);
    turn->arrive = laid_flat(in_space(&turn->foot, turn->end.heading), turn->foot.normal);
    if (turn->outcome == MESO_GROWTH_PLACES)
        join_place(work, tip, turn, out);
    else
        join_step(work, tip, turn, out);
}
