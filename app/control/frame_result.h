// Everything that one frame yielded, as a value that every room may keep.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "app/control/part_reactions.h"
#include "core/contact.h"
#include "core/ids.h"
#include "core/layout.h"
#include "core/session.h"
#include "recon/footage/frame_set.h"
#include "recon/hull/visual_hull.h"
#include "recon/segmentation/segmentation.h"

namespace elbowroom::control {

// What a frame did not need to compute, and why.
struct SkipCount {
  recon::SegmentationStats segmentation;
  recon::HullStats hull;
  int unchanged_parts = 0;             // same hull, same pose: the last answer holds
  std::int64_t triangles_in_all = 0;   // of the parts asked
  std::int64_t triangles_skipped = 0;  // of those: settled with their whole branch of the part's tree
  std::int64_t queries = 0;            // ball queries asked for contacts
  int clearances_by_contact = 0;       // parts asked whose clearance is 0 because they are in contact
  int clearances_by_ball = 0;          // parts asked that one ball showed to be far enough away
  std::int64_t clearance_queries = 0;  // queries of the hull asked for clearances

  // The counts of another frame on top.
  SkipCount& operator+=(const SkipCount& other);
};

struct StageTimes {
  double segmentation_ms = 0.0;
  double hull_ms = 0.0;
  double contacts_ms = 0.0;
  double response_ms = 0.0;
};

using SharedHull = std::shared_ptr<const recon::VisualHull>;

struct FrameResult {
  core::FrameIndex frame = 0;
  double time_s = 0.0;  // of capture
  // What the cameras took, with the pictures that hull and silhouettes come from; null where only the
  // silhouettes were kept, as in a session.
  std::shared_ptr<const recon::FrameSet> camera_frames;
  core::SharedMasks masks;  // one a camera
  SharedHull hull;
  std::shared_ptr<const core::Layout> layout;
  std::vector<double> spacing_mm;  // in the layout's order
  // In the layout's order: where the frames before have pushed parts, from where layout and spacings have
  // them, or nothing if none was pushed; and so where they are.
  std::vector<core::RigidTransform> rest_from_parts;
  std::vector<core::RigidTransform> world_from_parts;
  std::vector<core::PartContact> contacts;  // in the layout's order
  SharedReactions response;                 // to this frame; null: nothing gives way or flows
  SkipCount skipped;
  StageTimes times;
};

using SharedFrameResult = std::shared_ptr<const FrameResult>;

}  // namespace elbowroom::control
