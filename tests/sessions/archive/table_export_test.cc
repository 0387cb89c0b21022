#include "sessions/archive/table_export.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "tests/sessions/expect_error.h"
#include "tests/sessions/sample_session.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::tests {
namespace {

using sessions::ExportedTable;
using sessions::ExportTables;

class TableExport : public testing::Test {
 protected:
  void SetUp() override { WriteSampleSession(path_, 7); }
  [[nodiscard]] std::vector<ExportedTable> Export(const std::vector<std::string>& tables) const {
    return ExportTables(path_, tables, folder_ / "out", {}, {});
  }
  [[nodiscard]] nlohmann::json Json(const std::string& table) const {
    return nlohmann::json::parse(std::ifstream(folder_ / "out" / (table + ".json")));
  }
  [[nodiscard]] std::string Csv(const std::string& table) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / "out" / (table + ".csv")).rdbuf();
    return text.str();
  }
  test_support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "s.db";
};

TEST_F(TableExport, WritesEveryTableAndView) {
  const std::vector<ExportedTable> tables = Export({});
  SQLite::Database database(path_.string());
  SQLite::Statement names(
      database,
      "SELECT name FROM sqlite_schema WHERE type IN ('table', 'view') AND name NOT LIKE 'sqlite_%'");
  std::size_t count = 0;
  for (; names.executeStep(); ++count) {
    const std::string name = names.getColumn(0).getString();
    const std::int64_t rows = database.execAndGet("SELECT count(*) FROM \"" + name + "\"").getInt64();
    const auto found = std::ranges::find(tables, name, &ExportedTable::name);
    ASSERT_NE(found, tables.end()) << name;
    EXPECT_EQ(found->rows, rows) << name;
    EXPECT_EQ(Json(name).size(), static_cast<std::size_t>(rows)) << name;
  }
  EXPECT_EQ(tables.size(), count);
}

// Compares with SQLite's own JSON, which doesn't go through this program's rows.
TEST_F(TableExport, KeepsEveryValueInJson) {
  (void)Export({"part_frame", "contact_point", "frame_spacing"});
  SQLite::Database database(path_.string());
  for (const nlohmann::json& row : Json("contact_point")) {
    SQLite::Statement one(
        database,
        "SELECT x_mm, y_mm, z_mm, depth_mm, area_mm2 FROM contact_point WHERE frame_index = ? AND "
        "part_index = ? AND point_index = ?");
    one.bind(1, row["frame_index"].get<std::int64_t>());
    one.bind(2, row["part_index"].get<std::int64_t>());
    one.bind(3, row["point_index"].get<std::int64_t>());
    ASSERT_TRUE(one.executeStep());
    for (int i = 0; i < 5; ++i)
      EXPECT_EQ(row[one.getColumnName(i)].get<double>(), one.getColumn(i).getDouble());
  }
}

TEST_F(TableExport, TextsAreNeitherFormulasNorMarkup) {
  (void)Export({"remark"});
  EXPECT_EQ(Json("remark")[1]["comment"], "<script>alert(1)</script>");
  EXPECT_EQ(Json("remark")[1]["by_name"], "=cmd|");
  EXPECT_EQ(Csv("remark").find(",=cmd|"), std::string::npos);
  EXPECT_NE(Csv("remark").find(",\"'=cmd|\""), std::string::npos);
}

TEST_F(TableExport, BytesAreInBase64) {
  (void)Export({"footage"});
  EXPECT_EQ(Json("footage")[0]["content_hash"], "Af8AAAAAAAAAAAAAAAAAAA==");
}

TEST_F(TableExport, RefusesATableThatThereIsNot) {
  ExpectError([&] { (void)Export({"contacts"}); }, core::ErrorKind::kRange, "did you mean 'contact'?");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "out"));
}

TEST_F(TableExport, LeavesNothingWhenItIsCancelled) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW((void)ExportTables(path_, {}, folder_ / "out", {}, stop.get_token()), core::Error);
  EXPECT_TRUE(!std::filesystem::exists(folder_ / "out") || std::filesystem::is_empty(folder_ / "out"));
}

}  // namespace
}  // namespace elbowroom::tests
