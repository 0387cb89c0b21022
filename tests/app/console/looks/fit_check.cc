#include "tests/app/console/looks/fit_check.h"

#include <QAbstractButton>
#include <QAbstractItemDelegate>
#include <QAbstractItemView>
#include <QAbstractScrollArea>
#include <QAbstractSpinBox>
#include <QComboBox>
#include <QCoreApplication>
#include <QDockWidget>
#include <QGroupBox>
#include <QHeaderView>
#include <QLabel>
#include <QLineEdit>
#include <QListView>
#include <QMainWindow>
#include <QProgressBar>
#include <QScrollBar>
#include <QSplitterHandle>
#include <QStyleOptionComboBox>
#include <QStyleOptionSpinBox>
#include <QTabBar>
#include <QTableView>
#include <QTreeView>
#include <algorithm>
#include <vector>

namespace elbowroom::console {
namespace {

constexpr int kRoundingPx = 1;  // of positions and sizes that were scaled

// "QPushButton 'review_open' of 'review'", with its text.
QString NameOf(const QWidget& widget) {
  QString name = QString("%1 '%2'").arg(widget.metaObject()->className(), widget.objectName());
  for (const QWidget* above = widget.parentWidget(); above != nullptr; above = above->parentWidget()) {
    if (above->objectName().isEmpty() || above->objectName().startsWith("qt_")) continue;
    return name + QString(" in '%1'").arg(above->objectName());
  }
  return name;
}

class Faults {
 public:
  void Add(const QWidget& widget, const QString& what) { lines_ << NameOf(widget) + ": " + what; }
  // A text of that width, in pixels.
  void Need(const QWidget& widget, const QString& text, int wanted_px, int has_px) {
    if (wanted_px > has_px + kRoundingPx)
      Add(widget, QString("'%1' needs %2 px and has %3").arg(text).arg(wanted_px).arg(has_px));
  }
  [[nodiscard]] QStringList lines() const { return lines_; }

