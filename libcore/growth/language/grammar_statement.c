#include "libcore/growth/language/grammar_parser.h"

enum { DEEPEST_LOOP = 3 };

static MesoStatement *new_statement(MesoGrammarParser *parser, MesoStatementKind kind)
{
    MesoStatement *statement = meso_parse_allocate(parser, 1, sizeof *statement);
    if (!statement)
        statement = &parser->no_statement;
    *statement = (MesoStatement){.kind = kind, .at = parser->token, .salt = parser->salt, .site = MESO_NO_INDEX,
                                 .shape = MESO_NO_INDEX};
    return statement;
}

static void parse_let(MesoGrammarParser *parser, MesoStatement *let)
{
    meso_parse_advance(parser);
    MesoToken name = meso_parse_new_name(parser, "a quantity");
    meso_parse_expect(parser, "=", "behind the name");
    let->expression = meso_parse_expression(parser);
    let->local = meso_parse_add_local(parser, &name);
}

static void parse_if(MesoGrammarParser *parser, MesoStatement *branch)
{
    meso_parse_advance(parser);
    branch->expression = meso_parse_expression(parser);
    branch->block = meso_parse_block(parser);
    if (meso_parse_accept(parser, "else"))
        branch->otherwise = meso_parse_at(parser, "if") ? meso_parse_body(parser) : meso_parse_block(parser);
}

static void parse_choose(MesoGrammarParser *parser, MesoStatement *choice)
{
    MesoArm **next = &choice->arms;
    meso_parse_advance(parser);
    choice->site = meso_parse_site(parser, false);
    meso_parse_expect(parser, "{", "behind 'choose'");
    do {
        MesoArm *arm = meso_parse_allocate(parser, 1, sizeof *arm);
        if (!arm)
            return;
        arm->weight = meso_parse_expression(parser);
        meso_parse_expect(parser, ":", "behind the weight of a choice");
        arm->block = meso_parse_body(parser);
        *next = arm;
        next = &arm->next;
    } while (meso_parsing(parser) && !meso_parse_accept(parser, "}"));
}

/* Registers of the counter, the salt and the number of turns follow one another. */
static void parse_repeat(MesoGrammarParser *parser, MesoStatement *loop)
{
    uint32_t salt = parser->salt, scope = parser->scope_count, locals = parser->local_count;
    MesoToken name;
    bool named;
    meso_parse_advance(parser);
    if (++parser->loop_depth > DEEPEST_LOOP)
        meso_grammar_wrong(&parser->lexer, &loop->at, "more than %d repetitions in one another", (int)DEEPEST_LOOP);
    loop->expression = meso_parse_expression(parser);
    named = meso_parse_accept(parser, "as");
    if (named)
        name = meso_parse_new_name(parser, "a counter");
    loop->local = meso_parse_add_local(parser, named ? &name : NULL);
    parser->salt = meso_parse_add_local(parser, NULL);
    meso_parse_add_local(parser, NULL);
    loop->block = meso_parse_block(parser);
    parser->salt = salt;
    parser->scope_count = scope;
    parser->local_count = locals;
    parser->loop_depth--;
}

static void parse_retry(MesoGrammarParser *parser, MesoStatement *step)
{
    meso_parse_expect(parser, "(", "behind 'retry'");
    step->retries = meso_parse_expression(parser);
    meso_parse_expect(parser, ",", "between the number of tries and their angle");
    step->retry_angle = meso_parse_expression(parser);
    meso_parse_expect(parser, ")", "behind the angle of 'retry'");
}

/* What holds all along a step, and what is done when it is refused. */
static void parse_step_end(MesoGrammarParser *parser, MesoStatement *step)
{
    if (meso_parse_accept(parser, "while"))
        step->expression = meso_parse_expression(parser);
    bool otherwise = meso_parse_accept(parser, "else");
    if (otherwise && meso_parse_accept(parser, "retry")) {
        parse_retry(parser, step);
        otherwise = meso_parse_accept(parser, "else");
    }
    if (otherwise && meso_parse_accept(parser, "join"))
        step->join = true;
    else if (otherwise) {
        step->caught = true;
        step->otherwise = meso_parse_body(parser);
    }
}

static void parse_command(MesoGrammarParser *parser, MesoStatement *command)
{
    const MesoGrammarCommandWord *word = command->command;
    meso_parse_advance(parser);
    if (word->operation == MESO_OP_PLACE) {
        const MesoNamed *named = meso_parse_find(parser, &parser->token);
        if (!named || named->kind != MESO_NAME_SHAPE)
            meso_parse_unknown(parser, &parser->token, "a shape", MESO_NAME_SHAPE, NULL);
        else
            command->shape = named->index;
        meso_parse_advance(parser);
    }
    meso_parse_arguments(parser, &command->at, word->slots, command->arguments);
    if (word->operation == MESO_OP_STEP)
        parse_step_end(parser, command);
}

static void parse_branch(MesoGrammarParser *parser, MesoStatement *branch)
{
    branch->site = meso_parse_site(parser, true);
    meso_parse_advance(parser);
    branch->block = meso_parse_block(parser);
}

