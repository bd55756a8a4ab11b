#version 330 core
flat in vec4 v_color;
flat in vec4 v_rim;
flat in float v_radius;
flat in float v_shaded;
flat in vec2 v_center;
out vec4 color;

const vec3 KEY = normalize(vec3(-0.45, 0.75, 0.62));

void main() {
    vec2 offset = gl_FragCoord.xy - v_center;
    float d = length(offset);
    float coverage = clamp(v_radius + 0.5 - d, 0.0, 1.0);
    if (coverage <= 0.0) discard;
    vec3 tint = v_color.rgb;
    if (v_shaded > 0.5) {
        vec2 xy = offset / v_radius;
        vec3 normal = vec3(xy, sqrt(max(1.0 - dot(xy, xy), 0.0)));
        float specular = pow(max(dot(normal, normalize(KEY + vec3(0.0, 0.0, 1.0))), 0.0), 40.0);
        tint = tint * (mix(0.34, 0.58, normal.y * 0.5 + 0.5) + 0.66 * max(dot(normal, KEY), 0.0)) + 0.25 * specular;
    }
    float rim = v_rim.a * clamp(d - 0.78 * v_radius + 0.5, 0.0, 1.0);
    tint = mix(tint, v_rim.rgb, rim);
    color = vec4(tint, 1.0) * v_color.a * coverage;
}
