#include "sessions/session_writer.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <functional>
#include <thread>

#include "core/error.h"
#include "sessions/session_reader.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/processor_time.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using core::Error;
using core::ErrorKind;
using sessions::SessionReader;
using sessions::SessionWriter;
using test_support::TemporaryFolder;

constexpr std::uint32_t kWriterSeed = 5;

std::size_t FilesIn(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(SessionWriter, NeverOverwrites) {
  const TemporaryFolder folder;
  std::ofstream(folder / "s.db") << "precious";
  ExpectError([&] { SessionWriter(folder / "s.db", SampleHeader()); }, ErrorKind::kFile, "exists already");
  std::string content;
  std::getline(std::ifstream(folder / "s.db"), content);
  EXPECT_EQ(content, "precious");
  EXPECT_EQ(FilesIn(folder.path()), 1U);
}

TEST(SessionWriter, RefusesAPathWithAnotherSessionsJournalBesideIt) {
  const TemporaryFolder folder;
  std::ofstream(folder / "s.db-wal") << "frames of another session";
  ExpectError([&] { SessionWriter(folder / "s.db", SampleHeader()); }, ErrorKind::kFile, "s.db-wal");
  EXPECT_EQ(FilesIn(folder.path()), 1U);
}

TEST(SessionWriter, NamesAPathThatCantBeCreated) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "a file where a folder belongs";
  ExpectError([&] { SessionWriter(folder / "file" / "s.db", SampleHeader()); }, ErrorKind::kFile,
              "file/s.db");
  ExpectError([&] { SessionWriter(folder / "missing" / "s.db", SampleHeader()); }, ErrorKind::kFile,
              "missing/s.db");
  EXPECT_EQ(FilesIn(folder.path()), 1U);
}

TEST(SessionWriter, LeavesNoFileForAHeaderThatIsNotValid) {
  const TemporaryFolder folder;
  core::SessionHeader no_camera = SampleHeader();
  no_camera.rig.cameras.clear();
  ExpectError([&] { SessionWriter(folder / "s.db", no_camera); }, ErrorKind::kCamera, "no cameras");
  core::SessionHeader stray_spacing = SampleHeader();
  stray_spacing.layout.spacings[0].moving = "nobody";
  ExpectError([&] { SessionWriter(folder / "s.db", stray_spacing); }, ErrorKind::kRange, "nobody");
  core::SessionHeader not_a_number = SampleHeader();
  not_a_number.trial.estimate_mm = std::nan("");
  ExpectError([&] { SessionWriter(folder / "s.db", not_a_number); }, ErrorKind::kDatabase, "estimate_mm");
  EXPECT_EQ(FilesIn(folder.path()), 0U);
}

TEST(SessionWriter, RejectsRecordsThatDontFitTheHeader) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  SessionWriter writer(folder / "s.db", header);
  const auto append = [&](auto&& spoil) {
    core::FrameRecord record = SampleFrame(header, 0, kWriterSeed);
    spoil(record);
    writer.Append(record);
  };
  EXPECT_THROW(append([](auto& r) { r.masks = nullptr; }), core::PreconditionError);
  EXPECT_THROW(append([](auto& r) {
                 r.masks = std::make_shared<const std::vector<core::SoftMask>>(
                     2, core::SoftMask{core::BitMask(64, 64), {}});
               }),
               core::PreconditionError);
  EXPECT_THROW(append([](auto& r) {
                 std::vector<core::SoftMask> masks = *r.masks;
                 masks[0].levels.pop_back();
                 r.masks = std::make_shared<const std::vector<core::SoftMask>>(std::move(masks));
               }),
               core::PreconditionError);
  EXPECT_THROW(append([](auto& r) { r.spacing_mm.pop_back(); }), core::PreconditionError);
  EXPECT_THROW(append([](auto& r) { r.contacts.pop_back(); }), core::PreconditionError);
  EXPECT_THROW(append([](auto& r) { std::swap(r.contacts[0], r.contacts[1]); }), core::PreconditionError);
  EXPECT_THROW(writer.Append(core::SessionEvent{0, 0.0, core::SpacingChanged{"none such", 1.0, 2.0}}),
               core::PreconditionError);
  writer.Finish({});
  EXPECT_THROW(writer.Append(SampleFrame(header, 0, kWriterSeed)), core::PreconditionError);
  EXPECT_THROW(writer.Finish({}), core::PreconditionError);
}

