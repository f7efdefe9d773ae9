// SPDX-License-Identifier: Apache-2.0
// From the bytes of the serial line to single gait frames. The format is described in hal/firmware/touchline_gait.h,
// which is the sending side; COBS is Cheshire and Baker 1999. Bytes in, frames out: no port, no clock, no memory of the
// past.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/gait_link.h"
#include "platform/core/result.h"

namespace touchline {

inline constexpr std::size_t gait_payload_bytes = 38;
inline constexpr std::size_t gait_stuffed_bytes = 1 + gait_payload_bytes + 4;  // COBS code, payload, CRC-32

/// One frame as sent: the sample but for its time, which is still the controller's.
struct GaitFrame {
  GaitSample sample;          // `time` is not set
  std::uint32_t time_us = 0;  // of the controller's clock; wraps after 71 minutes
};

/// `stuffed` is one frame without its closing zero byte.
/// corrupt: length, stuffing, CRC-32 or a field is wrong. unsupported: a valid frame of another version.
[[nodiscard]] Result<GaitFrame> decode_gait_frame(std::span<const std::uint8_t> stuffed);

/// Cuts the stream at the zero bytes. A frame that is too long is dropped as a whole.
class GaitDecoder {
 public:
  /// not_ready: the frame goes on. ok: it ended and is good. corrupt, unsupported: it ended and is not, or it is longer
  /// than any frame (said once each `overlong` bytes). The rest of a frame before the first zero byte is not reported,
  /// since a port is usually opened in the middle of one.
  Result<GaitFrame> push(std::uint8_t byte);
  /// Forgets a frame that has begun; after the port was opened anew.
  void reset();

 private:
  std::array<std::uint8_t, gait_stuffed_bytes> bytes_{};
  /// Bytes without a zero, as of a wrong baud rate: never less than two frames whose zero was lost.
  static constexpr std::size_t overlong = 4 * gait_stuffed_bytes;

  std::size_t size_ = 0;       // of the frame so far, up to `overlong`
  bool synchronised_ = false;  // a zero byte has been seen
};

}  // namespace touchline
