#include "cmd/grow/grow_report.h"

#include <inttypes.h>

#include "formats/json/json_text.h"

static const char *const ends[] = {"done", "generations", "elements", "length", "stopped"};

const char *meso_grow_end_phrase(MesoGrowthEnd end)
{
    static const char *const phrases[] = {"nothing", "the limit of generations", "the limit of elements",
                                          "the limit of length", "a stop from outside"};
    return phrases[end];
}

static json_t *rule_of(const MesoGrowthRuleCount *count, const char *name)
{
    const struct {
        const char *key;
        uint64_t count;
    } counts[] = {{"runs", count->runs}, {"steps", count->steps}, {"refused", count->refused},
                  {"placed", count->placed}, {"branches", count->branches}, {"at_borders", count->at_borders}};
    json_t *object = json_object();
    json_object_set_new(object, "rule", json_string(name));
    for (size_t i = 0; i < sizeof counts / sizeof *counts; i++)
        json_object_set_new(object, counts[i].key, json_integer((json_int_t)counts[i].count));
    return object;
}

void meso_grow_report(MesoTool *tool, const MesoGrown *grown, const MesoGrammar *grammar, uint32_t start_count)
{
    json_t *object = json_object(), *rules = json_array();
    json_object_set_new(object, "seeds", json_integer(start_count));
    json_object_set_new(object, "generations", json_integer(grown->generation_count));
    json_object_set_new(object, "branches", json_integer(grown->branch_count));
    json_object_set_new(object, "elements", json_integer(grown->element_count));
    json_object_set_new(object, "length", meso_json_shortest((float)grown->length));
    json_object_set_new(object, "end", json_string(ends[grown->end]));
    for (uint32_t r = 0; r < grammar->rule_count; r++)
        json_array_append_new(rules, rule_of(&grown->rules[r], grammar->rules[r].name));
    json_object_set_new(object, "rules", rules);
    json_object_set_new(tool->report, "growth", object);
    if (tool->verbose)
        meso_tool_say(tool, "%u seeds, %u branches, %u elements in %u generations, ended by %s", start_count,
                      grown->branch_count, grown->element_count, grown->generation_count,
                      meso_grow_end_phrase(grown->end));
}

/* ---- traces ---- */

static const char *order_name(MesoGrowthOrder order)
{
    static const char *const names[] = {"step", "move", "turn", "face", "place", "branch", "rule", "end", "fault"};
    return names[order];
}

void meso_grow_trace(MesoGrowTrace *trace, const MesoGrowthEvent *event)
{
    const MesoGrowthCommand *command = event->command;
    double at[3];
    char line[512];
    if (trace->status)
        return;
    meso_tip_position(trace->mesh, &event->tip, at);
    const char *rule = event->rule < trace->grammar->rule_count ? trace->grammar->rules[event->rule].name : "";
    int length = snprintf(line, sizeof line, "{\"branch\": \"%016" PRIx64 "\", \"rule\": \"%.64s\", "
                          "\"generation\": %u, "
                          "\"line\": %u, \"command\": \"%s\", \"accepted\": %s, \"at\": [%.9g, %.9g, %.9g]",
                          event->key, rule, event->generation, command->line, order_name(command->order),
                          event->accepted ? "true" : "false", at[0], at[1], at[2]);
    if (command->order <= MESO_GROWTH_PLACE)
        length += snprintf(line + length, sizeof line - (size_t)length, ", \"amount\": %.9g",
                           command->values[MESO_GROWTH_AMOUNT]);
    if (command->order == MESO_GROWTH_BRANCH || command->order == MESO_GROWTH_RULE)
        length += snprintf(line + length, sizeof line - (size_t)length, ", \"to\": \"%016" PRIx64 "\"", command->key);
    length += snprintf(line + length, sizeof line - (size_t)length, "}\n");
    trace->status = meso_output_write(trace->output, line, (size_t)length, trace->error);
}
