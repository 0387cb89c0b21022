#include "app/control/episode_tally.h"

#include <algorithm>

namespace elbowroom::control {

void EpisodeTally::Add(const FrameResult& result) {
  tracker_.Add({result.record, result.world_from_parts, {}});
}

std::vector<PartTally> EpisodeTally::Parts() const {
  std::vector<PartTally> tallies(parts_);
  for (const core::ContactEpisode& episode : tracker_.Episodes()) {
    PartTally& tally = tallies.at(episode.part);
    ++tally.episodes;
    tally.frames_in_contact += episode.frames_in_contact;
    tally.deepest_mm = std::max(tally.deepest_mm, episode.peak_depth_mm);
  }
  return tallies;
}

}  // namespace elbowroom::control
