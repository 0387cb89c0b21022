// Contact points as a search finds them, in memory that the next search uses again.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "core/contact.h"

namespace elbowroom::review {

// A stretch of a chain.
struct PointChunk {
  static constexpr std::size_t kMost = 32;

  std::array<core::ContactPoint, kMost> points;
  std::array<std::uint32_t, kMost> places;
  std::size_t count = 0;
  PointChunk* next = nullptr;
};

// Owns the chunks of one search's chains. Chains only grow and join, so how many chunks a search takes
// doesn't depend on the threads. Thread: Take() any, Reset() one.
class PointChunks {
 public:
  // An empty chunk, which is valid until Reset().
  [[nodiscard]] PointChunk* Take();
  // All chunks may be taken again.
  void Reset() { taken_ = 0; }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<PointChunk>> chunks_;
  std::size_t taken_ = 0;
};

// Which of 64 places are taken, and how many of all those before them.
struct TakenPlaces {
  std::uint64_t bits = 0;
  std::size_t before = 0;
};

// Points in the order in which they were added.
class PointChain {
 public:
  // `chunks` must outlive it.
  explicit PointChain(PointChunks* chunks) : chunks_(chunks) {}

  [[nodiscard]] bool is_empty() const { return first_ == nullptr; }
  // `place`: for CopyByPlace.
  void Add(const core::ContactPoint& point, std::uint32_t place = 0);
  // Another chain of the same chunks, behind this one's points; copies none of them.
  void Append(const PointChain& other);
  // Replaces what `points` held.
  void CopyTo(std::vector<core::ContactPoint>* points) const;
  // The same, by ascending places: they must differ, and be less than `places`. `taken` is memory.
  void CopyByPlace(std::size_t places, std::vector<TakenPlaces>* taken,
                   std::vector<core::ContactPoint>* points) const;

 private:
  PointChunks* chunks_;
  PointChunk* first_ = nullptr;
  PointChunk* last_ = nullptr;
};

}  // namespace elbowroom::review
