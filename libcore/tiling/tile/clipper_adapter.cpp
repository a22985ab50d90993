#include "libcore/tiling/tile/clipper_adapter.h"

#include <clipper.hpp>
#include <new>
#include <vector>

using ClipperLib::Path;
using ClipperLib::Paths;

/*
 * Counter-clockwise. Outlines do not cross themselves, so they need no clean-up,
 * which would move their first point: sweeps join rings by their first points.
 */
static Path to_outline(const MesoIntPoint *points, uint32_t count)
{
    Path path;
    path.reserve(count);
    for (uint32_t i = 0; i < count; i++)
        path.push_back(ClipperLib::IntPoint(points[i].x, points[i].y));
    if (!ClipperLib::Orientation(path))
        ClipperLib::ReversePath(path);
    return path;
}

static Paths clip(const Paths &left, const Paths &right, MesoClipOp op)
{
    ClipperLib::Clipper clipper;
    clipper.AddPaths(left, ClipperLib::ptSubject, true);
    clipper.AddPaths(right, ClipperLib::ptClip, true);
    Paths result;
    clipper.Execute(op == MESO_CLIP_DIFFERENCE ? ClipperLib::ctDifference : ClipperLib::ctUnion,
                    result, ClipperLib::pftNonZero, ClipperLib::pftNonZero);
    return result;
}

static Paths run(const MesoClipStep *steps, uint32_t step_count, const MesoIntPoint *points)
{
    std::vector<Paths> values(step_count);
    for (uint32_t i = 0; i < step_count; i++) {
        const MesoClipStep &step = steps[i];
        if (step.op == MESO_CLIP_PATH)
            values[i] = Paths(1, to_outline(points + step.point_begin, step.point_count));
        else
            values[i] = clip(values[step.left], values[step.right], step.op);
    }
    return values.back();
}

static MesoStatus copy(MesoIntPolygons *result, MesoArena *arena, const Paths &paths, MesoError *error)
{
    size_t point_count = 0;
    for (const Path &path : paths)
        point_count += path.size();
    if (point_count >= UINT32_MAX)
        return meso_fail(error, MESO_ERR_LIMIT, "a drawing with over 2^32 points");
    result->path_count = static_cast<uint32_t>(paths.size());
    result->path_begin = MESO_NEW(arena, uint32_t, paths.size() + 1, error);
    result->points = MESO_NEW(arena, MesoIntPoint, point_count, error);
    if (!result->path_begin || !result->points)
        return MESO_ERR_MEMORY;

    uint32_t at = 0;
    for (uint32_t i = 0; i < result->path_count; i++) {
        result->path_begin[i] = at;
        for (const ClipperLib::IntPoint &p : paths[i])
            result->points[at++] = MesoIntPoint{p.X, p.Y};
    }
    result->path_begin[result->path_count] = at;
    return MESO_OK;
}

extern "C" MesoStatus meso_clip(MesoIntPolygons *result, MesoArena *arena, const MesoClipStep *steps,
                                uint32_t step_count, const MesoIntPoint *points, MesoError *error)
{
    try {
        return copy(result, arena, run(steps, step_count, points), error);
    } catch (const std::bad_alloc &) {
        return meso_fail(error, MESO_ERR_MEMORY, "out of memory in Clipper");
    } catch (const std::exception &e) {
        return meso_fail(error, MESO_ERR_INTERNAL, "Clipper: %s", e.what());
    } catch (...) {
        return meso_fail(error, MESO_ERR_INTERNAL, "Clipper failed");
    }
}
