/* What meso-grow is told. */
#ifndef MESO_GROW_ARGUMENTS_H
#define MESO_GROW_ARGUMENTS_H

#include "cmd/common/scene_output.h"

typedef struct MesoGrowArguments {
    MesoTool tool;
    MesoSceneOutput output;
    MesoTextList set;           /* --set: name=value */
    MesoVec3 up;
    const char *surface;        /* --surface: a material; NULL: it is not shown */
    const char *seeds;          /* --seeds */
    const char *trace;          /* --trace; NULL: none */
    const char *show_map;       /* --show-map: NAME=FILE; NULL: none */
    const char *march, *atlas;  /* --march, --atlas; NULL: the default */
    uint32_t texels;            /* --texels; 0: the default */
    uint32_t detail;            /* --detail; MESO_NO_INDEX: the grammar's */
    uint32_t until;             /* --until; 0: to the end */
    uint32_t most_generations, most_elements;   /* --generations, --elements */
    bool partial;               /* --partial */
} MesoGrowArguments;

#endif
