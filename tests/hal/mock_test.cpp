// SPDX-License-Identifier: Apache-2.0
// The mocks keep the contracts that the interfaces state; tests of everything above rest on that.
#include <doctest/doctest.h>

#include "hal/mock/mock_camera.h"
#include "hal/mock/mock_panel.h"
#include "hal/mock/mock_reader.h"

namespace touchline {
namespace {

TEST_CASE("a scripted camera lends what the script says, and only while it is open") {
  ManualClock clock;
  ScriptedCamera camera(clock, 2);
  CHECK(camera.acquire(0).status() == Status::disconnected);

  REQUIRE(camera.open() == Status::ok);
  const MonotonicNs start = clock.now();
  camera.frames.add(camera.make_frame(4, 2, 7, start + one_millisecond, 1));
  camera.frames.add(camera.make_frame(4, 2, 8, start + 2 * one_millisecond, 2));
  const auto first = camera.acquire(start + one_second);
  const auto second = camera.acquire(start + one_second);
  REQUIRE(first.ok());
  REQUIRE(second.ok());
  CHECK(first.value().image.data[0] == 7);
  CHECK(second.value().sequence == 2);
  CHECK(clock.now() == start + 2 * one_millisecond);

  CHECK(camera.acquire(start + one_second).status() == Status::capacity);
  CHECK(camera.release(first.value()) == Status::ok);
  CHECK(camera.release(first.value()) == Status::invalid_argument);
  CHECK(camera.acquire(start + one_second).status() == Status::timeout);
  CHECK(clock.now() == start + one_second);
  CHECK(camera.health().received == 2);
}

TEST_CASE("a camera that is unplugged stays away until it is opened again") {
  ManualClock clock;
  ScriptedCamera camera(clock);
  camera.opens.add(Status::disconnected);
  CHECK(camera.open() == Status::disconnected);
  CHECK(camera.open() == Status::ok);
  camera.frames.add(Status::disconnected);
  camera.frames.add(camera.make_frame(4, 2, 7, clock.now(), 1));
  CHECK(camera.acquire(0).status() == Status::disconnected);
  CHECK(camera.acquire(0).status() == Status::disconnected);
  CHECK_FALSE(camera.health().open);
  CHECK(camera.open() == Status::ok);
  CHECK(camera.acquire(0).ok());
  CHECK(camera.health().opened == 2);
  CHECK(camera.health().last_error == Status::disconnected);
}

TEST_CASE("a recording camera writes down every call and its answer") {
  ManualClock clock;
  ScriptedCamera inner(clock);
  RecordingCamera camera(inner);
  CHECK(camera.open() == Status::ok);
  CHECK_FALSE(camera.acquire(0).ok());
  camera.close();
  REQUIRE(camera.log.calls().size() == 3);
  CHECK(camera.log.calls()[1].name == "acquire");
  CHECK(camera.log.calls()[1].answer == Status::timeout);
  CHECK(camera.log.count("close") == 1);
}

TEST_CASE("scripted readers return samples in order, then that nothing is new") {
  ScriptedImu imu;
  CHECK(imu.read().status() == Status::disconnected);
  REQUIRE(imu.open() == Status::ok);
  ImuSample sample;
  sample.yaw = 1.5F;
  imu.samples.add(sample);
  imu.samples.add(Status::disconnected);
  RecordingImu recording(imu);
  CHECK(recording.read().value().yaw == 1.5F);
  CHECK(recording.read().status() == Status::disconnected);
  CHECK(recording.log.count("read") == 2);
  CHECK_FALSE(imu.health().open);

  ScriptedGaitLink gait;
  REQUIRE(gait.open() == Status::ok);
  GaitSample step;
  step.sequence = 9;
  gait.samples.add(step);
  CHECK(gait.read().value().sequence == 9);
  CHECK(gait.read().status() == Status::not_ready);
  CHECK(gait.health().last_error == Status::ok);
}

TEST_CASE("the mock panel is pressed by the script and remembers each change of its light") {
  MockPanel panel;
  CHECK(panel.poll(0).status() == Status::disconnected);
  REQUIRE(panel.open() == Status::ok);
  panel.presses.add({5, ButtonPress::long_press});
  CHECK(panel.poll(5).value().press == ButtonPress::long_press);
  CHECK(panel.poll(6).status() == Status::not_ready);
  panel.show(LedPattern::sure);
  panel.show(LedPattern::sure);
  panel.show(LedPattern::fault);
  CHECK(panel.shown == std::vector<LedPattern>{LedPattern::sure, LedPattern::fault});
}

}  // namespace
}  // namespace touchline
