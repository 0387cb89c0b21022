// Damaged and hostile session files: whoever reads one says so in a line and is done.
#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/error.h"
#include "sessions/report/report.h"
#include "sessions/session_reader.h"
#include "sessions/session_writer.h"
#include "tests/adversary/session_damage.h"
#include "tests/sessions/sample_session.h"
#include "tests/sessions/sample_trial.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/soak.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using test_support::TemporaryFolder;

constexpr int kDamaged = 100;         // at the usual scale; 2,000 in a soak
constexpr int kProgramRunsEach = 10;  // every so many of them through the real program as well
constexpr double kLongest_s = 20.0;   // of any one reading: what a user waits for
constexpr long kMostGrowthKb = 500'000;
constexpr std::size_t kLongestLine = 300;

// The sample session, but for a part beyond all stars, which no picture can show.
void WriteDrawableSession(const fs::path& path, core::FrameIndex frames) {
  core::SessionHeader header = SampleHeader();
  header.layout.parts[2].world_from_part.translation_mm.z() = 5e2;
  sessions::SessionWriter writer(path, header);
  for (core::FrameIndex i = 0; i < frames; ++i) writer.Append(SampleFrame(header, i, 1));
  for (const core::SessionEvent& event : SampleEvents()) writer.Append(event);
  writer.Finish(SampleOutcome(0, frames - 1));
}

// Sessions of every make: with all there can be, of many frames, of an older schema, one cut off.
std::vector<fs::path> MakeSessions(const TemporaryFolder& folder) {
  WriteDrawableSession(folder / "sample.db", 12);
  TrialPlan plan = UsualTrial();
  plan.duration_s = 20.0;
  plan.touches.resize(4);
  WriteTrial(folder / "trial.db", plan);
  plan.is_finished = false;
  WriteTrial(folder / "cut_off.db", plan);
  const fs::path stored = test_support::SourceFolder() / "tests/sessions/stored";
  fs::copy_file(stored / "session_schema_3.db", folder / "older.db");
  return {folder / "sample.db", folder / "trial.db", folder / "cut_off.db", folder / "older.db"};
}

long PeakKb(int whose) {
  rusage usage{};
  getrusage(whose, &usage);
  return usage.ru_maxrss;
}

void ReadEverything(const fs::path& path, const fs::path& report) {
  const sessions::SessionReader reader(path);
  for (const sessions::FrameSummary& frame : reader.frames()) (void)reader.ReadFrame(frame.frame);
  (void)reader.heat_maps();
  sessions::WriteReport(reader, {}, report);
}

void ExpectOneLine(std::string line, const std::string& damage) {
  if (line.ends_with('\n')) line.pop_back();
  EXPECT_EQ(line.find_first_of("\n\r"), std::string::npos) << damage << ":\n" << line;
  EXPECT_LE(line.size(), kLongestLine) << damage << ":\n" << line;
  EXPECT_FALSE(line.empty()) << damage;
  EXPECT_EQ(line.find("internal error"), std::string::npos) << damage << ":\n" << line;
}

// Nothing: it was read, and a report written.
std::optional<std::string> ReadHere(const fs::path& path, const TemporaryFolder& folder,
                                    const std::string& damage) {
  const auto begin = std::chrono::steady_clock::now();
  std::optional<std::string> refused;
  try {
    ReadEverything(path, folder / "report");
  } catch (const core::Error& error) {
    refused = error.what();
    ExpectOneLine(*refused, damage);
    EXPECT_NE(refused->find(path.filename().string()), std::string::npos) << damage << ":\n" << *refused;
  } catch (const std::exception& other) {
    refused = other.what();
    ADD_FAILURE() << damage << ": not an error for a user: " << other.what();
  }
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(took.count(), kLongest_s) << damage;
  if (!refused) {
    EXPECT_EQ(IntegrityOf(path), "ok") << damage << ": reported without a word";
  }
  return refused;
}

using Command = std::vector<std::string>;

// The ways in which the program reads a session.
std::vector<Command> CommandsThatRead(const fs::path& session, const TemporaryFolder& folder) {
  return {{"report", session.string(), "--out", (folder / "out").string()},
          {"sweep", session.string(), "--spacing", "PMT to A=140:160:20", "--out", (folder / "out").string()},
          {"sweep", session.string(), "--spacing", "PMT to payload A=140:160:20", "--json", "--out",
           (folder / "out").string()}};
}

void ReadByProgram(const fs::path& path, std::span<const Command> commands, const std::string& damage,
                   bool is_sound) {
  for (const Command& command : commands) {
    test_support::ProgramRun run;
    try {
      run = test_support::RunProgram(test_support::ProgramFile(), command,
                                     {.environment = {{"LIBGL_ALWAYS_SOFTWARE", "1"}},
                                      .timeout_s = 3 * kLongest_s * test_support::kSlowdown});
    } catch (const std::exception& hang) {
      ADD_FAILURE() << damage << ": " << command[0] << ": " << hang.what();
      continue;
    }
    EXPECT_TRUE(run.exit_status == 0 || run.exit_status == 1)
        << damage << ": " << command[0] << " ended with " << run.exit_status << "\n"
        << run.err;
    if (run.exit_status == 1) ExpectOneLine(run.err, damage);
    if (command[0] == "report" && is_sound) {
      EXPECT_EQ(run.exit_status, 0) << damage << "\n" << run.err;
    }
    if (run.exit_status == 0) {
      EXPECT_EQ(IntegrityOf(path), "ok") << damage << ": done without a word";
    }
  }
}

