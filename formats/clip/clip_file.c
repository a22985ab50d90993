#include "formats/clip/clip_file.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include "formats/clip/frame_folder.h"
#include "formats/clip/point_cache.h"
#include "formats/mesh/gltf/gltf_clip.h"
#include "formats/mesh/mesh_read.h"
#include "libcore/mesh/edit/mesh_weld.h"

/* A frame that has been read, or could not be. */
typedef struct Slot {
    uint32_t frame;         /* MESO_NO_INDEX: none */
    MesoStatus status;
    MesoError error;
    MesoVec3 *positions;    /* [vertex_count], in the clip's arena */
} Slot;

struct MesoClipFile {
    MesoArena arena;
    const char *path;
    MesoFrameList frames;
    MesoPolygonMesh rest;       /* as its file has it */
    MesoPolygonMesh mesh;       /* as it is handed out */
    uint32_t *kept;             /* [mesh.vertex_count] vertices of `rest`, ascending; NULL: all */
    MesoInput rest_input, cache_input;
    bool rest_open, cache_open;
    MesoPointCache cache;
    MesoGltfClip *animation;    /* NULL: none */
    double frames_per_second;   /* of the animation */
    uint32_t thread_count;

    bool ahead;
    Slot slots[2];          /* the second one only where frames are read ahead */
    uint32_t current;       /* slot in use by the caller */
    pthread_t reader;
    bool reading;           /* into the slot that is not current */
};

/* ---- the same faces ---- */

static MesoStatus check_counts(const MesoPolygonMesh *mesh, const MesoPolygonMesh *rest, const char *path,
                               const char *rest_path, MesoError *error)
{
    if (mesh->vertex_count != rest->vertex_count)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %u vertices; '%s' has %u", path, mesh->vertex_count, rest_path,
                         rest->vertex_count);
    if (mesh->face_count != rest->face_count)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %u faces; '%s' has %u", path, mesh->face_count, rest_path,
                         rest->face_count);
    return MESO_OK;
}

static MesoStatus check_face(const MesoPolygonMesh *mesh, const MesoPolygonMesh *rest, uint32_t face, const char *path,
                             const char *rest_path, MesoError *error)
{
    uint32_t sides = meso_polygon_sides(mesh, face), rest_sides = meso_polygon_sides(rest, face);
    const uint32_t *corners = mesh->corners + meso_polygon_begin(mesh, face);
    const uint32_t *rest_corners = rest->corners + meso_polygon_begin(rest, face);
    if (sides != rest_sides)
        return meso_fail(error, MESO_ERR_INPUT, "%s: face %u has %u sides; in '%s' it has %u", path, face + 1, sides,
                         rest_path, rest_sides);
    for (uint32_t i = 0; i < sides; i++)
        if (corners[i] != rest_corners[i])
            return meso_fail(error, MESO_ERR_INPUT, "%s: face %u has vertex %u as its corner %u; in '%s' that is "
                             "vertex %u", path, face + 1, corners[i] + 1, i + 1, rest_path, rest_corners[i] + 1);
    return MESO_OK;
}

static MesoStatus check_faces(const MesoPolygonMesh *mesh, const MesoPolygonMesh *rest, const char *path,
                              const char *rest_path, MesoError *error)
{
    MesoStatus status = check_counts(mesh, rest, path, rest_path, error);
    bool alike = !status && mesh->side_count == rest->side_count && mesh->corner_count == rest->corner_count;
    if (alike && mesh->side_count && !memcmp(mesh->corners, rest->corners, mesh->corner_count * sizeof *mesh->corners))
        return MESO_OK;
    for (uint32_t f = 0; f < rest->face_count && !status; f++)
        status = check_face(mesh, rest, f, path, rest_path, error);
    return status;
}

/* ---- one frame ---- */

static MesoStatus read_mesh(const MesoClipFile *clip, const char *path, uint32_t thread_count, MesoArena *scratch,
                            Slot *slot)
{
    MesoInput input;
    MesoPolygonMesh mesh;
    MesoStatus status = meso_input_open(&input, path, &slot->error);
    if (status)
        return status;
    status = meso_polygon_mesh_read(&mesh, scratch, &input, thread_count, &slot->error);
    if (!status)
        status = check_faces(&mesh, &clip->rest, path, clip->rest_input.path, &slot->error);
    if (!status)
        memcpy(slot->positions, mesh.positions, mesh.vertex_count * sizeof *mesh.positions);
    meso_input_close(&input);
    return status;
}

