// A spacing and a pair rule, as forms.
#pragma once

#include <QCheckBox>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDoubleSpinBox>
#include <QLabel>
#include <QLineEdit>
#include <functional>

#include "core/layout.h"

namespace elbowroom::console {

// Puts what was entered into the layout; the returned line says why that can't be, "" if it was done.
template <typename Rule>
using PutRule = std::function<QString(const Rule&)>;

// A form with OK and Cancel, and a line for what can't be. Closes when OK's work was done. Thread: UI.
class RuleDialog : public QDialog {
  Q_OBJECT

 public:
  explicit RuleDialog(const QString& title, QWidget* parent = nullptr);

 protected:
  void Finish(QLayout* form);               // below it the line and the buttons
  [[nodiscard]] virtual QString Put() = 0;  // "": done

 private:
  QLabel* fault_ = nullptr;
};

class SpacingDialog : public RuleDialog {
  Q_OBJECT

 public:
  // `is_new`: its name can still be chosen.
  SpacingDialog(const core::Layout& layout, const core::Spacing& spacing, bool is_new,
                PutRule<core::Spacing> put, QWidget* parent = nullptr);

 private:
  [[nodiscard]] QString Put() override;

  PutRule<core::Spacing> put_;
  QLineEdit* name_;
  QComboBox* reference_;
  QComboBox* moving_;
  QComboBox* axis_;
  QDoubleSpinBox* min_mm_;
  QDoubleSpinBox* max_mm_;
  QDoubleSpinBox* initial_mm_;
};

class PairDialog : public RuleDialog {
  Q_OBJECT

 public:
  PairDialog(const core::PairRule& rule, PutRule<core::PairRule> put, QWidget* parent = nullptr);

 private:
  [[nodiscard]] QString Put() override;

  PutRule<core::PairRule> put_;
  core::PairRule rule_;
  QDoubleSpinBox* clearance_mm_;
  QCheckBox* may_touch_;
  QCheckBox* ignore_;
};

}  // namespace elbowroom::console
