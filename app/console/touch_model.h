// The state and the touches so far of every part, as rows.
#pragma once

#include <QAbstractTableModel>
#include <QString>
#include <optional>
#include <vector>

#include "app/control/episode_tally.h"
#include "app/control/frame_result.h"

namespace elbowroom::console {

// One row a part of the layout, in its order. Thread: UI.
class TouchModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { kPart, kState, kTouches, kFrames, kDeepest, kColumns };

  using QAbstractTableModel::QAbstractTableModel;

  void Open(const core::Layout& layout);
  void ShowFrame(const control::FrameResult& result, const std::vector<control::PartTally>& tallies);

  [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
  [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
  [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override;
  [[nodiscard]] QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  struct Row {
    QString part;
    std::optional<core::Verdict> verdict;  // nothing before the first frame
    control::PartTally tally;
  };
  [[nodiscard]] QVariant CellText(const Row& row, int column) const;

  std::vector<Row> rows_;
};

}  // namespace elbowroom::console
