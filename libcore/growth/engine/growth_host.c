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

bool meso_growth_steps_clear(const MesoGrammar *grammar)
{
    for (uint32_t i = 0; i < grammar->code_count; i++) {
        const MesoGrammarInstruction *code = &grammar->code[i];
        bool gives = code->operation == MESO_OP_VALUE || code->operation == MESO_OP_VALUE_CONSTANT ||
                     code->operation == MESO_OP_VALUE_PRODUCT;
        if (gives && code->to == MESO_GROWTH_CLEAR)
            return true;
    }
    return false;
}

/* Where code can come to from an instruction, as far as it is known from where those lead that may be next. */
static uint8_t leads_to(const MesoGrammar *grammar, uint32_t at, const uint8_t *ahead)
{
    const MesoGrammarInstruction *code = &grammar->code[at];
    uint8_t next = at + 1 < grammar->code_count ? ahead[at + 1] : 0;
    switch (code->operation) {
    case MESO_OP_RULE: case MESO_OP_END: return MESO_AHEAD_END;
    case MESO_OP_LOOK: return MESO_AHEAD_LOOK;
    case MESO_OP_JUMP: return ahead[code->target];
    case MESO_OP_JUMP_UNLESS: case MESO_OP_JUMP_UNLESS_LESS: case MESO_OP_JUMP_IF: case MESO_OP_LOOP:
        return next | ahead[code->target];
    case MESO_OP_RESULT: case MESO_OP_STEP: case MESO_OP_MOVE: case MESO_OP_FACE: case MESO_OP_PLACE:
    case MESO_OP_BRANCH: return 0;
    default: return next;
    }
}

void meso_growth_look_ahead(const MesoGrammar *grammar, uint8_t *ahead)
{
    for (bool found = true; found;) {
        found = false;
        for (uint32_t i = grammar->code_count; i-- > 0;) {
            uint8_t leads = leads_to(grammar, i, ahead);
            found |= leads != ahead[i];
            ahead[i] = leads;
        }
    }
}

bool meso_growth_steps_avoid(const MesoGrammar *grammar)
{
    bool crosses = false;
    for (uint32_t i = 0; i < grammar->code_count; i++) {
        const MesoGrammarInstruction *code = &grammar->code[i];
        if (code->operation == MESO_OP_VALUE_CONSTANT && code->to == MESO_GROWTH_CROSS)
            crosses = grammar->constants[code->target] != 0;
        if (code->operation == MESO_OP_STEP && !crosses)
            return true;
        if (code->operation >= MESO_OP_STEP)
            crosses = false;
    }
    return meso_growth_steps_clear(grammar);
}
