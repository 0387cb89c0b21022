#include "recon/calibration/board_certainty.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "recon/calibration/banded_schur.h"
#include "recon/calibration/bundle.h"

namespace elbowroom::recon {
namespace {

// Adds `sign` times the information to the boards' part of the equations.
void AddInformation(const AdjustedView& view, const Eigen::MatrixXd& information, double sign,
                    NormalEquations* e) {
  for (int i = 0; i < view.board_count; ++i)
    for (int j = 0; j < view.board_count; ++j) {
      const int row = view.boards[static_cast<std::size_t>(i)],
                column = view.boards[static_cast<std::size_t>(j)];
      if (row >= column)
        e->band[static_cast<std::size_t>(column)][static_cast<std::size_t>(row - column)] +=
            sign * information.block<6, 6>(6 * i, 6 * j);
    }
}

double TurnSigma(const NormalEquations& e, std::size_t k, double noise_scale) {
  const auto covariance = InverseOfBoard(e, k);
  return covariance ? noise_scale * std::sqrt(covariance->topLeftCorner<3, 3>().trace())
                    : std::numeric_limits<double>::infinity();
}

}  // namespace

std::vector<double> ConfirmedTurnSigmas(const Adjustment& a, double noise_scale) {
  // Boards that nothing shows would make the equations singular.
  constexpr double kWeak = 1e-9;
  std::vector<Eigen::MatrixXd> information(a.views.size());
  NormalEquations all(0, static_cast<int>(a.boards.size()));
  for (auto& band : all.band) band[0].diagonal().setConstant(kWeak);
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    if (!a.views[i].is_used) continue;
    information[i] = BoardInformation(a, a.views[i]);
    AddInformation(a.views[i], information[i], 1.0, &all);
  }
  std::vector<double> worst(a.boards.size(), 0.0);
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    const AdjustedView& view = a.views[i];
    if (!view.is_used) continue;
    const auto k = static_cast<std::size_t>(view.boards[0]);
    NormalEquations others = all;
    AddInformation(view, information[i], -1.0, &others);
    worst[k] = std::max(worst[k], TurnSigma(others, k, noise_scale));
  }
  return worst;
}

}  // namespace elbowroom::recon
