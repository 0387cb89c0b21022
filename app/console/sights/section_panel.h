// Where parts and hull are cut open: a plane for each axis of the world, with its place in mm.
#pragma once

#include <Eigen/Geometry>
#include <QCheckBox>
#include <QDoubleSpinBox>
#include <QSlider>
#include <QToolButton>
#include <QWidget>
#include <array>

#include "app/control/section/section_cut.h"

namespace elbowroom::console {

// Takes the planes of the last run, and leaves them for the next. Thread: UI.
class SectionPanel : public QWidget {
  Q_OBJECT

 public:
  explicit SectionPanel(QWidget* parent = nullptr);

  // The planes can be moved within it.
  void Open(const Eigen::AlignedBox3d& workspace_mm);
  // What is cut while the panel is shown; nothing otherwise.
  [[nodiscard]] control::SectionCut cut() const;
  // Moves the plane that was used last, along its axis.
  void Drag(const Eigen::Vector3d& by_in_world_mm);

 signals:
  void Changed(const elbowroom::control::SectionCut& cut);

 protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

 private:
  struct Row {
    QCheckBox* is_on = nullptr;
    QSlider* slider = nullptr;
    QDoubleSpinBox* at_mm = nullptr;
    QToolButton* flip = nullptr;  // checked: what is above stays
  };
  [[nodiscard]] Row MakeRow(std::size_t axis);
  void Tell();
  void Remember() const;

  std::array<Row, 3> rows_;
  std::size_t last_used_ = 0;
};

}  // namespace elbowroom::console
