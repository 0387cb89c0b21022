// Who makes the exact view, with contenders that are slow, fast, wrong or broken to order.
#include "app/control/view_method.h"

#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "core/error.h"
#include "recon/exact_view/view_comparison.h"
#include "recon/gl/exact_view/exact_view_gl.h"
#include "recon/hull/visual_hull.h"
#include "recon/synthetic/view_scene.h"

namespace elbowroom::control {
namespace {

using recon::HullView;
using recon::ViewRays;
using recon::VisualHull;

struct HandScene {
  VisualHull hull;
  ViewRays rays;
};

const HandScene& Hand() {
  static const HandScene scene = [] {
    const recon::ViewScene made = recon::MakeViewScene(recon::ViewSceneRig::kThree, 160, 120);
    return HandScene{recon::MakeVisualHull(std::make_shared<const core::Rig>(made.rig),
                                           recon::TrueMasks(made.rig, made.objects)),
                     ViewRays(made.view)};
  }();
  return scene;
}

VisualHull NoHull() {
  std::vector<core::BitMask> masks;
  for (const core::CameraModel& camera : Hand().hull.rig().cameras)
    masks.emplace_back(camera.width_px(), camera.height_px());
  return recon::MakeVisualHull(Hand().hull.shared_rig(), masks);
}

// A clock that only the contenders move.
class Stage {
 public:
  [[nodiscard]] MakeView Taking(double ms, int* views, MakeView make = ProcessorsViews()) {
    return [this, ms, views, make = std::move(make)](const VisualHull& hull, const ViewRays& rays,
                                                     HullView kept) {
      now_ms_ += ms;
      ++*views;
      return make(hull, rays, std::move(kept));
    };
  }
  [[nodiscard]] ViewChoice Choose(double processor_ms, double graphics_ms,
                                  const MakeView& graphics = ProcessorsViews()) {
    return ChooseViewMethod(Taking(processor_ms, &processor_views),
                            Taking(graphics_ms, &graphics_views, graphics), "a driver", Hand().hull,
                            Hand().rays, [this] { return now_ms_; });
  }
  int processor_views = 0;
  int graphics_views = 0;

 private:
  double now_ms_ = 100.0;
};

HullView WithoutTheHand(const VisualHull& hull, const ViewRays& rays, const HullView&) {
  HullView view = recon::ViewHull(hull, rays);
  view.depth_mm.assign(view.depth_mm.size(), 0.0F);
  return view;
}

HullView Broken(const VisualHull&, const ViewRays&, const HullView&) {
  throw core::Error(core::ErrorKind::kGraphics, "out of graphics memory");
}

// What spdlog's default logger is told while it lives.
class LogLines {
 public:
  LogLines() : before_(spdlog::default_logger()) {
    auto logger = std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(text_, /*force_flush=*/true));
    logger->set_pattern("%l: %v");
    spdlog::set_default_logger(std::move(logger));
  }
  ~LogLines() { spdlog::set_default_logger(before_); }
  LogLines(const LogLines&) = delete;
  LogLines& operator=(const LogLines&) = delete;
  [[nodiscard]] std::string text() const { return text_.str(); }

