#include "app/control/calibration/board_views.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/error.h"
#include "recon/boards/resting_board.h"

namespace elbowroom::control {
namespace {

using core::Error;
using core::ErrorKind;
using core::FrameIndex;
using recon::BoardSighting;

std::string DescriptionOf(const recon::Board& board) {
  return fmt::format("{} of {} x {}{}", recon::ToString(board.kind), board.columns, board.rows,
                     board.dictionary.empty() ? "" : ", " + board.dictionary);
}

void RequireBoards(const CalibrationFile& file, const BoardFootage& footage) {
  FrameIndex looked_at = 0;
  std::string without;
  for (const CameraSightings& camera : footage.cameras) {
    looked_at += camera.looked_at + camera.photos;
    if (camera.in_frames.empty()) without += fmt::format("{}'{}'", without.empty() ? "" : ", ", camera.name);
  }
  const bool is_anywhere = std::ranges::any_of(
      footage.cameras, [](const CameraSightings& camera) { return !camera.in_frames.empty(); });
  if (!is_anywhere) {
    throw Error(
        ErrorKind::kCamera,
        fmt::format(
            "no camera shows the board ({}) in any of {} pictures; check type, columns, rows, dictionary, "
            "layout and inverted in [board]",
            DescriptionOf(file.board), looked_at));
  }
  if (!without.empty()) {
    throw Error(
        ErrorKind::kCamera,
        fmt::format(
            "the board isn't found in any frame of camera {}; hold it where that camera and another one see "
            "it at once",
            without));
  }
}

// One camera's pictures of a board that lies still.
class StillView {
 public:
  StillView(const recon::Board& board, const recon::StampedFrame& frame, const BoardSighting& sighting)
      : rest_(board, sighting),
        first_frame_(frame.frame),
        last_frame_(frame.frame),
        time_sum_s_(frame.time_s) {}

  // Takes the picture if the board hasn't moved since the first one.
  bool Add(const BoardSighting& sighting, const recon::StampedFrame& frame) {
    if (!rest_.Add(sighting)) return false;
    last_frame_ = frame.frame;
    time_sum_s_ += frame.time_s;
    return true;
  }

  [[nodiscard]] recon::CalibrationView View(int camera, int set) const {
    recon::CalibrationView view;
    view.camera = camera;
    view.set = set;
    view.time_s = time_sum_s_ / rest_.pictures();
    view.label = first_frame_ == last_frame_ ? fmt::format("frame {}", first_frame_)
                                             : fmt::format("frames {} to {}", first_frame_, last_frame_);
    view.sighting = rest_.Mean();
    return view;
  }

 private:
  recon::RestingBoard rest_;
  FrameIndex first_frame_ = 0;
  FrameIndex last_frame_ = 0;
  double time_sum_s_ = 0.0;
};

// Goes through the sets in order, and joins those between which the board lies still.
class SetJoiner {
 public:
  SetJoiner(const CalibrationFile& file, const BoardFootage& footage) : file_(file), footage_(footage) {
    for (const CameraSightings& camera : footage.cameras) {
      std::map<FrameIndex, const BoardSighting*>& by_frame = sightings_.emplace_back();
      for (const BoardPicture& picture : camera.in_frames) by_frame[picture.frame] = &picture.sighting;
    }
  }

  void Run(std::vector<recon::CalibrationView>* views) {
    for (const recon::StampedSet& set : footage_.sets) {
      if (!ShowsBoard(set)) continue;
      if (!IsContinued(set)) {
        Close(views);
        Begin(set);
      }
      if (!world_set_ && file_.board_frame && HasWorldFrame(set)) world_set_ = number_;
    }
    Close(views);
  }

  // The number of the set in which the board is the world.
  [[nodiscard]] std::optional<int> world_set() const { return world_set_; }

