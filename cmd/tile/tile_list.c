/* meso-tile list: interfaces and tiles as a table. */
#include <string.h>

#include "cmd/common/input_kind.h"
#include "cmd/tile/tile_command.h"
#include "formats/tiling/tiles/tiles_file.h"
#include "libcore/tiling/tile/variant.h"

static const MesoToolInfo info = {
    .name = "meso-tile list",
    .synopsis = "meso-tile list FILE",
    .purpose = "Prints the interfaces and the tiles of a tile set as tables.",
    .examples = "meso-tile list vase.tiles.json",
    .words = "1 .json\n"
             "--json .json",
    .operands_low = 1,
    .operands_high = 1,
};

enum { COLUMNS = 6 };

/* Cells in the arena; the first row is the heading. */
typedef struct Table {
    const char *(*rows)[COLUMNS];
    uint32_t row_count;
} Table;

/* Characters, as UTF-8 counts them. */
static int text_width(const char *text)
{
    int width = 0;
    for (; *text; text++)
        width += ((unsigned char)*text & 0xc0) != 0x80;
    return width;
}

static void print_table(FILE *stream, const Table *table)
{
    int widths[COLUMNS] = {0};
    for (uint32_t row = 0; row < table->row_count; row++)
        for (int column = 0; column < COLUMNS; column++) {
            const char *cell = table->rows[row][column];
            int width = cell ? text_width(cell) : 0;
            widths[column] = width > widths[column] ? width : widths[column];
        }
    for (uint32_t row = 0; row < table->row_count; row++) {
        const char **cells = table->rows[row];
        for (int column = 0; column < COLUMNS && cells[column]; column++) {
            bool last = column + 1 == COLUMNS || !cells[column + 1];
            fprintf(stream, "%s%*s", cells[column],
                    last ? 0 : widths[column] - text_width(cells[column]) + 2, "");
        }
        fputc('\n', stream);
    }
}

/* Words with a space between, in the arena. */
static const char *join(MesoArena *arena, const char *const *words, uint32_t count, MesoError *error)
{
    size_t size = 2;
    for (uint32_t i = 0; i < count; i++)
        size += strlen(words[i]) + 1;
    char *text = MESO_NEW(arena, char, size, error), *end = text;
    if (!text)
        return NULL;
    for (uint32_t i = 0; i < count; i++)
        end += snprintf(end, size - (size_t)(end - text), "%s%s", i ? " " : "", words[i]);
    if (count == 0)
        strcpy(text, "-");
    return text;
}

static const char *section_names(const MesoTileSet *set, const MesoInterface *interface,
                                 MesoArena *arena, MesoError *error)
{
    const char **names = MESO_NEW(arena, const char *, interface->section_count, error);
    for (uint32_t i = 0; names && i < interface->section_count; i++)
        names[i] = set->sections[interface->section_begin + i].name;
    return names ? join(arena, names, interface->section_count, error) : NULL;
}

static MesoStatus list_interfaces(const MesoTileSet *set, FILE *stream, MesoArena *arena, MesoError *error)
{
    Table table = {.rows = meso_arena_alloc(arena, (size_t)set->interface_count + 1, sizeof *table.rows, error)};
    if (!table.rows)
        return MESO_ERR_MEMORY;
    const char *heading[COLUMNS] = {"INTERFACE", "BORDER", "CROSS-SECTIONS"};
    memcpy(table.rows[table.row_count++], heading, sizeof heading);
    for (uint32_t i = 0; i < set->interface_count; i++) {
        const MesoInterface *interface = &set->interfaces[i];
        const char **cells = table.rows[table.row_count++];
        cells[0] = interface->name;
        cells[1] = interface->border_exempt ? "exempt" : interface->border_only ? "only" : "any";
        cells[2] = section_names(set, interface, arena, error);
        if (!cells[2])
            return MESO_ERR_MEMORY;
    }
    print_table(stream, &table);
    return MESO_OK;
}