static MesoStatus read_numbered(const MesoClipFile *clip, int32_t number, uint32_t thread_count, Slot *slot)
{
    MesoArena scratch;
    meso_arena_init(&scratch);
    const char *path = meso_frame_path(clip->path, number, &scratch, &slot->error);
    MesoStatus status = path ? read_mesh(clip, path, thread_count, &scratch, slot) : MESO_ERR_MEMORY;
    meso_arena_release(&scratch);
    return status;
}

/* Frames of caches and animations are counted from 1. */
static MesoStatus read_number(const MesoClipFile *clip, int32_t number, uint32_t thread_count, Slot *slot)
{
    if (clip->cache_open)
        return meso_point_cache_frame(&clip->cache, (uint32_t)number - 1, slot->positions, &slot->error);
    if (clip->animation)
        return meso_gltf_clip_positions(clip->animation, (number - 1) / clip->frames_per_second, slot->positions,
                                        &slot->error);
    return read_numbered(clip, number, thread_count, slot);
}

/* In place: no vertex stands before the one that it comes from. */
static void keep_vertices(const MesoClipFile *clip, MesoVec3 *positions)
{
    for (uint32_t v = 0; clip->kept && v < clip->mesh.vertex_count; v++)
        positions[v] = positions[clip->kept[v]];
}

static void read_frame(const MesoClipFile *clip, uint32_t frame, uint32_t thread_count, Slot *slot)
{
    slot->frame = frame;
    slot->status = read_number(clip, clip->frames.frames[frame], thread_count, slot);
    if (!slot->status)
        keep_vertices(clip, slot->positions);
}

/* ---- reading ahead ---- */

/* One thread: the caller has its own work for the others. */
static void *read_next(void *argument)
{
    MesoClipFile *clip = argument;
    Slot *slot = &clip->slots[1 - clip->current];
    read_frame(clip, slot->frame, 1, slot);
    return NULL;
}

static void wait_for_reader(MesoClipFile *clip)
{
    if (clip->reading)
        pthread_join(clip->reader, NULL);
    clip->reading = false;
}

/* Where there can be no thread the frame is read when it is asked for. */
static void start_reader(MesoClipFile *clip, uint32_t frame)
{
    Slot *slot = &clip->slots[1 - clip->current];
    if (!clip->ahead || frame >= clip->frames.count || slot->frame == frame)
        return;
    slot->frame = frame;
    clip->reading = pthread_create(&clip->reader, NULL, read_next, clip) == 0;
    if (!clip->reading)
        slot->frame = MESO_NO_INDEX;
}

const MesoVec3 *meso_clip_place_frame(MesoClipFile *clip, uint32_t frame, MesoError *error)
{
    wait_for_reader(clip);
    if (clip->ahead && clip->slots[1 - clip->current].frame == frame)
        clip->current = 1 - clip->current;
    Slot *slot = &clip->slots[clip->current];
    if (slot->frame != frame)
        read_frame(clip, frame, clip->thread_count, slot);
    if (slot->status) {
        if (error)
            *error = slot->error;
        slot->frame = MESO_NO_INDEX;
        return NULL;
    }
    start_reader(clip, frame + 1);
    return slot->positions;
}

/* ---- opening ---- */

static bool has_extension(const char *path, const char *extension)
{
    size_t length = strlen(path), size = strlen(extension);
    return length > size && strcasecmp(path + length - size, extension) == 0;
}

static MesoStatus copy_frames(MesoClipFile *clip, const MesoFrameList *frames, MesoError *error)
{
    clip->frames = (MesoFrameList){frames->count, MESO_NEW(&clip->arena, int32_t, frames->count, error)};
    if (!clip->frames.frames)
        return MESO_ERR_MEMORY;
    memcpy(clip->frames.frames, frames->frames, frames->count * sizeof *frames->frames);
    return MESO_OK;
}

