// The nearest surface at a sample, packed: libcore/render/gl/gl_visibility.c
// takes it apart. The inside of an open sweep is seen from behind: its normal
// is turned to the eye. DETAILED: more than light alone asks for.
in vec3 world_normal;
in float view_depth;
in float along_shape;
flat in uint shape_id;
layout(location = 0) out uvec4 seen;            // shape + 1, depth, normal, along the shape
#ifdef DETAILED
in vec2 shape_uv;
in vec3 shape_color;
layout(location = 1) out uvec4 details;         // uv, colour
#endif

vec2 octahedral(vec3 n)
{
    n /= abs(n.x) + abs(n.y) + abs(n.z);
    vec2 folded = (1.0 - abs(n.yx)) * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return n.z >= 0.0 ? n.xy : folded;
}

void main()
{
    float square = dot(world_normal, world_normal);
    vec3 normal = square > 0.0 ? world_normal * inversesqrt(square) : vec3(0, 0, 1);
    if (!gl_FrontFacing)
        normal = -normal;
    seen = uvec4(shape_id + 1u, floatBitsToUint(view_depth), packSnorm2x16(octahedral(normal)),
                 floatBitsToUint(along_shape));
#ifdef DETAILED
    details = uvec4(floatBitsToUint(shape_uv), packUnorm4x8(vec4(shape_color, 1.0)), 0u);
#endif
}
