// The keys of a trial file.
#pragma once

#include <array>
#include <string_view>

namespace elbowroom::control {

inline constexpr std::array<std::string_view, 15> kTrialKeys{"rig",
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
                                                             "step",
                                                             "survey"};

}  // namespace elbowroom::control
