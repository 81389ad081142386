// Mean of the samples of a pixel, in linear light, then sRGB with less than one step of dither.
uniform sampler2DMS drawn;
out vec4 color;

vec3 srgb(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(max(c, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055,
               greaterThan(c, vec3(0.0031308)));
}

void main() {
    int scale = int(range.w);
    ivec2 first = ivec2(gl_FragCoord.xy) * scale;
    vec4 sum = vec4(0.0);
    for (int y = 0; y < scale; ++y) {
        for (int x = 0; x < scale; ++x) {
            for (int s = 0; s < 4; ++s) sum += texelFetch(drawn, first + ivec2(x, y), s);
        }
    }
    sum /= float(4 * scale * scale);
    float noise = fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
    color = vec4(srgb(clamp(sum.rgb, 0.0, 1.0)) + sum.a * (noise - 0.5) / 255.0, 1.0);
}
