#include "recon/coverage/ray_stretches.h"

#include <algorithm>

namespace elbowroom::recon {
namespace {

Stretch Overlap(const Stretch& a, const Stretch& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

}  // namespace

void RayStretches::Append(const Stretch& stretch) {
  if (stretch.is_empty()) return;
  if (!stretches_.empty() && stretches_.back().end >= stretch.begin) {
    stretches_.back().end = std::max(stretches_.back().end, stretch.end);
    return;
  }
  stretches_.push_back(stretch);
}

void RayStretches::Keep(const Stretch& stretch) {
  for (Stretch& own : stretches_) own = Overlap(own, stretch);
  std::erase_if(stretches_, [](const Stretch& own) { return own.is_empty(); });
}

void RayStretches::Keep(const RayStretches& others) {
  next_.clear();
  for (const Stretch& own : stretches_)
    for (const Stretch& other : others.stretches_)
      if (const Stretch both = Overlap(own, other); !both.is_empty()) next_.push_back(both);
  std::swap(stretches_, next_);
}

void RayStretches::Remove(const Stretch& stretch) {
  if (stretch.is_empty()) return;
  next_.clear();
  for (const Stretch& own : stretches_) {
    const Stretch before{own.begin, std::min(own.end, stretch.begin)};
    const Stretch after{std::max(own.begin, stretch.end), own.end};
    if (!before.is_empty()) next_.push_back(before);
    if (!after.is_empty()) next_.push_back(after);
  }
  std::swap(stretches_, next_);
}

double RayStretches::VolumePerSteradian(const Stretch& within) const {
  double sum = 0.0;
  for (const Stretch& own : stretches_) {
    const Stretch both = Overlap(own, within);
    if (!both.is_empty())
      sum += (both.end * both.end * both.end - both.begin * both.begin * both.begin) / 3.0;
  }
  return sum;
}

}  // namespace elbowroom::recon
