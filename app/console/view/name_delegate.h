// Draws names so that they can wrap: most names of parts have no spaces.
#pragma once

#include <QStyledItemDelegate>

namespace elbowroom::console {

// `name` with places where a line may end (U+200B, no width): after '_', '-', '/' and '.', and anywhere in a
// long run of other signs.
[[nodiscard]] QString WithLineEnds(const QString& name);

// For a view that wraps words. What the model holds stays as it is. Thread: UI.
class NameDelegate : public QStyledItemDelegate {
  Q_OBJECT

 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  [[nodiscard]] QString displayText(const QVariant& value, const QLocale& locale) const override;
};

}  // namespace elbowroom::console
