// Lines where neighbouring pixels show different elements.
precision highp float;
precision highp sampler2D;

uniform sampler2D numbers;

out vec4 colour;

void main() {
  ivec2 at = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(numbers, 0) - 1;
  vec4 here = texelFetch(numbers, at, 0);
  vec4 right = texelFetch(numbers, min(at + ivec2(1, 0), last), 0);
  vec4 above = texelFetch(numbers, min(at + ivec2(0, 1), last), 0);
  bool isEdge = here.rgb != right.rgb || here.rgb != above.rgb;
  float seen = max(here.a, max(right.a, above.a));
  colour = vec4(vec3(0.0), isEdge ? 0.55 * seen : 0.0);
}
