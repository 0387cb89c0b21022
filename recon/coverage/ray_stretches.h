// Stretches of a ray: what of it lies in some region.
#pragma once

#include <limits>
#include <vector>

namespace elbowroom::recon {

// From `begin` to `end` along a ray, in mm; empty where begin >= end.
struct Stretch {
  double begin = 0.0;
  double end = std::numeric_limits<double>::infinity();

  [[nodiscard]] bool is_empty() const { return !(begin < end); }
};

// Stretches of one ray in rising order, none of which touch. Keeps its memory when it is cleared.
class RayStretches {
 public:
  void Clear() { stretches_.clear(); }
  // `stretch` begins where the last one ends, or later.
  void Append(const Stretch& stretch);
  void Keep(const Stretch& stretch);
  void Keep(const RayStretches& others);
  void Remove(const Stretch& stretch);

  [[nodiscard]] bool is_empty() const { return stretches_.empty(); }
  [[nodiscard]] const std::vector<Stretch>& all() const { return stretches_; }
  // The integral of t^2 over what lies within `within`: the volume of a bundle of rays of one steradian.
  [[nodiscard]] double VolumePerSteradian(const Stretch& within = {}) const;

 private:
  std::vector<Stretch> stretches_;
  std::vector<Stretch> next_;
};

}  // namespace elbowroom::recon
