#version 330 core
// One segment a-b of a polyline, with the points before and after it, as a quad on the page.
uniform mat4 view;
uniform mat4 projection;
uniform vec2 viewport;
uniform float per_side;
in vec3 in_before;
in vec3 in_a;
in vec3 in_b;
in vec3 in_after;
in vec4 in_color_a;
in vec4 in_color_b;
in float in_half_width;
in float in_lift;
flat out vec2 v_before;
flat out vec2 v_a;
flat out vec2 v_b;
flat out vec2 v_after;
flat out float v_half_width;
flat out vec4 v_color_a;
flat out vec4 v_color_b;

vec2 pixel(vec4 clip) { return (clip.xy / clip.w * 0.5 + 0.5) * viewport; }

void main() {
    float half_width = in_half_width * per_side;
    vec4 a = view * vec4(in_a, 1.0);
    vec4 b = view * vec4(in_b, 1.0);
    vec4 clip_a = projection * a;
    vec4 clip_b = projection * b;
    v_before = pixel(projection * (view * vec4(in_before, 1.0)));
    v_a = pixel(clip_a);
    v_b = pixel(clip_b);
    v_after = pixel(projection * (view * vec4(in_after, 1.0)));
    v_half_width = half_width;
    v_color_a = in_color_a;
    v_color_b = in_color_b;
    vec2 along = v_b - v_a;
    along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    float reach = half_width + 1.0;
    bool at_b = (gl_VertexID & 1) == 1;
    float sign_across = (gl_VertexID & 2) == 2 ? 1.0 : -1.0;
    vec2 corner = (at_b ? v_b + along * reach : v_a - along * reach) + across * sign_across * reach;
    vec4 position = at_b ? b : a;
    vec4 clip = at_b ? clip_b : clip_a;
    vec4 lifted = projection * (position + vec4(0.0, 0.0, in_lift, 0.0));
    vec2 ndc = corner / viewport * 2.0 - 1.0;
    gl_Position = vec4(ndc * clip.w, lifted.z / lifted.w * clip.w, clip.w);
}
