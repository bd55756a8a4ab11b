#version 330 core
// A pixel is the mean of its samples, in linear light.
uniform sampler2D samples;
uniform int per_side;
out vec4 color;
void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * per_side;
    vec3 total = vec3(0.0);
    for (int y = 0; y < per_side; ++y)
        for (int x = 0; x < per_side; ++x)
            total += min(texelFetch(samples, corner + ivec2(x, y), 0).rgb, vec3(1.0));
    color = vec4(total / float(per_side * per_side), 1.0);
}
