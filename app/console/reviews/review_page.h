// The page on which a recorded session is gone through.
#pragma once

#include <QString>
#include <QWidget>
#include <filesystem>

namespace elbowroom::console {

// Thread: UI.
class ReviewPage : public QWidget {
  Q_OBJECT

 public:
  explicit ReviewPage(QWidget* parent = nullptr);

  // Reads a session on a worker and shows it.
  void Open(const std::filesystem::path& session);

 signals:
  void Failed(const QString& line);
};

}  // namespace elbowroom::console
