#include "app/control/recorded_frame.h"

#include <memory>

namespace elbowroom::control {

SharedFrameResult RebuildFrame(const sessions::SessionReader& session, core::FrameIndex frame) {
  const core::FrameRecord record = session.ReadFrame(frame);
  auto result = std::make_shared<FrameResult>();
  result->frame = record.frame;
  result->time_s = record.time_s;
  result->masks = record.silhouettes;
  result->hull = std::make_shared<const recon::VisualHull>(
      recon::MakeVisualHull(std::make_shared<const core::Rig>(session.header().rig), *record.silhouettes));
  result->layout = std::make_shared<const core::Layout>(session.header().layout);
  result->spacing_mm = record.spacing_mm;
  result->rest_from_parts = record.rest_from_parts;
  result->world_from_parts =
      core::WithMotions(core::PosesAt(*result->layout, record.spacing_mm), record.rest_from_parts);
  result->contacts = record.contacts;
  return result;
}

}  // namespace elbowroom::control
