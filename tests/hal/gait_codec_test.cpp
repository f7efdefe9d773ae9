// SPDX-License-Identifier: Apache-2.0
// Frames made by the firmware's C header against our decoder: every field, every truncation, every wrong byte.
#include "hal/gait_codec.h"

#include <doctest/doctest.h>

#include <limits>
#include <vector>

#include "platform/core/rng.h"
#include "tests/hal/gait_header.h"

namespace touchline {
namespace {

using Frame = std::array<std::uint8_t, TOUCHLINE_GAIT_FRAME_BYTES>;

touchline_gait example() {
  touchline_gait gait{};
  gait.flags = TOUCHLINE_GAIT_WALKING | TOUCHLINE_GAIT_HAS_CAMERA | TOUCHLINE_GAIT_HAS_HEAD;
  gait.support_foot = TOUCHLINE_GAIT_FOOT_LEFT;
  gait.boot_id = 0xA1B2C3D4U;
  gait.sequence = 258;
  gait.time_us = 1000000;
  gait.x_m = 1.2345F;
  gait.y_m = -0.5F;
  gait.theta_rad = 7.0F;
  gait.camera_height_m = 0.58F;
  gait.camera_pitch_rad = 0.5236F;
  gait.camera_roll_rad = -0.01F;
  gait.head_pan_rad = 1.0F;
  gait.head_tilt_rad = -0.25F;
  return gait;
}

Frame encode(const touchline_gait& gait) {
  Frame frame{};
  REQUIRE(encode_gait_in_c(&gait, frame.data()) == frame.size());
  return frame;
}

std::span<const std::uint8_t> without_zero(const Frame& frame) { return std::span(frame).first(frame.size() - 1); }

TEST_CASE("golden frame: the bytes on the wire do not change") {
  // made with Python's struct and zlib
  const Frame expected{0x04, 0x01, 0x31, 0x01, 0x07, 0xD4, 0xC3, 0xB2, 0xA1, 0x02, 0x01, 0x01, 0x04, 0x40, 0x42,
                       0x0F, 0x03, 0x39, 0x30, 0x01, 0x08, 0x78, 0xEC, 0xFF, 0xFF, 0x60, 0xAE, 0x0A, 0x0F, 0xA8,
                       0x16, 0x74, 0x14, 0x9C, 0xFF, 0x10, 0x27, 0x3C, 0xF6, 0x23, 0x5B, 0xAE, 0x0D, 0x00};
  const Frame frame = encode(example());
  for (std::size_t i = 0; i < frame.size(); ++i) CHECK(int{frame[i]} == int{expected[i]});
  CHECK(frame.back() == 0);
  for (const std::uint8_t byte : without_zero(frame)) CHECK(byte != 0);
}

TEST_CASE("what the C header sends is what we read") {
  const auto result = decode_gait_frame(without_zero(encode(example())));
  REQUIRE(result.ok());
  const GaitSample& sample = result.value().sample;
  CHECK(result.value().time_us == 1000000);
  CHECK(sample.boot_id == 0xA1B2C3D4U);
  CHECK(sample.sequence == 258);
  CHECK(sample.odometry.x == doctest::Approx(1.2345F));
  CHECK(sample.odometry.y == doctest::Approx(-0.5F));
  CHECK(sample.odometry.theta == doctest::Approx(7.0F));
  CHECK(sample.has_camera_attitude);
  CHECK(sample.camera_height == doctest::Approx(0.58F));
  CHECK(sample.camera_pitch == doctest::Approx(0.5236F));
  CHECK(sample.camera_roll == doctest::Approx(-0.01F));
  CHECK(sample.has_head);
  CHECK(sample.head_pan == doctest::Approx(1.0F));
  CHECK(sample.head_tilt == doctest::Approx(-0.25F));
  CHECK(sample.support == SupportFoot::left);
  CHECK(sample.walking);
  CHECK_FALSE(sample.standing);
  CHECK_FALSE(sample.fallen);
  CHECK_FALSE(sample.lifted);
}

TEST_CASE("each flag arrives alone") {
  for (std::uint8_t bit = 0; bit < 6; ++bit) {
    touchline_gait gait = example();
    gait.flags = static_cast<std::uint8_t>(1U << bit);
    const GaitSample sample = decode_gait_frame(without_zero(encode(gait))).value().sample;
    CHECK(sample.walking == (bit == 0));
    CHECK(sample.standing == (bit == 1));
    CHECK(sample.fallen == (bit == 2));
    CHECK(sample.lifted == (bit == 3));
    CHECK(sample.has_camera_attitude == (bit == 4));
    CHECK(sample.has_head == (bit == 5));
  }
}

TEST_CASE("numbers that do not fit are sent as the nearest that does, NaN as 0") {
  touchline_gait gait = example();
  gait.flags = 0;
  gait.x_m = 1e9F;
  gait.y_m = -1e9F;
  gait.theta_rad = std::numeric_limits<float>::quiet_NaN();
  gait.camera_height_m = 99.0F;
  const auto result = decode_gait_frame(without_zero(encode(gait)));
  REQUIRE(result.ok());
  CHECK(result.value().sample.odometry.x == doctest::Approx(214748.3647));
  CHECK(result.value().sample.odometry.y == doctest::Approx(-214748.3648));
  CHECK(result.value().sample.odometry.theta == 0.0F);
  CHECK(result.value().sample.camera_height == doctest::Approx(6.5535F));
}

TEST_CASE("fields that no controller can mean are corrupt although the CRC is right") {
  touchline_gait gait = example();
  gait.camera_pitch_rad = 3.2F;
  CHECK(decode_gait_frame(without_zero(encode(gait))).status() == Status::corrupt);
  gait = example();
  gait.camera_height_m = 0.0F;
  CHECK(decode_gait_frame(without_zero(encode(gait))).status() == Status::corrupt);
  gait.flags = 0;  // without the flag the height is void
  CHECK(decode_gait_frame(without_zero(encode(gait))).ok());
}

TEST_CASE("every truncation and every extension of a frame is refused") {
  const Frame frame = encode(example());
  for (std::size_t size = 0; size < frame.size() - 1; ++size) {
    CHECK(decode_gait_frame(std::span(frame).first(size)).status() == Status::corrupt);
  }
  CHECK(decode_gait_frame(frame).status() == Status::corrupt);  // one byte too many
}

TEST_CASE("every single wrong byte is refused") {
  const Frame good = encode(example());
  int accepted = 0;
  for (std::size_t i = 0; i + 1 < good.size(); ++i) {
    for (int value = 0; value < 256; ++value) {
      Frame bad = good;
      bad[i] = static_cast<std::uint8_t>(value);
      accepted += bad != good && decode_gait_frame(without_zero(bad)).ok() ? 1 : 0;
    }
  }
  CHECK(accepted == 0);
}

TEST_CASE("random payloads of zeros, ones and anything survive the stuffing") {
  Rng rng(7);
  for (int round = 0; round < 2000; ++round) {
    touchline_gait gait{};
    const auto word = [&] { return rng.below(3) == 0 ? 0U : rng.next_u32(); };
    gait.boot_id = word();
    gait.sequence = word();
    gait.time_us = word();
    gait.x_m = rng.uniform(-100.0F, 100.0F);
    const auto result = decode_gait_frame(without_zero(encode(gait)));
    REQUIRE(result.ok());
    CHECK(result.value().sample.boot_id == gait.boot_id);
    CHECK(result.value().sample.sequence == gait.sequence);
    CHECK(result.value().time_us == gait.time_us);
  }
}

Status last_status(GaitDecoder& decoder, std::span<const std::uint8_t> bytes) {
  Status status = Status::not_ready;
  for (const std::uint8_t byte : bytes) status = decoder.push(byte).status();
  return status;
}

TEST_CASE("bytes without a zero are told to be no frames, before the first zero byte, too") {
  GaitDecoder decoder;
  int corrupt = 0;
  for (int i = 0; i < 100000; ++i) corrupt += decoder.push(0x55).status() == Status::corrupt ? 1 : 0;
  CHECK(corrupt > 100);
  CHECK(corrupt < 2000);
  CHECK(decoder.push(0).status() == Status::not_ready);
  GaitDecoder in_the_middle;
  for (int i = 0; i < 43; ++i) CHECK(in_the_middle.push(0x55).status() == Status::not_ready);
  CHECK(in_the_middle.push(0).status() == Status::not_ready);
}

TEST_CASE("the decoder finds the next frame after noise, a cut frame and one that is too long") {
  const Frame frame = encode(example());
  GaitDecoder decoder;
  CHECK(last_status(decoder, std::span(frame).last(10)) == Status::not_ready);  // opened in the middle of a frame
  CHECK(last_status(decoder, frame) == Status::ok);

  CHECK(last_status(decoder, std::span(frame).first(20)) == Status::not_ready);
  CHECK(last_status(decoder, frame) == Status::corrupt);  // the cut one and this are one heap of bytes
  CHECK(last_status(decoder, frame) == Status::ok);

  const std::vector<std::uint8_t> noise(100000, 0x55);
  CHECK(last_status(decoder, noise) == Status::not_ready);
  const std::array<std::uint8_t, 2> zeros{};
  CHECK(last_status(decoder, std::span(zeros).first(1)) == Status::corrupt);
  CHECK(last_status(decoder, zeros) == Status::not_ready);  // empty frames are nothing
  CHECK(last_status(decoder, frame) == Status::ok);
}

TEST_CASE("a decoder that starts on a whole frame uses it") {
  GaitDecoder decoder;
  CHECK(last_status(decoder, encode(example())) == Status::ok);
  decoder.reset();
  CHECK(last_status(decoder, encode(example())) == Status::ok);
}

}  // namespace
}  // namespace touchline
