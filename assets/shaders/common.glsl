#version 330 core
// Before every shader of this folder: where the eye and the lamp are.
uniform mat4 view_projection;
uniform vec3 eye;
uniform vec3 light;  // towards the lamp, length 1

// The room as a smooth surface mirrors it, bright above and dark below.
float mirrored_room(vec3 direction) { return smoothstep(-0.35, 0.75, direction.y); }
float mirrored_lamp(vec3 direction, float sharpness) { return pow(max(dot(direction, light), 0.0), sharpness); }
// Light that goes around a body by `wrap`, 0..1, as it does where it comes out beside where it went in.
vec3 wrapped(vec3 n, vec3 wrap) { return max((dot(n, light) + wrap) / (1.0 + wrap), 0.0); }
