#include "tests/app/console/looks/untranslated.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSpinBox>
#include <QAction>
#include <QComboBox>
#include <QDockWidget>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QPlainTextEdit>
#include <QProgressBar>
#include <QRegularExpression>
#include <QTabBar>
#include <QTextEdit>

namespace elbowroom::console {
namespace {

constexpr char16_t kSmall[] = u"áƀçđéƒğĥíĵķĺɱñóƥɋŕšţúṽŵẋýž";
constexpr char16_t kLarge[] = u"ÁɃÇĐÉƑĞĤÍĴĶĹḾÑÓƤɊŔŠŢÚṼŴẊÝŽ";

QChar Accented(QChar letter) {
  if (letter >= u'a' && letter <= u'z') return kSmall[letter.unicode() - u'a'];
  if (letter >= u'A' && letter <= u'Z') return kLarge[letter.unicode() - u'A'];
  return letter;
}

class TextWalk {
 public:
  TextWalk(const QSet<QString>& known, const QSet<QString>& english) : known_(known), english_(english) {}

  void Look(const QWidget& widget) {
    if (IsEnglish(widget)) return;
    for (const QString& text : {widget.toolTip(), widget.accessibleName(), widget.accessibleDescription()})
      Check(widget, text);
    LookAtText(widget);
    for (const QAction* action : widget.actions()) Look(widget, *action);
  }
  [[nodiscard]] QStringList lines() const { return lines_; }

 private:
  // The widget, or one that it is in.
  [[nodiscard]] bool IsEnglish(const QWidget& widget) const {
    for (const QWidget* at = &widget; at != nullptr; at = at->parentWidget())
      if (english_.contains(at->objectName())) return true;
    return false;
  }

  void LookAtText(const QWidget& widget) {
    if (const auto* label = qobject_cast<const QLabel*>(&widget)) Check(widget, label->text());
    if (const auto* button = qobject_cast<const QAbstractButton*>(&widget)) Check(widget, button->text());
    if (const auto* group = qobject_cast<const QGroupBox*>(&widget)) Check(widget, group->title());
    if (const auto* dock = qobject_cast<const QDockWidget*>(&widget)) Check(widget, dock->windowTitle());
    if (const auto* line = qobject_cast<const QLineEdit*>(&widget)) {
      Check(widget, line->placeholderText());
      Check(widget, line->text());
    }
    if (const auto* bar = qobject_cast<const QProgressBar*>(&widget)) Check(widget, bar->text());
    if (const auto* text = qobject_cast<const QTextEdit*>(&widget)) Check(widget, text->toPlainText());
    if (const auto* text = qobject_cast<const QPlainTextEdit*>(&widget)) Check(widget, text->toPlainText());
    if (const auto* combo = qobject_cast<const QComboBox*>(&widget))
      for (int i = 0; i < combo->count(); ++i) Check(widget, combo->itemText(i));
    if (const auto* tabs = qobject_cast<const QTabBar*>(&widget))
      for (int i = 0; i < tabs->count(); ++i) Check(widget, tabs->tabText(i));
    if (const auto* view = qobject_cast<const QAbstractItemView*>(&widget); view && view->model())
      LookAtItems(*view, {});
    if (widget.isWindow()) Check(widget, widget.windowTitle());
  }

  void LookAtItems(const QAbstractItemView& view, const QModelIndex& parent) {
    const QAbstractItemModel& model = *view.model();
    for (int column = 0; column < model.columnCount(parent); ++column) {
      if (!parent.isValid() && !view.inherits("QListView"))  // whose headings nobody sees
        for (const int role : {Qt::DisplayRole, Qt::ToolTipRole})
          Check(view, model.headerData(column, Qt::Horizontal, role).toString());
      for (int row = 0; row < model.rowCount(parent); ++row) {
        const QModelIndex index = model.index(row, column, parent);
        for (const int role : {Qt::DisplayRole, Qt::ToolTipRole}) Check(view, index.data(role).toString());
        if (column == 0) LookAtItems(view, index);
      }
    }
  }

  void Look(const QWidget& widget, const QAction& action) {
    Check(widget, action.text());
    Check(widget, action.toolTip());
    if (const QMenu* menu = action.menu())
      for (const QAction* below : menu->actions()) Look(*menu, *below);
  }

  void Check(const QWidget& widget, const QString& text) {
    static const QRegularExpression tags("<[^>]*>"), words("[A-Za-z]{2,}");
    QString left = text;
    left.remove(tags).remove('&');
    for (auto word = words.globalMatch(left); word.hasNext();) {
      if (known_.contains(word.next().captured().toLower())) continue;
      const QString line =
          QString("%1 '%2': %3").arg(widget.metaObject()->className(), widget.objectName(), text);
      if (!lines_.contains(line)) lines_ << line;
      return;
    }
  }

  const QSet<QString>& known_;
  const QSet<QString>& english_;
  QStringList lines_;
};

}  // namespace

QString AccentTranslator::translate(const char* /*context*/, const char* source,
                                    const char* /*disambiguation*/, int /*n*/) const {
  const QString text = QString::fromUtf8(source);
  if (text == "QT_LAYOUT_DIRECTION") return {};
  QString accented;
  bool is_in_tag = false;
  for (qsizetype i = 0; i < text.size(); ++i) {
    const QChar letter = text[i];
    is_in_tag = letter == '<' || (is_in_tag && letter != '>');
    const bool is_placeholder =
        i > 0 && text[i - 1] == '%' && (letter == 'n' || letter == 'L' || letter == 'p');
    accented += is_in_tag || is_placeholder ? letter : Accented(letter);
  }
  return accented;
}

QStringList UntranslatedTexts(const QWidget& top, const QSet<QString>& known, const QSet<QString>& english) {
  TextWalk walk(known, english);
  walk.Look(top);
  for (const QWidget* widget : top.findChildren<QWidget*>())
    if ((widget->isVisible() && widget->window() == &top) || qobject_cast<const QMenu*>(widget))
      walk.Look(*widget);
  return walk.lines();
}

}  // namespace elbowroom::console
