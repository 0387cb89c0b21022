// Pictures and videos made to take the program down: thousands damaged at random, and bombs. Each is taken or
// refused with one line, within 20 s and 500 MB, by a program that goes on.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/videoio.hpp>
#include <random>
#include <string>
#include <vector>

#include "core/error.h"
#include "recon/footage/image_source.h"
#include "recon/rig_files/rig_file.h"
#include "tests/adversary/picture_bombs.h"
#include "tests/fuzz/mutation.h"
#include "tests/recon/footage/made_footage.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::adversary {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using recon::testing::kHeightPx;
using recon::testing::kWidthPx;

// ./dev soak's scale of 20 makes 4,000.
constexpr int kPicturesAScale = 160, kVideosAScale = 40;
constexpr double kLongestS = 20.0;
constexpr long kMostGrowthKb = 500'000;
constexpr std::size_t kLongestLine = 300;

struct Seed {
  std::string name;
  std::string bytes;
};

// Numbered blocks under noise: codecs have something to keep.
cv::Mat Picture(int number) {
  cv::Mat picture = recon::testing::NumberedPicture(number);
  std::mt19937 random(static_cast<unsigned>(number));
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < 3 * picture.cols; ++x)
      picture.ptr(y)[x] = static_cast<unsigned char>(picture.ptr(y)[x] + random() % 32U);
  return picture;
}

std::vector<Seed> PictureSeeds() {
  const std::vector<std::pair<std::string, std::vector<int>>> kinds{
      {"a.png", {}},
      {"b.jpg", {}},
      {"progressive.jpg", {cv::IMWRITE_JPEG_PROGRESSIVE, 1}},
      {"restarts.jpg", {cv::IMWRITE_JPEG_RST_INTERVAL, 2}},
      {"a.bmp", {}},
      {"lzw.tiff", {}},
      {"plain.tiff", {cv::IMWRITE_TIFF_COMPRESSION, 1}},
      {"deflate.tiff", {cv::IMWRITE_TIFF_COMPRESSION, 8}},
      {"a.ppm", {}}};
  std::vector<Seed> seeds;
  for (const auto& [name, how] : kinds) {
    std::vector<unsigned char> bytes;
    cv::imencode(fs::path(name).extension().string(), Picture(77), bytes, how);
    seeds.push_back({name, {bytes.begin(), bytes.end()}});
  }
  return seeds;
}

std::vector<Seed> VideoSeeds() {
  const test_support::TemporaryFolder folder;
  const std::vector<std::pair<std::string, std::string>> kinds{
      {"mjpeg.avi", "MJPG"}, {"xvid.avi", "XVID"}, {"mpeg4.mp4", "mp4v"}, {"lossless.avi", "FFV1"}};
  std::vector<Seed> seeds;
  for (const auto& [name, codec] : kinds) {
    const std::string path = (folder / name).string();
    cv::VideoWriter writer(path, cv::CAP_FFMPEG,
                           cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]), 30.0,
                           cv::Size(kWidthPx, kHeightPx));
    if (!writer.isOpened()) continue;
    for (int i = 0; i < 12; ++i) writer.write(Picture(i));
    writer.release();
    seeds.push_back({name, test_support::ReadText(path)});
  }
  return seeds;
}

long MaxRssKb(__rusage_who whose) {
  rusage usage{};
  getrusage(whose, &usage);
  return usage.ru_maxrss;
}

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

void ExpectOneLine(const std::string& message) {
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  EXPECT_LE(message.size(), kLongestLine) << message;
}

struct Tally {
  std::atomic<int> taken{0};
  std::atomic<int> refused{0};
  std::atomic<int> crashed{0};
  std::atomic<int> too_slow{0};
};

// All that the program does with a source.
void ReadAll(const fs::path& file, Tally& tally) {
  const auto begin = Clock::now();
  try {
    const auto source = recon::OpenImageSource(file.string(), recon::testing::PlainCamera("cam1"));
    for (core::FrameIndex i = 0; const auto picture = source->Read(i); ++i)
      EXPECT_EQ(picture->image_bgr.size(), cv::Size(kWidthPx, kHeightPx));
    ++tally.taken;
  } catch (const core::Error& error) {
    const std::string message = error.what();
    ExpectOneLine(message);
    EXPECT_TRUE(message.starts_with("camera 'cam1': ")) << message;
    EXPECT_NE(message.find(file.filename().string()), std::string::npos) << message;
    if (message.find("its decoder crashed") != std::string::npos) ++tally.crashed;
    if (message.find("takes more than") != std::string::npos) ++tally.too_slow;
    ++tally.refused;
  }
  EXPECT_LT(SecondsSince(begin), kLongestS) << file;
}

