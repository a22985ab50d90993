#include "libcore/growth/engine/growth_work.h"

static const MesoVec3 nowhere = {0, 0, 0};

MesoVec3 meso_growth_direction_in_space(const MesoGrowthGround *ground, uint32_t triangle, MesoComplex direction)
{
    double out[3];
    meso_walk_direction(ground->mesh, triangle, direction, out);
    return (MesoVec3){(float)out[0], (float)out[1], (float)out[2]};
}

static bool is_given(const MesoGrowthCommand *command, MesoGrowthValue value)
{
    return command->given >> value & 1;
}

static float width_from(const MesoGrowthCommand *command, double otherwise)
{
    double width = is_given(command, MESO_GROWTH_WIDTH) ? command->values[MESO_GROWTH_WIDTH] : otherwise;
    return (float)fmax(width, 0);
}

static float width_to(const MesoGrowthCommand *command, float from)
{
    return is_given(command, MESO_GROWTH_END_WIDTH) ? (float)fmax(command->values[MESO_GROWTH_END_WIDTH], 0) : from;
}

static MesoJoint rolled(MesoJoint joint, float roll)
{
    return roll == 0 ? joint : meso_joint_roll(joint, roll);
}

/* The joint that a tip is at, now that it goes on towards `out`. */
static MesoJoint begin_joint(const MesoGrowthTip *tip, MesoVec3 out, float width, float lift, float roll)
{
    return rolled(meso_joint(tip->position, tip->normal, tip->arrive, out, width, lift), roll);
}

/* Where a step's own width begins with another than the joint has, it has a joint of its own in the same place. */
static void join_step(const MesoGrowthTip *tip, MesoGrowthTurn *turn, MesoVec3 out)
{
    const MesoGrowthCommand *command = &turn->command;
    bool has = tip->joint != MESO_NO_INDEX;
    float had = (float)tip->state[MESO_STATE_WIDTH], width = width_from(command, has ? had : 0);
    float lift = is_given(command, MESO_GROWTH_LIFT) ? (float)command->values[MESO_GROWTH_LIFT] : tip->lift;
    float roll = is_given(command, MESO_GROWTH_ROLL) ? (float)command->values[MESO_GROWTH_ROLL] : tip->roll;
    float lift_from = has ? tip->lift : lift, roll_from = has ? tip->roll : roll;
    turn->lift = lift;
    turn->roll = roll;
    turn->shares = has && (width == had || (tip->open && tip->shape == command->shape));
    turn->from = begin_joint(tip, out, width, lift_from, roll_from);
    if (has && !turn->shares)
        turn->before = begin_joint(tip, out, had, lift_from, roll_from);
    turn->to = rolled(meso_joint(turn->position, turn->normal, turn->arrive, nowhere, width_to(command, width), lift),
                      roll);
}

/* Turns a vector about a unit axis. */
static MesoVec3 turned_about(MesoVec3 v, MesoVec3 axis, float sine, float cosine)
{
    MesoVec3 out = meso_vec3_scale(v, cosine);
    out = meso_vec3_mad(out, sine, meso_vec3_cross(axis, v));
    return meso_vec3_mad(out, meso_vec3_dot(axis, v) * (1 - cosine), axis);
}

/* Tilted up, about the left of where the shape begins. */
static void tilt(MesoGrowthTurn *turn, float angle)
{
    MesoVec3 left = meso_vec3_cross(turn->from.normal, turn->from.tangent), start = turn->from.position;
    float sine = sinf(-angle), cosine = cosf(angle);
    MesoVec3 way = meso_vec3_sub(turn->to.position, start);
    turn->to.position = meso_vec3_add(start, turned_about(way, left, sine, cosine));
    for (int end = 0; end < 2; end++) {
        MesoJoint *joint = end ? &turn->to : &turn->from;
        joint->tangent = turned_about(joint->tangent, left, sine, cosine);
        joint->normal = turned_about(joint->normal, left, sine, cosine);
    }
}

static void join_place(const MesoGrowthTip *tip, MesoGrowthTurn *turn, MesoVec3 out)
{
    const MesoGrowthCommand *command = &turn->command;
    float width = width_from(command, turn->length), lift = (float)command->values[MESO_GROWTH_LIFT];
    float roll = (float)command->values[MESO_GROWTH_ROLL], angle = (float)command->values[MESO_GROWTH_ANGLE];
    MesoVec3 end = meso_vec3_mad(turn->position, (float)turn->rest, turn->arrive);
    turn->from = meso_joint(tip->position, tip->normal, nowhere, out, width, lift);
    turn->to = meso_joint(end, turn->normal, turn->arrive, nowhere, width_to(command, width), lift);
    if (angle != 0)
        tilt(turn, angle);
    turn->from = rolled(turn->from, roll);
    turn->to = rolled(turn->to, roll);
}

void meso_growth_join(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn)
{
    const MesoGrowthGround *ground = work->ground;
    turn->position = meso_growth_position(ground, turn->end.triangle, turn->end.weight);
    turn->normal = meso_growth_normal(ground, turn->end.triangle, turn->end.weight, turn->end.turned);
    if (turn->outcome == MESO_GROWTH_MOVES)
        return;
    MesoTip start = tip->at;
    if (turn->try > 0 && turn->outcome == MESO_GROWTH_STEPS)
        meso_tip_turn(&start, meso_growth_retry_angle(tip, turn, turn->try));
    MesoVec3 out = meso_growth_direction_in_space(ground, start.triangle, start.heading);
    turn->arrive = meso_growth_direction_in_space(ground, turn->end.triangle, turn->end.heading);
    if (turn->outcome == MESO_GROWTH_PLACES)
        join_place(tip, turn, out);
    else
        join_step(tip, turn, out);
}
