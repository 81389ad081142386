// Variant HOLES: the texture's transparent parts let light through.
#ifdef HOLES
in vec2 surface_texcoord;
uniform sampler2D base_color_texture;
#endif

void main() {
#ifdef HOLES
    if (texture(base_color_texture, surface_texcoord).a < 0.5) discard;
#endif
}
