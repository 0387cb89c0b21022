#include "recon/calibration/banded_schur.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace elbowroom::recon {
namespace {

using Matrix6d = Eigen::Matrix<double, 6, 6>;
using Wide6 = Eigen::Matrix<double, 6, Eigen::Dynamic>;

// The boards' band as L L^T, and L^-1 (mixed | gradient).
struct EliminatedBoards {
  std::vector<std::array<Matrix6d, 3>> factor;  // as in NormalEquations::band
  std::vector<Wide6> reduced;                   // six rows a board, c + 1 columns
};

// Of the boards' diagonal, added: the instants of all pictures may leave a board between them undecided.
constexpr double kLeastOfBoards = 1e-12;

std::optional<EliminatedBoards> Eliminate(const NormalEquations& e, double damping) {
  const std::size_t count = e.band.size();
  const Eigen::Index columns = e.camera_gradient.size();
  EliminatedBoards boards;
  boards.factor.resize(count);
  boards.reduced.resize(count);
  for (std::size_t k = 0; k < count; ++k) {
    auto [own, next, after] = e.band[k];
    own.diagonal() *= 1.0 + damping;
    Wide6 right(6, columns + 1);
    right << e.mixed[k], e.board_gradient[k];
    for (std::size_t d = 1; d <= 2 && d <= k; ++d) {
      const auto& before = boards.factor[k - d];
      own.noalias() -= before[d] * before[d].transpose();
      if (d == 1) next.noalias() -= before[2] * before[1].transpose();
      right.noalias() -= before[d] * boards.reduced[k - d];
    }
    const Eigen::LLT<Matrix6d> cholesky(own);
    if (cholesky.info() != Eigen::Success) return std::nullopt;
    const Matrix6d lower = cholesky.matrixL();
    const auto triangle = lower.triangularView<Eigen::Lower>();
    triangle.solveInPlace(right);
    boards.reduced[k] = right;
    boards.factor[k] = {lower, triangle.solve(next.transpose()).transpose(),
                        triangle.solve(after.transpose()).transpose()};
  }
  return boards;
}

// The cameras' matrix, and the gradient as its last column, without the boards.
struct ReducedCameras {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
};

ReducedCameras ReduceCameras(const NormalEquations& e, const EliminatedBoards& boards, double damping) {
  const Eigen::Index columns = e.camera_gradient.size();
  ReducedCameras reduced{e.cameras.selfadjointView<Eigen::Lower>(), e.camera_gradient};
  reduced.matrix.diagonal() *= 1.0 + damping;
  for (const Wide6& rows : boards.reduced) {
    reduced.matrix.selfadjointView<Eigen::Lower>().rankUpdate(rows.leftCols(columns).transpose(), -1.0);
    reduced.gradient.noalias() -= rows.leftCols(columns).transpose() * rows.col(columns);
  }
  return reduced;
}

// Parameters of very different size (px, radians, mm) are brought to a unit diagonal before the factors.
struct ScaledCholesky {
  Eigen::VectorXd scale;
  Eigen::LLT<Eigen::MatrixXd> factors;

  // Taking the boards away leaves rounding errors of the diagonal. `least` of it, added, bounds what
  // the equations don't tell, as the last coefficients of a rational lens.
  explicit ScaledCholesky(const Eigen::MatrixXd& lower, double least = 0.0)
      : scale(lower.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse()),
        factors(Eigen::MatrixXd(scale.asDiagonal() * lower * scale.asDiagonal()) +
                least * Eigen::MatrixXd::Identity(lower.rows(), lower.cols())) {}
};

std::optional<Eigen::MatrixXd> InverseOfReduced(const NormalEquations& e, const EliminatedBoards& boards) {
  constexpr double kLeast = 1e-13;
  const ScaledCholesky cholesky(ReduceCameras(e, boards, 0.0).matrix, kLeast);
  if (cholesky.factors.info() != Eigen::Success) return std::nullopt;
  const Eigen::Index columns = e.camera_gradient.size();
  const Eigen::MatrixXd inverse = cholesky.scale.asDiagonal() *
                                  cholesky.factors.solve(Eigen::MatrixXd::Identity(columns, columns)) *
                                  cholesky.scale.asDiagonal();
  return Eigen::MatrixXd(0.5 * (inverse + inverse.transpose()));
}

// mixedᵀ B⁻¹ g of the part's boards, with B the boards' band.
Eigen::VectorXd OfBoardsInCameras(const GradientPart& part, const EliminatedBoards& boards,
                                  Eigen::Index columns) {
  using Vector6d = Eigen::Matrix<double, 6, 1>;
  std::vector<Vector6d> reduced(boards.factor.size(), Vector6d::Zero());
  std::size_t first = reduced.size();
  for (const auto& [board, gradient] : part.boards) {
    reduced[static_cast<std::size_t>(board)] += gradient;
    first = std::min(first, static_cast<std::size_t>(board));
  }
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(columns);
  for (std::size_t k = first; k < reduced.size(); ++k) {
    for (std::size_t d = 1; d <= 2 && k >= first + d; ++d)
      reduced[k] -= boards.factor[k - d][d] * reduced[k - d];
    if (reduced[k].isZero(0.0)) continue;
    boards.factor[k][0].triangularView<Eigen::Lower>().solveInPlace(reduced[k]);
    sum.noalias() += boards.reduced[k].leftCols(columns).transpose() * reduced[k];
  }
  return sum;
}

}  // namespace

