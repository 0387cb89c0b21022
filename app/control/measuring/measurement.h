// Lengths and angles that the experimenter picks, which follow what they are picked on.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>

#include "app/control/frame_result.h"
#include "app/control/measuring/dimension.h"
#include "core/ids.h"

namespace elbowroom::control {

// A place on a part's surface: it moves as the part does.
struct SurfacePlace {
  core::PartIndex part = 0;
  Eigen::Vector3d point_in_part = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_in_part = Eigen::Vector3d::UnitZ();  // unit, of the face there
};

enum class MeasurementKind {
  kPoints,    // the distance of two places
  kFaces,     // of two faces: their distance if they are parallel, else their angle
  kPointHull  // of a place to what is real: an interval that holds it
};

struct Measurement {
  MeasurementKind kind = MeasurementKind::kPoints;
  SurfacePlace a;
  SurfacePlace b;  // not of kPointHull
};

// Faces at less than this to each other are parallel.
inline constexpr double kParallelDeg = 0.1;

// Where its parts are in this frame. Faces: the line from a along its normal to b's plane, "45.0 mm,
// parallel"; of others from a to b, with the angle between the planes, "30.0°, 12.3 mm between the places".
// Nothing: a part that the frame hasn't, or kPointHull, which takes a search.
[[nodiscard]] std::optional<Dimension> MeasureNow(const Measurement& measurement, const FrameResult& result);

// The distance from the place to the frame's hull, between bounds that are certain for this hull and at most
// a millimetre apart (review/clearance.h): "12.3 – 13.1 mm", 0 within it. Nothing: no hull, or no such part.
// Takes milliseconds. Thread: any.
[[nodiscard]] std::optional<Dimension> MeasureToHull(const SurfacePlace& place, const FrameResult& result);

}  // namespace elbowroom::control
