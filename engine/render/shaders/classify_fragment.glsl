// Sorts the pixels of the final picture: one surface, several, or only background (1).
uniform sampler2DMS drawn_surface;
uniform sampler2DMS drawn_depth;

void main() {
    int scale = int(range.w);
    ivec2 first = ivec2(gl_FragCoord.xy) * scale;
    float low = 1e9;
    float high = 0.0;
    float low_material = 1.0;
    float high_material = 0.0;
    for (int y = 0; y < scale; ++y) {
        for (int x = 0; x < scale; ++x) {
            for (int s = 0; s < 4; ++s) {
                float m = texelFetch(drawn_surface, first + ivec2(x, y), s).a;
                float d = linear_depth(texelFetch(drawn_depth, first + ivec2(x, y), s).r);
                low = min(low, d);
                high = max(high, d);
                low_material = min(low_material, m);
                high_material = max(high_material, m);
            }
        }
    }
    bool one = low_material == high_material && high - low < kAlike;
    gl_FragDepth = high_material == 0.0 ? 1.0 : (one ? kMesh : kEdge);
}
