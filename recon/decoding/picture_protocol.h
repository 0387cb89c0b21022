// What this program and its decoder say to each other (docs/decisions/0008-pictures-in-a-child.md).
#pragma once

#include <cstdint>

#include "core/system/child_process.h"
#include "recon/decoding/picture_codecs.h"

namespace elbowroom::recon {

// The program beside this one (core/system/module.h), and where it finds the socket that orders come through.
inline constexpr const char* kDecoderProgram = "decoder";
inline constexpr int kOrderSocket = core::kFirstGivenDescriptor;

// To the server: a worker for one source. With three files, in this order: the worker's socket, its leash
// (when this program closes the other end, the worker is killed; when the worker ends, its status comes
// through), the memory that they share.
struct WorkerOrder {
  std::int64_t pixel_bytes = 0;  // of the shared memory, which begins with a picture's pixels ...
  std::int64_t file_bytes = 0;   // ... and then has the bytes of a picture's file
  std::int64_t own_bytes = 0;    // that the worker may take beside what the codecs need to be there
};

enum class PictureTask : std::int32_t {
  kDecode,      // the file in the shared memory
  kOpenVideo,   // that the request's text names
  kOpenDevice,  // by its number
  kGrab,        // up to so many pictures of the video, without showing them
  kNext,        // the video's next picture
  kEncode,      // the pixels in the shared memory, into a file of the kind that the text names: ".png"
};

struct PictureRequest {
  PictureTask task = PictureTask::kDecode;
  DecodedAs as = DecodedAs::kStored;
  std::int64_t number = 0;    // bytes, device or pictures
  std::int32_t width_px = 0;  // that the picture ought to have
  std::int32_t height_px = 0;
  std::int32_t type = 0;   // OpenCV's, of pixels to encode
  std::int32_t tries = 1;  // of each picture to grab, before it is said that there is none
};

enum class PictureOutcome : std::int32_t {
  kReady,     // said once, at first: the worker is there
  kNoCodecs,  // instead of that: they can't be loaded, as the text says
  kDone,
  kNothing,  // no picture: can't be decoded, can't be opened, or there is no more
};

// The text is what the codecs said meanwhile that tells of damage.
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

// How a worker ended, through its leash.
struct WorkerEnd {
  std::int32_t status = 0;  // as waitpid gives it
};

}  // namespace elbowroom::recon
