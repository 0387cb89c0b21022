// What was acknowledged survives the power failing at any moment, and a disk that fails now and then.
#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <functional>
#include <iostream>
#include <string>
#include <thread>

#include "core/error.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/adversary/simulated_disk.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::adversary {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryFolder;

// ./dev soak's scale of 20 makes 1,000.
constexpr int kFailuresAScale = 50;
constexpr std::uint32_t kFrameSeed = 9;

struct Trial {
  core::FrameIndex frames = 0;
  bool is_finished = false;
};

// As a trial does it: frames one after the other; what the writer acknowledges is held against it.
std::vector<DiskOperation> RecordOnSimulatedDisk(const fs::path& path, const Trial& trial) {
  SimulatedDisk disk;
  const core::SessionHeader header = tests::SampleHeader();
  {
    sessions::SessionWriter writer(path, header);
    disk.Acknowledge(0);
    for (core::FrameIndex i = 0; i < trial.frames; ++i) {
      writer.Append(tests::SampleFrame(header, i, kFrameSeed));
      // A trial that waits for the disk now and then, so that there are many commits to lose.
      constexpr core::FrameIndex kWaitAfter = 7;
      while (i % kWaitAfter == 0 && writer.frames_committed() <= i) std::this_thread::yield();
      disk.Acknowledge(writer.frames_committed());
    }
    if (trial.is_finished) {
      writer.Finish(tests::SampleOutcome(0, trial.frames - 1));
      disk.Acknowledge(writer.frames_committed());
      EXPECT_EQ(writer.frames_committed(), trial.frames);
    }
  }
  return disk.operations();
}

void ExpectComplaintFree(const fs::path& path) {
  SQLite::Database database(path.string(), SQLite::OPEN_READWRITE);
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_FALSE(SQLite::Statement(database, "PRAGMA foreign_key_check").executeStep());
}

// The session of this image opens, has every acknowledged frame, and each frame as it was.
void ExpectNothingLost(const DiskImage& image, const fs::path& folder, std::mt19937_64& random) {
  WriteImage(image, folder);
  {
    const sessions::SessionReader reader(folder / "s.db");
    tests::ExpectEqual(reader.header(), tests::SampleHeader());
    const std::vector<sessions::FrameSummary> frames = reader.frames();
    EXPECT_GE(std::ssize(frames), image.acknowledged_frames);
    for (std::size_t i = 0; i < frames.size(); ++i)
      ASSERT_EQ(frames[i].frame, static_cast<int>(i)) << "a hole";
    if (!frames.empty()) {
      const core::FrameIndex frame = frames[random() % frames.size()].frame;
      tests::ExpectEqual(reader.ReadFrame(frame), tests::SampleFrame(reader.header(), frame, kFrameSeed));
    }
    if (reader.status() == sessions::SessionStatus::kComplete) {
      EXPECT_EQ(reader.episodes().size(), 2U);
    }
  }
  ExpectComplaintFree(folder / "s.db");
}

void PlayPowerFailures(const Trial& trial, int failures, std::mt19937_64& random) {
  const TemporaryFolder folder;
  const std::vector<DiskOperation> operations = RecordOnSimulatedDisk(folder / "s.db", trial);
  std::size_t set_up = 0;  // what is before the first acknowledgement made the session
  while (operations[set_up].kind != DiskOperation::Kind::kAcknowledge) ++set_up;
  std::int64_t most = 0;
  for (int i = 0; i < failures; ++i) {
    // Every third in what ends a trial, where the log is folded into the file.
    const std::size_t from =
        i % 3 == 0 ? std::max(set_up, operations.size() - operations.size() / 8) : set_up;
    const std::size_t count = from + 1 + random() % (operations.size() - from);
    const DiskImage image = AfterPowerFailure(operations, count, "s.db", random);
    most = std::max(most, image.acknowledged_frames);
    const fs::path place = folder / std::to_string(i);
    ExpectNothingLost(image, place, random);
    fs::remove_all(place);
    if (testing::Test::HasFailure()) FAIL() << "power failure " << i << " after operation " << count;
  }
  EXPECT_GT(most, 0) << "power failures before the first frame show little";
}

TEST(PowerFailure, LosesNothingThatWasAcknowledged) {
  std::mt19937_64 random(77);
  const int failures = kFailuresAScale * test_support::SoakScale();
  constexpr int kFailuresATrial = 25;
  int done = 0;
  for (; done < failures && !HasFailure(); done += kFailuresATrial) {
    const Trial trial{.frames = 1 + static_cast<core::FrameIndex>(random() % 200),
                      .is_finished = random() % 2 == 0};
    PlayPowerFailures(trial, kFailuresATrial, random);
  }
  std::cout << done << " power failures played\n";
}

// Long enough for several checkpoints.
TEST(PowerFailure, LosesNothingWhileTheLogIsMovedIntoTheFile) {
  std::mt19937_64 random(78);
  PlayPowerFailures({.frames = 1500, .is_finished = true}, 10 * std::min(20, test_support::SoakScale()),
                    random);
}

