// Mean of the 4 x 4 pixels around a corner of the pixel that lie on its surface.
layout(binding = 0) uniform sampler2D depth_map;
layout(binding = 1) uniform sampler2D openness_map;

layout(location = 3) uniform float radius;

layout(location = 0) out float openness;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(depth_map, 0) - 1;
    float depth = texelFetch(depth_map, pixel, 0).r;
    float sum = 0.0, weight = 0.0;
    for (int y = -2; y < 2; y++)
        for (int x = -2; x < 2; x++) {
            ivec2 other = clamp(pixel + ivec2(x, y), ivec2(0), last);
            float near = abs(texelFetch(depth_map, other, 0).r - depth) < 0.25 * radius ? 1.0 : 0.0;
            sum += near * texelFetch(openness_map, other, 0).r;
            weight += near;
        }
    openness = weight > 0.0 ? sum / weight : 1.0;
}
