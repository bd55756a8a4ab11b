#version 330 core
// The mean over a pixel's samples is taken in linear light, then encoded as sRGB.
uniform sampler2D samples;
uniform int per_side;
out vec4 color;
void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * per_side;
    vec3 total = vec3(0.0);
    for (int y = 0; y < per_side; ++y)
        for (int x = 0; x < per_side; ++x)
            total += min(texelFetch(samples, corner + ivec2(x, y), 0).rgb, vec3(1.0));
    vec3 linear = total / float(per_side * per_side);
    vec3 srgb = mix(linear * 12.92, 1.055 * pow(max(linear, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055,
                    step(vec3(0.0031308), linear));
    color = vec4(srgb, 1.0);
}
