#include "app/console/gap_history.h"

#include <chrono>
#include <utility>

namespace elbowroom::console {
namespace {

constexpr std::chrono::milliseconds kPause{600};

}  // namespace

GapHistory::GapHistory(QObject* parent) : QObject(parent) {
  pause_.setSingleShot(true);
  pause_.setInterval(kPause);
  connect(&pause_, &QTimer::timeout, this, &GapHistory::Settle);
}

void GapHistory::Open(Gaps initial_mm) {
  pause_.stop();
  now_mm_ = initial_mm;
  settled_.emplace(std::move(initial_mm));
  emit Changed();
}

void GapHistory::Change(std::size_t spacing, double to_mm) {
  if (!settled_ || now_mm_.at(spacing) == to_mm) return;
  if (spacing != moving_) Settle();
  moving_ = spacing;
  now_mm_[spacing] = to_mm;
  pause_.start();
  emit Changed();
}

void GapHistory::Settle() {
  pause_.stop();
  settled_ = settled_->Changed(now_mm_);
  emit Changed();
}

bool GapHistory::CanUndo() const { return settled_ && (settled_->CanUndo() || now_mm_ != settled_->now()); }

bool GapHistory::CanRedo() const { return settled_ && settled_->CanRedo() && now_mm_ == settled_->now(); }

GapHistory::Gaps GapHistory::Undo() {
  core::Require(CanUndo(), "a gap was changed");
  Settle();
  settled_ = settled_->Undone();
  now_mm_ = settled_->now();
  emit Changed();
  return now_mm_;
}

GapHistory::Gaps GapHistory::Redo() {
  core::Require(CanRedo(), "a change of a gap was undone");
  settled_ = settled_->Redone();
  now_mm_ = settled_->now();
  emit Changed();
  return now_mm_;
}

}  // namespace elbowroom::console
