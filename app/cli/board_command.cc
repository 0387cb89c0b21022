// elbowroom board KIND --columns N --rows N --square MM ... --out BOARD.pdf: a calibration board to print.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "app/cli/options/command.h"
#include "app/cli/options/file_ending.h"
#include "app/cli/options/unit_option.h"
#include "core/error.h"
#include "core/system/whole_file.h"
#include "recon/boards/board.h"
#include "recon/boards/board_drawing.h"
#include "recon/boards/board_page.h"

namespace elbowroom::cli {
namespace {

constexpr double kUsualMarker = 0.75;  // of a square

struct BoardOptions {
  std::string kind;
  recon::Board board;
  std::string layout;
  std::filesystem::path out;
};

// Throws: Error{kRange} for an option that the board's kind has no use for.
void RefuseUnused(const BoardOptions& options, bool has_markers, bool is_charuco) {
  const auto refuse = [&options](bool is_given, const char* option) {
    if (is_given)
      throw core::Error(core::ErrorKind::kRange,
                        fmt::format("{}: a board of kind {} has none; leave it out", option, options.kind));
  };
  refuse(!has_markers && options.board.marker_mm != 0.0, "--marker");
  refuse(!has_markers && !options.board.dictionary.empty(), "--dictionary");
  refuse(!is_charuco && !options.layout.empty(), "--layout");
}

recon::Board BoardOf(const BoardOptions& options) {
  recon::Board board = options.board;
  board.kind = recon::ParseBoardKind(options.kind).value();
  const bool is_charuco = board.kind == recon::BoardKind::kCharuco;
  RefuseUnused(options, board.has_markers(), is_charuco);
  if (options.layout == "legacy") board.layout = recon::CharucoLayout::kLegacy;
  if (!board.has_markers()) return board;
  if (board.marker_mm == 0.0) board.marker_mm = kUsualMarker * board.square_mm;
  if (board.dictionary.empty()) board.dictionary = is_charuco ? "DICT_5X5_250" : "DICT_APRILTAG_36h11";
  return board;
}

CommandResult Run(const BoardOptions& options) {
  CheckEnding("--out", options.out, {".pdf"});
  const recon::Board board = BoardOf(options);
  const recon::BoardPage page = recon::PageFor(recon::DrawBoard(board));
  core::WriteWholeFile(options.out, recon::BoardAsPdf(board, page));
  CommandResult result;
  result.json["type"] = recon::ToString(board.kind);
  result.json["columns"] = board.columns;
  result.json["rows"] = board.rows;
  result.json["square_mm"] = board.square_mm;
  result.json["inverted"] = board.inverted;
  if (board.has_markers()) {
    result.json["marker_mm"] = board.marker_mm;
    result.json["dictionary"] = board.dictionary;
  }
  if (board.kind == recon::BoardKind::kCharuco)
    result.json["layout"] = board.layout == recon::CharucoLayout::kLegacy ? "legacy" : "current";
  result.json["points"] = recon::PointsOf(board).size();
  result.json["paper"] = page.paper;
  result.json["page_mm"] = {page.width_mm, page.height_mm};
  result.json["toml"] = recon::BoardAsToml(board);
  result.text =
      fmt::format("{}: {} paper, {:.6g} x {:.6g} mm. Print it at 100 % and measure its rulers.\n{}",
                  options.out.string(), page.paper, page.width_mm, page.height_mm, recon::BoardAsToml(board));
  return result;
}

}  // namespace

void AddBoardCommand(CLI::App& app, Choice* choice) {
  CLI::App* command = app.add_subcommand("board", "write a calibration board to print, true to scale");
  auto options = std::make_shared<BoardOptions>();
  command->add_option("kind", options->kind, "chessboard, charuco, apriltag, circles or circles_asymmetric")
      ->required()
      ->check(CLI::IsMember({"chessboard", "charuco", "apriltag", "circles", "circles_asymmetric"}));
  command
      ->add_option("--columns", options->board.columns,
                   "columns of inner corners (chessboard), squares (charuco), tags or circles")
      ->required();
  command->add_option("--rows", options->board.rows, "rows of the same")->required();
  command
      ->add_option("--square", options->board.square_mm,
                   "side of a square, mm; of tags and circles: from one to the next")
      ->required()
      ->check(PositiveLength());
  command
      ->add_option("--marker", options->board.marker_mm,
                   "side of a marker or tag, mm (default: three quarters of --square)")
      ->check(PositiveLength());
  command->add_option("--dictionary", options->board.dictionary,
                      "markers, as OpenCV names them (default: DICT_5X5_250, DICT_APRILTAG_36h11)");
  command
      ->add_option("--layout", options->layout,
                   "charuco: current (default), or legacy as OpenCV before 4.6 has it")
      ->check(CLI::IsMember({"current", "legacy"}));
  command->add_flag("--inverted", options->board.inverted, "white and black exchanged");
  command->add_option("--out", options->out, "file to write (.pdf)")->required();
  command->callback([=] { choice->action = [=](const CommandContext&) { return Run(*options); }; });
}

}  // namespace elbowroom::cli
