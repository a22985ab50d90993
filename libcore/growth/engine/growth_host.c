#include "libcore/growth/engine/growth_work.h"
#include "libcore/growth/language/grammar_operation.h"

void meso_growth_depends(MesoGrowthTurn *turn, MesoVec3 center, double radius)
{
    MesoVec3 old = {turn->ball[0], turn->ball[1], turn->ball[2]};
    float reach = (float)(radius * 1.0001);
    if (turn->ball[3] < 0) {
        turn->ball[0] = center.x;
        turn->ball[1] = center.y;
        turn->ball[2] = center.z;
        turn->ball[3] = reach;
    } else {
        turn->ball[3] = fmaxf(turn->ball[3], meso_vec3_length(meso_vec3_sub(center, old)) * 1.0001f + reach);
    }
}

MesoGrowthAsker meso_growth_asker(const MesoGrowthTip *tip, uint32_t since)
{
    return (MesoGrowthAsker){tip->node, tip->moved, tip->state[MESO_STATE_LENGTH], since};
}

static MesoVec3 place_of(const MesoGrowthAsking *asking)
{
    const MesoTip *at = asking->at;
    return meso_growth_position(asking->work->ground, at->triangle, at->weight);
}

static bool is_clear_at(const MesoGrowthAsking *asking, double clear)
{
    const MesoTip *at = asking->at;
    MesoComplex corners[3];
    MesoGrowthAsker asker = meso_growth_asker(asking->tip, 0);
    meso_walk_corners(&asking->work->ground->walk, at->triangle, corners);
    MesoComplex point = meso_walk_point(corners, at->weight);
    MesoGrowthPiece here = {{point, point}, at->triangle, at->turned};
    return meso_growth_is_clear(&asking->work->space, &asking->batch->seen, &asker, &here, 1, clear, true);
}

static bool meets_ahead(const MesoGrowthAsking *asking, double length, double angle)
{
    MesoGrowthTurn apart = {.piece_count = 0};
    MesoWalk walk = {.tip = *asking->at, .length = fmax(length, 0)};
    MesoGrowthAsker asker = meso_growth_asker(asking->tip, 0);
    MesoGrowthBatch *batch = asking->batch;
    uint32_t used = batch->piece_count;
    meso_tip_turn(&walk.tip, angle);
    meso_growth_walk(asking->work, batch, &walk, &apart);
    bool meets = meso_growth_meets(&asking->work->space, &asker, batch->pieces + apart.piece_begin, apart.piece_count,
                                   NULL);
    batch->piece_count = used;
    return meets;
}

double meso_growth_look(void *context, MesoGrowthLook look, uint32_t map, double a, double b)
{
    const MesoGrowthAsking *asking = context;
    if (look != MESO_LOOK_CLEAR && look != MESO_LOOK_MEETS)
        return meso_growth_answer(asking->work->options->contexts, asking->at, look, map, a, b);
    if (!(isfinite(a) && isfinite(b)))
        return look == MESO_LOOK_CLEAR;
    asking->turn->looked = true;
    meso_growth_depends(asking->turn, place_of(asking), fmax(a, 0));
    return look == MESO_LOOK_CLEAR ? is_clear_at(asking, a) : meets_ahead(asking, a, b);
}

/* ---- what a grammar asks for ---- */

bool meso_growth_rules_look(const MesoGrammar *grammar)
{
    for (uint32_t i = 0; i < grammar->code_count; i++) {
        const MesoGrammarInstruction *code = &grammar->code[i];
        if (code->operation == MESO_OP_LOOK && (code->target == MESO_LOOK_CLEAR || code->target == MESO_LOOK_MEETS))
            return true;
    }
    return false;
}

static bool is_true(const MesoGrammar *grammar, uint16_t operand)
{
    return operand & MESO_CONSTANT_OPERAND && operand != MESO_NO_REGISTER &&
           grammar->constants[operand & (MESO_CONSTANT_OPERAND - 1)] != 0;
}

bool meso_growth_steps_clear(const MesoGrammar *grammar)
{
    for (uint32_t i = 0; i < grammar->code_count; i++) {
        const MesoGrammarInstruction *code = &grammar->code[i];
        bool gives = code->operation == MESO_OP_VALUE || code->operation == MESO_OP_VALUE_PRODUCT;
        if (gives && code->to == MESO_GROWTH_CLEAR)
            return true;
    }
    return false;
}

bool meso_growth_steps_avoid(const MesoGrammar *grammar)
{
    bool crosses = false;
    for (uint32_t i = 0; i < grammar->code_count; i++) {
        const MesoGrammarInstruction *code = &grammar->code[i];
        if (code->operation == MESO_OP_VALUE && code->to == MESO_GROWTH_CROSS)
            crosses = is_true(grammar, code->a);
        if (code->operation == MESO_OP_STEP && !crosses)
            return true;
        if (code->operation >= MESO_OP_STEP)
            crosses = false;
    }
    return meso_growth_steps_clear(grammar);
}
