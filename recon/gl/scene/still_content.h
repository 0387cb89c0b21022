// What stays in a picture, and where another scene's differs from it. For the .cc files of this folder.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "recon/gl/scene/part_painter.h"
#include "recon/gl/scene/scene.h"

namespace elbowroom::recon::gl {

// A part that is drawn or throws a shadow. Boxes are around it, in shares of the picture's sides from its
// upper left; empty: outside.
struct StillPart {
  std::weak_ptr<const core::TriangleMesh> mesh;
  core::RigidTransform world_from_part;
  Eigen::Vector3f color;
  bool in_contact = false, is_cut_face = false, is_decal = false;
  bool is_opaque = false;  // else only its shadow stays
  std::size_t level = 0;
  Eigen::AlignedBox2f in_picture, in_lamp;
};

// Where two contents with the same surroundings may look different: all that is outside is the same, bit for
// bit.
struct StillChange {
  std::vector<Eigen::AlignedBox2f> in_picture;  // of parts that are drawn in another way
  std::vector<Eigen::AlignedBox2f> in_lamp;     // of parts that throw another shadow
};

// Background, opaque parts, table and lines of a scene, with the parts' shadows.
class StillContent {
 public:
  // The painter must be up to date with the scene.
  StillContent(const Scene& scene, const PartPainter& painter);

  [[nodiscard]] bool operator==(const StillContent& other) const;

  // Nothing: the surroundings, the eye or the lamp is another one, so that all may differ.
  [[nodiscard]] std::optional<StillChange> ChangeTo(const StillContent& other) const;

 private:
  Scene surroundings_;  // without parts and hull
  std::vector<StillPart> parts_;
};

}  // namespace elbowroom::recon::gl
