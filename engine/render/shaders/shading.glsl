// Shared by surfaces and background.
uniform sampler2D visibility_texture;
uniform sampler2D camera_picture;

// Visibility of a pixel at a depth, from the smaller buffer: bilinear, but only from like depths.
vec2 visibility_at(vec2 pixel, float depth) {
    vec2 place = pixel * target_size.zw * visibility_size.xy - 0.5;
    ivec2 base = ivec2(floor(place));
    ivec2 last = ivec2(visibility_size.xy) - 1;
    vec2 t = place - vec2(base);
    vec2 sum = vec2(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 o = ivec2(i & 1, i >> 1);
        vec4 v = texelFetch(visibility_texture, clamp(base + o, ivec2(0), last), 0);
        vec2 b = mix(1.0 - t, t, vec2(o));
        float w = (b.x * b.y + 0.01) / (0.002 + abs(unpack_depth(v.ba) - depth));
        sum += w * v.rg;
        total += w;
    }
    return sum / total;
}

// The camera's picture at a pixel of the final picture (rows from the top).
vec3 camera_color(vec2 pixel) {
    vec2 uv = (floor(pixel / range.w) + 0.5) * range.w * target_size.zw;
    return texture(camera_picture, vec2(uv.x, 1.0 - uv.y)).rgb;
}

// Linear up to 0.76, then a soft shoulder towards white; hue is kept but bleaches a little.
vec3 tone_map(vec3 color) {
    const float start = 0.76;
    float peak = max(color.r, max(color.g, color.b));
    if (peak <= start) return color;
    float mapped = 1.0 - (1.0 - start) * exp(-(peak - start) / (1.0 - start));
    float bleach = 1.0 - 1.0 / (0.15 * (peak - mapped) + 1.0);
    return mix(color * (mapped / peak), vec3(mapped), bleach);
}
