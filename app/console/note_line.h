// A note at a moment of the trial.
#pragma once

#include <QLineEdit>

namespace elbowroom::console {

// Enter adds what is written as a note at the frame that comes next, and empties the line; Escape gives it
// up. Thread: UI.
class NoteLine : public QLineEdit {
  Q_OBJECT

 public:
  explicit NoteLine(QWidget* parent = nullptr);

 signals:
  void Written(const QString& note);

 protected:
  void keyPressEvent(QKeyEvent* event) override;
};

}  // namespace elbowroom::console
