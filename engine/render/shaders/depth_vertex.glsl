layout(location = 0) in vec3 position;
layout(location = 2) in vec2 texcoord;
uniform mat4 world_from_mesh;
out vec2 surface_texcoord;

void main() {
    vec3 p = (light_from_world * (world_from_mesh * vec4(position, 1.0))).xyz;
    surface_texcoord = texcoord;
    gl_Position = vec4(vec3(p.xy * shadow.xy, p.z / shadow.z) * 2.0 - 1.0, 1.0);
}
