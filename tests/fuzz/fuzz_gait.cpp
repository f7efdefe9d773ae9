// SPDX-License-Identifier: Apache-2.0
// Any bytes on the gait's serial line: no crash, and what is let through is finite and in range.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "hal/gait_stream.h"
#include "hal/odometry_history.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace touchline;
  GaitStream stream;
  OdometryHistory odometry;
  MonotonicNs now = one_second;
  for (std::size_t i = 0; i < size; ++i) {
    now += 87'000;  // 115200 baud
    const auto sample = stream.push(data[i], now);
    if (!sample.ok()) continue;
    const GaitSample& gait = sample.value();
    if (gait.time > now || math::abs(gait.camera_pitch) > 3.15F || static_cast<int>(gait.support) > 3) std::abort();
    if (odometry.push(gait) == Status::ok && !(math::abs(odometry.newest().x) < 1e9F)) std::abort();
  }
  return 0;
}
