#include "libcore/growth/engine/growth_work.h"

static const MesoVec3 nowhere = {0, 0, 0};

/* As meso_frame() has it, by what the walk knows of the triangle. */
MesoGrowthFooting meso_growth_foot(const MesoGrowthGround *ground, const MesoTip *at)
{
    const MesoTriangulation *mesh = ground->mesh;
    const MesoWalkFace *face = &ground->walk.faces[at->triangle];
    const uint32_t *c = &mesh->corners[3 * (size_t)at->triangle];
    uint32_t base = meso_walk_base(face);
    MesoVec3 p[3] = {mesh->positions[c[0]], mesh->positions[c[1]], mesh->positions[c[2]]};
    MesoVec3 along = meso_vec3_sub(p[meso_next_side(base)], p[base]), over = meso_vec3_sub(p[meso_previous_side(base)],
                                                                                         p[base]);
    float length = (float)ground->walk.lengths[at->triangle];
    MesoComplex apex = face->apexes[base];
    MesoGrowthFooting foot = {.x = meso_vec3_scale(along, length > 0 ? 1 / length : 0)};
    float height = length * (float)apex.im;
    foot.y = meso_vec3_scale(meso_vec3_mad(over, -(float)apex.re, along), height > 0 ? 1 / height : 0);
    for (uint32_t k = 0; k < 3; k++)
        foot.position = meso_vec3_mad(foot.position, (float)at->weight[k], p[k]);
    foot.normal = meso_growth_normal(ground, at->triangle, at->weight, at->turned);
    return foot;
}

static MesoVec3 in_space(const MesoGrowthFooting *foot, MesoComplex direction)
{
    return meso_vec3_mad(meso_vec3_scale(foot->x, (float)direction.re), (float)direction.im, foot->y);
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

static MesoJoint rolled(MesoJoint joint, float roll)
{
    return roll == 0 ? joint : meso_joint_roll(joint, roll);
}

/* Of length 1, and across the normal; 0 where it has no such part. */
static MesoVec3 laid_flat(MesoVec3 v, MesoVec3 normal)
{
    MesoVec3 flat = meso_vec3_mad(v, -meso_vec3_dot(v, normal), normal);
    float square = meso_vec3_dot(flat, flat);
    return meso_vec3_scale(flat, square > 1e-12f ? 1 / sqrtf(square) : 0);
}

/* As meso_joint() makes it, of directions that are laid flat. */
static MesoJoint joint_of(const MesoGrowthFooting *foot, MesoVec3 in, MesoVec3 out, float width, float lift)
{
    MesoVec3 sum = meso_vec3_add(in, out);
    float square = meso_vec3_dot(sum, sum);
    if (!(square > 1e-6f))
        return meso_joint(foot->position, foot->normal, in, out, width, lift);
    return (MesoJoint){meso_vec3_mad(foot->position, lift, foot->normal), meso_vec3_scale(sum, 1 / sqrtf(square)),
                       foot->normal, width, 0};
}

MesoJoint meso_growth_joint_on(const MesoGrowthGround *ground, const MesoTip *at, float width, float lift, float roll)
{
    MesoGrowthFooting foot = meso_growth_foot(ground, at);
    return rolled(joint_of(&foot, nowhere, laid_flat(in_space(&foot, at->heading), foot.normal), width, lift), roll);
}

/* Whether a shape is the same all along, so that several of it are one. */
static bool is_alike_along(const MesoGrammar *grammar, uint32_t shape)
{
    return shape == MESO_NO_INDEX || grammar->shapes[shape].kind == MESO_SHAPE_TUBE ||
           grammar->shapes[shape].kind == MESO_SHAPE_SECTION;
}

/* Where a step's own width begins with another than the joint has, it has a joint of its own in the same place. */
static void join_step(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn, MesoVec3 out)
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
    turn->from = rolled(joint_of(&tip->foot, tip->arrive, out, width, lift_from + (has ? tip->raise : 0)), roll_from);
    turn->to = rolled(joint_of(&turn->foot, turn->arrive, nowhere, width_to(command, width), lift), roll);
    meso_growth_surface(work, tip, turn, is_alike_along(work->grammar, command->shape), lift_from, roll_from);
    if (has && !turn->shares) {
        turn->before = turn->from;
        turn->before.width = had;
    }
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

/* Placed shapes are raised for themselves alone. */
static void join_place(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn, MesoVec3 out)
{
    const MesoGrowthCommand *command = &turn->command;
    float width = width_from(command, turn->length), lift = (float)command->values[MESO_GROWTH_LIFT];
    float roll = (float)command->values[MESO_GROWTH_ROLL], angle = (float)command->values[MESO_GROWTH_ANGLE];
    turn->from = joint_of(&tip->foot, nowhere, out, width, lift);
    turn->to = joint_of(&turn->foot, turn->arrive, nowhere, width_to(command, width), lift);
    turn->to.position = meso_vec3_mad(turn->to.position, (float)turn->rest, turn->arrive);
    if (angle != 0) {
        tilt(turn, angle);
    } else {
        MesoGrowthTip apart = *tip;
        apart.raise = 0;
        meso_growth_surface(work, &apart, turn, false, lift, roll);
    }
    turn->from = rolled(turn->from, roll);
    turn->to = rolled(turn->to, roll);
}

void meso_growth_join(const MesoGrowthWork *work, const MesoGrowthTip *tip, MesoGrowthTurn *turn)
{
    turn->middle_count = 0;
    turn->foot = meso_growth_foot(work->ground, &turn->end);
    if (turn->outcome == MESO_GROWTH_MOVES)
        return;
    MesoTip start = tip->at;
    if (turn->try > 0 && turn->outcome == MESO_GROWTH_STEPS)
        meso_tip_turn(&start, meso_growth_retry_angle(tip, turn, turn->try));
    MesoVec3 out = laid_flat(in_space(&tip->foot, start.heading), tip->foot.normal);
    turn->arrive = laid_flat(in_space(&turn->foot, turn->end.heading), turn->foot.normal);
    if (turn->outcome == MESO_GROWTH_PLACES)
        join_place(work, tip, turn, out);
    else
        join_step(work, tip, turn, out);
}
