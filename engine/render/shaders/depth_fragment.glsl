in vec2 surface_texcoord;
uniform sampler2D base_color_texture;
uniform bool holes;

void main() {
    if (holes && texture(base_color_texture, surface_texcoord).a < 0.5) discard;
}