 private:
  QStringList lines_;
};

int Advance(const QWidget& widget, const QString& text) {
  return widget.fontMetrics().size(Qt::TextShowMnemonic, text).width();
}

void CheckLabel(const QLabel& label, Faults* faults) {
  if (label.text().isEmpty()) return;
  // Without one the sign before a key is shown.
  if (label.buddy() == nullptr && label.textFormat() != Qt::PlainText && label.text().contains('&'))
    faults->Add(label, QString("'%1' has no buddy").arg(label.text()));
  if (!label.wordWrap()) faults->Need(label, label.text(), label.sizeHint().width(), label.width());
  const int wanted_px = label.wordWrap() ? label.heightForWidth(label.width()) : label.sizeHint().height();
  if (wanted_px > label.height() + kRoundingPx)
    faults->Add(
        label, QString("'%1' is %2 px high and has %3").arg(label.text()).arg(wanted_px).arg(label.height()));
}

// Fusion's least width of a button isn't its text's.
void CheckButton(const QAbstractButton& button, Faults* faults) {
  if (button.text().isEmpty()) return;
  const int icon_px = button.icon().isNull() ? 0 : button.iconSize().width() + 4;
  const int wanted_px = Advance(button, button.text()) + icon_px + 8;
  faults->Need(button, button.text(), std::min(wanted_px, button.sizeHint().width()), button.width());
  if (button.height() < button.fontMetrics().height() + 2)
    faults->Add(button, QString("is %1 px high").arg(button.height()));
}

void CheckCombo(const QComboBox& box, Faults* faults) {
  QStyleOptionComboBox option;
  option.initFrom(&box);
  option.editable = box.isEditable();
  const int has_px =
      box.style()->subControlRect(QStyle::CC_ComboBox, &option, QStyle::SC_ComboBoxEditField, &box).width();
  faults->Need(box, box.currentText(), Advance(box, box.currentText()), has_px);
}

void CheckSpinBox(const QAbstractSpinBox& box, Faults* faults) {
  const auto* line = box.findChild<QLineEdit*>();
  constexpr int kLineMarginPx = 4;  // QLineEdit's own, on both sides
  if (line != nullptr)
    faults->Need(box, line->text(), Advance(*line, line->text()) + kLineMarginPx, line->width());
}

void CheckLine(const QLineEdit& line, Faults* faults) {
  if (qobject_cast<const QAbstractSpinBox*>(line.parentWidget()) != nullptr) return;
  if (qobject_cast<const QComboBox*>(line.parentWidget()) != nullptr) return;
  constexpr int kFramePx = 12;
  if (line.text().isEmpty())
    faults->Need(line, line.placeholderText(), Advance(line, line.placeholderText()) + kFramePx,
                 line.width());
}

void CheckTabs(const QTabBar& tabs, Faults* faults) {
  for (int i = 0; i < tabs.count(); ++i)
    faults->Need(tabs, tabs.tabText(i), Advance(tabs, tabs.tabText(i)) + 8, tabs.tabRect(i).width());
}

void CheckDock(const QDockWidget& dock, Faults* faults) {
  if (dock.titleBarWidget() != nullptr) return;
  int has_px = dock.width() - 8;
  for (const auto* button : dock.findChildren<QAbstractButton*>(QString(), Qt::FindDirectChildrenOnly))
    if (button->isVisible()) has_px = std::min(has_px, button->x() - 4);
  faults->Need(dock, dock.windowTitle(), Advance(dock, dock.windowTitle()), has_px);
}

void CheckHeader(const QHeaderView& header, Faults* faults) {
  if (header.orientation() != Qt::Horizontal) return;
  for (int i = 0; i < header.count(); ++i) {
    if (header.isSectionHidden(i)) continue;
    faults->Need(header, header.model()->headerData(i, Qt::Horizontal).toString(), header.sectionSizeHint(i),
                 header.sectionSize(i));
  }
}

// Cells that are shown. Where words wrap, the row is as high as they need.
void CheckCells(const QAbstractItemView& view, Faults* faults) {
  const QAbstractItemModel* model = view.model();
  if (model == nullptr) return;
  const auto* list = qobject_cast<const QListView*>(&view);
  const auto* table = qobject_cast<const QTableView*>(&view);
  const bool wraps = (list != nullptr && list->wordWrap()) || (table != nullptr && table->wordWrap());
  const auto check = [&](const QModelIndex& index) {
    const QRect cell = view.visualRect(index);
    const QString text = index.data().toString();
    if (text.isEmpty() || !cell.isValid() || !view.viewport()->rect().intersects(cell)) return;
    QStyleOptionViewItem option;
    option.initFrom(&view);
    option.widget = &view;
    option.rect = wraps ? cell : QRect();
    if (wraps) option.features = QStyleOptionViewItem::WrapText;
    const QSize wanted = view.itemDelegateForIndex(index)->sizeHint(option, index);
    faults->Need(view, text, wanted.width(), cell.width());
    if (wraps && wanted.height() > cell.height() + kRoundingPx)
      faults->Add(view,
                  QString("'%1' is %2 px high and has %3").arg(text).arg(wanted.height()).arg(cell.height()));
  };
  const auto walk = [&](const auto& self, const QModelIndex& parent) -> void {
    for (int row = 0; row < model->rowCount(parent); ++row) {
      for (int column = 0; column < model->columnCount(parent); ++column) {
        const QModelIndex index = model->index(row, column, parent);
        check(index);
        if (column == 0 && qobject_cast<const QTreeView*>(&view) != nullptr) self(self, index);
      }
    }
  };
  if (qobject_cast<const QHeaderView*>(&view) == nullptr) walk(walk, view.rootIndex());
}

void CheckText(const QWidget& widget, Faults* faults) {
  if (const auto* label = qobject_cast<const QLabel*>(&widget)) CheckLabel(*label, faults);
  if (const auto* button = qobject_cast<const QAbstractButton*>(&widget)) CheckButton(*button, faults);
  if (const auto* combo = qobject_cast<const QComboBox*>(&widget)) CheckCombo(*combo, faults);
  if (const auto* spin = qobject_cast<const QAbstractSpinBox*>(&widget)) CheckSpinBox(*spin, faults);
  if (const auto* line = qobject_cast<const QLineEdit*>(&widget)) CheckLine(*line, faults);
  if (const auto* tabs = qobject_cast<const QTabBar*>(&widget)) CheckTabs(*tabs, faults);
  if (const auto* dock = qobject_cast<const QDockWidget*>(&widget)) CheckDock(*dock, faults);
  if (const auto* header = qobject_cast<const QHeaderView*>(&widget)) CheckHeader(*header, faults);
  if (const auto* view = qobject_cast<const QAbstractItemView*>(&widget)) CheckCells(*view, faults);
  if (const auto* group = qobject_cast<const QGroupBox*>(&widget))
    faults->Need(*group, group->title(), Advance(*group, group->title()), group->width() - 12);
  if (const auto* bar = qobject_cast<const QProgressBar*>(&widget); bar != nullptr && bar->isTextVisible())
    faults->Need(*bar, bar->text(), Advance(*bar, bar->text()), bar->width());
  const QString name = widget.objectName();
  if (name == "qt_toolbar_ext_button" || name == "qt_menubar_ext_button")
    faults->Add(widget, "there are buttons that it hides");
}

// What belongs to a widget of Qt's, and is laid out by it.
bool IsLaidOutByQt(const QWidget& parent) {
  return qobject_cast<const QAbstractSpinBox*>(&parent) != nullptr ||
         qobject_cast<const QComboBox*>(&parent) != nullptr ||
         qobject_cast<const QLineEdit*>(&parent) != nullptr ||
         qobject_cast<const QTabBar*>(&parent) != nullptr ||
         qobject_cast<const QAbstractScrollArea*>(&parent) != nullptr;
}

// In the part of a scroll area that moves.
bool IsScrolled(const QWidget& widget) {
  for (const QWidget* above = widget.parentWidget(); above != nullptr && !above->isWindow();
       above = above->parentWidget())
    if (above->objectName() == "qt_scrollarea_viewport") return true;
  return false;
}

void CheckPlace(const QWidget& widget, Faults* faults) {
  const QWidget& parent = *widget.parentWidget();
  if (const auto* area = qobject_cast<const QAbstractScrollArea*>(&widget)) {
    if (area->horizontalScrollBar()->isVisible()) faults->Add(widget, "scrolls sideways");
  }
  if (parent.objectName() == "qt_scrollarea_viewport") {
    if (widget.width() > parent.width()) faults->Add(widget, "is wider than what scrolls it");
    return;
  }
  if (IsLaidOutByQt(parent)) return;
  const QRect room = parent.rect().adjusted(-kRoundingPx, -kRoundingPx, kRoundingPx, kRoundingPx);
  if (!room.contains(widget.geometry())) {
    const QRect at = widget.geometry();
    faults->Add(widget, QString("leaves its parent: %1, %2, %3 x %4 in %5 x %6")
                            .arg(at.x())
                            .arg(at.y())
                            .arg(at.width())
                            .arg(at.height())
                            .arg(parent.width())
                            .arg(parent.height()));
  }
  const bool is_leaf = widget.findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly).isEmpty();
  if (is_leaf && !widget.size().isEmpty() && widget.visibleRegion().isEmpty() && !IsScrolled(widget))
    faults->Add(widget, "is covered or outside");
}

// Of panels that lie one above the other Qt keeps those behind, and unused tab bars, left of and above the
// window.
bool IsPutAside(const QWidget& widget) {
  for (const QWidget* at = &widget; at != nullptr; at = at->parentWidget())
    if (qobject_cast<const QMainWindow*>(at->parentWidget()) != nullptr && at->x() < 0 && at->y() < 0)
      return true;
  return false;
}

bool IsOf(const QWidget& widget, const QWidget& top) {
  return widget.isVisible() && widget.window() == &top && !IsPutAside(widget);
}

void CheckOverlaps(const QWidget& parent, const QWidget& top, Faults* faults) {
  if (IsLaidOutByQt(parent)) return;
  std::vector<const QWidget*> children;
  for (const QWidget* child : parent.findChildren<QWidget*>(QString(), Qt::FindDirectChildrenOnly)) {
    if (!IsOf(*child, top) || qobject_cast<const QSplitterHandle*>(child) != nullptr) continue;
    if (!child->size().isEmpty()) children.push_back(child);
  }
  for (std::size_t i = 0; i < children.size(); ++i) {
    for (std::size_t k = i + 1; k < children.size(); ++k) {
      const QRect both = children[i]->geometry().intersected(children[k]->geometry());
      if (both.width() > kRoundingPx && both.height() > kRoundingPx)
        faults->Add(*children[i], "overlaps " + NameOf(*children[k]));
    }
  }
}

}  // namespace

void AwaitLayout() {
  constexpr int kMostLayers = 8;
  for (int i = 0; i < kMostLayers; ++i) QCoreApplication::processEvents();
}

QStringList FaultsOfFit(const QWidget& top) {
  Faults faults;
  CheckOverlaps(top, top, &faults);
  for (const QWidget* widget : top.findChildren<QWidget*>()) {
    if (!IsOf(*widget, top)) continue;
    CheckText(*widget, &faults);
    CheckPlace(*widget, &faults);
    CheckOverlaps(*widget, top, &faults);
  }
  return faults.lines();
}

}  // namespace elbowroom::console
