// The console's calibration page on the sample rig of the documents.
#include "app/console/calibration_dialog.h"

#include <gtest/gtest.h>

#include <QLabel>
#include <QListWidget>
#include <QPixmap>
#include <QPushButton>
#include <QSignalSpy>
#include <QTableWidget>
#include <QTest>
#include <filesystem>

#include "recon/rig_files/rig_file.h"
#include "tests/app/console/opened_urls.h"
#include "tests/support/places.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/text_file.h"

namespace elbowroom::console {
namespace {

namespace fs = std::filesystem;
constexpr int kCalibrationPatienceMs = 240'000;  // far beyond what it takes on a loaded machine

class CalibrationPage : public testing::Test {
 protected:
  CalibrationPage() {
    fs::copy(test_support::SourceFolder() / "docs/examples/first_rig", folder_.path(),
             fs::copy_options::recursive);
  }
  static QString Text(const CalibrationDialog& dialog, const char* label) {
    return dialog.findChild<QLabel*>(label)->text();
  }

  test_support::TemporaryFolder folder_;
};

TEST_F(CalibrationPage, ShowsTheFiguresAndWhatToDoNext) {
  const OpenedUrls opened;
  CalibrationDialog dialog(folder_ / "CALIB.toml", folder_ / "rig.yml");
  QSignalSpy ended(&dialog, &CalibrationDialog::Ended);
  dialog.show();
  ASSERT_TRUE(QTest::qWaitFor([&] { return !ended.isEmpty(); }, kCalibrationPatienceMs));
  ASSERT_TRUE(ended.first().first().toBool()) << Text(dialog, "calibration_headline").toStdString();
  EXPECT_TRUE(Text(dialog, "calibration_headline").contains("A point in the workspace is known to"));
  EXPECT_TRUE(Text(dialog, "calibration_headline").contains("agrees with the known length"));
  const auto* cameras = dialog.findChild<QTableWidget*>("calibration_cameras");
  ASSERT_EQ(cameras->rowCount(), 3);
  EXPECT_EQ(cameras->item(0, 0)->text(), "cam1");
  const auto* advice = dialog.findChild<QListWidget*>("calibration_advice");
  ASSERT_GT(advice->count(), 0);
  EXPECT_TRUE(advice->item(0)->text().contains("cam1")) << advice->item(0)->text().toStdString();
  EXPECT_TRUE(recon::ReadRigFile(folder_ / "rig.yml").calibration.has_value());
  auto* report = dialog.findChild<QPushButton*>("calibration_report");
  ASSERT_TRUE(report->isEnabled());
  report->click();
  ASSERT_EQ(opened.urls().size(), 1U);
  EXPECT_TRUE(fs::exists(opened.urls().front().toLocalFile().toStdString()));
}

TEST_F(CalibrationPage, ClosingItCancelsAndWritesNothing) {
  {
    CalibrationDialog dialog(folder_ / "CALIB.toml", folder_ / "rig.yml");
    EXPECT_TRUE(dialog.is_running());
  }
  EXPECT_FALSE(fs::exists(folder_ / "rig.yml"));
  EXPECT_FALSE(fs::exists(folder_ / "rig-calibration"));
}

TEST_F(CalibrationPage, WhatIsWrongIsSaidInItsLine) {
  test_support::WriteText(folder_ / "CALIB.toml", "[board]\ntype = \"carpet\"\n");
  CalibrationDialog dialog(folder_ / "CALIB.toml", folder_ / "rig.yml");
  QSignalSpy ended(&dialog, &CalibrationDialog::Ended);
  ASSERT_TRUE(QTest::qWaitFor([&] { return !ended.isEmpty(); }, kCalibrationPatienceMs));
  EXPECT_FALSE(ended.first().first().toBool());
  EXPECT_TRUE(Text(dialog, "calibration_headline").contains("carpet"));
  EXPECT_FALSE(fs::exists(folder_ / "rig.yml"));
}

}  // namespace
}  // namespace elbowroom::console
