#version 330 core
// Values that hold for the whole picture; struct FrameUniforms of frame_uniforms.h.
layout(std140) uniform Frame {
    mat4 clip_from_world;
    mat4 world_from_camera;
    mat4 light_from_world; // metres: x, y across the shadow map from a corner, z away from the light
    vec4 borders;          // of the picture at depth 1: left, right, bottom, top
    vec4 range;            // near, far, 1 / (far - near), supersampling
    vec4 target_size;      // pixels drawn: width, height, and their inverses
    vec4 visibility_size;  // pixels of the visibility buffer, and their inverses
    vec4 shadow;           // 1 / width, 1 / height, depth of the map (metres), metres a texel
    vec4 key_direction;    // w: tangent of the light's size
    vec4 key_color;
    vec4 fill_direction;
    vec4 fill_color;
    vec4 rim_direction;
    vec4 rim_color;
    vec4 sky;
    vec4 ground;
    vec4 backdrop;         // linear colour; w: kind (0 studio, 1 colour, 2 camera)
    vec4 subject;          // centre of what is shown, w: radius
    vec4 contact;          // x and z of the map's corner, 1 / size, strength
    vec4 occlusion;        // tolerance (metres), 0 none 1 exact 2 soft, taps: ambient, shadow
    vec4 meshes;           // pixels of the target that meshes may touch: left, bottom, right, top
    vec4 flags;            // 1 with a floor; grain of the camera (sRGB), its seed
};

const float kPi = 3.14159265;
const float kAlike = 0.015; // samples of one pixel this near in depth are one surface, metres
// Kinds of pixels, stored as depths; background is 1.
const float kMesh = 0.25;
const float kFloor = 0.5;
const float kEdge = 0.5;

// Point of the camera's frame (looks along -z) at a place of the picture and a depth.
vec3 camera_point(vec2 uv, float depth) {
    return vec3(mix(borders.xz, borders.yw, uv) * depth, -depth);
}

vec3 world_point(vec2 uv, float depth) {
    return (world_from_camera * vec4(camera_point(uv, depth), 1.0)).xyz;
}

float linear_depth(float stored) {
    return 2.0 * range.x * range.y / (range.x + range.y - (2.0 * stored - 1.0) * (range.y - range.x));
}

// Depth at which a ray meets the floor; the far end where it does not, or there is no floor.
float floor_depth(vec2 place) {
    float down = -(mat3(world_from_camera) * camera_point(place, 1.0)).y;
    float depth = world_from_camera[3].y / max(down, 1e-5);
    return flags.x > 0.5 && down > 1e-5 && depth > range.x ? min(depth, range.y) : range.y;
}

// 16 bits of depth in two 8-bit channels.
vec2 pack_depth(float depth) {
    float t = clamp((depth - range.x) * range.z, 0.0, 1.0) * 65535.0;
    float high = floor(t / 256.0);
    return vec2(high, floor(t - high * 256.0)) / 255.0;
}

float unpack_depth(vec2 packed_depth) {
    return range.x + dot(packed_depth, vec2(255.0 * 256.0, 255.0) / 65535.0) / range.z;
}
