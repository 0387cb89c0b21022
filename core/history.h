// Undo and redo as values.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "core/error.h"

namespace elbowroom::core {

// All states of a value, and which one is the present. States are kept whole, so that undo gives them back
// bit-equal. A core::Layout shares its meshes and is cheap to keep.
template <typename Value>
class History {
 public:
  explicit History(Value first) { Push(std::move(first)); }

  [[nodiscard]] const Value& now() const { return *values_[now_]; }
  [[nodiscard]] bool CanUndo() const { return now_ > 0; }
  [[nodiscard]] bool CanRedo() const { return now_ + 1 < values_.size(); }
  // What Redone() would make the present. Throws: PreconditionError when nothing was undone.
  [[nodiscard]] const Value& next() const {
    Require(CanRedo(), "something was undone");
    return *values_[now_ + 1];
  }

  // Forgets the states that were undone. A value that equals the present one is no change.
  [[nodiscard]] History Changed(Value next) const {
    if (next == now()) return *this;
    History history = *this;
    history.values_.resize(now_ + 1);
    history.Push(std::move(next));
    ++history.now_;
    return history;
  }

  // The same history of what `change` makes of each value.
  template <typename Change>
  [[nodiscard]] History Mapped(const Change& change) const {
    History history = *this;
    for (std::shared_ptr<const Value>& value : history.values_)
      value = std::make_shared<const Value>(change(*value));
    return history;
  }

  // Both throw: PreconditionError when there is nothing to undo or redo.
  [[nodiscard]] History Undone() const {
    Require(CanUndo(), "something was changed");
    History history = *this;
    --history.now_;
    return history;
  }
  [[nodiscard]] History Redone() const {
    Require(CanRedo(), "something was undone");
    History history = *this;
    ++history.now_;
    return history;
  }

 private:
  void Push(Value value) { values_.push_back(std::make_shared<const Value>(std::move(value))); }

  std::vector<std::shared_ptr<const Value>> values_;  // first to last; at least one
  std::size_t now_ = 0;
};

}  // namespace elbowroom::core
