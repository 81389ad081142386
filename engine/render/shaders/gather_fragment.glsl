// Depth and normal for the visibility buffer, of the meshes, else of the floor. The stored depth
// sorts the pixels into kinds, so that later passes skip the others by an early depth test.
in vec2 uv;
uniform sampler2DMS drawn_depth;
uniform sampler2DMS drawn_normal;
layout(location = 0) out vec4 encoded_normal;
layout(location = 1) out float depth;

void main() {
    ivec2 pixel = min(ivec2(gl_FragCoord.xy) * 2, ivec2(target_size.xy) - 1);
    vec2 centre = (vec2(pixel) + 0.5) * target_size.zw;
    float stored = texelFetch(drawn_depth, pixel, 0).r;
    bool on_mesh = stored < 1.0;
    float to_floor = floor_depth(centre);
    depth = on_mesh ? linear_depth(stored) : to_floor;
    encoded_normal = on_mesh ? texelFetch(drawn_normal, pixel, 0) : vec4(0.5, 1.0, 0.5, 1.0);
    vec3 p = (light_from_world * vec4(world_point(centre, depth), 1.0)).xyz;
    vec2 place = p.xy * shadow.xy;
    bool near_shadow = to_floor < range.y && place.x > -0.05 && place.y > -0.05 &&
                       place.x < 1.05 && place.y < 1.05;
    gl_FragDepth = on_mesh ? kMesh : (near_shadow ? kFloor : 1.0);
}
