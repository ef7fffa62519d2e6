// From luminance to a screen, as crates/core/src/view/tone.rs does it: Hable's filmic curve (2010), each channel by itself mixed
// with the curve of the luminance alone, which keeps hue; sRGB; half a step of ordered noise against banding.

float luminance(vec3 c) {
  return dot(c, vec3(0.2126, 0.7152, 0.0722));
}

float hable(float x) {
  const float A = 0.15, B = 0.50, C = 0.10, D = 0.20, E = 0.02, F = 0.30;
  return x * (A * (F - E) * x + B * (C * F - E)) / (F * (x * (A * x + B) + D * F));
}

float filmicCurve(float x) {
  const float EXPOSURE = 3.0, WHITE_POINT = 11.2;
  return clamp(hable(clamp(EXPOSURE * x, 0.0, WHITE_POINT)) / hable(WHITE_POINT), 0.0, 1.0);
}

vec3 filmic(vec3 x) {
  vec3 byChannel = vec3(filmicCurve(x.r), filmicCurve(x.g), filmicCurve(x.b));
  float y = luminance(x);
  if (y <= 0.0) return byChannel;
  float target = filmicCurve(y);
  vec3 kept = x * (target / y);
  float most = max(kept.r, max(kept.g, kept.b));
  if (most > 1.0) kept = target + (kept - target) * clamp((1.0 - target) / (most - target), 0.0, 1.0);
  return clamp(0.5 * byChannel + 0.5 * kept, 0.0, 1.0);
}

vec3 toSrgb(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

// What the screen shows of a linear display colour.
vec3 onScreen(vec3 c) {
  float noise = fract(52.982918 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  vec3 codes = floor(toSrgb(clamp(c, 0.0, 1.0)) * 255.0 + 0.25 + 0.5 * noise);
  return codes / 255.0;
}
