// A part placed by points that were measured on the real fixture.
#pragma once

#include <QDialog>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <optional>
#include <vector>

#include "app/control/placing/rigid_fit.h"

namespace elbowroom::console {

// Points are clicked on the part in the view behind it, and their measured places written beside them; from
// three on the part can be placed, with what each point is off by then. Thread: UI.
class MeasuredPoints : public QDialog {
  Q_OBJECT

 public:
  explicit MeasuredPoints(QString part, QWidget* parent = nullptr);

  [[nodiscard]] const QString& part() const { return part_; }
  // `x_in_world`: where it is now, to begin with.
  void Add(const Eigen::Vector3d& x_in_part, const Eigen::Vector3d& x_in_world);
  void Raise();  // asked for again
  [[nodiscard]] const std::optional<control::RigidFit>& fit() const { return fit_; }

 signals:
  void PlaceAsked(const QString& part, const core::RigidTransform& world_from_part);

 private:
  void Build();
  void Fit();
  [[nodiscard]] std::vector<control::PointPair> Pairs() const;  // of rows whose numbers are numbers

  QString part_;
  std::vector<Eigen::Vector3d> points_in_part_;
  std::optional<control::RigidFit> fit_;
  QTableWidget* table_ = nullptr;  // this and the next are owned by Qt as children
  QLabel* outcome_ = nullptr;
  QPushButton* place_ = nullptr;
};

}  // namespace elbowroom::console
