#include "app/console/page_switch.h"

#include <QDockWidget>
#include <QShortcut>
#include <algorithm>
#include <utility>

namespace elbowroom::console {

PageSwitch::PageSwitch(QMainWindow* window, QStackedWidget* pages)
    : QToolBar(tr("Pages"), window), window_(window), pages_(pages), group_(new QActionGroup(this)) {
  connect(pages_, &QStackedWidget::currentChanged, this, &PageSwitch::FitShownPage);
  setObjectName("pages_bar");
  setMovable(false);
  toggleViewAction()->setVisible(false);  // without it there is no way back
}

void PageSwitch::AddPage(Page page, const QString& title, const QString& tool_tip, QWidget* widget) {
  QAction* action = addAction(title);
  action->setObjectName(widget->objectName() + "_page");
  action->setToolTip(tool_tip);
  action->setCheckable(true);
  action->setChecked(page == page_);
  action->setShortcut(QKeySequence(Qt::CTRL | (Qt::Key_1 + static_cast<int>(choices_.size()))));
  group_->addAction(action);
  connect(action, &QAction::triggered, this, [this, page] { Show(page); });
  choices_.push_back({page, action, widget});
  pages_->addWidget(widget);
  FitShownPage();
}

void PageSwitch::SetTools(Page page, QWidget* tools) {
  QAction* action = addWidget(tools);
  action->setVisible(page == page_);
  ChoiceOf(page).tools = action;
}

void PageSwitch::SetTrialWidget(QWidget* widget) {
  pages_->addWidget(widget);
  FitShownPage();
  ChoiceOf(Page::kTrial).widget = widget;
  if (page_ == Page::kTrial) pages_->setCurrentWidget(widget);
}

void PageSwitch::Show(Page page) {
  if (page == page_) return;
  if (page_ == Page::kTrial) {
    PutPanelsAway();
    RestTrialKeys();
  }
  page_ = page;
  if (page == Page::kTrial) {
    window_->restoreState(std::exchange(panels_, {}));
    for (const QPointer<QAction>& action : std::exchange(resting_, {}))
      if (action) action->setShortcutContext(Qt::WindowShortcut);
  }
  for (QShortcut* shortcut : window_->findChildren<QShortcut*>(QString(), Qt::FindDirectChildrenOnly))
    shortcut->setEnabled(page == Page::kTrial);
  for (const Choice& choice : choices_)
    if (choice.tools != nullptr) choice.tools->setVisible(choice.page == page);
  ChoiceOf(page).action->setChecked(true);
  pages_->setCurrentWidget(ChoiceOf(page).widget);
}

// A key without Ctrl, and those that take a gap back, are the trial's: another page's user doesn't mean them.
void PageSwitch::RestTrialKeys() {
  for (QAction* action : window_->findChildren<QAction*>()) {
    if (action->shortcut().isEmpty() || action->shortcutContext() != Qt::WindowShortcut) continue;
    const QKeyCombination key = action->shortcut()[0];
    const bool is_plain = !key.keyboardModifiers().testFlag(Qt::ControlModifier);
    const bool is_for_all = key.key() == Qt::Key_F11 || key.key() == Qt::Key_F;  // full screen, fit
    const bool takes_gap_back = action->objectName() == "undo_gap" || action->objectName() == "redo_gap";
    if (!(is_plain && !is_for_all) && !takes_gap_back) continue;
    action->setShortcutContext(Qt::WidgetShortcut);
    resting_.append(action);
  }
}

// A page that isn't shown takes no room.
void PageSwitch::FitShownPage() {
  for (int i = 0; i < pages_->count(); ++i) {
    const QSizePolicy::Policy policy =
        i == pages_->currentIndex() ? QSizePolicy::Preferred : QSizePolicy::Ignored;
    pages_->widget(i)->setSizePolicy(policy, policy);
  }
}

PageSwitch::Choice& PageSwitch::ChoiceOf(Page page) {
  return *std::ranges::find(choices_, page, &Choice::page);
}

void PageSwitch::PutPanelsAway() {
  panels_ = window_->saveState();
  for (auto* dock : window_->findChildren<QDockWidget*>()) dock->hide();
  for (auto* bar : window_->findChildren<QToolBar*>())
    if (bar != this) bar->hide();
}

}  // namespace elbowroom::console
