// Puts the pictures of several live cameras together, by their stamps, as they come.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <vector>

#include "recon/capture/captured_picture.h"

namespace elbowroom::recon {

// The pictures of one instant.
struct PictureSet {
  core::CameraIndex leader = 0;  // whose picture the others lie nearest to
  CaptureClock::time_point
      taken_at;  // the median of its pictures, of an even number the mean of the middle two
  std::vector<std::optional<CapturedPicture>> pictures;  // by camera; nothing: it has none near this instant
};

struct AssemblerOptions {
  double period_s = 1.0 / 30.0;            // of the cameras, until it is known better; > 0
  std::vector<double> time_offset_s = {};  // by camera: added to its stamps; empty: 0 for all
};

// One camera leads: each of its pictures makes a set, with the picture of every other camera that is nearest
// in time and at most half a period away (up to 0.6 of one, where clocks drift past the half). Where the
// leader leaves one out, the time at which that was due takes its place. The leader is the camera whose
// pictures lie in the middle of the others', so that the skew is small; another one takes over if it fails,
// or if clocks have drifted so far that the skew gets smaller by a fifth. Each picture is in one set at most
// (docs/capture.md).
//
// Sets are decided in order: as soon as no picture that may still come can change one, and within one
// period after the last of its pictures, or of those of earlier sets, came. Held to a slow search over all
// pictures by frame_set_assembler_test.
// Thread: one at a time.
class FrameSetAssembler {
 public:
  using OnUnpaired = std::function<void(core::CameraIndex, const CapturedPicture&)>;

  // Throws: PreconditionError: no camera, a period of 0, or an offset for another number of cameras.
  FrameSetAssembler(std::size_t cameras, AssemblerOptions options, OnUnpaired on_unpaired);

  // The pictures of one camera come in their order.
  void Add(core::CameraIndex camera, CapturedPicture picture);
  // Nobody waits for a camera that is gone.
  void SetGone(core::CameraIndex camera, bool is_gone);

  // The next set that is decided by `now`, if any.
  [[nodiscard]] std::optional<PictureSet> TryTake(CaptureClock::time_point now);
  // When the next set will be decided even if nothing comes. Nothing: no set has begun.
  [[nodiscard]] std::optional<CaptureClock::time_point> Deadline() const;

 private:
  static constexpr std::size_t kPeriods = 15;

  struct Camera {
    std::deque<CapturedPicture> waiting;
    bool is_gone = false;
    CaptureClock::duration offset{0};
    CaptureClock::duration period{0};  // the median of the last ones
    std::array<CaptureClock::duration, kPeriods> periods{};
    std::size_t next_period = 0;            // the oldest of them
    std::optional<CapturedPicture> newest;  // without its pixels
    CaptureClock::duration phase{0};        // how far its pictures lie behind the leader's, smoothed
    int phases = 0;                         // from how many sets that is known, up to a limit
  };
  // Which of a camera's pictures a set takes.
  struct Choice {
    std::optional<std::size_t> picture;  // among those that wait
    bool is_final = false;               // none that is nearer can come any more

    [[nodiscard]] bool has_picture() const { return picture.has_value(); }
  };
  using Instant = CaptureClock::time_point;

  [[nodiscard]] Instant TimeOf(core::CameraIndex camera, const CapturedPicture& picture) const;
  void FollowPeriod(Camera& camera, const CapturedPicture& picture);
  [[nodiscard]] std::optional<Instant> NextInstant() const;
  [[nodiscard]] std::optional<Instant> NextOfLeader(Instant least) const;
  [[nodiscard]] std::optional<Instant> EarliestAfter(Instant time) const;
  [[nodiscard]] Instant DueOf(core::CameraIndex camera, Instant instant) const;
  [[nodiscard]] Choice ChoiceOf(core::CameraIndex camera, Instant instant) const;
  [[nodiscard]] std::vector<Choice> ChoicesAt(Instant instant) const;
  [[nodiscard]] Instant DeadlineOf(const std::vector<Choice>& choices) const;
  [[nodiscard]] PictureSet TakeSet(Instant instant, const std::vector<Choice>& choices);
  void DropFirst(core::CameraIndex camera);
  void FollowPhases(Instant instant, const PictureSet& set);
  void ChooseLeader(bool must_change);
  [[nodiscard]] CaptureClock::duration SkewLedBy(core::CameraIndex camera) const;
  void Lead(core::CameraIndex camera);

  std::vector<Camera> cameras_;
  OnUnpaired on_unpaired_;
  core::CameraIndex leader_ = 0;
  std::optional<Instant> last_instant_;
  int sets_without_leader_ = 0;
  int sets_until_choice_ = 0;
};

}  // namespace elbowroom::recon
