#include "libcore/growth/language/grammar_read.h"

#include "libcore/growth/language/grammar_check.h"
#include "libcore/growth/language/grammar_compile.h"
#include "libcore/growth/language/grammar_parser.h"

MesoStatus meso_grammar_read(MesoGrammar *grammar, MesoArena *arena, const char *path, const char *text, size_t size,
                             const MesoGrammarOptions *options, MesoError *error)
{
    MesoGrammarParser parser = {.arena = arena, .grammar = grammar, .options = options};
    *grammar = (MesoGrammar){0};
    meso_grammar_lexer_begin(&parser.lexer, path, text, size, error);
    meso_parse_grammar(&parser, text, size);
    if (meso_parsing(&parser))
        meso_grammar_check_types(&parser);
    if (meso_parsing(&parser))
        meso_grammar_check_progress(&parser);
    if (meso_parsing(&parser))
        meso_grammar_compile(&parser);
    return parser.lexer.status;
}
