/* The command that made a product, as its provenance has it: by what it means. */
#ifndef MESO_COMMAND_LINE_H
#define MESO_COMMAND_LINE_H

#include "cmd/common/options.h"

/* The present value of each option as text, [rows of the table]; NULL for none. NULL when memory is out. */
const char **meso_options_values(const MesoOption *options, MesoArena *arena, MesoError *error);

/*
 * The command as what it means, as one line that a shell takes back: two that do the same job give the
 * same line. Options stand in the order of the table, where their values differ from
 * `defaults` (of meso_options_values(), before parsing); none is there that only
 * says where a product goes. Paths, and operands are paths, lose their folders.
 */
char *meso_options_command_names(const MesoOption *options, const char *program, const char *const *defaults,
                                 const char *const *operands, uint32_t operand_count,
                                 const MesoOptionChange *changes, MesoArena *arena, MesoError *error);

#endif
