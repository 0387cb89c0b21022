#include "app/control/recorded_frame.h"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "core/file_limits.h"
#include "recon/hull/visual_hull.h"
#include "sessions/database/damage.h"

namespace elbowroom::control {
namespace {

// Throws where a part is too far away: a picture of the whole scene must show all parts.
void RequireInSight(const FrameResult& result, const std::filesystem::path& session) {
  for (core::PartIndex i = 0; i < result.layout->parts.size(); ++i) {
    const core::Part& part = result.layout->parts[i];
    const Eigen::AlignedBox3d bounds = core::BoundsOf(*part.mesh, result.world_from_parts[i]);
    if (bounds.min().cwiseAbs().maxCoeff() <= core::kLongestLengthMm &&
        bounds.max().cwiseAbs().maxCoeff() <= core::kLongestLengthMm)
      continue;
    sessions::FailAsDamaged(
        fmt::format("session '{}', part '{}'", session.string(), sessions::Quotable(part.name)),
        "it is nowhere near a trial");
  }
}

}  // namespace

FrameRebuilder::FrameRebuilder(const core::SessionHeader& header, std::filesystem::path session)
    : session_(std::move(session)),
      rig_(std::make_shared<const core::Rig>(header.rig)),
      layout_(std::make_shared<const core::Layout>(header.layout)),
      poses_(*layout_) {}

SharedFrameResult FrameRebuilder::Rebuild(core::FrameRecord record, const SharedHull& last) {
  // Whoever read the frame has checked that its silhouettes have the sizes of the cameras' pictures, before
  // planes of these sizes are made.
  if (planes_.empty()) planes_ = recon::MakeUndistortedPlanes(*rig_);
  auto result = std::make_shared<FrameResult>();
  result->hull = recon::NextHull(last, rig_, planes_, *record.masks).hull;
  result->layout = layout_;
  result->world_from_parts = core::WithMotions(poses_.At(record.spacing_mm), record.rest_from_parts);
  result->record = std::move(record);
  RequireInSight(*result, session_);
  return result;
}

SharedFrameResult RebuildFrame(const sessions::SessionReader& session, core::FrameIndex frame) {
  return FrameRebuilder(session.header(), session.path()).Rebuild(session.ReadFrame(frame));
}

}  // namespace elbowroom::control
