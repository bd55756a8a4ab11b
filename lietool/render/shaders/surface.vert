#version 330 core
uniform mat4 view;
uniform mat4 projection;
in vec3 in_position;
in vec3 in_normal;
in vec4 in_color;
in float in_material;
out vec3 v_position;
out vec3 v_normal;
out vec4 v_color;
flat out float v_material;
void main() {
    vec4 position = view * vec4(in_position, 1.0);
    v_position = position.xyz;
    v_normal = mat3(view) * in_normal;
    v_color = in_color;
    v_material = in_material;
    gl_Position = projection * position;
}