TEST(DamagedSession, IsRefusedInOneLineOrReadSoundly) {
  const TemporaryFolder folder;
  const std::vector<fs::path> sound = MakeSessions(folder);
  for (const fs::path& path : sound) ASSERT_EQ(ReadHere(path, folder, path), std::nullopt);
  ReadByProgram(sound[0], CommandsThatRead(sound[0], folder), "undamaged", true);
  const long here_kb = PeakKb(RUSAGE_SELF), children_kb = PeakKb(RUSAGE_CHILDREN);
  const int count = kDamaged * test_support::SoakScale();
  int refused = 0;
  for (int i = 0; i < count && !HasFatalFailure(); ++i) {
    std::mt19937 random(static_cast<std::uint32_t>(i));
    const fs::path damaged = folder / "damaged.db";
    for (const char* suffix : {"", "-wal", "-shm", "-journal"}) fs::remove(damaged.string() + suffix);
    fs::copy_file(sound[static_cast<std::size_t>(i) % sound.size()], damaged);
    const std::string damage = fmt::format(
        "seed {} of {}: {}", i, sound[static_cast<std::size_t>(i) % sound.size()].filename().string(),
        Spoil(damaged, random));
    const auto said = ReadHere(damaged, folder, damage);
    refused += said.has_value() ? 1 : 0;
    if (i % kProgramRunsEach == 0) ReadByProgram(damaged, CommandsThatRead(damaged, folder), damage, false);
  }
  EXPECT_GT(refused, count / 2) << "most damage is damage";
  EXPECT_LT(PeakKb(RUSAGE_SELF) - here_kb, kMostGrowthKb);
  EXPECT_LT(PeakKb(RUSAGE_CHILDREN) - children_kb, kMostGrowthKb);
  RecordProperty("refused", refused);
}

// Each changes what is shown, so each is refused; through the program too, by one command in turn (by all in
// a soak).
TEST(DamagedSession, KnownReproducersAreRefusedInOneLine) {
  const TemporaryFolder folder;
  WriteDrawableSession(folder / "sample.db", 12);
  ReadByProgram(folder / "sample.db", CommandsThatRead(folder / "sample.db", folder), "undamaged", true);
  const long here_kb = PeakKb(RUSAGE_SELF), children_kb = PeakKb(RUSAGE_CHILDREN);
  const fs::path damaged = folder / "damaged.db";
  const std::vector<Command> commands = CommandsThatRead(damaged, folder);
  std::size_t turn = 0;
  for (const Reproducer& reproducer : KnownReproducers()) {
    fs::copy_file(folder / "sample.db", damaged, fs::copy_options::overwrite_existing);
    SpoilBySql(damaged, reproducer.sql);
    EXPECT_TRUE(ReadHere(damaged, folder, reproducer.what).has_value()) << reproducer.what;
    const std::span<const Command> in_turn = std::span(commands).subspan(turn++ % commands.size(), 1);
    ReadByProgram(damaged, test_support::SoakScale() == 1 ? in_turn : std::span(commands), reproducer.what,
                  false);
  }
  EXPECT_LT(PeakKb(RUSAGE_SELF) - here_kb, kMostGrowthKb);
  EXPECT_LT(PeakKb(RUSAGE_CHILDREN) - children_kb, kMostGrowthKb);
}

TEST(DamagedSession, APartThatNoPictureCanShowEndsInOneLine) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "far.db", 12);
  const test_support::ProgramRun run =
      test_support::RunProgram(test_support::ProgramFile(),
                               {"report", (folder / "far.db").string(), "--out", (folder / "out").string()});
  EXPECT_EQ(run.exit_status, 1);
  ExpectOneLine(run.err, "a part at 5e300 mm");
  EXPECT_NE(run.err.find("part 'payload B': it is nowhere near a trial"), std::string::npos) << run.err;
}

// What a user of the sqlite3 shell adds is no damage.
TEST(DamagedSession, TablesViewsAndIndicesOfOnesOwnMayBeThere) {
  const TemporaryFolder folder;
  const fs::path stored = test_support::SourceFolder() / "tests/sessions/stored";
  WriteSampleSession(folder / "newest.db", 6);
  for (const fs::path& session :
       {folder / "newest.db", stored / "session_schema_1.db", stored / "session_schema_4.db"}) {
    const fs::path path = folder / "mine.db";
    fs::copy_file(session, path, fs::copy_options::overwrite_existing);
    SQLite::Database(path.string(), SQLite::OPEN_READWRITE)
        .exec(
            "CREATE TABLE \"my \"\"notes\" (frame_index INTEGER REFERENCES frame, text); "
            "INSERT INTO \"my \"\"notes\" VALUES (999, 'no such frame'); "
            "CREATE INDEX mine ON contact (deepest_depth_mm); "
            "CREATE VIEW my_contacts AS SELECT * FROM v_contact");
    EXPECT_EQ(ReadHere(path, folder, session), std::nullopt);
  }
}

}  // namespace
}  // namespace elbowroom::tests
