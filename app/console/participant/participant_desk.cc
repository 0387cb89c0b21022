#include "app/console/participant/participant_desk.h"

#include <QGuiApplication>
#include <QScreen>
#include <algorithm>
#include <utility>

#include "app/control/layers/hull_colors.h"
#include "core/error.h"

namespace elbowroom::console {
namespace {

constexpr std::chrono::milliseconds kWatchEvery(100);
constexpr qint64 kCountEveryMs = 1000;
// Both eyes' pictures side by side; coarser ones follow by themselves where drawing takes too long.
constexpr QSize kLargestForHeadset(1920, 1080);

const QScreen* ScreenNamed(const QString& name) {
  const QList<QScreen*> screens = QGuiApplication::screens();
  for (const QScreen* screen : screens)
    if (screen->name() == name) return screen;
  return screens.isEmpty() ? nullptr : screens.back();
}

QString PhaseText(recon::HeadsetPhase phase) {
  using recon::HeadsetPhase;
  switch (phase) {
    case HeadsetPhase::kStarting:
      return ParticipantDesk::tr("the OpenXR runtime starts");
    case HeadsetPhase::kIdle:
      return ParticipantDesk::tr("the headset waits: put it on");
    case HeadsetPhase::kRunning:
      return ParticipantDesk::tr("the headset is tracked; nothing is shown in it yet");
    case HeadsetPhase::kVisible:
      return ParticipantDesk::tr("the headset shows something else before the picture");
    case HeadsetPhase::kFocused:
      return ParticipantDesk::tr("the headset is in use");
    case HeadsetPhase::kStopping:
      return ParticipantDesk::tr("the headset pauses");
    case HeadsetPhase::kRecentred:
      return ParticipantDesk::tr("recentred");
    case HeadsetPhase::kSilent:
      return ParticipantDesk::tr("no answer");
    case HeadsetPhase::kLost:
      return ParticipantDesk::tr("lost; it is tried again");
    case HeadsetPhase::kRefused:
      return ParticipantDesk::tr("no headset; it is tried again");
    case HeadsetPhase::kEnded:
      return ParticipantDesk::tr("ended in the headset; choose the source again");
  }
  return {};
}

// Empty for other sources.
QString HeadsetText(const std::optional<control::HeadsetStatus>& headset) {
  if (!headset) return {};
  QString text = ParticipantDesk::tr("OpenXR: %1").arg(PhaseText(headset->phase));
  if (!headset->text.empty()) text += QString(" – %1").arg(QString::fromStdString(headset->text));
  if (!headset->name.empty()) text += QString("\n%1").arg(QString::fromStdString(headset->name));
  return text;
}

}  // namespace

ParticipantDesk::ParticipantDesk(QWidget* window)
    : QObject(window),
      window_(window),
      choices_(RememberedChoices()),
      menu_(new QMenu(tr("&Participant"), window)),
      status_(new QLabel(window)) {
  menu_->setToolTipsVisible(true);
  shows_ = menu_->addAction(tr("&Show to the participant"));
  shows_->setObjectName("show_participant");
  shows_->setCheckable(true);
  shows_->setShortcut(QKeySequence(Qt::CTRL | Qt::Key_P));
  shows_->setToolTip(tr("A second window, from the participant's head, on the display that was chosen"));
  connect(shows_, &QAction::triggered, this, [this](bool open) { open ? Open() : Close(); });
  QAction* choose = menu_->addAction(tr("Picture and &head tracking …"), this, &ParticipantDesk::ShowChoices);
  choose->setObjectName("participant_choices");
  choose->setToolTip(
      tr("Display, stereo, eye distance; OpenTrack, FreeD, the markers on a cap or an OpenXR headset"));
  QAction* registers =
      menu_->addAction(tr("&Register the head camera …"), this, &ParticipantDesk::RegisterHeadCamera);
  registers->setObjectName("register_head_camera");
  registers->setToolTip(tr("Lay the picture of a camera on the head over the parts, until they fit"));
  status_->setObjectName("status_participant");
  status_->setContentsMargins(4, 0, 10, 0);
  status_->hide();
  watch_.setInterval(kWatchEvery);
  connect(&watch_, &QTimer::timeout, this, &ParticipantDesk::ShowState);
}

ParticipantDesk::~ParticipantDesk() = default;

void ParticipantDesk::OpenTrial(const core::Rig& rig) {
  rig_ = rig;
  result_.reset();
  if (view_) view_->Clear();
  if (is_open() && choices_.source == recon::HeadSource::kCap) StartTracker();
}

void ParticipantDesk::ShowFrame(control::SharedFrameResult result) {
  result_ = std::move(result);
  if (tracker_ && result_) tracker_->OfferFrames(result_->camera_frames);
  if (pictures_) pictures_->ShowFrame(result_);
}

void ParticipantDesk::SetLook(const control::SceneLook& look) {
  if (control::ShowsKnowledge(look.hull)) return;  // that is for the operator
  look_ = look;
  AskForPictures();
}

void ParticipantDesk::Open() {
  if (is_open()) return;
  view_ = std::make_unique<ParticipantView>();
  connect(view_.get(), &ParticipantView::Resized, this, &ParticipantDesk::AskForPictures);
  connect(view_.get(), &ParticipantView::Closed, this, &ParticipantDesk::Close);
  connect(view_.get(), &ParticipantView::PictureSeen, this, [this](double age_ms) {
    age_ms_ = age_ms;
    ages_.Add(age_ms);
  });
  ages_ = {};
  age_ms_.reset();
  pictures_ = std::make_unique<control::ParticipantPictures>(
      [this, headset = headset_](control::ParticipantPicture picture) {
        (void)control::ShowInHeadset(picture, headset.get());  // a picture that it can't take yet: the next
        bridge_.PostLatest(Bridge::Stream::kPicture,
                           [this, shared = std::make_shared<control::ParticipantPicture>(
                                      std::move(picture))] { ShowPicture(*shared); });
      },
      [this](const std::string& line) {
        bridge_.Post([this, text = QString::fromStdString(line)] { emit Failed(text); });
      });
  pictures_->ShowFrame(result_);
  const QScreen* screen = ScreenNamed(choices_.display);
  if (choices_.fills_display) {
    view_->FillDisplay(screen);
  } else {
    if (screen != nullptr) view_->move(screen->availableGeometry().topLeft() + QPoint(40, 40));
    view_->show();
  }
  StartTracker();
  AskForPictures();
  watch_.start();
  ShowState();
}

void ParticipantDesk::Close() {
  if (!is_open()) return;
  watch_.stop();
  tracker_.reset();
  pictures_.reset();
  view_->disconnect(this);
  view_.release()->deleteLater();  // it may be what calls
  ShowState();
}

void ParticipantDesk::ShowChoices() {
  if (dialog_ == nullptr) {
    dialog_ = new ParticipantDialog(choices_, window_);
    connect(dialog_, &ParticipantDialog::Changed, this, &ParticipantDesk::TakeChoices);
    connect(dialog_, &ParticipantDialog::OpenAsked, this, [this](bool open) { open ? Open() : Close(); });
  }
  ShowState();
  dialog_->show();
  dialog_->raise();
}

recon::HeadCamera ParticipantDesk::SavedHeadCamera() {
  try {
    return HeadSettingsOf(choices_).head_camera.value_or(recon::HeadCamera());
  } catch (const core::Error& error) {
    emit Failed(tr("Participant's view: %1").arg(QString::fromStdString(error.what())));
  }
  return {};
}

void ParticipantDesk::RegisterHeadCamera() {
  if (registering_ == nullptr) {
    registering_ = new HeadCameraDialog(SavedHeadCamera(), choices_.head_file, window_);
    registering_->setAttribute(Qt::WA_DeleteOnClose);
    connect(registering_, &QObject::destroyed, this, [this] { registering_ = nullptr; });
    connect(registering_, &HeadCameraDialog::TakeAsked, this, &ParticipantDesk::TakeInstant);
    connect(registering_, &HeadCameraDialog::Saved, this, [this](const QString& head_file) {
      if (dialog_ != nullptr) dialog_->SetHeadFile(head_file);
      choices_.head_file = head_file;
      RememberChoices(choices_);
      head_camera_ = registering_->camera();
      AskForPictures();
    });
    TakeInstant();
  }
  registering_->show();
  registering_->raise();
}

// Without a window there is no tracker: then the eyes are at the fixed point.
void ParticipantDesk::TakeInstant() {
  control::HeadState head;
  try {
    head = tracker_ ? tracker_->state() : control::HeadTracker(FixedHead(), rig_).state();
  } catch (const core::Error& error) {
    emit Failed(tr("Participant's view: %1").arg(QString::fromStdString(error.what())));
  }
  registering_->Take(result_, head, static_cast<core::CameraIndex>(choices_.camera - 1));
}

control::HeadSettings ParticipantDesk::FixedHead() const {
  control::HeadSettings settings = HeadSettingsOf(choices_);
  settings.source = recon::HeadSource::kFixed;
  return settings;
}

void ParticipantDesk::TakeChoices() {
  const ParticipantChoices last = std::exchange(choices_, dialog_->choices());
  RememberChoices(choices_);
  if (!is_open()) return;
  const bool is_other_tracker =
      last.source != choices_.source || last.port != choices_.port || last.head_file != choices_.head_file ||
      (choices_.source == recon::HeadSource::kOpenXr && last.eyes.mode != choices_.eyes.mode);
  if (is_other_tracker) StartTracker();
  if (choices_.fills_display && (last.display != choices_.display || !last.fills_display)) {
    view_->FillDisplay(ScreenNamed(choices_.display));
  } else if (!choices_.fills_display && last.fills_display) {
    view_->showNormal();
  }
  AskForPictures();
}

void ParticipantDesk::StartTracker() {
  tracker_.reset();  // its port is free again
  accepted_before_ = 0;
  poses_per_s_ = 0.0;
  since_count_.start();
  if (choices_.source == recon::HeadSource::kCap && !rig_) return;  // with the next trial
  try {
    const control::HeadSettings settings = HeadSettingsOf(choices_);
    head_camera_ = settings.head_camera.value_or(recon::HeadCamera());
    tracker_ = std::make_unique<control::HeadTracker>(
        settings, rig_,
        [pictures = pictures_.get()](const control::HeadState& head) { pictures->ShowHead(head); },
        control::HeadLimits(), ShowsInHeadset() ? headset_ : nullptr);
    if (choices_.source == recon::HeadSource::kFixed) pictures_->ShowHead(tracker_->state());
    if (result_) tracker_->OfferFrames(result_->camera_frames);
  } catch (const core::Error& error) {
    emit Failed(tr("Participant's view: %1").arg(QString::fromStdString(error.what())));
  }
}

bool ParticipantDesk::ShowsInHeadset() const {
  return choices_.source == recon::HeadSource::kOpenXr && choices_.eyes.mode == control::ViewMode::kStereo;
}

void ParticipantDesk::AskForPictures() {
  if (!is_open()) return;
  QSize size = view_->PictureSize();
  if (ShowsInHeadset()) {
    const auto [width, height] = headset_->recommended_px();
    if (width > 0 && height > 0)
      size = QSize(2 * width, height)
                 .scaled(kLargestForHeadset, Qt::KeepAspectRatio)
                 .boundedTo({2 * width, height});
  }
  view_->SetStereo(choices_.eyes.mode == control::ViewMode::kStereo);
  pictures_->SetLook({choices_.eyes,
                      look_,
                      static_cast<core::CameraIndex>(choices_.camera - 1),
                      size.width(),
                      size.height(),
                      head_camera_,
                      {}});
}

void ParticipantDesk::ShowPicture(const control::ParticipantPicture& picture) {
  if (is_open() && result_) view_->ShowPicture(picture);
}

void ParticipantDesk::ShowState() {
  if (ShowsInHeadset() &&
      std::exchange(headset_px_, headset_->recommended_px()) != headset_->recommended_px())
    AskForPictures();
  const bool needs_head = control::NeedsHead(choices_.eyes.mode);
  if (is_open()) view_->ShowTracking(needs_head && (!tracker_ || tracker_->state().is_lost));
  if (tracker_ && since_count_.elapsed() >= kCountEveryMs) {
    const std::int64_t accepted = tracker_->counts().accepted;
    poses_per_s_ = 1000.0 * static_cast<double>(accepted - accepted_before_) /
                   static_cast<double>(since_count_.restart());
    accepted_before_ = accepted;
  }
  const QString text = StateText();
  shows_->setChecked(is_open());
  status_->setVisible(is_open());
  status_->setText(age_ms_ ? tr("participant %1 ms").arg(*age_ms_, 0, 'f', 0) : tr("participant"));
  status_->setToolTip(tr("The participant's view, from the head's pose to the screen\n%1").arg(text));
  if (dialog_ == nullptr) return;
  dialog_->ShowOpen(is_open());
  dialog_->ShowState(text);
}

QString ParticipantDesk::StateText() const {
  if (!is_open()) return tr("The window is closed");
  if (!tracker_)
    return choices_.source == recon::HeadSource::kCap ? tr("Start a trial: its cameras look for the cap")
                                                      : tr("No tracking: the view stays");
  if (choices_.source == recon::HeadSource::kFixed) return tr("A fixed eye point");
  const QString headset = HeadsetText(tracker_->headset());
  const bool is_working = tracker_->counts().accepted > 0 && !tracker_->state().is_lost;
  if (!headset.isEmpty() && !is_working) return headset;
  const control::HeadCounts counts = tracker_->counts();
  QString text = tracker_->state().is_lost ? tr("Tracking is lost") : tr("Tracking");
  text += tr(": %1 poses/s, %2 refused").arg(poses_per_s_, 0, 'f', 0).arg(counts.all_refused());
  const auto most = std::ranges::max_element(counts.refused);
  if (*most > 0) {
    const auto fault = control::ToString(static_cast<control::PoseFault>(most - counts.refused.begin()));
    text += tr(" (most: %1)")
                .arg(QString::fromUtf8(fault.data(), static_cast<qsizetype>(fault.size())).replace('_', ' '));
  }
  if (!headset.isEmpty()) text += "\n" + headset;
  if (age_ms_)
    text += tr("\nPose to screen: %1 ms, median %2 ms")
                .arg(*age_ms_, 0, 'f', 0)
                .arg(ages_.MedianMs().value_or(0.0), 0, 'f', 0);
  return text;
}

}  // namespace elbowroom::console
