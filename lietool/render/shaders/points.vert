#version 330 core
uniform mat4 view;
uniform mat4 projection;
uniform vec2 viewport;
uniform float per_side;
in vec3 in_position;
in vec4 in_color;
in vec4 in_rim;
in float in_radius;
in float in_shaded;
in float in_lift;
flat out vec4 v_color;
flat out vec4 v_rim;
flat out float v_radius;
flat out float v_shaded;
flat out vec2 v_center;
void main() {
    vec4 position = view * vec4(in_position, 1.0);
    vec4 clip = projection * position;
    vec4 lifted = projection * (position + vec4(0.0, 0.0, in_lift, 0.0));
    v_color = in_color;
    v_rim = in_rim;
    v_radius = in_radius * per_side;
    v_shaded = in_shaded;
    vec2 corner = vec2((gl_VertexID & 1) == 1 ? 1.0 : -1.0, (gl_VertexID & 2) == 2 ? 1.0 : -1.0);
    v_center = (clip.xy / clip.w * 0.5 + 0.5) * viewport;
    vec2 ndc = clip.xy / clip.w + corner * (v_radius + 1.0) * 2.0 / viewport;
    gl_Position = vec4(ndc * clip.w, lifted.z / lifted.w * clip.w, clip.w);
}
