#include "app/control/coverage/coverage_advice.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "app/control/coverage/coverage_text.h"
#include "core/units.h"

namespace elbowroom::control {
namespace {

using Eigen::Vector3d;
using recon::CoverageFigures;
using recon::CoverageNode;

// Where most of the nodes with a fault are, as ", mostly at x below 120 mm and z above 700 mm"; empty if they
// are all over.
std::string WhereMost(const CoverageOutcome& outcome,
                      const std::function<bool(const CoverageNode&)>& has_fault) {
  const Eigen::AlignedBox3d& box = outcome.rig.rig.workspace_mm;
  std::array<std::size_t, 3> low{}, high{};
  std::size_t all = 0;
  for (std::size_t i = 0; i < outcome.nodes.size(); ++i) {
    if (!has_fault(outcome.nodes[i])) continue;
    ++all;
    const Vector3d share = (outcome.grid.PointAt(i) - box.min()).cwiseQuotient(box.sizes());
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = share[static_cast<Eigen::Index>(axis)];
      low[axis] += at < 1.0 / 3.0 ? 1 : 0;
      high[axis] += at > 2.0 / 3.0 ? 1 : 0;
    }
  }
  constexpr double kMost = 0.6;
  std::string where;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto i = static_cast<Eigen::Index>(axis);
    const bool is_low = static_cast<double>(low[axis]) > kMost * static_cast<double>(all);
    if (!is_low && static_cast<double>(high[axis]) <= kMost * static_cast<double>(all)) continue;
    const double limit_mm = box.min()[i] + box.sizes()[i] * (is_low ? 1.0 : 2.0) / 3.0;
    where += fmt::format("{} {} {} {} mm", where.empty() ? ", mostly at" : " and", "xyz"[axis],
                         is_low ? "below" : "above", MmText(limit_mm));
  }
  return where;
}

void AddSeen(const CoverageOutcome& outcome, std::vector<std::string>* advice) {
  constexpr double kMuch = 0.05;
  const double by_few = 1.0 - outcome.figures.seen_share;
  if (by_few < kMuch) return;
  advice->push_back(fmt::format(
      "{} of the workspace is seen by fewer than two cameras{}: no point is located there; turn cameras "
      "there, add one, or "
      "make workspace_mm smaller",
      PercentText(by_few), WhereMost(outcome, [](const CoverageNode& node) { return node.cameras < 2; })));
}

// The camera that sees the fewest nodes.
std::string SeesLeast(const CoverageOutcome& outcome) {
  std::size_t least = 0;
  std::ptrdiff_t fewest = -1;
  const std::size_t step = outcome.nodes.size() / 5000 + 1;
  for (std::size_t camera = 0; camera < outcome.rig.rig.cameras.size(); ++camera) {
    std::ptrdiff_t seen = 0;
    for (std::size_t i = 0; i < outcome.nodes.size(); i += step)
      seen += recon::IsInPicture(outcome.rig.rig.cameras[camera], outcome.grid.PointAt(i)) ? 1 : 0;
    if (fewest >= 0 && seen >= fewest) continue;
    fewest = seen;
    least = camera;
  }
  return outcome.rig.rig.cameras[least].name();
}

void AddReach(const CoverageOutcome& outcome, std::vector<std::string>* advice) {
  constexpr double kMost = 0.95;
  if (outcome.figures.reach_share >= kMost) return;
  const std::string where = WhereMost(outcome, [](const CoverageNode& node) { return !node.in_reach; });
  if (outcome.rig.rig.unseen == core::UnseenPolicy::kAbstain) {
    advice->push_back(fmt::format("no camera sees {} of the workspace{}: nothing is found there",
                                  PercentText(1.0 - outcome.figures.reach_share), where));
    return;
  }
  advice->push_back(
      fmt::format("with `unseen: outside` a thing is found only where all cameras see it, which is {} of the "
                  "workspace; it is lost in the "
                  "rest{}. Camera '{}' sees the least: turn it or move it back, or set `unseen: abstain` in "
                  "the rig's file",
                  PercentText(outcome.figures.reach_share), where, SeesLeast(outcome)));
}

void AddSides(const core::Rig& rig, std::vector<std::string>* advice) {
  constexpr double kNarrowDeg = 50.0;
  if (rig.cameras.size() < 2) {
    advice->emplace_back(
        "one camera can't tell how far away a thing is; add a second one, across its line of sight");
    return;
  }
  double least_cosine = 1.0;
  const Vector3d middle = rig.workspace_mm.center();
  for (const core::CameraModel& a : rig.cameras)
    for (const core::CameraModel& b : rig.cameras)
      least_cosine = std::min(
          least_cosine,
          (a.center_in_world() - middle).normalized().dot((b.center_in_world() - middle).normalized()));
  const double widest_deg = core::DegreesFromRadians(std::acos(std::clamp(least_cosine, -1.0, 1.0)));
  if (widest_deg >= kNarrowDeg) return;
  advice->push_back(
      fmt::format("all cameras look from one side (no two directions to the middle of the workspace are more "
                  "than {:.0f} deg apart): the "
                  "distance from them is known badly, and what is behind a thing isn't refuted; put one "
                  "across their line of sight",
                  widest_deg));
}

