// The messages between this program and its decoder (docs/decisions/0008-pictures-in-a-child.md).
#pragma once

#include <cstdint>

#include "core/system/child_process.h"
#include "recon/decoding/picture_codecs.h"

namespace elbowroom::recon {

// The decoder lies beside this program (core/system/module.h). It receives its orders through the socket with
// this descriptor.
inline constexpr const char* kDecoderProgram = "decoder";
inline constexpr int kOrderSocket = core::kFirstGivenDescriptor;

// Asks the server for a worker for one source. Three files come with it, in this order: the worker's socket,
// its leash, and the memory that this program and the worker share. When this program closes its end of the
// leash, the worker is killed; when the worker ends, its status comes through the leash.
struct WorkerOrder {
  std::int64_t pixel_bytes = 0;  // of a picture's pixels, with which the shared memory begins
  std::int64_t file_bytes = 0;   // of a picture's file, which comes after the pixels
  std::int64_t own_bytes = 0;    // of addresses that the worker may take beyond those that it starts with
};

enum class PictureTask : std::int32_t {
  kDecode,     // decode the file in the shared memory
  kOpenVideo,  // open the video that the request's text names
  kGrab,       // pass over up to so many pictures of the video
  kNext,       // decode the video's next picture
  kEncode,     // encode the pixels in the shared memory; the text names the kind of file: ".png"
};

struct PictureRequest {
  PictureTask task = PictureTask::kDecode;
  DecodedAs as = DecodedAs::kStored;
  std::int64_t number = 0;    // of the file's bytes, or of pictures to grab
  std::int32_t width_px = 0;  // of the picture that is expected, or of the pixels to encode
  std::int32_t height_px = 0;
  std::int32_t type = 0;   // OpenCV's, of pixels to encode
  std::int32_t tries = 1;  // at most, to grab each picture, before the answer is kNothing
};

enum class PictureOutcome : std::int32_t {
  kReady,     // the first message: the worker has started
  kNoCodecs,  // the first message instead: the codecs can't be loaded; the text says why
  kDone,
  kNothing,  // there is no picture: it can't be decoded or opened, or there are no more
};

// The packet's text is what the codecs printed meanwhile about damage (ComplaintIn).
struct PictureReply {
  PictureOutcome outcome = PictureOutcome::kNothing;
  std::int32_t width_px = 0;  // of the picture, which lies in the shared memory if it fits; of an open video
  std::int32_t height_px = 0;
  std::int32_t type = 0;        // OpenCV's
  std::int64_t frames = 0;      // grabbed
  std::int64_t file_bytes = 0;  // encoded, in the shared memory
  double frame_rate_hz = 0.0;
  double promised_frames = 0.0;
};

// How a worker ended. The server sends it through the worker's leash.
struct WorkerEnd {
  std::int32_t status = 0;  // as waitpid gives it
};

}  // namespace elbowroom::recon
