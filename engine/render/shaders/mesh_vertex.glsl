layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texcoord;
uniform mat4 world_from_mesh;
out vec3 world_normal;
#ifdef COLORED
layout(location = 3) in vec3 color;
out vec3 surface_color;
#endif
#ifdef TEXTURED
out vec2 surface_texcoord;
#endif
#ifdef NORMAL_MAP
out vec3 world_position;
#endif

void main() {
    vec4 world = world_from_mesh * vec4(position, 1.0);
    world_normal = mat3(world_from_mesh) * normal;
#ifdef COLORED
    surface_color = color;
#endif
#ifdef TEXTURED
    surface_texcoord = texcoord;
#endif
#ifdef NORMAL_MAP
    world_position = world.xyz;
#endif
    gl_Position = clip_from_world * world;
}
