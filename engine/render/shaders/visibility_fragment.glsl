// How much of the key light (r) and of the surroundings (g) each pixel sees; b, a: its depth.
// Variant ON_FLOOR: the floor takes only the shadow; it has its own contact map.
in vec2 uv;
uniform sampler2D surface_depth;
uniform sampler2D surface_normal;
uniform sampler2D shadow_map;
out vec4 visibility;

const float kGolden = 2.39996323;
const float kReach = 0.16; // metres over which surfaces darken each other

// One of 16 angles, each once in every 4 x 4 pixels; the blur averages over such a square.
float pattern_angle() {
    ivec2 p = ivec2(gl_FragCoord.xy) & 3;
    int order = ((p.x ^ p.y) & 1) * 8 + (p.y & 1) * 4 + (((p.x ^ p.y) >> 1) & 1) * 2 + ((p.y >> 1) & 1);
    return float(order) * (2.0 * kPi / 16.0);
}

vec2 spiral(int i, float count, float angle) {
    float a = float(i) * kGolden + angle;
    return sqrt((float(i) + 0.5) / count) * vec2(cos(a), sin(a));
}

// Scalable ambient obscurance (McGuire, Mara and Luebke 2012), polynomial falloff.
float ambient(vec3 p, vec3 n, float depth, float angle) {
    float radius_uv = kReach / (depth * (borders.w - borders.z));
    vec2 scale = vec2(radius_uv * visibility_size.y * visibility_size.z, radius_uv);
    float r2 = kReach * kReach;
    float sum = 0.0;
    int count = int(occlusion.z);
    for (int i = 0; i < count; ++i) {
        vec2 s = spiral(i, float(count), angle);
        vec2 place = uv + s * length(s) * scale;
        vec3 q = camera_point(place, textureLod(surface_depth, place, 0.0).r);
        vec3 v = q - p;
        float vv = dot(v, v);
        float f = max(r2 - vv, 0.0) / r2;
        sum += f * f * f * max((dot(v, n) - 0.002 - 0.003 * depth * 0.3) / (vv + 0.0008), 0.0);
    }
    return 1.0 - clamp(sum * 0.115 / float(max(count, 1)) * 1.3, 0.0, 1.0);
}

// Percentage-closer soft shadows: blockers first, then a disc as wide as their penumbra.
float key(vec3 world, vec3 n, float angle) {
    vec3 p = (light_from_world * vec4(world, 1.0)).xyz;
    vec3 m = mat3(light_from_world) * n;
    vec2 slope = clamp(-m.xy / min(m.z, -0.15), -2.5, 2.5); // depth of the receiver's own plane
    float tangent = key_direction.w;
#ifdef ON_FLOOR
    const float widest = 0.17;
#else
    const float widest = 0.07;
#endif
    float search = clamp(tangent * 0.6, 2.0 * shadow.w, widest);
    bool inside = all(greaterThan(p.xy * shadow.xy, vec2(-0.05))) &&
                  all(lessThan(p.xy * shadow.xy, vec2(1.05))) && p.z > 0.0;
    float blockers = 0.0;
    float blocker_depth = 0.0;
    int count = inside && m.z < 0.12 ? 10 : 0;
    for (int i = 0; i < count; ++i) {
        vec2 d = spiral(i, 10.0, angle) * search;
        float z = textureLod(shadow_map, (p.xy + d) * shadow.xy, 0.0).r;
        float lifted = p.z + dot(slope, d) - 0.004;
        if (z < 1.0 && z * shadow.z < lifted) {
            blockers += 1.0;
            blocker_depth += z * shadow.z;
        }
    }
    float gap = max(p.z - blocker_depth / max(blockers, 1.0), 0.0);
    float radius = clamp(gap * tangent * 0.5, 2.0 * shadow.w, widest);
    count = blockers > 0.0 ? int(occlusion.w) : 0;
    float hidden = 0.0;
    for (int i = 0; i < count; ++i) {
        vec2 d = spiral(i, occlusion.w, angle) * radius;
        float z = textureLod(shadow_map, (p.xy + d) * shadow.xy, 0.0).r;
        if (z < 1.0 && z * shadow.z < p.z + dot(slope, d) - 0.0025) hidden += 1.0;
    }
    return 1.0 - hidden / max(float(count), 1.0);
}

void main() {
    float depth = texelFetch(surface_depth, ivec2(gl_FragCoord.xy), 0).r;
    vec3 p = camera_point(uv, depth);
    float angle = pattern_angle();
    vec2 seen = vec2(1.0);
#ifdef ON_FLOOR
    vec3 n = vec3(0.0, 1.0, 0.0);
#else
    vec3 n = normalize(texelFetch(surface_normal, ivec2(gl_FragCoord.xy), 0).xyz * 2.0 - 1.0);
    seen.y = ambient(p, transpose(mat3(world_from_camera)) * n, depth, angle);
#endif
    float facing = dot(n, key_direction.xyz);
    vec3 lifted = n * (0.0015 + 1.5 * shadow.w * (1.0 - clamp(facing, 0.0, 1.0)));
    seen.x = key((world_from_camera * vec4(p, 1.0)).xyz + lifted, n, angle);
    visibility = vec4(seen, pack_depth(depth));
}
