// Which element is at a pixel (24 bits), and how well a line around it can be seen: not at all if it has a few pixels only.
precision highp float;
precision highp int;
precision highp sampler2D;

in vec3 vPosition;
flat in uint vElement;

uniform sampler2D areas;

out vec4 found;

void main() {
  int width = textureSize(areas, 0).x;
  int e = int(vElement);
  float area = texelFetch(areas, ivec2(e % width, e / width), 0).r;
  float pixels = area / max(length(cross(dFdx(vPosition), dFdy(vPosition))), 1e-20);
  uint number = vElement + 1u;
  vec3 bytes = vec3(number & 255u, (number >> 8) & 255u, (number >> 16) & 255u) / 255.0;
  found = vec4(bytes, smoothstep(10.0, 150.0, pixels));
}
