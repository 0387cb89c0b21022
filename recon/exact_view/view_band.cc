#include "recon/exact_view/view_band.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/infinity.h"
#include "recon/exact_view/cast_intervals.h"

namespace elbowroom::recon {
namespace {

using core::kInfinity;
constexpr double kHalfUlp = 1.0 / (1 << 24);  // of float32, relative: one rounding
// Roundings in u * du + v * dv + at_origin: three of a term at most, and room for their products.
constexpr double kFormRoundings = 4.0;
// Roundings of an angle beside those of its x and y: a sum, a quotient to 2.5 ulp as OpenGL has it, a
// difference.
constexpr double kAngleRoundings = 8.0;
// If the errors of x and y are more than this share of their size, the ray is so near to the pencil's axis
// that float32 may give it any angle.
constexpr double kMostRelativeError = 0.01;
// Leaves room for the division that turns a key into a depth.
constexpr double kMostShareOfTolerance = 0.9;

// The values that float32 may give for a number.
struct Range {
  double low = -kInfinity;
  double high = -kInfinity;
};

Range Around(double value, double error) { return {value - error, value + error}; }

struct Ray {
  double u;
  double v;
};

struct Rounded {
  double value;
  double error;
};

Rounded ValueOf(const CastForm& form, const Ray& ray) {
  const double du = ray.u * form.du, dv = ray.v * form.dv, at_origin = form.at_origin;
  const double terms = std::abs(du) + std::abs(dv) + std::abs(at_origin);
  return {du + dv + at_origin, kFormRoundings * kHalfUlp * terms};
}

Range KeyOf(const CastForm& form, const Ray& ray) {
  const Rounded key = ValueOf(form, ray);
  return Around(key.value, key.error);
}

// Nothing if float32 may give any angle: near the pencil's axis, and across the negative x axis.
std::optional<Range> AngleOf(const CastPencil& pencil, const Ray& ray) {
  const Rounded x = ValueOf(pencil.x, ray), y = ValueOf(pencil.y, ray);
  const double size = std::abs(x.value) + std::abs(y.value);
  if (!(x.error + y.error < kMostRelativeError * size)) return std::nullopt;
  const double error = (std::abs(y.value) * x.error + std::abs(x.value) * y.error) / (size * size);
  const Range range = Around(PencilAngle(x.value, y.value), error + kAngleRoundings * kHalfUlp);
  // Across the negative x axis, where angles jump.
  if (range.low <= -2.0 || range.high >= 2.0) return std::nullopt;
  return range;
}

// A crossing of one caster's contour.
struct Event {
  Range key;
  bool is_entry = false;
  bool is_sure = false;  // exactly one crossing in the range; otherwise one or none
};

// The edges of a kind that rays at an angle in the range may be on.
std::vector<CastEdge> EdgesAt(const CastPencil& pencil, bool is_entry, const Range& angle) {
  const auto [first, last] = IntervalsOf(pencil, BinOf(pencil, angle.low), BinOf(pencil, angle.high));
  std::vector<std::uint32_t> numbers;
  for (std::size_t interval = first; interval <= last; ++interval) {
    const CastIntervals::Run run = pencil.intervals.RunOf(interval);
    for (std::size_t i = run.begin; i < run.end; ++i) {
      const auto number = static_cast<std::uint32_t>(pencil.intervals.crossings[i].edge());
      const CastEdge& edge = pencil.edges[number];
      if (edge.is_entry == is_entry && edge.from <= angle.high && edge.to > angle.low)
        numbers.push_back(number);
    }
  }
  std::ranges::sort(numbers);
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  std::vector<CastEdge> found;
  for (const std::uint32_t number : numbers) found.push_back(pencil.edges[number]);
  return found;
}

// Edges that end where others begin are one surface: as ends are compared with one and the same angle,
// exactly one edge of a chain across the range is met. An edge that goes all the way across is a chain of its
// own.
void AddEvents(const CastPencil& pencil, bool is_entry, const Range& angle, const Ray& ray,
               std::vector<Event>* events) {
  std::vector<CastEdge> loose = EdgesAt(pencil, is_entry, angle);
  const auto take = [&](const auto& is_next) -> std::optional<CastEdge> {
    const auto found = std::find_if(loose.begin(), loose.end(), is_next);
    if (found == loose.end()) return std::nullopt;
    const CastEdge edge = *found;
    *found = loose.back();
    loose.pop_back();
    return edge;
  };
  while (auto edge = take([&](const CastEdge& e) { return e.from <= angle.low; })) {
    Event event{KeyOf(edge->key, ray), is_entry, false};
    float end = edge->to;
    while (end <= angle.high) {
      edge = take([&](const CastEdge& e) { return e.from == end; });
      if (!edge) break;
      const Range key = KeyOf(edge->key, ray);
      event.key = {std::min(event.key.low, key.low), std::max(event.key.high, key.high)};
      end = edge->to;
    }
    event.is_sure = end > angle.high;
    events->push_back(event);
  }
  for (const CastEdge& edge : loose) events->push_back({KeyOf(edge.key, ray), is_entry, false});
}

// A caster's label at a key: certain, or either of the two, depending on the rounding.
enum class RayLabel { kOutside, kEither, kInside };

// From `key` on, `caster` has this label.
struct Change {
  double key = 0.0;
  std::size_t caster = 0;
  RayLabel label = RayLabel::kEither;
};

// A caster's label after some events whose order isn't certain. It is certain only if all of them are
// entries, or all exits, and if one of them is sure to happen or the label was the same before.
RayLabel LabelAfter(std::span<const Event> events, RayLabel before) {
  const bool is_entry = events.front().is_entry;
  const RayLabel label = is_entry ? RayLabel::kInside : RayLabel::kOutside;
  const bool are_alike = std::all_of(events.begin(), events.end(),
                                     [&](const Event& event) { return event.is_entry == is_entry; });
  const bool are_sure =
      std::any_of(events.begin(), events.end(), [](const Event& event) { return event.is_sure; });
  return are_alike && (are_sure || before == label) ? label : RayLabel::kEither;
}

// Adds the changes of label that the events make. Events whose ranges of keys overlap form a group, as they
// may come in any order: the label is uncertain from the group's lowest key to its highest.
void AddChanges(std::vector<Event> events, std::size_t caster, RayLabel label, std::vector<Change>* changes) {
  std::sort(events.begin(), events.end(),
            [](const Event& a, const Event& b) { return a.key.low < b.key.low; });
  for (std::size_t begin = 0, end = 0; begin < events.size(); begin = end) {
    double high = events[begin].key.high;
    for (end = begin + 1; end < events.size() && events[end].key.low <= high; ++end)
      high = std::max(high, events[end].key.high);
    changes->push_back({events[begin].key.low, caster, RayLabel::kEither});
    label = LabelAfter(std::span(events).subspan(begin, end - begin), label);
    changes->push_back({high, caster, label});
  }
}

// One ray in the workspace: finds where the hull may begin, and where it must have begun.
class Course {
 public:
  Course(const ViewPencils& pencils, const Eigen::Vector2d& uv)
      : pencils_(pencils), uv_(uv), ray_{static_cast<float>(uv.x()), static_cast<float>(uv.y())} {}

