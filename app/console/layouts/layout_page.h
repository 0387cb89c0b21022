// The page on which parts are imported, placed and ruled.
#pragma once

#include <QString>
#include <QWidget>
#include <filesystem>

namespace elbowroom::console {

// Thread: UI.
class LayoutPage : public QWidget {
  Q_OBJECT

 public:
  explicit LayoutPage(QWidget* parent = nullptr);

  // Reads a LAYOUT.toml on a worker and shows it.
  void Open(const std::filesystem::path& layout_file);

 signals:
  void TrialAsked(const QString& trial_file);  // a TRIAL.toml was written that is to be run
  void Failed(const QString& line);
};

}  // namespace elbowroom::console
