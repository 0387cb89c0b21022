// The console's parts on their own: bridge, tiles' texts, contact list, frame rate, start without a display.
#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLocale>
#include <QTest>
#include <QThread>
#include <QTimer>
#include <algorithm>
#include <filesystem>
#include <map>
#include <semaphore>
#include <thread>

#include "app/console/console_main.h"
#include "app/console/contact_model.h"
#include "app/console/frame_rate.h"
#include "app/console/tile_text.h"
#include "app/console/trial_actions.h"
#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/console/view/picture_pace.h"
#include "core/error.h"
#include "tests/app/console/stall_watch.h"
#include "tests/support/places.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::console {
namespace {

constexpr int kPatienceMs = 30'000;  // far beyond what an event takes; a test that waits so long has failed

TEST(Bridge, KeepsOnlyTheLatestOfAStreamThatTheUiIsTooSlowFor) {
  Bridge bridge;
  std::vector<int> delivered;
  std::thread worker([&] {
    for (int i = 0; i < 1000; ++i) {
      bridge.PostLatest(Bridge::Stream::kFrame, [&delivered, i] { delivered.push_back(i); });
    }
  });
  worker.join();  // the UI thread hasn't come to its events yet
  QCoreApplication::processEvents();
  EXPECT_EQ(delivered, std::vector<int>({999}));
}

TEST(Bridge, DeliversEveryPostInOrderOnItsOwnThread) {
  Bridge bridge;
  std::vector<int> delivered;
  bool always_on_own_thread = true;
  std::jthread worker([&] {
    for (int i = 0; i < 100; ++i) {
      bridge.Post([&, i] {
        delivered.push_back(i);
        always_on_own_thread = always_on_own_thread && QThread::currentThread() == bridge.thread();
      });
    }
  });
  ASSERT_TRUE(QTest::qWaitFor([&] { return delivered.size() == 100; }, kPatienceMs));
  EXPECT_TRUE(std::is_sorted(delivered.begin(), delivered.end()));
  EXPECT_TRUE(always_on_own_thread);
}

TEST(Bridge, AFramePostedBeforeTheEndArrivesBeforeIt) {
  Bridge bridge;
  std::vector<std::string> delivered;
  bridge.PostLatest(Bridge::Stream::kFrame, [&] { delivered.emplace_back("frame"); });
  bridge.Post([&] { delivered.emplace_back("end"); });
  QCoreApplication::processEvents();
  EXPECT_EQ(delivered, std::vector<std::string>({"frame", "end"}));
}

TEST(Bridge, ForgetsWhatIsUndeliveredWhenItGoes) {
  bool is_delivered = false;
  {
    Bridge bridge;
    bridge.Post([&] { is_delivered = true; });
    bridge.PostLatest(Bridge::Stream::kFrame, [&] { is_delivered = true; });
  }
  QCoreApplication::processEvents();
  EXPECT_FALSE(is_delivered);
}

TEST(BackgroundJob, HandsTheOneLineOfAFailureToTheUiThread) {
  Bridge bridge;
  std::string line;
  const BackgroundJob job(
      bridge,
      [](const std::stop_token&) { throw core::Error(core::ErrorKind::kFile, "a.db: gone; look elsewhere"); },
      [&](const std::string& error) { line = error; });
  ASSERT_TRUE(QTest::qWaitFor([&] { return !line.empty(); }, kPatienceMs));
  EXPECT_EQ(line, "a.db: gone; look elsewhere");
}

TEST(BackgroundJob, TellsItsWorkToStop) {
  Bridge bridge;
  std::binary_semaphore is_stopped(0);
  bool is_done = false;
  BackgroundJob job(
      bridge,
      [&](const std::stop_token& stop) {
        const std::stop_callback on_stop(stop, [&] { is_stopped.release(); });
        is_stopped.acquire();
      },
      [&](const std::string& error) { is_done = error.empty(); });
  job.Cancel();
  EXPECT_TRUE(QTest::qWaitFor([&] { return is_done; }, kPatienceMs));
}

TEST(TileText, SaysWhatIsKnownAndNoMore) {
  control::CameraTile tile;
  tile.name = "cam1";
  tile.object_px = 12345;
  const TileText recorded = TextOf(tile);
  EXPECT_EQ(recorded.rate, QLocale().toString(12345) + " px");
  EXPECT_TRUE(recorded.lost.isEmpty() && recorded.skew.isEmpty() && recorded.light.isEmpty() &&
              recorded.advice.isEmpty() && recorded.trouble.isEmpty());

  tile.figures.rate_hz = 29.97;
  tile.figures.lost = 3;
  tile.figures.skew_ms = 2.14;
  tile.figures.light = recon::LightReport();
  tile.figures.light->gain = 0.966;
  TileText live = TextOf(tile);
  EXPECT_EQ(live.rate, "30.0 Hz");
  EXPECT_EQ(live.lost, "lost 3");
  EXPECT_EQ(live.skew, "skew +2.1 ms");
  EXPECT_EQ(live.light, "light 97 %");
  tile.figures.skew_ms = -0.04;
  EXPECT_EQ(TextOf(tile).skew, "skew 0.0 ms");
  tile.figures.skew_ms = -2.16;
  EXPECT_EQ(TextOf(tile).skew, "skew -2.2 ms");

  tile.figures.light->pulse = recon::LightPulse{0.05, 10.0, 100.0, true, true};
  tile.figures.light->advice = {"camera 'cam1': lamps on 50 Hz mains flicker by 5 %"};
  tile.is_missing = true;
  live = TextOf(tile);
  EXPECT_EQ(live.light, "light 97 %, flicker 5 %");
  EXPECT_FALSE(live.advice.isEmpty());
  EXPECT_TRUE(live.tool_tip.contains("50 Hz mains"));
  EXPECT_EQ(live.trouble, "no picture");
  tile.gone = "it sends nothing";
  EXPECT_EQ(TextOf(tile).trouble, "gone: it sends nothing");
}

control::FrameResult TwoPartsWith(core::Verdict first, core::Verdict second) {
  auto layout = std::make_shared<core::Layout>();
  layout->parts.resize(2);
  layout->parts[0].name = "box";
  layout->parts[1].name = "lid";
  control::FrameResult result;
  result.layout = layout;
  result.record.contacts.resize(2);
  result.record.contacts[0].verdict = first;
  result.record.contacts[1].part = 1;
  result.record.contacts[1].verdict = second;
  return result;
}

TEST(ContactModel, ListsOnlyPartsInContact) {
  ContactModel model;
  control::FrameResult result = TwoPartsWith(core::Verdict::kNear, core::Verdict::kContact);
  result.record.contacts[1].deepest = core::ContactPoint{{10.4, -20.0, -0.2}, 4.29, 1.0};
  result.record.contacts[1].contact_area_mm2 = 12.4;
  result.record.contacts[1].contact_point_count = 7;
  model.ShowFrame(result);
  ASSERT_EQ(model.rowCount(), 1);
  const auto cell = [&](int column) {
    return model.data(model.index(0, column), Qt::DisplayRole).toString();
  };
  EXPECT_EQ(cell(ContactModel::kPart), "lid");
  EXPECT_EQ(cell(ContactModel::kDepth), "4.2");  // a lower bound stays one
  EXPECT_EQ(cell(ContactModel::kArea), "12");
  EXPECT_EQ(cell(ContactModel::kPoints), "7");
  EXPECT_EQ(cell(ContactModel::kPosition), "10, -20, 0");

  model.ShowFrame(TwoPartsWith(core::Verdict::kUndecided, core::Verdict::kClear));
  EXPECT_EQ(model.rowCount(), 0);
}

TEST(FrameRate, CountsFramesByNumberOverTheLastTwoSeconds) {
  FrameRate rate;
  const FrameRate::Clock::time_point start{};
  EXPECT_FALSE(rate.frames_per_s());
  rate.Add(0, start);
  EXPECT_FALSE(rate.frames_per_s());
  for (int i = 1; i <= 10; ++i) rate.Add(3 * i, start + std::chrono::milliseconds(100 * i));
  EXPECT_DOUBLE_EQ(*rate.frames_per_s(), 30.0);  // two of three frames weren't shown, and count
  for (int i = 11; i <= 50; ++i) rate.Add(30 + i - 10, start + std::chrono::milliseconds(100 * i));
  EXPECT_DOUBLE_EQ(*rate.frames_per_s(), 10.0);
}

TEST(PicturePace, CoarsensPicturesOnASlowMachineAndRefinesThemAgain) {
  PicturePace pace;
  EXPECT_FALSE(pace.fineness().is_smooth);  // the first picture comes soon
  EXPECT_EQ(pace.fineness().picture, 1.0);
  const auto draw = [&](double finest_ms) {
    for (int i = 0; i < 20; ++i) pace.Add(finest_ms * pace.fineness().relative_cost);
  };
  for (const double finest_ms : {50.0, 100.0, 150.0, 220.0, 300.0}) {
    draw(finest_ms);
    EXPECT_LE(finest_ms * pace.fineness().relative_cost, PicturePace::kAimMs);
    const PictureFineness settled = pace.fineness();
    draw(finest_ms);
    EXPECT_EQ(pace.fineness(), settled);  // no to and fro
  }
  draw(15.0);
  EXPECT_EQ(pace.fineness(), PicturePace::kFinest);
}

TEST(PicturePace, GivesUpSmoothEdgesBeforePixels) {
  PicturePace pace;
  const auto draw = [&](double finest_ms) {
    for (int i = 0; i < 20; ++i) pace.Add(finest_ms * pace.fineness().relative_cost);
  };
  draw(20.0);
  EXPECT_EQ(pace.fineness(), PicturePace::kFinest);
  draw(30.0);
  EXPECT_EQ(pace.fineness(), PicturePace::kFinest);
  draw(100.0);
  EXPECT_FALSE(pace.fineness().is_smooth);
  EXPECT_EQ(pace.fineness().picture, 1.0);
  draw(250.0);
  EXPECT_LT(pace.fineness().picture, 1.0);
  EXPECT_LE(250.0 * pace.fineness().relative_cost, PicturePace::kAimMs);
}

TEST(PicturePace, OneSlowPictureChangesNothing) {
  PicturePace pace;
  const PictureFineness first = pace.fineness();
  for (int i = 0; i < 10; ++i) pace.Add(i % 2 == 0 ? 1000.0 : 20.0);
  EXPECT_EQ(pace.fineness(), first);
}

TEST(SessionName, SortsByTime) {
  const QDateTime at(QDate(2031, 2, 3), QTime(4, 5, 6));
  EXPECT_EQ(DefaultSessionName(at), "elbowroom-20310203-040506.db");
}

TEST(StallWatch, SeesAThreadThatWaits) {
  const StallWatch stalls;
  std::binary_semaphore never(0);
  QTimer::singleShot(0, [&] { EXPECT_FALSE(never.try_acquire_for(std::chrono::milliseconds(300))); });
  ASSERT_TRUE(QTest::qWaitFor([&] { return stalls.longest_ms() > 250.0; }, kPatienceMs));
}

// Runs the program where there is no display: no core dump, no list of Qt's plugins, one line.
void ExpectOneLineWithoutDisplay(const std::map<std::string, std::string>& environment) {
  const test_support::ProgramRun run =
      test_support::RunProgram(test_support::ProgramFile(), {}, {.environment = environment});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("no display"), std::string::npos) << run.err;
  EXPECT_NE(run.err.find("--headless"), std::string::npos) << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
}

TEST(ConsoleStart, WithoutADisplayIsOneLine) {
  ExpectOneLineWithoutDisplay({{"DISPLAY", ""}, {"WAYLAND_DISPLAY", ""}, {"QT_QPA_PLATFORM", ""}});
}

TEST(ConsoleStart, WithoutTheProgramOfTheWindowIsOneLine) {
  const test_support::TemporaryFolder folder;
  std::filesystem::copy_file(test_support::ProgramFile(), folder / "elbowroom");
  const test_support::ProgramRun run = test_support::RunProgram(folder / "elbowroom", {});
  EXPECT_EQ(run.exit_status, 1);
  EXPECT_NE(run.err.find("elbowroom_window-"), std::string::npos) << run.err;
  EXPECT_TRUE(run.err.ends_with("it belongs beside the program: build or install them together\n"))
      << run.err;
  EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
}

TEST(ConsoleStart, WithADisplayThatDoesNotAnswerIsOneLine) {
  ExpectOneLineWithoutDisplay({{"DISPLAY", ":987"}, {"WAYLAND_DISPLAY", ""}, {"QT_QPA_PLATFORM", "xcb"}});
}

}  // namespace
}  // namespace elbowroom::console
