// What stands on the review page before a session is opened.
#pragma once

#include <QPushButton>
#include <QVBoxLayout>
#include <QWidget>
#include <vector>

namespace elbowroom::console {

// A button to open a session, and those that were opened last. Thread: UI.
class ReviewStart : public QWidget {
  Q_OBJECT

 public:
  explicit ReviewStart(QWidget* parent = nullptr);

 signals:
  void OpenAsked();
  void Chosen(const QString& session);

 protected:
  void showEvent(QShowEvent* event) override;

 private:
  void ListRecent();

  QVBoxLayout* column_;
  QWidget* recent_ = nullptr;
};

}  // namespace elbowroom::console
