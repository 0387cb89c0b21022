// The parts that are in contact in the current frame, as rows.
#pragma once

#include <QAbstractTableModel>
#include <vector>

#include "app/control/frame_result.h"

namespace elbowroom::console {

// Rows in the layout's order; none when nothing is touched. Thread: UI.
class ContactModel : public QAbstractTableModel {
  Q_OBJECT

 public:
  enum Column { kPart, kDepth, kArea, kPoints, kPosition, kColumns };

  using QAbstractTableModel::QAbstractTableModel;

  void ShowFrame(const control::FrameResult& result);
  void Clear();

  [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
  [[nodiscard]] int columnCount(const QModelIndex& parent = {}) const override;
  [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override;
  [[nodiscard]] QVariant headerData(int section, Qt::Orientation orientation, int role) const override;

 private:
  struct Row {
    QString part;
    core::PartContact contact;  // without its points
  };
  void ShowRows(std::vector<Row> rows);

  std::vector<Row> rows_;
};

}  // namespace elbowroom::console