// The test can fail: a log that isn't synced loses what was acknowledged.
TEST(PowerFailure, IsNoticedWhereNothingIsSynced) {
  const TemporaryFolder folder;
  std::vector<DiskOperation> operations = RecordOnSimulatedDisk(folder / "s.db", {.frames = 40});
  std::size_t created = 0;
  std::erase_if(operations, [&](const DiskOperation& operation) {
    created += operation.kind == DiskOperation::Kind::kAcknowledge ? 1 : 0;
    return created > 0 && operation.kind == DiskOperation::Kind::kSync;
  });
  std::mt19937_64 random(79);
  int lost = 0;
  for (int i = 0; i < 20; ++i) {
    const DiskImage image = AfterPowerFailure(operations, operations.size(), "s.db", random);
    const fs::path place = folder / std::to_string(i);
    WriteImage(image, place);
    try {
      lost += sessions::SessionReader(place / "s.db").frame_count() < image.acknowledged_frames ? 1 : 0;
    } catch (const core::Error&) {
      ++lost;  // not even a session any more
    }
  }
  EXPECT_GT(lost, 0);
}

// --- disks that fail ---

struct Fault {
  const char* name;
  std::function<void(SimulatedDisk&)> begin, end;
};
void PrintTo(const Fault& fault, std::ostream* out) { *out << fault.name; }

class DiskFault : public testing::TestWithParam<Fault> {};

TEST_P(DiskFault, ThatPassesLosesNoFrame) {
  const TemporaryFolder folder;
  const core::SessionHeader header = tests::SampleHeader();
  std::vector<sessions::RecordingState> states;
  {
    SimulatedDisk disk;
    sessions::SessionWriterOptions options;
    options.on_news = [&](const sessions::RecordingNews& news) { states.push_back(news.state); };
    sessions::SessionWriter writer(folder / "s.db", header, options);
    core::FrameIndex frame = 0;
    for (int round = 0; round < 3; ++round) {
      for (int i = 0; i < 20; ++i) writer.Append(tests::SampleFrame(header, frame++, kFrameSeed));
      GetParam().begin(disk);
      // Until the writer has met it.
      while (writer.state() == sessions::RecordingState::kInFile)
        writer.Append(tests::SampleFrame(header, frame++, kFrameSeed));
      GetParam().end(disk);
      while (writer.state() != sessions::RecordingState::kInFile) std::this_thread::yield();
    }
    writer.Finish(tests::SampleOutcome(0, frame - 1));
    EXPECT_EQ(writer.frames_committed(), frame);
    EXPECT_EQ(writer.state(), sessions::RecordingState::kInFile);
    const sessions::SessionReader reader(folder / "s.db");
    EXPECT_EQ(reader.frame_count(), frame);
    EXPECT_EQ(reader.status(), sessions::SessionStatus::kComplete);
  }
  EXPECT_GE(states.size(), 6U) << "trouble and its end, three times";
  ExpectComplaintFree(folder / "s.db");
}

TEST_P(DiskFault, ThatStaysEndsTheRecordingWithWhatWasCommitted) {
  const TemporaryFolder folder;
  const core::SessionHeader header = tests::SampleHeader();
  std::int64_t committed = 0;
  {
    SimulatedDisk disk;
    sessions::SessionWriterOptions options;
    options.patience_s = 0.1;
    options.spill_after_s = 0.1;
    options.most_held_frames = 30;
    sessions::SessionWriter writer(folder / "s.db", header, options);
    const auto record_until_it_ends = [&] {
      core::FrameIndex frame = 0;
      while (writer.frames_committed() < 10) writer.Append(tests::SampleFrame(header, frame++, kFrameSeed));
      GetParam().begin(disk);
      while (true) writer.Append(tests::SampleFrame(header, frame++, kFrameSeed));
    };
    try {
      record_until_it_ends();
    } catch (const core::Error& error) {
      EXPECT_EQ(error.kind(), core::ErrorKind::kDatabase);
      EXPECT_NE(std::string(error.what()).find("s.db"), std::string::npos) << error.what();
    }
    committed = writer.frames_committed();
    EXPECT_THROW(writer.Finish({}), core::Error);
    GetParam().end(disk);
  }
  {
    const sessions::SessionReader reader(folder / "s.db");
    EXPECT_GE(reader.frame_count(), committed);
    EXPECT_EQ(reader.status(), sessions::SessionStatus::kCutOff);
  }
  ExpectComplaintFree(folder / "s.db");
}

const Fault kFaults[] = {
    {"FullDisk", [](SimulatedDisk& disk) { disk.FailWrites(SQLITE_FULL); },
     [](SimulatedDisk& disk) { disk.FailWrites(SQLITE_OK); }},
    {"WriteError", [](SimulatedDisk& disk) { disk.FailWrites(SQLITE_IOERR_WRITE); },
     [](SimulatedDisk& disk) { disk.FailWrites(SQLITE_OK); }},
    {"SyncError", [](SimulatedDisk& disk) { disk.FailSyncs(SQLITE_IOERR_FSYNC); },
     [](SimulatedDisk& disk) { disk.FailSyncs(SQLITE_OK); }},
    {"ReadOnly", [](SimulatedDisk& disk) { disk.FailWrites(SQLITE_READONLY); },
     [](SimulatedDisk& disk) { disk.FailWrites(SQLITE_OK); }},
};
INSTANTIATE_TEST_SUITE_P(Kinds, DiskFault, testing::ValuesIn(kFaults),
                         [](const auto& tested) { return std::string(tested.param.name); });

}  // namespace
}  // namespace elbowroom::adversary
