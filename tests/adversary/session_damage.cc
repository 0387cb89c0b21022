#include "tests/adversary/session_damage.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <vector>

#include "sessions/packing.h"

namespace elbowroom::tests {
namespace {

namespace fs = std::filesystem;
using Random = std::mt19937;

std::uint64_t Below(Random& random, std::uint64_t end) {
  return std::uniform_int_distribution<std::uint64_t>(0, end - 1)(random);
}

template <typename List>
const auto& OneOf(Random& random, const List& list) {
  return list[Below(random, std::size(list))];
}

// --- bytes and pages ---------------------------------------------------------------------------------------

std::string ReadBytes(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

void WriteBytes(const fs::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary | std::ios::trunc) << bytes;
}

std::size_t PageSize(const std::string& bytes) {
  const std::size_t size = static_cast<std::size_t>(static_cast<unsigned char>(bytes[16])) << 8U |
                           static_cast<unsigned char>(bytes[17]);
  return size == 1 ? 65536 : size;
}

void FlipBit(std::string& bytes, std::size_t at, Random& random) {
  bytes[at] = static_cast<char>(static_cast<unsigned char>(bytes[at]) ^ (1U << Below(random, 8)));
}

std::string FlipBits(const fs::path& path, Random& random) {
  std::string bytes = ReadBytes(path);
  const std::uint64_t count = 1 + Below(random, 8);
  std::string what = "bits flipped at";
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::size_t at = Below(random, bytes.size());
    FlipBit(bytes, at, random);
    what += fmt::format(" {}", at);
  }
  WriteBytes(path, bytes);
  return what;
}

std::string SpoilPages(const fs::path& path, Random& random) {
  std::string bytes = ReadBytes(path);
  const std::size_t size = PageSize(bytes), pages = bytes.size() / size;
  const std::size_t a = Below(random, pages), b = Below(random, pages);
  const auto page = [&](std::size_t i) { return bytes.begin() + static_cast<std::ptrdiff_t>(i * size); };
  const auto end = static_cast<std::ptrdiff_t>(size);
  std::string what;
  switch (Below(random, 5)) {
    case 0:
      std::swap_ranges(page(a), page(a) + end, page(b));
      what = "swapped with";
      break;
    case 1:
      std::copy_n(page(b), end, page(a));
      what = "copied from";
      break;
    case 2:
      std::fill_n(page(a), end, '\0');
      what = "zeroed, not";
      break;
    case 3:
      std::generate_n(page(a), end, [&] { return static_cast<char>(random()); });
      what = "noise, not";
      break;
    default:
      // The page's header and the places of its cells, where a bit moves most.
      for (int i = 0; i < 3; ++i)
        FlipBit(bytes, a * size + Below(random, std::min<std::size_t>(size, 64)), random);
      what = "bits of its head flipped, not";
  }
  WriteBytes(path, bytes);
  return fmt::format("page {} {} {}", a + 1, what, b + 1);
}

std::string Cut(const fs::path& path, Random& random) {
  const std::uintmax_t size = fs::file_size(path);
  const std::uintmax_t to = Below(random, 4) == 0 ? size + Below(random, size) : 1 + Below(random, size - 1);
  fs::resize_file(path, to);
  return fmt::format("{} bytes of {}", to, size);
}

// --- SQL ---------------------------------------------------------------------------------------------------

constexpr std::array kTables = {"session",       "setting",
                                "version",       "tool",
                                "camera",        "mesh",
                                "part",          "spacing",
                                "pair_rule",     "frame",
                                "frame_spacing", "mask",
                                "silhouette",    "part_frame",
                                "contact",       "contact_point",
                                "episode",       "event",
                                "clearance",     "near_miss",
                                "heat_map",      "episode_spacing",
                                "cloth",         "pushed",
                                "stream",        "part_motion",
                                "part_group",    "part_group_member",
                                "camera_stamp"};
constexpr std::array kViews = {"v_spacing", "v_contact",    "v_episode",      "v_event",
                               "v_part",    "v_silhouette", "v_contact_point"};
constexpr std::array kValues = {"NULL",
                                "-1",
                                "0",
                                "1",
                                "7",
                                "2147483648",
                                "9223372036854775807",
                                "-9223372036854775808",
                                "9e999",
                                "-9e999",
                                "1e300",
                                "-1e300",
                                "1e-300",
                                "1e17",
                                "0.5",
                                "''",
                                "'x'",
                                "'[]'",
                                "'[1e999]'",
                                "'[1,2,3]'",
                                "'[\"a\",{}]'",
                                "'{\"a\":1}'",
                                "'[0,0,0,0,0,0,0,0,0]'",
                                "x'00'",
                                "x'28b52ffd'",
                                "zeroblob(100000)",
                                "randomblob(1000)",
                                "char(27,10,13,0,8232)",
                                "CAST(x'fffe80' AS TEXT)",
                                "hex(zeroblob(700000))",
                                "printf('%.*c', 40000, '[')"};
constexpr const char* kEndless = "WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT ";

std::vector<std::string> ColumnsOf(SQLite::Database& database, const std::string& table) {
  std::vector<std::string> columns;
  SQLite::Statement rows(database, fmt::format("PRAGMA table_info({})", table));
  while (rows.executeStep()) columns.push_back(rows.getColumn(1).getString());
  return columns;
}

// One row of it, or all.
std::string SomeRows(const std::string& table, Random& random) {
  if (Below(random, 3) == 0) return "";
  // Tables without a rowid take the first row that comes.
  static_cast<void>(table);
  return fmt::format(" LIMIT 1 OFFSET {}", Below(random, 6));
}

std::string ValueSql(SQLite::Database& database, Random& random) {
  const std::string table = OneOf(random, kTables);
  const std::vector<std::string> columns = ColumnsOf(database, table);
  if (columns.empty()) return "";
  const std::string& column = OneOf(random, columns);
  std::string value = OneOf(random, kValues);
  const std::uint64_t how = Below(random, 4);
  if (how == 0) value = fmt::format("{} + 1", column);
  if (how == 1) value = fmt::format("-{}", column);
  return fmt::format("UPDATE OR IGNORE {} SET {} = {}{}", table, column, value, SomeRows(table, random));
}

std::string SchemaSql(Random& random) {
  const std::string table = OneOf(random, kTables), other = OneOf(random, kTables),
                    view = OneOf(random, kViews);
  switch (Below(random, 11)) {
    case 0:
      return fmt::format("DROP TABLE {}", table);
    case 1:
      return fmt::format("DROP VIEW {}", view);
    case 2:
      return "DROP INDEX " + std::string(Below(random, 2) == 0 ? "event_by_frame" : "contact_by_part");
    case 3:
      return fmt::format("DROP VIEW {0}; CREATE VIEW {0} AS {1} i AS frame_index, i AS part_index FROM n",
                         view, kEndless);
    case 4:
      return fmt::format("ALTER TABLE {0} RENAME TO old_{0}; CREATE VIEW {0} AS {1} * FROM n", table,
                         kEndless);
    case 5:
      return fmt::format(
          "UPDATE sqlite_schema SET rootpage = (SELECT rootpage FROM sqlite_schema WHERE name = '{}') "
          "WHERE name = '{}'",
          other, table);
    case 6:
      return fmt::format("UPDATE sqlite_schema SET sql = {} WHERE name = '{}'", OneOf(random, kValues),
                         table);
    case 7:
      return fmt::format("UPDATE sqlite_schema SET rootpage = {} WHERE name = '{}'", OneOf(random, kValues),
                         table);
    case 8:
      return fmt::format("CREATE TRIGGER t AFTER INSERT ON {} BEGIN SELECT 1; END", table);
    case 9:
      return fmt::format("PRAGMA user_version = {}", static_cast<std::int32_t>(random()) % 9);
    default:
      return fmt::format("ALTER TABLE {} ADD COLUMN more REAL", table);
  }
}

std::string SpoilBySomeSql(const fs::path& path, Random& random) {
  std::string sql;
  {
    SQLite::Database database(path.string());
    switch (Below(random, 5)) {
      case 0: {
        const std::string table = OneOf(random, kTables);
        sql = fmt::format("DELETE FROM {}{}", table, SomeRows(table, random));
        break;
      }
      case 1:
        sql = SchemaSql(random);
        break;
      default:
        sql = ValueSql(database, random);
    }
  }
  try {
    SpoilBySql(path, sql);
  } catch (const SQLite::Exception& refused) {
    return fmt::format("{} (refused: {})", sql, refused.what());
  }
  return sql;
}

// --- packed data -------------------------------------------------------------------------------------------

// A frame of Zstandard that claims that many bytes, by one block of the same byte over and over.
std::string FrameClaiming(std::uint64_t bytes) {
  std::string frame("\x28\xB5\x2F\xFD\xE0", 5);  // single segment, 8 bytes of content size
  for (unsigned i = 0; i < 8; ++i) frame += static_cast<char>(bytes >> (8 * i));
  const std::uint32_t block = static_cast<std::uint32_t>(std::min<std::uint64_t>(bytes, 131072)) << 3U | 3U;
  for (unsigned i = 0; i < 3; ++i) frame += static_cast<char>(block >> (8 * i));
  return frame + '\0';
}

// Of a mask with bits where no pixel is, or levels that no boundary has: with its right checksum.
std::string SpoilMaskBehindItsChecksum(const fs::path& path, Random& random) {
  SQLite::Database database(path.string(), SQLite::OPEN_READWRITE);
  SQLite::Statement row(database, "SELECT mask_id, width_px, height_px FROM mask ORDER BY mask_id");
  if (!row.executeStep()) return "no mask";
  core::SoftMask mask{core::BitMask(row.getColumn(1).getInt(), row.getColumn(2).getInt()), {}};
  for (std::uint64_t& word : mask.mask.words()) word = static_cast<std::uint64_t>(random()) << 32U | random();
  if (Below(random, 2) == 0) mask.levels.assign(1 + Below(random, 1000), 200);
  sessions::Compressor compressor;
  const sessions::PackedMask packed = sessions::Pack(mask, compressor);
  const sessions::MaskHash hash = sessions::HashOf(mask);
  SQLite::Statement update(
      database, "UPDATE mask SET content_hash = ?, words_zstd = ?, levels_zstd = ? WHERE mask_id = ?");
  update.bind(1, hash.data(), static_cast<int>(hash.size()));
  update.bind(2, packed.words_zstd.data(), static_cast<int>(packed.words_zstd.size()));
  if (packed.levels_zstd)
    update.bind(3, packed.levels_zstd->data(), static_cast<int>(packed.levels_zstd->size()));
  update.bind(4, row.getColumn(0).getInt64());
  row.reset();
  update.exec();
  return "noise in a mask with its right checksum";
}

std::string SpoilPackedData(const fs::path& path, Random& random) {
  if (Below(random, 3) == 0) return SpoilMaskBehindItsChecksum(path, random);
  constexpr std::array<std::array<const char*, 3>, 5> kPacked = {
      {{"mask", "words_zstd", "width_px"},
       {"mask", "levels_zstd", "height_px"},
       {"mesh", "vertices_mm_zstd", "vertex_count"},
       {"mesh", "triangles_zstd", "triangle_count"},
       {"heat_map", "dwell_s_zstd", "patch_count"}}};
  constexpr std::array<std::uint64_t, 6> kCounts = {1,           65536,       1ULL << 31U,
                                                    3ULL << 32U, 1ULL << 60U, ~0ULL >> 1U};
  const auto& [table, column, count] = OneOf(random, kPacked);
  const std::uint64_t claimed = OneOf(random, kCounts);
  const std::string frame = FrameClaiming(claimed * (column[0] == 'v' ? 24 : column[0] == 't' ? 12 : 8));
  std::string hex;
  for (const char c : frame) hex += fmt::format("{:02x}", static_cast<unsigned char>(c));
  std::string sql = fmt::format("UPDATE {} SET {} = x'{}', {} = {}", table, column, hex, count, claimed);
  try {
    SpoilBySql(path, sql);
  } catch (const SQLite::Exception& refused) {
    return fmt::format("{} (refused: {})", sql, refused.what());
  }
  return sql;
}

// --- what is known
// ------------------------------------------------------------------------------------------

constexpr std::array kKnownReproducers = {
    Reproducer{"a frame without its spacings", "DELETE FROM frame_spacing WHERE frame_index = 5"},
    Reproducer{"a frame without one spacing",
               "DELETE FROM frame_spacing WHERE frame_index = 2 AND spacing_index = 0"},
    Reproducer{"spacings numbered otherwise", "UPDATE frame_spacing SET spacing_index = spacing_index + 10"},
    Reproducer{"a touch of a part beyond the layout", "UPDATE episode SET part_index = 1000000"},
    Reproducer{"a touch of part -1", "UPDATE episode SET part_index = -1"},
    Reproducer{"a touch without its spacings", "DELETE FROM episode_spacing"},
    Reproducer{"a verdict on a part beyond the layout",
               "UPDATE part_frame SET part_index = 4000000000 WHERE part_index = 1"},
    Reproducer{"a part that was clear and isn't said to be",
               "DELETE FROM part_frame WHERE frame_index = 1 AND part_index = 0"},
    Reproducer{"a contact without its evidence", "DELETE FROM contact"},
    Reproducer{"a silhouette gone", "DELETE FROM silhouette WHERE frame_index = 0 AND camera_index = 0"},
    Reproducer{"a camera gone", "DELETE FROM camera WHERE camera_index = 0"},
    Reproducer{"a part gone", "DELETE FROM part WHERE part_index = 0"},
    Reproducer{"a spacing gone", "DELETE FROM spacing WHERE spacing_index = 0"},
    Reproducer{"a mesh gone", "DELETE FROM mesh"},
    Reproducer{"time that goes backwards", "UPDATE frame SET time_s = -time_s"},
    Reproducer{"time without end", "UPDATE frame SET time_s = 9e999 WHERE frame_index = 3"},
    Reproducer{"time beyond a trial's", "UPDATE frame SET time_s = time_s + 1e300"},
    Reproducer{"a spacing that no axis can show", "UPDATE frame_spacing SET spacing_mm = 1e17"},
    Reproducer{"a spacing without end", "UPDATE frame_spacing SET spacing_mm = 9e999"},
    Reproducer{"frames of negative number",
               "UPDATE frame SET frame_index = -9223372036854775807 WHERE frame_index = 0"},
    Reproducer{"an event before all", "UPDATE event SET frame_index = -9223372036854775807 - 1"},
    Reproducer{"an event of a spacing beyond the layout",
               "UPDATE event SET spacing_index = 99 WHERE spacing_index IS NOT NULL"},
    Reproducer{"a near miss without spacings", "UPDATE near_miss SET spacing_at_closest_mm = '[]'"},
    Reproducer{"a near miss of a part beyond the layout", "UPDATE near_miss SET part_index = 77"},
    Reproducer{"patches without size", "UPDATE heat_map SET patch_mm = 1e-300"},
    Reproducer{"patches beyond count", "UPDATE heat_map SET patch_count = -1"},
    Reproducer{"pictures of 65536 x 65536",
               "UPDATE camera SET image_width_px = 65536, image_height_px = 65536; "
               "UPDATE mask SET width_px = 65536, height_px = 65536"},
    Reproducer{"pictures of negative size",
               "UPDATE camera SET image_width_px = -5; UPDATE mask SET width_px = -5"},
    Reproducer{"2^31 triangles", "UPDATE mesh SET triangle_count = 2147483648"},
    Reproducer{"2^61 vertices", "UPDATE mesh SET vertex_count = 2305843009213693953"},
    Reproducer{"no workspace", "UPDATE session SET workspace_max_x_mm = workspace_min_x_mm"},
    Reproducer{"two statuses", "UPDATE session SET status = 'broken'"},
    Reproducer{"no session", "DELETE FROM session"},
    Reproducer{"a negative schema", "PRAGMA user_version = -5"},
    Reproducer{"no schema", "PRAGMA user_version = 0"},
    Reproducer{"an older schema than it has", "PRAGMA user_version = 3"},
    Reproducer{"a view that never ends",
               "DROP VIEW v_part; CREATE VIEW v_part AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT "
               "i + 1 FROM n) "
               "SELECT i AS part_index, i AS frames_in_contact, i AS frames_near, i AS frames_undecided, "
               "i AS frames_clear FROM n"},
    Reproducer{
        "a view that never ends as table event",
        "DROP VIEW v_event; DROP TABLE event; CREATE VIEW event AS WITH RECURSIVE n(i) AS "
        "(SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i AS event_id, 1 AS frame_index, 0.5 AS time_s, "
        "'note' AS kind, NULL AS spacing_index, NULL AS from_mm, NULL AS to_mm, NULL AS tool, NULL AS "
        "in_use, "
        "'x' AS note FROM n WHERE i < 0"},
    Reproducer{"billions of frames as table frame",
               "ALTER TABLE frame RENAME TO kept; CREATE VIEW frame AS WITH RECURSIVE n(i) AS "
               "(SELECT 0 UNION ALL SELECT i + 1 FROM n LIMIT 4000000000) SELECT i AS frame_index, i * 0.1 "
               "AS time_s "
               "FROM n"},
    Reproducer{"an index that isn't that of its table",
               "UPDATE sqlite_schema SET sql = 'CREATE INDEX event_by_frame ON event (time_s)' "
               "WHERE name = 'event_by_frame'"},
    Reproducer{"a text of 30 MB",
               "INSERT INTO event (frame_index, time_s, kind, note) "
               "VALUES (1, 0.1, 'note', printf('%.*c', 30000000, 'n'))"},
    Reproducer{"no camera that is one", "UPDATE camera SET camera_matrix = '[1e300,0,0,0,1e-300,0,0,0,1]'"},
    Reproducer{"a frame with the stamp of one camera of two",
               "DELETE FROM camera_stamp WHERE frame_index = 0 AND camera_index = 0"},
    Reproducer{"a stamp of a camera beyond the rig",
               "UPDATE camera_stamp SET camera_index = camera_index + 7"},
    Reproducer{"a picture of negative number", "UPDATE camera_stamp SET picture = -picture - 1"},
    Reproducer{"a picture taken at no time", "UPDATE camera_stamp SET taken_at_s = 9e999"},
    Reproducer{"a picture taken beyond a trial's time", "UPDATE camera_stamp SET taken_at_s = 1e300"},
    Reproducer{"parts turned by no rotation",
               "UPDATE part SET rotation_world_from_part = '[9,0,0,0,9,0,0,0,9]'"},
};

}  // namespace

std::string Spoil(const fs::path& path, Random& random) {
  switch (Below(random, 10)) {
    case 0:
    case 1:
      return FlipBits(path, random);
    case 2:
    case 3:
      return SpoilPages(path, random);
    case 4:
      return Cut(path, random);
    case 5:
      return SpoilPackedData(path, random);
    default:
      return SpoilBySomeSql(path, random);
  }
}

void SpoilBySql(const fs::path& path, const std::string& sql) {
  SQLite::Database database(path.string(), SQLite::OPEN_READWRITE);
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_DEFENSIVE, 0, nullptr);
  database.exec(
      "PRAGMA foreign_keys = OFF; PRAGMA ignore_check_constraints = ON; PRAGMA writable_schema = ON; "
      "PRAGMA legacy_alter_table = ON");
  database.exec(sql);
}

std::span<const Reproducer> KnownReproducers() { return kKnownReproducers; }

std::string IntegrityOf(const fs::path& path) {
  try {
    SQLite::Database database(path.string());
    return database.execAndGet("PRAGMA integrity_check").getString();
  } catch (const SQLite::Exception& failure) {
    return failure.what();
  }
}

}  // namespace elbowroom::tests
