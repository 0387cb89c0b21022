#include "tests/app/console/window_soak.h"

#include <unistd.h>

#include <QApplication>
#include <QElapsedTimer>
#include <QMouseEvent>
#include <QTimer>
#include <atomic>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "app/console/main_window.h"
#include "app/control/demo_trial.h"
#include "tests/app/console/stall_watch.h"
#include "tests/support/resident_memory.h"

namespace elbowroom::console {
namespace {

// OpenGL has started and pools have grown by then.
constexpr double kWarmUpShare = 0.2;
// In the middle of the warm-up no frame comes for so long, and no gap is moved: the window draws what rests
// in full. Buffers of the largest picture are there before memory is counted, and a picture that becomes
// finer later, as the machine has more time, isn't taken for growth.
constexpr std::chrono::milliseconds kRest(1500);
constexpr QSize kView(1280, 720);
constexpr double kGapStepMm = 10.0;
constexpr double kRateHz = 30.0;

// Some seconds of another source's pictures over and over, as fast as is wanted. They are kept in memory:
// what a simulation of cameras costs isn't the window's.
class KeptFrames : public recon::FrameSetSource {
 public:
  KeptFrames(std::shared_ptr<recon::FrameSetSource> source, double rate_hz)
      : source_(std::move(source)), rate_hz_(rate_hz) {
    for (core::FrameIndex i = kFirstKept; i < kFirstKept + kKept; ++i) frames_.push_back(source_->Read(i));
  }
  const core::Rig& rig() const override { return source_->rig(); }
  std::optional<core::FrameIndex> frame_count() const override { return std::nullopt; }
  std::string WhatEndsIt() const override { return {}; }
  // No frames come for kRest.
  void Rest() { rests_ = true; }
  std::optional<recon::FrameSet> TryRead(core::FrameIndex index, std::stop_token /*stop*/) override {
    if (rests_.exchange(false)) std::this_thread::sleep_for(kRest);
    recon::FrameSet frames = frames_.at(static_cast<std::size_t>(index % kKept));
    frames.index = index;
    frames.time_s = static_cast<double>(index) / rate_hz_;
    return frames;
  }
  std::vector<recon::BackgroundReference> ReadBackgrounds(const core::Progress& progress,
                                                          std::stop_token stop) override {
    return source_->ReadBackgrounds(progress, std::move(stop));
  }

 private:
  static constexpr core::FrameIndex kFirstKept = 30, kKept = 120;  // the hand is there in all of them
  std::shared_ptr<recon::FrameSetSource> source_;
  double rate_hz_;
  std::vector<recon::FrameSet> frames_;
  std::atomic<bool> rests_ = false;
};

class Soak {
 public:
  explicit Soak(const WindowSoakPlan& plan) : plan_(plan) {
    frames_ = std::make_shared<KeptFrames>(setup_.source, kRateHz * plan.speed);
    setup_.source = frames_;
    since_start_.start();
    window_ = std::make_unique<MainWindow>();
    FollowWindow();
  }

  WindowSoakResult Run() {
    window_->resize(1760, 1040);
    window_->show();
    window_->desk().Start([this](const std::stop_token&) { return std::move(setup_); }, plan_.session);
    QApplication::exec();
    return std::move(result_);
  }

 private:
  void FollowWindow() {
    QObject::connect(&window_->desk(), &TrialDesk::Failed, window_.get(), [this](const QString& line) {
      result_.error = line.toStdString();
      window_->close();
    });
    QObject::connect(&window_->view(), &OperatorView::PictureShown, window_.get(),
                     [this](qint64, double drawing_ms) { TakePicture(drawing_ms); });
    QObject::connect(&window_->desk(), &TrialDesk::FrameArrived, window_.get(),
                     [this](const FrameNews& news) {
                       frame_ = news.result->record.frame;
                       if (!std::exchange(has_begun_, true)) Begin(*news.result);
                     });
  }

  // A simulated second is 1 / speed of a second.
  std::chrono::milliseconds Simulated(double seconds) const {
    return std::chrono::milliseconds(static_cast<int>(1000.0 * seconds / plan_.speed));
  }

