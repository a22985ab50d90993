#include "cmd/render/render_maker.h"

#include <ctype.h>
#include <dirent.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "libcore/render/image.h"

/* Names of nodes by how they begin; a number follows where there may be several. */
typedef struct Node {
    const char *folder, *name;
    bool numbered;
} Node;

/* Mesa's drivers and others of the kernel's; NVIDIA's; Direct3D under Windows. */
static const Node NODES[] = {{"dri", "renderD", true}, {"", "nvidia", true}, {"", "dxg", false}};

static bool is_named(const Node *node, const char *name)
{
    size_t length = strlen(node->name);
    if (strncmp(name, node->name, length) != 0)
        return false;
    return node->numbered ? isdigit((unsigned char)name[length]) != 0 : name[length] == 0;
}

static bool holds(const char *folder, const Node *node)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s", folder, node->folder);
    DIR *nodes = opendir(path);
    bool found = false;
    for (struct dirent *entry; nodes && !found && (entry = readdir(nodes));) {
        if (!is_named(node, entry->d_name))
            continue;
        snprintf(path, sizeof path, "%s/%s/%s", folder, node->folder, entry->d_name);
        found = access(path, R_OK | W_OK) == 0;
    }
    if (nodes)
        closedir(nodes);
    return found;
}

bool meso_gpu_is_there(const char *folder)
{
    for (size_t i = 0; i < sizeof NODES / sizeof *NODES; i++)
        if (holds(folder, &NODES[i]))
            return true;
    return false;
}

bool meso_render_wants_gl(const MesoRenderArguments *a)
{
    return strcmp(a->visibility, "gl") == 0 || (strcmp(a->visibility, "auto") == 0 && a->context_given);
}

/* What keeps auto from a GPU; NULL: nothing. */
static const char *objection(const MesoRenderArguments *a, bool held)
{
    if (a->resume)
        return "frames that are resumed are the same on all machines";
    if (a->extras & MESO_EXTRA_MOTION)
        return "GL finds no motion";
    if (!held)
        return "it is larger than GL holds";
    return meso_gpu_is_there(a->devices) ? NULL : "no GPU is there";
}

MesoRenderMaker meso_render_maker(const MesoRenderArguments *a, bool held)
{
    if (meso_render_wants_gl(a))
        return (MesoRenderMaker){.context = a->context};
    if (strcmp(a->visibility, "auto") != 0)
        return (MesoRenderMaker){0};
    const char *why = objection(a, held);
    return why ? (MesoRenderMaker){.why = why} : (MesoRenderMaker){.context = "gpu", .tried = true};
}
