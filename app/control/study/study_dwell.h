// Where the parts were touched in all sessions of a study together.
#pragma once

#include <string>
#include <vector>

#include "core/heat_map.h"
#include "core/triangle_mesh.h"
#include "sessions/session_reader.h"

namespace elbowroom::control {

struct PartDwell {
  std::string part;
  core::SharedMesh mesh;
  core::HeatMap map;  // dwell_s: the sum of the sessions'; peak_depth_mm: the largest
  std::size_t sessions = 0;
};

// Sums sessions' heat maps part by part, in the order in which they come. Thread: one.
class DwellSum {
 public:
  // A part whose mesh, or whose patches, aren't those of the first session that touched it isn't added.
  // Throws: as sessions::SessionReader.
  void Add(const sessions::SessionReader& session);

  [[nodiscard]] const std::vector<PartDwell>& parts() const { return parts_; }  // by name
  [[nodiscard]] std::size_t left_out() const { return left_out_; }              // maps of other meshes

 private:
  std::vector<PartDwell> parts_;
  std::size_t left_out_ = 0;
};

}  // namespace elbowroom::control
