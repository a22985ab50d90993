/* What --report says: each frame, and each detail from its birth to its end. */
#ifndef MESO_REPLICATE_TABLE_H
#define MESO_REPLICATE_TABLE_H

#include "cmd/replicate/replicate_modes.h"
#include "libcore/replicate/statistics/pair_correlation.h"

typedef struct MesoReplicateTable {
    json_t *frames;             /* owned; NULL: no report is wanted */
    MesoPairCorrelation first;  /* of the first frame */
    double difference;          /* of the last frame's pair correlation from it */
    uint32_t shown;             /* at the frame before */
    MesoMeshPoint *points;      /* [room] */
    uint32_t room;
} MesoReplicateTable;

/* Notes the frame that a run is at. */
MesoStatus meso_replicate_table_frame(MesoReplicateTable *table, const MesoReplicateRun *run);

/* Writes the report. Releases the table, whatever `status` is. */
MesoStatus meso_replicate_table_end(MesoReplicateTable *table, const MesoReplicateRun *run,
                                    const char *const *kind_names, MesoStatus status);

#endif
