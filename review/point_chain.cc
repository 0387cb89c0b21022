#include "review/point_chain.h"

namespace elbowroom::review {

PointChunk* PointChunks::Take() {
  const std::lock_guard lock(mutex_);
  if (taken_ == chunks_.size()) chunks_.push_back(std::make_unique<PointChunk>());
  PointChunk* chunk = chunks_[taken_++].get();
  chunk->count = 0;
  chunk->next = nullptr;
  return chunk;
}

void PointChain::Add(const core::ContactPoint& point) {
  if (last_ == nullptr) {
    first_ = last_ = chunks_->Take();
  } else if (last_->count == PointChunk::kMost) {
    last_->next = chunks_->Take();
    last_ = last_->next;
  }
  last_->points[last_->count++] = point;
}

void PointChain::Append(const PointChain& other) {
  if (other.is_empty()) return;
  (is_empty() ? first_ : last_->next) = other.first_;
  last_ = other.last_;
}

void PointChain::CopyTo(std::vector<core::ContactPoint>* points) const {
  points->clear();
  for (const PointChunk* chunk = first_; chunk != nullptr; chunk = chunk->next)
    points->insert(points->end(), chunk->points.data(), chunk->points.data() + chunk->count);
}

}  // namespace elbowroom::review
