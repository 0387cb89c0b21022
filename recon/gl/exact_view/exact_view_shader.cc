#include "recon/gl/exact_view/exact_view_shader.h"

namespace elbowroom::recon::gl {

const char* const kExactViewVertexSource = R"(
layout(location = 0) in vec2 corner;
void main() { gl_Position = vec4(corner, 0.0, 1.0); }
)";

const char* const kExactViewFragmentSource = R"(
uniform sampler2D rays;    // u, v, 1; last 0 where the lens has no ray
uniform sampler2D labels;  // LabelsByPixel, if has_labels
uniform samplerBuffer forms;
uniform usamplerBuffer runs;
uniform samplerBuffer angles;
uniform samplerBuffer keys;
uniform int cameras;
uniform int visibility_outlines;
uniform ivec3 faces;  // not before, not after, beside
uniform float key_end;
uniform bool is_perspective;
uniform bool has_labels;
layout(location = 0) out float depth;
layout(location = 1) out ivec2 surface;

const float kFar = 3.0e38;  // stands for infinity
const int kNoCaster = -1;
const int kMiss = -2;  // TileHits::kMiss

float At(vec4 form, vec2 uv) { return uv.x * form.x + uv.y * form.y + form.z; }

// PencilAngle; beyond all angles along the pencil's axis.
float Angle(float x, float y) {
  float size = abs(x) + abs(y);
  if (size == 0.0) return 8.0;
  float share = y / size;
  return x < 0.0 ? (y < 0.0 ? -2.0 - share : 2.0 - share) : share;
}

// One caster's crossings with a ray about a key: the last ones up to it, the first entry beyond.
struct About {
  bool is_inside;
  float next_entry;
  float edge;  // of the next entry
};

About AboutKey(int caster, vec2 uv, float at, int label) {
  About about = About(false, kFar, 0.0);
  vec4 x = texelFetch(forms, 3 * caster), y = texelFetch(forms, 3 * caster + 1);
  vec4 place = texelFetch(forms, 3 * caster + 2);
  bool starts_inside = place.w == 1.0 || (place.w == 2.0 && label != 0);
  float angle = Angle(At(x, uv), At(y, uv));
  int bin = int(clamp((angle - x.w) * y.w, 0.0, place.z - 1.0));
  float last_entry = -kFar, last_exit = -kFar;
  uvec2 run = place.z > 0.0 ? texelFetch(runs, int(place.x) + bin).xy : uvec2(0u);
  for (uint i = run.x; i < run.y; ++i) {
    vec2 range = texelFetch(angles, int(i)).xy;
    if (angle < range.x || angle >= range.y) continue;
    vec4 form = texelFetch(keys, int(i));
    float key = At(form, uv);
    if (!(key < key_end)) continue;
    if (key <= at) {
      last_entry = max(last_entry, key);
    } else if (key <= about.next_entry) {
      about.next_entry = key;
      about.edge = form.w;
    }
  }
  // Exits matter only to rays that are, or may be, inside.
  bool asks_exits = place.z > 0.0 && (starts_inside || last_entry > -kFar);
  run = asks_exits ? texelFetch(runs, int(place.y) + bin).xy : uvec2(0u);
  for (uint i = run.x; i < run.y; ++i) {
    vec2 range = texelFetch(angles, int(i)).xy;
    if (angle < range.x || angle >= range.y) continue;
    float key = At(texelFetch(keys, int(i)), uv);
    if (key < key_end && key <= at) last_exit = max(last_exit, key);
  }
  bool has_crossed = max(last_entry, last_exit) > -kFar;
  about.is_inside = last_entry > last_exit || (starts_inside && !has_crossed);
  return about;
}

struct Front {
  float key;
  int caster;
  float edge;
};

// True if no sight sees the front; then it moves on to where one does.
bool MoveIntoView(vec2 uv, int label, inout Front front) {
  Front nearest = Front(kFar, kNoCaster, 0.0);
  for (int i = 0; i < visibility_outlines; ++i) {
    About about = AboutKey(cameras + i, uv, front.key, label);
    if (about.is_inside) return false;
    if (about.next_entry < nearest.key) nearest = Front(about.next_entry, cameras + i, about.edge);
  }
  front = nearest;
  return true;
}

// The first key in [from, to] where all cameras and one sight agree; beyond `to` if there is none.
Front Walk(vec2 uv, float from, float to, int label) {
  Front front = Front(from, kNoCaster, 0.0);
  int agreed = 0;
  for (int camera = 0; agreed < cameras && front.key <= to; camera = camera + 1 < cameras ? camera + 1 : 0) {
    About about = AboutKey(camera, uv, front.key, label & 1);
    ++agreed;
    if (!about.is_inside) {
      front = Front(about.next_entry, camera, about.edge);
      agreed = 1;
    }
    if (agreed == cameras && visibility_outlines > 0 && front.key <= to && MoveIntoView(uv, label & 2, front)) agreed = 0;
  }
  return front;
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec3 ray = texelFetch(rays, pixel, 0).xyz;
  vec2 uv = ray.xy;
  int label = has_labels ? int(texelFetch(labels, pixel, 0).x) : 0;
  float from = -kFar, to = key_end;
  bool is_beside = ray.z == 0.0;
  int face = 3 * (cameras + visibility_outlines);
  for (int i = 0; i < faces.x; ++i) from = max(from, At(texelFetch(forms, face++), uv));
  for (int i = 0; i < faces.y; ++i) to = min(to, At(texelFetch(forms, face++), uv));
  for (int i = 0; i < faces.z; ++i) is_beside = is_beside || At(texelFetch(forms, face++), uv) < 0.0;
  if (is_beside) from = kFar, to = -kFar;
  Front front = Walk(uv, from, to, label);
  // A centre in the hull has the whole picture in front of it, and nothing to see.
  bool is_hit = front.key <= to && front.key > -kFar;
  depth = !is_hit ? 0.0 : is_perspective ? -1.0 / front.key : front.key;
  surface = is_hit ? ivec2(front.caster, int(front.edge)) : ivec2(kMiss, 0);
}
)";

}  // namespace elbowroom::recon::gl
