// Lookups for a pixel of the target.
uniform sampler2D visibility_texture;
uniform sampler2D camera_picture;
uniform sampler2D camera_depth;
uniform sampler2D contact_map;

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

#ifdef OCCLUSION
// Share of a surface that something real, seen by the depth camera, hides.
float hidden_share(vec2 picked, float depth) {
    ivec2 size = textureSize(camera_depth, 0);
    vec2 pixel = vec2(picked.x, target_size.y - picked.y);
    vec2 place = pixel * target_size.zw * vec2(size);
#ifdef HARD_EDGES
    float real = texelFetch(camera_depth, min(ivec2(place), size - 1), 0).r;
    return real > 0.0 && real < depth - occlusion.x ? 1.0 : 0.0;
#else
    // Near alike pixels of the camera's picture decide together, so that edges follow the picture.
    vec3 own = camera_color(picked);
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
#endif
}
#endif

// A studio: a floor that rises into a wall, lighter behind the subject, with the subject's shadows.
vec3 studio(vec2 pixel) {
    vec2 place_uv = pixel * target_size.zw;
    vec3 eye = world_from_camera[3].xyz;
    vec3 ray = mat3(world_from_camera) * camera_point(place_uv, 1.0);
    vec3 to_subject = subject.xyz - eye;
    float away = length(to_subject);
    float turn = 1.0 - dot(normalize(ray), to_subject / away);
    float spread = subject.w / away;
    vec3 wall = backdrop.rgb * (0.80 + 0.34 * exp(-turn / (0.9 * spread * spread)));

#ifdef WALL
    return wall;
#else
    float t = min(-eye.y / min(ray.y, -1e-5), 1e4);
    vec3 place = eye + ray * t;
    float behind = dot(place.xz - subject.xz, normalize(to_subject.xz + vec2(0.0, 1e-6)));
    float from_feet = length(place.xz - subject.xz) / subject.w;
    vec3 floor_color = backdrop.rgb * (0.84 + 0.22 * exp(-from_feet * from_feet * 0.55));
    vec2 seen = t < range.y ? visibility_at(pixel, t) : vec2(1.0);
    vec2 cell = (place.xz - contact.xy) * contact.z;
    vec2 inside = clamp(min(cell, 1.0 - cell) * 10.0, 0.0, 1.0);
    float touching = texture(contact_map, cell).r * contact.w * inside.x * inside.y;
    float shade = 0.5 * (1.0 - touching) * seen.y + 0.5 * seen.x;
    float rise = flags.x > 0.5 && ray.y < -1e-4 ? smoothstep(0.6, 4.5, behind / subject.w) : 1.0;
    return mix(floor_color * mix(shade, 1.0, rise), wall, rise);
#endif
}
