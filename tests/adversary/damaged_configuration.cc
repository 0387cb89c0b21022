#include "tests/adversary/damaged_configuration.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tests/app/mask_rig.h"
#include "tests/fuzz/mutation.h"
#include "tests/support/text_file.h"

namespace elbowroom::adversary {
namespace {

constexpr const char* kView = R"(%YAML:1.0
---
name: "view"
image_width: 320
image_height: 240
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 400., 0., 159.5, 0., 400., 119.5, 0., 0., 1. ]
distortion_model: "plumb_bob"
distortion_coefficients: [ -0.1, 0.02, 0., 0., 0. ]
rotation_cam_from_world: [ [ 1, 0, 0 ], [ 0, -1, 0 ], [ 0, 0, -1 ] ]
translation_cam_from_world_mm: [ 0, 0, 900 ]
)";

constexpr const char* kPose = R"(%YAML:1.0
---
rotation_world_from_part: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 1., 0., 0., 0., 1., 0., 0., 0., 1. ]
translation_world_from_part_mm: !!opencv-matrix
   rows: 3
   cols: 1
   dt: d
   data: [ 80., 0., 200. ]
)";

constexpr const char* kLayout = R"(unit = "mm"
[[part]]
name = "lower"
file = "box.stl"
position_mm = [80, 0, 60]
rotation_rpy_deg = [0, 0, 30.5]
[[part]]
name = "upper"
file = "box.stl"
unit = "mm"
position_mm = [80, 0, 200]
recovery = "slider"
recovery_axis = [0, 0, 1]
[[group]]
name = "both"
parts = ["lower", "upper"]
[[spacing]]
name = "gap"
moving = "upper"
reference = "lower"
axis = "z"
min_mm = 0.0
max_mm = 200.0
initial_mm = 20
[[pair]]
a = "lower"
b = "upper"
required_clearance_mm = 5
authorised_contact = true
)";

constexpr const char* kTrial = R"(rig = "rig.yml"
layout = "layout.toml"
participant = "P1"   # who
task = "plug"
estimate_mm = 140
required_clearance_mm = 5.0
uncertainty_mm = 1
tools = ["tongs", "screwdriver"]
[segmentation]
method = "threshold"
k_sigma = 4.0
floor_levels = 6
min_blob_px = 20
shadows = "keep"
[[segmentation.camera]]
name = "cam1"
k_sigma = 8.5
floor_levels = 12
ignore = "cam1/mask_0000.png"
[viewer]
camera = "view.yml"
frames = "view_%d.png"
)";