TEST(SessionWriter, FinishLeavesOneFileAndAComplaintFreeDatabase) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 10);
  EXPECT_EQ(FilesIn(folder.path()), 1U);
  SQLite::Database database((folder / "s.db").string());
  EXPECT_EQ(database.execAndGet("PRAGMA integrity_check").getString(), "ok");
  EXPECT_EQ(database.execAndGet("PRAGMA journal_mode").getString(), "delete");
  EXPECT_FALSE(SQLite::Statement(database, "PRAGMA foreign_key_check").executeStep());
}

TEST(SessionWriter, DestroyedWithoutFinishLeavesAReadableRecording) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  {
    SessionWriter writer(folder / "s.db", header);
    for (core::FrameIndex i = 0; i < 100; ++i) writer.Append(SampleFrame(header, i, kWriterSeed));
  }
  EXPECT_EQ(FilesIn(folder.path()), 1U);
  const SessionReader reader(folder / "s.db");
  EXPECT_EQ(reader.status(), sessions::SessionStatus::kCutOff);
  EXPECT_FALSE(reader.ended_at_utc().has_value());
  EXPECT_EQ(reader.frame_count(), 100);
}

TEST(SessionWriter, AbandonLeavesNothing) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  SessionWriter writer(folder / "s.db", header);
  writer.Append(core::SessionEvent{0, 0.0, core::Note{"no camera answers"}});
  writer.Abandon();
  EXPECT_EQ(FilesIn(folder.path()), 0U);
  EXPECT_THROW(writer.Append(SampleFrame(header, 1, kWriterSeed)), core::PreconditionError);
}

TEST(SessionWriter, AbandonNeverTakesAFrame) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  SessionWriter writer(folder / "s.db", header);
  writer.Append(SampleFrame(header, 0, kWriterSeed));
  EXPECT_THROW(writer.Abandon(), core::PreconditionError);
  EXPECT_EQ(SessionReader(folder / "s.db").frame_count(), 1);
}

// A reader's clock, not a wait: nothing but the first frame is appended, so nothing else can push it out.
TEST(SessionWriter, TheFirstFrameWaitsForNoOther) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  SessionWriter writer(folder / "s.db", header);
  writer.Append(SampleFrame(header, 0, kWriterSeed));
  while (writer.frames_committed() == 0) std::this_thread::yield();
  EXPECT_EQ(SessionReader(folder / "s.db").frame_count(), 1);
}

TEST(SessionWriter, NamesThatAreSqlitesOwnAreFilesLikeOthers) {
  const TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  for (const char* name : {":memory:", "file:s.db?mode=memory", "file::memory:", "file:s.db?vfs=none"}) {
    WriteSampleSession(name, 3);
    EXPECT_TRUE(fs::is_regular_file(folder / name)) << name;
    EXPECT_EQ(SessionReader(name).frame_count(), 3) << name;
  }
  fs::current_path(before);
}

TEST(SessionWriter, AReaderFollowsARecordingUnderWayAndSeesItsEnd) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  SessionWriter writer(folder / "s.db", header);
  const SessionReader reader(folder / "s.db");
  EXPECT_EQ(reader.frame_count(), 0);
  core::FrameIndex appended = 0;
  while (writer.frames_committed() < 5) writer.Append(SampleFrame(header, appended++, kWriterSeed));
  EXPECT_GE(reader.frame_count(), 5);
  ExpectEqual(reader.ReadFrame(4), SampleFrame(header, 4, kWriterSeed));
  writer.Finish({SampleEpisodes(0, appended - 1), {}, {}});
  EXPECT_EQ(reader.status(), sessions::SessionStatus::kComplete);
  EXPECT_EQ(reader.frame_count(), appended);
  EXPECT_EQ(reader.episodes().size(), 2U);
}

