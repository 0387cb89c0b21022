// What a review costs (docs/reviewing.md): `review_cost SESSION SPACING`. Frames scrubbed to and fro, frames
// at another gap, and the whole motion at gaps over the spacing's range.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "app/control/reviewing/needed_gap.h"
#include "app/control/reviewing/what_if.h"
#include "app/control/reviewing/what_if_frames.h"
#include "app/control/stopwatch.h"
#include "core/error.h"
#include "tests/support/processor_time.h"

namespace elbowroom::control {
namespace {

constexpr std::size_t kScrubs = 300;
constexpr std::size_t kStride = 37;  // frames: none is the neighbour of the one before
constexpr int kGaps = 9;

void Tell(const char* what, std::vector<double> times_ms) {
  std::ranges::sort(times_ms);
  fmt::print("{}: median {:.2f} ms, 95 % {:.2f} ms, longest {:.2f} ms ({})\n", what,
             times_ms[times_ms.size() / 2], times_ms[times_ms.size() * 95 / 100], times_ms.back(),
             times_ms.size());
}

void Scrub(const char* what, const std::shared_ptr<const ReviewedSession>& session, std::size_t stride,
           const HeldGaps& held_mm) {
  WhatIfFrames frames(session);
  (void)frames.At(0, held_mm);  // what all frames share is made with the first
  std::vector<double> times_ms;
  Stopwatch watch;
  const double begin_ms = test_support::ProcessorMs();
  for (std::size_t i = 1; i <= kScrubs; ++i) {
    (void)frames.At(i * stride % session->frames().size(), held_mm);
    times_ms.push_back(watch.LapMs());
  }
  Tell(what, std::move(times_ms));
  fmt::print("  of processor time {:.2f} ms a frame\n", (test_support::ProcessorMs() - begin_ms) / kScrubs);
}

void Run(const char* file, const char* name) {
  Stopwatch watch;
  const auto session = std::make_shared<const ReviewedSession>(file, core::Progress(), std::stop_token());
  fmt::print("opened in {:.0f} ms: {} frames\n", watch.LapMs(), session->frames().size());
  const core::Layout& layout = session->header().layout;
  const core::Spacing& spacing = layout.spacings[core::RequireSpacing(layout, name)];
  const double middle_mm = 0.5 * (spacing.min_mm + spacing.max_mm);
  Scrub("scrub to the next frame", session, 1, {});
  Scrub("scrub to any frame", session, kStride, {});
  Scrub("any frame at another gap", session, kStride, {{name, middle_mm}});
  std::vector<double> times_ms;
  for (int i = 0; i < kGaps; ++i) {
    const double gap_mm = spacing.min_mm + (spacing.max_mm - spacing.min_mm) * i / (kGaps - 1);
    watch.LapMs();
    const double begin_ms = test_support::ProcessorMs();
    const WhatIf what_if = JudgeMotionAt(*session, {{{name, gap_mm}}}, {}, {});
    times_ms.push_back(watch.LapMs());
    fmt::print("  {} {:.1f} mm: {} touches, {} of {} answers kept, {:.0f} ms, of processor time {:.0f} ms\n",
               name, gap_mm, what_if.outcome.episodes.size(), what_if.answers_kept, what_if.answers,
               times_ms.back(), test_support::ProcessorMs() - begin_ms);
  }
  Tell("whole motion at another gap", std::move(times_ms));
  watch.LapMs();
  (void)FindNeededGap(*session, name, {}, {});
  fmt::print("needed gap: {:.0f} ms\n", watch.LapMs());
}

}  // namespace
}  // namespace elbowroom::control

int main(int argc, char** argv) {
  if (argc != 3) return fmt::print(stderr, "review_cost SESSION SPACING\n"), 2;
  try {
    elbowroom::control::Run(argv[1], argv[2]);
  } catch (const elbowroom::core::Error& error) {
    return fmt::print(stderr, "{}\n", error.what()), 1;
  }
  return 0;
}
