#include "review/point_chain.h"

#include <bit>

namespace elbowroom::review {

PointChunk* PointChunks::Take() {
  const std::lock_guard lock(mutex_);
  if (taken_ == chunks_.size()) chunks_.push_back(std::make_unique<PointChunk>());
  PointChunk* chunk = chunks_[taken_++].get();
  chunk->count = 0;
  chunk->next = nullptr;
  return chunk;
}

void PointChain::Add(const core::ContactPoint& point, std::uint32_t place) {
  if (last_ == nullptr) {
    first_ = last_ = chunks_->Take();
  } else if (last_->count == PointChunk::kMost) {
    last_->next = chunks_->Take();
    last_ = last_->next;
  }
  last_->points[last_->count] = point;
  last_->places[last_->count++] = place;
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

void PointChain::CopyByPlace(std::size_t places, std::vector<TakenPlaces>* taken,
                             std::vector<core::ContactPoint>* points) const {
  constexpr std::size_t kBits = 64;
  taken->assign((places + kBits - 1) / kBits, {});
  for (const PointChunk* chunk = first_; chunk != nullptr; chunk = chunk->next)
    for (std::size_t i = 0; i < chunk->count; ++i)
      (*taken)[chunk->places[i] / kBits].bits |= std::uint64_t{1} << (chunk->places[i] % kBits);
  std::size_t before = 0;
  for (TakenPlaces& word : *taken) {
    word.before = before;
    before += static_cast<std::size_t>(std::popcount(word.bits));
  }
  points->resize(before);
  for (const PointChunk* chunk = first_; chunk != nullptr; chunk = chunk->next)
    for (std::size_t i = 0; i < chunk->count; ++i) {
      const TakenPlaces& word = (*taken)[chunk->places[i] / kBits];
      const std::uint64_t lower = (std::uint64_t{1} << (chunk->places[i] % kBits)) - 1;
      (*points)[word.before + static_cast<std::size_t>(std::popcount(word.bits & lower))] = chunk->points[i];
    }
}

}  // namespace elbowroom::review