TEST(SessionWriter, AFrameThatCameTwiceFailsTheNextCallAndTheSessionStaysReadable) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  {
    SessionWriter writer(folder / "s.db", header);
    writer.Append(SampleFrame(header, 7, kWriterSeed));
    writer.Append(SampleFrame(header, 7, kWriterSeed));
    ExpectError([&] { writer.Finish({}); }, ErrorKind::kDatabase, "frame.frame_index");
  }
  EXPECT_EQ(SessionReader(folder / "s.db").status(), sessions::SessionStatus::kCutOff);
}

TEST(SessionWriter, WhileAnotherProgramHoldsTheFileFramesGoIntoASpillAndComeBack) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  sessions::SessionWriterOptions options;
  options.spill_after_s = 0.0;
  std::vector<sessions::RecordingState> states;
  options.on_news = [&](const sessions::RecordingNews& news) { states.push_back(news.state); };
  core::FrameIndex frame = 0;
  SessionWriter writer(folder / "s.db", header, options);
  {
    SQLite::Database other((folder / "s.db").string(), SQLite::OPEN_READWRITE);
    other.exec("BEGIN IMMEDIATE");
    while (writer.frames_committed() < 10) writer.Append(SampleFrame(header, frame++, kWriterSeed));
    EXPECT_EQ(writer.state(), sessions::RecordingState::kInSpill);
    EXPECT_TRUE(fs::exists(folder / "s.db.spill"));
  }
  while (writer.state() != sessions::RecordingState::kInFile)
    writer.Append(SampleFrame(header, frame++, kWriterSeed));
  writer.Finish(SampleOutcome(0, frame - 1));
  using State = sessions::RecordingState;
  EXPECT_EQ(states, (std::vector{State::kInMemory, State::kInSpill, State::kInFile}));
  EXPECT_EQ(FilesIn(folder.path()), 1U);
  const SessionReader reader(folder / "s.db");
  EXPECT_EQ(reader.frame_count(), frame);
  for (core::FrameIndex i = 0; i < frame; ++i)
    ExpectEqual(reader.ReadFrame(i), SampleFrame(header, i, kWriterSeed));
}

TEST(SessionWriter, ASessionThatStaysLockedIsWholeInItsSpillAndJoinsWhenOpened) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  sessions::SessionWriterOptions options;
  options.spill_after_s = 0.0;
  {
    SessionWriter writer(folder / "s.db", header, options);
    writer.Append(SampleFrame(header, 0, kWriterSeed));
    while (writer.frames_committed() == 0) std::this_thread::yield();
    SQLite::Database other((folder / "s.db").string(), SQLite::OPEN_READWRITE);
    other.exec("BEGIN IMMEDIATE");
    for (core::FrameIndex i = 1; i < 30; ++i) writer.Append(SampleFrame(header, i, kWriterSeed));
    for (const core::SessionEvent& event : SampleEvents()) writer.Append(event);
    writer.Finish(SampleOutcome(0, 29));
    EXPECT_EQ(writer.state(), sessions::RecordingState::kInSpill);
    EXPECT_EQ(writer.frames_committed(), 30);
    // Nothing is in use any more but by who holds the lock: a copy in which both are one.
    const SessionReader reader(folder / "s.db");
    EXPECT_LE(reader.frame_count(), 30);
  }
  const SessionReader reader(folder / "s.db");
  EXPECT_EQ(reader.frame_count(), 30);
  EXPECT_EQ(reader.status(), sessions::SessionStatus::kComplete);
  EXPECT_EQ(reader.events().size(), SampleEvents().size());
  EXPECT_EQ(reader.episodes().size(), 2U);
  ExpectEqual(reader.ReadFrame(29), SampleFrame(header, 29, kWriterSeed));
  EXPECT_EQ(FilesIn(folder.path()), 1U);
}

