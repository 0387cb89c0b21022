#include "app/control/frame_judge.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/error.h"
#include "recon/hull/visual_hull.h"

namespace elbowroom::control {
namespace {

// Memory for as many points is kept with each answer; a layout that keeps more of them allocates.
constexpr int kPointsReserved = 256;

// Whether the hull's errors by skew are the same in both frames: none in either.
bool IsSkewUnchanged(const FrameResult& last, const FrameResult& result) {
  if (!last.skew_errors || !result.skew_errors) return last.skew_errors == result.skew_errors;
  return last.skew_errors->is_still() && result.skew_errors->is_still();
}

bool IsUnchanged(const FrameResult* last, const FrameResult& result, core::PartIndex part) {
  return last != nullptr && last->hull == result.hull &&
         last->record.LacksCamera() == result.record.LacksCamera() && IsSkewUnchanged(*last, result) &&
         last->world_from_parts[part] == result.world_from_parts[part];
}

void Count(const core::PartContact& contact, SkipCount* skipped) {
  skipped->triangles_in_all += contact.count.triangles;
  skipped->triangles_skipped += contact.count.skipped;
  skipped->queries += contact.count.queries;
  if (!contact.clearance) return;
  skipped->clearance_queries += contact.clearance->queries;
  if (contact.contact_point_count > 0 || contact.contained_in_world_mm) {
    ++skipped->clearances_by_contact;
  } else if (contact.clearance->queries == 1) {
    ++skipped->clearances_by_ball;
  }
}

std::shared_ptr<const std::vector<core::TriangleTree>> TreesOf(const core::Layout& layout) {
  layout.Validate();
  auto trees = std::make_shared<std::vector<core::TriangleTree>>();
  for (const core::Part& part : layout.parts) trees->emplace_back(part.mesh);
  return trees;
}

}  // namespace

FrameJudge::FrameJudge(const core::Layout& layout, const review::PartReviewOptions& review)
    : FrameJudge(layout, review, TreesOf(layout)) {}

FrameJudge::FrameJudge(const core::Layout& layout, const review::PartReviewOptions& review,
                       SharedTrees part_trees)
    : layout_(layout), review_(review), part_trees_(std::move(part_trees)), scratch_(layout.parts.size()) {
  layout_.Validate();
  review_.Validate();
  for (const core::TriangleTree& part : *part_trees_) inside_parts_.emplace_back(part);
  tbb::parallel_for(std::size_t{0}, part_trees_->size(), [&](std::size_t i) {
    scratch_[i].stretches =
        review::ContactStretches::Make((*part_trees_)[i], review_.contacts.point_spacing_mm);
  });
}

void FrameJudge::Judge(const FrameResult* last, FrameResult* result) {
  known_.assign(part_trees_->size(), nullptr);
  for (core::PartIndex i = 0; i < known_.size(); ++i)
    if (IsUnchanged(last, *result, i)) known_[i] = &last->record.contacts[i];
  JudgeOthers(known_, result);
}

void FrameJudge::JudgeOthers(const KnownAnswers& known, FrameResult* result) {
  core::Require(known.size() == part_trees_->size(), "one answer, or none, a part");
  std::vector<core::PartContact>& contacts = result->record.contacts;
  contacts.resize(part_trees_->size());
  tbb::parallel_for(std::size_t{0}, contacts.size(), [&](std::size_t i) {
    contacts[i].points.reserve(
        static_cast<std::size_t>(std::min(review_.contacts.max_points, kPointsReserved)));
    if (known[i] != nullptr) {
      contacts[i] = *known[i];
      return;
    }
    std::vector<core::ContactPoint>& kept = scratch_[i].spread.kept;
    kept = std::move(contacts[i].points);
    contacts[i] = Review(*result, i);
    if (!contacts[i].points.empty()) return;
    contacts[i].points = std::move(kept);
    contacts[i].points.clear();
  });
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    if (known[i] != nullptr) {
      ++result->skipped.unchanged_parts;
    } else {
      Count(contacts[i], &result->skipped);
    }
  }
}

core::PartContact FrameJudge::Review(const FrameResult& result, core::PartIndex part) {
  review::PartReviewOptions options = review_;
  options.contacts.recovery = layout_.parts[part].recovery;
  options.lacks_camera = result.record.LacksCamera();
  options.skew_errors = result.skew_errors;
  return review::ReviewPart(*result.hull, (*part_trees_)[part], result.world_from_parts[part], part, options,
                            &inside_parts_[part], &scratch_[part]);
}

}  // namespace elbowroom::control