/* Those that were asked for, of which there are 1 to `count`, or all of them. */
static MesoStatus choose_frames(MesoClipFile *clip, const MesoFrameList *frames, double count, MesoError *error)
{
    if (frames) {
        for (uint32_t i = 0; i < frames->count; i++)
            if (frames->frames[i] < 1 || frames->frames[i] > count)
                return meso_fail(error, MESO_ERR_INPUT, "%s: no frame %d; there are 1 to %.0f", clip->path,
                                 frames->frames[i], count);
        return copy_frames(clip, frames, error);
    }
    if (count > MESO_MOST_FRAMES)
        return meso_fail(error, MESO_ERR_LIMIT, "%s: over %d frames", clip->path, MESO_MOST_FRAMES);
    clip->frames = (MesoFrameList){(uint32_t)count, MESO_NEW(&clip->arena, int32_t, (size_t)count, error)};
    for (uint32_t f = 0; clip->frames.frames && f < clip->frames.count; f++)
        clip->frames.frames[f] = (int32_t)f + 1;
    return clip->frames.frames ? MESO_OK : MESO_ERR_MEMORY;
}

static MesoStatus open_cache(MesoClipFile *clip, const MesoClipSource *source, MesoError *error)
{
    if (!source->rest)
        return meso_fail(error, MESO_ERR_USAGE, "'%s' has no faces: it needs a mesh beside it", source->path);
    MesoStatus status = meso_input_open(&clip->cache_input, clip->path, error);
    if (status)
        return status;
    clip->cache_open = true;
    status = meso_point_cache_open(&clip->cache, &clip->cache_input,
                                   has_extension(clip->path, ".mdd") ? MESO_CACHE_MDD : MESO_CACHE_PC2, error);
    return status ? status : choose_frames(clip, source->frames, clip->cache.frame_count, error);
}

/* The last key may lie on a frame, but for rounding. */
static MesoStatus open_animation(MesoClipFile *clip, const MesoClipSource *source, MesoError *error)
{
    MesoInput input;
    clip->frames_per_second = source->frames_per_second > 0 ? source->frames_per_second : 24;
    MesoStatus status = meso_input_open(&input, clip->path, error);
    if (status)
        return status;
    status = meso_gltf_clip_open(&clip->animation, &input, error);
    meso_input_close(&input);
    if (status)
        return status;
    double count = floor(meso_gltf_clip_duration(clip->animation) * clip->frames_per_second + 1e-4) + 1;
    return choose_frames(clip, source->frames, count, error);
}

static MesoStatus open_numbered(MesoClipFile *clip, const MesoClipSource *source, MesoError *error)
{
    if (source->frames)
        return copy_frames(clip, source->frames, error);
    return meso_frame_folder_list(&clip->frames, &clip->arena, clip->path, error);
}

static MesoStatus open_frames(MesoClipFile *clip, const MesoClipSource *source, MesoError *error)
{
    if (has_extension(clip->path, ".pc2") || has_extension(clip->path, ".mdd"))
        return open_cache(clip, source, error);
    if (meso_frame_path_is_pattern(clip->path))
        return open_numbered(clip, source, error);
    if (has_extension(clip->path, ".glb") || has_extension(clip->path, ".gltf"))
        return open_animation(clip, source, error);
    return meso_fail(error, MESO_ERR_USAGE, "'%s' is no clip: a name with the frame's number, as in body-%%04d.obj, a "
                     "cache (.pc2, .mdd) or an animation (.glb, .gltf) is", source->path);
}

static MesoStatus read_rest(MesoClipFile *clip, const MesoClipSource *source, MesoError *error)
{
    if (clip->frames.count == 0)
        return meso_fail(error, MESO_ERR_USAGE, "'%s': no frames", source->path);
    const char *path = source->rest      ? meso_arena_copy_text(&clip->arena, source->rest, error)
                       : clip->animation ? clip->path
                                         : meso_frame_path(clip->path, clip->frames.frames[0], &clip->arena, error);
    if (!path)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_input_open(&clip->rest_input, path, error);
    if (status)
        return status;
    clip->rest_open = true;
    status = meso_polygon_mesh_read(&clip->rest, &clip->arena, &clip->rest_input, clip->thread_count, error);
    if (status)
        return status;
    uint32_t count = clip->cache_open  ? clip->cache.point_count
                     : clip->animation ? meso_gltf_clip_vertex_count(clip->animation)
                                       : clip->rest.vertex_count;
    if (count != clip->rest.vertex_count)
        return meso_fail(error, MESO_ERR_INPUT, "%s: %u points; '%s' has %u vertices", clip->path, count, path,
                         clip->rest.vertex_count);
    return MESO_OK;
}

