// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// G. Golub, R. Underwood, "The block Lanczos method for computing eigenvalues", Mathematical Software III, 1977.
// R. Grimes, J. Lewis, H. Simon, "A shifted block Lanczos algorithm for solving sparse symmetric generalized
//   eigenproblems", SIAM Journal on Matrix Analysis 15(1), 1994.
// J. Sun, M. Ovsjanikov, L. Guibas, "A concise and provably informative multi-scale signature based on heat diffusion",
//   Computer Graphics Forum 28(5), 2009.
#include "operators/eigenbasis.hpp"

#include "rhizodont/error.hpp"

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cstdint>

namespace rhizodont {
namespace {

constexpr Eigen::Index width = 8;  // of a block: as many numbers as the widest vector registers hold
using Block = Eigen::Matrix<double, Eigen::Dynamic, width, Eigen::RowMajor>;

/// mass^1/2 (stiffness - shift mass)^-1 mass^1/2: its largest eigenvalues belong to the smallest of the problem.
class InverseOperator {
 public:
  InverseOperator(const SurfaceOperators& operators, double shift) : root_(operators.mass.cwiseSqrt()) {
    Eigen::SparseMatrix<double> shifted = operators.stiffness;
    shifted.diagonal() -= shift * operators.mass;
    solver_.compute(shifted);
    if (solver_.info() != Eigen::Success || !(solver_.vectorD().minCoeff() > 0))
      throw InputError("The mesh is too degenerate for the eigenfunctions of its surface.");
    order_ = solver_.permutationP().indices();
    lower_ = solver_.matrixL();
    inverse_diagonal_ = solver_.vectorD().cwiseInverse();
  }

  /// All columns of a block go through the factors together, which are read once.
  [[gnu::noinline]] Block apply(const Block& x) const {
    const Eigen::Index n = x.rows();
    Block y(n, width);
    for (Eigen::Index i = 0; i < n; ++i) y.row(order_[i]) = root_[i] * x.row(i);
    const int* outer = lower_.outerIndexPtr();
    const int* inner = lower_.innerIndexPtr();
    const double* value = lower_.valuePtr();
    substitute_forward(outer, inner, value, n, y.data());
    for (Eigen::Index i = 0; i < n; ++i) y.row(i) *= inverse_diagonal_[i];
    substitute_backward(outer, inner, value, n, y.data());
    Block result(n, width);
    for (Eigen::Index i = 0; i < n; ++i) result.row(i) = root_[i] * y.row(order_[i]);
    return result;
  }

 private:
  static void substitute_forward(const int* outer, const int* inner, const double* value, Eigen::Index n, double* y) {
    for (Eigen::Index j = 0; j < n; ++j) {
      const double* from = y + j * width;
      for (int e = outer[j]; e < outer[j + 1]; ++e) {
        if (inner[e] == j) continue;  // the unit diagonal
        double* to = y + inner[e] * width;
        for (Eigen::Index c = 0; c < width; ++c) to[c] -= value[e] * from[c];
      }
    }
  }

  static void substitute_backward(const int* outer, const int* inner, const double* value, Eigen::Index n, double* y) {
    for (Eigen::Index j = n; j-- > 0;) {
      double sum[width] = {};
      for (int e = outer[j]; e < outer[j + 1]; ++e) {
        if (inner[e] == j) continue;
        const double* from = y + inner[e] * width;
        for (Eigen::Index c = 0; c < width; ++c) sum[c] += value[e] * from[c];
      }
      for (Eigen::Index c = 0; c < width; ++c) y[j * width + c] -= sum[c];
    }
  }

  Eigen::VectorXd root_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  Eigen::SparseMatrix<double> lower_;
  Eigen::VectorXd inverse_diagonal_;
  Eigen::VectorXi order_;
};

/// Numbers in [-1, 1) that depend on their place alone.
Block scattered(Eigen::Index n) {
  Block block(n, width);
  std::uint64_t state = 0x9e3779b97f4a7c15ULL;
  for (Eigen::Index i = 0; i < block.size(); ++i) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    block.data()[i] = static_cast<double>(state >> 11) * 0x1.0p-52 - 1;
  }
  return block;
}

/// Krylov space of an operator, orthonormal, with the operator's image in it.
class KrylovSpace {
 public:
  KrylovSpace(const InverseOperator& op, Eigen::Index n, Eigen::Index most) : op_(op), space_(n, most) {
    projected_ = Eigen::MatrixXd::Zero(most, most);
    Block start = scattered(n);
    orthonormalise(start, 0);
  }

  Eigen::Index size() const { return size_; }
  bool has_room() const { return size_ + width <= space_.cols(); }
  auto basis() const { return space_.leftCols(size_); }

  /// Adds the image of the newest block. What leads out of the space afterwards is `rest()`.
  void extend() {
    Block image = op_.apply(space_.middleCols(size_ - width, width));
    const Eigen::Index newest = size_ - width;
    const Eigen::MatrixXd along = remove_part_in_space(image);
    projected_.block(0, newest, size_, width) = along;
    projected_.block(newest, 0, width, size_) = along.transpose();
    complete_ = size_;
    if (has_room())
      rest_ = orthonormalise(image, size_);
    else
      rest_ = triangular_factor(image);
  }

  /// Eigenvalues, ascending, and vectors of the operator within the space that was complete at the last `extend`.
  Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solve() const {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(projected_.topLeftCorner(complete_, complete_));
  }
  Eigen::Index complete() const { return complete_; }
  const Eigen::MatrixXd& rest() const { return rest_; }

