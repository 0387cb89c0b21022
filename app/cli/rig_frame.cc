#include "app/cli/rig_frame.h"

#include <tbb/parallel_for.h>

#include "recon/contours/contour_map.h"
#include "recon/contours/undistorted_plane.h"
#include "recon/footage/recorded_rig.h"
#include "recon/hull/visual_hull.h"
#include "recon/rig_files/rig_file.h"
#include "recon/segmentation/frame_segmenter.h"

namespace elbowroom::cli {

void AddRigFrameOptions(CLI::App& command, RigFrameOptions* options) {
  command.add_option("RIG", options->rig_file, "the rig (RIG.yml)")->required();
  command.add_option("--frame", options->frame, "frame number, from 0")->required();
}

RigFrame LoadRigFrame(const RigFrameOptions& options, const CommandContext& context) {
  recon::RigFile rig_file = recon::ReadRigFile(options.rig_file);
  core::RigQuality quality = recon::QualityOf(rig_file);
  recon::RecordedRig source(std::move(rig_file), context.stop);
  RigFrame result{std::make_shared<const core::Rig>(source.rig()), {}, std::move(quality), {}};
  // The frame is read before the backgrounds: a missing frame is found sooner.
  const recon::FrameSet frames = source.Read(options.frame, context.stop);
  result.masks =
      recon::FrameSegmenter(source.ReadBackgrounds(context.progress, context.stop), {}, source.rig())
          .SegmentSoft(frames);
  result.planes = recon::MakeUndistortedPlanes(*result.rig);
  // A plane makes its outline, which `abstain` alone needs, at the first query: it is made here.
  if (recon::ExteriorIsObject(*result.rig)) {
    tbb::parallel_for(std::size_t{0}, result.planes.size(), [&](std::size_t i) {
      (void)result.planes[i]->outline().LabelAt(Eigen::Vector2d::Zero());
    });
  }
  return result;
}

}  // namespace elbowroom::cli