/* A file of an animation has its mesh as it was made; what moves, begins with the first frame. */
static MesoStatus pose_rest(MesoClipFile *clip, const MesoClipSource *source, MesoError *error)
{
    if (!clip->animation || source->rest)
        return MESO_OK;
    return meso_gltf_clip_positions(clip->animation, (clip->frames.frames[0] - 1) / clip->frames_per_second,
                                    clip->rest.positions, error);
}

static MesoStatus weld(MesoClipFile *clip, MesoError *error)
{
    uint32_t count = clip->rest.vertex_count;
    uint32_t *first = MESO_NEW(&clip->arena, uint32_t, count, error);
    clip->kept = MESO_NEW(&clip->arena, uint32_t, count, error);
    if (!first || !clip->kept)
        return MESO_ERR_MEMORY;
    MesoStatus status = meso_mesh_weld_map(first, &clip->rest, 0, error);
    if (!status)
        status = meso_mesh_weld(&clip->mesh, &clip->arena, &clip->rest, 0, NULL, error);
    if (status)
        return status;
    uint32_t kept = 0;
    for (uint32_t v = 0; v < count; v++)
        if (first[v] == v)
            clip->kept[kept++] = v;
    if (kept != clip->mesh.vertex_count)
        return meso_fail(error, MESO_ERR_INTERNAL, "%u vertices are left, and not %u", clip->mesh.vertex_count, kept);
    if (clip->mesh.face_count == 0)
        return meso_fail(error, MESO_ERR_INPUT, "%s: no face has three vertices in different places",
                         clip->rest_input.path);
    return MESO_OK;
}

static MesoStatus make_slots(MesoClipFile *clip, MesoError *error)
{
    for (uint32_t i = 0; i < (clip->ahead ? 2u : 1u); i++) {
        clip->slots[i].positions = MESO_NEW(&clip->arena, MesoVec3, clip->rest.vertex_count, error);
        if (!clip->slots[i].positions)
            return MESO_ERR_MEMORY;
    }
    return MESO_OK;
}

static MesoStatus open_all(MesoClipFile *clip, const MesoClipSource *source, MesoError *error)
{
    clip->path = meso_arena_copy_text(&clip->arena, source->path, error);
    if (!clip->path)
        return MESO_ERR_MEMORY;
    MesoStatus status = open_frames(clip, source, error);
    if (!status)
        status = read_rest(clip, source, error);
    if (!status)
        status = pose_rest(clip, source, error);
    clip->mesh = clip->rest;
    if (!status && source->weld)
        status = weld(clip, error);
    return status ? status : make_slots(clip, error);
}

MesoStatus meso_clip_open(MesoClipFile **clip, const MesoClipSource *source, MesoError *error)
{
    MesoClipFile *made = calloc(1, sizeof *made);
    *clip = NULL;
    if (!made)
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory");
    meso_arena_init(&made->arena);
    made->thread_count = source->thread_count;
    made->ahead = source->ahead;
    made->slots[0].frame = made->slots[1].frame = MESO_NO_INDEX;
    MesoStatus status = open_all(made, source, error);
    if (status)
        meso_clip_release(made);
    else
        *clip = made;
    return status;
}

void meso_clip_release(MesoClipFile *clip)
{
    if (!clip)
        return;
    wait_for_reader(clip);
    if (clip->rest_open)
        meso_input_close(&clip->rest_input);
    if (clip->cache_open)
        meso_input_close(&clip->cache_input);
    meso_gltf_clip_release(clip->animation);
    meso_arena_release(&clip->arena);
    free(clip);
}

const MesoPolygonMesh *meso_clip_mesh(const MesoClipFile *clip) { return &clip->mesh; }
const MesoInput *meso_clip_mesh_input(const MesoClipFile *clip) { return &clip->rest_input; }
uint32_t meso_clip_frame_count(const MesoClipFile *clip) { return clip->frames.count; }

int32_t meso_clip_frame_number(const MesoClipFile *clip, uint32_t frame)
{
    return clip->frames.frames[frame];
}
