/* What is said of growth: the report, and a trace of what the branches did. */
#ifndef MESO_GROW_REPORT_H
#define MESO_GROW_REPORT_H

#include "cmd/common/tool.h"
#include "formats/file/output.h"
#include "libcore/growth/engine/growth.h"

/* Puts "growth" into the report: counts, how it ended, and what each rule did. */
void meso_grow_report(MesoTool *tool, const MesoGrown *grown, const MesoGrammar *grammar, uint32_t start_count);

/* What stopped it: "400 generations". */
const char *meso_grow_end_phrase(MesoGrowthEnd end);

typedef struct MesoGrowTrace {
    MesoOutput *output;
    const MesoGrammar *grammar;
    const MesoTriangulation *mesh;
    MesoStatus status;          /* of the first line that could not be written */
    MesoError *error;
} MesoGrowTrace;

/* Writes the line of an event. */
void meso_grow_trace(MesoGrowTrace *trace, const MesoGrowthEvent *event);

#endif