 private:
  std::ostringstream text_;
  std::shared_ptr<spdlog::logger> before_;
};

TEST(ChooseViewMethod, TheFasterOneWins) {
  Stage stage;
  const ViewChoice choice = stage.Choose(3.0, 2.0);
  EXPECT_EQ(choice.method, ViewMethod::kGraphics);
  EXPECT_FALSE(choice.is_warning);
  EXPECT_EQ(choice.line, "exact view: by OpenGL: processor 3.00 ms, OpenGL 2.00 ms (a driver)");
  EXPECT_EQ(stage.graphics_views, 1 + kViewRounds);
}

TEST(ChooseViewMethod, ASlowerOneLosesWithoutAWarning) {
  Stage stage;
  const ViewChoice choice = stage.Choose(2.0, 3.0);
  EXPECT_EQ(choice.method, ViewMethod::kProcessor);
  EXPECT_FALSE(choice.is_warning);
  EXPECT_EQ(choice.line, "exact view: by the processor: processor 2.00 ms, OpenGL 3.00 ms (a driver)");
  EXPECT_EQ(stage.graphics_views, 1 + kViewRounds);
}

TEST(ChooseViewMethod, ALostContestEndsWithItsFirstRound) {
  Stage stage;
  EXPECT_EQ(stage.Choose(1.0, 1.01 * kLostBy).method, ViewMethod::kProcessor);
  EXPECT_EQ(stage.graphics_views, 2);
  EXPECT_EQ(stage.processor_views, 2);
}

TEST(ChooseViewMethod, AnotherPictureIsAWarning) {
  const ViewChoice choice = Stage().Choose(3.0, 2.0, WithoutTheHand);
  EXPECT_EQ(choice.method, ViewMethod::kProcessor);
  EXPECT_TRUE(choice.is_warning);
  EXPECT_NE(choice.line.find("another picture"), std::string::npos) << choice.line;
}

TEST(ChooseViewMethod, AnErrorIsAWarning) {
  const ViewChoice choice = Stage().Choose(3.0, 2.0, Broken);
  EXPECT_EQ(choice.method, ViewMethod::kProcessor);
  EXPECT_TRUE(choice.is_warning);
  EXPECT_NE(choice.line.find("out of graphics memory"), std::string::npos) << choice.line;
}

TEST(ExactViewMaker, ASoftwareDriverIsNotOpened) {
  const LogLines log;
  ExactViewMaker maker({"soft", true, []() -> MakeView {
                          ADD_FAILURE() << "opened";
                          return ProcessorsViews();
                        }});
  EXPECT_GT(maker.Make(Hand().hull, Hand().rays).hit_pixels, 0);
  EXPECT_EQ(maker.method(), ViewMethod::kProcessor);
  EXPECT_EQ(log.text(), "info: exact view: by the processor, as OpenGL is software (soft)\n");
}

TEST(ExactViewMaker, ADriverThatDoesNotOpenIsAWarning) {
  const LogLines log;
  ExactViewMaker maker(
      {"shut", false, []() -> MakeView { throw core::Error(core::ErrorKind::kGraphics, "no shader"); }});
  EXPECT_GT(maker.Make(Hand().hull, Hand().rays).hit_pixels, 0);
  EXPECT_EQ(maker.method(), ViewMethod::kProcessor);
  EXPECT_EQ(log.text(), "warning: exact view: by the processor, as OpenGL failed (shut): no shader\n");
}

TEST(ExactViewMaker, ChoosesOnceAtTheFirstViewWithSomethingInIt) {
  const LogLines log;
  int opened = 0;
  ExactViewMaker maker({"slow", false, [&opened] {
                          ++opened;
                          return MakeView(WithoutTheHand);
                        }});
  EXPECT_EQ(maker.Make(NoHull(), Hand().rays).hit_pixels, 0);
  EXPECT_EQ(opened, 0);
  EXPECT_EQ(log.text(), "");
  const HullView expected = recon::ViewHull(Hand().hull, Hand().rays);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(maker.Make(Hand().hull, Hand().rays).depth_mm, expected.depth_mm);
  EXPECT_EQ(opened, 1);
}

TEST(ExactViewMaker, AGraphicsCardThatFailsLaterIsLeft) {
  const LogLines log;
  double now_ms = 0.0;
  bool is_broken = false;
  MakeView graphics = [&](const VisualHull& hull, const ViewRays& rays, const HullView& kept) {
    now_ms -= 1.0;  // a clock that runs back lets the contender win on any machine
    return is_broken ? Broken(hull, rays, kept) : recon::ViewHull(hull, rays);
  };
  ExactViewMaker maker({"card", false, [&] { return graphics; }}, [&] { return now_ms; });
  (void)maker.Make(Hand().hull, Hand().rays);
  EXPECT_EQ(maker.method(), ViewMethod::kGraphics);
  const double before_ms = now_ms;
  (void)maker.Make(Hand().hull, Hand().rays);
  EXPECT_EQ(now_ms, before_ms - 1.0);  // by the card alone
  is_broken = true;
  for (int i = 0; i < 2; ++i) EXPECT_GT(maker.Make(Hand().hull, Hand().rays).hit_pixels, 0);
  EXPECT_EQ(maker.method(), ViewMethod::kProcessor);
  EXPECT_EQ(log.text(),
            "info: exact view: by OpenGL: processor 0.00 ms, OpenGL -1.00 ms (card)\n"
            "warning: exact view: by the processor, as OpenGL failed (card): out of graphics memory\n");
}

// Software or not: whoever wins, nothing is amiss, and the picture is right.
TEST(ExactViewMaker, TheDriverAtHandStandsTheContest) {
  const LogLines log;
  ExactViewMaker maker(GraphicsCard("the driver at hand", false));
  const HullView cpu = recon::ViewHull(Hand().hull, Hand().rays);
  for (int i = 0; i < 2; ++i) {
    const HullView view = maker.Make(Hand().hull, Hand().rays);
    EXPECT_TRUE(recon::CompareViews(Hand().hull, Hand().rays, cpu, view).Agree());
  }
  EXPECT_TRUE(log.text().starts_with("info: exact view: by ")) << log.text();
  EXPECT_TRUE(log.text().ends_with("(the driver at hand)\n")) << log.text();
}

TEST(ExactViewMaker, OnTheCardAtHandPicturesAreTheProcessorsOutsideTheBand) {
  const MakeView card = GraphicsCard("the driver at hand", false).open();
  const HullView cpu = ProcessorsViews()(Hand().hull, Hand().rays, {});
  const HullView gl = card(Hand().hull, Hand().rays, {});
  EXPECT_TRUE(recon::CompareViews(Hand().hull, Hand().rays, cpu, gl).Agree());
  EXPECT_EQ(gl.normal_in_world.size(), cpu.normal_in_world.size());
  EXPECT_EQ(gl.surface.size(), cpu.surface.size());
}

}  // namespace
}  // namespace elbowroom::control