void DamageFrom(const std::vector<Seed>& seeds, int files, std::uint64_t seed) {
  ASSERT_FALSE(seeds.empty());
  const test_support::TemporaryFolder folder;
  for (const Seed& sound : seeds) {
    Tally tally;
    test_support::WriteText(folder / sound.name, sound.bytes);
    ReadAll(folder / sound.name, tally);
    EXPECT_EQ(tally.taken, 1) << sound.name;
  }
  Tally tally;
  const long before_kb = MaxRssKb(RUSAGE_SELF);
  tbb::parallel_for(0, files, [&](int i) {
    std::mt19937_64 random(seed + static_cast<std::uint64_t>(i));
    const Seed& from = seeds[random() % seeds.size()];
    const fs::path file = folder / (std::to_string(i) + '_' + from.name);
    test_support::WriteText(file, fuzz::Mutated(from.bytes, seeds[random() % seeds.size()].bytes, random));
    ReadAll(file, tally);
    if (::testing::Test::HasFailure()) {
      fs::copy_file(file, fs::temp_directory_path() / ("elbowroom_adversary_" + file.filename().string()),
                    fs::copy_options::overwrite_existing);
    }
    fs::remove(file);
  });
  EXPECT_LT(MaxRssKb(RUSAGE_SELF) - before_kb, kMostGrowthKb);
  EXPECT_EQ(tally.taken + tally.refused, files);
  std::cout << files << " files: " << tally.taken << " taken, " << tally.refused << " refused, of which "
            << tally.crashed << " crashed their decoder and " << tally.too_slow << " took too long\n";
}

TEST(DamagedPictures, AreTakenOrRefusedInOneLine) {
  DamageFrom(PictureSeeds(), kPicturesAScale * test_support::SoakScale(), 1);
}

TEST(DamagedVideos, AreTakenOrRefusedInOneLine) {
  DamageFrom(VideoSeeds(), kVideosAScale * test_support::SoakScale(), 2);
}

class Bombs : public ::testing::Test {
 protected:
  // `elbowroom segment` on a rig whose one camera has that as its frames.
  [[nodiscard]] test_support::ProgramRun Segment(const std::string& frames) const {
    recon::RigFile rig =
        recon::testing::PlainRig({{(folder_ / frames).string(), (folder_ / "background.png").string(), ""}});
    recon::WriteRigFile(rig, folder_ / "rig.yml");
    return test_support::RunProgram(
        test_support::ProgramFile(),
        {"segment", (folder_ / "rig.yml").string(), "--frame", "0", "--out", (folder_ / "masks").string()},
        {.environment = {}, .timeout_s = 60.0});
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(Bombs, EndTheProgramInOneLineWithinItsTimeAndMemory) {
  cv::imwrite((folder_ / "background.png").string(), recon::testing::NumberedPicture(0));
  ASSERT_EQ(Segment("background.png").err, "");
  // The largest of all processes so far; the program waits for its decoder, and that for its workers.
  const long before_kb = MaxRssKb(RUSAGE_CHILDREN);
  const std::vector<Bomb> bombs = MakeBombs(kWidthPx, kHeightPx);
  EXPECT_GE(bombs.size(), 20U);
  for (const Bomb& bomb : bombs) {
    SCOPED_TRACE(bomb.name);
    test_support::WriteText(folder_ / bomb.name, bomb.bytes);
    const auto begin = Clock::now();
    const test_support::ProgramRun run = Segment(bomb.name);
    EXPECT_LT(SecondsSince(begin), kLongestS);
    EXPECT_LT(MaxRssKb(RUSAGE_CHILDREN) - before_kb, kMostGrowthKb);
    // A picture whose bomb isn't among its pixels is a picture.
    EXPECT_TRUE(run.exit_status == 1 || run.exit_status == 0) << run.exit_status;
    if (run.exit_status == 0) {
      EXPECT_EQ(run.err, "");
      continue;
    }
    ASSERT_TRUE(run.err.ends_with('\n')) << run.err;
    ExpectOneLine(run.err.substr(0, run.err.size() - 1));
    EXPECT_NE(run.err.find(bomb.name), std::string::npos) << run.err;
  }
}

}  // namespace
}  // namespace elbowroom::adversary
