#include "app/cli/rig_frame.h"

#include "recon/recorded_rig.h"
#include "recon/rig_file.h"
#include "recon/segmentation.h"

namespace elbowroom::cli {

void AddRigFrameOptions(CLI::App& command, RigFrameOptions* options) {
  command.add_option("RIG", options->rig_file, "the rig (RIG.yml)")->required();
  command.add_option("--frame", options->frame, "frame number, from 0")->required();
}

RigFrame LoadRigFrame(const RigFrameOptions& options, const CommandContext& context) {
  recon::RecordedRig source(recon::ReadRigFile(options.rig_file), context.stop);
  RigFrame result{std::make_shared<const core::Rig>(source.rig()), {}};
  // The frame first: it is the cheaper one to find missing.
  const recon::FrameSet frames = source.Read(options.frame);
  const std::vector<recon::BackgroundReference> backgrounds =
      source.ReadBackgrounds(context.progress, context.stop);
  for (std::size_t i = 0; i < frames.cameras.size(); ++i) {
    const recon::CameraFrame& camera = frames.cameras[i];
    result.masks.push_back(camera.ready_mask ? *camera.ready_mask
                                             : recon::Segment(camera.image_bgr, backgrounds[i], {}));
  }
  return result;
}

}  // namespace elbowroom::cli
