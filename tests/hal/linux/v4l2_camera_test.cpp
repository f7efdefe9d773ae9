// SPDX-License-Identifier: Apache-2.0
// The camera backend against a fake of libv4l2: the good way, every error path, and every handle given back.
#include "hal/linux/v4l2_camera.h"

#include <doctest/doctest.h>
#include <linux/videodev2.h>

#include <string_view>

#include "hal/mock/manual_clock.h"
#include "tests/support/fake_v4l2.h"
#include "tests/support/heap_guard.h"

namespace touchline {
namespace {

struct Bench {
  Bench() { fake::reset_v4l2(); }
  ~Bench() { fake::reset_v4l2(); }
  fake::V4l2& device = fake::v4l2();
  ManualClock clock{10 * one_second};

  void frame(std::uint32_t sequence, std::uint8_t fill = 0, std::uint32_t flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
    device.push({sequence, 9 * one_second + sequence * one_millisecond, flags, 0, fill});
  }
  void check_all_closed() const {
    CHECK(device.open_handles == 0);
    CHECK(device.mapped == 0);
    CHECK(device.streams_started == 0);
  }
};

bool contains(const char* text, std::string_view part) {
  return std::string_view(text).find(part) != std::string_view::npos;
}

TEST_CASE("a frame is read in the driver's buffer and given back") {
  Bench bench;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  CHECK(camera.open() == Status::ok);
  CHECK(bench.device.queued == 5);
  bench.frame(7, 99);
  const auto frame = camera.acquire(bench.clock.now());
  REQUIRE(frame.ok());
  CHECK(frame.value().image.width == 640);
  CHECK(frame.value().image.stride_bytes == 1280);
  CHECK(frame.value().image.data == bench.device.memory[frame.value().buffer].data());
  CHECK(frame.value().image.data[0] == 99);
  CHECK(frame.value().time == 9 * one_second + 7 * one_millisecond);
  CHECK(frame.value().sequence == 7);
  CHECK_FALSE(frame.value().error);
  CHECK(bench.device.queued == 4);
  CHECK(camera.release(frame.value()) == Status::ok);
  CHECK(camera.release(frame.value()) == Status::invalid_argument);
  CHECK(bench.device.queued == 5);
  CHECK(camera.acquire(bench.clock.now()).status() == Status::timeout);
  camera.close();
  camera.close();
  bench.check_all_closed();
  CHECK(camera.acquire(bench.clock.now()).status() == Status::disconnected);
}

TEST_CASE("the newest frame is lent; older ones are passed over, lost ones counted") {
  Bench bench;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  bench.frame(1);
  REQUIRE(camera.release(camera.acquire(0).value()) == Status::ok);
  bench.frame(4);
  bench.frame(5);
  bench.frame(8, 8);
  const auto frame = camera.acquire(0);
  REQUIRE(frame.ok());
  CHECK(frame.value().sequence == 8);
  CHECK(frame.value().image.data[0] == 8);
  CHECK(frame.value().skipped == 2);
  CHECK(frame.value().lost == 4);
  CHECK(bench.device.queued == 4);
  CHECK(camera.health().lost == 4);
  CHECK(camera.health().skipped == 2);
  CHECK(camera.health().received == 2);
}

TEST_CASE("streaming allocates nothing") {
  Bench bench;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  for (std::uint32_t i = 0; i < 100; ++i) {
    bench.frame(i);
    const test::HeapGuard guard;
    const auto frame = camera.acquire(0);
    REQUIRE(frame.ok());
    REQUIRE(camera.release(frame.value()) == Status::ok);
    CHECK(guard.allocations() == 0);
  }
}

TEST_CASE("damaged and short buffers carry the error flag") {
  Bench bench;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  bench.frame(1, 0, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_ERROR);
  auto frame = camera.acquire(0);
  CHECK(frame.value().error);
  REQUIRE(camera.release(frame.value()) == Status::ok);
  bench.device.push({2, 9 * one_second, V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC, 1000, 0});
  frame = camera.acquire(0);
  CHECK(frame.value().error);
  CHECK(camera.health().corrupt == 2);
}

TEST_CASE("a stamp of another clock, or from the future, is replaced by now") {
  Bench bench;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  bench.frame(1, 0, V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN);
  CHECK(camera.acquire(0).value().time == bench.clock.now());
  bench.device.push({2, 99 * one_second});
  CHECK(camera.acquire(0).value().time == bench.clock.now());
}

TEST_CASE("when every buffer is lent the camera says so") {
  Bench bench;
  bench.device.granted_buffers = 2;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  bench.frame(1);
  const auto first = camera.acquire(0);
  bench.frame(2);
  REQUIRE(camera.acquire(0).ok());
  CHECK(camera.acquire(0).status() == Status::capacity);
  CHECK(camera.release(first.value()) == Status::ok);
  bench.frame(3);
  CHECK(camera.acquire(0).value().sequence == 3);
}

TEST_CASE("a converted stream is taken frame by frame, since each would be converted for nothing") {
  Bench bench;
  bench.device.emulated = true;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  CHECK_FALSE(camera.native());
  bench.frame(1);
  bench.frame(2);
  CHECK(camera.acquire(0).value().sequence == 1);
}

TEST_CASE("the camera is found by its name") {
  Bench bench;
  bench.device.devices = {{"/dev/video3", "Lens: Top"}};
  V4l2CameraConfig config;
  config.device = "Lens: Top";
  V4l2Camera camera(config, bench.clock);
  CHECK(camera.open() == Status::ok);
  CHECK(std::string_view(camera.path()) == "/dev/video3");
  config.device = "Other";
  V4l2Camera other(config, bench.clock);
  camera.close();
  CHECK(other.open() == Status::disconnected);
  CHECK(contains(other.problem(), "Other"));
  bench.check_all_closed();
}

TEST_CASE("each call that fails while opening closes everything and says what it was") {
  struct Failure {
    unsigned long request;
    Status status;
    const char* name;
  };
  for (const Failure& failure : {Failure{VIDIOC_QUERYCAP, Status::device_error, "VIDIOC_QUERYCAP"},
                                 Failure{VIDIOC_S_INPUT, Status::unsupported, "VIDIOC_S_INPUT"},
                                 Failure{VIDIOC_S_FMT, Status::device_error, "VIDIOC_S_FMT"},
                                 Failure{VIDIOC_REQBUFS, Status::device_error, "VIDIOC_REQBUFS"},
                                 Failure{VIDIOC_QUERYBUF, Status::device_error, "VIDIOC_QUERYBUF"},
                                 Failure{VIDIOC_QBUF, Status::device_error, "VIDIOC_QBUF"},
                                 Failure{VIDIOC_STREAMON, Status::device_error, "VIDIOC_STREAMON"}}) {
    Bench bench;
    bench.device.failing[failure.request] = EBUSY;
    V4l2CameraConfig config;
    config.input = 0;
    V4l2Camera camera(config, bench.clock);
    CHECK(camera.open() == failure.status);
    CHECK(contains(camera.problem(), failure.name));
    CHECK_FALSE(camera.health().open);
    bench.check_all_closed();
    bench.device.failing.clear();
    CHECK(camera.open() == Status::ok);  // and nothing stands in the way of the next try
  }
}

TEST_CASE("what the device is not or has not is said") {
  Bench bench;
  V4l2Camera camera({}, bench.clock);
  bench.device.fail_open = EACCES;
  CHECK(camera.open() == Status::disconnected);
  CHECK(contains(camera.problem(), "ermission"));
  bench.device.fail_open = 0;
  bench.device.capabilities = V4L2_CAP_STREAMING;
  CHECK(camera.open() == Status::unsupported);
  bench.device.capabilities = V4L2_CAP_VIDEO_CAPTURE;
  CHECK(camera.open() == Status::unsupported);
  bench.device.capabilities |= V4L2_CAP_STREAMING;
  bench.device.offered_width = 320;
  CHECK(camera.open() == Status::unsupported);
  CHECK(contains(camera.problem(), "320"));
  bench.device.offered_width = 0;
  bench.device.offered_format = V4L2_PIX_FMT_GREY;
  CHECK(camera.open() == Status::unsupported);
  bench.device.offered_format = 0;
  bench.device.granted_buffers = 1;
  CHECK(camera.open() == Status::device_error);
  bench.device.granted_buffers = 40;
  CHECK(camera.open() == Status::device_error);
  bench.device.granted_buffers = 0;
  bench.device.fail_mmap = true;
  CHECK(camera.open() == Status::device_error);
  bench.check_all_closed();
}

TEST_CASE("rate and controls that the camera has not are no failure, but are told") {
  Bench bench;
  V4l2CameraConfig config;
  config.exposure = {CameraControl::Mode::fixed, 80};
  config.gain = {CameraControl::Mode::automatic, 0};
  config.white_balance = {CameraControl::Mode::fixed, 4500};
  V4l2Camera camera(config, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  CHECK(bench.device.controls[V4L2_CID_EXPOSURE_AUTO] == V4L2_EXPOSURE_MANUAL);
  CHECK(bench.device.controls[V4L2_CID_EXPOSURE_ABSOLUTE] == 80);
  CHECK(bench.device.controls[V4L2_CID_AUTOGAIN] == 1);
  CHECK(bench.device.controls[V4L2_CID_AUTO_WHITE_BALANCE] == 0);
  CHECK(bench.device.controls[V4L2_CID_WHITE_BALANCE_TEMPERATURE] == 4500);
  camera.close();
  bench.device.failing = {{VIDIOC_S_CTRL, EINVAL}, {VIDIOC_S_PARM, EINVAL}};
  CHECK(camera.open() == Status::ok);
  CHECK(contains(camera.problem(), "white balance"));
}

TEST_CASE("an unplugged camera is disconnected, closes all, and comes back by open()") {
  Bench bench;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  bench.frame(1);
  const auto lent = camera.acquire(0);
  REQUIRE(lent.ok());
  bench.device.unplug();
  CHECK(camera.acquire(0).status() == Status::disconnected);
  CHECK(camera.release(lent.value()) == Status::disconnected);
  bench.check_all_closed();
  CHECK(camera.open() == Status::disconnected);
  bench.device.plug_in();
  CHECK(camera.open() == Status::ok);
  bench.frame(0);  // the count starts anew: nothing was lost
  CHECK(camera.acquire(0).value().lost == 0);
  CHECK(camera.health().opened == 2);
}

TEST_CASE("errors while streaming end the stream") {
  for (const unsigned long request : {VIDIOC_DQBUF, VIDIOC_QBUF}) {
    Bench bench;
    V4l2Camera camera({}, bench.clock);
    REQUIRE(camera.open() == Status::ok);
    bench.frame(1);
    bench.frame(2);
    bench.device.failing[request] = EIO;
    CHECK(camera.acquire(0).status() == Status::disconnected);
    bench.check_all_closed();
  }
}

TEST_CASE("a driver that says ready and has nothing cannot hold the loop") {
  Bench bench;
  bench.device.spurious_ready = true;
  V4l2Camera camera({}, bench.clock);
  REQUIRE(camera.open() == Status::ok);
  CHECK(camera.acquire(0).status() == Status::timeout);
}

}  // namespace
}  // namespace touchline
