// Exact views by the processor or the graphics card, whichever is faster on this machine.
#pragma once

#include <functional>
#include <string>

#include "recon/exact_view/hull_view.h"
#include "recon/exact_view/view_rays.h"
#include "recon/hull/visual_hull_declared.h"

namespace elbowroom::control {

// Makes the view of recon::ViewHull without surfaces, and equal to it outside of recon::ViewBand. The last
// argument is one of its views that isn't needed any more, whose memory may be taken.
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

// The graphics card, which is compared with the processor.
struct GraphicsContender {
  std::string driver;
  bool is_software = false;        // OpenGL by the processor, which gains nothing: it isn't opened
  std::function<MakeView()> open;  // the MakeView owns what it draws with
};

// The graphics card with recon::gl::ExactViewGl. Thread: views are made, and the MakeView is destroyed, where
// it was opened.
[[nodiscard]] GraphicsContender GraphicsCard(std::string driver, bool is_software);

using NowMs = std::function<double()>;
[[nodiscard]] double SteadyNowMs();

// Both make the view once as a warm-up, and then kViewRounds times, which are timed. Each view is from a
// place a micrometre beside the last, so that nothing of that can be used again. If `graphics` takes more
// than kLostBy times as long in the first round, the rest is left out. The smaller median wins, if the two
// pictures agree (recon::CompareViews). If they don't, or if `graphics` throws core::Error, the processor
// wins, with a warning.
inline constexpr int kViewRounds = 5;
inline constexpr double kLostBy = 2.0;
[[nodiscard]] ViewChoice ChooseViewMethod(const MakeView& processor, const MakeView& graphics,
                                          const std::string& driver, const recon::VisualHull& hull,
                                          const recon::ViewRays& rays, const NowMs& now_ms = SteadyNowMs);

// Makes views on the processor up to the first that shows some hull. With that hull it chooses, logs the
// choice and keeps to it. When the graphics card fails later, the processor takes its place, with a warning.
// Thread: one.
class ExactViewMaker {
 public:
  explicit ExactViewMaker(GraphicsContender contender, NowMs now_ms = SteadyNowMs);

  // `kept`: as MakeView's.
  [[nodiscard]] recon::HullView Make(const recon::VisualHull& hull, const recon::ViewRays& rays,
                                     recon::HullView kept = {});

  // The method in use at present.
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