 private:
  [[nodiscard]] const BoardSighting* SightingIn(const recon::StampedSet& set, std::size_t camera) const {
    if (!set.frames[camera]) return nullptr;
    const auto found = sightings_[camera].find(set.frames[camera]->frame);
    return found == sightings_[camera].end() ? nullptr : found->second;
  }
  [[nodiscard]] bool ShowsBoard(const recon::StampedSet& set) const {
    for (std::size_t i = 0; i < sightings_.size(); ++i)
      if (SightingIn(set, i) != nullptr) return true;
    return false;
  }
  // Whether the first camera that sees the board there sees it in the frame that the file names.
  [[nodiscard]] bool HasWorldFrame(const recon::StampedSet& set) const {
    for (std::size_t i = 0; i < sightings_.size(); ++i)
      if (SightingIn(set, i) != nullptr && set.frames[i]->frame == *file_.board_frame) return true;
    return false;
  }

  void Begin(const recon::StampedSet& set) {
    views_.clear();
    views_.resize(sightings_.size());
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      if (const BoardSighting* sighting = SightingIn(set, i))
        views_[i].emplace(file_.board, *set.frames[i], *sighting);
    }
  }

  // Takes the set's pictures if the board lies still in all cameras that see it now and before.
  bool IsContinued(const recon::StampedSet& set) {
    if (views_.empty()) return false;
    std::vector<std::optional<StillView>> continued = views_;
    int agree = 0;
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      const BoardSighting* sighting = SightingIn(set, i);
      if (sighting == nullptr || !continued[i]) continue;
      if (!continued[i]->Add(*sighting, *set.frames[i])) return false;
      ++agree;
    }
    if (agree == 0) return false;
    // A camera that didn't see it before does so from now on.
    for (std::size_t i = 0; i < sightings_.size(); ++i) {
      const BoardSighting* sighting = SightingIn(set, i);
      if (sighting != nullptr && !continued[i]) continued[i].emplace(file_.board, *set.frames[i], *sighting);
    }
    views_ = std::move(continued);
    return true;
  }

  void Close(std::vector<recon::CalibrationView>* views) {
    if (views_.empty()) return;
    for (std::size_t i = 0; i < views_.size(); ++i)
      if (views_[i]) views->push_back(views_[i]->View(static_cast<int>(i), number_));
    views_.clear();
    ++number_;
  }

  const CalibrationFile& file_;
  const BoardFootage& footage_;
  std::vector<std::map<FrameIndex, const BoardSighting*>> sightings_;
  std::vector<std::optional<StillView>> views_;  // of the set that is being joined, by camera
  int number_ = 0;
  std::optional<int> world_set_;
};

void AddPhotos(const BoardFootage& footage, recon::CalibrationInput* input) {
  for (std::size_t i = 0; i < footage.cameras.size(); ++i) {
    for (const BoardPicture& photo : footage.cameras[i].in_photos) {
      recon::CalibrationView view;
      view.camera = static_cast<int>(i);
      view.sighting = photo.sighting;
      view.label = fmt::format("picture {} of its intrinsics", photo.frame + 1);
      input->views.push_back(std::move(view));
    }
  }
}

}  // namespace

recon::CalibrationInput ViewsOf(const CalibrationFile& file, const BoardFootage& footage,
                                std::vector<std::optional<core::CameraCalibration>> known) {
  RequireBoards(file, footage);
  recon::CalibrationInput input;
  input.board = file.board;
  for (std::size_t i = 0; i < footage.cameras.size(); ++i) {
    const CameraSightings& camera = footage.cameras[i];
    input.cameras.push_back(
        {camera.name, camera.width_px, camera.height_px, file.cameras[i].lens_model, std::move(known[i])});
  }
  SetJoiner joiner(file, footage);
  joiner.Run(&input.views);
  AddPhotos(footage, &input);
  if (file.board_frame) {
    if (!joiner.world_set()) {
      throw Error(
          ErrorKind::kCamera,
          fmt::format(
              "no camera shows the board in board_frame {}; name a frame in which it lies on the table and "
              "is found",
              *file.board_frame));
    }
    input.world = {recon::CalibrationWorld::Kind::kBoardOfSet, *joiner.world_set()};
  } else {
    const auto camera = std::ranges::find(file.cameras, file.world_camera, &CameraFootage::name);
    input.world = {recon::CalibrationWorld::Kind::kCamera, static_cast<int>(camera - file.cameras.begin())};
  }
  input.finds_offsets = footage.period_s.has_value();
  if (footage.period_s) input.frame_period_s = *footage.period_s;
  return input;
}

}  // namespace elbowroom::control
