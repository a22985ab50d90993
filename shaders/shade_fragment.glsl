// Light on what the surface pass found: a warm key light from the upper left
// of the camera with a shadow, a cool sky over a warm ground, a weak light
// from behind. GGX with the height-correlated Smith term ("Understanding the
// Masking-Shadowing Function", Heitz 2014); the sky's reflection by Karis's
// fit. SAMPLES > 1: shades every sample once, or once for all that agree.
#if SAMPLES > 1
layout(binding = 0) uniform sampler2D z_samples;
layout(binding = 1) uniform usampler2D packed_samples;
#else
layout(binding = 0) uniform sampler2D depth_samples;
layout(binding = 1) uniform sampler2D normal_samples;
layout(binding = 2) uniform sampler2D albedo_samples;
#endif
layout(binding = 3) uniform sampler2D depth_map;
layout(binding = 4) uniform sampler2D openness_map;
layout(binding = 5) uniform sampler2DShadow shadow_map;

layout(location = 0) uniform vec3 ray_origin;
layout(location = 1) uniform vec3 ray_right;
layout(location = 2) uniform vec3 ray_down;
layout(location = 3) uniform mat4 light_from_eye;   // clip space of the light
layout(location = 7) uniform vec3 to_key;
layout(location = 8) uniform vec3 to_rim;
layout(location = 9) uniform vec3 sky_up;
layout(location = 10) uniform float shadow_texel;   // scene units
layout(location = 11) uniform float end_depth;      // near, or far of a parallel view
// Loops end at uniforms: unrolled, they would take a driver that compiles for
// the CPU longer to compile than to run.
layout(location = 12) uniform int sample_count;
layout(location = 13) uniform int shadow_side;      // taps a side
layout(location = 14) uniform vec4 ray_axis;        // of a parallel view, whose rays begin at depth 0, and 1; or 0

layout(location = 0) out vec4 out_color;

const float PI = 3.14159265;
const float EMPTY = 1e30;
const vec3 KEY = vec3(1.0, 0.94, 0.85) * 2.5;
const vec3 RIM = vec3(0.85, 0.92, 1.0) * 0.6;
const vec3 SKY = vec3(0.80, 0.89, 1.0) * 0.50;
const vec3 GROUND = vec3(0.55, 0.50, 0.45) * 0.34;

struct Surface {
    vec3 position;      // from the eye
    vec3 normal;
    vec3 albedo;
    float roughness, metallic, depth;
};

float shadow_at(Surface s)
{
    float slope = 1.0 - max(dot(s.normal, to_key), 0.0);
    vec3 lifted = s.position + s.normal * shadow_texel * (1.0 + 2.0 * slope) + to_key * shadow_texel;
    vec3 place = (light_from_eye * vec4(lifted, 1.0)).xyz;
    vec2 uv = 0.5 * place.xy + 0.5;
    vec2 step_uv = 1.25 / vec2(textureSize(shadow_map, 0));
    float lit = 0.0;
    int taps = shadow_side * shadow_side;
    float middle = 0.5 * float(shadow_side - 1);
    for (int i = 0; i < taps; i++) {
        vec2 tap = vec2(i % shadow_side, i / shadow_side) - middle;
        lit += texture(shadow_map, vec3(uv + tap * step_uv, place.z));
    }
    return lit / float(taps);
}

// The pixel's occlusion is that of its centre: a sample on another surface asks the neighbours.
float openness_at(ivec2 pixel, float depth)
{
    ivec2 last = textureSize(depth_map, 0) - 1;
    ivec2 best = pixel;
    float least = abs(texelFetch(depth_map, pixel, 0).r - depth);
    if (least > 0.002 * depth)
        for (int i = 0; i < 4; i++) {
            ivec2 other = clamp(pixel + ivec2((i & 1) * (i - 2), (1 - (i & 1)) * (i - 1)), ivec2(0), last);
            float gap = abs(texelFetch(depth_map, other, 0).r - depth);
            if (gap < least) {
                least = gap;
                best = other;
            }
        }
    return texelFetch(openness_map, best, 0).r;
}

