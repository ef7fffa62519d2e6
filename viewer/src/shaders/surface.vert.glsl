// A vertex of a surface. Values of the element are those of the provoking vertex (provoking.ts).
precision highp float;
precision highp int;

uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;

in vec3 position;
in vec3 irradiance;
in uint element;
#ifdef HAS_BEFORE
in vec3 irradianceBefore;
#endif
#ifdef HAS_UV
in vec2 uv;
#endif
#ifdef HAS_EMISSION_UV
in vec2 emissionUv;
#endif
#ifdef HAS_TINT
in vec3 tint;
#endif

// Centroids: at the edge of a triangle its middle of a pixel may lie outside, where light would be extrapolated.
out vec3 vPosition;
centroid out vec3 vIrradiance;
#ifdef HAS_BEFORE
centroid out vec3 vIrradianceBefore;
#endif
#ifdef HAS_UV
centroid out vec2 vUv;
#endif
#ifdef HAS_EMISSION_UV
centroid out vec2 vEmissionUv;
#endif
#ifdef HAS_TINT
centroid out vec3 vTint;
#endif
flat out uint vElement;

void main() {
  vPosition = position;
  vIrradiance = irradiance;
  vElement = element;
#ifdef HAS_BEFORE
  vIrradianceBefore = irradianceBefore;
#endif
#ifdef HAS_UV
  vUv = uv;
#endif
#ifdef HAS_EMISSION_UV
  vEmissionUv = emissionUv;
#endif
#ifdef HAS_TINT
  vTint = tint;
#endif
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}