  void Begin(const control::FrameResult& first) {
    window_->resize(window_->size() + kView - window_->view().size());
    const core::Spacing& spacing = first.layout->spacings.front();
    spacing_ = spacing.name;
    between_mm_ = {spacing.initial_mm, spacing.initial_mm + kGapStepMm};
    QObject::connect(&gaps_, &QTimer::timeout, window_.get(), [this] { MoveGap(); });
    QObject::connect(&tools_, &QTimer::timeout, window_.get(),
                     [this] { window_->desk().MarkTool("tongs", (has_tool_ = !has_tool_)); });
    gaps_.start(Simulated(0.5));
    tools_.start(Simulated(5.0));
    const double warm_up_s = kWarmUpShare * plan_.simulated_s;
    QTimer::singleShot(Simulated(warm_up_s / 2), window_.get(), [this] { Rest(); });
    QTimer::singleShot(Simulated(warm_up_s) + kRest, window_.get(), [this] { Measure(); });
  }

  void Rest() {
    gaps_.stop();
    frames_->Rest();
    QTimer::singleShot(kRest, window_.get(), [this] { gaps_.start(); });
  }

  void MoveGap() {
    window_->desk().SetSpacing(spacing_, (is_wide_ = !is_wide_) ? between_mm_.second : between_mm_.first);
    if (!plan_.turns_eye) return;
    auto& view = window_->view();
    QMouseEvent press(QEvent::MouseButtonPress, QPointF(600, 300), view.mapToGlobal(QPointF(600, 300)),
                      Qt::LeftButton, Qt::LeftButton, {});
    const QPointF to(is_wide_ ? 610 : 590, 300);
    QMouseEvent move(QEvent::MouseMove, to, view.mapToGlobal(to), Qt::NoButton, Qt::LeftButton, {});
    QApplication::sendEvent(&view, &press);
    QApplication::sendEvent(&view, &move);
  }

  void Measure() {
    // What the lists need at most is there before the memory is counted.
    for (auto* list : {&result_.between_pictures_ms, &result_.drawing_ms}) list->resize(100'000);
    for (auto* list : {&result_.between_pictures_ms, &result_.drawing_ms}) list->clear();
    watch_.emplace();
    watch_->KeepWaits(400'000);
    first_frame_ = frame_;
    since_picture_.invalidate();
    since_begin_.start();
    result_.resident_bytes.reserve(10'000);
    QObject::connect(&memory_, &QTimer::timeout, window_.get(), [this] {
      result_.resident_bytes.push_back(static_cast<double>(test_support::ResidentBytes(::getpid())));
    });
    memory_.start(std::chrono::milliseconds(500));
    QTimer::singleShot(Simulated((1.0 - kWarmUpShare) * plan_.simulated_s), window_.get(),
                       [this] { Finish(); });
  }

  void TakePicture(double drawing_ms) {
    if (result_.first_picture_ms == 0.0)
      result_.first_picture_ms = 1e-6 * static_cast<double>(since_start_.nsecsElapsed());
    if (!watch_) return;
    result_.drawing_ms.push_back(drawing_ms);
    if (since_picture_.isValid())
      result_.between_pictures_ms.push_back(1e-6 * static_cast<double>(since_picture_.nsecsElapsed()));
    since_picture_.start();
  }

  void Finish() {
    memory_.stop();
    result_.seconds = 1e-3 * static_cast<double>(since_begin_.elapsed());
    result_.frames = frame_ - first_frame_;
    result_.ui_waits_ms = watch_->TakeWaits();
    watch_.reset();
    result_.widest_px = window_->view().width();
    result_.highest_px = window_->view().height();
    result_.driver = window_->view().driver().toStdString();
    gaps_.stop();
    tools_.stop();
    window_->close();
  }

  WindowSoakPlan plan_;
  control::TrialSetup setup_ = control::MakeDemoTrial(control::DemoPlay::kForever);
  std::shared_ptr<KeptFrames> frames_;
  std::unique_ptr<MainWindow> window_;
  QTimer gaps_, tools_, memory_;
  WindowSoakResult result_;
  std::optional<StallWatch> watch_;
  QElapsedTimer since_start_, since_picture_, since_begin_;
  core::FrameIndex frame_ = 0, first_frame_ = 0;
  std::string spacing_;
  std::pair<double, double> between_mm_;
  bool has_begun_ = false, is_wide_ = false, has_tool_ = false;
};

}  // namespace

WindowSoakResult SoakWindow(const WindowSoakPlan& plan) { return Soak(plan).Run(); }

}  // namespace elbowroom::console
