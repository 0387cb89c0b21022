// The light that parts and hull share, as shader source.
#pragma once

namespace elbowroom::recon::gl {

// vec3 Lit(vec3 color, vec3 normal, vec3 to_eye, vec3 up, float gloss): Blinn-Phong on both sides of a
// surface, lit by the sky, by a light over the viewer's left shoulder and a little by the viewer. All in
// camera axes.
inline constexpr const char* kLightingSource = R"(
vec3 Lit(vec3 color, vec3 normal, vec3 to_eye, vec3 up, float gloss) {
  vec3 n = dot(normal, to_eye) < 0.0 ? -normal : normal;
  vec3 to_light = normalize(vec3(-0.45, -0.75, -0.85));
  vec3 ambient = mix(vec3(0.42, 0.40, 0.39), vec3(0.56, 0.58, 0.60), 0.5 + 0.5 * dot(n, up));
  float key = max(dot(n, to_light), 0.0);
  float head = max(dot(n, to_eye), 0.0);
  float highlight = pow(max(dot(n, normalize(to_light + to_eye)), 0.0), 40.0);
  return color * (ambient + 0.36 * key + 0.14 * head) + gloss * highlight;
}
)";

}  // namespace elbowroom::recon::gl
