#include "libcore/geodesic/transport/vertex_tip.h"

/* ---- fans ---- */

/* The angle of a triangle at a corner. */
static double angle_at(const MesoWalkGround *ground, uint32_t corner)
{
    MesoComplex apex = ground->faces[corner / 3].apexes[corner % 3];
    return atan2(apex.im, apex.re);
}

/* As meso_fan_next(), over the ground, which may be a part of the mesh. */
static bool next_place(const MesoWalkGround *ground, MesoFan *fan)
{
    uint32_t exit = meso_fan_exit(*fan);
    const MesoWalkFace *face = &ground->faces[exit / 3];
    uint32_t across = face->twins[exit % 3];
    if (across == MESO_NO_INDEX)
        return false;
    fan->turned ^= meso_walk_turns(face, exit % 3);
    fan->corner = fan->turned ? meso_next_corner(across) : across;
    return true;
}

MesoVertexTurn meso_vertex_turn(const MesoWalkGround *ground, uint32_t corner)
{
    MesoVertexTurn turn = {0, 0, false};
    MesoFan fan = {corner, false};
    do {
        turn.angle += angle_at(ground, fan.corner);
        turn.closed = next_place(ground, &fan);
    } while (turn.closed && fan.corner != corner);
    fan = (MesoFan){corner, true};
    while (!turn.closed && next_place(ground, &fan))
        turn.before += angle_at(ground, fan.corner);
    turn.angle += turn.before;
    return turn;
}

/* What angles around the vertex are times, to be scaled. */
static double scale_of(const MesoVertexTurn *turn)
{
    return (turn->closed ? 2 : 1) * MESO_PI / turn->angle;
}

/* ---- tips ---- */

/* A tip in a place of a fan, at an angle from the side by which the fan has come in. */
static MesoTip tip_in(const MesoWalkGround *ground, MesoFan fan, double angle)
{
    MesoTip tip = {.triangle = fan.corner / 3};
    const MesoWalkFace *face = &ground->faces[tip.triangle];
    MesoComplex along = meso_walk_side(face, meso_fan_entry(fan) % 3);
    if (fan.turned)     /* that side ends at the vertex, and the triangle lies to the right of whoever goes back */
        along = (MesoComplex){-along.re, -along.im};
    MesoComplex turn = {cos(angle), sin(fan.turned ? -angle : angle)};
    tip.weight[fan.corner % 3] = 1;
    tip.heading = meso_complex_unit(meso_complex_times(along, turn));
    return tip;
}

bool meso_vertex_tip(const MesoWalkGround *ground, uint32_t corner, double angle, MesoTip *tip)
{
    const double rounding = 1e-12;      /* of the angle, by which a direction along a border may be outside */
    MesoVertexTurn turn = meso_vertex_turn(ground, corner);
    if (!(turn.angle > 0) || !isfinite(angle))
        return false;
    double rest = angle / scale_of(&turn), slack = rounding * turn.angle;
    if (turn.closed)
        rest -= turn.angle * floor(rest / turn.angle);
    else if (rest < -turn.before - slack || rest > turn.angle - turn.before + slack)
        return false;
    MesoFan fan = {corner, true};
    bool backwards = rest < 0 && next_place(ground, &fan);
    if (!backwards)
        fan.turned = false;
    rest = backwards ? -rest : fmax(rest, 0);
    double here = angle_at(ground, fan.corner);
    while (rest > here) {
        MesoFan next = fan;
        if (!next_place(ground, &next) || next.corner == corner)
            break;
        rest -= here;
        fan = next;
        here = angle_at(ground, fan.corner);
    }
    *tip = tip_in(ground, fan, fmin(rest, here));
    tip->turned = fan.turned != backwards;
    return true;
}

double meso_vertex_angle(const MesoWalkGround *ground, uint32_t corner, MesoComplex direction)
{
    MesoComplex along = meso_walk_side(&ground->faces[corner / 3], corner % 3);
    MesoComplex from_side = meso_complex_times(direction, meso_complex_conjugate(along));
    MesoVertexTurn turn = meso_vertex_turn(ground, corner);
    return atan2(from_side.im, from_side.re) * scale_of(&turn);
}

bool meso_tip_pass_vertex(const MesoWalkGround *ground, MesoTip *tip, uint32_t k)
{
    uint32_t corner = 3 * tip->triangle + k;
    MesoComplex back = {-tip->heading.re, -tip->heading.im};
    MesoTip beyond;
    if (!meso_vertex_tip(ground, corner, meso_vertex_angle(ground, corner, back) + MESO_PI, &beyond))
        return false;
    beyond.turned = beyond.turned != tip->turned;
    *tip = beyond;
    return true;
}
