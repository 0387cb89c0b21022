// The controls of the layout's gaps: slider, number, buttons, keys.
#pragma once

#include <QDoubleSpinBox>
#include <QGroupBox>
#include <QLabel>
#include <QSlider>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/console/gap_history.h"
#include "app/console/pair_rule_list.h"
#include "app/control/frame_result.h"
#include "core/layout.h"

namespace elbowroom::console {

// The control of one spacing. The gap that the experimenter asks for is shown at once; beside it stands the
// gap with which the latest frame was judged.
class SpacingControl : public QWidget {
  Q_OBJECT

 public:
  explicit SpacingControl(const core::Spacing& spacing, QWidget* parent = nullptr);

  // Shows the gap with which a frame was judged. The control follows it where it changed without being asked
  // for here; a gap that was asked for stays until a frame comes with it.
  void ShowApplied(double applied_mm);
  void Step(double by_mm);     // stays within the limits
  void Request(double to_mm);  // likewise
  [[nodiscard]] bool Is(double gap_mm) const { return value_mm_ == gap_mm; }
  void SetIsActive(bool is_active);  // the one that the keys move

 signals:
  void Requested(const std::string& spacing, double to_mm);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void AddRows(const core::Spacing& spacing);
  void ShowValue(double value_mm);

  std::string name_;
  double min_mm_;
  double max_mm_;
  double value_mm_ = 0.0;  // what is shown, before it is rounded
  QLabel* title_ = nullptr;
  QLabel* applied_ = nullptr;
  QSlider* slider_ = nullptr;
  QDoubleSpinBox* box_ = nullptr;
  std::optional<double> awaited_mm_;  // asked for, but no frame has come with it yet
  std::optional<double> applied_mm_;
};

// Thread: UI.
class SpacingPanel : public QGroupBox {
  Q_OBJECT

 public:
  explicit SpacingPanel(QWidget* parent = nullptr);

  void Open(const core::Layout& layout);
  void ShowApplied(std::span<const double> spacing_mm);  // in the layout's order
  void ShowPairs(const control::FrameResult& result);    // each rule below the spacings that move its parts
  void StepActive(double by_mm);  // the spacing that was moved last, at first the layout's first

  // Back to the gaps before the last change, and forth again; do nothing where there is no such change.
  void Undo();
  void Redo();
  [[nodiscard]] const GapHistory& history() const { return *history_; }

  [[nodiscard]] const std::vector<SpacingControl*>& controls() const { return controls_; }
  // One a spacing, and one for the rules of parts that no spacing moves.
  [[nodiscard]] const std::vector<PairRuleList*>& rules() const { return rules_; }

 signals:
  void Requested(const std::string& spacing, double to_mm);
  void HistoryChanged();

 protected:
  void changeEvent(QEvent* event) override;

 private:
  void Activate(SpacingControl* control);
  void Restore(const GapHistory::Gaps& gap_mm);
  void AddRules(const core::Layout& layout, std::vector<std::size_t> shown, bool only_broken);

  std::vector<SpacingControl*> controls_;  // owned by Qt as children
  std::vector<PairRuleList*> rules_;       // likewise
  SpacingControl* active_ = nullptr;
  GapHistory* history_ = nullptr;  // owned by Qt as a child
};

}  // namespace elbowroom::console
