// Light, the same as in the pictures that `pseudopod render` makes, in linear amounts; the last step is to sRGB.

export const LIGHT = `
uniform vec3 light;
uniform vec3 sky;

vec3 toLinear(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), step(0.04045, c)); }
vec3 toScreen(vec3 c) { c = clamp(c, 0.0, 1.0); return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }

// A painted skin under a bright sky, a main light and a weak lamp at the camera.
vec3 lit(vec3 paint, vec3 normal, vec3 viewer) {
  float facing = clamp(dot(normal, viewer), 0.0, 1.0);
  float up = 0.5 + 0.5 * dot(normal, sky);
  float main = max((dot(normal, light) + 0.25) / 1.25, 0.0);
  float amount = 0.20 + 0.30 * up + 0.62 * main + 0.10 * facing;
  float half_ = max(dot(normal, normalize(light + viewer)), 0.0);
  float gloss = 0.10 * pow(half_, 42.0) + 0.035 * pow(half_, 9.0);
  float rim = pow(1.0 - facing, 3.0);
  return toScreen(paint * amount * (1.0 - 0.45 * rim) + gloss + 0.05 * rim * up);
}
`;
