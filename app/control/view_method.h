// Exact views, made in whichever of two ways this machine is faster at.
#pragma once

#include <functional>
#include <string>

#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {

// As recon::ViewHull without surfaces, and equal to it outside of recon::ViewBand; the last is one of its
// views that nobody needs any more, whose memory may be taken.
using MakeView =
    std::function<recon::HullView(const recon::VisualHull&, const recon::ViewRays&, recon::HullView)>;

// The processor's way: recon::ViewHull.
[[nodiscard]] MakeView ProcessorsViews();

enum class ViewMethod { kProcessor, kGraphics };

struct ViewChoice {
  ViewMethod method = ViewMethod::kProcessor;
  std::string line;         // for the log: method, ms each, driver
  bool is_warning = false;  // the graphics card failed, or drew something else
};

// What asks for the processor's place.
struct GraphicsContender {
  std::string driver;
  bool is_software = false;        // the processor again, with a detour: it isn't opened
  std::function<MakeView()> open;  // the view's owner lives and dies with the MakeView
};

// The graphics card as recon::gl::ExactViewGl draws on it. Thread: views are made and ended where it is
// opened.
[[nodiscard]] GraphicsContender GraphicsCard(std::string driver, bool is_software);

using NowMs = std::function<double()>;
[[nodiscard]] double SteadyNowMs();

// Both make the view once for practice and kViewRounds times against the clock, each time from a place a
// micrometre away, so that nothing of the last one can be kept; a first round that is lost by
// kLostBy ends it. The lesser median wins, if the two pictures agree (recon::CompareViews); if not, or if
// `graphics` throws core::Error, the processor does, with a warning.
inline constexpr int kViewRounds = 5;
inline constexpr double kLostBy = 2.0;
[[nodiscard]] ViewChoice ChooseViewMethod(const MakeView& processor, const MakeView& graphics,
                                          const std::string& driver, const recon::VisualHull& hull,
                                          const recon::ViewRays& rays, const NowMs& now_ms = SteadyNowMs);

// Makes views on the processor up to the first that shows some hull, chooses there, logs the choice and keeps
// to it; a graphics card that fails later is left for the processor, with a warning. Thread: one.
class ExactViewMaker {
 public:
  explicit ExactViewMaker(GraphicsContender contender, NowMs now_ms = SteadyNowMs);

  // `kept`: as MakeView's.
  [[nodiscard]] recon::HullView Make(const recon::VisualHull& hull, const recon::ViewRays& rays,
                                     recon::HullView kept = {});

  // So far.
  [[nodiscard]] ViewMethod method() const {
    return graphics_ == nullptr ? ViewMethod::kProcessor : ViewMethod::kGraphics;
  }

 private:
  void Choose(const recon::VisualHull& hull, const recon::ViewRays& rays);

  GraphicsContender contender_;
  NowMs now_ms_;
  bool has_chosen_ = false;
  MakeView graphics_;  // if it was chosen
};

}  // namespace elbowroom::control
