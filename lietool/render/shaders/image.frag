#version 330 core
uniform sampler2D texels;
in vec2 v_place;
out vec4 color;
void main() {
    color = vec4(texture(texels, v_place).rgb, 1.0);
}