 private:
  /// Nearly all of an image lies in the two newest blocks: once these are gone, one pass over the whole space leaves no
  /// more than rounding of what is left.
  Eigen::MatrixXd remove_part_in_space(Block& block) {
    const Eigen::Index newest = std::min<Eigen::Index>(2 * width, size_);
    const auto recent = space_.middleCols(size_ - newest, newest);
    const Eigen::MatrixXd first = recent.transpose() * block;
    block.noalias() -= recent * first;
    Eigen::MatrixXd part = basis().transpose() * block;
    block.noalias() -= basis() * part;
    part.bottomRows(newest) += first;
    return part;
  }

  static Eigen::MatrixXd triangular_factor(const Block& block) {
    const Eigen::LLT<Eigen::MatrixXd> factor(block.transpose() * block +
                                             1e-30 * Eigen::MatrixXd::Identity(width, width));
    return factor.matrixU();
  }

  /// Orthonormal columns for `block`, put into the space at `at`; block = columns times what is returned.
  Eigen::MatrixXd orthonormalise(Block& block, Eigen::Index at) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(block);
    Eigen::MatrixXd columns = qr.householderQ() * Eigen::MatrixXd::Identity(block.rows(), width);
    const Eigen::MatrixXd upper = qr.matrixQR().topRows(width).triangularView<Eigen::Upper>();
    const Eigen::VectorXd sizes = upper.diagonal().cwiseAbs();
    if (at > 0 && sizes.minCoeff() < 1e-5 * sizes.maxCoeff()) {  // a column that is all but rounding may lead back
      columns -= space_.leftCols(at) * (space_.leftCols(at).transpose() * columns).eval();
      columns.colwise().normalize();
    }
    space_.middleCols(at, width) = columns;
    size_ = at + width;
    return upper;
  }

  const InverseOperator& op_;
  Eigen::MatrixXd space_, projected_, rest_;
  Eigen::Index size_ = 0, complete_ = 0;
};

void fix_signs(Eigen::MatrixXd& vectors) {
  for (Eigen::Index j = 0; j < vectors.cols(); ++j) {
    const double largest = vectors.col(j).cwiseAbs().maxCoeff();
    Eigen::Index at = 0;
    while (std::abs(vectors(at, j)) < (1 - 1e-6) * largest) ++at;
    if (vectors(at, j) < 0) vectors.col(j) *= -1;
  }
}

/// All eigenvectors of a small mesh at once.
Eigenbasis dense_eigenbasis(const SurfaceOperators& operators, Eigen::Index wanted) {
  const Eigen::VectorXd scale = operators.mass.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd symmetric = scale.asDiagonal() * Eigen::MatrixXd(operators.stiffness) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solution(symmetric);
  Eigenbasis basis;
  basis.values = solution.eigenvalues().head(wanted).cwiseMax(0.0);
  basis.vectors = scale.asDiagonal() * solution.eigenvectors().leftCols(wanted);
  fix_signs(basis.vectors);
  return basis;
}

}  // namespace

Eigenbasis eigenbasis(const SurfaceOperators& operators, int k) {
  const Eigen::Index n = operators.mass.size(), wanted = k;
  if (k < 1) throw UsageError("An eigenbasis has at least one function.");
  if (2 * wanted + 2 * width > n) throw InputError("The mesh has too few vertices for so many eigenfunctions.");
  // A Krylov space that soon is all there is converges to nothing better.
  if (n <= std::max<Eigen::Index>(320, 4 * wanted)) return dense_eigenbasis(operators, wanted);
  constexpr double shift = -0.1;  // beside eigenvalues near 1, 2, 3, ...
  constexpr double tolerance = 1e-6;
  const InverseOperator op(operators, shift);
  const Eigen::Index most = std::min(n / width * width, 8 * wanted + 20 * width);
  KrylovSpace krylov(op, n, most);
  Eigen::Index next_look = 5 * wanted / 2 + 6 * width;
  for (;;) {
    krylov.extend();
    const bool last = krylov.complete() + width > most;
    if (krylov.complete() < next_look && !last) continue;
    const auto solution = krylov.solve();
    const Eigen::Index size = krylov.complete();
    // How far a Ritz vector is from being an eigenvector: its share in the newest block times what leads out of it.
    const Eigen::MatrixXd leaving = krylov.rest() * solution.eigenvectors().bottomRows(width).rightCols(wanted);
    const Eigen::VectorXd theta = solution.eigenvalues().tail(wanted);
    const bool good = (leaving.colwise().norm().transpose().array() <= tolerance * theta.array()).all();
    if (!good && !last) {
      next_look = size + std::max(width, wanted / 8);
      continue;
    }
    if (!good) throw InputError("The mesh is too degenerate: the eigenfunctions of its surface were not found.");
    Eigenbasis basis;
    basis.values = (theta.cwiseInverse().array() + shift).max(0.0).matrix().reverse();
    basis.vectors = krylov.basis().leftCols(size) * solution.eigenvectors().rightCols(wanted).rowwise().reverse();
    basis.vectors = operators.mass.cwiseSqrt().cwiseInverse().asDiagonal() * basis.vectors;
    fix_signs(basis.vectors);
    return basis;
  }
}

Eigen::MatrixXd heat_kernel_signatures(const Eigenbasis& basis, const Eigen::VectorXd& times) {
  const Eigen::MatrixXd decay = (-basis.values * times.transpose()).array().exp();
  return basis.vectors.cwiseAbs2() * decay;
}

}  // namespace rhizodont
