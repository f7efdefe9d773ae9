// SPDX-License-Identifier: Apache-2.0
// Any bytes on the gait's serial line, and whole frames of any content, which random bytes never are for their check:
// no crash, and what is let through is finite and in range.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include "hal/gait_stream.h"
#include "hal/odometry_history.h"
#include "tests/hal/gait_header.h"

namespace {

using namespace touchline;

class Line {
 public:
  void push(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) {
      now_ += 87'000;  // 115200 baud
      const auto sample = stream_.push(byte, now_);
      if (!sample.ok()) continue;
      const GaitSample& gait = sample.value();
      if (gait.time > now_ || math::abs(gait.camera_pitch) > 3.15F || static_cast<int>(gait.support) > 3) std::abort();
      if (odometry_.push(gait) == Status::ok && !(math::abs(odometry_.newest().x) < 1e9F)) std::abort();
    }
  }

 private:
  GaitStream stream_;
  OdometryHistory odometry_;
  MonotonicNs now_ = one_second;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Line raw;
  raw.push({data, size});
  Line whole;
  for (; size >= sizeof(touchline_gait); data += sizeof(touchline_gait), size -= sizeof(touchline_gait)) {
    touchline_gait gait;
    std::memcpy(&gait, data, sizeof gait);
    std::uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
    encode_gait_in_c(&gait, frame);
    whole.push(frame);
  }
  return 0;
}