MesoStatement *meso_parse_rule_call(MesoGrammarParser *parser)
{
    MesoStatement *call = new_statement(parser, MESO_STATEMENT_RULE);
    call->rule = meso_parse_rule_number(parser, &call->at);
    meso_parse_advance(parser);
    meso_parse_expect(parser, "(", "behind the name of a rule");
    call->site = meso_parse_site(parser, true);
    bool more = !meso_parse_at(parser, ")");
    while (more && meso_parsing(parser)) {
        if (call->argument_count == MESO_GRAMMAR_ARGUMENTS) {
            meso_grammar_wrong(&parser->lexer, &parser->token, "a rule has at most %d arguments",
                               (int)MESO_GRAMMAR_ARGUMENTS);
            break;
        }
        MesoArgument *argument = &call->arguments[call->argument_count++];
        argument->at = parser->token;
        argument->expression = meso_parse_expression(parser);
        more = meso_parse_accept(parser, ",");
    }
    meso_parse_expect(parser, ")", "behind the arguments of a rule");
    return call;
}

static void unknown_statement(MesoGrammarParser *parser)
{
    static const char *const words[] = {"step", "move", "turn", "face", "place", "stop", "branch", "if", "choose",
                                        "repeat", "let", NULL};
    const MesoToken *token = &parser->token;
    if (meso_token_is(token, "else"))
        meso_grammar_wrong(&parser->lexer, token, "'else' belongs behind the block of an 'if' or behind a 'step'");
    else if (meso_token_is(token, "join") || meso_token_is(token, "retry"))
        meso_grammar_wrong(&parser->lexer, token, "'%.*s' belongs behind 'step(...) else'", (int)token->length,
                           token->text);
    else
        meso_parse_unknown(parser, token, "a command", MESO_NAME_RULE, words);
}

static MesoStatement *parse_statement(MesoGrammarParser *parser)
{
    static const struct {
        const char *word;
        MesoStatementKind kind;
        void (*parse)(MesoGrammarParser *parser, MesoStatement *statement);
    } kinds[] = {{"let", MESO_STATEMENT_LET, parse_let},          {"if", MESO_STATEMENT_IF, parse_if},
                 {"choose", MESO_STATEMENT_CHOOSE, parse_choose}, {"repeat", MESO_STATEMENT_REPEAT, parse_repeat},
                 {"branch", MESO_STATEMENT_BRANCH, parse_branch}, {NULL, MESO_STATEMENT_LET, NULL}};
    const MesoToken *token = &parser->token;
    const MesoGrammarCommandWord *word = token->kind == MESO_TOKEN_NAME ? meso_grammar_command(token->text, token->length)
                                                                        : NULL;
    MesoStatement *statement = &parser->no_statement;
    for (uint32_t i = 0; kinds[i].word; i++)
        if (meso_parse_at(parser, kinds[i].word)) {
            statement = new_statement(parser, kinds[i].kind);
            kinds[i].parse(parser, statement);
            return statement;
        }
    if (word) {
        statement = new_statement(parser, MESO_STATEMENT_COMMAND);
        statement->command = word;
        parse_command(parser, statement);
    } else if (token->kind == MESO_TOKEN_NAME && meso_token_is(&parser->next, "(") &&
               !meso_grammar_is_reserved(token->text, token->length))
        statement = meso_parse_rule_call(parser);
    else
        unknown_statement(parser);
    return statement;
}

static bool ends_branch(const MesoStatement *statement)
{
    return statement->kind == MESO_STATEMENT_RULE ||
           (statement->kind == MESO_STATEMENT_COMMAND && statement->command->operation == MESO_OP_END);
}

static void append(MesoGrammarParser *parser, MesoBlock *block, MesoStatement *statement)
{
    const MesoToken *last = block->last ? &block->last->at : NULL;
    if (last && ends_branch(block->last))
        meso_grammar_wrong(&parser->lexer, &statement->at,
                           "nothing can follow '%.*s', with which the rule ends; put that into 'branch { }'?",
                           (int)(last->length < 40 ? last->length : 40), last->text);
    if (!meso_parsing(parser))
        return;
    if (block->last)
        block->last->next = statement;
    else
        block->first = statement;
    block->last = statement;
}

MesoBlock meso_parse_block(MesoGrammarParser *parser)
{
    MesoBlock block = {0};
    uint32_t scope = parser->scope_count, locals = parser->local_count;
    MesoToken open = parser->token;
    if (!meso_parse_enter(parser))
        return block;
    meso_parse_expect(parser, "{", "before the commands");
    while (meso_parsing(parser) && !meso_parse_accept(parser, "}")) {
        if (parser->token.kind == MESO_TOKEN_END)
            meso_grammar_wrong(&parser->lexer, &open, "'{' has no '}'");
        else
            append(parser, &block, parse_statement(parser));
    }
    parser->scope_count = scope;
    parser->local_count = locals;
    parser->depth--;
    return block;
}

MesoBlock meso_parse_body(MesoGrammarParser *parser)
{
    MesoBlock block = {0};
    if (meso_parse_at(parser, "{") || !meso_parse_enter(parser))
        return meso_parse_block(parser);
    uint32_t scope = parser->scope_count, locals = parser->local_count;
    append(parser, &block, parse_statement(parser));
    parser->scope_count = scope;
    parser->local_count = locals;
    parser->depth--;
    return block;
}
