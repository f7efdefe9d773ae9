// SPDX-License-Identifier: Apache-2.0
// Runs inside the virtual machine: every backend alone, on the kernel's own drivers. Each check prints PASS or FAIL;
// the exit status is the number of those that failed.
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

#include "hal/linux/gpio_panel.h"
#include "hal/linux/hid_imu.h"
#include "hal/linux/monotonic_clock.h"
#include "hal/linux/serial_gait_link.h"
#include "hal/linux/v4l2_camera.h"
#include "tests/hal/gait_header.h"
#include "tests/vm/raw_serial.h"
#include "tests/vm/uhid_device.h"
#include "tests/vm/vivid.h"

namespace touchline::vm {
namespace {

int failures = 0;

void check(bool good, const char* what, const char* detail = "") {
  std::printf("%s %s %s\n", good ? "PASS" : "FAIL", what, good ? "" : detail);
  std::fflush(stdout);
  failures += good ? 0 : 1;
}

MonotonicClock clock_now;

void pause(MonotonicNs duration) { clock_now.wait_until(clock_now.now() + duration); }

/// Repeats until it is true, for at most `seconds`.
bool within(double seconds, const std::function<bool()>& condition) {
  const MonotonicNs end = clock_now.now() + from_seconds(seconds);
  while (!condition()) {
    if (clock_now.now() > end) return false;
    pause(2 * one_millisecond);
  }
  return true;
}

struct Stream {
  int good = 0, damaged = 0, lost = 0;
  Status last = Status::ok;
};

Stream stream(V4l2Camera& camera, int frames, double seconds) {
  Stream seen;
  const MonotonicNs end = clock_now.now() + from_seconds(seconds);
  while (seen.good + seen.damaged < frames && clock_now.now() < end) {
    const auto frame = camera.acquire(clock_now.now() + one_second / 2);
    seen.last = frame.status();
    if (frame.status() == Status::timeout) continue;
    if (!frame.ok()) return seen;
    ++(frame.value().error ? seen.damaged : seen.good);
    seen.lost += static_cast<int>(frame.value().lost);
    if (camera.release(frame.value()) != Status::ok) return seen;
  }
  return seen;
}

void test_camera() {
  const std::string node = vivid_node(false);
  check(!node.empty(), "camera: vivid is there");
  V4l2CameraConfig config;
  config.device = node;
  config.input = 0;
  config.rate_hz = 25.0;
  V4l2Camera camera(config, clock_now);
  check(camera.open() == Status::ok, "camera: opens as 640x480 YUYV", camera.problem());
  check(camera.native(), "camera: YUYV is native");
  Stream seen = stream(camera, 20, 20.0);
  check(seen.good == 20 && seen.damaged == 0, "camera: 20 frames");
  check(camera.health().last_datum > 0 && clock_now.now() - camera.health().last_datum < 2 * one_second,
        "camera: time stamps are of the monotonic clock");
  set_control(node, "Percentage of Dropped Buffers", 50);
  seen = stream(camera, 20, 30.0);
  set_control(node, "Percentage of Dropped Buffers", 0);
  check(seen.lost > 0, "camera: dropped frames are counted by their sequence numbers");
  set_control(node, "Inject V4L2_BUF_FLAG_ERROR", 1);
  seen = stream(camera, 10, 20.0);
  check(seen.damaged > 0, "camera: a buffer with the error flag is marked");
  config.width = 752;
  config.height = 480;
  camera.close();
  V4l2Camera odd(config, clock_now);
  check(odd.open() == Status::unsupported, "camera: a size that the webcam has not is refused");
  V4l2CameraConfig rgb;
  rgb.device = node;
  rgb.input = 0;
  rgb.format = PixelFormat::rgb24;
  V4l2Camera rgb_camera(rgb, clock_now);
  check(rgb_camera.open() == Status::ok, "camera: opens as RGB24", rgb_camera.problem());
  check(stream(rgb_camera, 5, 20.0).good == 5, "camera: 5 frames of RGB24");
  rgb_camera.close();
  check(camera.open() == Status::ok, "camera: opens again", camera.problem());
  set_control(node, "Disconnect", 1);
  seen = stream(camera, 1000, 10.0);
  check(seen.last == Status::disconnected, "camera: an unplugged camera is disconnected");
  check(!camera.health().open, "camera: and closed");
}

void test_camera_is_back() {
  V4l2CameraConfig config;
  config.device = vivid_node(false);
  config.input = 0;
  V4l2Camera camera(config, clock_now);
  check(within(5.0, [&] { return camera.open() == Status::ok; }), "camera: opens after the module was loaded anew",
        camera.problem());
  check(stream(camera, 5, 20.0).good == 5, "camera: 5 frames after that");
}

/// Own pictures, told apart by a tag in their first pixels, since the two ends are not phase locked.
void test_loop() {
  VividOutput output;
  check(output.open(), "loop: vivid's output is looped to its input");
  std::string picture(640 * 480 * 2, '\0');
  auto* bytes = reinterpret_cast<std::uint8_t*>(picture.data());
  V4l2CameraConfig config;
  config.device = vivid_node(false);
  config.input = 1;
  config.rate_hz = 0.0;
  V4l2Camera camera(config, clock_now);
  check(camera.open() == Status::ok, "loop: camera opens the HDMI input", camera.problem());
  int newest = -1;
  int exact = 0;
  int seen = 0;
  for (int tag = 0; tag < 60; ++tag) {
    for (std::size_t i = 0; i < picture.size(); ++i)
      bytes[i] = static_cast<std::uint8_t>((i * 7 + static_cast<std::size_t>(tag) * 31) & 0xFF);
    bytes[0] = static_cast<std::uint8_t>(tag);
    output.show(bytes, 1000);
    const auto frame = camera.acquire(clock_now.now() + one_second / 10);
    if (!frame.ok()) continue;
    const std::uint8_t* data = frame.value().image.data;
    const int got = data[0];
    bool same = got <= tag && got >= newest;
    for (std::size_t i = 1; same && i < picture.size(); i += 97) {
      same = data[i] == static_cast<std::uint8_t>((i * 7 + static_cast<std::size_t>(got) * 31) & 0xFF);
    }
    if (tag > 10) ++seen, exact += same ? 1 : 0;
    newest = same ? got : newest;
    (void)camera.release(frame.value());
  }
  std::printf("loop: %d of %d pictures exact, newest tag %d\n", exact, seen, newest);
  check(seen > 10 && exact == seen && newest > 20, "loop: pictures come out as they went in");
}

void test_imu() {
  UhidImu device;
  HidImuConfig config{"1209:0001", vendor_report_layout()};
  HidImu imu(config, clock_now);
  check(imu.open() == Status::disconnected, "imu: not there before it is plugged in");
  check(device.plug_in(), "imu: uhid plays it");
  check(within(5.0, [&] { return imu.open() == Status::ok; }), "imu: opens by vendor:product", imu.problem());
  int samples = 0;
  float yaw = 0.0F;
  for (int i = 0; i < 100; ++i) {
    device.send(0.1F * static_cast<float>(i));
    pause(10 * one_millisecond);
    for (auto sample = imu.read(); sample.ok(); sample = imu.read(), ++samples) yaw = sample.value().yaw;
  }
  std::printf("imu: %d of 100 samples, yaw %.3f, lost %u, corrupt %u\n", samples, static_cast<double>(yaw),
              imu.health().lost, imu.health().corrupt);
  check(samples >= 90 && imu.health().corrupt == 0, "imu: 100 reports in a second");
  check(yaw > 9.5F && yaw < 9.95F, "imu: yaw is unwrapped");
  device.unplug();
  check(within(2.0, [&] { return imu.read().status() == Status::disconnected; }), "imu: unplugged is disconnected");
  check(device.plug_in() && within(5.0, [&] { return imu.open() == Status::ok; }), "imu: comes back", imu.problem());
}

void test_gait() {
  const MonotonicNs none = 0;
  SerialGaitLink link({"/dev/gait-robot", 115200, none}, clock_now);
  check(link.open() == Status::ok, "gait: the port opens", link.problem());
  const int sender = open_raw("/dev/gait-controller");
  check(sender >= 0, "gait: the other end opens");
  int samples = 0;
  float x = 0.0F;
  for (std::uint32_t i = 0; i < 100; ++i) {
    touchline_gait gait{};
    gait.boot_id = 7;
    gait.sequence = i;
    gait.time_us = i * 20000;
    gait.x_m = 0.01F * static_cast<float>(i);
    std::uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
    encode_gait_in_c(&gait, frame);
    if (i % 10 == 5) frame[20] ^= 0x01;  // a bit that fell over
    if (::write(sender, frame, sizeof frame) != static_cast<ssize_t>(sizeof frame)) check(false, "gait: written");
    pause(20 * one_millisecond);
    for (auto sample = link.read(); sample.ok(); sample = link.read(), ++samples) x = sample.value().odometry.x;
  }
  (void)within(1.0, [&] {
    for (auto sample = link.read(); sample.ok(); sample = link.read(), ++samples) x = sample.value().odometry.x;
    return samples >= 90;
  });
  std::printf("gait: %d samples, %u corrupt, %u lost\n", samples, link.health().corrupt, link.health().lost);
  check(samples == 90 && link.health().corrupt >= 10 && link.health().lost == 10,
        "gait: 90 good frames, 10 with a wrong bit not used");
  check(x > 0.985F && x < 0.995F, "gait: the odometry arrives");
  ::close(sender);
}

void test_panel() {
  UhidGpio chip;
  GpioLinesConfig config;
  config.chip = "cp2112_gpio";
  config.button_line = 2;
  config.led_line = 5;
  GpioPanel panel(config);
  check(panel.open() == Status::disconnected, "panel: not there before it is plugged in");
  check(chip.plug_in(), "panel: uhid plays a CP2112");
  check(within(5.0, [&] { return panel.open() == Status::ok; }), "panel: opens by the chip's label", panel.problem());
  Result<ButtonEvent> press = Status::not_ready;
  const auto poll_until = [&](double seconds) {
    press = Status::not_ready;
    return within(seconds, [&] {
      const auto event = panel.poll(clock_now.now());
      if (event.ok()) press = event;
      return press.ok();
    });
  };
  check(!poll_until(0.3), "panel: no press without a press");
  chip.set_line(2, false);
  (void)poll_until(0.3);
  chip.set_line(2, true);
  check(poll_until(2.0) && press.value().press == ButtonPress::short_press, "panel: a short press");
  chip.set_line(2, false);
  check(poll_until(4.0) && press.value().press == ButtonPress::long_press, "panel: a long press");
  chip.set_line(2, true);
  (void)poll_until(0.2);
  panel.show(LedPattern::sure);
  (void)poll_until(0.2);
  check(chip.line(5), "panel: the light is on");
  chip.unplug();
  check(within(3.0, [&] { return panel.poll(clock_now.now()).status() == Status::disconnected; }),
        "panel: unplugged is disconnected");
  check(chip.plug_in() && within(5.0, [&] { return panel.open() == Status::ok; }), "panel: comes back",
        panel.problem());
}

}  // namespace
}  // namespace touchline::vm

int main(int argc, char** argv) {
  using namespace touchline::vm;
  const std::string what = argc > 1 ? argv[1] : "";
  if (what == "camera") test_camera();
  if (what == "camera-back") test_camera_is_back();
  if (what == "loop") test_loop();
  if (what == "imu") test_imu();
  if (what == "gait") test_gait();
  if (what == "panel") test_panel();
  return failures;
}
