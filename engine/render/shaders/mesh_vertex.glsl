layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 texcoord;
uniform mat4 world_from_mesh;
out vec3 world_position;
out vec3 world_normal;
out vec2 surface_texcoord;

void main() {
    vec4 world = world_from_mesh * vec4(position, 1.0);
    world_position = world.xyz;
    world_normal = mat3(world_from_mesh) * normal;
    surface_texcoord = texcoord;
    gl_Position = clip_from_world * world;
}
