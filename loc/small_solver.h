// SPDX-License-Identifier: Apache-2.0
// Normal equations of a few unknowns, solved on fixed-size matrices: no heap, sums in a fixed order.
#pragma once

#include "loc/pose_estimate.h"

namespace touchline {

inline constexpr int pose_unknowns = 5;  // x, y, theta, pitch error, roll error
using PoseVector = float[pose_unknowns];

/// J^T W J and J^T W r of a weighted least-squares problem.
class NormalEquations {
 public:
  /// Sums over measurements: the lower triangle of J^T W J row by row, and J^T W r.
  void add_sums(const float (&lower)[pose_unknowns * (pose_unknowns + 1) / 2], const PoseVector& gradient) {
    int at = 0;
    for (int a = 0; a < pose_unknowns; ++a) {
      gradient_[a] += gradient[a];
      for (int b = 0; b <= a; ++b) hessian_[a][b] += lower[at++];
    }
  }
  /// A measurement of one unknown.
  void add_single(int index, float residual, float weight) {
    gradient_[index] += weight * residual;
    hessian_[index][index] += weight;
  }
  /// A Gaussian on the first three unknowns, error `e`.
  void add_block3(const PoseCovariance& information, const float (&e)[3]);
  /// False when the system is singular; `step` is then unchanged. The unknowns become x - step.
  bool solve(PoseVector& step) const;
  /// Covariance of the first three unknowns, the others marginalised; false when singular.
  bool pose_covariance(PoseCovariance& out) const;

 private:
  float hessian_[pose_unknowns][pose_unknowns] = {};  // lower triangle
  float gradient_[pose_unknowns] = {};
};

/// Inverse of a symmetric positive definite 3x3 matrix; false when it is not one.
bool invert(const PoseCovariance& in, PoseCovariance& out);

}  // namespace touchline
