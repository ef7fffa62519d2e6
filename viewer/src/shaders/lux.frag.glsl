// Where a surface is, and how much light is interpolated there, as bits.
precision highp float;
precision highp int;

in vec3 vPosition;
centroid in vec3 vIrradiance;

out uvec4 found;

void main() {
  found = floatBitsToUint(vec4(vPosition, dot(vIrradiance, vec3(0.2126, 0.7152, 0.0722))));
}
