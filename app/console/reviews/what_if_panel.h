// The recorded motion tried at other gaps: a slider for each spacing, and what it would have been.
#pragma once

#include <QDoubleSpinBox>
#include <QGroupBox>
#include <QLabel>
#include <QProgressBar>
#include <QPushButton>
#include <QSlider>
#include <QVBoxLayout>
#include <map>
#include <string>
#include <vector>

#include "app/control/reviewing/needed_gap.h"
#include "app/control/reviewing/what_if.h"
#include "core/session.h"

namespace elbowroom::console {

// Thread: UI.
class WhatIfPanel : public QGroupBox {
  Q_OBJECT

 public:
  explicit WhatIfPanel(QWidget* parent = nullptr);

  void Open(const core::SessionHeader& header);
  void ShowGaps(const std::vector<double>& spacing_mm);  // of the frame that is shown
  void ShowFrame(const control::FrameResult& result);  // judged at the gaps held, before the whole motion is
  void ShowProgress(qint64 done, qint64 total);
  void ShowWhatIf(const control::WhatIf& what_if);
  void ShowRecorded();  // nothing is tried
  void ShowNeeded(const QString& spacing, const control::NeededGap& needed);
  void SetCanFind(bool can_find);

 signals:
  void Held(const elbowroom::control::HeldGaps& held_mm);  // empty: as recorded
  void NeededAsked(const std::string& spacing);

 private:
  struct Row {
    std::string name;
    QSlider* slider = nullptr;
    QDoubleSpinBox* box = nullptr;
    QPushButton* needed = nullptr;
    bool is_held = false;
  };
  void AddRow(const core::Spacing& spacing, QWidget* rows);
  void Hold(std::size_t row, double value_mm);
  void LetGo();
  [[nodiscard]] QString NeededOf(const control::HeldGaps& held_mm) const;
  static void ShowValue(const Row& row, double value_mm);

  core::SessionHeader header_;
  std::vector<Row> rows_;
  std::map<std::string, control::NeededGap> needed_;  // by spacing, as far as they were found
  QVBoxLayout* column_;
  QWidget* controls_ = nullptr;  // of this session's spacings
  QLabel* result_;
  QLabel* details_;
  QProgressBar* progress_;
  QPushButton* let_go_;
};

}  // namespace elbowroom::console
