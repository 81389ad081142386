// The floor near the subject, as a strip of four vertices without buffers.
out vec3 world_normal;
out vec2 surface_texcoord;

void main() {
    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
    world_normal = vec3(0.0, 1.0, 0.0);
    surface_texcoord = vec2(0.0);
    vec2 place = subject.xz + corner * vec2(1.0, -1.0) * 30.0;
    gl_Position = clip_from_world * vec4(place.x, 0.0, place.y, 1.0);
}
