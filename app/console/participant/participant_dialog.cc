#include "app/console/participant/participant_dialog.h"

#include <QFormLayout>
#include <QGroupBox>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QScreen>
#include <QVBoxLayout>

#include "app/console/view/file_question.h"
#include "core/units.h"

namespace elbowroom::console {
namespace {

using recon::HeadSource;

template <typename Value>
void Choose(QComboBox* box, Value value) {
  box->setCurrentIndex(box->findData(static_cast<int>(value)));
}

template <typename Value>
Value ChosenIn(const QComboBox* box) {
  return static_cast<Value>(box->currentData().toInt());
}

void Name(QWidget* widget, const char* object_name, const QString& accessible_name, const QString& tool_tip) {
  widget->setObjectName(object_name);
  widget->setAccessibleName(accessible_name);
  widget->setToolTip(tool_tip);
}

}  // namespace

ParticipantDialog::ParticipantDialog(const ParticipantChoices& choices, QWidget* parent) : QDialog(parent) {
  setObjectName("participant_dialog");
  setWindowTitle(tr("Participant's view"));
  auto* picture = new QGroupBox(tr("Picture"));
  AddPicture(choices, new QFormLayout(picture));
  auto* tracker = new QGroupBox(tr("Head tracking"));
  auto* tracker_form = new QFormLayout(tracker);
  AddTracker(choices, tracker_form);
  state_ = new QLabel(tr("The window is closed"));
  state_->setObjectName("participant_state");
  state_->setWordWrap(true);
  state_->setMinimumHeight(4 * state_->fontMetrics().lineSpacing());  // as long as what a headset lacks
  state_->setAlignment(Qt::AlignTop | Qt::AlignLeft);
  tracker_form->addRow(state_);
  open_ = new QPushButton;
  Name(open_, "participant_open", tr("Open or close the participant's window"),
       tr("Shows the scene from the participant's head on the display that is chosen; Escape there closes "
          "it"));
  open_->setCheckable(true);
  connect(open_, &QPushButton::clicked, this, &ParticipantDialog::OpenAsked);
  auto* column = new QVBoxLayout(this);
  column->addWidget(picture);
  column->addWidget(tracker);
  column->addWidget(open_);
  ShowOpen(false);
  FollowChoices();
}

QDoubleSpinBox* ParticipantDialog::AddNumber(const char* name, double value, double least, double most,
                                             const QString& unit, const QString& tool_tip) {
  auto* box = new QDoubleSpinBox;
  Name(box, name, tool_tip.section(',', 0, 0), tool_tip);
  box->setRange(least, most);
  box->setDecimals(0);
  box->setSuffix(" " + unit);
  box->setValue(value);
  connect(box, &QDoubleSpinBox::valueChanged, this, &ParticipantDialog::Changed);
  return box;
}

void ParticipantDialog::AddPicture(const ParticipantChoices& choices, QFormLayout* form) {
  using control::ViewMode;
  mode_ = new QComboBox;
  mode_->addItem(tr("One picture"), static_cast<int>(ViewMode::kMono));
  mode_->addItem(tr("Two, side by side (stereo)"), static_cast<int>(ViewMode::kStereo));
  mode_->addItem(tr("Mirrored"), static_cast<int>(ViewMode::kMirror));
  mode_->addItem(tr("A camera's picture, with the parts"), static_cast<int>(ViewMode::kCamera));
  mode_->addItem(tr("The same, as a mirror"), static_cast<int>(ViewMode::kCameraMirror));
  mode_->addItem(tr("The head camera's picture, with the parts"), static_cast<int>(ViewMode::kHeadCamera));
  Name(mode_, "participant_mode", tr("Kind of picture"),
       tr("From the head: one picture, one for each eye, or mirrored; or the parts in a camera's live "
          "picture"));
  Choose(mode_, choices.eyes.mode);
  connect(mode_, &QComboBox::currentIndexChanged, this, [this] {
    FollowChoices();
    emit Changed();
  });
  camera_ = new QSpinBox;
  camera_->setRange(1, 64);
  camera_->setValue(choices.camera);
  Name(camera_, "participant_camera", tr("Camera"),
       tr("Whose picture is shown, in the rig's order, from 1; for the head camera: where the trial has no "
          "[viewer]"));
  connect(camera_, &QSpinBox::valueChanged, this, &ParticipantDialog::Changed);
  display_ = new QComboBox;
  for (const QScreen* screen : QGuiApplication::screens())
    display_->addItem(
        tr("%1 (%2 × %3)").arg(screen->name()).arg(screen->size().width()).arg(screen->size().height()),
        screen->name());
  const int known = display_->findData(choices.display);
  display_->setCurrentIndex(known >= 0 ? known : display_->count() - 1);
  Name(display_, "participant_display", tr("Display"),
       tr("The display on which the participant's window opens"));
  connect(display_, &QComboBox::currentIndexChanged, this, &ParticipantDialog::Changed);
  fills_display_ = new QCheckBox(tr("Fill the display"));
  Name(fills_display_, "participant_fills", tr("Fill the display"),
       tr("Off: an ordinary window; F11 in it changes between both"));
  fills_display_->setChecked(choices.fills_display);
  connect(fills_display_, &QCheckBox::toggled, this, &ParticipantDialog::Changed);
  fov_ =
      AddNumber("participant_fov", core::DegreesFromRadians(choices.eyes.vertical_fov_rad), 12.0, 137.0, "°",
                tr("Field of view from top to bottom, in degrees: that of the headset or the screen"));
  ipd_ = AddNumber("participant_ipd", choices.eyes.ipd_mm, 0.0, 100.0, "mm",
                   tr("Distance between the pupils, in mm; for stereo"));
  convergence_ =
      AddNumber("participant_convergence", choices.eyes.convergence_mm, 100.0, 10'000.0, "mm",
                tr("Distance of the screen's plane, in mm: things there have no parallax; for stereo"));
  form->addRow(tr("&Kind"), mode_);
  form->addRow(tr("C&amera"), camera_);
  form->addRow(tr("&Display"), display_);
  form->addRow(QString(), fills_display_);
  form->addRow(tr("&Field of view"), fov_);
  form->addRow(tr("&Eye distance"), ipd_);
  form->addRow(tr("&Screen plane"), convergence_);
}

void ParticipantDialog::AddTracker(const ParticipantChoices& choices, QFormLayout* form) {
  source_ = new QComboBox;
  source_->addItem(tr("None: a fixed eye point"), static_cast<int>(HeadSource::kFixed));
  source_->addItem(tr("OpenTrack (UDP)"), static_cast<int>(HeadSource::kOpenTrack));
  source_->addItem(tr("FreeD (UDP)"), static_cast<int>(HeadSource::kFreeD));
  source_->addItem(tr("Markers on a cap"), static_cast<int>(HeadSource::kCap));
  source_->addItem(tr("OpenXR headset"), static_cast<int>(HeadSource::kOpenXr));
  Name(source_, "participant_source", tr("Source of the head's pose"),
       tr("Where the head's pose comes from; the cap is seen by the rig's own cameras; an "
          "OpenXR headset also shows the picture, in stereo"));
  Choose(source_, choices.source);
  port_ = new QSpinBox;
  port_->setRange(1, 65535);
  port_->setValue(choices.port);
  Name(port_, "participant_port", tr("UDP port"),
       tr("The UDP port that the tracker sends to; OpenTrack's is 4242, FreeD's often 40000"));
  connect(source_, &QComboBox::currentIndexChanged, this, [this] {
    const auto source = ChosenIn<HeadSource>(source_);
    if (source == HeadSource::kOpenTrack) port_->setValue(control::kOpenTrackPort);
    if (source == HeadSource::kFreeD) port_->setValue(control::kFreeDPort);
    FollowChoices();
    emit Changed();
  });
  connect(port_, &QSpinBox::editingFinished, this, &ParticipantDialog::Changed);
  head_file_ = new QLineEdit(choices.head_file);
  head_file_->setPlaceholderText(tr("none"));
  Name(
      head_file_, "participant_head_file", tr("Head file"),
      tr("HEAD.toml: where the tracker's frame is in the rig's, the cap, the fixed eye point; may be empty"));
  connect(head_file_, &QLineEdit::editingFinished, this, &ParticipantDialog::Changed);
  auto* browse = new QPushButton(tr("&Open …"));
  Name(browse, "participant_browse", tr("Choose the head file"), tr("Choose a HEAD.toml"));
  connect(browse, &QPushButton::clicked, this, [this] {
    AskForFileToRead(
        this, {.title = tr("Head file"), .beside = head_file_->text(), .filter = tr("Head files (*.toml)")},
        [this](const QString& file) {
          head_file_->setText(file);
          emit Changed();
        });
  });
  auto* file = new QHBoxLayout;
  file->addWidget(head_file_, 1);
  file->addWidget(browse);
  form->addRow(tr("So&urce"), source_);
  form->addRow(tr("&Port"), port_);
  auto* file_label = new QLabel(tr("&Head file"));
  file_label->setBuddy(head_file_);
  form->addRow(file_label, file);
}

void ParticipantDialog::FollowChoices() {
  const auto source = ChosenIn<HeadSource>(source_);
  const auto mode = ChosenIn<control::ViewMode>(mode_);
  camera_->setEnabled(control::IsOfCamera(mode));
  // A headset says itself where its eyes are and how far they see.
  const bool is_headsets = source == HeadSource::kOpenXr && mode == control::ViewMode::kStereo;
  fov_->setEnabled(!control::IsOfCamera(mode) && !is_headsets);
  for (QWidget* stereo : {ipd_, convergence_})
    stereo->setEnabled(mode == control::ViewMode::kStereo && !is_headsets);
  port_->setEnabled(source == HeadSource::kOpenTrack || source == HeadSource::kFreeD);
}

ParticipantChoices ParticipantDialog::choices() const {
  ParticipantChoices choices;
  choices.source = ChosenIn<HeadSource>(source_);
  choices.port = port_->value();
  choices.head_file = head_file_->text().trimmed();
  choices.eyes.mode = ChosenIn<control::ViewMode>(mode_);
  choices.eyes.ipd_mm = ipd_->value();
  choices.eyes.vertical_fov_rad = core::RadiansFromDegrees(fov_->value());
  choices.eyes.convergence_mm = convergence_->value();
  choices.camera = camera_->value();
  choices.display = display_->currentData().toString();
  choices.fills_display = fills_display_->isChecked();
  return choices;
}

void ParticipantDialog::ShowState(const QString& text) { state_->setText(text); }

void ParticipantDialog::ShowOpen(bool is_open) {
  open_->setChecked(is_open);
  open_->setText(is_open ? tr("&Close the participant's window") : tr("&Show to the participant"));
}

}  // namespace elbowroom::console
