// The page on which a recorded session is gone through.
#pragma once

#include <QElapsedTimer>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QScrollArea>
#include <QStackedWidget>
#include <QString>
#include <QTimer>
#include <QToolButton>
#include <QWidget>
#include <filesystem>

#include "app/console/reviews/finding_panel.h"
#include "app/console/reviews/remark_panel.h"
#include "app/console/reviews/review_desk.h"
#include "app/console/reviews/timeline_view.h"
#include "app/console/reviews/what_if_panel.h"
#include "app/console/sights/part_picker.h"
#include "app/console/sights/section_tool.h"
#include "app/console/view/hull_look_button.h"
#include "app/console/view/message_bar.h"
#include "app/console/view/operator_view.h"

namespace elbowroom::console {

// Left and Right go a frame back and on, Page Up and Page Down to the touch before and the next, Home and End
// to the first frame and the last, Space plays at the recorded pace. Thread: UI.
class ReviewPage : public QWidget {
  Q_OBJECT

 public:
  explicit ReviewPage(QWidget* parent = nullptr);
  ~ReviewPage() override;

  // Reads a session on a worker and shows it.
  void Open(const std::filesystem::path& session);
  // Asks for the file first.
  void AskForSession();
  void Fit();  // everything in the picture

  [[nodiscard]] ReviewDesk& desk() { return *desk_; }
  // What can be done with the session, for the window's tool bar; nothing is seen of it before the first one.
  [[nodiscard]] QWidget* actions() const { return actions_; }
  [[nodiscard]] OperatorView* view() { return view_; }  // null before the first session

 signals:
  void Failed(const QString& line);  // beside the page; what the page can show itself, it does

 protected:
  void changeEvent(QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  [[nodiscard]] QWidget* MakeSessionPage();
  [[nodiscard]] QLayout* MakeHeader();
  [[nodiscard]] QLayout* MakeTransport();
  [[nodiscard]] QLayout* MakeJobLine();
  QPushButton* AddButton(QLayout* row, const char* name, const QString& text, const QString& tip);
  void FollowDesk();
  void FollowPanels();
  void MakeView();
  void ShowSession();
  void MakeActions();
  void ShowFrame(const control::ScrubbedFrame& frame);
  void ShowFindings();
  void ShowHeat(const control::SharedHeatLayer& heat);
  void ShowWhatIf();
  void ShowState();
  void ShowProgress(qint64 done, qint64 total, const QString& what);
  void GoToFinding(std::size_t finding);
  void Step(int frames);
  void StepToFinding(int step);
  void Play(bool plays);
  void TakeIcons();  // in the text's colour
  void PlayOn();
  void AskForBcf(bool out);
  void AskForKeepOut();

  ReviewDesk* desk_;
  MessageBar* messages_;
  QStackedWidget* stack_;
  QWidget* session_page_;
  OperatorView* view_ = nullptr;
  QWidget* actions_ = nullptr;
  QWidget* buttons_ = nullptr;
  QLabel* title_ = nullptr;
  QLabel* facts_ = nullptr;
  QLabel* time_ = nullptr;
  QToolButton* before_ = nullptr;
  QToolButton* play_ = nullptr;
  QToolButton* next_ = nullptr;
  QVBoxLayout* view_column_ = nullptr;
  QScrollArea* timeline_area_ = nullptr;
  QPushButton* section_button_ = nullptr;
  QPushButton* heat_button_ = nullptr;
  HullLookButton* hull_look_ = nullptr;
  SectionPanel* section_ = nullptr;
  FindingPanel* findings_ = nullptr;
  RemarkPanel* remarks_ = nullptr;
  WhatIfPanel* what_if_ = nullptr;
  TimelineView* timeline_ = nullptr;
  QWidget* job_line_ = nullptr;
  QLabel* job_text_ = nullptr;
  QProgressBar* job_progress_ = nullptr;
  std::vector<QPushButton*> job_buttons_;
  QTimer player_;
  QElapsedTimer playing_;
  double played_from_s_ = 0.0;
};

}  // namespace elbowroom::console
