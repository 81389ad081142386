// Averages visibility over the 4 x 4 pixels of its pattern, not across steps in depth.
in vec2 uv;
uniform sampler2D visibility_texture;
out vec4 visibility;

#ifdef ON_FLOOR
const float kSteepness = 9.0; // seen at a grazing angle
#else
const float kSteepness = 60.0;
#endif

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    ivec2 last = ivec2(visibility_size.xy) - 1;
    vec4 centre = texelFetch(visibility_texture, here, 0);
    float depth = unpack_depth(centre.ba);
    vec2 sum = vec2(0.0);
    float total = 0.0;
    for (int i = 0; i < 16; ++i) {
        vec4 other = texelFetch(visibility_texture, clamp(here + ivec2(i & 3, i >> 2) - 2, ivec2(0), last), 0);
        float w = max(1.0 - abs(unpack_depth(other.ba) - depth) * kSteepness, 0.0);
        sum += w * other.rg;
        total += w;
    }
    visibility = vec4(sum / total, centre.ba);
}
