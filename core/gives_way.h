// What of a layout responds to the real: parts that give way, streams of particles.
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

// A panel, blanket or curtain (`gives_way = "cloth"`): it hangs, stretches, bends, is pushed aside. V_rec is
// the axis of the part's recovery, a slider's or a direction; without one, the panel's mean normal, either
// way.
struct ClothRule {
  std::vector<BoundsSide> pins;               // vertices on these sides stay with the part
  double stretch_stiffness_n_per_m = 2000.0;  // tension per width and strain; [1, 1e7]
  double bending_stiffness_n_per_m = 1.0;     // of a spring across two triangles; [0.001, 1e5]
  double mass_per_area_kg_per_m2 = 0.4;       // [0.001, 1000]
  double damping_per_s = 1.0;                 // share of the speed lost a second, for slow ones; [0, 100]
  double friction = 0.3;                      // share of the speed along the hull lost in touch; [0, 1]

  [[nodiscard]] bool operator==(const ClothRule&) const = default;
};

// A rigid part (`gives_way = "pushed"`) that moves out of the hull the way its recovery says, and stays where
// it was pushed.
struct PushRule {
  double max_speed_mm_per_s = 500.0;  // of its fastest point; [0.001, 1e4]

  [[nodiscard]] bool operator==(const PushRule&) const = default;
};

using GivesWay = std::variant<std::monostate, ClothRule, PushRule>;

[[nodiscard]] std::string_view ToString(const GivesWay& gives_way);  // "none", "cloth", "pushed"

// The paper's faucet: particles that leave a place, fall, and run off what is real or virtual.
struct Stream {
  std::string name;                                       // unique in its layout
  Eigen::Vector3d position_mm = Eigen::Vector3d::Zero();  // in world
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();  // in world; any length but 0
  double rate_per_s = 200.0;                              // (0, 10000]
  double speed_mm_per_s = 500.0;                          // [0, 5000]
  double radius_mm = 3.0;                                 // (0, 50]

  [[nodiscard]] bool operator==(const Stream&) const = default;
};

// Throw: Error{kRange} that begins with `who`, naming the key, its value and its range.
void ValidateGivesWay(const GivesWay& gives_way, const std::string& who);
void ValidateStream(const Stream& stream);

}  // namespace elbowroom::core
