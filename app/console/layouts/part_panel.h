// The part that is chosen: where it stands, by numbers, and how it looks.
#pragma once

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QEvent>
#include <QGroupBox>
#include <QLabel>
#include <QSlider>
#include <QToolButton>
#include <array>
#include <optional>

#include "app/console/layouts/part_look.h"
#include "core/layout.h"

namespace elbowroom::console {

// Roll, pitch and yaw with which LAYOUT.toml writes the part's rotation.
[[nodiscard]] Eigen::Vector3d RollPitchYawDegOf(const core::Part& part);

// Thread: UI.
class PartPanel : public QGroupBox {
  Q_OBJECT

 public:
  explicit PartPanel(QWidget* parent = nullptr);

  // Nothing: no part is chosen.
  void Show(const core::Layout& layout, std::optional<core::PartIndex> part, const PartLook& look);

 signals:
  // One number of the part's position_mm or rotation_rpy_deg, 0 to 2.
  void Moved(const QString& part, int axis, double position_mm);
  void Turned(const QString& part, int axis, double rotation_deg);
  void LookChanged(const QString& part, const PartLook& look);
  void RemoveAsked(const QString& part);
  void IsolateAsked(const QString& part);
  void UndoAsked();  // by keys, in a number
  void RedoAsked();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  [[nodiscard]] QWidget* NumberRows();
  [[nodiscard]] QWidget* LookRow();
  void TakeSteps();
  void ShowPlace(const core::Part& part);
  void ShowGaps(const core::Layout& layout, core::PartIndex part);

  QString name_;
  PartLook look_;
  QColor usual_color_;
  QLabel* what_ = nullptr;  // this and the next are owned by Qt as children
  std::array<QDoubleSpinBox*, 3> position_mm_{};
  std::array<QDoubleSpinBox*, 3> rotation_deg_{};
  QComboBox* step_mm_ = nullptr;
  QComboBox* step_deg_ = nullptr;
  QToolButton* color_ = nullptr;
  QSlider* opacity_ = nullptr;
};

}  // namespace elbowroom::console
