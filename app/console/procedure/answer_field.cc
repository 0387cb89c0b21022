#include "app/console/procedure/answer_field.h"

#include <QButtonGroup>
#include <QComboBox>
#include <QCoreApplication>
#include <QDoubleSpinBox>
#include <QHBoxLayout>
#include <QPlainTextEdit>
#include <QSpinBox>
#include <QToolButton>
#include <string>

namespace elbowroom::console {
namespace {

using core::ItemAnswer;
using core::ItemKind;
using core::QuestionnaireItem;

constexpr int kMostButtons = 11;  // longer scales have a box of numbers
constexpr int kNumberDecimals = 6;
constexpr int kNumberDigits = 12;
constexpr int kTextPx = 64;
constexpr int kLeastLetters = 12;  // of a list of choices; longer ones are cut off, and have a tip

class AnswerFields {
  Q_DECLARE_TR_FUNCTIONS(elbowroom::console::AnswerFields)

 public:
  static AnswerField Buttons(const QuestionnaireItem& item, const QString& name) {
    auto* row = new QWidget;
    auto* line = new QHBoxLayout(row);
    line->setContentsMargins(0, 0, 0, 0);
    line->setSpacing(2);
    auto* group = new QButtonGroup(row);
    const int least = static_cast<int>(item.least), most = static_cast<int>(item.most);
    for (int value = least; value <= most; ++value) {
      auto* button = new QToolButton;
      button->setObjectName(QString("%1:%2").arg(name).arg(value));
      button->setText(QString::number(value));
      button->setCheckable(true);
      button->setAccessibleName(QString("%1: %2").arg(QString::fromStdString(item.text)).arg(value));
      button->setToolTip(tr("%1, on a scale from %2 to %3").arg(value).arg(least).arg(most));
      group->addButton(button, value - least);
      line->addWidget(button);
    }
    line->addStretch(1);
    return {row, [group, least]() -> std::optional<ItemAnswer> {
              if (group->checkedId() < 0) return std::nullopt;
              return static_cast<double>(group->checkedId() + least);
            }};
  }

  static AnswerField WholeNumber(const QuestionnaireItem& item, const QString& name) {
    auto* box = new QSpinBox;
    const int least = static_cast<int>(item.least), most = static_cast<int>(item.most);
    box->setRange(least - 1, most);  // one below the scale stands for no answer
    box->setValue(least - 1);
    box->setSpecialValueText(tr("not answered"));
    box->setToolTip(tr("On a scale from %1 to %2").arg(least).arg(most));
    Name(item, name, box);
    return {box, [box, least]() -> std::optional<ItemAnswer> {
              if (box->value() < least) return std::nullopt;
              return static_cast<double>(box->value());
            }};
  }

  static AnswerField Number(const QuestionnaireItem& item, const QString& name) {
    auto* box = new NumberBox;
    box->setDecimals(kNumberDecimals);
    box->setRange(item.least - 1.0, item.most);  // below the range: no answer
    box->setValue(box->minimum());
    box->setSpecialValueText(tr("not answered"));
    box->setButtonSymbols(QAbstractSpinBox::NoButtons);
    box->setToolTip(tr("A number from %1 to %2").arg(item.least).arg(item.most));
    Name(item, name, box);
    return {box, [box, least = item.least]() -> std::optional<ItemAnswer> {
              if (box->value() < least) return std::nullopt;
              return box->value();
            }};
  }

  static AnswerField Choice(const QuestionnaireItem& item, const QString& name) {
    auto* list = new QComboBox;
    list->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    list->setMinimumContentsLength(kLeastLetters);
    list->addItem(tr("not answered"));
    for (const std::string& choice : item.choices) {
      list->addItem(QString::fromStdString(choice));
      list->setItemData(list->count() - 1, QString::fromStdString(choice).toHtmlEscaped(), Qt::ToolTipRole);
    }
    list->setToolTip(tr("One of these, or none"));
    Name(item, name, list);
    return {list, [list, choices = item.choices]() -> std::optional<ItemAnswer> {
              if (list->currentIndex() < 1) return std::nullopt;
              return choices.at(static_cast<std::size_t>(list->currentIndex()) - 1);
            }};
  }

  static AnswerField Text(const QuestionnaireItem& item, const QString& name) {
    auto* text = new QPlainTextEdit;
    text->setTabChangesFocus(true);
    text->setFixedHeight(kTextPx);
    text->setToolTip(tr("In the participant's own words"));
    Name(item, name, text);
    return {text, [text]() -> std::optional<ItemAnswer> {
              const QString said = text->toPlainText().trimmed();
              if (said.isEmpty()) return std::nullopt;
              return said.toStdString();
            }};
  }

 private:
  // Without zeros at the end.
  class NumberBox : public QDoubleSpinBox {
   public:
    [[nodiscard]] QString textFromValue(double value) const override {
      return locale().toString(value, 'g', kNumberDigits);
    }
  };

  static void Name(const QuestionnaireItem& item, const QString& name, QWidget* widget) {
    widget->setObjectName(name);
    widget->setAccessibleName(QString::fromStdString(item.text));
  }
};

}  // namespace

AnswerField MakeAnswerField(const QuestionnaireItem& item, const QString& name) {
  switch (item.kind) {
    case ItemKind::kScale:
      return item.most - item.least < kMostButtons ? AnswerFields::Buttons(item, name)
                                                   : AnswerFields::WholeNumber(item, name);
    case ItemKind::kNumber:
      return AnswerFields::Number(item, name);
    case ItemKind::kChoice:
      return AnswerFields::Choice(item, name);
    case ItemKind::kText:
      break;
  }
  return AnswerFields::Text(item, name);
}

}  // namespace elbowroom::console
