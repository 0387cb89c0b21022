#include "app/console/background_dialog.h"

#include <QFormLayout>
#include <QHBoxLayout>
#include <QVBoxLayout>
#include <utility>

#include "app/console/desktop/theme.h"

namespace elbowroom::console {
namespace {

constexpr QSize kBackgroundDialogSize(620, 300);
constexpr double kCountdownS = 5.0, kMostCountdownS = 60.0;
constexpr double kTakeS = 3.0, kMostTakeS = 60.0;

QDoubleSpinBox* SecondsBox(double value_s, double least_s, double most_s) {
  auto* box = new QDoubleSpinBox;
  box->setRange(least_s, most_s);
  box->setDecimals(0);
  box->setSuffix(QObject::tr(" s"));
  box->setValue(value_s);
  return box;
}

// To be read from the other side of the table.
void SetLarge(QLabel* label, bool is_large) {
  constexpr double kLarger = 2.0;
  QFont font = label->parentWidget()->font();
  if (is_large) font.setPointSizeF(kLarger * font.pointSizeF());
  label->setFont(font);
}

QString TakenText(const control::BackgroundOutcome& outcome) {
  QString text =
      QObject::tr(
          "✔ Taken: %1 cameras, %2 s. A trial uses it with the line\nrig = \"%3\"\nin its TRIAL.toml.")
          .arg(outcome.cameras.size())
          .arg(outcome.seconds, 0, 'f', 1)
          .arg(QString::fromStdString(outcome.rig_file.string()));
  for (const control::CameraBackground& camera : outcome.cameras)
    for (const std::string& fault : camera.faults) text += "\n▲ " + QString::fromStdString(fault);
  return text;
}

}  // namespace

BackgroundDialog::BackgroundDialog(recon::RigFile rig_file, const std::filesystem::path& folder,
                                   QWidget* parent)
    : QDialog(parent), rig_file_(std::move(rig_file)) {
  setWindowTitle(tr("Take the background – %1").arg(QString::fromStdString(rig_file_.rig.name)));
  headline_ =
      new QLabel(tr("Clear the table, start, and leave the cameras' view before the countdown ends."));
  headline_->setObjectName("background_headline");
  headline_->setWordWrap(true);
  headline_->setTextFormat(Qt::PlainText);
  headline_->setTextInteractionFlags(Qt::TextSelectableByMouse);
  folder_ = new QLineEdit(QString::fromStdString(folder.string()));
  folder_->setObjectName("background_folder");
  folder_->setToolTip(tr("New or empty; it gets the pictures, and a RIG.yml that uses them"));
  countdown_s_ = SecondsBox(kCountdownS, 0.0, kMostCountdownS);
  countdown_s_->setObjectName("background_countdown");
  seconds_ = SecondsBox(kTakeS, 1.0, kMostTakeS);
  seconds_->setObjectName("background_seconds");
  anyway_ = new QCheckBox(tr("Take it also where something moves or the light isn't steady"));
  anyway_->setObjectName("background_anyway");
  progress_ = new QProgressBar;
  progress_->setObjectName("background_progress");
  start_ = new QPushButton(tr("&Start"));
  start_->setObjectName("background_start");
  start_->setDefault(true);
  close_ = new QPushButton;
  close_->setObjectName("background_close");
  auto* form = new QFormLayout;
  form->addRow(tr("&Folder"), folder_);
  form->addRow(tr("&Countdown"), countdown_s_);
  form->addRow(tr("&Pictures for"), seconds_);
  form->addRow({}, anyway_);
  auto* column = new QVBoxLayout(this);
  column->addLayout(form);
  column->addWidget(headline_, 1);
  column->addWidget(progress_);
  auto* buttons = new QHBoxLayout;
  buttons->addStretch(1);
  buttons->addWidget(start_);
  buttons->addWidget(close_);
  column->addLayout(buttons);
  resize(kBackgroundDialogSize);
  connect(start_, &QPushButton::clicked, this, &BackgroundDialog::Start);
  connect(close_, &QPushButton::clicked, this, [this] {
    if (job_) {
      job_->Cancel();
    } else {
      reject();
    }
  });
  SetRunning(false);
}

// The job's destructor cancels and waits.
BackgroundDialog::~BackgroundDialog() {
  const bool was_running = is_running();
  job_.reset();
  if (was_running) emit Ended(false);
}

void BackgroundDialog::Start() {
  if (job_) return;
  control::BackgroundOptions options;
  options.countdown_s = countdown_s_->value();
  options.seconds = seconds_->value();
  options.anyway = anyway_->isChecked();
  auto outcome = std::make_shared<control::BackgroundOutcome>();
  const core::Progress progress([this](std::int64_t done, std::int64_t total, const std::string& what) {
    bridge_.PostLatest(Bridge::Stream::kProgress,
                       [this, done, total, what] { ShowProgress(done, total, what); });
  });
  emit Began();
  job_ = std::make_unique<BackgroundJob>(
      bridge_,
      [rig_file = rig_file_, folder = std::filesystem::path(folder_->text().toStdString()), options, progress,
       outcome](const std::stop_token& stop) {
        *outcome = control::TakeBackground(rig_file, folder, options, progress, stop);
      },
      [this, outcome](const std::string& error) { Finish(error, *outcome); });
  headline_->setText(tr("Starting the cameras …"));
  SetRunning(true);
}

// The countdown counts down here; what is written counts up.
void BackgroundDialog::ShowProgress(std::int64_t done, std::int64_t total, const std::string& what) {
  const bool is_countdown = what.starts_with("leave");
  SetLarge(headline_, is_countdown);
  headline_->setText(is_countdown
                         ? tr("Leave the cameras' view: %1 s").arg(std::max<std::int64_t>(0, total - done))
                         : QString::fromStdString(what) + QString(" %1").arg(done + 1));
  progress_->setRange(0, static_cast<int>(total));
  progress_->setValue(static_cast<int>(done));
}

void BackgroundDialog::Finish(const std::string& error, const control::BackgroundOutcome& outcome) {
  job_.reset();  // its thread has nothing left to do
  SetRunning(false);
  SetLarge(headline_, false);
  headline_->setText(error.empty() ? TakenText(outcome) : "✖ " + QString::fromStdString(error));
  emit Ended(error.empty());
  if (error.empty()) emit Taken(QString::fromStdString(outcome.rig_file.string()));
}

void BackgroundDialog::SetRunning(bool is_running) {
  progress_->setVisible(is_running);
  progress_->setRange(0, 0);
  start_->setEnabled(!is_running);
  close_->setText(is_running ? tr("C&ancel") : tr("&Close"));
  for (QWidget* input : std::initializer_list<QWidget*>{folder_, countdown_s_, seconds_, anyway_})
    input->setEnabled(!is_running);
}

}  // namespace elbowroom::console
