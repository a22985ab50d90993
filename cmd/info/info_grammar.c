#include "cmd/info/info_grammar.h"

#include "formats/growth/grammar_file.h"
#include "formats/json/json_text.h"

/* Names of sources; those that were written where they are used have none. */
static int put_sources(json_t *facts, const char *key, const MesoGrammarSource *sources, uint32_t count)
{
    json_t *names = json_array();
    int failed = 0;
    for (uint32_t i = 0; i < count; i++)
        if (sources[i].name)
            failed |= json_array_append_new(names, meso_json_string(sources[i].name));
    return failed | json_object_set_new(facts, key, names);
}

static int put_parameters(json_t *facts, const MesoGrammar *grammar)
{
    json_t *names = json_array();
    int failed = 0;
    for (uint32_t i = 0; i < grammar->parameter_count; i++)
        failed |= json_array_append_new(names, meso_json_string(grammar->parameters[i].name));
    return failed | json_object_set_new(facts, "parameters", names);
}

static int put_rules(json_t *facts, const MesoGrammar *grammar)
{
    json_t *rules = json_array();
    int failed = 0;
    for (uint32_t i = 0; i < grammar->rule_count; i++) {
        const MesoGrammarRule *rule = &grammar->rules[i];
        json_t *object = json_object();
        failed |= json_object_set_new(object, "rule", meso_json_string(rule->name));
        failed |= json_object_set_new(object, "arguments", json_integer(rule->argument_count));
        failed |= json_object_set_new(object, "reached", json_boolean(rule->reached));
        failed |= json_array_append_new(rules, object);
    }
    return failed | json_object_set_new(facts, "rules", rules);
}

static int put_seeds(json_t *facts, const MesoGrammar *grammar)
{
    json_t *seeds = json_array();
    int failed = 0;
    for (uint32_t i = 0; i < grammar->seed_count; i++)
        failed |= json_array_append_new(seeds, meso_json_string(grammar->rules[grammar->seeds[i].rule].name));
    return failed | json_object_set_new(facts, "seeds", seeds);
}

MesoStatus meso_info_grammar(json_t *facts, MesoArena *arena, const MesoInput *input, MesoError *error)
{
    MesoGrammar grammar;
    const MesoGrammarOptions options = {.extent = 1};
    MesoStatus status = meso_grammar_file_read(&grammar, arena, input, &options, error);
    if (status)
        return status;
    int failed = json_object_set_new(facts, "kind", json_string("grammar"));
    failed |= put_parameters(facts, &grammar);
    failed |= put_sources(facts, "maps", grammar.maps, grammar.map_count);
    failed |= put_sources(facts, "fields", grammar.fields, grammar.field_count);
    failed |= put_sources(facts, "shapes", grammar.shapes, grammar.shape_count);
    failed |= put_seeds(facts, &grammar);
    failed |= put_rules(facts, &grammar);
    return failed ? meso_fail(error, MESO_ERR_MEMORY, "out of memory: facts of a file") : MESO_OK;
}
