/* meso-tile: makes and looks at tile sets. The work is in the commands' files. */
#include <string.h>

#include "cmd/tile/tile_command.h"

static const struct {
    const char *name;
    int (*run)(int argc, char **argv);
} commands[] = {
    {"import", meso_tile_import},
    {"check", meso_tile_check},
    {"list", meso_tile_list},
};

enum { COMMAND_COUNT = sizeof commands / sizeof *commands };

static const MesoToolInfo info = {
    .name = "meso-tile",
    .synopsis = "meso-tile import [-o OUT.tiles.json] FILE\n"
                "meso-tile check [--strict] FILE\n"
                "meso-tile list FILE\n"
                "meso-tile help [COMMAND]",
    .purpose = "Makes and looks at tile sets: those of ours and those of the MesoGen prototype.",
    .examples = "meso-tile import -o basket.tiles.json basket.json\n"
                "meso-tile check vase.tiles.json\n"
                "meso-tile list vase.tiles.json",
    .operands_low = 0,
    .operands_high = UINT32_MAX,
};

static int find_command(const char *name)
{
    for (int i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(commands[i].name, name) == 0)
            return i;
    return -1;
}

/* Nothing was named that exists: says what does. */
static MesoStatus refuse(MesoTool *tool)
{
    char names[200];
    size_t used = 0;
    for (int i = 0; i < COMMAND_COUNT; i++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s, ", commands[i].name);
    snprintf(names + used, sizeof names - used, "help");
    if (tool->operand_count == 0)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "no command; there are %s", names);
    const char *name = tool->operands[0];
    if (find_command(name) >= 0)
        return meso_fail(&tool->error, MESO_ERR_USAGE, "the command '%s' must come before the options", name);
    return meso_fail(&tool->error, MESO_ERR_USAGE, "unknown command '%s'; there are %s", name, names);
}

/* For programs, as meso_options_list(): the commands, whose options each of them lists. */
static MesoStatus list_commands(MesoTool *tool)
{
    for (int i = 0; i < COMMAND_COUNT; i++)
        printf("command\t%s\n", commands[i].name);
    return fflush(stdout) == 0 ? MESO_OK : meso_fail(&tool->error, MESO_ERR_OUTPUT, "cannot write standard output");
}

static int run_help(int argc, char **argv, int command)
{
    char help[] = "--help", *arguments[] = {command < 0 ? argv[0] : argv[2], help, NULL};
    if (command >= 0)
        return commands[command].run(2, arguments);
    MesoTool tool = {0};
    MesoOption options[] = {MESO_TOOL_OPTIONS(tool), {0}};
    bool general = argc == 2;
    if (meso_tool_start(&tool, &info, options, general ? 2 : argc - 1, general ? arguments : argv + 1))
        tool.status = refuse(&tool);
    return meso_tool_finish(&tool);
}

int main(int argc, char **argv)
{
    int command = argc > 1 ? find_command(argv[1]) : -1;
    if (command >= 0)
        return commands[command].run(argc - 1, argv + 1);
    if (argc > 1 && strcmp(argv[1], "help") == 0)
        return run_help(argc, argv, argc > 2 ? find_command(argv[2]) : -1);

    MesoTool tool = {0};
    MesoOption options[] = {MESO_TOOL_OPTIONS(tool), {0}};
    if (meso_tool_start(&tool, &info, options, argc, argv))
        tool.status = refuse(&tool);
    else if (tool.list_options && !tool.status)
        tool.status = list_commands(&tool);
    return meso_tool_finish(&tool);
}
