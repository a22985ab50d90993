#include "formats/growth/grammar_file.h"

#include <string.h>

/* Pictures and meshes given in a grammar's stead. */
static bool is_binary(const MesoInput *input)
{
    return memchr(input->data, '\0', input->size) != NULL;
}

MesoStatus meso_grammar_file_read(MesoGrammar *grammar, MesoArena *arena, const MesoInput *input,
                                  const MesoGrammarOptions *options, MesoError *error)
{
    *grammar = (MesoGrammar){0};
    if (is_binary(input))
        return meso_fail(error, MESO_ERR_INPUT, "%s: not a text", input->path);
    return meso_grammar_read(grammar, arena, input->path, (const char *)input->data, input->size, options, error);
}
