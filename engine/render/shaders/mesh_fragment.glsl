// What is where: colour, normal towards the camera, material. Light comes later, once a pixel.
// Variants TEXTURED, COLORED, HOLES, NORMAL_MAP: a CPU rasteriser pays for every unused branch.
in vec3 world_normal;
uniform vec4 base_color;
uniform float material; // index / 255; 0: hides what is behind it, is not seen
#ifdef COLORED
in vec3 surface_color;
#endif
#ifdef TEXTURED
in vec2 surface_texcoord;
uniform sampler2D base_color_texture;
#endif
#ifdef NORMAL_MAP
in vec3 world_position;
uniform float normal_scale;
uniform sampler2D normal_texture;
#endif
layout(location = 0) out vec4 surface;
layout(location = 1) out vec4 encoded_normal;

#ifdef NORMAL_MAP
// Normal map without stored tangents: the frame comes from the derivatives of the texcoords.
vec3 mapped_normal(vec3 n) {
    vec3 dp1 = dFdx(world_position);
    vec3 dp2 = dFdy(world_position);
    vec2 dt1 = dFdx(surface_texcoord);
    vec2 dt2 = dFdy(surface_texcoord);
    vec3 a = cross(dp2, n);
    vec3 b = cross(n, dp1);
    vec3 tangent = a * dt1.x + b * dt2.x;
    vec3 bitangent = a * dt1.y + b * dt2.y; // along rising v: down the picture
    float scale = inversesqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-20));
    vec3 m = texture(normal_texture, surface_texcoord).xyz * 2.0 - 1.0;
    m.xy *= normal_scale;
    return normalize(tangent * (scale * m.x) - bitangent * (scale * m.y) + n * m.z);
}
#endif

void main() {
    vec4 base = base_color;
#ifdef TEXTURED
    base *= texture(base_color_texture, surface_texcoord);
#endif
#ifdef COLORED
    base.rgb *= surface_color;
#endif
#ifdef HOLES
    if (base.a < 0.5) discard;
#endif
    float size2 = dot(world_normal, world_normal);
    vec3 n = size2 > 1e-12 ? world_normal * inversesqrt(max(size2, 1e-12)) : vec3(0.0, 1.0, 0.0);
    n = gl_FrontFacing ? n : -n;
#ifdef NORMAL_MAP
    n = mapped_normal(n);
#endif
    surface = vec4(sqrt(base.rgb), material);
    encoded_normal = vec4(n * 0.5 + 0.5, 1.0);
}
