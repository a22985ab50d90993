#include "libcore/math/square.h"

/* Turn by turn: R^q F, and F R = R^-1 F. */
MesoTransform meso_transform_compose(MesoTransform second, MesoTransform first)
{
    uint32_t flip = (second ^ first) & 4u;
    uint32_t quarters = meso_transform_flips(second) ? 8u + second - first : 0u + second + first;
    return (MesoTransform)(flip | (quarters & 3u));
}

MesoTransform meso_transform_inverse(MesoTransform transform)
{
    return meso_transform_flips(transform) ? transform : (MesoTransform)((4u - transform) & 3u);
}

MesoVec2 meso_transform_point(MesoTransform transform, MesoVec2 point)
{
    if (meso_transform_flips(transform))
        point.x = 1 - point.x;
    for (uint32_t quarter = transform & 3u; quarter > 0; quarter--)
        point = (MesoVec2){1 - point.y, point.x};
    return point;
}
