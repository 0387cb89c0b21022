#include "tests/accuracy/hard/case_costs.h"

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "recon/contours/silhouette.h"
#include "review/clearance.h"
#include "review/contact_heat.h"
#include "review/contacts.h"
#include "review/recovery.h"
#include "tests/accuracy/hard/hard_errors.h"

namespace elbowroom::accuracy {
namespace {

using Eigen::Vector3d;

// A hinge through a corner of the part's bounds, upright in the part's frame.
core::RecoveryRule HingeOf(const core::TriangleTree& tree) {
  core::RecoveryRule rule;
  rule.kind = core::RecoveryKind::kHinge;
  rule.axis_in_part = Vector3d::UnitZ();
  rule.at_in_part_mm = tree.bounds().min();
  return rule;
}

// Of all cameras' contours.
double EdgesOf(const recon::VisualHull& hull) {
  double edges = 0.0;
  for (const auto& silhouette : hull.silhouettes())
    edges += static_cast<double>(silhouette->labels().contour().edges.size());
  return edges;
}

// What is asked about one case.
class AskedCase {
 public:
  AskedCase(const SeenHull& seen, const HardCase& hard_case) : seen_(seen), case_(hard_case) {
    contact_ = review::FindContacts(*seen.hull, *case_.part.tree, case_.world_from_part, 0);
    if (is_contact())
      touched_ = review::FindTouchedPatches(*seen.hull, *case_.part.tree, case_.world_from_part,
                                            *case_.part.patches, contact_);
    errors_ = ErrorsOf(contact_, touched_, *seen.hull, case_);
  }

  void Add(const TimingEffort& effort, HardKinds* kinds) {
    const bool is_amid = case_.place == HardPlace::kAmid;
    if (is_contact()) {
      AskContacts(is_amid ? &kinds->contacts_amid : &kinds->contacts_touching);
      AskHeat(is_amid ? &kinds->heat_amid : &kinds->heat_touching);
      AskRecovery({}, &kinds->straight);
      AskRecovery(HingeOf(*case_.part.tree), &kinds->hinge);
    } else {
      AskContacts(&kinds->contacts_away);
      AskClearance(case_.part.encloses ? &kinds->around : &kinds->beside);
    }
    const std::vector<Timing> timings = TimeInTurns(jobs_, 1, effort);
    for (std::size_t i = 0; i < timings.size(); ++i)
      asked_[i].kind->costs.push_back({std::string(ToString(seen_.which)), case_.part.name,
                                       std::string(ToString(case_.place)), timings[i].median_ms,
                                       asked_[i].work});
  }

 private:
  struct Asked {
    HardKind* kind = nullptr;
    double work = 0.0;
  };

  [[nodiscard]] bool is_contact() const { return contact_.verdict == core::Verdict::kContact; }

  void Ask(HardKind* kind, double work, std::function<void()> job) {
    asked_.push_back({kind, work});
    jobs_.push_back(std::move(job));
  }

  void AskContacts(HardKind* kind) {
    Ask(kind, static_cast<double>(contact_.count.queries),
        [this] { (void)review::FindContacts(*seen_.hull, *case_.part.tree, case_.world_from_part, 0); });
    kind->Check(!errors_.is_missed && errors_.points_outside == 0, 0.0);
  }

  void AskHeat(HardKind* kind) {
    Ask(kind, static_cast<double>(touched_.size()), [this] {
      (void)review::FindTouchedPatches(*seen_.hull, *case_.part.tree, case_.world_from_part,
                                       *case_.part.patches, contact_);
    });
    kind->Check(errors_.missing_patches + errors_.extra_patches == 0, 0.0);
  }

  void AskClearance(HardKind* kind) {
    const review::Clearance found =
        review::FindClearance(*seen_.hull, *case_.part.tree, case_.world_from_part);
    Ask(kind, static_cast<double>(found.queries),
        [this] { (void)review::FindClearance(*seen_.hull, *case_.part.tree, case_.world_from_part); });
    const ClearanceErrors errors =
        ErrorsOf(found.interval, *seen_.hull, *case_.part.tree, case_.world_from_part);
    kind->Check(errors.bounds_hold, errors.upper_mm);
  }

  void AskRecovery(const core::RecoveryRule& rule, HardKind* kind) {
    if (!contact_.recovery) return;
    const Vector3d cp_obj = contact_.recovery->cp_obj_in_world_mm;
    const review::RecoveryWay way = review::WayOf(rule, *case_.part.tree, case_.world_from_part);
    Ask(kind, EdgesOf(*seen_.hull), [this, cp_obj, way] { (void)review::Recover(*seen_.hull, cp_obj, way); });
    const review::RecoveryAnswer answer = review::Recover(*seen_.hull, cp_obj, way);
    if (answer.status != core::RecoveryStatus::kFound) return;
    // CP_hull is on the hull's surface: no ball around it is wholly in the hull or wholly outside.
    constexpr double kOnSurfaceMm = 1e-4;
    const double off_mm = seen_.hull->Probe(answer.recovery->cp_hull_in_world_mm).radius_mm;
    kind->Check(off_mm <= kOnSurfaceMm, off_mm);
  }

  const SeenHull& seen_;
  const HardCase& case_;
  core::PartContact contact_;
  std::vector<review::TouchedPatch> touched_;
  ContactErrors errors_;
  std::vector<Asked> asked_;
  std::vector<std::function<void()>> jobs_;
};

}  // namespace

void AddCaseCosts(const SeenHull& seen, const HardCase& hard_case, const TimingEffort& effort,
                  HardKinds* kinds) {
  AskedCase(seen, hard_case).Add(effort, kinds);
}

}  // namespace elbowroom::accuracy
