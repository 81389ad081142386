layout(location = 0) in vec3 position;
layout(location = 2) in vec2 texcoord;
uniform mat4 world_from_mesh;
#ifdef HOLES
out vec2 surface_texcoord;
#endif

void main() {
    vec3 p = (light_from_world * (world_from_mesh * vec4(position, 1.0))).xyz;
#ifdef HOLES
    surface_texcoord = texcoord;
#endif
    gl_Position = vec4(vec3(p.xy * shadow.xy, p.z / shadow.z) * 2.0 - 1.0, 1.0);
}
