// Layout, trial or review: which of the window's pages is shown.
#pragma once

#include <QActionGroup>
#include <QByteArray>
#include <QList>
#include <QMainWindow>
#include <QPointer>
#include <QStackedWidget>
#include <QToolBar>
#include <vector>

namespace elbowroom::console {

enum class Page { kLayout, kTrial, kReview };

// A bar with a choice for each page. The trial page has the window's panels and other tool bars: they go when
// another page is shown, and come back as they were. Thread: UI.
class PageSwitch : public QToolBar {
  Q_OBJECT

 public:
  // `pages`: where a page is found by AddPage()'s widget.
  PageSwitch(QMainWindow* window, QStackedWidget* pages);

  void AddPage(Page page, const QString& title, const QString& tool_tip, QWidget* widget);

  // What stands beside the choices while the page is shown. The bar owns it from then on.
  void SetTools(Page page, QWidget* tools);

  // The trial page has several widgets, one at a time: before the first trial, before and after one with a
  // procedure, while one runs.
  void SetTrialWidget(QWidget* widget);
  [[nodiscard]] QWidget* trial_widget() { return ChoiceOf(Page::kTrial).widget; }

  void Show(Page page);
  [[nodiscard]] Page page() const { return page_; }

 private:
  struct Choice {
    Page page;
    QAction* action;
    QWidget* widget;
    QAction* tools = nullptr;
  };
  [[nodiscard]] Choice& ChoiceOf(Page page);
  void PutPanelsAway();
  void FitShownPage();
  void RestTrialKeys();

  QMainWindow* window_;
  QStackedWidget* pages_;
  QActionGroup* group_;
  std::vector<Choice> choices_;
  Page page_ = Page::kTrial;
  QList<QPointer<QAction>> resting_;  // whose keys are the trial page's alone
  QByteArray panels_;                 // of the trial page, while another one is shown
};

}  // namespace elbowroom::console
