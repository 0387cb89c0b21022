#include "recon/calibration/board_certainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/calibration/banded_schur.h"
#include "recon/calibration/bundle.h"

namespace elbowroom::recon {
namespace {

double TurnSigma(const NormalEquations& e, std::size_t k, double noise_scale) {
  const auto covariance = InverseOfBoard(e, k);
  return covariance ? noise_scale * std::sqrt(covariance->topLeftCorner<3, 3>().trace())
                    : std::numeric_limits<double>::infinity();
}

// Boards that hang together by the motion between them, and the views of them.
struct Run {
  int first_board = 0;
  int boards = 0;
  std::vector<const AdjustedView*> views;
};

std::vector<Run> RunsOf(const Adjustment& a) {
  std::vector<bool> continues(a.boards.size(), false);  // with the next board
  for (const AdjustedView& view : a.views) {
    if (!view.is_used) continue;
    const auto [first, last] = std::ranges::minmax_element(BoardsOf(view));
    for (int k = *first; k < *last; ++k) continues[static_cast<std::size_t>(k)] = true;
  }
  std::vector<Run> runs;
  std::vector<std::size_t> run_of;
  for (std::size_t k = 0; k < continues.size(); ++k) {
    if (k == 0 || !continues[k - 1]) runs.push_back({static_cast<int>(k), 0, {}});
    ++runs.back().boards;
    run_of.push_back(runs.size() - 1);
  }
  for (const AdjustedView& view : a.views)
    if (view.is_used) runs[run_of[static_cast<std::size_t>(view.boards[0])]].views.push_back(&view);
  return runs;
}

void PutSigmasOf(const Run& run, const Adjustment& a, double noise_scale, std::vector<double>* worst) {
  constexpr double kWeak = 1e-9;  // boards that nothing shows would make the equations singular
  NormalEquations all(0, run.boards);
  for (auto& band : all.band) band[0].diagonal().setConstant(kWeak);
  std::vector<std::vector<int>> boards;  // of the views, in the run
  std::vector<Eigen::MatrixXd> information;
  for (const AdjustedView* view : run.views) {
    for (boards.emplace_back(); const int board : BoardsOf(*view))
      boards.back().push_back(board - run.first_board);
    information.push_back(BoardInformation(a, *view));
    all.AddToBand(boards.back(), information.back());
  }
  for (std::size_t i = 0; i < run.views.size(); ++i) {
    NormalEquations others = all;
    others.AddToBand(boards[i], -information[i]);
    const int own = boards[i].front();
    double& sigma = (*worst)[static_cast<std::size_t>(run.first_board + own)];
    sigma = std::max(sigma, TurnSigma(others, static_cast<std::size_t>(own), noise_scale));
  }
}

}  // namespace

std::vector<double> ConfirmedTurnSigmas(const Adjustment& a, double noise_scale) {
  std::vector<double> worst(a.boards.size(), 0.0);
  for (const Run& run : RunsOf(a)) {
    if (run.views.size() > 1)
      PutSigmasOf(run, a, noise_scale, &worst);
    else
      worst[static_cast<std::size_t>(run.first_board)] = std::numeric_limits<double>::infinity();
  }
  return worst;
}

}  // namespace elbowroom::recon
