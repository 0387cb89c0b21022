#include "app/console/contact_model.h"

#include <QLocale>
#include <array>
#include <cmath>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/lower_bound_text.h"

namespace elbowroom::console {
namespace {

struct Heading {
  const char* text;
  const char* explanation;
};
constexpr std::array<Heading, ContactModel::kColumns> kContactHeadings = {
    {{QT_TRANSLATE_NOOP("elbowroom::console::ContactModel", "Part"),
      QT_TRANSLATE_NOOP("elbowroom::console::ContactModel",
                        "Parts of the layout that something real touches in this frame")},
     {QT_TRANSLATE_NOOP("elbowroom::console::ContactModel", "Depth ≥ mm"),
      QT_TRANSLATE_NOOP("elbowroom::console::ContactModel",
                        "Certified lower bound of the deepest point's distance to the hull's surface")},
     {QT_TRANSLATE_NOOP("elbowroom::console::ContactModel", "Area mm²"),
      QT_TRANSLATE_NOOP("elbowroom::console::ContactModel", "Surface of the part that lies in the hull")},
     {QT_TRANSLATE_NOOP("elbowroom::console::ContactModel", "Points"),
      QT_TRANSLATE_NOOP("elbowroom::console::ContactModel", "Sampled surface points that lie in the hull")},
     {QT_TRANSLATE_NOOP("elbowroom::console::ContactModel", "Deepest at mm"),
      QT_TRANSLATE_NOOP("elbowroom::console::ContactModel",
                        "The deepest point in the world frame: x, y, z")}}};

QString PositionText(const core::PartContact& contact) {
  if (!contact.deepest) return "–";
  const Eigen::Vector3d& position_mm = contact.deepest->position_in_world_mm;
  const auto text = [](double coordinate_mm) {
    return QString::number(std::round(coordinate_mm) + 0.0, 'f', 0);  // + 0.0: no "-0"
  };
  return text(position_mm.x()) + ", " + text(position_mm.y()) + ", " + text(position_mm.z());
}

QString CellText(const core::PartContact& contact, int column) {
  switch (column) {
    case ContactModel::kDepth:
      return contact.deepest ? LowerBoundText(contact.deepest->depth_mm) : "–";
    case ContactModel::kArea:
      return QLocale().toString(contact.contact_area_mm2, 'f', 0);
    case ContactModel::kPoints:
      return QLocale().toString(static_cast<qlonglong>(contact.contact_point_count));
    case ContactModel::kPosition:
      return PositionText(contact);
    default:
      return {};
  }
}

}  // namespace

void ContactModel::ShowFrame(const control::FrameResult& result) {
  std::vector<Row> rows;
  for (const core::PartContact& contact : result.record.contacts) {
    if (contact.verdict != core::Verdict::kContact) continue;
    Row row{QString::fromStdString(result.layout->parts[contact.part].name), contact};
    row.contact.points.clear();
    rows.push_back(std::move(row));
  }
  ShowRows(std::move(rows));
}

void ContactModel::Clear() { ShowRows({}); }

void ContactModel::ShowRows(std::vector<Row> rows) {
  const bool is_same_count = rows.size() == rows_.size();
  if (!is_same_count) beginResetModel();
  rows_ = std::move(rows);
  if (!is_same_count) {
    endResetModel();
  } else if (!rows_.empty()) {
    emit dataChanged(index(0, 0), index(rowCount() - 1, kColumns - 1));
  }
}

int ContactModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(rows_.size());
}

int ContactModel::columnCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : kColumns; }

QVariant ContactModel::data(const QModelIndex& index, int role) const {
  const Row& row = rows_.at(static_cast<std::size_t>(index.row()));
  if (role == Qt::DisplayRole) {
    return index.column() == kPart ? row.part : CellText(row.contact, index.column());
  }
  if (role == Qt::TextAlignmentRole) {
    return QVariant((index.column() == kPart ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter);
  }
  if (role == Qt::BackgroundRole) return ThemeColors().contact_tint;
  if (role == Qt::ForegroundRole && index.column() == kPart) return ThemeColors().contact;
  return {};
}

QVariant ContactModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= kColumns) return {};
  const Heading& heading = kContactHeadings.at(static_cast<std::size_t>(section));
  if (role == Qt::DisplayRole) return tr(heading.text);
  if (role == Qt::ToolTipRole) return tr(heading.explanation);
  if (role == Qt::TextAlignmentRole) {
    return QVariant((section == kPart ? Qt::AlignLeft : Qt::AlignRight) | Qt::AlignVCenter);
  }
  return {};
}

}  // namespace elbowroom::console
