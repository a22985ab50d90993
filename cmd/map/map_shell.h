/* Options of meso-map about the shell: normals, sides, heights that differ, folds. */
#ifndef MESO_MAP_SHELL_H
#define MESO_MAP_SHELL_H

#include "cmd/common/tool.h"
#include "libcore/tiling/strand/model.h"

typedef struct MesoMapShell {
    const char *normals, *side;             /* names of MesoShellNormals and MesoShellSide; NULL: not given */
    bool limit_folds;
    const char *thickness_by, *offset_by;   /* attributes of the surface (surface_number.h) */
    struct {
        bool normals, side, limit_folds;
    } given;
} MesoMapShell;

#define MESO_MAP_SHELL_OPTIONS(shell)                                                                         \
    MESO_CHOICE(0, "normals", "OF", "along which the shell rises: the surface's own (file, default), of its vertices " \
                "anew (smooth), of its faces (flat)", &(shell).normals, "file|smooth|flat",                   \
                .given = &(shell).given.normals, .more = MESO_OPTION_OVERRIDES),                              \
    MESO_CHOICE(0, "side", "SIDE", "of the surface that the shell lies on (default outside)", &(shell).side,  \
                "outside|both|inside", .given = &(shell).given.side, .more = MESO_OPTION_OVERRIDES),          \
    MESO_TEXT(0, "thickness-by", "WHAT", "factors of the thickness: an attribute of the surface, or names that have " \
              "one, as in group:rim=0.5,foot=2", &(shell).thickness_by),                                      \
    MESO_TEXT(0, "offset-by", "WHAT", "lengths that are added to the offset, likewise", &(shell).offset_by),  \
    MESO_FLAG(0, "limit-folds", "lower the shell, smoothly, where it would fold", &(shell).limit_folds,       \
              .given = &(shell).given.limit_folds, .more = MESO_OPTION_OVERRIDES)

/* Puts what was given into `options`. */
void meso_map_shell_set(const MesoMapShell *shell, MesoMapOptions *options);

/* Fills in the model's factors and lifts from attributes of `mesh`, whose vertices its surface has. */
MesoStatus meso_map_shell_heights(MesoTool *tool, const MesoMapShell *shell, const MesoPolygonMesh *mesh,
                                  const char *path, MesoModel *model);

/* Counts the slots that fold, in the report as "folded_slots", and warns of them. */
MesoStatus meso_map_shell_judge(MesoTool *tool, const MesoModel *model);

#endif