void ExpectFortyFrames(const fs::path& session, const core::SessionHeader& header) {
  const SessionReader reader(session);
  EXPECT_EQ(reader.status(), sessions::SessionStatus::kComplete);
  ASSERT_EQ(reader.frame_count(), 40);
  for (core::FrameIndex i = 0; i < 40; ++i)
    ExpectEqual(reader.ReadFrame(i), SampleFrame(header, i, kWriterSeed));
}

// What `remove` takes from beside or below a session while it is recorded.
void RecordWhile(const TemporaryFolder& folder, const std::function<void(const fs::path&)>& remove,
                 const char* expected_name) {
  const core::SessionHeader header = SampleHeader();
  const fs::path path = folder / "trials" / "s.db";
  fs::create_directories(path.parent_path());
  std::vector<std::string> lines;
  sessions::SessionWriterOptions options;
  options.on_news = [&](const sessions::RecordingNews& news) { lines.push_back(news.line); };
  SessionWriter writer(path, header, options);
  for (core::FrameIndex i = 0; i < 20; ++i) writer.Append(SampleFrame(header, i, kWriterSeed));
  while (writer.frames_committed() < 20) std::this_thread::yield();
  remove(path);
  for (core::FrameIndex i = 20; i < 30; ++i) writer.Append(SampleFrame(header, i, kWriterSeed));
  while (writer.frames_committed() < 30) std::this_thread::yield();
  for (core::FrameIndex i = 30; i < 40; ++i) writer.Append(SampleFrame(header, i, kWriterSeed));
  writer.Finish(SampleOutcome(0, 39));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines.front().find("removed or replaced"), std::string::npos) << lines.front();
  EXPECT_EQ(writer.path().filename(), expected_name);
  ExpectFortyFrames(writer.path(), header);
}

TEST(SessionWriter, MakesASessionAgainWhoseFileWasRemoved) {
  RecordWhile(
      TemporaryFolder(), [](const fs::path& path) { fs::remove(path); }, "s.db");
}
TEST(SessionWriter, MakesASessionAgainWhoseLogWasRemoved) {
  RecordWhile(
      TemporaryFolder(), [](const fs::path& path) { fs::remove(path.string() + "-wal"); }, "s.db");
}
TEST(SessionWriter, MakesASessionAgainWhoseLogsIndexWasRemoved) {
  RecordWhile(
      TemporaryFolder(), [](const fs::path& path) { fs::remove(path.string() + "-shm"); }, "s.db");
}
TEST(SessionWriter, MakesASessionAgainWhoseFolderWasRemoved) {
  RecordWhile(
      TemporaryFolder(), [](const fs::path& path) { fs::remove_all(path.parent_path()); }, "s.db");
}
TEST(SessionWriter, GivesASessionAnotherNameWhereItsOwnWasTaken) {
  const auto replace = [](const fs::path& path) {
    fs::remove(path);
    std::ofstream(path) << "precious";
  };
  const TemporaryFolder folder;
  RecordWhile(folder, replace, "s.db.rescued");
  std::string content;
  std::getline(std::ifstream(folder / "trials" / "s.db"), content);
  EXPECT_EQ(content, "precious");
}

TEST(SessionWriter, PutsASessionIntoAnotherFolderWhereTheNameOfItsOwnWasTaken) {
  const auto replace = [](const fs::path& path) {
    fs::remove_all(path.parent_path());
    std::ofstream(path.parent_path()) << "precious";
    std::ofstream(path.parent_path().string() + ".rescued") << "precious, too";
  };
  const TemporaryFolder folder;
  RecordWhile(folder, replace, "s.db");
  EXPECT_TRUE(fs::exists(folder / "trials.rescued2" / "s.db"));
  EXPECT_TRUE(fs::is_regular_file(folder / "trials"));
  EXPECT_TRUE(fs::is_regular_file(folder / "trials.rescued"));
}

