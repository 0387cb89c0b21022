#include "recon/decoding/picture_codecs.h"

#include "core/system/module.h"
#include "recon/decoding/quiet_opencv.h"

namespace elbowroom::recon {

const PictureCodecs& LoadedPictureCodecs() {
  SilenceOpenCv();
  static const PictureCodecs& codecs =
      core::FunctionOfModule<decltype(ElbowroomPictureCodecs)>("picture_codecs", "ElbowroomPictureCodecs")();
  return codecs;
}

}  // namespace elbowroom::recon
