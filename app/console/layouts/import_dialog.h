// A CAD file before it becomes parts: what is in it, in which unit, and which of it to take.
#pragma once

#include <QButtonGroup>
#include <QDialog>
#include <QGroupBox>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QTreeWidget>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/console/view/background_job.h"
#include "app/console/view/bridge.h"
#include "app/control/layout_editing/part_preview.h"

namespace elbowroom::console {

// Reads the file on a worker from the moment it is made; closing the dialog cancels that. What is ticked is
// taken with all that hangs under it, so that ticking a node unticks what is above and below it. Where the
// file carries no unit, one must be chosen, and the file is read again in that. Thread: UI.
class ImportDialog : public QDialog {
  Q_OBJECT

 public:
  explicit ImportDialog(std::filesystem::path file, QWidget* parent = nullptr);
  ~ImportDialog() override;

  [[nodiscard]] bool is_reading() const { return job_ != nullptr; }
  // What was read last; nothing before, and where it can't be read.
  [[nodiscard]] const std::optional<control::PartPreview>& preview() const { return preview_; }
  // An empty one is the whole file.
  [[nodiscard]] std::vector<std::string> TickedNodes() const;

 signals:
  // The parts to take: the dialog closes with it.
  void Taken(const control::PartPreview& preview, const std::vector<std::string>& nodes);
  void Read();  // or failed to

 private:
  void Build();
  void StartReading(std::optional<core::LengthUnit> unit);
  void Finish(const std::string& error, bool is_chosen_unit);
  void ShowPreview();
  void ShowUnits();
  void ShowTree();
  void Tick(QTreeWidgetItem* item);
  void Take();
  void ShowState();
  [[nodiscard]] std::optional<core::LengthUnit> ChosenUnit() const;

  std::filesystem::path file_;
  std::optional<control::PartPreview> preview_;
  QLabel* headline_ = nullptr;  // this and the next are owned by Qt as children
  QProgressBar* progress_ = nullptr;
  QGroupBox* units_ = nullptr;
  QButtonGroup* unit_choices_ = nullptr;
  QTreeWidget* tree_ = nullptr;
  QLabel* warnings_ = nullptr;
  QPushButton* take_ = nullptr;
  Bridge bridge_;  // before the thread that posts to it
  std::unique_ptr<BackgroundJob> job_;
};

}  // namespace elbowroom::console
