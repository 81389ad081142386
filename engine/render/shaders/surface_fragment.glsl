// First look at the surfaces: depth, and the normal towards the camera.
in vec3 world_normal;
in vec2 surface_texcoord;
uniform sampler2D base_color_texture;
uniform bool holes;
out vec4 encoded_normal;

void main() {
    if (holes && texture(base_color_texture, surface_texcoord).a < 0.5) discard;
    vec3 n = normalize(world_normal);
    encoded_normal = vec4((gl_FrontFacing ? n : -n) * 0.5 + 0.5, 1.0);
}
