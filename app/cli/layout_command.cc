// elbowroom layout: a LAYOUT.toml from CAD, without an editor.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/layout_listing.h"
#include "app/cli/options/command.h"
#include "app/cli/options/file_ending.h"
#include "app/cli/options/unit_option.h"
#include "app/control/layout_editing/folder_lock.h"
#include "app/control/layout_editing/layout_edit.h"
#include "app/control/layout_picture.h"
#include "cad_import/layout/layout_file.h"
#include "core/error.h"
#include "core/system/whole_file.h"
#include "recon/images/png_file.h"

namespace elbowroom::cli {
namespace {

namespace fs = std::filesystem;
using cad_import::LayoutText;
using control::FolderLock;
using control::PairEdit;
using control::PartEdit;
using control::SpacingEdit;

// The options of all these commands.
struct LayoutOptions {
  fs::path layout;
  std::vector<fs::path> files;
  std::optional<core::LengthUnit> unit;
  fs::path picture;
  PartEdit part;
  SpacingEdit spacing;
  core::Group group;
  PairEdit pair;
  std::vector<std::string> names;
};
using SharedOptions = std::shared_ptr<LayoutOptions>;
using LayoutAction = CommandResult (*)(const LayoutOptions&, const CommandContext&);

// Writes the text if it is a valid layout. The result lists the layout, after a line that says what was done.
CommandResult Save(const LayoutText& text, const std::string& what, const CommandContext& context,
                   core::Layout* saved = nullptr) {
  cad_import::ImportedLayout imported;
  try {
    imported = cad_import::ImportLayoutText(text, context.progress, context.stop);
  } catch (const core::Error& error) {
    throw core::Error(error.kind(), fmt::format("nothing was written: {}", error.what()));
  }
  core::WriteWholeFile(text.file(), text.text());
  CommandResult result = ListingOf(imported, text.file());
  result.text.insert(0, what + "\n");
  if (saved != nullptr) *saved = std::move(imported.layout);
  return result;
}

CommandResult New(const LayoutOptions& options, const CommandContext& context) {
  if (fs::exists(options.layout)) {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("{}: is there already; choose another name, or add to it with `elbowroom "
                                  "layout add`",
                                  options.layout.string()));
  }
  const fs::path folder = fs::absolute(options.layout).parent_path();
  if (!fs::is_directory(folder)) {
    throw core::Error(core::ErrorKind::kFile,
                      fmt::format("{}: no such folder; make it first", folder.string()));
  }
  LayoutText text({}, options.layout);
  if (options.unit) text.SetUnit(*options.unit);
  for (const fs::path& file : options.files) {
    PartEdit part;
    part.file = file;
    control::AddPart(text, part);
  }
  if (!options.files.empty()) return Save(text, "made " + options.layout.string(), context);
  core::WriteWholeFile(options.layout, text.text());
  return {{{"file", options.layout.string()}, {"parts", nlohmann::json::array()}},
          fmt::format("made {}; it has no parts yet", options.layout.string())};
}

CommandResult Add(const LayoutOptions& options, const CommandContext& context) {
  LayoutText text = LayoutText::Read(options.layout);
  PartEdit part = options.part;
  part.file = options.files.front();
  part.unit = options.unit;
  const std::string name = control::AddPart(text, part);
  return Save(text, fmt::format("added part '{}'", name), context);
}

CommandResult Space(const LayoutOptions& options, const CommandContext& context) {
  LayoutText text = LayoutText::Read(options.layout);
  control::PutSpacing(text, options.spacing);
  return Save(text, fmt::format("spacing '{}' is set", options.spacing.name), context);
}

CommandResult Group(const LayoutOptions& options, const CommandContext& context) {
  LayoutText text = LayoutText::Read(options.layout);
  control::PutGroup(text, options.group);
  return Save(text, fmt::format("group '{}' is set", options.group.name), context);
}

CommandResult Pair(const LayoutOptions& options, const CommandContext& context) {
  LayoutText text = LayoutText::Read(options.layout);
  control::PutPair(text, options.pair);
  return Save(text, fmt::format("pair '{}' and '{}' is set", options.pair.a, options.pair.b), context);
}

CommandResult Move(const LayoutOptions& options, const CommandContext& context) {
  LayoutText text = LayoutText::Read(options.layout);
  control::MovePart(text, options.part);
  core::Layout layout;
  CommandResult result = Save(text, fmt::format("part '{}' is moved", options.part.name), context, &layout);
  // Along the axis of a spacing that moves the part, the gap decides where the part is, not its position.
  for (const core::Spacing& spacing : layout.spacings) {
    const std::vector<core::PartIndex> moving = layout.PartsNamed(spacing.moving);
    if (!options.part.position_mm ||
        std::ranges::count(moving, layout.FindPart(options.part.name).value_or(layout.parts.size())) == 0)
      continue;
    result.text += fmt::format("\nits {} is set by the spacing '{}', whatever its position says",
                               core::ToString(spacing.axis), spacing.name);
  }
  return result;
}

CommandResult Remove(const LayoutOptions& options, const CommandContext& context) {
  LayoutText text = LayoutText::Read(options.layout);
  for (const std::string& name : options.names) control::RemoveNamed(text, name);
  if (!options.pair.a.empty()) control::RemovePair(text, options.pair);
  return Save(text,
              options.names.empty()
                  ? fmt::format("removed the pair '{}' and '{}'", options.pair.a, options.pair.b)
                  : fmt::format("removed '{}'", fmt::join(options.names, "', '")),
              context);
}

CommandResult Show(const LayoutOptions& options, const CommandContext& context) {
  CheckEnding("--picture", options.picture, {".png"});
  const cad_import::ImportedLayout imported =
      cad_import::ImportLayoutFile(options.layout, context.progress, context.stop);
  CommandResult result = ListingOf(imported, options.layout);
  if (options.picture.empty()) return result;
  recon::gl::SceneRenderer renderer;
  const core::Layout& layout = imported.layout;
  recon::WritePng(control::LayoutPicture(renderer, layout, core::PosesAt(layout, layout.InitialSpacings())),
                  options.picture);
  result.json["picture"] = options.picture.string();
  result.text += "\npicture: " + options.picture.string();
  return result;
}

// Accepts finite numbers, also negative ones.
CLI::Validator FiniteNumber() {
  return {[](const std::string& text) -> std::string {
            return ParseNumber(text) ? "" : "must be a number, not " + text;
          },
          "NUMBER"};
}

void AddNumber(CLI::App& command, const std::string& option, std::optional<double>* value,
               const std::string& what) {
  command.add_option(option, *value, what)->check(FiniteNumber());
}

// --name, and --no-name for the opposite.
void AddSwitch(CLI::App& command, const std::string& name, std::optional<bool>* value,
               const std::string& what) {
  command.add_flag_function(
      fmt::format("--{0},!--no-{0}", name), [value](std::int64_t count) { *value = count > 0; }, what);
}

void AddVector(CLI::App& command, const std::string& option, std::optional<Eigen::Vector3d>* value,
               const std::string& what, const std::string& type) {
  command
      .add_option_function<std::vector<double>>(
          option, [value](const std::vector<double>& v) { *value = Eigen::Vector3d(v[0], v[1], v[2]); }, what)
      ->expected(3)
      ->check(FiniteNumber())
      ->type_name(type);
}

void RequireOneOf(CLI::App& command, const std::vector<std::string>& options) {
  command.parse_complete_callback([&command, options] {
    const auto is_given = [&](const std::string& name) { return command.count(name) > 0; };
    if (std::ranges::none_of(options, is_given))
      throw CLI::RequiredError(fmt::format("{}", fmt::join(options, " or ")));
  });
}

void AddPlace(CLI::App& command, PartEdit* part) {
  AddVector(command, "--position", &part->position_mm, "where the part's origin stands, mm in world",
            "X Y Z");
  AddVector(command, "--rotation", &part->rotation_rpy_deg,
            "about the fixed x, then y, then z axis, degrees (roll, pitch, yaw)", "R P Y");
}

// Adds a command of `layout` with its first argument.
CLI::App* AddCommand(CLI::App& layout, const SharedOptions& options, Choice* choice, const std::string& name,
                     const std::string& what, LayoutAction run) {
  CLI::App* command = layout.add_subcommand(name, what);
  command->add_option("LAYOUT", options->layout, "layout (TOML)")->required();
  command->callback(
      [=] { choice->action = [=](const CommandContext& context) { return run(*options, context); }; });
  return command;
}

// Runs a command that changes the layout, and keeps other programs from changing it between reading and
// writing.
template <LayoutAction kChange>
CommandResult Alone(const LayoutOptions& options, const CommandContext& context) {
  const FolderLock lock(options.layout);
  return kChange(options, context);
}

void AddPartCommands(CLI::App& layout, Choice* choice) {
  auto made = std::make_shared<LayoutOptions>();
  CLI::App* make = AddCommand(layout, made, choice, "new", "make a layout of CAD files", Alone<New>);
  make->add_option("FILE", made->files, "parts, each where its file has it");
  AddUnitOption(*make, &made->unit);

  auto added = std::make_shared<LayoutOptions>();
  CLI::App* add = AddCommand(layout, added, choice, "add", "add a part", Alone<Add>);
  add->add_option("FILE", added->files, "CAD file")->required()->expected(1);
  add->add_option("--name", added->part.name, "the part's name (default: the file's)");
  add->add_option("--node", added->part.node, "only this instance of an assembly, Path/Of/Node");
  AddUnitOption(*add, &added->unit);
  AddPlace(*add, &added->part);

  auto moved = std::make_shared<LayoutOptions>();
  CLI::App* move = AddCommand(layout, moved, choice, "move", "put a part elsewhere", Alone<Move>);
  move->add_option("PART", moved->part.name, "its name")->required();
  AddPlace(*move, &moved->part);
  RequireOneOf(*move, {"--position", "--rotation"});

  auto removed = std::make_shared<LayoutOptions>();
  CLI::App* remove =
      AddCommand(layout, removed, choice, "remove", "remove a part, group, spacing or pair", Alone<Remove>);
  CLI::Option* names = remove->add_option("NAME", removed->names, "of parts, groups, spacings, streams");
  remove
      ->add_option_function<std::vector<std::string>>(
          "--pair",
          [removed](const std::vector<std::string>& pair) {
            removed->pair.a = pair[0];
            removed->pair.b = pair[1];
          },
          "the rule of these two")
      ->expected(2)
      ->type_name("A B")
      ->excludes(names);
  RequireOneOf(*remove, {"NAME", "--pair"});
}

void AddRuleCommands(CLI::App& layout, Choice* choice) {
  auto spaced = std::make_shared<LayoutOptions>();
  CLI::App* space = AddCommand(layout, spaced, choice, "space",
                               "add a spacing, or change what is given of it", Alone<Space>);
  SpacingEdit& spacing = spaced->spacing;
  space->add_option("NAME", spacing.name, "the spacing's name")->required();
  space->add_option("--moving", spacing.moving, "part or group that it moves");
  space->add_option("--reference", spacing.reference, "part or group that stays");
  space->add_option("--axis", spacing.axis, "along which world axis")->check(CLI::IsMember({"x", "y", "z"}));
  AddNumber(*space, "--min", &spacing.min_mm, "smallest gap, mm");
  AddNumber(*space, "--max", &spacing.max_mm, "largest gap, mm");
  AddNumber(*space, "--initial", &spacing.initial_mm, "gap to start with, mm");

  auto grouped = std::make_shared<LayoutOptions>();
  CLI::App* group = AddCommand(layout, grouped, choice, "group", "name parts that go together", Alone<Group>);
  group->add_option("NAME", grouped->group.name, "the group's name")->required();
  group->add_option("PART", grouped->group.parts, "its parts")->required();

  auto paired = std::make_shared<LayoutOptions>();
  CLI::App* pair =
      AddCommand(layout, paired, choice, "pair", "say what holds between two parts or groups", Alone<Pair>);
  PairEdit& rule = paired->pair;
  pair->add_option("A", rule.a, "part or group")->required();
  pair->add_option("B", rule.b, "part or group")->required();
  pair->add_option("--required-clearance", rule.required_clearance_mm, "how far apart they must be, mm")
      ->check(LengthFromZero());
  AddSwitch(*pair, "authorised-contact", &rule.authorised_contact, "they may touch");
  AddSwitch(*pair, "ignore", &rule.ignore, "they aren't judged at all");
  RequireOneOf(*pair, {"--required-clearance", "--authorised-contact", "--ignore"});
}

}  // namespace

void AddLayoutCommand(CLI::App& app, Choice* choice) {
  CLI::App* layout = app.add_subcommand("layout", "make, change and show a layout of parts");
  layout->require_subcommand(1);
  AddPartCommands(*layout, choice);
  AddRuleCommands(*layout, choice);
  auto shown = std::make_shared<LayoutOptions>();
  CLI::App* show = AddCommand(*layout, shown, choice, "show", "its parts, sizes, gaps and rules", Show);
  show->add_option("--picture", shown->picture, "picture to write (.png)");
}

}  // namespace elbowroom::cli
