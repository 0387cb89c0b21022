// Undo and redo of the gaps that the experimenter has set.
#pragma once

#include <QObject>
#include <QTimer>
#include <cstddef>
#include <optional>
#include <vector>

#include "core/history.h"

namespace elbowroom::console {

// Changes of one gap that follow each other quickly (a slider on its way, a key held down) are one step. The
// session's log isn't touched: going back is one more change in it. Thread: UI.
class GapHistory : public QObject {
  Q_OBJECT

 public:
  using Gaps = std::vector<double>;  // mm, in the layout's order

  explicit GapHistory(QObject* parent = nullptr);

  void Open(Gaps initial_mm);
  void Change(std::size_t spacing, double to_mm);

  [[nodiscard]] bool CanUndo() const;
  [[nodiscard]] bool CanRedo() const;
  // The gaps as they then are, bit-equal to what they were. Throw: PreconditionError if that can't be.
  [[nodiscard]] Gaps Undo();
  [[nodiscard]] Gaps Redo();

 signals:
  void Changed();

 private:
  void Settle();

  std::optional<core::History<Gaps>> settled_;  // nothing: no trial yet
  Gaps now_mm_;
  std::size_t moving_ = 0;  // the gap that makes `now_mm_` unlike what is settled
  QTimer pause_;
};

}  // namespace elbowroom::console
