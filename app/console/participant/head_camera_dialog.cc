#include "app/console/participant/head_camera_dialog.h"

#include <QFormLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QVBoxLayout>
#include <cmath>
#include <utility>

#include "app/console/view/file_question.h"
#include "app/console/view/picture_asker.h"
#include "app/control/head/head_settings.h"
#include "core/error.h"
#include "core/units.h"

namespace elbowroom::console {
namespace {

constexpr double kFinely = 0.1;
constexpr double kCatchPx = 14.0;  // of the picture, as it is shown
constexpr double kZoom = 1.01;

QPointF PointOf(const Eigen::Vector2d& pixel) { return {pixel.x(), pixel.y()}; }

}  // namespace

HeadCameraDialog::HeadCameraDialog(const recon::HeadCamera& camera, const QString& head_file, QWidget* parent)
    : QDialog(parent), camera_(camera), head_file_(head_file), view_(new HeadCameraView) {
  setObjectName("head_camera_dialog");
  setWindowTitle(tr("Register the head camera"));
  auto* row = new QHBoxLayout(this);
  row->addWidget(view_, 1);
  row->addWidget(MakePanel());
  connect(view_, &HeadCameraView::Clicked, this, &HeadCameraDialog::TakeClick);
  connect(view_, &HeadCameraView::Dragged, this, [this](const QPointF& by) {
    Change(recon::Turned(camera_, {by.x(), by.y()}));
  });
  connect(view_, &HeadCameraView::Wheeled, this,
          [this](int steps) { Change(recon::Scaled(camera_, std::pow(kZoom, steps))); });
  look_.eyes.mode = control::ViewMode::kHeadCamera;
  look_.width_px = look_.height_px = 1;  // the picture has the camera's size
  pictures_ = std::make_unique<control::ParticipantPictures>(
      [this](control::ParticipantPicture picture) {
        bridge_.PostLatest(Bridge::Stream::kPicture,
                           [this, shared = std::make_shared<control::ParticipantPicture>(
                                      std::move(picture))] { ShowPicture(*shared); });
      },
      [this](const std::string& line) {
        bridge_.Post([this, text = QString::fromStdString(line)] { next_->setText(text); });
      });
  view_->SetMarking(false);
  ShowFigures();
}

HeadCameraDialog::~HeadCameraDialog() = default;

QDoubleSpinBox* HeadCameraDialog::AddStep(const char* name, double value, const QString& unit,
                                          const QString& spoken, const QString& tool_tip) {
  auto* box = new QDoubleSpinBox;
  box->setObjectName(name);
  box->setAccessibleName(spoken);
  box->setToolTip(tool_tip);
  box->setRange(0.1, 100.0);
  box->setDecimals(1);
  box->setSuffix(" " + unit);
  box->setValue(value);
  return box;
}

QPushButton* HeadCameraDialog::AddButton(const char* name, const QString& text, const QString& tool_tip) {
  auto* button = new QPushButton(text);
  button->setObjectName(name);
  button->setAccessibleName(QString(text).remove('&'));
  button->setToolTip(tool_tip);
  button->setAutoDefault(false);
  return button;
}

QWidget* HeadCameraDialog::MakePanel() {
  auto* panel = new QWidget;
  panel->setFixedWidth(24 * panel->fontMetrics().averageCharWidth() + 150);
  auto* column = new QVBoxLayout(panel);
  column->setContentsMargins(0, 0, 0, 0);
  auto* take = AddButton("head_camera_take", tr("&Take this instant"),
                         tr("The picture and the head's pose as they are now"));
  connect(take, &QPushButton::clicked, this, &HeadCameraDialog::TakeAsked);
  auto* open = AddButton("head_camera_open", tr("&Open a picture …"),
                         tr("A picture's file in the place of the camera's picture"));
  connect(open, &QPushButton::clicked, this, &HeadCameraDialog::OpenPicture);
  marks_ = AddButton(
      "head_camera_mark", tr("&Mark points"),
      tr("Click a corner of a part as it is drawn, then its place in the picture; again and again"));
  marks_->setCheckable(true);
  connect(marks_, &QPushButton::toggled, this, [this](bool is_marking) {
    if (!is_marking && !pairs_.empty() && !pairs_.back().pixel) pairs_.pop_back();
    view_->SetMarking(is_marking);
    ShowFigures();
  });
  list_ = new QListWidget;
  list_->setObjectName("head_camera_pairs");
  list_->setAccessibleName(tr("Marked points"));
  list_->setToolTip(tr("Each marked corner, and how far from it the part is drawn, in pixels"));
  connect(list_, &QListWidget::currentRowChanged, this, &HeadCameraDialog::ShowFigures);
  auto* remove =
      AddButton("head_camera_remove", tr("&Remove the point"), tr("The point that is chosen in the list"));
  connect(remove, &QPushButton::clicked, this, &HeadCameraDialog::RemovePair);
  fit_ = AddButton(
      "head_camera_fit", tr("&Fit to the points"),
      tr("Least squares in pixels: 1 point turns the camera; 2 also roll it and set the focal length; "
         "3 place and turn it; 4 and more do all of that"));
  connect(fit_, &QPushButton::clicked, this, &HeadCameraDialog::Fit);
  save_ =
      AddButton("head_camera_save", tr("&Save"), tr("Into the head file, HEAD.toml; all else in it stays"));
  connect(save_, &QPushButton::clicked, this, &HeadCameraDialog::Save);
  step_px_ = AddStep("head_camera_step_px", 5.0, tr("px"), tr("Step of a turn"),
                     tr("By how many pixels an arrow key moves what is seen; with Alt a tenth"));
  step_mm_ = AddStep("head_camera_step_mm", 5.0, tr("mm"), tr("Step of a move"),
                     tr("By how many mm Shift and an arrow key move the camera; with Alt a tenth"));
  auto* steps = new QFormLayout;
  steps->addRow(tr("T&urn by"), step_px_);
  steps->addRow(tr("Mo&ve by"), step_mm_);
  figures_ = new QLabel;
  figures_->setObjectName("head_camera_figures");
  figures_->setWordWrap(true);
  next_ = new QLabel;
  next_->setObjectName("head_camera_next");
  next_->setWordWrap(true);
  auto* keys =
      new QLabel(tr("Arrows: turn. Shift: move. Page up, down: nearer, farther. Comma, full stop: roll. "
                    "Plus, minus: focal length. Alt: a tenth."));
  keys->setWordWrap(true);
  for (QWidget* widget : std::initializer_list<QWidget*>{take, open}) column->addWidget(widget);
  column->addLayout(steps);
  column->addWidget(keys);
  for (QWidget* widget : std::initializer_list<QWidget*>{marks_, list_, remove, fit_, figures_, next_, save_})
    column->addWidget(widget);
  return panel;
}

void HeadCameraDialog::Take(control::SharedFrameResult result, const control::HeadState& head,
                            core::CameraIndex camera) {
  result_ = std::move(result);
  head_ = head;
  look_.camera = camera;
  corners_ = result_ ? control::CornersOf(*result_) : std::vector<control::SceneCorner>();
  pairs_.clear();
  pictures_->ShowFrame(result_);
  pictures_->ShowHead(head_);
  Ask();
  ShowFigures();
}

void HeadCameraDialog::OpenPicture() {
  AskForFileToRead(this,
                   {.title = tr("Picture of the head camera"),
                    .filter = tr("Pictures (*.png *.jpg *.jpeg *.tif *.tiff *.bmp)")},
                   [this](const QString& file) {
                     look_.head_picture = file.toStdString();
                     pairs_.clear();
                     Ask();
                     ShowFigures();
                   });
}

void HeadCameraDialog::Ask() {
  look_.head_camera = camera_;
  pictures_->SetLook(look_);
}

void HeadCameraDialog::ShowPicture(const control::ParticipantPicture& picture) {
  view_->ShowPicture(QtImageOf(picture.image));
  const bool is_resized =
      camera_.width_px != picture.image.width_px || camera_.height_px != picture.image.height_px;
  if (!is_resized) return;
  camera_ = recon::ResizedTo(camera_, picture.image.width_px, picture.image.height_px);
  Ask();
  ShowFigures();
}

void HeadCameraDialog::TakeClick(const QPointF& pixel) {
  if (!head_.pose) return;
  const Eigen::Vector2d at(pixel.x(), pixel.y());
  if (!pairs_.empty() && !pairs_.back().pixel) {
    pairs_.back().pixel = at;
  } else {
    const double scale = static_cast<double>(view_->width()) / std::max(1, view_->picture_size().width());
    const auto corner = control::CornerAt(corners_, camera_, head_.pose->world_from_head, at,
                                          kCatchPx / std::min(1.0, scale));
    if (!corner) {
      next_->setText(tr("No corner of a part is drawn there: click nearer to one."));
      return;
    }
    pairs_.push_back({QString::fromStdString(corner->part), corner->x_in_world, std::nullopt});
  }
  ShowFigures();
}

void HeadCameraDialog::RemovePair() {
  const int row = list_->currentRow();
  if (row < 0 || row >= static_cast<int>(pairs_.size())) return;
  pairs_.erase(pairs_.begin() + row);
  ShowFigures();
}

std::vector<recon::SeenPoint> HeadCameraDialog::Points() const {
  std::vector<recon::SeenPoint> points;
  if (!head_.pose) return points;
  const core::RigidTransform head_from_world = head_.pose->world_from_head.Inverse();
  for (const Pair& pair : pairs_)
    if (pair.pixel) points.push_back({head_from_world * pair.x_in_world, *pair.pixel});
  return points;
}

void HeadCameraDialog::Fit() {
  try {
    marks_->setChecked(false);
    Change(recon::FitHeadCamera(camera_, Points()).camera);
  } catch (const core::Error& error) {
    next_->setText(QString::fromStdString(error.what()));
  }
}

void HeadCameraDialog::Save() {
  if (head_file_.isEmpty())
    return AskForFileToWrite(this,
                             {.title = tr("Head file"),
                              .beside = "HEAD.toml",
                              .filter = tr("Head files (*.toml)"),
                              .asks_before_replacing = false},  // what else the file says stays
                             [this](const QString& file) {
                               head_file_ = file;
                               Save();
                             });
  try {
    control::WriteHeadCamera(head_file_.toStdString(), camera_);
    next_->setText(tr("Saved in %1").arg(head_file_));
    emit Saved(head_file_);
  } catch (const core::Error& error) {
    next_->setText(QString::fromStdString(error.what()));
  }
}

void HeadCameraDialog::Change(const recon::HeadCamera& camera) {
  camera_ = camera;
  Ask();
  ShowFigures();
}

QString HeadCameraDialog::NextStep() const {
  if (!result_) return tr("Start a trial first: its parts are laid over the picture.");
  if (!head_.pose) return tr("The head's pose isn't known: choose a tracker, or a fixed eye point.");
  if (!marks_->isChecked()) return tr("Drag, or use the keys, until the parts fit; or mark points.");
  return !pairs_.empty() && !pairs_.back().pixel ? tr("Now click the same corner in the picture.")
                                                 : tr("Click a corner of a part as it is drawn.");
}

void HeadCameraDialog::ShowFigures() {
  double sum = 0.0;
  int count = 0;
  std::vector<HeadCameraView::Mark> marks;
  const int chosen = list_->currentRow();
  const QSignalBlocker quiet(list_);
  list_->clear();
  for (std::size_t i = 0; head_.pose && i < pairs_.size(); ++i) {
    const Pair& pair = pairs_[i];
    const Eigen::Vector2d drawn =
        recon::PixelOf(camera_, head_.pose->world_from_head.Inverse() * pair.x_in_world);
    HeadCameraView::Mark mark{PointOf(drawn), std::nullopt, static_cast<int>(i) == chosen};
    if (pair.pixel) {
      const double off_px = (drawn - *pair.pixel).norm();
      sum += off_px * off_px;
      ++count;
      mark.seen = PointOf(*pair.pixel);
      list_->addItem(tr("%1: %2, %3 px").arg(i + 1).arg(pair.part).arg(off_px, 0, 'f', 1));
    } else {
      list_->addItem(tr("%1: %2, not in the picture yet").arg(i + 1).arg(pair.part));
    }
    if (drawn.allFinite()) marks.push_back(mark);
  }
  list_->setCurrentRow(std::min(chosen, list_->count() - 1));
  view_->ShowMarks(std::move(marks));
  const Eigen::Vector3d& at = camera_.head_from_camera.translation_mm;
  QString text = tr("From between the eyes: %1 mm right, %2 mm down, %3 mm forward\nFocal length: %4 px")
                     .arg(at.x(), 0, 'f', 1)
                     .arg(at.y(), 0, 'f', 1)
                     .arg(at.z(), 0, 'f', 1)
                     .arg(camera_.focal_px, 0, 'f', 1);
  if (count > 0) text += tr("\nMarked points: %1 px RMS").arg(std::sqrt(sum / count), 0, 'f', 2);
  figures_->setText(text);
  next_->setText(NextStep());
  fit_->setEnabled(count > 0);
}

bool HeadCameraDialog::TakeKey(int key, Qt::KeyboardModifiers modifiers) {
  const double share = modifiers & Qt::AltModifier ? kFinely : 1.0;
  const double px = share * step_px_->value(), mm = share * step_mm_->value();
  const bool moves = modifiers & Qt::ShiftModifier;
  const double zoom = std::pow(kZoom, share);
  const auto step = [&](double x, double y) {
    Change(moves ? recon::Moved(camera_, mm * Eigen::Vector3d(x, y, 0.0))
                 : recon::Turned(camera_, px * Eigen::Vector2d(x, y)));
    return true;
  };
  switch (key) {
    case Qt::Key_Left:
      return step(-1.0, 0.0);
    case Qt::Key_Right:
      return step(1.0, 0.0);
    case Qt::Key_Up:
      return step(0.0, -1.0);
    case Qt::Key_Down:
      return step(0.0, 1.0);
    case Qt::Key_PageUp:
      Change(recon::Moved(camera_, {0.0, 0.0, mm}));
      return true;
    case Qt::Key_PageDown:
      Change(recon::Moved(camera_, {0.0, 0.0, -mm}));
      return true;
    case Qt::Key_Comma:
      Change(recon::Rolled(camera_, -px / camera_.focal_px));
      return true;
    case Qt::Key_Period:
      Change(recon::Rolled(camera_, px / camera_.focal_px));
      return true;
    case Qt::Key_Plus:
      Change(recon::Scaled(camera_, zoom));
      return true;
    case Qt::Key_Minus:
      Change(recon::Scaled(camera_, 1.0 / zoom));
      return true;
    default:
      return false;
  }
}

// What the picture, which has the focus, doesn't use.
void HeadCameraDialog::keyPressEvent(QKeyEvent* event) {
  if (!view_->hasFocus() || !TakeKey(event->key(), event->modifiers())) QDialog::keyPressEvent(event);
}

}  // namespace elbowroom::console
