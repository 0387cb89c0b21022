// The light of a real recording: people at work under office lamps.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "recon/footage/background.h"
#include "recon/footage/image_source.h"
#include "recon/footage/recorded_rig.h"
#include "recon/light/empty_scene.h"
#include "recon/light/light_watch.h"
#include "recon/segmentation/frame_segmenter.h"
#include "tests/support/places.h"

namespace elbowroom::recon {
namespace {

TEST(RealLight, OfARecordingIsSteadyAndItsPeopleAreNoLastingChange) {
  const std::filesystem::path file = test_support::SharedDataFolder() / "four_cameras" / "rig.yml";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "NOT TESTED on real footage: " << file << " is absent";
  // The recording lasts 426 frames. It is watched as 15 pictures a second, and once more as three a second,
  // so that it takes longer than a lasting change needs.
  constexpr core::FrameIndex kFrames = 426;
  constexpr double kGainTolerance = 0.08;  // the lamps are steady; the cameras' exposure may move a little
  RecordedRig rig(ReadRigFile(file));
  const std::vector<BackgroundReference> backgrounds = rig.ReadBackgrounds({}, {});
  const FrameSegmenter segmenter(backgrounds, SegmentationOptions(), rig.rig());
  std::vector<LightWatch> fast, slow;
  for (std::size_t i = 0; i < backgrounds.size(); ++i) {
    fast.emplace_back(rig.rig().cameras[i].name(), backgrounds[i], false);
    slow.emplace_back(rig.rig().cameras[i].name(), backgrounds[i], false);
  }
  for (core::FrameIndex frame = 0; frame < kFrames; ++frame) {
    const FrameSet set = rig.Read(frame);
    const std::vector<core::BitMask> masks = segmenter.Segment(set);
    for (std::size_t i = 0; i < masks.size(); ++i) {
      fast[i].Add(set.cameras[i].image_bgr, masks[i], static_cast<double>(frame) / 15.0);
      slow[i].Add(set.cameras[i].image_bgr, masks[i], static_cast<double>(frame) / 3.0);
    }
  }
  for (std::size_t i = 0; i < fast.size(); ++i) {
    const LightReport report = fast[i].Report();
    EXPECT_NEAR(report.gain, 1.0, kGainTolerance) << i;
    EXPECT_GT(report.agreeing_share, 0.5) << i;
    EXPECT_FALSE(report.pulse && report.pulse->matters) << i;
    EXPECT_TRUE(report.changes.empty()) << i;
    RecordProperty("gain_" + std::to_string(i), std::to_string(report.gain));
    RecordProperty("agreeing_" + std::to_string(i), std::to_string(report.agreeing_share));
    RecordProperty("pulse_" + std::to_string(i),
                   std::to_string(report.pulse ? report.pulse->amplitude_share : 0.0));
    const LightReport longer = slow[i].Report();
    EXPECT_TRUE(longer.changes.empty()) << i << ": " << longer.advice.front();
  }
}

// Sixty pictures: of the empty room, and at the end `with_person` of the person in it.
EmptySceneReport ExamineRoom(const CameraSources& sources, const core::CameraModel& camera, int with_person) {
  constexpr int kPictures = 60;
  constexpr double kFootageRateHz = 25.0;
  const auto empty = OpenImageSource(sources.background, camera),
             person = OpenImageSource(sources.frames, camera);
  std::vector<TimedPicture> pictures;
  BackgroundAccumulator accumulator;
  for (int i = 0; i < kPictures; ++i) {
    ImageSource& source = i < kPictures - with_person ? *empty : *person;
    pictures.push_back({source.Read(i).value().image_bgr, i / kFootageRateHz});
    accumulator.Add(pictures.back().image_bgr);
  }
  constexpr int kMinBlobPx = 200;
  return ExamineEmptyScene(pictures, accumulator.Reference(), kMinBlobPx);
}

TEST(RealLight, AnEmptyRoomIsToldFromOneThatSomebodyEnters) {
  const std::filesystem::path file = test_support::SharedDataFolder() / "four_cameras" / "rig.yml";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "NOT TESTED on real footage: " << file << " is absent";
  const RigFile rig_file = ReadRigFile(file);
  for (std::size_t i = 0; i < rig_file.sources.size(); ++i) {
    const core::CameraModel& camera = rig_file.rig.cameras[i];
    const cv::Size size(camera.width_px(), camera.height_px());
    const std::vector<std::string> faults =
        FaultsOf(ExamineRoom(rig_file.sources[i], camera, 0), camera.name(), size);
    EXPECT_TRUE(faults.empty()) << faults.front();
    for (const int with_person : {1, 20})
      EXPECT_FALSE(ExamineRoom(rig_file.sources[i], camera, with_person).moved_px.empty()) << camera.name();
  }
}

}  // namespace
}  // namespace elbowroom::recon
