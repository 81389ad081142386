// Light on one surface point, and the tone of the result.
struct Surface {
    vec3 albedo;
    vec3 normal;   // towards the camera
    vec3 position; // world
    vec4 sheen;    // colour, roughness
    float roughness;
};

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

// `seen`: shares of the key light and of the surroundings.
vec3 shaded(Surface s, vec2 seen) {
    vec3 n = s.normal;
    vec3 v = normalize(world_from_camera[3].xyz - s.position);
    float nv = clamp(dot(n, v), 0.03, 1.0);
    float alpha = s.roughness * s.roughness;
    float soft_alpha = clamp(alpha + key_direction.w, 0.0, 1.0);
    vec3 energy = vec3(1.0) - s.sheen.rgb * 0.5;

    // Key: a soft box, so that light reaches a little round the terminator.
    vec3 l = key_direction.xyz;
    float nl = dot(n, l);
    float wrap = 0.35 * key_direction.w;
    float diffuse = clamp((nl + wrap) / (1.0 + wrap), 0.0, 1.0);
    float lit = clamp(nl, 0.0, 1.0);
    vec3 result = key_color.rgb * seen.x *
                  (s.albedo * energy * diffuse +
                   lit * (glossy(n, l, v, lit, nv, soft_alpha) + s.sheen.rgb * fibres(n, l, v, lit, nv, s.sheen.a)));

    // Surroundings and the broad fill.
    vec3 around = mix(ground.rgb, sky.rgb, n.y * 0.5 + 0.5);
    float fill = clamp(dot(n, fill_direction.xyz) * 0.6 + 0.4, 0.0, 1.0);
    vec3 open = bounced(seen.y, s.albedo);
    float grazing = pow(1.0 - nv, 4.0);
    result += (around + fill_color.rgb * fill) *
              (open * s.albedo * energy + seen.y * (0.02 * (1.0 - s.roughness) + 0.05 * grazing * (1.0 - s.roughness) +
                                                  s.sheen.rgb * (0.08 + 0.6 * grazing)));

    // Rim from behind.
    float edge = clamp(dot(n, rim_direction.xyz), 0.0, 1.0);
    result += rim_color.rgb * seen.y * seen.y * edge * (s.albedo * energy + s.sheen.rgb * grazing + 0.15 * grazing * (1.0 - s.roughness));
    return result;
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
