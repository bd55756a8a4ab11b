#version 330 core
// A pixel is the mean of its samples, in linear light; on a ground that is not opaque it is not either.
uniform sampler2D samples;
uniform int per_side;
out vec4 color;
void main() {
    ivec2 corner = ivec2(gl_FragCoord.xy) * per_side;
    vec4 total = vec4(0.0);
    for (int y = 0; y < per_side; ++y)
        for (int x = 0; x < per_side; ++x)
            total += min(texelFetch(samples, corner + ivec2(x, y), 0), vec4(1.0));
    color = total / float(per_side * per_side);
}
