#include "app/console/preflight_panel.h"

#include <QAction>
#include <QDir>
#include <QEvent>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>

#include "app/console/desktop/theme.h"
#include "app/console/view/file_question.h"
#include "app/control/cameras/camera_check.h"

namespace elbowroom::console {
namespace {

// A sign and a word beside the colour, for those who don't tell the colours apart.
struct StateLook {
  QString text;
  QColor color;
};

StateLook LookOf(control::PreflightState state) {
  switch (state) {
    case control::PreflightState::kWell:
      return {QObject::tr("✔ well"), ThemeColors().clear};
    case control::PreflightState::kAttention:
      return {QObject::tr("▲ see to it"), ThemeColors().attention};
    case control::PreflightState::kFault:
      return {QObject::tr("✖ fault"), ThemeColors().contact};
  }
  return {};
}

QString PanelText(const control::PreflightRow& row) {
  QString text = QString::fromStdString(row.finding);
  if (!row.advice.empty()) text += QString("\n→ ") + QString::fromStdString(row.advice.front());
  return text;
}

QString AllAdvice(const control::PreflightRow& row) {
  QStringList lines;
  for (const std::string& line : row.advice) lines << QString::fromStdString(line);
  return lines.join('\n');
}

std::filesystem::path SessionFolder(const TrialDesk& desk) {
  const std::filesystem::path folder = desk.session().parent_path();
  return folder.empty() ? std::filesystem::path(QDir::homePath().toStdString()) : folder;
}

}  // namespace

// What the job found, in parts: a check that fails leaves what was known before.
struct PreflightPanel::Finding {
  std::optional<control::PreflightRig> rig;
  std::vector<control::PreflightRow> rows;
  bool has_checked = false;
};

PreflightPanel::PreflightPanel(TrialDesk& desk, QWidget* parent) : QWidget(parent), desk_(desk) {
  file_name_ = new QLabel;
  file_name_->setObjectName("preflight_file");
  file_name_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);  // cut off rather than wide
  choose_ = new QPushButton(tr("C&hoose …"));
  choose_->setObjectName("preflight_choose");
  choose_->setToolTip(tr("Choose a trial (TRIAL.toml) or a rig (RIG.yml)"));
  headline_ = new QLabel;
  headline_->setObjectName("preflight_headline");
  headline_->setWordWrap(true);
  table_ = new QTableWidget(0, 3);
  table_->setObjectName("preflight_rows");
  table_->setHorizontalHeaderLabels({tr("State"), tr("Of"), tr("Finding, and advice")});
  table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  table_->setSelectionMode(QAbstractItemView::NoSelection);
  table_->setFocusPolicy(Qt::NoFocus);
  table_->verticalHeader()->hide();
  table_->verticalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setSectionResizeMode(QHeaderView::ResizeToContents);
  table_->horizontalHeader()->setStretchLastSection(true);
  progress_ = new QProgressBar;
  cancel_ = new QPushButton(tr("Cance&l"));
  cancel_->setObjectName("preflight_cancel");
  check_ = new QPushButton(tr("Check &cameras"));
  check_->setObjectName("preflight_check");
  background_ = new QToolButton;
  background_->setObjectName("preflight_background");
  background_->setToolButtonStyle(Qt::ToolButtonTextOnly);

  auto* column = new QVBoxLayout(this);
  auto* first = new QHBoxLayout;
  first->addWidget(file_name_, 1);
  first->addWidget(choose_);
  column->addLayout(first);
  column->addWidget(headline_);
  column->addWidget(table_, 1);
  auto* running = new QHBoxLayout;
  running->addWidget(progress_, 1);
  running->addWidget(cancel_);
  column->addLayout(running);
  auto* buttons = new QHBoxLayout;
  buttons->addWidget(check_);
  buttons->addWidget(background_);
  buttons->addStretch(1);
  column->addLayout(buttons);
  setMinimumWidth(340);

  connect(choose_, &QPushButton::clicked, this, &PreflightPanel::Choose);
  connect(check_, &QPushButton::clicked, this, [this] { Check(); });
  connect(cancel_, &QPushButton::clicked, this, &PreflightPanel::Cancel);
  connect(&desk_, &TrialDesk::StateChanged, this, &PreflightPanel::FollowDesk);
  ShowRows();
  ShowButtons();
}

PreflightPanel::~PreflightPanel() = default;  // the job's destructor cancels and waits

void PreflightPanel::ShowBackgroundButton(QAction* action) { background_->setDefaultAction(action); }

void PreflightPanel::FollowDesk() {
  if (desk_.state() == DeskState::kReading && !desk_.trial_file().empty() && desk_.trial_file() != file_)
    Open(desk_.trial_file());
  ShowButtons();
}

void PreflightPanel::Choose() {
  AskForFileToRead(this,
                   {.title = tr("Check the rig of"),
                    .beside = QString::fromStdString(file_.string()),
                    .filter = tr("Trials and rigs (*.toml *.yml *.yaml);;All files (*)")},
                   [this](const QString& file) { Open(file.toStdString()); });
}

void PreflightPanel::Open(const std::filesystem::path& file) {
  Cancel();
  file_ = file;
  rig_.reset();
  rows_.clear();
  has_checked_ = false;
  Run(0.0);
  emit RigChanged();
}

