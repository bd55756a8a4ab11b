#version 330 core
// An image on a parallelogram.
uniform mat4 view;
uniform mat4 projection;
in vec3 in_corner;
in vec3 in_across;
in vec3 in_up;
out vec2 v_place;
void main() {
    v_place = vec2((gl_VertexID & 1) == 1 ? 1.0 : 0.0, (gl_VertexID & 2) == 2 ? 1.0 : 0.0);
    gl_Position = projection * view * vec4(in_corner + v_place.x * in_across + v_place.y * in_up, 1.0);
}
