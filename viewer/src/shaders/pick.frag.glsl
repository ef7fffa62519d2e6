// What is at a pixel, as bits: which element and how much light (what = 0), or where (what = 1).
precision highp float;
precision highp int;

in vec3 vPosition;
centroid in vec3 vIrradiance;
flat in uint vElement;

uniform int what;

out uvec4 found;

void main() {
  found = what == 0 ? uvec4(vElement + 1u, floatBitsToUint(vIrradiance)) : uvec4(floatBitsToUint(vPosition), 1u);
}
