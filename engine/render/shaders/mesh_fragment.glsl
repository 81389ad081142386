in vec3 world_position;
in vec3 world_normal;
in vec2 surface_texcoord;
uniform vec4 base_color;
uniform vec4 sheen;       // colour, roughness
uniform float roughness;
uniform float normal_scale;
uniform bool has_normal_texture;
uniform bool holes;
uniform sampler2D base_color_texture;
uniform sampler2D normal_texture;
uniform sampler2D camera_depth;
out vec4 color;

// Normal map without stored tangents: the frame comes from the derivatives of the texcoords.
vec3 mapped_normal(vec3 n) {
    vec3 dp1 = dFdx(world_position);
    vec3 dp2 = dFdy(world_position);
    vec2 dt1 = dFdx(surface_texcoord);
    vec2 dt2 = dFdy(surface_texcoord);
    vec3 a = cross(dp2, n);
    vec3 b = cross(n, dp1);
    vec3 tangent = a * dt1.x + b * dt2.x;
    vec3 bitangent = a * dt1.y + b * dt2.y; // along rising v: down the picture
    float scale = inversesqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-20));
    vec3 m = texture(normal_texture, surface_texcoord).xyz * 2.0 - 1.0;
    m.xy *= normal_scale;
    return normalize(tangent * (scale * m.x) - bitangent * (scale * m.y) + n * m.z);
}

// Ambient light that comes back after bounces on a coloured surface (fit of Jimenez et al. 2016).
vec3 bounced(float v, vec3 albedo) {
    vec3 a = 2.0404 * albedo - 0.3324;
    vec3 b = -4.7951 * albedo + 0.6417;
    vec3 c = 2.7552 * albedo + 0.6903;
    return max(vec3(v), ((v * a + b) * v + c) * v);
}

// GGX with Smith visibility (Hammon's approximation), F0 = 0.04.
float glossy(vec3 n, vec3 l, vec3 v, float nl, float nv, float alpha) {
    vec3 h = normalize(l + v);
    float nh = clamp(dot(n, h), 0.0, 1.0);
    float lh = clamp(dot(l, h), 0.0, 1.0);
    float a2 = alpha * alpha;
    float d = nh * nh * (a2 - 1.0) + 1.0;
    float fresnel = 0.04 + 0.96 * pow(1.0 - lh, 5.0);
    return fresnel * a2 / (d * d) * 0.5 / max(mix(2.0 * nl * nv, nl + nv, alpha), 0.02);
}

// Charlie distribution (Estevez and Kulla 2017) with Ashikhmin's visibility.
float fibres(vec3 n, vec3 l, vec3 v, float nl, float nv, float rough) {
    float nh = clamp(dot(n, normalize(l + v)), 0.0, 1.0);
    float inverse = 1.0 / max(rough * rough, 0.02);
    float d = (2.0 + inverse) * pow(1.0 - nh * nh, inverse * 0.5) * 0.5;
    return d / max(4.0 * (nl + nv - nl * nv), 0.05);
}

// Share of the fragment that something real, seen by the depth camera, hides.
float hidden_share(float depth) {
    ivec2 size = textureSize(camera_depth, 0);
    vec2 pixel = vec2(gl_FragCoord.x, target_size.y - gl_FragCoord.y);
    vec2 place = pixel * target_size.zw * vec2(size);
    if (occlusion.y < 1.5) {
        float real = texelFetch(camera_depth, min(ivec2(place), size - 1), 0).r;
        return real > 0.0 && real < depth - occlusion.x ? 1.0 : 0.0;
    }
    // Near alike pixels of the camera's picture decide together, so that edges follow the picture.
    vec3 own = camera_color(gl_FragCoord.xy);
    ivec2 base = ivec2(floor(place - 0.5));
    float sum = 0.0;
    float total = 1e-4;
    for (int i = 0; i < 36; ++i) {
        ivec2 q = clamp(base + ivec2(i % 6, i / 6) - 2, ivec2(0), size - 1);
        vec2 centre = (vec2(q) + 0.5) / vec2(size);
        float real = texelFetch(camera_depth, q, 0).r;
        vec2 away = vec2(q) + 0.5 - place;
        vec3 other = textureLod(camera_picture, centre, 0.0).rgb;
        vec3 unlike = sqrt(other) - sqrt(own);
        float w = exp(-0.35 * dot(away, away) - 60.0 * dot(unlike, unlike)) * (real > 0.0 ? 1.0 : 0.1);
        sum += w * (real > 0.0 && real < depth - occlusion.x ? 1.0 : 0.0);
        total += w;
    }
    return smoothstep(0.25, 0.75, sum / total);
}

vec3 shaded(vec3 albedo, vec3 n, vec2 seen) {
    vec3 v = normalize(world_from_camera[3].xyz - world_position);
    float nv = clamp(dot(n, v), 0.03, 1.0);
    float alpha = roughness * roughness;
    float soft_alpha = clamp(alpha + key_direction.w, 0.0, 1.0);
    vec3 energy = vec3(1.0) - sheen.rgb * 0.5;

    // Key: a soft box, so that light reaches a little round the terminator.
    vec3 l = key_direction.xyz;
    float nl = dot(n, l);
    float wrap = 0.35 * key_direction.w;
    float diffuse = clamp((nl + wrap) / (1.0 + wrap), 0.0, 1.0);
    float lit = clamp(nl, 0.0, 1.0);
    vec3 result = key_color.rgb * seen.x *
                  (albedo * energy * diffuse +
                   lit * (glossy(n, l, v, lit, nv, soft_alpha) + sheen.rgb * fibres(n, l, v, lit, nv, sheen.a)));

    // Surroundings and the broad fill.
    vec3 around = mix(ground.rgb, sky.rgb, n.y * 0.5 + 0.5);
    float fill = clamp(dot(n, fill_direction.xyz) * 0.6 + 0.4, 0.0, 1.0);
    vec3 open = bounced(seen.y, albedo);
    float grazing = pow(1.0 - nv, 4.0);
    result += (around + fill_color.rgb * fill) *
              (open * albedo * energy + seen.y * (0.02 * (1.0 - roughness) + 0.05 * grazing * (1.0 - roughness) +
                                                  sheen.rgb * (0.08 + 0.6 * grazing)));

    // Rim from behind.
    float edge = clamp(dot(n, rim_direction.xyz), 0.0, 1.0);
    result += rim_color.rgb * seen.y * seen.y * edge * (albedo * energy + sheen.rgb * grazing + 0.15 * grazing * (1.0 - roughness));
    return result;
}

void main() {
    vec4 base = base_color * texture(base_color_texture, surface_texcoord);
    if (holes && base.a < 0.5) discard;
    vec3 n = normalize(world_normal);
    n = gl_FrontFacing ? n : -n;
    if (has_normal_texture) n = mapped_normal(n);
    float depth = 1.0 / gl_FragCoord.w;
    color = vec4(tone_map(shaded(base.rgb, n, visibility_at(gl_FragCoord.xy, depth))), 1.0);
    if (occlusion.y > 0.5) {
        float hidden = hidden_share(depth);
        color = hidden >= 1.0 ? vec4(camera_color(gl_FragCoord.xy), 0.0)
                              : vec4(mix(color.rgb, camera_color(gl_FragCoord.xy), hidden), 1.0);
    }
}
