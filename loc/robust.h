// SPDX-License-Identifier: Apache-2.0
// The one robust loss of localization: Geman-McClure (Barron 2019, "A General and Adaptive Robust Loss Function",
// alpha = -2). Quadratic near zero, it saturates: what is no line costs `robust_limit` and pulls at nothing.
#pragma once

namespace touchline {

/// Nats that a complete outlier costs: a twentieth of the probability of a perfect match.
inline constexpr float robust_limit = 3.0F;

/// 0 for z = 0, z^2 / 2 for small z, tends to robust_limit. `z2` is the squared normalised residual.
constexpr float robust_cost(float z2) { return 0.5F * z2 / (1.0F + z2 * (0.5F / robust_limit)); }

/// Weight of the residual in iteratively re-weighted least squares: 1 for z = 0, tends to 0.
constexpr float robust_weight(float z2) {
  const float s = 1.0F / (1.0F + z2 * (0.5F / robust_limit));
  return s * s;
}

}  // namespace touchline