vec3 direct(Surface s, vec3 to_eye, vec3 to_light, vec3 f0)
{
    float nl = dot(s.normal, to_light);
    if (nl <= 0.0)
        return vec3(0.0);
    float nv = max(dot(s.normal, to_eye), 1e-3);
    vec3 halfway = normalize(to_light + to_eye);
    float nh = max(dot(s.normal, halfway), 0.0), vh = max(dot(to_eye, halfway), 0.0);
    float a = s.roughness * s.roughness, a2 = a * a;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float ndf = a2 / (PI * d * d);
    float smith = 0.5 / (nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
    float grazing = 1.0 - vh, grazing2 = grazing * grazing;
    vec3 fresnel = f0 + (1.0 - f0) * grazing2 * grazing2 * grazing;
    vec3 diffuse = (1.0 - fresnel) * (1.0 - s.metallic) * s.albedo / PI;
    return (diffuse + ndf * smith * fresnel) * nl;
}

vec3 sky(vec3 direction, float roughness)
{
    float width = mix(0.25, 1.0, roughness);
    vec3 dome = mix(GROUND, SKY, smoothstep(-width, width, dot(direction, sky_up)));
    float window = smoothstep(0.55 - 0.5 * roughness, 0.95, dot(direction, to_key));
    return dome + KEY * 0.25 * window * (1.0 - 0.8 * roughness);
}

vec3 ambient(Surface s, vec3 to_eye, vec3 f0, float openness)
{
    float nv = max(dot(s.normal, to_eye), 1e-3);
    vec4 r = s.roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    vec2 fit = vec2(-1.04, 1.04) * a + r.zw;
    vec3 glossy = sky(reflect(-to_eye, s.normal), s.roughness) * (f0 * fit.x + fit.y);
    vec3 diffuse = sky(s.normal, 1.0) * s.albedo * (1.0 - s.metallic);
    return diffuse * openness + glossy * openness * openness;
}

vec3 shade(Surface s, float openness)
{
    vec3 to_eye = ray_axis.w > 0.0 ? -ray_axis.xyz : -normalize(s.position);
    vec3 f0 = mix(vec3(0.04), s.albedo, s.metallic);
    vec3 light = ambient(s, to_eye, f0, openness);
    vec3 key = direct(s, to_eye, to_key, f0);
    if (key.r + key.g + key.b > 0.0)
        light += KEY * key * shadow_at(s) * mix(1.0, openness, 0.4);
    return light + RIM * direct(s, to_eye, to_rim, f0) * openness;
}

#if SAMPLES > 1
vec3 from_octahedral(vec2 p)
{
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-n.z, 0.0);
    n.xy -= vec2(n.x >= 0.0 ? fold : -fold, n.y >= 0.0 ? fold : -fold);
    return normalize(n);
}

// Four samples on a grid of 2 x 2.
ivec2 place_of(ivec2 pixel, int i)
{
    return 2 * pixel + ivec2(i & 1, i >> 1);
}

// Depth is reversed and infinite: z = near / depth. Of a parallel view z = 1 - depth / far.
float depth_of(ivec2 pixel, int i)
{
    float z = texelFetch(z_samples, place_of(pixel, i), 0).r;
    return z <= 0.0 ? 2.0 * EMPTY : ray_axis.w > 0.0 ? (1.0 - z) * end_depth : end_depth / z;
}

void fetch(ivec2 pixel, int i, inout Surface s)
{
    uvec4 bits = texelFetch(packed_samples, place_of(pixel, i), 0);
    vec2 blue_metallic = unpackUnorm2x16(bits.z);
    s.normal = from_octahedral(unpackSnorm2x16(bits.x));
    s.albedo = vec3(unpackUnorm2x16(bits.y), blue_metallic.x);
    s.metallic = blue_metallic.y;
    s.roughness = uintBitsToFloat(bits.w);
}
#else
float depth_of(ivec2 pixel, int i)
{
    return texelFetch(depth_samples, pixel, 0).r;
}

void fetch(ivec2 pixel, int i, inout Surface s)
{
    vec4 normal = texelFetch(normal_samples, pixel, 0);
    vec4 albedo = texelFetch(albedo_samples, pixel, 0);
    s.normal = normalize(normal.xyz);
    s.albedo = albedo.rgb;
    s.metallic = albedo.a;
    s.roughness = normal.w;
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 ray = ray_origin + gl_FragCoord.x * ray_right + gl_FragCoord.y * ray_down;
    Surface surfaces[SAMPLES];
    vec3 colors[SAMPLES];
    vec4 sum = vec4(0.0);
    for (int i = 0; i < sample_count; i++) {
        Surface s;
        s.depth = depth_of(pixel, i);
        if (s.depth > EMPTY) {
            surfaces[i].depth = s.depth;
            continue;
        }
        fetch(pixel, i, s);
        s.position = ray_axis.w > 0.0 ? ray + s.depth * ray_axis.xyz : s.depth * ray;
        s.roughness = clamp(s.roughness, 0.08, 1.0);

        int like = -1;
        for (int k = 0; k < i; k++)
            if (abs(surfaces[k].depth - s.depth) < 0.002 * s.depth
                && dot(surfaces[k].normal, s.normal) > 0.98
                && all(lessThan(abs(surfaces[k].albedo - s.albedo), vec3(0.01))))
                like = k;
        surfaces[i] = s;
        colors[i] = like >= 0 ? colors[like] : shade(s, openness_at(pixel, s.depth));
        sum += vec4(colors[i], 1.0);
    }
    out_color = sum / float(sample_count);
}
