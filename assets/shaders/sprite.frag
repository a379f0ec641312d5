// A part of a picture that was drawn before.
in vec2 share;

uniform sampler2D picture;

out vec4 pixel;  // multiplied with its opacity

void main() { pixel = textureLod(picture, share, 0.0); }
