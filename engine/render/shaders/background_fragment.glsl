// Backdrop of a studio (a floor that rises into a wall), a flat colour, or the camera's picture.
// Alpha 0: colours are exact, no dither.
in vec2 uv;
uniform sampler2D contact_map;
uniform bool has_floor;
out vec4 color;

void main() {
    if (backdrop.w > 1.5) {
        color = vec4(camera_color(gl_FragCoord.xy), 0.0);
        return;
    }
    if (backdrop.w > 0.5) {
        color = vec4(backdrop.rgb, 0.0);
        return;
    }
    vec3 eye = world_from_camera[3].xyz;
    vec3 ray = mat3(world_from_camera) * camera_point(uv, 1.0);
    vec3 to_subject = subject.xyz - eye;
    float away = length(to_subject);

    // The wall: brighter behind the subject, falling off softly.
    float turn = 1.0 - dot(normalize(ray), to_subject / away);
    float spread = subject.w / away;
    float glow = exp(-turn / (0.9 * spread * spread));
    vec3 wall = backdrop.rgb * (0.80 + 0.34 * glow);

    // The floor: a pool of light round the feet, with the subject's shadows.
    float t = ray.y < -1e-4 && has_floor ? -eye.y / ray.y : 1e6;
    vec3 place = eye + ray * t;
    vec2 forward = normalize(to_subject.xz + vec2(0.0, 1e-6));
    float behind = dot(place.xz - subject.xz, forward);
    float from_feet = length(place.xz - subject.xz) / subject.w;
    vec3 ground_color = backdrop.rgb * (0.84 + 0.22 * exp(-from_feet * from_feet * 0.55));
    vec2 seen = t < range.y ? visibility_at(gl_FragCoord.xy, t) : vec2(1.0);
    vec2 cell = (place.xz - contact.xy) * contact.z;
    float touching = texture(contact_map, cell).r * contact.w;
    float ambient_share = 0.5;
    float shade = ambient_share * (1.0 - touching) * seen.y + (1.0 - ambient_share) * seen.x;
    float rise = smoothstep(0.6, 4.5, behind / subject.w);
    color = vec4(mix(ground_color * mix(shade, 1.0, rise), wall, rise), 1.0);
}
