// The things of a layout that respond to the hull: parts that give way, and streams of particles.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace elbowroom::core {

// A side of a part's bounds, in the part's frame.
enum class BoundsSide { kXMin, kXMax, kYMin, kYMax, kZMin, kZMax };

[[nodiscard]] std::optional<BoundsSide> ParseBoundsSide(std::string_view text);  // "x_min", ...
[[nodiscard]] std::string_view ToString(BoundsSide side);

// A panel, blanket or curtain (`gives_way = "cloth"`): it hangs, stretches, bends, and is pushed aside. V_rec
// is the axis of the part's recovery: of a slider in both senses, of a direction in one. Without an axis it
// is the panel's mean normal, in both senses.
struct ClothRule {
  std::vector<BoundsSide> pins;               // vertices on these sides stay with the part; at least one side
  double stretch_stiffness_n_per_m = 2000.0;  // tension per width and strain; [1, 1e7]
  double bending_stiffness_n_per_m = 1.0;     // of springs across the edges; [0.001, 1e5]
  double mass_per_area_kg_per_m2 = 0.4;       // [0.001, 1000]
  double damping_per_s = 1.0;                 // speed falls as exp(-damping * time); [0, 100]
  double friction = 0.3;                      // share of the speed across V_rec lost a frame in touch; [0, 1]

  [[nodiscard]] bool operator==(const ClothRule&) const = default;
};

// A rigid part (`gives_way = "pushed"`) that moves out of the hull along the way of its recovery, and stays
// where it was pushed to.
struct PushRule {
  double max_speed_mm_per_s = 500.0;  // of its fastest point; [0.001, 1e4]

  [[nodiscard]] bool operator==(const PushRule&) const = default;
};

using GivesWay = std::variant<std::monostate, ClothRule, PushRule>;

[[nodiscard]] std::string_view ToString(const GivesWay& gives_way);  // "none", "cloth", "pushed"

// The paper's faucet: particles that leave a place, fall, and run off the hull and the parts.
struct Stream {
  std::string name;                                       // unique in its layout
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  // in world
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();  // in world; its length is at least 1e-9
  double rate_per_s = 200.0;                              // [0.001, 10000]
  double speed_mm_per_s = 500.0;                          // [0, 5000]
  double radius_mm = 3.0;                                 // [0.1, 50]

  [[nodiscard]] bool operator==(const Stream&) const = default;
};

// Both throw: Error{kRange} whose message begins with `who` (a stream's name) and names the key and what it
// must be.
void ValidateGivesWay(const GivesWay& gives_way, const std::string& who);
void ValidateStream(const Stream& stream);

}  // namespace elbowroom::core
