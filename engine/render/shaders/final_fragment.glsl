// The final picture in three passes over the kinds of pixels (variants SURFACE: one surface, EDGE:
// several, else background alone), in sRGB with less than one step of dither. Flat colours and
// camera pictures stay exact. Further variants: STUDIO, CAMERA, WALL, OCCLUSION, HARD_EDGES.
uniform sampler2DMS drawn_surface;
uniform sampler2DMS drawn_normal;
uniform sampler2DMS drawn_depth;
layout(std140) uniform Materials {
    vec4 materials[512]; // two each: sheen colour and roughness; roughness, 1 for a receiver
};
out vec4 color;

vec3 srgb(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(max(c, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055,
               greaterThan(c, vec3(0.0031308)));
}

vec3 background(vec2 pixel) {
#if defined(STUDIO)
    return studio(pixel);
#elif defined(CAMERA)
    return camera_color(pixel);
#else
    return backdrop.rgb;
#endif
}

#if defined(SURFACE) || defined(EDGE)
// Samples of a pixel that show one surface, summed; .a of `color` counts them.
struct Group {
    vec4 color;
    vec4 normal; // depth in w
    float material;
};

void add(inout Group g, vec4 surface, vec3 n, float depth, bool wanted) {
    float w = wanted ? 1.0 : 0.0;
    g.color += w * vec4(surface.rgb * surface.rgb, 1.0);
    g.normal += w * vec4(n, depth);
    g.material = wanted ? surface.a : g.material;
}

#ifdef CAMERA
const float kReceived = 0.55; // of the light, where a receiver lies in shadow

float random(vec3 p) {
    p = fract(p * vec3(0.1031, 0.1030, 0.0973));
    p += dot(p, p.yxz + 33.33);
    return fract((p.x + p.y) * p.z);
}

// With the grain that the camera's own pixels have; a square root is nearly sRGB's curve.
vec3 grained(vec3 light, vec2 pixel) {
    vec3 where = vec3(floor(pixel / range.w), flags.z);
    float sum = random(where) + random(where + 7.13) + random(where + 17.7) - 1.5;
    vec3 encoded = sqrt(max(light, 0.0)) + 2.0 * flags.y * sum;
    return encoded * max(encoded, 0.0);
}
#endif

// Light of a group times its samples; a: minus the samples it covers.
vec4 group_light(Group g, vec2 pixel) {
    float samples = max(g.color.a, 1e-3);
    // An empty group counts for nothing, but must not breed NaN on the way.
    float depth = max(g.normal.w / samples, range.x);
    int material = int(g.material * 255.0 + 0.5);
    Surface s;
    s.albedo = g.color.rgb / samples;
    s.normal = normalize(g.normal.xyz + vec3(0.0, 0.0, 1e-6));
    s.position = world_point(pixel * target_size.zw, depth);
    s.sheen = materials[2 * material];
    s.sheen.a = max(s.sheen.a, 0.1);
    s.roughness = max(materials[2 * material + 1].x, 0.05);
    vec2 seen = visibility_at(pixel, depth);
    vec3 light = tone_map(shaded(s, seen));
#ifdef CAMERA
    light = materials[2 * material + 1].y > 0.5
                ? camera_color(pixel) * mix(1.0 - kReceived, 1.0, seen.x)
                : flags.y > 0.0 ? grained(light, pixel) : light;
#endif
    float shown = g.color.a;
#ifdef OCCLUSION
    shown *= 1.0 - hidden_share(pixel, depth);
#endif
    return g.color.a > 0.5 ? vec4(light * shown, -shown) : vec4(0.0);
}

// Sum over the samples of one pixel of the target; a: how many samples the background has.
vec4 pixel_light(ivec2 pixel) {
    vec2 centre = vec2(pixel) + 0.5;
    Group near_group = Group(vec4(0.0), vec4(0.0), 0.0);
    Group other_group = near_group;
    float reference = 0.0;
#ifdef EDGE
    const int samples = 4;
#else
    const int samples = 1;
#endif
    for (int s = 0; s < samples; ++s) {
        vec4 surface = texelFetch(drawn_surface, pixel, s);
        vec3 n = texelFetch(drawn_normal, pixel, s).xyz * 2.0 - 1.0;
        float depth = linear_depth(texelFetch(drawn_depth, pixel, s).r);
        bool seen = surface.a > 0.5 / 255.0;
        bool first = seen && near_group.color.a < 0.5;
        reference = first ? depth : reference;
        bool alike = first || (surface.a == near_group.material && abs(depth - reference) < kAlike);
        add(near_group, surface, n, depth, seen && alike);
        add(other_group, surface, n, depth, seen && !alike);
    }
    vec4 result = vec4(0.0, 0.0, 0.0, float(samples)) + group_light(near_group, centre);
#ifdef EDGE
    result += group_light(other_group, centre);
#endif
    return result / float(samples);
}
#endif

void main() {
    vec4 sum = vec4(0.0, 0.0, 0.0, 1.0);
#if defined(SURFACE) || defined(EDGE)
    int scale = int(range.w);
    sum = vec4(0.0);
    for (int y = 0; y < scale; ++y) {
        for (int x = 0; x < scale; ++x) {
            sum += pixel_light(ivec2(gl_FragCoord.xy) * scale + ivec2(x, y));
        }
    }
    sum /= float(scale * scale);
#endif
#if !defined(SURFACE) || defined(OCCLUSION)
    sum.rgb += sum.a * background(gl_FragCoord.xy * range.w);
#endif
#ifdef STUDIO
    float dithered = 1.0;
#else
    float dithered = sum.a < 0.9995 ? 1.0 : 0.0;
#endif
    float noise = fract(52.9829189 * fract(dot(floor(gl_FragCoord.xy), vec2(0.06711056, 0.00583715))));
    color = vec4(srgb(clamp(sum.rgb, 0.0, 1.0)) + dithered * (noise - 0.5) / 255.0, 1.0);
}
