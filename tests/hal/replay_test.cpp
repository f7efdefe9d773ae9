// SPDX-License-Identifier: Apache-2.0
// A data set played through the interfaces, at the pace of the clock.
#include "hal/replay/replay.h"

#include <doctest/doctest.h>

#include <fstream>

#include "hal/mock/manual_clock.h"
#include "platform/host/host_error.h"
#include "tests/host/temp_folder.h"

namespace touchline {
namespace {

const char* const dataset_toml = R"(name = "two"
protocol = "sequence"
field = "acyut-5x3"
[camera]
width = 32
height = 24
model = "equidistant"
focal_px = 10.0
cx = 16.0
cy = 12.0
max_theta_deg = 80.0
[mount]
height_m = 0.5
pitch_deg = 30.0
)";

void write_set(const std::filesystem::path& folder, const std::string& frames) {
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "dataset.toml") << dataset_toml;
  std::ofstream(folder / "frames.jsonl") << frames;
  host::RgbImage image(32, 24);
  for (int i = 0; i < 3; ++i) {
    for (auto& byte : image.rgb) byte = static_cast<std::uint8_t>(10 * i + 1);
    host::write_png(folder / (std::to_string(i) + ".png"), image);
  }
}

const char* const three_frames = R"({"image": "0.png", "t_s": 5.0, "imu_yaw_deg": 170}
{"image": "1.png", "t_s": 5.1, "imu_yaw_deg": -170, "odometry": {"dx_m": 0.1, "dy_m": 0.0, "dtheta_deg": 90}}
{"image": "2.png", "t_s": 5.3, "mount": {"pitch_deg": 40}, "odometry": {"dx_m": 0.1, "dy_m": 0.0, "dtheta_deg": 0}}
)";

TEST_CASE("frames, yaw and odometry come at their times") {
  host::TempFolder temp;
  write_set(temp.path(), three_frames);
  ManualClock clock;
  Replay replay(temp.path(), clock);
  CHECK(replay.camera().acquire(0).status() == Status::disconnected);
  REQUIRE(replay.camera().open() == Status::ok);
  REQUIRE(replay.imu().open() == Status::ok);
  REQUIRE(replay.gait().open() == Status::ok);
  CHECK(replay.imu().read().status() == Status::not_ready);
  CHECK(replay.camera().acquire(clock.now() + one_millisecond).status() == Status::timeout);

  const auto first = replay.camera().acquire(clock.now() + one_second);
  REQUIRE(first.ok());
  CHECK(first.value().image.data[0] == 1);
  CHECK(first.value().time == clock.now());
  CHECK(replay.imu().read().value().yaw == doctest::Approx(radians(170.0F)));
  CHECK(replay.imu().read().status() == Status::not_ready);
  CHECK(replay.gait().read().value().camera_pitch == doctest::Approx(radians(30.0F)));

  const auto second = replay.camera().acquire(clock.now() + one_second);
  CHECK(second.value().time - first.value().time == 100 * one_millisecond);
  CHECK(replay.imu().read().value().yaw == doctest::Approx(radians(190.0F)));
  CHECK(replay.gait().read().value().odometry.theta == doctest::Approx(math::half_pi));

  const auto third = replay.camera().acquire(clock.now() + one_second);
  CHECK(third.value().image.data[0] == 21);
  const GaitSample gait = replay.gait().read().value();
  CHECK(gait.odometry.x == doctest::Approx(0.1F));
  CHECK(gait.odometry.y == doctest::Approx(0.1F));
  CHECK(gait.camera_pitch == doctest::Approx(radians(40.0F)));
  CHECK(replay.camera().release(third.value()) == Status::ok);
  CHECK(replay.camera().acquire(clock.now() + one_second).status() == Status::end_of_data);
  CHECK(replay.imu().read().status() == Status::end_of_data);
  CHECK(replay.gait().read().status() == Status::end_of_data);
}

TEST_CASE("who is late gets the newest frame, and all odometry; loops go on with time and path") {
  host::TempFolder temp;
  write_set(temp.path(), three_frames);
  ManualClock clock;
  Replay replay(temp.path(), clock, {2});
  REQUIRE(replay.camera().open() == Status::ok);
  REQUIRE(replay.gait().open() == Status::ok);
  clock.advance(one_second);  // past the second loop's end
  const auto frame = replay.camera().acquire(clock.now());
  REQUIRE(frame.ok());
  CHECK(frame.value().sequence == 5);
  CHECK(frame.value().skipped == 5);
  GaitSample last;
  int samples = 0;
  for (auto sample = replay.gait().read(); sample.ok(); sample = replay.gait().read(), ++samples) last = sample.value();
  CHECK(samples == 6);
  CHECK(last.odometry.theta == doctest::Approx(math::pi));
  CHECK(replay.current().image == "2.png");
}

TEST_CASE("a set that cannot be played is refused by name") {
  host::TempFolder temp;
  ManualClock clock;
  write_set(temp.path(), "{\"image\": \"0.png\"}\n");
  CHECK_THROWS_AS(Replay(temp.path(), clock), host::HostError);
  write_set(temp.path(), "{\"image\": \"0.png\", \"t_s\": 1}\n{\"image\": \"1.png\", \"t_s\": 1}\n");
  CHECK_THROWS_AS(Replay(temp.path(), clock), host::HostError);
  write_set(temp.path(), three_frames);
  CHECK_THROWS_AS(Replay(temp.path(), clock, {1, 5000}), host::HostError);
}

}  // namespace
}  // namespace touchline
