#include "app/console/calibration_dialog.h"

#include <QDesktopServices>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QStyle>
#include <QUrl>
#include <QVBoxLayout>
#include <utility>

#include "app/control/calibration/calibration_report.h"
#include "core/units.h"
#include "recon/rig_files/rig_file.h"

namespace elbowroom::console {
namespace {

constexpr QSize kCalibrationSize(820, 520);
constexpr int kFirstNumber = 2;  // column; before it are names

QString Number(double value, int decimals) { return QString::number(value, 'f', decimals); }

QString Headline(const control::CalibrationOutcome& outcome) {
  const auto& spread = outcome.uncertainty_mm;
  QString text =
      spread ? QObject::tr("A point in the workspace is known to ± %1 mm (1 σ, median), %2 mm for 95 %.")
                   .arg(Number(spread->median, 2), Number(spread->p95, 2))
             : QObject::tr("No two cameras see the same part of the workspace.");
  text += outcome.scale_checked ? QObject::tr(" The scale agrees with the known length.")
                                : QObject::tr(" The scale isn't checked.");
  return text;
}

}  // namespace

CalibrationDialog::CalibrationDialog(std::filesystem::path calibration_file, std::filesystem::path rig_file,
                                     QWidget* parent)
    : QDialog(parent), calibration_file_(std::move(calibration_file)), rig_file_(std::move(rig_file)) {
  setWindowTitle(tr("Calibration – %1").arg(QString::fromStdString(calibration_file_.filename().string())));
  headline_ = new QLabel(tr("Looking for the board …"));
  headline_->setObjectName("calibration_headline");
  headline_->setWordWrap(true);
  progress_ = new QProgressBar;
  cameras_ = new QTableWidget(0, 8);
  cameras_->setObjectName("calibration_cameras");
  cameras_->setHorizontalHeaderLabels({tr("Camera"), tr("Lens"), tr("Views"), tr("Left out"), tr("RMS, px"),
                                       tr("Centre ±, mm"), tr("Rotation ±, °"), tr("Late by, ms")});
  cameras_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  cameras_->verticalHeader()->hide();
  cameras_->horizontalHeader()->setSectionResizeMode(QHeaderView::Stretch);
  advice_ = new QListWidget;
  advice_->setObjectName("calibration_advice");
  advice_->setWordWrap(true);
  advice_->setAlternatingRowColors(true);
  open_report_ = new QPushButton(tr("Open the &report"));
  open_report_->setObjectName("calibration_report");
  open_report_->setEnabled(false);
  close_ = new QPushButton(tr("&Cancel"));
  close_->setObjectName("calibration_close");
  auto* column = new QVBoxLayout(this);
  column->addWidget(headline_);
  column->addWidget(progress_);
  column->addWidget(cameras_, 1);
  column->addWidget(new QLabel(tr("What to do next")));
  column->addWidget(advice_, 1);
  auto* buttons = new QHBoxLayout;
  buttons->addStretch(1);
  buttons->addWidget(open_report_);
  buttons->addWidget(close_);
  column->addLayout(buttons);
  resize(kCalibrationSize);
  connect(close_, &QPushButton::clicked, this, &QDialog::reject);
  connect(open_report_, &QPushButton::clicked, this, [this] {
    const std::filesystem::path page = ReportFolder() / "report.html";
    QDesktopServices::openUrl(QUrl::fromLocalFile(QString::fromStdString(page.string())));
  });
  Start();
}

// The job's destructor cancels and waits.
CalibrationDialog::~CalibrationDialog() = default;

std::filesystem::path CalibrationDialog::ReportFolder() const {
  return rig_file_.parent_path() / (rig_file_.stem().string() + "-calibration");
}

void CalibrationDialog::Start() {
  outcome_ = std::make_shared<control::CalibrationOutcome>();
  const core::Progress progress([this](std::int64_t done, std::int64_t total, const std::string& what) {
    bridge_.PostLatest(Bridge::Stream::kProgress,
                       [this, done, total, what] { ShowProgress(done, total, what); });
  });
  job_ = std::make_unique<BackgroundJob>(
      bridge_,
      [this, progress, outcome = outcome_](const std::stop_token& stop) {
        const control::CalibrationFile file = control::ReadCalibrationFile(calibration_file_);
        *outcome = control::CalibrateRig(file, rig_file_.stem().string(), progress, stop);
        recon::WriteRigFile(outcome->rig_file, rig_file_);
        (void)control::WriteCalibrationReport(file, *outcome, ReportFolder());
      },
      [this](const std::string& error) { Finish(error); });
}

void CalibrationDialog::ShowProgress(std::int64_t done, std::int64_t total, const std::string& what) {
  headline_->setText(QString::fromStdString(what) + " …");
  progress_->setRange(0, static_cast<int>(total));
  progress_->setValue(static_cast<int>(done));
}

void CalibrationDialog::Finish(const std::string& error) {
  job_.reset();
  progress_->hide();
  close_->setText(tr("&Close"));
  if (error.empty()) {
    ShowOutcome(*outcome_);
  } else {
    headline_->setText(QString::fromStdString(error));
  }
  emit Ended(error.empty());
}

void CalibrationDialog::ShowOutcome(const control::CalibrationOutcome& outcome) {
  headline_->setText(Headline(outcome));
  ShowCameras(outcome);
  for (const std::string& warning : outcome.warnings) {
    auto* item = new QListWidgetItem(style()->standardIcon(QStyle::SP_MessageBoxWarning),
                                     QString::fromStdString(warning));
    advice_->addItem(item);
  }
  for (const std::string& advice : outcome.advice) advice_->addItem(QString::fromStdString(advice));
  if (advice_->count() == 0) advice_->addItem(tr("Nothing: the calibration is complete"));
  open_report_->setEnabled(true);
}

void CalibrationDialog::ShowCameras(const control::CalibrationOutcome& outcome) {
  cameras_->setRowCount(static_cast<int>(outcome.result.cameras.size()));
  for (int row = 0; row < cameras_->rowCount(); ++row) {
    const recon::CalibratedCamera& camera = outcome.result.cameras[static_cast<std::size_t>(row)];
    const QStringList cells = {
        QString::fromStdString(camera.calibration.name),
        QString::fromStdString(std::string(core::ToString(camera.calibration.distortion_model))),
        QString::number(camera.views_used),
        QString::number(camera.views_rejected),
        Number(camera.rms_px, 2),
        Number(recon::CenterSigmaMm(outcome.result, row), 2),
        Number(core::DegreesFromRadians(recon::RotationSigmaRad(outcome.result, row)), 3),
        camera.time_offset_sigma_s ? tr("%1 ± %2").arg(Number(1e3 * camera.time_offset_s, 1),
                                                       Number(1e3 * *camera.time_offset_sigma_s, 1))
                                   : tr("–")};
    for (int column = 0; column < cells.size(); ++column) {
      auto* item = new QTableWidgetItem(cells[column]);
      const Qt::Alignment side = column < kFirstNumber ? Qt::AlignLeft : Qt::AlignRight;
      item->setTextAlignment(side | Qt::AlignVCenter);
      cameras_->setItem(row, column, item);
    }
  }
}

}  // namespace elbowroom::console