static const char *side_names(const MesoTileSet *set, const MesoTile *tile, MesoArena *arena, MesoError *error)
{
    const char *names[MESO_SIDE_COUNT];
    for (uint32_t side = 0; side < tile->side_count; side++) {
        int32_t label = tile->labels[side];
        names[side] = label == 0 ? "-"
                                 : meso_arena_print(arena, error, "%s%s",
                                                    set->interfaces[meso_label_interface(label)].name,
                                                    meso_label_mark(label));
        if (!names[side])
            return NULL;
    }
    return join(arena, names, tile->side_count, error);
}

/* "rotation flip-x flip-y", or "-" */
static const char *transform_names(const MesoTile *tile, MesoArena *arena, MesoError *error)
{
    const char *names[3];
    uint32_t count = 0;
    if (tile->rotation)
        names[count++] = "rotation";
    if (tile->flip_x)
        names[count++] = "flip-x";
    if (tile->flip_y)
        names[count++] = "flip-y";
    return join(arena, names, count, error);
}

static MesoStatus list_tiles(const MesoTileSet *set, const uint32_t *variant_counts, FILE *stream,
                             MesoArena *arena, MesoError *error)
{
    Table table = {.rows = meso_arena_alloc(arena, (size_t)set->tile_count + 1, sizeof *table.rows, error)};
    if (!table.rows)
        return MESO_ERR_MEMORY;
    const char *heading[COLUMNS] = {"TILE", "SIDES", "SWEEPS", "MESHES", "VARIANTS", "TRANSFORMS"};
    memcpy(table.rows[table.row_count++], heading, sizeof heading);
    for (uint32_t t = 0; t < set->tile_count; t++) {
        const MesoTile *tile = &set->tiles[t];
        const char **cells = table.rows[table.row_count++];
        cells[0] = tile->name;
        cells[1] = side_names(set, tile, arena, error);
        cells[2] = meso_arena_print(arena, error, "%u", tile->sweep_count);
        cells[3] = meso_arena_print(arena, error, "%u", tile->inner_count);
        cells[4] = tile->ignored ? "ignored" : meso_arena_print(arena, error, "%u", variant_counts[t]);
        cells[5] = transform_names(tile, arena, error);
        for (int column = 0; column < COLUMNS; column++)
            if (!cells[column])
                return MESO_ERR_MEMORY;
    }
    print_table(stream, &table);
    return MESO_OK;
}

static MesoStatus read_set(MesoTool *tool, MesoTileSet *set)
{
    MesoInput input;
    MesoStatus status = meso_tool_open_place(tool, &input, tool->operands[0], &MESO_PLACE_TILE_FILE);
    if (status)
        return status;
    status = meso_tiles_read(set, &tool->arena, &input, &tool->error);
    meso_input_close(&input);
    return status;
}

static MesoStatus run(MesoTool *tool)
{
    MesoArena *arena = &tool->arena;
    MesoError *error = &tool->error;
    MesoTileSet set;
    MesoVariantSet variants;
    MesoStatus status = meso_tile_refuse_clash(tool);
    if (!status)
        status = read_set(tool, &set);
    if (!status)
        status = meso_variant_set_build(&variants, arena, &set, error);
    if (!status)
        status = meso_tile_report_counts(tool, &set, &variants.count);
    if (status)
        return status;
    uint32_t *variant_counts = MESO_NEW(arena, uint32_t, set.tile_count, error);
    if (!variant_counts)
        return MESO_ERR_MEMORY;
    for (uint32_t v = 0; v < variants.count; v++)
        variant_counts[variants.tile[v]]++;

    MesoTileText text;
    status = meso_tile_text_init(&text, error);
    if (!status)
        status = list_interfaces(&set, text.stream, arena, error);
    if (!status)
        fputc('\n', text.stream);
    if (!status)
        status = list_tiles(&set, variant_counts, text.stream, arena, error);
    return meso_tile_text_finish(&text, tool->output, status, error);
}

int meso_tile_list(int argc, char **argv)
{
    MesoTool tool = {0};
    MesoOption options[] = {MESO_TOOL_OPTIONS(tool), {0}};
    if (meso_tile_start(&tool, &info, options, argc, argv))
        tool.status = run(&tool);
    return meso_tool_finish(&tool);
}
