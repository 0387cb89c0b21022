// While a trial runs: the step under way, how long it and the trial last, and bookmarks.
#pragma once

#include <QCheckBox>
#include <QGroupBox>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QWidget>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "core/procedure/step_runs.h"

namespace elbowroom::console {

// Thread: UI.
class ProcedurePanel : public QWidget {
  Q_OBJECT

 public:
  explicit ProcedurePanel(QWidget* parent = nullptr);

  // The steps of a trial that begins; the first one is begun with its first frame, or none.
  void Open(const std::vector<std::string>& steps, bool begins_first);
  // How far the trial is, s from its first frame; the step under way in that frame.
  void ShowTime(double time_s, const std::optional<core::StepRun>& step);
  void ShowEnd();

  // As the keys do; nothing while the panel is disabled.
  void Next();
  void SetBookmark();

  void ShowSound(const QString& trouble);                    // why contacts can't be heard; empty: they can
  [[nodiscard]] QCheckBox* sound() const { return sound_; }  // whether contacts are to be heard

 signals:
  void StepAsked(const std::string& step);  // empty: none
  void BookmarkAsked(const std::string& name);

 private:
  void Ask(std::size_t place);  // as many as there are steps: none
  void ShowPlace();
  [[nodiscard]] QWidget* MakeBookmarks();

  std::vector<std::string> steps_;
  std::optional<std::size_t> place_;  // of the step that was asked for last
  std::vector<bool> was_begun_;
  QLabel* trial_time_ = nullptr;  // this and the next are owned by Qt as children
  QLabel* step_time_ = nullptr;
  QListWidget* list_ = nullptr;
  QPushButton* next_ = nullptr;
  QPushButton* bookmark_ = nullptr;
  QLineEdit* bookmark_name_ = nullptr;
  QCheckBox* sound_ = nullptr;
};

}  // namespace elbowroom::console
