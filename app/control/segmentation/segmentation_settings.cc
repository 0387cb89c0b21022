#include "app/control/segmentation/segmentation_settings.h"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <string_view>
#include <utility>

#include "core/error.h"
#include "core/system/file_sync.h"
#include "recon/images/mask_image.h"

namespace elbowroom::control {
namespace {

[[noreturn]] void FailAsNoSetting(const std::string& key, const std::string& value) {
  throw core::Error(core::ErrorKind::kFormat,
                    fmt::format("its setting {} = '{}' isn't one of this program", key, value));
}

// Settings read one by one.
class SettingsReader {
 public:
  explicit SettingsReader(const Settings& settings) : settings_(settings) {}

  template <typename Number>
  [[nodiscard]] std::optional<Number> NumberOf(const std::string& key) const {
    const auto found = settings_.find(key);
    if (found == settings_.end()) return std::nullopt;
    const std::string& text = found->second;
    Number number{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size()) FailAsNoSetting(key, text);
    return number;
  }

  template <typename Value, typename Parse>
  [[nodiscard]] Value ChoiceOf(const std::string& key, Value otherwise, Parse parse) const {
    const auto found = settings_.find(key);
    if (found == settings_.end()) return otherwise;
    const std::optional<Value> value = parse(found->second);
    if (!value) FailAsNoSetting(key, found->second);
    return *value;
  }

 private:
  const Settings& settings_;
};

std::string CameraKey(const std::string& camera) { return fmt::format("segmentation.camera.{}.", camera); }

}  // namespace

Settings SettingsOf(const recon::SegmentationOptions& options) {
  Settings settings{{"segmentation.method", std::string(ToString(options.method))},
                    {"segmentation.k_sigma", fmt::format("{}", options.k_sigma)},
                    {"segmentation.floor_levels", fmt::format("{}", options.floor_levels)},
                    {"segmentation.min_blob_px", fmt::format("{}", options.min_blob_px)},
                    {"segmentation.max_hole_px", fmt::format("{}", options.max_hole_px)},
                    {"segmentation.edge_slack_px", fmt::format("{}", options.edge_slack_px)},
                    {"segmentation.shadow_darkest", fmt::format("{}", options.shadow_darkest)},
                    {"segmentation.shadow_chroma", fmt::format("{}", options.shadow_chroma)},
                    {"segmentation.shadows", std::string(ToString(options.shadows))}};
  for (const recon::CameraSegmentation& camera : options.cameras) {
    const std::string key = CameraKey(camera.camera);
    if (camera.k_sigma) settings[key + "k_sigma"] = fmt::format("{}", *camera.k_sigma);
    if (camera.floor_levels) settings[key + "floor_levels"] = fmt::format("{}", *camera.floor_levels);
    if (camera.ignore.width_px() != 0)
      settings[key + "ignored_pixels"] = fmt::format("{}", camera.ignore.CountObjectPixels());
  }
  return settings;
}

recon::SegmentationOptions OptionsFrom(const Settings& settings, const core::Rig& rig) {
  const SettingsReader read(settings);
  recon::SegmentationOptions options;
  const auto number = [&]<typename Number>(const std::string& name, Number* value) {
    *value = read.NumberOf<Number>("segmentation." + name).value_or(*value);
  };
  options.method = read.ChoiceOf("segmentation.method", options.method, recon::ParseSegmentationMethod);
  options.shadows = read.ChoiceOf("segmentation.shadows", options.shadows, recon::ParseShadowRule);
  number("k_sigma", &options.k_sigma);
  number("floor_levels", &options.floor_levels);
  number("min_blob_px", &options.min_blob_px);
  number("max_hole_px", &options.max_hole_px);
  number("edge_slack_px", &options.edge_slack_px);
  number("shadow_darkest", &options.shadow_darkest);
  number("shadow_chroma", &options.shadow_chroma);
  for (const core::CameraModel& model : rig.cameras) {
    const std::string key = CameraKey(model.name());
    recon::CameraSegmentation camera{model.name(),
                                     read.NumberOf<double>(key + "k_sigma"),
                                     read.NumberOf<double>(key + "floor_levels"),
                                     {}};
    if (camera.k_sigma || camera.floor_levels || IgnoredPixelsOf(settings, model) > 0)
      options.cameras.push_back(std::move(camera));
  }
  options.Validate(rig);
  return options;
}

std::int64_t IgnoredPixelsOf(const Settings& settings, const core::CameraModel& camera) {
  return SettingsReader(settings)
      .NumberOf<std::int64_t>(CameraKey(camera.name()) + "ignored_pixels")
      .value_or(0);
}

std::filesystem::path IgnoredPixelsFile(const std::filesystem::path& footage, core::CameraIndex camera) {
  return footage / "ignored_pixels" / fmt::format("{}.png", camera + 1);
}

void KeepIgnoredPixels(const recon::SegmentationOptions& options, const core::Rig& rig,
                       const std::filesystem::path& footage) {
  for (core::CameraIndex i = 0; i < rig.cameras.size(); ++i) {
    const recon::CameraSegmentation* camera = options.OfCamera(rig.cameras[i].name());
    if (camera == nullptr || camera->ignore.width_px() == 0) continue;
    const std::filesystem::path file = IgnoredPixelsFile(footage, i);
    core::MakeFolder(file.parent_path());
    recon::WriteMaskPng(camera->ignore, file);
  }
}

}  // namespace elbowroom::control
