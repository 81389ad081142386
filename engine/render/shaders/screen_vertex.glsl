// One triangle over the whole picture, at the depth of one kind of pixels.
uniform float kind;
out vec2 uv;

void main() {
    uv = vec2((gl_VertexID & 1) * 2, gl_VertexID & 2);
    gl_Position = vec4(uv * 2.0 - 1.0, kind * 2.0 - 1.0, 1.0);
}
