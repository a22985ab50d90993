/* Which details there are at each frame, and how much of each: by one of the three modes. */
#ifndef MESO_REPLICATE_MODES_H
#define MESO_REPLICATE_MODES_H

#include "cmd/replicate/replicate_clip.h"
#include "cmd/replicate/replicate_originals.h"
#include "formats/clip/frame_list.h"
#include "formats/replicate/replica_file.h"
#include "libcore/replicate/plan/replicate_state.h"

typedef enum MesoReplicateWay { MESO_WAY_PLAN, MESO_WAY_PLAY, MESO_WAY_PAPER } MesoReplicateWay;

typedef struct MesoReplicateRun {
    MesoReplicateArguments *arguments;
    MesoTool *tool;
    MesoReplicateClip *clip;
    MesoReplicateWay way;
    MesoReplicaSettings settings;
    MesoReplicaMark mark;           /* of the surface and the originals */
    MesoReplication *replication;   /* owned; NULL where a plan is played that was kept */
    MesoReplicaPlan plan;           /* of what is played */
    MesoPlayer *player;
    MesoArena playing;              /* of the plan and its player */
    uint32_t count, room;
    const MesoDetail *details;      /* [count] there are so far; of what is played or looked ahead at, ever */
    bool ahead;                     /* it was looked ahead: there are no more details than `count` */
    float *grown;                   /* [count] shares of their sizes */
    MesoReplicaLife *lives;         /* [count] */
    int32_t *history;               /* [history_count] numbers of the frames that were gone through */
    uint32_t history_count, history_room;
} MesoReplicateRun;

/*
 * Begins with the originals. To play, goes through all of the clip, or takes the plan that is kept in --plan; else
 * takes the state that is kept in --state. MESO_ERR_INPUT where either is of another surface, details or options.
 */
MesoStatus meso_replicate_run_begin(MesoReplicateRun *run, MesoReplicateArguments *arguments, MesoReplicateClip *clip,
                                    const MesoOriginals *originals);
void meso_replicate_run_end(MesoReplicateRun *run);

/*
 * Goes through frames, by number, and begins again: so what will be born is known from the first frame on, of size 0
 * until then. For products whose faces cannot change; nothing is done but in MESO_WAY_PLAN.
 */
MesoStatus meso_replicate_run_look_ahead(MesoReplicateRun *run, const MesoOriginals *originals,
                                         const MesoFrameList *frames);

/* Goes to a frame of the clip, from 0: to the next one, but where it plays. */
MesoStatus meso_replicate_run_frame(MesoReplicateRun *run, uint32_t frame);

/* Writes the state to a file that is open. */
MesoStatus meso_replicate_run_store(const MesoReplicateRun *run, MesoOutput *output);

/* The frames that were gone through, as --frames takes them; NULL where memory is out. */
const char *meso_replicate_run_history(const MesoReplicateRun *run);

#endif
