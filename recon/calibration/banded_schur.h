// Normal equations whose boards are eliminated first.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace elbowroom::recon {

// H x = g, with c parameters of cameras and six of each board. Of the boards only those couple that stand at
// most two places apart: the part to eliminate is a band, and so is its Cholesky factor. Time is of the order
// of boards * c^2.
struct NormalEquations {
  Eigen::MatrixXd cameras;                                       // c x c, lower triangle
  Eigen::VectorXd camera_gradient;                               // c
  std::vector<std::array<Eigen::Matrix<double, 6, 6>, 3>> band;  // [k][d]: rows of board k + d, columns of k
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> mixed;   // [k]: rows of board k, columns of cameras
  std::vector<Eigen::Matrix<double, 6, 1>> board_gradient;

  NormalEquations(int camera_parameters, int boards);

  // Adds a whole matrix of six rows and columns for each of the boards.
  void AddToBand(std::span<const int> boards, const Eigen::MatrixXd& matrix);
};

// x for H with its diagonal multiplied by 1 + damping; nothing: not positive definite.
[[nodiscard]] std::optional<Eigen::VectorXd> SolveNormalEquations(const NormalEquations& equations,
                                                                  double damping);

// The cameras' c x c part of the inverse of H, in directions that H tells to 1e-13 of its diagonal (of the
// boards', to 1e-12); nothing: not positive definite.
[[nodiscard]] std::optional<Eigen::MatrixXd> InverseOfCameras(const NormalEquations& equations);

// A share of the right-hand side g.
struct GradientPart {
  Eigen::VectorXd cameras;                                          // c
  std::vector<std::pair<int, Eigen::Matrix<double, 6, 1>>> boards;  // by number
};

// The sum over the parts of xᵀ C x, with x what is left of a part for the cameras once the boards are
// eliminated, and C as InverseOfCameras; nothing: not positive definite.
[[nodiscard]] std::optional<double> SpreadOfParts(const NormalEquations& equations,
                                                  const std::vector<GradientPart>& parts);

// Board k's 6 x 6 block of the inverse of the boards' part of H, as if the cameras were known, in directions
// that H tells to 1e-10 of its diagonal; nothing: not positive definite.
[[nodiscard]] std::optional<Eigen::Matrix<double, 6, 6>> InverseOfBoard(const NormalEquations& equations,
                                                                        std::size_t k);

}  // namespace elbowroom::recon
