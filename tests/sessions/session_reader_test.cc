#include "sessions/session_reader.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>
#include <random>

#include "sessions/packing.h"
#include "sessions/session_writer.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using core::ErrorKind;
using sessions::SessionReader;
using test_support::TemporaryFolder;

TEST(SessionReader, NamesAFileThatIsNotThere) {
  const TemporaryFolder folder;
  ExpectError([&] { SessionReader(folder / "none.db"); }, ErrorKind::kFile, "none.db");
  ExpectError([&] { SessionReader(folder.path()); }, ErrorKind::kFile, folder.path().string());
}

TEST(SessionReader, TellsFilesThatAreNoSession) {
  const TemporaryFolder folder;
  std::ofstream(folder / "text.db") << std::string(5000, 'x');
  ExpectError([&] { SessionReader(folder / "text.db"); }, ErrorKind::kDatabase, "not a session file");
  std::ofstream(folder / "empty.db").flush();
  ExpectError([&] { SessionReader(folder / "empty.db"); }, ErrorKind::kFormat, "not an elbowroom session");
  SQLite::Database((folder / "other.db").string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("CREATE TABLE session (id INTEGER)");
  ExpectError([&] { SessionReader(folder / "other.db"); }, ErrorKind::kFormat, "not an elbowroom session");
  SQLite::Database((folder / "without_log.db").string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE)
      .exec("PRAGMA journal_mode = WAL");
  ExpectError([&] { SessionReader(folder / "without_log.db"); }, ErrorKind::kFormat, "copy both");
}

TEST(SessionReader, SaysWhichFramesThereAre) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 2);
  ExpectError([&] { (void)SessionReader(folder / "s.db").ReadFrame(2); }, ErrorKind::kRange, "frame 2");
}

// Reads all there is; throws what is wrong.
void ReadEverything(const fs::path& path) {
  const SessionReader reader(path);
  for (const sessions::FrameSummary& frame : reader.frames()) (void)reader.ReadFrame(frame.frame);
  (void)reader.events();
  (void)reader.episodes();
  (void)reader.contacts();
  (void)reader.part_totals();
  (void)reader.status();
}

TEST(SessionReader, ATruncatedFileIsAnErrorWhereverItIsCut) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 30);
  const std::uintmax_t size = fs::file_size(folder / "s.db");
  std::mt19937 random(3);
  for (int i = 0; i < 40; ++i) {
    const fs::path cut = folder / "cut.db";
    fs::copy_file(folder / "s.db", cut, fs::copy_options::overwrite_existing);
    fs::resize_file(cut, std::uniform_int_distribution<std::uintmax_t>(1, size - 1)(random));
    EXPECT_THROW(ReadEverything(cut), core::Error)
        << "cut to " << fs::file_size(cut) << " of " << size << " bytes";
  }
}

// Flips bytes all over a session: it reads, or says that it can't; nothing else.
TEST(SessionReader, DamageIsNeverMoreThanAnError) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 30);
  const auto size = static_cast<std::streamoff>(fs::file_size(folder / "s.db"));
  std::mt19937 random(4);
  int errors = 0;
  for (int i = 0; i < 150; ++i) {
    const fs::path damaged = folder / "damaged.db";
    fs::copy_file(folder / "s.db", damaged, fs::copy_options::overwrite_existing);
    std::fstream file(damaged, std::ios::in | std::ios::out | std::ios::binary);
    for (int byte = 0; byte < 40; ++byte) {
      file.seekp(std::uniform_int_distribution<std::streamoff>(0, size - 1)(random));
      file.put(static_cast<char>(random()));
    }
    file.close();
    try {
      ReadEverything(damaged);
    } catch (const core::Error& error) {
      EXPECT_NE(std::string(error.what()).find(damaged.string()), std::string::npos) << error.what();
      ++errors;
    }
  }
  EXPECT_GT(errors, 75) << "forty damaged bytes should rarely go unnoticed";
}

TEST(SessionReader, NoticesSilhouettesAndMeshesThatDontMatchTheirChecksums) {
  const TemporaryFolder folder;
  for (const char* damage :
       {"UPDATE mask SET words_zstd = (SELECT words_zstd FROM mask WHERE mask_id = 2)",
        "UPDATE mesh SET vertices_mm_zstd = (SELECT max(vertices_mm_zstd) FROM mesh)",
        "UPDATE mask SET words_zstd = zeroblob(100)", "DELETE FROM silhouette WHERE camera_index = 1",
        "UPDATE mask SET levels_zstd = (SELECT levels_zstd FROM mask WHERE mask_id = 3) WHERE mask_id = 1",
        "UPDATE mask SET levels_zstd = zeroblob(100)", "UPDATE mask SET levels_zstd = NULL",
        "UPDATE mask SET width_px = 1000000000", "DELETE FROM part_frame WHERE part_index = 2",
        "UPDATE mesh SET triangle_count = 1000000000000"}) {
    const fs::path path = folder / "s.db";
    fs::remove(path);
    WriteSampleSession(path, 3);
    SQLite::Database(path.string(), SQLite::OPEN_READWRITE).exec(damage);
    ExpectError([&] { ReadEverything(path); }, ErrorKind::kFormat, path.string());
  }
}

