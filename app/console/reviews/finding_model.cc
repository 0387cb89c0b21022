#include "app/console/reviews/finding_model.h"

#include <QFont>
#include <array>
#include <cmath>
#include <utility>

#include "app/console/desktop/theme.h"

namespace elbowroom::console {
namespace {

constexpr std::array<const char*, FindingModel::kColumns> kHeadings = {
    QT_TRANSLATE_NOOP("elbowroom::console::FindingModel", "Finding"),
    QT_TRANSLATE_NOOP("elbowroom::console::FindingModel", "Part"),
    QT_TRANSLATE_NOOP("elbowroom::console::FindingModel", "Status"),
    QT_TRANSLATE_NOOP("elbowroom::console::FindingModel", "At, s"),
    QT_TRANSLATE_NOOP("elbowroom::console::FindingModel", "mm"),
    QT_TRANSLATE_NOOP("elbowroom::console::FindingModel", "Said")};

// A depth is a lower bound, and rounded down; a clearance an upper bound, and rounded up.
QString MeasureText(const control::ListedFinding& listed) {
  if (listed.depth_mm) return "≥ " + QString::number(std::floor(10.0 * *listed.depth_mm) / 10.0, 'f', 1);
  if (listed.clearance_mm && std::isfinite(*listed.clearance_mm))
    return "≤ " + QString::number(std::ceil(10.0 * *listed.clearance_mm) / 10.0, 'f', 1);
  return "–";
}

}  // namespace

QString StatusText(core::ReviewStatus status) {
  switch (status) {
    case core::ReviewStatus::kNew:
      return FindingModel::tr("new");
    case core::ReviewStatus::kActive:
      return FindingModel::tr("active");
    case core::ReviewStatus::kReviewed:
      return FindingModel::tr("reviewed");
    case core::ReviewStatus::kApproved:
      return FindingModel::tr("approved");
    case core::ReviewStatus::kResolved:
      return FindingModel::tr("resolved");
  }
  return {};
}

QString FindingText(const core::Finding& finding) {
  const bool is_touch = finding.kind == core::FindingKind::kTouch;
  if (finding.presence != core::FindingPresence::kHere)
    return is_touch ? FindingModel::tr("touch") : FindingModel::tr("near miss");
  return (is_touch ? FindingModel::tr("touch %1") : FindingModel::tr("near miss %1")).arg(finding.number);
}

void FindingModel::Open(std::vector<control::ListedFinding> findings) {
  beginResetModel();
  findings_ = std::move(findings);
  vanished_.clear();
  endResetModel();
}

void FindingModel::ShowVanished(std::set<std::size_t> vanished, const QString& gaps) {
  vanished_ = std::move(vanished);
  gaps_ = gaps;
  if (!findings_.empty()) emit dataChanged(index(0, 0), index(rowCount() - 1, kColumns - 1));
}

int FindingModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(findings_.size());
}

int FindingModel::columnCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : kColumns; }

QVariant FindingModel::CellText(const control::ListedFinding& listed, int column) const {
  switch (column) {
    case kName:
      return FindingText(listed.finding);
    case kPart:
      return QString::fromStdString(listed.finding.part);
    case kStatus:
      return StatusText(listed.finding.status());
    case kTime:
      return QString::number(listed.worst_s, 'f', 2);
    case kMeasure:
      return MeasureText(listed);
    case kRemarks:
      return listed.finding.remarks.empty() ? QString() : QString::number(std::ssize(listed.finding.remarks));
    default:
      return {};
  }
}

QString FindingModel::TipOf(const control::ListedFinding& listed, bool is_vanished) const {
  QString tip = listed.finding.kind == core::FindingKind::kTouch
                    ? tr("Touched from %1 to %2 s; mm: at least so deep")
                    : tr("Nearer than required from %1 to %2 s; mm: at most so far away");
  tip = tip.arg(listed.finding.begin_s, 0, 'f', 2).arg(listed.finding.end_s, 0, 'f', 2);
  if (!listed.worst_position) tip += tr("; it isn't in this session any more");
  for (const std::string& tool : listed.tools) tip += tr("; with %1").arg(QString::fromStdString(tool));
  if (is_vanished)
    tip +=
        (listed.finding.kind == core::FindingKind::kTouch ? tr("; no touch at %1") : tr("; not there at %1"))
            .arg(gaps_);
  return tip;
}

QVariant FindingModel::data(const QModelIndex& index, int role) const {
  const auto place = static_cast<std::size_t>(index.row());
  const control::ListedFinding& listed = findings_.at(place);
  const bool is_vanished = vanished_.contains(place) || !listed.worst_position;
  switch (role) {
    case Qt::DisplayRole:
      return CellText(listed, index.column());
    case Qt::ToolTipRole:
      return TipOf(listed, vanished_.contains(place));
    case Qt::TextAlignmentRole:
      return QVariant((index.column() >= kTime ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
    case Qt::ForegroundRole:
      if (is_vanished) return ThemeColors().quiet_text;
      if (index.column() != kName) return {};
      return listed.finding.kind == core::FindingKind::kTouch ? ThemeColors().contact
                                                              : ThemeColors().attention;
    case Qt::FontRole: {
      QFont font;
      font.setStrikeOut(is_vanished && index.column() == kName);
      return font;
    }
    default:
      return {};
  }
}

QVariant FindingModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= kColumns) return {};
  if (role == Qt::DisplayRole) return tr(kHeadings.at(static_cast<std::size_t>(section)));
  if (role == Qt::TextAlignmentRole)
    return QVariant((section >= kTime ? Qt::AlignRight : Qt::AlignLeft) | Qt::AlignVCenter);
  return {};
}

void FindingFilter::ShowOnly(std::optional<core::ReviewStatus> status, const QString& part) {
  status_ = status;
  part_ = part;
  invalidateFilter();
}

bool FindingFilter::filterAcceptsRow(int row, const QModelIndex& /*parent*/) const {
  const auto* model = static_cast<const FindingModel*>(sourceModel());
  const core::Finding& finding = model->findings().at(static_cast<std::size_t>(row)).finding;
  return (!status_ || finding.status() == *status_) &&
         (part_.isEmpty() || QString::fromStdString(finding.part) == part_);
}

}  // namespace elbowroom::console
