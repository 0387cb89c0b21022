#include "app/control/reviewing/reviewed_session.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "app/control/outcome_tracker.h"
#include "app/control/reviewing/review_remarks.h"
#include "core/error.h"

namespace elbowroom::control {
namespace {

std::vector<std::size_t> WithAllCameras(const std::vector<sessions::FrameSummary>& frames,
                                        const std::vector<sessions::StampRow>& stamps) {
  std::set<core::FrameIndex> incomplete;
  for (const sessions::StampRow& row : stamps)
    if (row.LacksCamera()) incomplete.insert(row.frame);
  std::vector<std::size_t> positions;
  for (std::size_t i = 0; i < frames.size(); ++i)
    if (!incomplete.contains(frames[i].frame)) positions.push_back(i);
  return positions;
}

}  // namespace

ReviewedSession::ReviewedSession(const std::filesystem::path& path, const core::Progress& progress,
                                 const std::stop_token& stop)
    : path_(path) {
  progress.Report(0, 0, "checking the session");
  // The reader keeps its token for as long as it lives, which is longer than the opening.
  const std::stop_callback forward(stop, [this] { stop_.request_stop(); });
  reader_.emplace(OpenWithOutcome(path, progress, stop_.get_token()));
  header_ = reader_->header();
  status_ = reader_->status();
  frames_ = reader_->frames();
  if (frames_.empty())
    throw core::Error(core::ErrorKind::kRange,
                      fmt::format("session '{}' has no frames; record a trial first", path.string()));
  events_ = reader_->events();
  outcome_ = {reader_->episodes(), reader_->near_misses(), {}};
  heat_maps_ = reader_->heat_maps();
  part_totals_ = reader_->part_totals();
  std::vector<sessions::StampRow> stamps = reader_->stamp_rows();
  complete_ = WithAllCameras(frames_, stamps);
  if (header_.trial.required_clearance_mm > 0.0) motion_stamps_ = std::move(stamps);
  findings_ = reader_->findings();
  core::ThrowIfStopped(stop, "opening the session");
}

ReviewedSession::~ReviewedSession() = default;

std::size_t ReviewedSession::PositionAt(double time_s) const {
  const auto after = std::ranges::upper_bound(frames_, time_s, {}, &sessions::FrameSummary::time_s);
  return after == frames_.begin() ? 0 : static_cast<std::size_t>(std::distance(frames_.begin(), after)) - 1;
}

std::size_t ReviewedSession::PositionOf(core::FrameIndex frame) const {
  const auto at = std::ranges::lower_bound(frames_, frame, {}, &sessions::FrameSummary::frame);
  return std::min(static_cast<std::size_t>(std::distance(frames_.begin(), at)), frames_.size() - 1);
}

// Frames don't depend on the outcome, so that a session that was cut off needn't get its own again.
const sessions::SessionReader& ReviewedSession::Reader() const {
  if (!reader_) {
    reader_.emplace(path_, stop_.get_token());
    reader_->Freeze();
  }
  return *reader_;
}

core::FrameRecord ReviewedSession::ReadFrame(core::FrameIndex frame) const {
  const std::lock_guard lock(mutex_);
  return Reader().ReadFrame(frame);
}

std::vector<core::Finding> ReviewedSession::findings() const {
  const std::lock_guard lock(mutex_);
  return findings_;
}

void ReviewedSession::Say(std::span<const sessions::FindingRemark> remarks) {
  for (const sessions::FindingRemark& said : remarks) RequireFit(said.remark);
  const std::lock_guard lock(mutex_);
  Add(remarks);
}

sessions::ReviewImport ReviewedSession::Import(const std::filesystem::path& bcf_file) {
  const std::lock_guard lock(mutex_);
  sessions::ReviewImport import = ReadReview(bcf_file, path_, findings_);
  if (!import.remarks.empty()) Add(import.remarks);
  return import;
}

void ReviewedSession::Add(std::span<const sessions::FindingRemark> remarks) {
  for (const sessions::FindingRemark& said : remarks)
    core::Require(std::ranges::find(findings_, said.finding, &core::Finding::id) != findings_.end(),
                  "a remark is on a finding of the session");
  reader_.reset();  // whoever writes the file must be the only one of this program that has it open
  sessions::AddRemarks(path_, remarks);
  for (const sessions::FindingRemark& said : remarks)
    std::ranges::find(findings_, said.finding, &core::Finding::id)->remarks.push_back(said.remark);
}

}  // namespace elbowroom::control
