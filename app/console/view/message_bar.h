// One line that the experimenter must see, without stopping anything.
#pragma once

#include <QFrame>
#include <QLabel>
#include <QString>

namespace elbowroom::console {

// Hidden until there is something to say; the user closes it, or a later message takes its place. Thread: UI.
class MessageBar : public QFrame {
 public:
  explicit MessageBar(QWidget* parent = nullptr);

  void ShowError(const QString& line);
  void ShowNote(const QString& line);
  [[nodiscard]] QString text() const { return text_->text(); }

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void ShowLine(const QString& line, bool is_error);
  void TakeColors();

  QLabel* text_;
  bool is_error_ = false;
};

}  // namespace elbowroom::console
