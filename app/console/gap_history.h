// Undo and redo of the gaps that the experimenter has set.
#pragma once

#include <QObject>
#include <QTimer>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/history.h"

namespace elbowroom::console {

// Changes of one gap that follow each other quickly (a slider on its way, a key held down) are one step.
// Undoing one removes nothing from the session: it is recorded as one more change. Thread: UI.
class GapHistory : public QObject {
  Q_OBJECT

 public:
  using Gaps = std::vector<double>;  // mm, in the layout's order

  explicit GapHistory(QObject* parent = nullptr);

  void Open(Gaps initial_mm);
  void Change(std::size_t spacing, double to_mm);

  [[nodiscard]] bool CanUndo() const;
  [[nodiscard]] bool CanRedo() const;
  // The gaps afterwards, bit-equal to what they were. Throw: PreconditionError if there is nothing to undo or
  // redo.
  [[nodiscard]] Gaps Undo();
  [[nodiscard]] Gaps Redo();

 signals:
  void Changed();

 private:
  void Settle();

  std::optional<core::History<Gaps>> settled_;  // nothing: no trial yet
  Gaps now_mm_;
  std::size_t moving_ = 0;  // the gap in which now_mm_ may differ from settled_
  QTimer pause_;
};

}  // namespace elbowroom::console
