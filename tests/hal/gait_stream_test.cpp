// SPDX-License-Identifier: Apache-2.0
// Lost, doubled, reordered and corrupt gait frames, restarts of the controller, and its clock.
#include "hal/gait_stream.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>

#include "platform/core/rng.h"
#include "tests/hal/gait_header.h"

namespace touchline {
namespace {

struct Sent {
  std::uint32_t sequence = 0;
  std::uint32_t boot = 1;
  std::uint32_t time_us = 0;
  float x = 0.0F;
};

std::array<std::uint8_t, TOUCHLINE_GAIT_FRAME_BYTES> encode(const Sent& sent) {
  touchline_gait gait{};
  gait.boot_id = sent.boot;
  gait.sequence = sent.sequence;
  gait.time_us = sent.time_us;
  gait.x_m = sent.x;
  std::array<std::uint8_t, TOUCHLINE_GAIT_FRAME_BYTES> frame{};
  encode_gait_in_c(&gait, frame.data());
  return frame;
}

Result<GaitSample> send(GaitStream& stream, const Sent& sent, MonotonicNs arrival = 0) {
  Result<GaitSample> result = Status::not_ready;
  for (const std::uint8_t byte : encode(sent)) result = stream.push(byte, arrival);
  return result;
}

TEST_CASE("lost frames are counted, doubled and reordered ones are not used") {
  GaitStream stream;
  CHECK(send(stream, {10}).ok());
  CHECK(send(stream, {14}).ok());
  CHECK(stream.counts().lost == 3);
  CHECK(send(stream, {14}).status() == Status::stale);
  CHECK(send(stream, {12}).status() == Status::stale);
  CHECK(send(stream, {15}).ok());
  CHECK(stream.counts().stale == 2);
  CHECK(stream.counts().received == 3);
  CHECK(stream.counts().restarts == 0);
}

TEST_CASE("the sequence may wrap") {
  GaitStream stream;
  CHECK(send(stream, {0xFFFFFFFFU}).ok());
  CHECK(send(stream, {0}).ok());
  CHECK(stream.counts().lost == 0);
}

TEST_CASE("a restart shows by the boot id, or by a sequence far back when the id is the same") {
  GaitStream stream;
  CHECK(send(stream, {1000, 1}).ok());
  CHECK(send(stream, {0, 2}).ok());
  CHECK(stream.counts().restarts == 1);
  CHECK(send(stream, {1001, 1}).status() == Status::stale);  // a straggler of the boot before
  CHECK(send(stream, {1, 2}).ok());
  CHECK(send(stream, {1000, 2}).ok());
  CHECK(send(stream, {0, 2}).ok());
  CHECK(stream.counts().restarts == 2);
}

TEST_CASE("a controller that takes its old boot id again is believed after eight frames") {
  GaitStream stream;
  CHECK(send(stream, {50, 1}).ok());
  CHECK(send(stream, {0, 2}).ok());
  for (std::uint32_t i = 0; i < 7; ++i) CHECK(send(stream, {i, 1}).status() == Status::stale);
  CHECK(send(stream, {7, 1}).ok());
  CHECK(send(stream, {8, 1}).ok());
}

TEST_CASE("late frames do not shift the controller's time, and it follows a drifting quartz") {
  GaitStream stream(4 * one_millisecond);
  Rng rng(3);
  const double rate = 1.0001;  // the controller's quartz is 100 ppm fast
  MonotonicNs worst = 0;
  MonotonicNs before = 0;
  for (std::uint32_t i = 0; i < 6000; ++i) {
    const MonotonicNs truth = one_second + MonotonicNs{i} * 10 * one_millisecond;
    const auto controller_us = static_cast<std::uint32_t>(4.2e9 + i * 10000.0 * rate);  // wraps on the way
    const auto delay = rng.below(4) == 0 ? MonotonicNs{rng.below(9'000'000)} : 0;
    const auto sample = send(stream, {i, 1, controller_us}, truth + 4 * one_millisecond + delay);
    REQUIRE(sample.ok());
    if (i > 100) worst = std::max(worst, std::abs(sample.value().time - truth));
    CHECK(sample.value().time >= before);
    before = sample.value().time;
  }
  CHECK(worst < one_millisecond / 4);
}

TEST_CASE("a controller that was held in a debugger gets a new time after a while") {
  GaitStream stream;
  CHECK(send(stream, {1, 1, 1000}, one_second).ok());
  MonotonicNs now = 10 * one_second;
  Result<GaitSample> sample = Status::not_ready;
  for (std::uint32_t i = 2; i < 160; ++i, now += 10 * one_millisecond) sample = send(stream, {i, 1, i * 10000}, now);
  REQUIRE(sample.ok());
  CHECK(now - 10 * one_millisecond - sample.value().time < one_millisecond);
}

TEST_CASE("frames that waited while this program was busy keep their times, however long that was") {
  GaitStream stream;
  for (std::uint32_t i = 0; i < 100; ++i)
    CHECK(send(stream, {i, 1, i * 10000}, one_second + i * 10 * one_millisecond).ok());
  const MonotonicNs late = one_second + 190 * 10 * one_millisecond + one_second;
  MonotonicNs before = 0;
  for (std::uint32_t i = 100; i < 190; ++i) {  // all read at once
    const auto sample = send(stream, {i, 1, i * 10000}, late);
    REQUIRE(sample.ok());
    CHECK(std::abs(sample.value().time - (one_second + i * 10 * one_millisecond)) < one_millisecond);
    CHECK(sample.value().time > before);
    before = sample.value().time;
  }
}

TEST_CASE("times grow even where all of a first burst came at once") {
  GaitStream stream;
  MonotonicNs before = 0;
  for (std::uint32_t i = 0; i < 50; ++i) {
    const auto sample = send(stream, {i, 1, i * 10000}, one_second);
    REQUIRE(sample.ok());
    CHECK(sample.value().time > before);
    before = sample.value().time;
  }
}

TEST_CASE("one byte in fifty wrong for 60 s: not one false frame is used") {
  GaitStream stream;
  Rng rng(11);
  std::uint32_t good = 0;
  for (std::uint32_t i = 0; i < 6000; ++i) {
    const float x = static_cast<float>(i % 1000) * 0.01F;
    for (std::uint8_t byte : encode({i, 77, i * 10000, x})) {
      if (rng.below(50) == 0) byte = static_cast<std::uint8_t>(byte ^ (1 + rng.below(255)));
      const auto result = stream.push(byte, MonotonicNs{i} * 10 * one_millisecond);
      if (!result.ok()) continue;
      ++good;
      CHECK(result.value().sequence <= i);
      CHECK(result.value().odometry.x == doctest::Approx(static_cast<float>(result.value().sequence % 1000) * 0.01F));
      CHECK(result.value().boot_id == 77);
    }
  }
  CHECK(good > 1500);  // (49/50)^44 = 41 % of the frames come whole
  CHECK(good < 3500);
  CHECK(stream.counts().corrupt > 2000);
  CHECK(stream.counts().restarts == 0);
}

}  // namespace
}  // namespace touchline
