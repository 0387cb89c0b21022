#include "recon/picture_codecs.h"

#include "core/module.h"
#include "recon/quiet_opencv.h"

namespace elbowroom::recon {

const PictureCodecs& LoadedPictureCodecs() {
  SilenceOpenCv();
  static const PictureCodecs& codecs =
      core::FunctionOfModule<decltype(ElbowroomPictureCodecs)>("picture_codecs", "ElbowroomPictureCodecs")();
  return codecs;
}

}  // namespace elbowroom::recon
