// What is seen of a surface: its light as the eye sees it, or a quantity in false colours; isolux lines over both. There is a program for each
// choice (uniforms.ts): MODE; BY_ELEMENT, each element shows the one value that was computed for it; TEXTURED; LINES. Processors that draw take
// twice as long if programs choose themselves.
precision highp float;
precision highp int;
precision highp sampler2D;

#define LIGHT 0
#define ILLUMINANCE 1
#define ERROR 2
#define DIFFERENCE 3

centroid in vec3 vIrradiance;
#ifdef HAS_BEFORE
centroid in vec3 vIrradianceBefore;
#endif
#ifdef HAS_UV
centroid in vec2 vUv;
#endif
#ifdef HAS_EMISSION_UV
centroid in vec2 vEmissionUv;
#endif
#ifdef HAS_TINT
centroid in vec3 vTint;
#endif
flat in uint vElement;

// What luminance is multiplied by.
uniform float exposure;
// Irradiance of every element, and the standard error of its luminance; of the other solution the same.
uniform sampler2D elements;
uniform sampler2D elementsBefore;
// Whether errors are shown relative to the values.
uniform bool relativeError;
uniform sampler2D palette;
uniform vec2 range;
uniform bool logarithmic;
// Isolux lines: their number and illuminances, rising.
uniform int levelCount;
uniform float levels[24];
// Width of a line in pixels.
uniform float lineWidth;

// Of the material; mean colours stand in for textures that are switched off.
uniform vec3 reflectivity;
uniform vec3 emission;
#ifdef HAS_UV
uniform sampler2D reflectivityMap;
uniform vec3 reflectivityMean;
#endif
#ifdef HAS_EMISSION_UV
uniform sampler2D emissionMap;
uniform vec3 emissionMean;
#endif

out vec4 colour;

vec4 ofElement(sampler2D values) {
  int width = textureSize(values, 0).x;
  int e = int(vElement);
  return texelFetch(values, ivec2(e % width, e / width), 0);
}

// Luminance [cd/m²] of the surface under so much irradiance.
vec3 seen(vec3 irradiance) {
  vec3 rho = reflectivity;
  vec3 emitted = emission;
#ifdef HAS_TINT
  rho *= vTint;
#endif
#if defined(HAS_UV) && defined(TEXTURED)
  rho *= texture(reflectivityMap, vUv).rgb;
#elif defined(HAS_UV)
  rho *= reflectivityMean;
#endif
#if defined(HAS_EMISSION_UV) && defined(TEXTURED)
  emitted *= texture(emissionMap, vEmissionUv).rgb;
#elif defined(HAS_EMISSION_UV)
  emitted *= emissionMean;
#endif
  return (emitted + rho * irradiance) * 0.31830988618;
}

float onScale(float value) {
  float t = logarithmic ? log(max(value, 1e-30) / range.x) / log(range.y / range.x) : (value - range.x) / (range.y - range.x);
  return clamp(t, 0.0, 1.0);
}

vec3 falseColour(float value) {
  float size = float(textureSize(palette, 0).x);
  return texture(palette, vec2((0.5 + onScale(value) * (size - 1.0)) / size, 0.5)).rgb;
}

// How much of a pixel lies on an isolux line, in [0, 1].
float onLine(float lux) {
  float change = max(fwidth(lux), 1e-6 * abs(lux) + 1e-20);
  float below = -1e30, above = 1e30;
  for (int k = 0; k < levelCount; k++) {
    if (levels[k] <= lux) below = levels[k];
    else above = min(above, levels[k]);
  }
  float nearest = min(lux - below, above - lux);
  // Where light is as good as even a line would be as wide as the wall; where it changes within pixels there would be lines all over.
  float seen = smoothstep(0.0, 2e-5 * lux, change) * (1.0 - smoothstep(0.3, 0.7, change / min(above - below, 1e3 * lux + 1e-20)));
  return seen * (1.0 - smoothstep(0.5 * lineWidth - 0.5, 0.5 * lineWidth + 0.5, nearest / change));
}

void main() {
  vec3 smoothLight = max(vIrradiance, 0.0);
#ifdef BY_ELEMENT
  vec3 light = ofElement(elements).rgb;
#else
  vec3 light = smoothLight;
#endif
#if MODE == LIGHT
  vec3 shown = onScreen(filmic(seen(light) * exposure));
#elif MODE == ILLUMINANCE
  vec3 shown = falseColour(luminance(light));
#elif MODE == ERROR
  vec4 element = ofElement(elements);
  float lux = luminance(element.rgb);
  float error = relativeError ? 100.0 * element.a / max(lux, 1e-20) : element.a;
  // An error that is not known is grey, as in the dark.
  vec3 shown = isnan(element.a) || (relativeError && lux <= 0.0) ? vec3(0.25) : falseColour(error);
#elif defined(HAS_BEFORE) && !defined(BY_ELEMENT)
  vec3 shown = falseColour(luminance(light) - luminance(vIrradianceBefore));
#else
  vec3 shown = falseColour(luminance(ofElement(elements).rgb) - luminance(ofElement(elementsBefore).rgb));
#endif
#ifdef LINES
  float line = onLine(luminance(smoothLight));
  vec3 ink = luminance(shown) > 0.45 ? vec3(0.0) : vec3(1.0);
  shown = mix(shown, ink, 0.8 * line);
#endif
  colour = vec4(shown, 1.0);
}
