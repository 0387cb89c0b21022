#include "app/control/view_method.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <utility>

#include "core/error.h"
#include "recon/exact_view/view_comparison.h"
#include "recon/gl/exact_view/exact_view_gl.h"

namespace elbowroom::control {
namespace {

// The operator's picture needs depths and normals, but no surfaces.
constexpr recon::HullViewOptions kNoSurfaces{.surfaces = false};

constexpr double kStepMm = 1e-3;  // the picture looks the same, but must be computed anew

using Times = std::array<double, kViewRounds>;

double Median(Times times_ms, int rounds) {
  const auto middle = times_ms.begin() + rounds / 2;
  std::nth_element(times_ms.begin(), middle, times_ms.begin() + rounds);
  return *middle;
}

recon::ViewRays Beside(const recon::ViewRays& rays) {
  core::RigidTransform view_from_world = rays.view_from_world();
  view_from_world.translation_mm.x() += kStepMm;
  return rays.From(view_from_world);
}

struct Contest {
  double processor_ms = 0.0;
  double graphics_ms = 0.0;
  bool agree = true;  // looked at only if the graphics card is faster

  [[nodiscard]] bool IsWon() const { return graphics_ms < processor_ms && agree; }
};

Contest Hold(const MakeView& processor, const MakeView& graphics, const recon::VisualHull& hull,
             const recon::ViewRays& rays, const NowMs& now_ms) {
  const std::array<recon::ViewRays, 2> places = {rays, Beside(rays)};
  recon::HullView by_processor, by_graphics;
  const auto time = [&](const MakeView& make, int round, recon::HullView* view) {
    const double begin_ms = now_ms();
    *view = make(hull, places[static_cast<std::size_t>(round % 2)], std::move(*view));
    return now_ms() - begin_ms;
  };
  (void)time(processor, 0, &by_processor);
  (void)time(graphics, 0, &by_graphics);
  Times processor_ms{}, graphics_ms{};
  int round = 0;
  while (round < kViewRounds) {
    const auto at = static_cast<std::size_t>(round);
    ++round;
    processor_ms[at] = time(processor, round, &by_processor);
    graphics_ms[at] = time(graphics, round, &by_graphics);
    if (round == 1 && graphics_ms[0] > kLostBy * processor_ms[0]) break;
  }
  Contest contest{Median(processor_ms, round), Median(graphics_ms, round)};
  if (contest.graphics_ms < contest.processor_ms) {
    const recon::ViewRays& last = places[static_cast<std::size_t>(round % 2)];
    contest.agree = recon::CompareViews(hull, last, by_processor, by_graphics).Agree();
  }
  return contest;
}

ViewChoice Failed(const std::string& driver, const std::string& why) {
  return {ViewMethod::kProcessor,
          fmt::format("exact view: by the processor, as OpenGL failed ({}): {}", driver, why), true};
}

void Log(const ViewChoice& choice) {
  spdlog::log(choice.is_warning ? spdlog::level::warn : spdlog::level::info, "{}", choice.line);
}

}  // namespace

MakeView ProcessorsViews() {
  return [](const recon::VisualHull& hull, const recon::ViewRays& rays, recon::HullView kept) {
    return recon::ViewHull(hull, rays, kNoSurfaces, std::move(kept));
  };
}

GraphicsContender GraphicsCard(std::string driver, bool is_software) {
  return {std::move(driver), is_software, [] {
            return [card = std::make_shared<recon::gl::ExactViewGl>()](
                       const recon::VisualHull& hull, const recon::ViewRays& rays, const recon::HullView&) {
              return card->ViewHull(hull, rays, kNoSurfaces);
            };
          }};
}

double SteadyNowMs() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

ViewChoice ChooseViewMethod(const MakeView& processor, const MakeView& graphics, const std::string& driver,
                            const recon::VisualHull& hull, const recon::ViewRays& rays, const NowMs& now_ms) {
  try {
    const Contest contest = Hold(processor, graphics, hull, rays, now_ms);
    const std::string times = fmt::format("processor {:.2f} ms, OpenGL {:.2f} ms ({})", contest.processor_ms,
                                          contest.graphics_ms, driver);
    if (!contest.agree) {
      return {
          ViewMethod::kProcessor,
          fmt::format("exact view: by the processor, as OpenGL draws another picture; update the driver: {}",
                      times),
          true};
    }
    return {contest.IsWon() ? ViewMethod::kGraphics : ViewMethod::kProcessor,
            fmt::format("exact view: by {}: {}", contest.IsWon() ? "OpenGL" : "the processor", times), false};
  } catch (const core::Error& error) {  // a card that can't draw isn't an error here
    return Failed(driver, error.what());
  }
}

ExactViewMaker::ExactViewMaker(GraphicsContender contender, NowMs now_ms)
    : contender_(std::move(contender)), now_ms_(std::move(now_ms)) {
  if (!contender_.is_software) return;
  has_chosen_ = true;
  Log({ViewMethod::kProcessor,
       fmt::format("exact view: by the processor, as OpenGL is software ({})", contender_.driver), false});
}

recon::HullView ExactViewMaker::Make(const recon::VisualHull& hull, const recon::ViewRays& rays,
                                     recon::HullView kept) {
  if (graphics_ != nullptr) {
    try {
      return graphics_(hull, rays, {});
    } catch (const core::Error& error) {  // the processor makes the view instead
      graphics_ = nullptr;
      Log(Failed(contender_.driver, error.what()));
    }
  }
  recon::HullView view = recon::ViewHull(hull, rays, kNoSurfaces, std::move(kept));
  if (!has_chosen_ && view.hit_pixels > 0) Choose(hull, rays);
  return view;
}

void ExactViewMaker::Choose(const recon::VisualHull& hull, const recon::ViewRays& rays) {
  has_chosen_ = true;
  ViewChoice choice;
  MakeView graphics;
  try {
    graphics = contender_.open();
    choice = ChooseViewMethod(ProcessorsViews(), graphics, contender_.driver, hull, rays, now_ms_);
  } catch (const core::Error& error) {  // as above
    choice = Failed(contender_.driver, error.what());
  }
  if (choice.method == ViewMethod::kGraphics) graphics_ = std::move(graphics);
  Log(choice);
}

}  // namespace elbowroom::control
