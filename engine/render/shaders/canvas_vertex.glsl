// Shapes of a canvas: pixels from the top left corner.
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 place;
layout(location = 2) in vec4 ink;
uniform vec2 screen_size;
out vec2 uv;
out vec4 tint;

void main() {
    uv = place;
    tint = ink;
    gl_Position = vec4(2.0 * position.x / screen_size.x - 1.0, 1.0 - 2.0 * position.y / screen_size.y, 0.0, 1.0);
}