NormalEquations::NormalEquations(int camera_parameters, int boards)
    : cameras(Eigen::MatrixXd::Zero(camera_parameters, camera_parameters)),
      camera_gradient(Eigen::VectorXd::Zero(camera_parameters)),
      band(static_cast<std::size_t>(boards), {Matrix6d::Zero(), Matrix6d::Zero(), Matrix6d::Zero()}),
      mixed(static_cast<std::size_t>(boards), Wide6::Zero(6, camera_parameters)),
      board_gradient(static_cast<std::size_t>(boards), Eigen::Matrix<double, 6, 1>::Zero()) {}

void NormalEquations::AddToBand(std::span<const int> boards, const Eigen::MatrixXd& matrix) {
  for (std::size_t i = 0; i < boards.size(); ++i)
    for (std::size_t j = 0; j < boards.size(); ++j)
      if (boards[i] >= boards[j])
        band[static_cast<std::size_t>(boards[j])][static_cast<std::size_t>(boards[i] - boards[j])] +=
            matrix.block<6, 6>(6 * static_cast<Eigen::Index>(i), 6 * static_cast<Eigen::Index>(j));
}

std::optional<Eigen::VectorXd> SolveNormalEquations(const NormalEquations& e, double damping) {
  const std::optional<EliminatedBoards> boards = Eliminate(e, damping);
  if (!boards) return std::nullopt;
  const ReducedCameras reduced = ReduceCameras(e, *boards, damping);
  const ScaledCholesky cholesky(reduced.matrix);
  if (cholesky.factors.info() != Eigen::Success) return std::nullopt;
  const Eigen::Index columns = e.camera_gradient.size();
  const auto count = static_cast<Eigen::Index>(e.band.size());
  Eigen::VectorXd x(columns + 6 * count);
  x.head(columns) =
      cholesky.scale.asDiagonal() * cholesky.factors.solve(cholesky.scale.asDiagonal() * reduced.gradient);
  for (Eigen::Index k = count - 1; k >= 0; --k) {
    const auto at = static_cast<std::size_t>(k);
    const Wide6& rows = boards->reduced[at];
    Eigen::Matrix<double, 6, 1> right = rows.col(columns) - rows.leftCols(columns) * x.head(columns);
    for (Eigen::Index d = 1; d <= 2 && k + d < count; ++d)
      right -=
          boards->factor[at][static_cast<std::size_t>(d)].transpose() * x.segment<6>(columns + 6 * (k + d));
    x.segment<6>(columns + 6 * k) =
        boards->factor[at][0].triangularView<Eigen::Lower>().transpose().solve(right);
  }
  if (!x.allFinite()) return std::nullopt;
  return x;
}

std::optional<Eigen::MatrixXd> InverseOfCameras(const NormalEquations& e) {
  const std::optional<EliminatedBoards> boards = Eliminate(e, kLeastOfBoards);
  return boards ? InverseOfReduced(e, *boards) : std::nullopt;
}

std::optional<double> SpreadOfParts(const NormalEquations& e, const std::vector<GradientPart>& parts) {
  const std::optional<EliminatedBoards> boards = Eliminate(e, kLeastOfBoards);
  if (!boards) return std::nullopt;
  const std::optional<Eigen::MatrixXd> inverse = InverseOfReduced(e, *boards);
  if (!inverse) return std::nullopt;
  double sum = 0.0;
  for (const GradientPart& part : parts) {
    const Eigen::VectorXd left = part.cameras - OfBoardsInCameras(part, *boards, part.cameras.size());
    sum += left.dot(*inverse * left);
  }
  return sum;
}

std::optional<Matrix6d> InverseOfBoard(const NormalEquations& e, std::size_t k) {
  constexpr double kLeast = 1e-10;
  const std::optional<EliminatedBoards> boards = Eliminate(e, kLeast);
  if (!boards) return std::nullopt;
  Matrix6d block = Matrix6d::Zero();
  std::vector<Matrix6d> columns(e.band.size(), Matrix6d::Zero());  // of L^-1, those of board k
  for (std::size_t row = k; row < columns.size(); ++row) {
    Matrix6d right = row == k ? Matrix6d(Matrix6d::Identity()) : Matrix6d(Matrix6d::Zero());
    for (std::size_t d = 1; d <= 2 && row >= k + d; ++d)
      right.noalias() -= boards->factor[row - d][d] * columns[row - d];
    boards->factor[row][0].triangularView<Eigen::Lower>().solveInPlace(right);
    columns[row] = right;
    block.noalias() += right.transpose() * right;
  }
  return block;
}

}  // namespace elbowroom::recon
