#version 330 core
// A soft material: light from a wide lamp and from the room, a little that comes
// through thin places, and less of it where the surface is hollow. What changes slowly
// comes from the vertices, which are few where the processor draws.
in vec3 room_light;
in float lamp_light;
in float shadowed;  // how much of the tool's shadow falls here
in float shine;
in vec2 fallen;     // from the middle of that shadow, in its own sizes
in float sunk;

uniform vec3 colour;
uniform vec3 mark_colour; // error over the JND
uniform float mark;       // how much of it shows, 0..1

out vec4 pixel;

void main() {
  vec3 base = mix(colour, mark_colour, mark * smoothstep(0.16, 0.55, sunk));
  float falling = 1.0 + 0.6 * dot(fallen, fallen);
  float shadow = shadowed / (falling * falling);
  pixel = vec4(base * (room_light + lamp_light * (1.0 - shadow)) + vec3(shine), 1.0);
}
