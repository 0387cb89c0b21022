// The light that parts, hull and table share, with its shadows. For the .cc files of this folder: it includes
// OpenGL.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "recon/gl/objects/shader_program.h"
#include "recon/gl/scene/part_painter.h"
#include "recon/gl/scene/scene.h"
#include "recon/gl/scene/shadow_count.h"
#include "recon/gl/scene/shadow_map.h"
#include "recon/gl/scene/shadow_reach.h"
#include "recon/gl/scene/view_matrices.h"

namespace elbowroom::recon::gl {

// kLeftOut: the hull lets all light through.
enum class HullShadow { kThrown, kLeftOut };

// Keeps the shadows of parts and of the hull apart. Each is renewed only when it changed. A hull with the
// colours of camera pictures takes only the shadows of the parts: the pictures already show its own.
class Lighting {
 public:
  Lighting();

  // To be called before the picture's target is bound, as it binds another one. The parts' meshes must be
  // uploaded.
  // Throws: Error{kGraphics} when the driver can't hold a shadow's texture.
  void Update(const Scene& scene, PartPainter& parts);

  // Sets what kLightingSource declares; the program must be in use.
  void Apply(const ShaderProgram& program, const ViewMatrices& matrices,
             HullShadow hull_shadow = HullShadow::kThrown) const;

  [[nodiscard]] const ShadowReach& hull_reach() const { return hull_reach_; }

  [[nodiscard]] const ShadowCount& count() const { return count_; }

 private:
  struct Caster {
    std::weak_ptr<const core::TriangleMesh> mesh;
    core::RigidTransform world_from_part;
    std::size_t level = 0;
  };
  void UpdatePartShadow(const Scene& scene, PartPainter& parts);
  void UpdateHullShadow(const Scene& scene);
  [[nodiscard]] bool CastersAre(const std::vector<Caster>& now) const;

  SceneLamp lamp_;  // that the maps were made with
  bool has_part_shadow_ = false;
  std::vector<Caster> casters_;
  std::weak_ptr<const HullView> hull_from_lamp_;
  bool has_hull_shadow_ = false;
  Eigen::AlignedBox2f part_bounds_;  // of what throws the shadow, in shares of its map
  Eigen::AlignedBox2f hull_bounds_;
  ShadowReach hull_reach_;
  ShadowMap part_shadow_;
  ShadowMap hull_shadow_;
  ShadowCount count_;
};

// Fragment shader source; all in camera axes.
//   float PartLight(vec3 x, vec3 normal), float HullLight(vec3 x, vec3 normal, float slack_mm): share of the
//     lamp's light that parts, and the hull, let through to x on a surface with that normal; a caster nearer
//     to it than the slack doesn't count.
//   vec3 Lit(vec3 color, vec3 x, vec3 normal, float gloss, float light): Blinn-Phong on both sides of a
//     surface, lit by the sky, by the lamp with that share of its light, and a little by the viewer.
extern const char* const kLightingSource;

}  // namespace elbowroom::recon::gl
