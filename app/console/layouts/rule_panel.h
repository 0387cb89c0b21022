// The layout's spacings and pair rules: made for two chosen parts, changed, removed.
#pragma once

#include <QGroupBox>
#include <QListWidget>
#include <QPushButton>
#include <QStringList>
#include <QToolButton>

#include "core/layout.h"

namespace elbowroom::console {

// Says what is asked; the page does it. Thread: UI.
class RulePanel : public QGroupBox {
  Q_OBJECT

 public:
  explicit RulePanel(QWidget* parent = nullptr);

  // `chosen`: the names of the chosen parts, the first one first.
  void Show(const core::Layout& layout, const QStringList& chosen);

 signals:
  void SpacingAsked();  // a new one, between the two chosen parts
  void PairAsked();     // their rule, new or there
  void SpacingChangeAsked(std::size_t spacing);
  void PairChangeAsked(std::size_t pair);
  void SpacingRemovalAsked(std::size_t spacing);
  void PairRemovalAsked(std::size_t pair);

 private:
  void ShowButtons();
  void Change();
  void Remove();

  QPushButton* add_spacing_;
  QPushButton* add_pair_;
  QListWidget* rules_;
  QToolButton* change_;
  QToolButton* remove_;
};

}  // namespace elbowroom::console
