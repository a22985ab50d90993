/* Grammars of growth from files (.grammar, "meso-grow 1"). */
#ifndef MESO_GRAMMAR_FILE_H
#define MESO_GRAMMAR_FILE_H

#include "formats/file/input.h"
#include "libcore/growth/language/grammar_read.h"

/*
 * Reads a grammar into `arena`. The files that it names are not opened: their names stand in its sources. `options`
 * may be NULL. MESO_ERR_INPUT and MESO_ERR_USAGE as meso_grammar_read() gives them; what is no text at all is told so.
 */
MesoStatus meso_grammar_file_read(MesoGrammar *grammar, MesoArena *arena, const MesoInput *input,
                                  const MesoGrammarOptions *options, MesoError *error);

#endif
