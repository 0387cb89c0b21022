// Gaps under a name, and when which gap was set.
#pragma once

#include <QLineEdit>
#include <QListWidget>
#include <QPushButton>
#include <QWidget>
#include <cstddef>
#include <string>
#include <vector>

#include "app/console/procedure/gap_presets.h"
#include "core/layout.h"

namespace elbowroom::console {

// Ctrl+F1 to Ctrl+F9 apply the first presets, whether the panel is shown or not. Thread: UI.
class PresetPanel : public QWidget {
  Q_OBJECT

 public:
  // `window`: in which the keys work.
  explicit PresetPanel(QWidget* window);

  void Open(const core::Layout& layout);
  // The gaps with which a frame was judged; those that differ from the last one's are listed.
  void ShowGaps(double time_s, const std::vector<double>& gap_mm);
  void Apply(std::size_t place);  // does nothing beyond the last, or while the panel is disabled

 signals:
  // In the layout's order.
  void GapsAsked(const std::vector<double>& gap_mm);

 private:
  void Save();
  void Remove();
  void ShowPresets();
  void AddRow(double time_s, std::size_t spacing, double from_mm, double to_mm);
  void AddLists();

  struct Change {
    double time_s = 0.0;
    std::size_t spacing = 0;
    double from_mm = 0.0;
    std::vector<double> gap_mm;  // all of them, afterwards
  };

  std::vector<std::string> spacings_;
  std::vector<GapPreset> presets_;
  std::vector<double> gap_mm_;   // the latest
  std::vector<Change> changes_;  // one a row of history_
  QListWidget* list_ = nullptr;  // this and the next are owned by Qt as children
  QLineEdit* name_ = nullptr;
  QPushButton* save_ = nullptr;
  QPushButton* remove_ = nullptr;
  QListWidget* history_ = nullptr;
};

}  // namespace elbowroom::console
