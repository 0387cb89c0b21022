// docs/durability.md, "logging": what it costs a frame that every one is recorded and on the disk.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "app/control/demo_trial.h"
#include "app/control/frame_pipeline.h"
#include "app/control/trial_rules.h"
#include "core/error.h"
#include "core/layout.h"
#include "sessions/session_writer.h"
#include "tests/accuracy/measurements.h"
#include "tests/accuracy/quantile.h"
#include "tests/reporting/machine_line.h"
#include "tests/reporting/markdown_table.h"
#include "tests/reporting/marked_section.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::accuracy {
namespace {

using Clock = std::chrono::steady_clock;

// Frames with and without logging take turns, so that what else the machine does meets both alike. An odd
// number of turns shows all pictures once, so that each picture is met with and without.
constexpr int kFramesATurn = 40, kTurns = 40;
constexpr core::FrameIndex kFramesLogged = 5 * kFramesATurn;
constexpr double kFrameRateHz = 30.0;

double MsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// When frames were handed over, and when the writer said that they were on the disk.
class LagWatch {
 public:
  explicit LagWatch(const sessions::SessionWriter& writer) : writer_(writer) {}

  void HandedOver() {
    const std::lock_guard lock(mutex_);
    handed_over_.push_back(Clock::now());
  }
  [[nodiscard]] std::vector<double> Lags() {
    thread_ = {};
    return lag_ms_;
  }

 private:
  void Watch(const std::stop_token& stop) {
    std::size_t seen = 0;
    while (!stop.stop_requested()) {
      const auto committed = static_cast<std::size_t>(writer_.frames_committed());
      {
        const std::lock_guard lock(mutex_);
        for (; seen < std::min(committed, handed_over_.size()); ++seen)
          lag_ms_.push_back(MsSince(handed_over_[seen]));
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }

  const sessions::SessionWriter& writer_;
  std::mutex mutex_;
  std::vector<Clock::time_point> handed_over_;
  std::vector<double> lag_ms_;
  std::jthread thread_{[this](const std::stop_token& stop) { Watch(stop); }};
};

struct Cost {
  std::vector<double> without_ms, with_ms;  // pictures to contacts, and handed over
  std::vector<double> hand_over_ms;         // of the latter
  std::vector<double> lag_ms;               // handed over to on the disk
};

// The demo's pictures, again and again; paced: at the cameras' rate, else as fast as it goes.
Cost MeasureCost(const control::TrialSetup& setup, const std::vector<recon::FrameSet>& pictures,
                 bool is_paced) {
  const test_support::TemporaryFolder folder;
  control::FramePipeline pipeline(
      setup.source->rig(), setup.layout, setup.source->ReadBackgrounds({}, {}), setup.segmentation,
      control::ReviewOptionsOf(setup.info, setup.source->rig(), setup.rig_quality));
  core::SessionHeader header;
  header.trial = setup.info;
  header.rig = setup.source->rig();
  header.layout = setup.layout;
  sessions::SessionWriter writer(folder / "s.db", header);
  LagWatch watch(writer);
  Cost cost;
  core::FrameIndex frame = 0;
  std::int64_t logged = 0;
  Clock::time_point due = Clock::now();
  for (int turn = 0; turn < 2 * kTurns; ++turn) {
    const bool is_logged = turn % 2 == 1;
    for (int i = 0; i < kFramesATurn; ++i, ++frame) {
      recon::FrameSet next = pictures[static_cast<std::size_t>(frame % kFramesLogged)];
      next.index = frame;
      next.time_s = static_cast<double>(frame) / kFrameRateHz;
      due += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / kFrameRateHz));
      if (is_paced) std::this_thread::sleep_until(due);
      const Clock::time_point begin = Clock::now();
      const control::SharedFrameResult result =
          pipeline.Process(std::move(next), setup.layout.InitialSpacings());
      if (is_logged) {
        const Clock::time_point hand_over = Clock::now();
        writer.Append(result->record);
        cost.hand_over_ms.push_back(MsSince(hand_over));
      }
      (is_logged ? cost.with_ms : cost.without_ms).push_back(MsSince(begin));
      if (!is_logged) continue;
      watch.HandedOver();
      ++logged;
    }
    // What is still to be written belongs to the turn that is over.
    while (writer.frames_committed() < logged) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  cost.lag_ms = watch.Lags();
  return cost;
}

std::vector<std::string> RowOf(const std::string& what, const Cost& cost) {
  const double without_ms = Quantile(cost.without_ms, 0.5), with_ms = Quantile(cost.with_ms, 0.5);
  return {what,
          fmt::format("{}", cost.with_ms.size()),
          fmt::format("{:.2f}", without_ms),
          fmt::format("{:.2f}", with_ms),
          fmt::format("{:+.1f} %", 100.0 * (with_ms / without_ms - 1.0)),
          fmt::format("{:.2f}", Quantile(cost.hand_over_ms, 0.5)),
          fmt::format("{:.2f}, {:.2f}", Quantile(cost.without_ms, 0.99), Quantile(cost.with_ms, 0.99)),
          fmt::format("{:.0f}", Quantile(cost.lag_ms, 0.5)),
          fmt::format("{:.0f}", Quantile(cost.lag_ms, 0.99)),
          fmt::format("{:.0f}", Quantile(cost.lag_ms, 1.0))};
}

}  // namespace

void MeasureLogging(const std::filesystem::path& docs) {
  const control::TrialSetup setup = control::MakeDemoTrial(control::DemoPlay::kForever);
  fmt::print(stderr, "logging: drawing {} frames\n", kFramesLogged);
  std::vector<recon::FrameSet> pictures;
  for (core::FrameIndex i = 0; i < kFramesLogged; ++i) pictures.push_back(setup.source->Read(i));
  reporting::Table table{{"frames come", "frames each", "without logging, ms", "with, ms", "difference",
                          "of it handing over, ms", "99 %: without, with, ms", "on the disk after, ms",
                          "99 %, ms", "longest, ms"},
                         {}};
  for (const bool is_paced : {true, false}) {
    const std::string what = is_paced ? fmt::format("{:.0f} a second", kFrameRateHz) : "as fast as it goes";
    fmt::print(stderr, "logging: {}\n", what);
    table.rows.push_back(RowOf(what, MeasureCost(setup, pictures, is_paced)));
  }
  reporting::WriteSection(
      docs / "durability.md", "logging",
      reporting::ToMarkdown(table) + "\n" + reporting::ToLine(reporting::ThisMachine(docs / "..")));
}

}  // namespace elbowroom::accuracy
