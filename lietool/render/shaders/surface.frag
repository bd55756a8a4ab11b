#version 330 core
// 0 flat, 1 matte, 2 glass, 3 soft, as in batches.MATERIALS.
uniform float side;  // of a shell of glass: -1 the far wall, 1 the near wall
uniform bool lens;   // false on a page, where every line of sight is along z
// Of the theme: light from below, from above and from the lamp, highlights; glass straight on and at its rim.
uniform vec4 light;
uniform vec4 glass;
in vec3 v_position;
in vec3 v_normal;
in vec4 v_color;
flat in float v_material;
out vec4 color;

const vec3 KEY = normalize(vec3(-0.45, 0.75, 0.62));
const vec3 FILL = normalize(vec3(0.8, -0.25, 0.45));

void main() {
    if (v_material < 0.5) {
        color = vec4(v_color.rgb * v_color.a, v_color.a);
        return;
    }
    vec3 eye = lens ? normalize(-v_position) : vec3(0.0, 0.0, 1.0);
    vec3 normal = normalize(v_normal);
    float facing = dot(normal, eye);
    bool shell = v_material > 1.5 && v_material < 2.5;
    // Soft: hardly darker where it is turned from the lamp, so that a face keeps its tint however it turns.
    float soft = v_material > 2.5 ? 0.55 : 0.0;
    if (shell && facing * side < 0.0) discard;
    if (facing < 0.0) normal = -normal;
    facing = abs(facing);
    // The 48th power by multiplication: pow costs the software renderer more than all the rest.
    float shine = max(dot(normal, normalize(KEY + eye)), 0.0);
    float shine4 = shine * shine * shine * shine;
    float shine16 = shine4 * shine4 * shine4 * shine4;
    float specular = shine16 * shine16 * shine16;
    if (shell) {
        float rim = (1.0 - facing) * (1.0 - facing);
        float alpha = v_color.a * mix(glass.x, glass.y, rim) * (side < 0.0 ? 0.62 : 1.0);
        vec3 tint = mix(v_color.rgb * glass.z, v_color.rgb * glass.w, rim);
        float spark = side > 0.0 ? 0.20 * light.w * specular : 0.0;
        color = vec4(tint * alpha + spark, alpha + spark * 0.5);
        return;
    }
    float ambient = mix(light.x, light.y, normal.y * 0.5 + 0.5);
    float key = light.z * max(dot(normal, KEY), 0.0);
    vec3 fill = vec3(0.06, 0.075, 0.10) * max(dot(normal, FILL), 0.0);
    vec3 lit = v_color.rgb * mix(ambient + key + fill, vec3(0.86), soft) + 0.16 * light.w * specular * (1.0 - soft);
    color = vec4(lit * v_color.a, v_color.a);
}
