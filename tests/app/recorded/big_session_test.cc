// A long trial: an hour of four silhouettes at 30 Hz, with a million rows of contact. What its file, its
// report and its queries take. `./dev soak` makes all of it, a test a twentieth.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdio>
#include <thread>

#include "app/control/demo_trial.h"
#include "app/control/trial_runner.h"
#include "core/bit_mask.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/support/documented_queries.h"
#include "tests/support/places.h"
#include "tests/support/resident_memory.h"
#include "tests/support/run_program.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFrameRateHz = 30.0;
constexpr core::FrameIndex kFramesOfScale = 5400;  // 20 times that are an hour
constexpr std::size_t kParts = 10;
constexpr std::size_t kPoints = 3;        // of each contact, of those that the demo's contacts have
constexpr core::FrameIndex kTouch = 500;  // frames from one touch of a part to its next
// The hour's, shared out over its frames.
constexpr double kMostBytesAFrame = 1.5e9 / 108'000.0;
constexpr std::int64_t kMostReportBytes = 500'000'000;

double SecondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

// What the demo recorded, in memory.
struct Recorded {
  core::SessionHeader header;
  std::vector<core::FrameRecord> frames;
  core::PartContact contact;  // one with all there is
};

Recorded RecordDemo(const std::filesystem::path& path) {
  control::TrialOptions options;
  options.session = path;
  control::TrialControls controls;
  (void)control::RunTrial(control::MakeDemoTrial(control::DemoPlay::kOnce), options, controls, {});
  const sessions::SessionReader session(path);
  Recorded recorded{session.header(), {}, {}};
  for (const sessions::FrameSummary& frame : session.frames()) {
    recorded.frames.push_back(session.ReadFrame(frame.frame));
    for (const core::PartContact& contact : recorded.frames.back().contacts)
      if (contact.points.size() >= kPoints && contact.recovery) recorded.contact = contact;
  }
  recorded.contact.points.resize(kPoints);
  return recorded;
}

// Copies of the demo's parts.
core::Layout ManyParts(const core::Layout& layout) {
  core::Layout many = layout;
  while (many.parts.size() < kParts) {
    core::Part part = layout.parts[many.parts.size() % layout.parts.size()];
    part.name += " " + std::to_string(many.parts.size());
    part.world_from_part.translation_mm.x() += 40.0 * static_cast<double>(many.parts.size());
    many.parts.push_back(part);
  }
  return many;
}

// Noise in the lowest bits of the levels, so that no silhouette is the same as another and none packs better
// than a camera's.
core::SharedMasks Varied(const core::SharedMasks& masks, std::uint64_t seed) {
  auto varied = std::make_shared<std::vector<core::SoftMask>>(*masks);
  for (core::SoftMask& mask : *varied) {
    for (std::uint8_t& level : mask.levels) {
      seed = seed * 6364136223846793005ULL + 1442695040888963407ULL;
      level = static_cast<std::uint8_t>(level ^ (seed >> 62U));
    }
  }
  return varied;
}

bool Touches(core::FrameIndex frame, std::size_t part) {
  return frame % kTouch >= 5 && (part > 0 || frame % 5 < 2);
}

core::FrameRecord FrameOf(const Recorded& recorded, core::FrameIndex frame) {
  core::FrameRecord record = recorded.frames[static_cast<std::size_t>(frame) % recorded.frames.size()];
  const auto turn = static_cast<std::size_t>(frame) / recorded.frames.size();
  if (turn > 0) record.masks = Varied(record.masks, static_cast<std::uint64_t>(frame) + 1);
  record.frame = frame;
  record.time_s = static_cast<double>(frame) / kFrameRateHz;
  const std::vector<core::PartContact> judged = record.contacts;
  record.contacts.clear();
  for (std::size_t part = 0; part < kParts; ++part) {
    core::PartContact contact = Touches(frame, part) ? recorded.contact : judged[part % judged.size()];
    if (!Touches(frame, part) && contact.verdict == core::Verdict::kContact) contact = core::PartContact();
    contact.part = part;
    contact.contact_area_mm2 += static_cast<double>(frame % 97);
    record.contacts.push_back(contact);
  }
  return record;
}

