#include "tests/app/live_demo.h"

#include <opencv2/imgcodecs.hpp>
#include <string>

namespace elbowroom::control {

DemoFootage RenderDemo() {
  DemoFootage footage;
  for (core::FrameIndex i = 0; i < kSets; ++i) footage.sets.push_back(footage.setup.source->Read(kFirst + i));
  footage.backgrounds = footage.setup.source->ReadBackgrounds({}, {});
  return footage;
}

recon::RigFile LiveRigFile(const DemoFootage& footage, const recon::testing::ServedRig& served,
                           const std::filesystem::path& folder) {
  recon::RigFile rig_file{footage.setup.source->rig()};
  for (std::size_t i = 0; i < kCameras; ++i) {
    cv::Mat mean;
    footage.backgrounds[i].mean_bgr.convertTo(mean, CV_8U);
    const std::filesystem::path background = folder / ("background" + std::to_string(i) + ".png");
    cv::imwrite(background.string(), mean);
    rig_file.sources.push_back(served.SourcesOf(i));
    rig_file.sources.back().background = background.string();
  }
  return rig_file;
}

Found FoundIn(const core::FrameRecord& record) {
  Found found;
  for (const core::PartContact& contact : record.contacts)
    found.emplace_back(contact.verdict, contact.contact_point_count, contact.contact_area_mm2);
  return found;
}

}  // namespace elbowroom::control
