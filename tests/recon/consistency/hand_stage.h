// Cameras that see spheres and capsules, with all that their tangents need.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/rig.h"
#include "core/soft_mask.h"
#include "recon/consistency/epipolar_pairs.h"
#include "tests/recon/consistency/capsule_masks.h"

namespace elbowroom::recon::testing {

struct HandStage {
  explicit HandStage(core::Rig its_rig)
      : rig(std::move(its_rig)), planes(MakeUndistortedPlanes(rig)), pairs(rig, planes) {
    for (const auto& plane : planes) cameras.emplace_back(plane);
  }
  [[nodiscard]] std::vector<core::SoftMask> MasksOf(const std::vector<Solid>& solids,
                                                    const MaskErrors& errors = {}) const {
    std::vector<core::SoftMask> masks;
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      MaskErrors own = errors;
      own.seed = errors.seed * 64 + i;
      masks.push_back(cameras[i].MaskOf(solids, own));
    }
    return masks;
  }

  core::Rig rig;
  UndistortedPlanes planes;
  EpipolarPairs pairs;
  std::vector<CapsuleCamera> cameras;
};

}  // namespace elbowroom::recon::testing
