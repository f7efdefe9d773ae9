// SPDX-License-Identifier: Apache-2.0
// The observation model of the paper, eq. (5):  P(p) ~ prod over l of exp(-||s_e - s_o|| / (2 sigma_l^2)),
// with s the landmark's displacement in the robot's frame, expected and observed (reading notes: the norm is not
// squared), sigma_l^2 the variance over the particles of their distance to landmark l, with a floor, and each exponent
// weighed by the feature's confidence c / c_max.
#pragma once

#include "loc/feature_manager.h"
#include "loc/particles.h"

namespace touchline {

/// Adds the log of eq. (5) to every particle's log weight. `cloud` is how many particles, from the first, make up the
/// cloud whose variance counts: those drawn at random in the frame before are spread over the whole field. `range_only`
/// compares distances in place of displacements: then the heading does not enter, and the field's mirror image in y
/// fits as well; kept as a variant to report.
void add_paper_likelihood(const Field& field, const FeatureManager& features, const FeatureManagerConfig& config,
                          float variance_floor, int cloud, bool range_only, ParticleView particles);

}  // namespace touchline
