// Ambient occlusion from the depths around a pixel, after "The Alchemy
// Screen-Space Ambient Obscurance Algorithm" (McGuire et al. 2011). Positions
// are relative to the eye, in the axes of the world.
layout(binding = 0) uniform sampler2D depth_map;
layout(binding = 1) uniform sampler2D normal_map;

layout(location = 0) uniform vec3 ray_origin;       // through the target's corner (0, 0), depth 1
layout(location = 1) uniform vec3 ray_right;        // a pixel further
layout(location = 2) uniform vec3 ray_down;
layout(location = 3) uniform float radius;          // scene units
layout(location = 4) uniform float pixels_at_one;   // pixels of one unit at depth 1
layout(location = 5) uniform float radius_pixels;   // most
layout(location = 6) uniform ivec2 origin;          // of the target in the image
layout(location = 7) uniform int sample_count;      // a uniform, so that the loop is not unrolled

layout(location = 14) uniform vec4 ray_axis;        // of a parallel view, whose rays begin at depth 0, and 1; or 0

layout(location = 0) out float openness;

const float GOLDEN_ANGLE = 2.39996323;
const float STRENGTH = 2.6;
const float EMPTY = 1e30;

vec3 position_at(ivec2 pixel, float depth)
{
    vec3 ray = ray_origin + (float(pixel.x) + 0.5) * ray_right + (float(pixel.y) + 0.5) * ray_down;
    return ray_axis.w > 0.0 ? ray + depth * ray_axis.xyz : depth * ray;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 size = textureSize(depth_map, 0);
    float depth = texelFetch(depth_map, pixel, 0).r;
    openness = 1.0;
    if (depth > EMPTY)
        return;

    vec3 center = position_at(pixel, depth);
    vec3 normal = texelFetch(normal_map, pixel, 0).xyz;
    float pixel_depth = ray_axis.w > 0.0 ? 1.0 : depth;
    float reach = min(radius * pixels_at_one / pixel_depth, radius_pixels);
    if (reach < 1.0)
        return;
    // Each pixel of a 4 x 4 block turns the spiral by another sixteenth; the blur takes the block's mean.
    ivec2 place = (pixel + origin) & 3;
    float turn = float((place.x * 5 + place.y * 11) & 15) * (6.2831853 / 16.0);
    float bias = 1.5 * pixel_depth / pixels_at_one;

    float sum = 0.0;
    for (int i = 0; i < sample_count; i++) {
        float share = (float(i) + 0.5) / float(sample_count);
        float angle = float(i) * GOLDEN_ANGLE + turn;
        ivec2 other = pixel + ivec2(round(reach * share * vec2(cos(angle), sin(angle))));
        if (any(lessThan(other, ivec2(0))) || any(greaterThanEqual(other, size)))
            continue;
        float other_depth = texelFetch(depth_map, other, 0).r;
        if (other_depth > EMPTY)
            continue;
        vec3 to = position_at(other, other_depth) - center;
        float square = dot(to, to);
        float fade = max(1.0 - square / (radius * radius), 0.0);
        sum += fade * max(dot(to, normal) - bias, 0.0) * radius / (square + 0.01 * radius * radius);
    }
    openness = max(1.0 - STRENGTH * sum / float(sample_count), 0.0);
}
