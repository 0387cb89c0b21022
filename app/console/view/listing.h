// A read-only table that says so when it is empty.
#pragma once

#include <QString>
#include <QTableView>

namespace elbowroom::console {

// Thread: UI.
class Listing : public QTableView {
 public:
  // `empty_text` stands in the middle while the model has no rows. The model is not owned.
  Listing(QAbstractItemModel* model, QString empty_text, QWidget* parent = nullptr);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QString empty_text_;
};

}  // namespace elbowroom::console