  [[nodiscard]] bool IsUndecided() {
    Clip();
    if (is_beside_ == RayLabel::kInside || from_.low > to_.high) return false;
    for (const auto& pencil : pencils_.cameras()) Add(*pencil);
    for (const auto& pencil : pencils_.visibility_outlines()) Add(*pencil);
    std::stable_sort(changes_.begin(), changes_.end(),
                     [](const Change& a, const Change& b) { return a.key < b.key; });
    // Whatever the rounding, the hull begins between the key where it first may and the one where it first
    // must.
    const double may = FirstKey(RayLabel::kEither, from_.low), must = FirstKey(RayLabel::kInside, from_.high);
    if (may > to_.high) return false;
    if (is_beside_ == RayLabel::kEither || must > to_.low) return true;
    return !(may == must ||
             must - may < kMostShareOfTolerance * kViewTolerance * std::min(std::abs(may), std::abs(must)));
  }

 private:
  void Clip() {
    to_ = {pencils_.key_end(), pencils_.key_end()};
    for (const CastForm& form : pencils_.box().not_before) {
      const Range key = KeyOf(form, ray_);
      from_ = {std::max(from_.low, key.low), std::max(from_.high, key.high)};
    }
    for (const CastForm& form : pencils_.box().not_after) {
      const Range key = KeyOf(form, ray_);
      to_ = {std::min(to_.low, key.low), std::min(to_.high, key.high)};
    }
    for (const CastForm& form : pencils_.box().beside) {
      const Range side = KeyOf(form, ray_);
      is_beside_ = std::max(is_beside_, side.high < 0.0   ? RayLabel::kInside
                                        : side.low <= 0.0 ? RayLabel::kEither
                                                          : RayLabel::kOutside);
    }
  }

  void Add(const EpipolarEdges& pencil) {
    const std::size_t caster = words_.size();
    const bool is_object = pencil.is_concentric() ? pencil.IsObjectAlong(uv_) : pencil.starts_inside();
    words_.push_back(is_object ? RayLabel::kInside : RayLabel::kOutside);
    const CastPencil& cast = pencil.cast();
    if (cast.edges.empty()) return;
    const std::optional<Range> angle = AngleOf(cast, ray_);
    if (!angle) {
      words_.back() = RayLabel::kEither;
      return;
    }
    std::vector<Event> events;
    AddEvents(cast, true, *angle, ray_, &events);
    AddEvents(cast, false, *angle, ray_, &events);
    AddChanges(std::move(events), caster, words_.back(), &changes_);
  }

  // Whether all cameras have at least this label, and one of the visibility outlines, too, if there are any.
  [[nodiscard]] bool Agree(const std::vector<RayLabel>& words, RayLabel least) const {
    const auto cameras_end = words.begin() + std::ssize(pencils_.cameras());
    const auto says = [&](RayLabel label) { return label >= least; };
    return std::all_of(words.begin(), cameras_end, says) &&
           (cameras_end == words.end() || std::any_of(cameras_end, words.end(), says));
  }

  // The first key from `from` on at which they agree; infinite if there is none.
  [[nodiscard]] double FirstKey(RayLabel least, double from) const {
    std::vector<RayLabel> words = words_;
    double at = from;
    for (std::size_t next = 0;;) {
      for (; next < changes_.size() && changes_[next].key <= at; ++next)
        words[changes_[next].caster] = changes_[next].label;
      if (Agree(words, least)) return at;
      if (next == changes_.size()) return kInfinity;
      at = changes_[next].key;
    }
  }

  const ViewPencils& pencils_;
  Eigen::Vector2d uv_;
  Ray ray_;
  Range from_;
  Range to_;
  RayLabel is_beside_ = RayLabel::kOutside;  // kInside: it certainly is
  std::vector<RayLabel> words_;              // before all changes; cameras, then visibility_outlines
  std::vector<Change> changes_;
};

}  // namespace

bool ViewBand::Contains(int x, int y) const {
  const Eigen::Vector2d uv = pencils_.rays().At(x, y);
  if (std::isnan(uv.x())) return false;
  return Course(pencils_, uv).IsUndecided();
}

}  // namespace elbowroom::recon