void AddCalibration(const CoverageOutcome& outcome, std::vector<std::string>* advice) {
  constexpr double kHalf = 0.5;
  const auto& today = outcome.figures.uncertainty_mm;
  if (!today || !outcome.exact_uncertainty_mm || *outcome.exact_uncertainty_mm > kHalf * today->median)
    return;
  advice->push_back(
      fmt::format("most of a point's error is that of the calibration: exact cameras would locate it to {} "
                  "mm instead of {} mm (median); "
                  "calibrate with more pictures of the board before adding a camera",
                  MmText(*outcome.exact_uncertainty_mm), MmText(today->median)));
}

void AddParts(const CoverageOutcome& outcome, std::vector<std::string>* advice) {
  constexpr double kWorse = 1.5, kMuch = 0.05;
  for (const PartCoverage& part : outcome.parts) {
    if (part.figures.nodes == 0) continue;
    if (part.figures.seen_share < 1.0 - kMuch) {
      advice->push_back(fmt::format("near part '{}' {} of the space is seen by fewer than two cameras",
                                    part.name, PercentText(1.0 - part.figures.seen_share)));
    } else if (part.figures.uncertainty_mm && outcome.figures.uncertainty_mm &&
               part.figures.uncertainty_mm->median > kWorse * outcome.figures.uncertainty_mm->median) {
      advice->push_back(fmt::format(
          "near part '{}' a point is located to {} mm (median), in the whole workspace to {} mm: a "
          "camera nearer to it would help",
          part.name, MmText(part.figures.uncertainty_mm->median),
          MmText(outcome.figures.uncertainty_mm->median)));
    }
  }
}

// "the error of a point from 1.8 to 1.2 mm (median) and from 4 to 2 mm (95 %)"
std::string Change(const CoverageFigures& before, const CoverageFigures& after) {
  std::string text;
  const auto add = [&](const std::string& what) { text += (text.empty() ? "" : ", ") + what; };
  if (before.uncertainty_mm && after.uncertainty_mm) {
    const bool is_over_more = after.seen_share > before.seen_share + 0.01;
    add(fmt::format("the error of a point from {} to {} mm (median) and from {} to {} mm (95 %{})",
                    MmText(before.uncertainty_mm->median), MmText(after.uncertainty_mm->median),
                    MmText(before.uncertainty_mm->p95), MmText(after.uncertainty_mm->p95),
                    is_over_more ? ", of more space" : ""));
  } else if (after.uncertainty_mm) {
    add(fmt::format("the error of a point from unknown to {} mm (median)",
                    MmText(after.uncertainty_mm->median)));
  }
  if (before.phantom_fraction && after.phantom_fraction)
    add(fmt::format("the phantom share from {} to {} (median)", PercentText(before.phantom_fraction->median),
                    PercentText(after.phantom_fraction->median)));
  const auto moved = [&](const char* what, double from, double to) {
    if (std::abs(to - from) >= 0.005)
      add(fmt::format("{} from {} to {}", what, PercentText(from), PercentText(to)));
  };
  moved("the space that two cameras see", before.seen_share, after.seen_share);
  moved("the space in which a thing is found", before.reach_share, after.reach_share);
  return text;
}

void AddNext(const CoverageOutcome& outcome, std::vector<std::string>* advice) {
  if (!outcome.next) return;
  const recon::NextCamera& next = *outcome.next;
  if (next.best.empty()) {
    advice->push_back(fmt::format(
        "none of {} places and directions tried for another camera makes the rig better", next.tried));
    return;
  }
  // A gain of 0.05 is about a twentieth of the error and the phantom volume together.
  constexpr double kLittle = 0.05;
  const bool is_little = next.best.front().gain < kLittle;
  for (std::size_t i = 0; i < next.best.size(); ++i) {
    if (is_little && i > 0) break;
    const recon::ProposedCamera& camera = next.best[i];
    const bool at_middle = (camera.look_at_mm - outcome.rig.rig.workspace_mm.center()).norm() < 1e-6;
    advice->push_back(
        fmt::format("{}{} camera at {}, with the lens of '{}', looking at {}, changes {}{}",
                    is_little ? "another camera buys little: "
                    : i == 0  ? ""
                              : "or: ",
                    OrdinalText(outcome.rig.rig.cameras.size() + 1), PlaceText(camera.center_mm),
                    outcome.rig.rig.cameras[next.lens_of].name(),
                    at_middle ? std::string("the middle of the workspace") : PlaceText(camera.look_at_mm),
                    Change(next.before, camera.after),
                    next.near_before && camera.near_after
                        ? fmt::format("; near the parts {}", Change(*next.near_before, *camera.near_after))
                        : ""));
  }
}

}  // namespace

std::vector<std::string> CoverageAdvice(const CoverageOutcome& outcome) {
  std::vector<std::string> advice;
  AddSeen(outcome, &advice);
  AddReach(outcome, &advice);
  AddSides(outcome.rig.rig, &advice);
  AddCalibration(outcome, &advice);
  AddParts(outcome, &advice);
  AddNext(outcome, &advice);
  return advice;
}

}  // namespace elbowroom::control
