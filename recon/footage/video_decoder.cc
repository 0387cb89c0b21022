#include "recon/footage/video_decoder.h"

namespace elbowroom::recon {
namespace {

Decoded<OpenedVideo> OpenedBy(const PictureAnswer& answer) {
  Decoded<OpenedVideo> opened{{}, answer.complaint, answer.worker_ended};
  const PictureReply& reply = answer.reply;
  if (reply.outcome == PictureOutcome::kDone)
    opened.value = OpenedVideo{{reply.width_px, reply.height_px}, reply.frame_rate_hz, reply.promised_frames};
  return opened;
}

}  // namespace

VideoDecoder::VideoDecoder(const cv::Size& size_px)
    : size_px_(size_px), worker_({size_px.width, size_px.height, 0, SourceMemory::kVideo}) {}

Decoded<OpenedVideo> VideoDecoder::OpenVideo(const std::string& location, const std::stop_token& stop,
                                             const MostTime& most_time) {
  return OpenedBy(worker_.Ask({.task = PictureTask::kOpenVideo}, location, stop, most_time));
}

Decoded<core::FrameIndex> VideoDecoder::Skip(core::FrameIndex most, const std::stop_token& stop,
                                             const MostTime& most_time, int tries) {
  const PictureRequest request{.task = PictureTask::kGrab, .number = most, .tries = tries};
  const PictureAnswer answer = worker_.Ask(request, {}, stop, most_time);
  Decoded<core::FrameIndex> skipped{{}, answer.complaint, answer.worker_ended};
  if (answer.reply.outcome == PictureOutcome::kDone || answer.reply.frames > 0)
    skipped.value = answer.reply.frames;
  return skipped;
}

Decoded<VideoPicture> VideoDecoder::Next(const std::stop_token& stop, const MostTime& most_time) {
  const PictureRequest request{
      .task = PictureTask::kNext, .width_px = size_px_.width, .height_px = size_px_.height};
  const PictureAnswer answer = worker_.Ask(request, {}, stop, most_time);
  Decoded<VideoPicture> next{{}, answer.complaint, answer.worker_ended};
  const PictureReply& reply = answer.reply;
  const bool is_picture = reply.outcome == PictureOutcome::kDone && reply.type == CV_8UC3;
  if (!is_picture || reply.width_px <= 0 || reply.height_px <= 0) return next;
  next.value = VideoPicture{{reply.width_px, reply.height_px}, {}};
  if (next.value->size_px != size_px_) return next;
  // The worker writes over its memory with the next picture.
  std::byte* pixels = worker_.pixel_bytes().data();
  next.value->image_bgr = cv::Mat(size_px_, CV_8UC3, pixels).clone();
  return next;
}

}  // namespace elbowroom::recon