// In a process of its own: a limit on the size of its files makes every later write fail, as a full disk
// does.
int RecordUntilTheDiskIsFull(const fs::path& path) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{800'000, 800'000};
  const core::SessionHeader header = SampleHeader();
  sessions::SessionWriterOptions options;
  options.patience_s = options.spill_after_s = 0.1;
  options.most_held_frames = 50;
  try {
    SessionWriter writer(path, header, options);
    if (setrlimit(RLIMIT_FSIZE, &limit) != 0) return 2;
    for (core::FrameIndex i = 0; i < 5000; ++i) writer.Append(SampleFrame(header, i, kWriterSeed));
    writer.Finish({});
  } catch (const Error& error) {
    const bool says_where = std::string(error.what()).find(path.string()) != std::string::npos;
    return error.kind() == ErrorKind::kDatabase && says_where ? 0 : 3;
  }
  return 4;
}

TEST(SessionWriter, AFullDiskStopsTheRecordingWithAnErrorAndKeepsWhatWasCommitted) {
  const TemporaryFolder folder;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) _exit(RecordUntilTheDiskIsFull(folder / "s.db"));
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const SessionReader reader(folder / "s.db");
  EXPECT_GT(reader.frame_count(), 0);
  ExpectEqual(reader.ReadFrame(0), SampleFrame(SampleHeader(), 0, kWriterSeed));
}

// Four cameras of 640 x 480, three parts in contact with 64 points each: the work of a busy trial's frame.
core::SessionHeader BusyHeader() {
  core::SessionHeader header = SampleHeader();
  core::CameraCalibration calibration = header.rig.cameras[0].calibration();
  calibration.image_width_px = 640;
  calibration.image_height_px = 480;
  calibration.camera_matrix << 500.0, 0.0, 319.5, 0.0, 500.0, 239.5, 0.0, 0.0, 1.0;
  header.rig.cameras.assign(4, core::CameraModel(calibration));
  return header;
}

core::FrameRecord BusyFrame(const core::SessionHeader& header, core::FrameIndex frame) {
  core::FrameRecord record = SampleFrame(header, frame, kWriterSeed);
  record.contacts[2] = record.contacts[0];
  record.contacts[2].part = 2;
  for (core::PartContact& contact : record.contacts) contact.points.resize(64, contact.points[0]);
  return record;
}

// Half of a frame's time at 30 Hz, in computation: a busy machine or a sanitizer must not fail this, work
// that grows with the session must.
constexpr double kLargestWorkPerFrameMs = 16.0;

TEST(SessionWriter, KeepsUpWithABusyTrial) {
  const TemporaryFolder folder;
  const core::SessionHeader header = BusyHeader();
  std::vector<core::FrameRecord> records;
  for (core::FrameIndex i = 0; i < 150; ++i) records.push_back(BusyFrame(header, i));
  SessionWriter writer(folder / "s.db", header);
  const double work_before_ms = test_support::ProcessorMs();
  const auto start = std::chrono::steady_clock::now();
  for (core::FrameRecord& record : records) writer.Append(std::move(record));
  writer.Finish({});
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  const auto frames = static_cast<double>(records.size());
  const double work_per_frame_ms = (test_support::ProcessorMs() - work_before_ms) / frames;
  std::printf(
      "writing one frame of 4 x 640 x 480 and 3 contacts: %.2f ms of work, %.2f ms elapsed, %.1f kB\n",
      work_per_frame_ms, took.count() / frames,
      static_cast<double>(fs::file_size(folder / "s.db")) / 1e3 / frames);
  EXPECT_LT(work_per_frame_ms, kLargestWorkPerFrameMs);
}

}  // namespace
}  // namespace elbowroom::tests
