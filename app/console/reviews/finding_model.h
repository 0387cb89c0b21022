// Touches and near misses as rows.
#pragma once

#include <QAbstractTableModel>
#include <QSortFilterProxyModel>
#include <QString>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "app/control/reviewing/listed_findings.h"
#include "core/findings/finding.h"

namespace elbowroom::console {

// One row a finding, in the list's order. Those that vanish at the gaps that are tried are grey and struck
// out. Thread: UI.
class FindingModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { kName, kPart, kStatus, kTime, kMeasure, kRemarks, kColumns };

  using QAbstractTableModel::QAbstractTableModel;

  void Open(std::vector<control::ListedFinding> findings);
  // Places in the list; `gaps`: the gaps in words.
  void ShowVanished(std::set<std::size_t> vanished, const QString& gaps);

  [[nodiscard]] const std::vector<control::ListedFinding>& findings() const { return findings_; }

  [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
  [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
  [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override;
  [[nodiscard]] QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  [[nodiscard]] QVariant CellText(const control::ListedFinding& listed, int column) const;
  [[nodiscard]] QString TipOf(const control::ListedFinding& listed, bool is_vanished) const;

  std::vector<control::ListedFinding> findings_;
  std::set<std::size_t> vanished_;
  QString gaps_;
};

// Those of one status, of one part, or of both.
class FindingFilter : public QSortFilterProxyModel {
 public:
  using QSortFilterProxyModel::QSortFilterProxyModel;

  void ShowOnly(std::optional<core::ReviewStatus> status, const QString& part);  // part empty: of any

 protected:
  [[nodiscard]] bool filterAcceptsRow(int row, const QModelIndex& parent) const override;

 private:
  std::optional<core::ReviewStatus> status_;
  QString part_;
};

[[nodiscard]] QString StatusText(core::ReviewStatus status);  // "new", "active", ...
// core::NameOf, in the user's language: "touch 3".
[[nodiscard]] QString FindingText(const core::Finding& finding);

}  // namespace elbowroom::console