core::SessionOutcome OutcomeOf(const Recorded& recorded, core::FrameIndex frames) {
  core::SessionOutcome outcome;
  for (core::FrameIndex first = 5; first + kTouch <= frames; first += kTouch) {
    for (core::PartIndex part = 1; part < kParts; ++part) {
      core::ContactEpisode episode;
      episode.id = std::ssize(outcome.episodes) + 1;
      episode.part = part;
      episode.begin_frame = first;
      episode.peak_frame = first + kTouch / 2 + static_cast<core::FrameIndex>(part);
      episode.end_frame = first + kTouch - 6;
      episode.begin_time_s = static_cast<double>(episode.begin_frame) / kFrameRateHz;
      episode.peak_time_s = static_cast<double>(episode.peak_frame) / kFrameRateHz;
      episode.end_time_s = static_cast<double>(episode.end_frame) / kFrameRateHz;
      episode.frames_in_contact = episode.end_frame - episode.begin_frame + 1;
      episode.peak_depth_mm = 1.0 + static_cast<double>(episode.id % 50);
      episode.peak_position_in_world_mm = recorded.contact.points.front().position_in_world_mm;
      episode.spacing_at_peak_mm = recorded.frames.front().spacing_mm;
      outcome.episodes.push_back(episode);
    }
  }
  return outcome;
}

std::int64_t WriteBigSession(const std::filesystem::path& path, const Recorded& recorded,
                             core::FrameIndex frames) {
  core::SessionHeader header = recorded.header;
  header.layout = ManyParts(header.layout);
  std::int64_t rows = 0;
  sessions::SessionWriter writer(path, header);
  for (core::FrameIndex frame = 0; frame < frames; ++frame) {
    for (std::size_t part = 0; part < kParts; ++part) rows += Touches(frame, part) ? 1 : 0;
    writer.Append(FrameOf(recorded, frame));
  }
  writer.Finish(OutcomeOf(recorded, frames), {});
  return rows;
}

class BigSession : public testing::Test {
 protected:
  void SetUp() override {
    const Recorded recorded = RecordDemo(folder_ / "demo.db");
    const Clock::time_point begin = Clock::now();
    rows_ = WriteBigSession(path_, recorded, frames_);
    std::printf("%ld frames, %ld rows of contact, %.1f MB, written in %.1f s\n", frames_, rows_,
                static_cast<double>(std::filesystem::file_size(path_)) / 1e6, SecondsSince(begin));
  }
  core::FrameIndex frames_ = kFramesOfScale * test_support::SoakScale();
  test_support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "big.db";
  std::int64_t rows_ = 0;
};

TEST_F(BigSession, StaysSmallIsReportedInBoundedMemoryAndAnswersItsQueries) {
  EXPECT_GE(static_cast<double>(rows_), 1e6 / 108'000.0 * static_cast<double>(frames_));
  EXPECT_LE(static_cast<double>(std::filesystem::file_size(path_)),
            kMostBytesAFrame * static_cast<double>(frames_) + 1e6);

  std::atomic<bool> has_ended = false;
  std::int64_t peak_bytes = 0;
  test_support::RunOptions options;
  options.timeout_s = 600.0;
  options.while_running = [&](int process) {
    while (!has_ended) {
      peak_bytes = std::max(peak_bytes, test_support::PeakResidentBytes(process));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (test_support::ResidentBytes(process) == 0) break;
    }
  };
  const Clock::time_point begin = Clock::now();
  const auto run = test_support::RunProgram(
      test_support::ProgramFile(), {"report", path_.string(), "--out", (folder_ / "out").string()}, options);
  has_ended = true;
  ASSERT_EQ(run.exit_status, 0) << run.err;
  std::printf("report: %.1f s, %.0f MB resident at most\n", SecondsSince(begin),
              static_cast<double>(peak_bytes) / 1e6);
  EXPECT_GT(peak_bytes, 0);
  EXPECT_LE(peak_bytes, kMostReportBytes);

  SQLite::Database database(path_.string());
  double longest_s = 0.0;
  for (const std::string& query : test_support::DocumentedQueries()) {
    const Clock::time_point asked = Clock::now();
    SQLite::Statement rows(database, query);
    while (rows.executeStep()) {
    }
    const double took_s = SecondsSince(asked);
    longest_s = std::max(longest_s, took_s);
    std::printf("%7.3f s  %s\n", took_s, query.substr(0, query.find('\n')).c_str());
  }
  std::printf("longest query: %.3f s\n", longest_s);
}

}  // namespace
}  // namespace elbowroom
