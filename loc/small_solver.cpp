// SPDX-License-Identifier: Apache-2.0
// Cholesky's decomposition of a handful of unknowns on Eigen's fixed-size matrices. Eigen's own LLT and LDLT bring
// their blocked paths along, which allocate, for matrices that are never that large; so the decomposition stands here
// (Golub and Van Loan, "Matrix Computations", algorithm 4.2.1), and every sum has its order.
#include "loc/small_solver.h"

#include <Eigen/Core>

#include "platform/core/elementary.h"

namespace touchline {
namespace {

/// Lower factor in place of the lower triangle; false when the matrix is not positive definite (NaN included).
template <int N>
bool factorise(Eigen::Matrix<float, N, N>& m) {
  for (int j = 0; j < N; ++j) {
    for (int i = j; i < N; ++i) {
      float sum = m(i, j);
      for (int k = 0; k < j; ++k) sum -= m(i, k) * m(j, k);
      if (i == j) {
        if (!(sum > 1e-12F)) return false;
        m(j, j) = math::sqrt(sum);
      } else {
        m(i, j) = sum / m(j, j);
      }
    }
  }
  return true;
}

/// Solves L L^T x = b in place of b.
template <int N>
void substitute(const Eigen::Matrix<float, N, N>& l, Eigen::Matrix<float, N, 1>& b) {
  for (int i = 0; i < N; ++i) {
    for (int k = 0; k < i; ++k) b(i) -= l(i, k) * b(k);
    b(i) /= l(i, i);
  }
  for (int i = N - 1; i >= 0; --i) {
    for (int k = i + 1; k < N; ++k) b(i) -= l(k, i) * b(k);
    b(i) /= l(i, i);
  }
}

/// Column `c` of the inverse.
template <int N>
Eigen::Matrix<float, N, 1> inverse_column(const Eigen::Matrix<float, N, N>& l, int c) {
  Eigen::Matrix<float, N, 1> b;
  for (int i = 0; i < N; ++i) b(i) = i == c ? 1.0F : 0.0F;
  substitute<N>(l, b);
  return b;
}

template <int N>
PoseCovariance leading_inverse(const Eigen::Matrix<float, N, N>& l) {
  const Eigen::Matrix<float, N, 1> x = inverse_column<N>(l, 0);
  const Eigen::Matrix<float, N, 1> y = inverse_column<N>(l, 1);
  const Eigen::Matrix<float, N, 1> t = inverse_column<N>(l, 2);
  return {x(0), x(1), y(1), x(2), y(2), t(2)};
}

using Matrix5 = Eigen::Matrix<float, pose_unknowns, pose_unknowns>;
Matrix5 to_matrix(const float (&lower)[pose_unknowns][pose_unknowns]) {
  Matrix5 m;
  for (int a = 0; a < pose_unknowns; ++a) {
    for (int b = 0; b < pose_unknowns; ++b) m(a, b) = b <= a ? lower[a][b] : 0.0F;
  }
  return m;
}

}  // namespace

void NormalEquations::add_block3(const PoseCovariance& i, const float (&e)[3]) {
  hessian_[0][0] += i.xx;
  hessian_[1][0] += i.xy;
  hessian_[1][1] += i.yy;
  hessian_[2][0] += i.xt;
  hessian_[2][1] += i.yt;
  hessian_[2][2] += i.tt;
  gradient_[0] += i.xx * e[0] + i.xy * e[1] + i.xt * e[2];
  gradient_[1] += i.xy * e[0] + i.yy * e[1] + i.yt * e[2];
  gradient_[2] += i.xt * e[0] + i.yt * e[1] + i.tt * e[2];
}

bool NormalEquations::solve(PoseVector& step) const {
  Matrix5 m = to_matrix(hessian_);
  if (!factorise<pose_unknowns>(m)) return false;
  Eigen::Matrix<float, pose_unknowns, 1> b;
  for (int a = 0; a < pose_unknowns; ++a) b(a) = gradient_[a];
  substitute<pose_unknowns>(m, b);
  for (int a = 0; a < pose_unknowns; ++a) {
    if (!(b(a) < 1e6F && b(a) > -1e6F)) return false;  // also NaN
  }
  for (int a = 0; a < pose_unknowns; ++a) step[a] = b(a);
  return true;
}

bool NormalEquations::pose_covariance(PoseCovariance& out) const {
  Matrix5 m = to_matrix(hessian_);
  if (!factorise<pose_unknowns>(m)) return false;
  out = leading_inverse<pose_unknowns>(m);
  return true;
}

bool invert(const PoseCovariance& in, PoseCovariance& out) {
  Eigen::Matrix<float, 3, 3> m;
  m << in.xx, 0.0F, 0.0F, in.xy, in.yy, 0.0F, in.xt, in.yt, in.tt;
  if (!factorise<3>(m)) return false;
  out = leading_inverse<3>(m);
  return true;
}

}  // namespace touchline
