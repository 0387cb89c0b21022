// A read-only table that says so when it is empty.
#pragma once

#include <QString>
#include <QTableView>

namespace elbowroom::console {

// The column of names takes the room that the other columns leave; a name that needs more wraps. Thread: UI.
class Listing : public QTableView {
  Q_OBJECT

 public:
  // `empty_text` stands in the middle while the model has no rows. The model is not owned.
  Listing(QAbstractItemModel* model, QString empty_text, int name_column = 0, QWidget* parent = nullptr);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void FitAllRows();
  void FitRows(int first, int last);

  QString empty_text_;
  int name_column_;
};

}  // namespace elbowroom::console
