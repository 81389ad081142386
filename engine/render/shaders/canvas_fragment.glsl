// Letters and pictures: the texture times the ink, as stored (sRGB).
uniform sampler2D base_color_texture;
in vec2 uv;
in vec4 tint;
out vec4 color;

void main() {
    color = tint * texture(base_color_texture, uv);
}