std::vector<std::string> LinesOf(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

// Damages what a line means, not its bytes.
class LineDamage {
 public:
  LineDamage(std::vector<std::string>& lines, std::mt19937_64& random) : lines_(lines), random_(random) {}

  void Once() {
    if (lines_.empty()) return;
    std::string& line = lines_[Below(lines_.size())];
    switch (Below(10)) {
      case 0:
        lines_.erase(lines_.begin() + (&line - lines_.data()));
        break;
      case 1:
        lines_.insert(lines_.begin() + static_cast<std::ptrdiff_t>(Below(lines_.size())), std::string(line));
        break;
      case 2:
        std::swap(line, lines_[Below(lines_.size())]);
        break;
      case 3:
        line.insert(0, Below(2) == 0 ? std::string(Below(12), ' ') : "\t");
        break;
      case 4:
        line = line.substr(0, KeyEnd(line));
        break;
      case 5:
      case 6:
      case 7:
        ReplaceDigit(line);
        break;
      default:
        line = line.substr(0, KeyEnd(line)) + (Below(2) == 0 ? ' ' + OtherValue() : OtherValue());
    }
  }

 private:
  std::uint64_t Below(std::uint64_t end) { return random_() % end; }

  // Behind the key's colon or equals sign.
  static std::size_t KeyEnd(const std::string& line) {
    const std::size_t end = line.find_first_of(":=");
    return end == std::string::npos ? line.size() : end + 1;
  }

  // A number that is still one, mostly.
  void ReplaceDigit(std::string& line) {
    const std::size_t digit = line.find_first_of("0123456789", Below(line.size() + 1));
    if (digit != std::string::npos) line[digit] = "0123456789.-e"[Below(13)];
  }

  std::string OtherValue() {
    const std::vector<std::string> values = {"",
                                             "nan",
                                             "inf",
                                             ".Nan",
                                             "-.Inf",
                                             "1e308",
                                             "-1e308",
                                             "1e-320",
                                             "1e7",
                                             "-1",
                                             "0",
                                             "100000",
                                             "10000",
                                             "2147483647",
                                             "1000000000",
                                             "99999999999999999999",
                                             "true",
                                             "\"\"",
                                             "\"text\"",
                                             "\"" + std::string(5000, 'x') + "\"",
                                             "\"\\u0000\\u001b[2J\\n\"",
                                             "\"\\x1b\"",
                                             "\"/dev/zero\"",
                                             "\"/\"",
                                             "\"..\"",
                                             "\"=1+1\"",
                                             "\xFF\xFE",
                                             std::string("\0\0", 2),
                                             "[]",
                                             "{}",
                                             "[1, 2, 3]",
                                             "[1e300, 1e300, 1e300]",
                                             "[-1e7, -1e7, -1e7, 1e7, 1e7, 1e7]",
                                             "[0, 0, 0, 1e-320, 1e-320, 1e-320]",
                                             "[nan, nan, nan]",
                                             Repeated("[", 40'000),
                                             Repeated("- ", 40'000),
                                             Repeated("{ a: ", 40'000),
                                             Repeated("{a=", 40'000),
                                             Repeated("[", 40'000) + Repeated("]", 40'000),
                                             "[" + Repeated("0,", 100'000) + "0]",
                                             "!!binary |",
                                             "&anchor",
                                             "*anchor",
                                             "1979-05-27T07:32:00Z"};
    return values[Below(values.size())];
  }

  std::vector<std::string>& lines_;
  std::mt19937_64& random_;
};

}  // namespace

std::string Repeated(const std::string& text, std::uint64_t times) {
  std::string all;
  for (std::uint64_t i = 0; i < times; ++i) all += text;
  return all;
}

std::string NameOf(ConfigurationKind kind) {
  constexpr const char* kNames[] = {"rig.yml", "view.yml", "pose.yml", "layout.toml", "trial.toml"};
  return kNames[static_cast<std::size_t>(kind)];
}

void WriteSoundTrial(const std::filesystem::path& folder) {
  test_support::WriteBallRig(folder);
  test_support::WriteBoxStl(folder / "box.stl", 80.0);
  // Any picture of the viewer's size does.
  std::filesystem::copy_file(folder / "cam1" / "mask_0000.png", folder / "view_0.png");
  test_support::WriteText(folder / "view.yml", kView);
  test_support::WriteText(folder / "pose.yml", kPose);
  test_support::WriteText(folder / "layout.toml", kLayout);
  test_support::WriteText(folder / "trial.toml", kTrial);
}

std::map<ConfigurationKind, std::string> SoundTexts(const std::filesystem::path& folder) {
  std::map<ConfigurationKind, std::string> texts;
  for (const ConfigurationKind kind : kKinds) texts[kind] = test_support::ReadText(folder / NameOf(kind));
  return texts;
}

std::string Damaged(const std::string& text, const std::string& other, std::mt19937_64& random) {
  if (random() % 3 == 0) return fuzz::Mutated(text, other, random);
  std::vector<std::string> lines = LinesOf(text);
  for (std::uint64_t i = random() % 2 + 1; i > 0; --i) LineDamage(lines, random).Once();
  std::string damaged;
  for (const std::string& line : lines) damaged += line + '\n';
  return damaged;
}

}  // namespace elbowroom::adversary
