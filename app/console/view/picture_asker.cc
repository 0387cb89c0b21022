#include "app/console/view/picture_asker.h"

#include <chrono>
#include <utility>

namespace elbowroom::console {
namespace {

// Beyond these a picture costs more time than it gains in sharpness.
constexpr QSize kLargestBySoftware(1280, 800);
constexpr QSize kLargestByCard(3840, 2400);
// A scene that hasn't changed for this long is drawn in full.
constexpr std::chrono::milliseconds kRests(400);

}  // namespace

QImage QtImageOf(const recon::Image& image) {
  const QImage view(image.rgb.data(), image.width_px, image.height_px, 3 * image.width_px,
                    QImage::Format_RGB888);
  return view.convertToFormat(QImage::Format_RGB32);
}

PictureAsker::PictureAsker(const QWidget& view, Answers answers)
    : view_(view),
      answers_(std::move(answers)),
      worker_(
          [this](const recon::Image& image, const control::RenderRequest& request) {
            bridge_.PostLatest(Bridge::Stream::kPicture,
                               [this, picture = QtImageOf(image), request] { Take(picture, request); });
          },
          [this](const std::string& line) {
            bridge_.PostLatest(Bridge::Stream::kPicture,
                               [this, text = QString::fromStdString(line)] { Fail(text); });
          }) {
  rest_.setSingleShot(true);
  rest_.setInterval(kRests);
  QObject::connect(&rest_, &QTimer::timeout, &rest_, [this] {
    if (!is_drawing()) Submit(PicturePace::kFinest);
  });
}

void PictureAsker::Ask() {
  if (is_drawing()) {
    is_outdated_ = true;
  } else {
    Submit(pace_.fineness());
  }
}

void PictureAsker::Submit(const PictureFineness& fineness) {
  const QSize largest = LargestPicture();
  std::optional<control::RenderRequest> request = answers_.request(largest * fineness.picture, fineness);
  is_outdated_ = false;
  if (!request) return;
  request->largest_px = {largest.width(), largest.height()};
  drawn_with_ = fineness;
  drawing_.start();
  worker_.Submit(std::move(*request));
}

QSize PictureAsker::LargestPicture() const {
  const QSize pixels = view_.size() * view_.devicePixelRatio();
  const QSize largest = worker_.is_software().value_or(true) ? kLargestBySoftware : kLargestByCard;
  return pixels.boundedTo(pixels.scaled(largest, Qt::KeepAspectRatio)).expandedTo(QSize(64, 64));
}

void PictureAsker::Take(const QImage& picture, const control::RenderRequest& request) {
  const double drawing_ms = 1e-6 * static_cast<double>(drawing_.nsecsElapsed());
  drawing_.invalidate();
  if (!answers_.take(picture, request)) return Ask();
  last_error_.clear();
  if (drawn_with_ == pace_.fineness()) pace_.Add(drawing_ms);
  if (is_outdated_) {
    Submit(pace_.fineness());
  } else if (drawn_with_ != PicturePace::kFinest) {
    rest_.start();
  }
  answers_.shown(drawing_ms);
}

void PictureAsker::Fail(const QString& line) {
  drawing_.invalidate();
  if (line != std::exchange(last_error_, line)) answers_.failed(line);
}

}  // namespace elbowroom::console
