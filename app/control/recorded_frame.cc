#include "app/control/recorded_frame.h"

#include <fmt/format.h>

#include <memory>

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

SharedFrameResult RebuildFrame(const sessions::SessionReader& session, core::FrameIndex frame) {
  auto result = std::make_shared<FrameResult>();
  result->record = session.ReadFrame(frame);
  result->hull = std::make_shared<const recon::VisualHull>(
      recon::MakeVisualHull(std::make_shared<const core::Rig>(session.header().rig), *result->record.masks));
  result->layout = std::make_shared<const core::Layout>(session.header().layout);
  result->world_from_parts = core::WithMotions(core::PosesAt(*result->layout, result->record.spacing_mm),
                                               result->record.rest_from_parts);
  RequireInSight(*result, session.path());
  return result;
}

}  // namespace elbowroom::control
