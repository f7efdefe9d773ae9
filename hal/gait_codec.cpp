// SPDX-License-Identifier: Apache-2.0
// Decoding of gait frames; see hal/firmware/touchline_gait.h for the format.
#include "hal/gait_codec.h"

#include "hal/byte_reader.h"
#include "hal/crc32.h"

namespace touchline {
namespace {

using Bytes = std::span<const std::uint8_t>;
using Unstuffed = std::array<std::uint8_t, gait_payload_bytes + 4>;

constexpr std::uint8_t version = 1;
constexpr std::uint8_t known_flags = 0x3F;

/// Undoes COBS. Each code byte tells how far the next zero is; the last one points just behind the frame.
bool unstuff(Bytes stuffed, Unstuffed& plain) {
  std::size_t next_zero = stuffed[0];
  if (next_zero == 0) return false;
  for (std::size_t i = 1; i < stuffed.size(); ++i) {
    if (stuffed[i] == 0) return false;
    const bool was_zero = i == next_zero;
    plain[i - 1] = was_zero ? std::uint8_t{0} : stuffed[i];
    if (was_zero) next_zero = i + stuffed[i];
  }
  return next_zero == stuffed.size();
}

/// A pitch, roll or pan beyond this is no angle of a camera; 16 bits would hold a little more than pi.
constexpr std::int32_t max_angle = 31416;  // 1e-4 rad
bool is_angle(std::int32_t value) { return value >= -max_angle && value <= max_angle; }

bool angles_are_valid(Bytes payload) {
  for (const std::size_t offset : {std::size_t{30}, std::size_t{32}, std::size_t{34}, std::size_t{36}}) {
    if (!is_angle(read_i16(payload, offset))) return false;
  }
  return true;
}

GaitFrame parse(Bytes payload) {
  const auto angle = [&](std::size_t offset) { return static_cast<float>(read_i16(payload, offset)) * 1e-4F; };
  const auto wide = [&](std::size_t offset, float unit) {
    return static_cast<float>(read_i32(payload, offset)) * unit;
  };
  const auto flag = [&](int bit) { return ((payload[1] >> bit) & 1) != 0; };
  GaitFrame frame;
  GaitSample& sample = frame.sample;
  sample.walking = flag(0);
  sample.standing = flag(1);
  sample.fallen = flag(2);
  sample.lifted = flag(3);
  sample.has_camera_attitude = flag(4);
  sample.has_head = flag(5);
  sample.support = static_cast<SupportFoot>(payload[2]);
  sample.boot_id = read_unsigned(payload, 4, 4);
  sample.sequence = read_unsigned(payload, 8, 4);
  frame.time_us = read_unsigned(payload, 12, 4);
  sample.odometry = {wide(16, 1e-4F), wide(20, 1e-4F), wide(24, 1e-5F)};
  sample.camera_height = static_cast<float>(read_unsigned(payload, 28, 2)) * 1e-4F;
  sample.camera_pitch = angle(30);
  sample.camera_roll = angle(32);
  sample.head_pan = angle(34);
  sample.head_tilt = angle(36);
  return frame;
}

}  // namespace

Result<GaitFrame> decode_gait_frame(Bytes stuffed) {
  Unstuffed plain{};
  if (stuffed.size() != gait_stuffed_bytes || !unstuff(stuffed, plain)) return Status::corrupt;
  const Bytes payload = Bytes(plain).first(gait_payload_bytes);
  if (crc32(payload) != read_unsigned(plain, gait_payload_bytes, 4)) return Status::corrupt;
  if (payload[0] != version) return Status::unsupported;
  const bool valid =
      (payload[1] & ~known_flags) == 0 && payload[2] <= 3 && payload[3] == 0 && angles_are_valid(payload);
  if (!valid) return Status::corrupt;
  const bool has_camera = (payload[1] & 0x10) != 0;
  if (has_camera && read_unsigned(payload, 28, 2) == 0) return Status::corrupt;  // a camera in the carpet
  return parse(payload);
}

Result<GaitFrame> GaitDecoder::push(std::uint8_t byte) {
  if (byte != 0) {
    if (size_ < bytes_.size()) bytes_[size_] = byte;
    if (++size_ < overlong) return Status::not_ready;
    size_ = bytes_.size() + 1;
    return Status::corrupt;
  }
  const std::size_t size = size_;
  const bool was_synchronised = synchronised_;
  size_ = 0;
  synchronised_ = true;
  if (size == 0) return Status::not_ready;
  if (size > bytes_.size()) return was_synchronised ? Status::corrupt : Status::not_ready;
  const Result<GaitFrame> frame = decode_gait_frame(Bytes(bytes_).first(size));
  return frame.ok() || was_synchronised ? frame : Status::not_ready;
}

void GaitDecoder::reset() {
  size_ = 0;
  synchronised_ = false;
}

}  // namespace touchline
