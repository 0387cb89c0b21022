// elbowroom gauge RIG.yml --frame N --rod DIAMETER_MM: a known rod, measured against true.
#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/cli/options/command.h"
#include "app/cli/options/unit_option.h"
#include "app/cli/options/value_json.h"
#include "app/cli/repeated_timing.h"
#include "app/control/gauge/gauge_job.h"
#include "app/control/gauge/gauge_page.h"

namespace elbowroom::cli {
namespace {

struct GaugeOptions {
  std::filesystem::path rig_file;
  std::vector<core::FrameIndex> frames;
  std::vector<core::FrameIndex> ranges;  // of --frames, written out
  double diameter_mm = 0.0;
  double length_mm = 0.0;  // 0: not given
  std::filesystem::path out;
  bool save = false;
};

constexpr std::size_t kMostPlaces = 10'000;

// "A:B" or "A:B:STEP", B not included.
std::vector<core::FrameIndex> ParseFrameNumbers(const std::string& text) {
  const auto fail = [&](const std::string& what) {
    return CLI::ValidationError("--frames", fmt::format("'{}': {}", text, what));
  };
  std::vector<core::FrameIndex> numbers;
  const char *at = text.data(), *end = text.data() + text.size();
  while (true) {
    core::FrameIndex number = 0;
    const auto [stop, error] = std::from_chars(at, end, number);
    if (error != std::errc() || number < 0) throw fail("must be A:B or A:B:STEP, as 0:100:10");
    numbers.push_back(number);
    at = stop;
    if (at == end) break;
    if (*at++ != ':') throw fail("must be A:B or A:B:STEP, as 0:100:10");
  }
  if (numbers.size() < 2 || numbers.size() > 3) throw fail("must be A:B or A:B:STEP, as 0:100:10");
  const core::FrameIndex step = numbers.size() == 3 ? numbers[2] : 1;
  if (step < 1) throw fail("the step must be 1 or more");
  if (numbers[1] <= numbers[0]) throw fail("has no frame; B is not included");
  if (static_cast<std::size_t>((numbers[1] - numbers[0] - 1) / step) >= kMostPlaces)
    throw fail(fmt::format("more than {} frames; choose a larger step", kMostPlaces));
  std::vector<core::FrameIndex> frames;
  for (core::FrameIndex frame = numbers[0]; frame < numbers[1]; frame += step) frames.push_back(frame);
  return frames;
}

const char* SightText(recon::RodSight sight) {
  switch (sight) {
    case recon::RodSight::kMeasured:
      return "measured";
    case recon::RodSight::kAstray:
      return "astray";
    case recon::RodSight::kRefutes:
      return "refutes";
    case recon::RodSight::kBlind:
      return "blind";
  }
  return "";
}

nlohmann::json BoundJson(const recon::GaugeBound& bound) {
  return {{"silhouettes_mm", bound.silhouettes_mm},
          {"distance_mm", bound.distance_mm},
          {"calibration_mm", bound.calibration_mm}};
}

// KEY_mm, and KEY_bound_mm.
void Add(const std::string& key, const std::optional<recon::BoundedMm>& value, nlohmann::json* json) {
  (*json)[key + "_mm"] = value ? nlohmann::json(value->value_mm) : nlohmann::json();
  (*json)[key + "_bound_mm"] = value ? nlohmann::json(value->bound.total_mm()) : nlohmann::json();
}

nlohmann::json CameraJson(const recon::CameraOfGauge& camera) {
  nlohmann::json json = {{"name", camera.name},
                         {"sight", SightText(camera.sight)},
                         {"distance_mm", camera.distance_mm},
                         {"excess_px", camera.excess_px}};
  Add("diameter", camera.diameter, &json);
  Add("offset", camera.offset, &json);
  // How far off a camera is that sees the rod elsewhere has no bound.
  if (camera.sight == recon::RodSight::kAstray) json["offset_bound_mm"] = nullptr;
  return json;
}

nlohmann::json PlaceJson(const control::GaugePlace& place) {
  nlohmann::json json = {{"frame", place.frame},
                         {"position_mm", JsonOf(place.rod.position_in_world)},
                         {"direction", JsonOf(place.rod.direction_in_world)},
                         {"seen_mm", place.rod.seen_mm},
                         {"diameter_mm", place.rod.diameter.value_mm},
                         {"error_mm", place.error_mm},
                         {"bound_mm", place.rod.diameter.bound.total_mm()},
                         {"bound", BoundJson(place.rod.diameter.bound)},
                         {"length_error_mm", OrNull(place.length_error_mm)},
                         {"passed", place.passed()},
                         {"faults", place.faults},
                         {"cameras", nlohmann::json::array()}};
  Add("straightness", place.rod.straightness, &json);
  Add("length", place.rod.length, &json);
  for (const recon::CameraOfGauge& camera : place.rod.cameras) json["cameras"].push_back(CameraJson(camera));
  return json;
}

nlohmann::json OutcomeJson(const control::GaugeOutcome& outcome) {
  const control::GaugePlace& worst = outcome.worst_place();
  nlohmann::json json = {{"diameter_mm", worst.rod.diameter.value_mm},
                         {"true_diameter_mm", outcome.truth.diameter_mm},
                         {"error_mm", worst.error_mm},
                         {"bound_mm", worst.rod.diameter.bound.total_mm()},
                         {"bound", BoundJson(worst.rod.diameter.bound)},
                         {"worst_frame", worst.frame},
                         {"true_length_mm", OrNull(outcome.truth.length_mm)},
                         {"places", outcome.places.size()},
                         {"passed", outcome.passed()},
                         {"faults", outcome.faults},
                         {"warnings", outcome.warnings},
                         {"frames", nlohmann::json::array()}};
  const auto at = [&](const std::optional<std::size_t>& i) { return i ? &outcome.places[*i] : nullptr; };
  const control::GaugePlace *length = at(outcome.worst_length), *bow = at(outcome.worst_straightness);
  Add("length", length != nullptr ? length->rod.length : std::nullopt, &json);
  Add("straightness", bow != nullptr ? bow->rod.straightness : std::nullopt, &json);
  for (const control::GaugePlace& place : outcome.places) json["frames"].push_back(PlaceJson(place));
  return json;
}

std::string PlaceText(const control::GaugePlace& place) {
  std::string text =
      fmt::format("frame {}: {:.3f} mm, {:+.3f} mm off, bound {:.3f} mm", place.frame,
                  place.rod.diameter.value_mm, place.error_mm, place.rod.diameter.bound.total_mm());
  if (place.rod.length)
    text += fmt::format("; length {:.1f} +- {:.1f} mm", place.rod.length->value_mm,
                        place.rod.length->bound.total_mm());
  if (place.rod.straightness)
    text += fmt::format("; bow {:.2f} mm, bound {:.2f} mm", place.rod.straightness->value_mm,
                        place.rod.straightness->bound.total_mm());
  text += place.passed() ? "\n" : "; doesn't pass\n";
  for (const std::string& fault : place.faults) text += "  " + fault + "\n";
  return text;
}

std::string TextOf(const control::GaugeOutcome& outcome) {
  std::string text;
  for (const control::GaugePlace& place : outcome.places) text += PlaceText(place);
  for (const std::string& fault : outcome.faults) text += fault + "\n";
  for (const std::string& warning : outcome.warnings) text += "warning: " + warning + "\n";
  const control::GaugePlace& worst = outcome.worst_place();
  return text + fmt::format("{}: {} places, largest error {:+.3f} mm with a bound of {:.3f} mm (frame {})",
                            outcome.passed() ? "passed" : "failed", outcome.places.size(), worst.error_mm,
                            worst.rod.diameter.bound.total_mm(), worst.frame);
}

CommandResult Run(const GaugeOptions& options, const CommandContext& context, bool json) {
  std::vector<core::FrameIndex> frames = options.frames;
  frames.insert(frames.end(), options.ranges.begin(), options.ranges.end());
  const control::TrueRod truth{options.diameter_mm,
                               options.length_mm > 0.0 ? std::optional(options.length_mm) : std::nullopt};
  const control::GaugeFrames input =
      control::ReadGaugeFrames(options.rig_file, std::move(frames), context.progress, context.stop);
  control::GaugeOutcome outcome;
  CommandResult result;
  const RunTimes times = ComputeAndTime(
      json, [&] { outcome = control::GaugeRig(input, truth, context.progress, context.stop); });
  result.json = OutcomeJson(outcome);
  AddTimes(times, &result.json);
  result.text = TextOf(outcome);
  if (!options.out.empty()) {
    const auto page = control::WriteGaugePage(input.rig_file.rig, outcome, options.out);
    result.json["out"] = page.string();
    result.text += "\n" + page.string();
  }
  if (options.save) recon::SaveGauge(control::RigGaugeOf(outcome), options.rig_file);
  result.json["saved"] = options.save;
  if (!outcome.passed())
    result.hint = fmt::format("{}: the gauge failed; measurements of this rig can't be trusted",
                              options.rig_file.string());
  return result;
}

}  // namespace

void AddGaugeCommand(CLI::App& app, Choice* choice) {
  CLI::App* command =
      app.add_subcommand("gauge", "measure a rod of known diameter: what the rig makes of it, against true");
  auto options = std::make_shared<GaugeOptions>();
  command->add_option("RIG", options->rig_file, "the rig (RIG.yml)")->required();
  command->add_option("--frame", options->frames, "frame number, from 0; may be given several times")
      ->check(CLI::NonNegativeNumber)
      ->take_all();
  command
      ->add_option_function<std::vector<std::string>>(
          "--frames",
          [options](const std::vector<std::string>& texts) {
            for (const std::string& text : texts) {
              const std::vector<core::FrameIndex> range = ParseFrameNumbers(text);
              options->ranges.insert(options->ranges.end(), range.begin(), range.end());
            }
          },
          "frames from A to B, B not included, the rod at one place in each; may be given several times")
      ->type_name("A:B[:STEP]");
  command->add_option("--rod", options->diameter_mm, "the rod's true diameter, mm")
      ->required()
      ->check(PositiveLength());
  command
      ->add_option("--length", options->length_mm, "its true length, mm; without it the length isn't judged")
      ->check(PositiveLength());
  command->add_option("--out", options->out, "folder for gauge.html; made if needed");
  command->add_flag("--save", options->save, "keep the result in RIG.yml");
  command->callback([=, &app] {
    if (options->frames.empty() && options->ranges.empty()) throw CLI::RequiredError("--frame or --frames");
    const bool json = app.get_option("--json")->as<bool>();
    choice->action = [=](const CommandContext& context) { return Run(*options, context, json); };
  });
}

}  // namespace elbowroom::cli
