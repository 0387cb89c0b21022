// The keys of a trial file.
#pragma once

#include <array>
#include <string_view>

namespace elbowroom::control {

inline constexpr std::array<std::string_view, 16> kTrialKeys{"rig",
                                                             "layout",
                                                             "participant",
                                                             "task",
                                                             "estimate_mm",
                                                             "required_clearance_mm",
                                                             "uncertainty_mm",
                                                             "tools",
                                                             "segmentation",
                                                             "viewer",
                                                             "record",
                                                             "condition",
                                                             "order",
                                                             "block",
                                                             "step",
                                                             "survey"};

// Of a trial file that has a `base`: all else is its base's.
inline constexpr std::array<std::string_view, 7> kPlannedTrialKeys{
    "base", "participant", "task", "estimate_mm", "condition", "order", "block"};

}  // namespace elbowroom::control
