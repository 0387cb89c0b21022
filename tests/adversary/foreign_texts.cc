#include "tests/adversary/foreign_texts.h"

namespace elbowroom::adversary {

const std::array<ForeignText, 6> kForeignTexts = {{
    {"opencv", "stereo.yml", R"(%YAML:1.0
---
cameras:
  - name: left
    image_width: 640
    image_height: 480
    camera_matrix: [[500.0, 0.0, 320.0], [0.0, 501.0, 240.0], [0.0, 0.0, 1.0]]
    distortion_coefficients: [-0.1, 0.02, 0.0, 0.0, 0.0]
    R: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    T: [0.0, 0.0, 0.0]
  - name: right
    image_width: 640
    image_height: 480
    camera_matrix: [[510.0, 0.0, 315.0], [0.0, 509.0, 244.0], [0.0, 0.0, 1.0]]
    distortion_coefficients: [-0.12, 0.03, 0.001, 0.0, 0.0]
    R: [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]
    T: [12.5, 0.0, 900.0]
)"},
    {"ros", "left.yaml", R"(image_width: 640
image_height: 480
camera_name: left
camera_matrix:
  rows: 3
  cols: 3
  data: [500.0, 0.0, 320.0, 0.0, 501.0, 240.0, 0.0, 0.0, 1.0]
distortion_model: plumb_bob
distortion_coefficients:
  rows: 1
  cols: 5
  data: [-0.1, 0.02, 0.0, 0.0, 0.0]
rectification_matrix:
  rows: 3
  cols: 3
  data: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]
projection_matrix:
  rows: 3
  cols: 4
  data: [495.0, 0.0, 318.0, -60.0, 0.0, 495.0, 241.0, 0.0, 0.0, 0.0, 1.0, 0.0]
)"},
    {"kalibr", "camchain.yaml", R"(cam0:
  camera_model: pinhole
  distortion_model: radtan
  distortion_coeffs: [-0.1, 0.02, 0.0, 0.0]
  intrinsics: [500.0, 501.0, 320.0, 240.0]
  resolution: [640, 480]
  rostopic: /left/image_raw
cam1:
  T_cn_cnm1:
  - [1.0, 0.0, 0.0, -0.12]
  - [0.0, 1.0, 0.0, 0.0]
  - [0.0, 0.0, 1.0, 0.0]
  - [0.0, 0.0, 0.0, 1.0]
  camera_model: pinhole
  distortion_model: equidistant
  distortion_coeffs: [0.01, 0.0, 0.0, 0.0]
  intrinsics: [510.0, 509.0, 315.0, 244.0]
  resolution: [640, 480]
  rostopic: /right/image_raw
)"},
    {"anipose", "calibration.toml", R"([cam_0]
name = "left"
size = [640, 480]
matrix = [[500.0, 0.0, 320.0], [0.0, 501.0, 240.0], [0.0, 0.0, 1.0]]
distortions = [-0.1, 0.02, 0.0, 0.0, 0.0]
rotation = [0.0, 0.0, 0.0]
translation = [0.0, 0.0, 0.0]
[cam_1]
name = "right"
size = [640, 480]
matrix = [[510.0, 0.0, 315.0], [0.0, 509.0, 244.0], [0.0, 0.0, 1.0]]
distortions = [0.01, 0.0, 0.0, 0.0]
rotation = [0.1, 1.4, 0.0]
translation = [12.5, 0.0, 900.0]
fisheye = true
[metadata]
adjusted = true
error = 0.4
)"},
    {"caliscope", "camera_array.toml", R"([cameras.1]
cam_id = 1
rotation_count = 0
error = 0.4
ignore = false
size = [640, 480]
matrix = [[500.0, 0.0, 320.0], [0.0, 501.0, 240.0], [0.0, 0.0, 1.0]]
distortions = [-0.1, 0.02, 0.0, 0.0, 0.0]
rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
translation = [0.0, 0.0, 0.0]
[cameras.2]
cam_id = 2
rotation_count = 0
error = 0.5
ignore = false
size = [640, 480]
matrix = [[510.0, 0.0, 315.0], [0.0, 509.0, 244.0], [0.0, 0.0, 1.0]]
distortions = [-0.12, 0.03, 0.001, 0.0, 0.0]
rotation = [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]
translation = [0.2, 0.0, 0.9]
)"},
    {"projection", "matrices.txt", R"(left
500.0 0.0 320.0 0.0
0.0 501.0 240.0 0.0
0.0 0.0 1.0 0.0
right
315.0 0.0 -510.0 1000.0
244.0 509.0 0.0 20.0
1.0 0.0 0.0 900.0
)"},
}};

}  // namespace elbowroom::adversary
