// The window, shown, with what its tests ask of it.
#pragma once

#include <gtest/gtest.h>

#include <QAction>
#include <QLabel>
#include <QSize>
#include <filesystem>
#include <string>

#include "app/console/main_window.h"
#include "tests/app/console/user_actions.h"
#include "tests/support/temporary_folder.h"

namespace elbowroom::console {

// A running trial is stopped, and waited for, at the end.
class WindowFixture : public testing::Test {
 protected:
  // Its first trial is recorded into a file of that name below `folder_`; "": in SessionsFolder().
  explicit WindowFixture(const std::string& session = "trial.db", QSize size = {1280, 720})
      : session_(session.empty() ? std::filesystem::path() : folder_ / session), window_(session_) {
    window_.resize(size);
    window_.show();
    QObject::connect(&window_.desk(), &TrialDesk::FrameArrived, &window_, [this](const FrameNews& news) {
      last_frame_ = news.result;
      ++frames_;
    });
  }
  ~WindowFixture() override {
    window_.desk().Stop();
    (void)WaitUntil([&] { return IsIdle(); });
  }

  template <typename Widget>
  Widget* Find(const QString& name) {
    auto* widget = window_.findChild<Widget*>(name);
    EXPECT_NE(widget, nullptr) << name.toStdString();
    return widget;
  }
  QAction& Action(const char* name) { return *Find<QAction>(name); }
  [[nodiscard]] bool IsIdle() { return window_.desk().state() == DeskState::kIdle; }
  [[nodiscard]] std::string Message() { return Find<QLabel>("message")->text().toStdString(); }
  void Activate() {
    window_.activateWindow();
    ASSERT_TRUE(QTest::qWaitForWindowActive(&window_));
  }
  void AwaitFrames(int more) {
    const int from = frames_;
    ASSERT_TRUE(WaitUntil([&] { return frames_ >= from + more; })) << Message();
  }
  void StopAndWait() {
    Action("stop").trigger();
    ASSERT_TRUE(WaitUntil([&] { return IsIdle(); }));
  }

  test_support::TemporaryFolder folder_;
  std::filesystem::path session_;
  MainWindow window_;
  control::SharedFrameResult last_frame_;  // null before the first
  int frames_ = 0;
};

}  // namespace elbowroom::console
