#include "app/console/layouts/measured_points.h"

#include <QDialogButtonBox>
#include <QHeaderView>
#include <QLocale>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <optional>
#include <utility>

#include "core/error.h"

namespace elbowroom::console {
namespace {

constexpr int kFirstMeasured = 1, kResidual = 4;  // columns
constexpr int kLeastPoints = 3;

QTableWidgetItem* ReadOnly(const QString& text) {
  auto* item = new QTableWidgetItem(text);
  item->setFlags(item->flags() & ~Qt::ItemIsEditable);
  return item;
}

// As it is shown, with a point; else as the user's language writes it.
std::optional<double> NumberIn(const QString& text) {
  bool is_number = false;
  double number = text.toDouble(&is_number);
  if (!is_number) number = QLocale().toDouble(text, &is_number);
  return is_number ? std::optional(number) : std::nullopt;
}

QString PlaceWords(const Eigen::Vector3d& x) {
  return QObject::tr("%1, %2, %3").arg(x.x(), 0, 'f', 2).arg(x.y(), 0, 'f', 2).arg(x.z(), 0, 'f', 2);
}

}  // namespace

MeasuredPoints::MeasuredPoints(QString part, QWidget* parent) : QDialog(parent), part_(std::move(part)) {
  setObjectName("measured_points");
  setWindowTitle(tr("Place %1 by measured points").arg(part_));
  Build();
  Fit();
  resize(560, 300);
}

void MeasuredPoints::Build() {
  table_ = new QTableWidget(0, 5);
  table_->setObjectName("measured_table");
  table_->setAccessibleName(tr("Measured points"));
  table_->setToolTip(tr("Write where each point was measured, mm in the rig's world"));
  table_->setHorizontalHeaderLabels({tr("On the part, mm"), tr("x"), tr("y"), tr("z"), tr("Off by")});
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  table_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::ResizeToContents);
  connect(table_, &QTableWidget::cellChanged, this, [this](int, int column) {
    if (column >= kFirstMeasured && column < kResidual) Fit();
  });
  outcome_ = new QLabel;
  outcome_->setObjectName("measured_outcome");
  outcome_->setWordWrap(true);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Close);
  place_ = buttons->addButton(tr("&Place part"), QDialogButtonBox::ActionRole);
  place_->setObjectName("measured_place");
  place_->setToolTip(tr("Moves the part so that its points come nearest to the measured places"));
  QPushButton* remove = buttons->addButton(tr("&Remove point"), QDialogButtonBox::ActionRole);
  remove->setObjectName("measured_remove");
  remove->setToolTip(tr("Takes the chosen line out"));
  connect(place_, &QPushButton::clicked, this, [this] { emit PlaceAsked(part_, fit_->world_from_part); });
  connect(remove, &QPushButton::clicked, this, [this] {
    const int row = table_->currentRow();
    if (row < 0) return;
    table_->removeRow(row);
    points_in_part_.erase(points_in_part_.begin() + row);
    Fit();
  });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::close);
  auto* column = new QVBoxLayout(this);
  column->addWidget(table_, 1);
  column->addWidget(outcome_);
  column->addWidget(buttons);
}

void MeasuredPoints::Add(const Eigen::Vector3d& x_in_part, const Eigen::Vector3d& x_in_world) {
  {
    const QSignalBlocker blocker(table_);
    const int row = table_->rowCount();
    table_->insertRow(row);
    table_->setItem(row, 0, ReadOnly(PlaceWords(x_in_part)));
    for (int i = 0; i < 3; ++i)
      table_->setItem(row, kFirstMeasured + i, new QTableWidgetItem(QString::number(x_in_world[i], 'f', 2)));
    table_->setItem(row, kResidual, ReadOnly({}));
    points_in_part_.push_back(x_in_part);
  }
  Fit();
}

void MeasuredPoints::Raise() {
  show();
  raise();
  activateWindow();
}

std::vector<control::PointPair> MeasuredPoints::Pairs() const {
  std::vector<control::PointPair> pairs;
  for (int row = 0; row < table_->rowCount(); ++row) {
    control::PointPair pair{points_in_part_[static_cast<std::size_t>(row)], {}};
    for (int i = 0; i < 3; ++i) {
      const std::optional<double> number = NumberIn(table_->item(row, kFirstMeasured + i)->text());
      if (!number) return {};
      pair.x_in_world[i] = *number;
    }
    pairs.push_back(pair);
  }
  return pairs;
}

void MeasuredPoints::Fit() {
  fit_.reset();
  const QSignalBlocker blocker(table_);
  for (int row = 0; row < table_->rowCount(); ++row) table_->item(row, kResidual)->setText({});
  const std::vector<control::PointPair> pairs = Pairs();
  if (static_cast<int>(pairs.size()) < kLeastPoints) {
    outcome_->setText(table_->rowCount() < kLeastPoints
                          ? tr("Points to click on and measure before the part can be placed: %1.")
                                .arg(kLeastPoints - table_->rowCount())
                          : tr("A measured place isn't a number."));
  } else {
    try {
      fit_ = control::FitRigid(pairs);
      for (int row = 0; row < table_->rowCount(); ++row)
        table_->item(row, kResidual)
            ->setText(tr("%1 mm").arg(fit_->residuals_mm[static_cast<std::size_t>(row)], 0, 'f', 2));
      outcome_->setText(
          tr("The points fit to %1 mm (root mean square), the worst to %2 mm; they are spread by %3 mm%4.")
              .arg(fit_->rms_mm, 0, 'f', 2)
              .arg(fit_->largest_mm, 0, 'f', 2)
              .arg(fit_->spread_mm, 0, 'f', 0)
              .arg(pairs.size() == 3 ? tr("; a fourth point would check them") : QString()));
    } catch (const core::Error& error) {
      outcome_->setText(QString::fromStdString(error.what()));
    }
  }
  place_->setEnabled(fit_.has_value());
}

}  // namespace elbowroom::console
