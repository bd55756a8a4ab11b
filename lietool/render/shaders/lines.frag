#version 330 core
flat in vec2 v_before;
flat in vec2 v_a;
flat in vec2 v_b;
flat in vec2 v_after;
flat in float v_half_width;
flat in vec4 v_color_a;
flat in vec4 v_color_b;
out vec4 color;

float distance_to(vec2 p, vec2 a, vec2 b, out float t) {
    vec2 ab = b - a;
    float length2 = dot(ab, ab);
    t = length2 > 0.0 ? clamp(dot(p - a, ab) / length2, 0.0, 1.0) : 0.0;
    vec2 nearest = t <= 0.0 ? a : t >= 1.0 ? b : a + t * ab;
    return length(p - nearest);
}

void main() {
    // Not interpolated: where Mesa clips a quad at the edge of a tile, it gets that wrong.
    vec2 pixel = gl_FragCoord.xy;
    float t, unused;
    float d = distance_to(pixel, v_a, v_b, t);
    float coverage = clamp(v_half_width + 0.5 - d, 0.0, 1.0);
    if (coverage <= 0.0) discard;
    // A pixel near a joint belongs to one segment only, else a translucent line would show its joints.
    if (v_before != v_a && distance_to(pixel, v_before, v_a, unused) < d) discard;
    if (v_after != v_b && distance_to(pixel, v_b, v_after, unused) <= d) discard;
    vec4 tint = mix(v_color_a, v_color_b, t);
    color = vec4(tint.rgb, 1.0) * tint.a * coverage;
}