// Hidden from the checksum, as a faulty writer would: the levels themselves must make sense.
TEST(SessionReader, NamesFrameAndCameraOfLevelsThatDontFitTheirMask) {
  const TemporaryFolder folder;
  const core::SessionHeader header = SampleHeader();
  const core::SoftMask good = (*SampleFrame(header, 0, 1).masks)[0];
  core::SoftMask short_by_one = good, contradicting = good;
  short_by_one.levels.pop_back();
  contradicting.levels.back() ^= 128U;
  sessions::Compressor compressor;
  for (const auto& [bad, says] :
       {std::pair{short_by_one, "levels of its boundary: the packed data has another size"},
        {contradicting, "levels agree with its bits"}}) {
    const fs::path path = folder / "s.db";
    fs::remove(path);
    WriteSampleSession(path, 1);
    {
      SQLite::Database database(path.string(), SQLite::OPEN_READWRITE);
      const sessions::MaskHash hash = sessions::HashOf(bad);
      const sessions::Bytes levels = sessions::Pack(bad, compressor).levels_zstd.value();
      SQLite::Statement spoil(database,
                              "UPDATE mask SET content_hash = ?, levels_zstd = ? WHERE levels_zstd NOT NULL");
      spoil.bind(1, hash.data(), static_cast<int>(hash.size()));
      spoil.bind(2, levels.data(), static_cast<int>(levels.size()));
      ASSERT_EQ(spoil.exec(), 1);
    }
    ExpectError([&] { ReadEverything(path); }, ErrorKind::kFormat, path.string());
    ExpectError([&] { ReadEverything(path); }, ErrorKind::kFormat, "frame 0, silhouette of camera 0");
    ExpectError([&] { ReadEverything(path); }, ErrorKind::kFormat, says);
  }
}

// --- what may lie beside a session ---

// As a program leaves it that dies after so many frames.
void WriteCutOff(const std::filesystem::path& path, core::FrameIndex frames) {
  const core::SessionHeader header = SampleHeader();
  sessions::SessionWriter writer(path, header);
  for (core::FrameIndex i = 0; i < frames; ++i) writer.Append(SampleFrame(header, i, 1));
}

TEST(SessionReader, NeverJoinsASpillOfAnotherSession) {
  const TemporaryFolder folder;
  WriteCutOff(folder / "mine.db", 5);
  WriteCutOff(folder / "mine.db.spill", 9);
  ExpectError([&] { SessionReader(folder / "mine.db"); }, core::ErrorKind::kFile,
              "mine.db.spill' is another session's");
  EXPECT_EQ(SessionReader(folder / "mine.db.spill").frame_count(), 9);
  std::filesystem::rename(folder / "mine.db.spill", folder / "other.db");
  EXPECT_EQ(SessionReader(folder / "mine.db").frame_count(), 5);
}

TEST(SessionReader, ACompleteSessionTakesNothingFromASpill) {
  const TemporaryFolder folder;
  WriteSampleSession(folder / "s.db", 5);
  WriteCutOff(folder / "s.db.spill", 9);
  EXPECT_EQ(SessionReader(folder / "s.db").frame_count(), 5);
  EXPECT_TRUE(std::filesystem::exists(folder / "s.db.spill"));
}

TEST(SessionReader, SaysWhatIsNoSpill) {
  const TemporaryFolder folder;
  WriteCutOff(folder / "s.db", 5);
  std::ofstream(folder / "s.db.spill") << std::string(4096, 'x');
  ExpectError([&] { SessionReader(folder / "s.db"); }, core::ErrorKind::kFile, "s.db.spill' is no session");
  std::filesystem::resize_file(folder / "s.db.spill", 0);  // a program was killed while it made it
  EXPECT_EQ(SessionReader(folder / "s.db").frame_count(), 5);
}

TEST(SessionReader, DoesntWaitForAPipeInTheJournalsPlace) {
  const TemporaryFolder folder;
  for (const char* suffix : {"-journal", "-wal", "-shm"}) {
    WriteSampleSession(folder / "s.db", 2);
    ASSERT_EQ(mkfifo((folder / ("s.db" + std::string(suffix))).c_str(), 0600), 0);
    ExpectError([&] { SessionReader(folder / "s.db"); }, core::ErrorKind::kFile, "is a pipe or a device");
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
      std::filesystem::remove(entry.path());
  }
}

}  // namespace
}  // namespace elbowroom::tests
