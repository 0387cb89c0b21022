#include "app/console/touch_model.h"

#include <QLocale>
#include <array>

#include "app/console/desktop/theme.h"
#include "app/console/lower_bound_text.h"
#include "app/console/view/verdict_word.h"

namespace elbowroom::console {
namespace {

constexpr std::array<const char*, TouchModel::kColumns> kTouchHeadings = {
    QT_TRANSLATE_NOOP("elbowroom::console::TouchModel", "Part"),
    QT_TRANSLATE_NOOP("elbowroom::console::TouchModel", "Now"),
    QT_TRANSLATE_NOOP("elbowroom::console::TouchModel", "Touches"),
    QT_TRANSLATE_NOOP("elbowroom::console::TouchModel", "Frames"),
    QT_TRANSLATE_NOOP("elbowroom::console::TouchModel", "Deepest ≥ mm")};

Qt::Alignment AlignmentOf(int column) {
  const bool is_text = column == TouchModel::kPart || column == TouchModel::kState;
  return (is_text ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter;
}

QColor ColorOf(std::optional<core::Verdict> verdict) {
  if (!verdict) return ThemeColors().quiet_text;
  switch (*verdict) {
    case core::Verdict::kContact:
      return ThemeColors().contact;
    case core::Verdict::kClear:
      return ThemeColors().clear;
    case core::Verdict::kNear:
    case core::Verdict::kUndecided:
      break;
  }
  return ThemeColors().quiet_text;
}

}  // namespace

void TouchModel::Open(const core::Layout& layout) {
  beginResetModel();
  rows_.clear();
  for (const core::Part& part : layout.parts) rows_.push_back({QString::fromStdString(part.name), {}, {}});
  endResetModel();
}

void TouchModel::ShowFrame(const control::FrameResult& result,
                           const std::vector<control::PartTally>& tallies) {
  for (std::size_t i = 0; i < rows_.size() && i < tallies.size(); ++i) {
    rows_[i].verdict = result.record.contacts[i].verdict;
    rows_[i].tally = tallies[i];
  }
  if (!rows_.empty()) emit dataChanged(index(0, kState), index(rowCount() - 1, kColumns - 1));
}

int TouchModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int TouchModel::columnCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : kColumns; }

QVariant TouchModel::CellText(const Row& row, int column) const {
  switch (column) {
    case kPart:
      return row.part;
    case kState:
      return row.verdict ? VerdictWord(*row.verdict) : QString("–");
    case kTouches:
      return QLocale().toString(static_cast<qlonglong>(row.tally.episodes));
    case kFrames:
      return QLocale().toString(static_cast<qlonglong>(row.tally.frames_in_contact));
    case kDeepest:
      return row.tally.episodes == 0 ? QString("–") : LowerBoundText(row.tally.deepest_mm);
    default:
      return {};
  }
}

QVariant TouchModel::data(const QModelIndex& index, int role) const {
  const Row& row = rows_.at(static_cast<std::size_t>(index.row()));
  if (role == Qt::DisplayRole) return CellText(row, index.column());
  if (role == Qt::TextAlignmentRole) return QVariant(AlignmentOf(index.column()));
  if (role == Qt::ForegroundRole && index.column() == kState) return ColorOf(row.verdict);
  return {};
}

QVariant TouchModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= kColumns) return {};
  if (role == Qt::DisplayRole) return tr(kTouchHeadings.at(static_cast<std::size_t>(section)));
  if (role == Qt::TextAlignmentRole) return QVariant(AlignmentOf(section));
  return {};
}

}  // namespace elbowroom::console
