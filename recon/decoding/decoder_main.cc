// The decoder: a program beside the one that people start, which reads pictures and videos for it.
#include <cstdlib>

#include "recon/decoding/picture_server.h"

int main() {
  // FFmpeg's own level, 16 = errors, with a mark before each line; OpenCV reads it when the first video
  // opens.
  ::setenv("OPENCV_FFMPEG_LOGLEVEL", "16", 1);
  elbowroom::recon::ServePictures();
}