bool PreflightPanel::CanCheck() const {
  return !job_ && rig_ && rig_->is_live && desk_.state() != DeskState::kReading &&
         desk_.state() != DeskState::kRunning && !desk_.are_cameras_taken();
}

void PreflightPanel::Check(double seconds) {
  if (!CanCheck()) return;
  desk_.SetCamerasTaken(true);
  Run(seconds);
}

void PreflightPanel::Cancel() {
  if (job_) job_->Cancel();
}

// Reads the rig; with seconds, it runs its cameras for so long, too.
void PreflightPanel::Run(double check_s) {
  auto finding = std::make_shared<Finding>();
  const core::Progress progress([this](std::int64_t done, std::int64_t total, const std::string& what) {
    bridge_.PostLatest(Bridge::Stream::kProgress,
                       [this, done, total, what] { ShowProgress(done, total, what); });
  });
  job_ = std::make_unique<BackgroundJob>(
      bridge_,
      [finding, progress, check_s, file = file_, folder = SessionFolder(desk_)](const std::stop_token& stop) {
        finding->rig = control::ReadPreflightRig(file);
        finding->rows = control::RigRows(finding->rig->rig_file, folder);
        if (check_s <= 0.0) return;
        const control::RigHealth health =
            control::CheckCameras(finding->rig->rig_file, check_s, progress, stop);
        std::ranges::copy(control::CameraRows(health), std::back_inserter(finding->rows));
        finding->has_checked = true;
      },
      [this, finding, check_s, run = ++runs_](const std::string& error) {
        if (check_s > 0.0) desk_.SetCamerasTaken(false);
        if (run != runs_) return;  // another file was opened since: its job runs
        if (finding->rig) {
          rig_ = std::move(finding->rig);
          rows_ = std::move(finding->rows);
          has_checked_ = finding->has_checked;
        }
        Finish(error);
        emit RigChanged();
        if (check_s > 0.0) emit Checked(error.empty());
      });
  ShowRows();
  ShowButtons();
}

void PreflightPanel::Finish(const std::string& error) {
  job_.reset();  // its thread has nothing left to do
  ShowRows();
  ShowButtons();
  if (!error.empty()) headline_->setText("✖ " + QString::fromStdString(error));
}

void PreflightPanel::ShowProgress(std::int64_t done, std::int64_t total, const std::string& what) {
  progress_->setRange(0, static_cast<int>(total));
  progress_->setValue(static_cast<int>(done));
  progress_->setFormat(QString::fromStdString(what) + " %v");
}

QString PreflightPanel::Headline() const {
  if (file_.empty()) return tr("Choose a trial or a rig to see whether it is ready.");
  if (!rig_) return job_ ? tr("Reading …") : QString();
  if (!rig_->is_live) return tr("The rig plays recorded files: there are no live cameras to check.");
  const auto to_do = std::ranges::count_if(
      rows_, [](const auto& row) { return row.state != control::PreflightState::kWell; });
  const QString cameras = has_checked_ ? QString() : tr(" The cameras aren't checked yet.");
  if (to_do == 0)
    return (has_checked_ ? tr("✔ All is well: the trial can begin.") : tr("✔ So far all is well.")) + cameras;
  return (to_do == 1 ? tr("▲ One thing to do.") : tr("▲ %1 things to do.").arg(to_do)) + cameras;
}

void PreflightPanel::changeEvent(QEvent* event) {
  QWidget::changeEvent(event);
  if (event->type() == QEvent::PaletteChange && table_ != nullptr) ShowRows();
}

void PreflightPanel::ShowRows() {
  file_name_->setText(file_.empty() ? tr("no rig") : QString::fromStdString(file_.filename().string()));
  file_name_->setToolTip(QString::fromStdString(file_.string()));
  headline_->setText(Headline());
  table_->setRowCount(static_cast<int>(rows_.size()));
  for (int i = 0; i < table_->rowCount(); ++i) {
    const control::PreflightRow& row = rows_[static_cast<std::size_t>(i)];
    const StateLook look = LookOf(row.state);
    auto* state = new QTableWidgetItem(look.text);
    state->setForeground(look.color);
    const std::array<QTableWidgetItem*, 3> items = {state,
                                                    new QTableWidgetItem(QString::fromStdString(row.subject)),
                                                    new QTableWidgetItem(PanelText(row))};
    for (int column = 0; column < table_->columnCount(); ++column) {
      items[static_cast<std::size_t>(column)]->setToolTip(AllAdvice(row));
      items[static_cast<std::size_t>(column)]->setTextAlignment(Qt::AlignLeft | Qt::AlignTop);
      table_->setItem(i, column, items[static_cast<std::size_t>(column)]);
    }
  }
}

void PreflightPanel::ShowButtons() {
  progress_->setVisible(job_ != nullptr);
  if (job_) {
    progress_->setRange(0, 0);
    progress_->setFormat({});
  }
  cancel_->setVisible(job_ != nullptr);
  choose_->setEnabled(job_ == nullptr);
  check_->setEnabled(CanCheck());
  check_->setToolTip(desk_.state() == DeskState::kRunning
                         ? tr("The running trial has the cameras: stop it first")
                     : rig_ && !rig_->is_live ? tr("The rig's pictures are recorded")
                                              : tr("Run the cameras for some seconds, and say how they do"));
}

}  // namespace elbowroom::console
