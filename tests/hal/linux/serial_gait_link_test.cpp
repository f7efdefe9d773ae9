// SPDX-License-Identifier: Apache-2.0
// The gait link on a pseudo terminal: a real tty with the test at its other end.
#include "hal/linux/serial_gait_link.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <filesystem>
#include <string_view>
#include <vector>

#include "hal/mock/manual_clock.h"
#include "platform/core/rng.h"
#include "tests/hal/gait_header.h"

namespace touchline {
namespace {

int open_descriptors() {
  int count = 0;
  for ([[maybe_unused]] const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

/// The controller's end of the line.
class Controller {
 public:
  Controller() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    REQUIRE(master_ >= 0);
    REQUIRE(grantpt(master_) == 0);
    REQUIRE(unlockpt(master_) == 0);
    path_ = ptsname(master_);
  }
  ~Controller() { hang_up(); }
  Controller(const Controller&) = delete;
  Controller& operator=(const Controller&) = delete;

  void hang_up() {
    if (master_ >= 0) ::close(master_);
    master_ = -1;
  }
  void send(const void* bytes, std::size_t size) { REQUIRE(write(master_, bytes, size) == static_cast<ssize_t>(size)); }
  void send(std::uint32_t sequence, float x = 0.0F) {
    touchline_gait gait{};
    gait.boot_id = 7;
    gait.sequence = sequence;
    gait.time_us = sequence * 10000;
    gait.x_m = x;
    std::uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
    encode_gait_in_c(&gait, frame);
    send(frame, sizeof frame);
  }
  [[nodiscard]] SerialGaitLinkConfig config() const { return {path_, 115200, 0}; }

 private:
  int master_;
  std::string path_;
};

TEST_CASE("frames come through the line, also when they are cut in pieces") {
  ManualClock clock;
  Controller controller;
  SerialGaitLink link(controller.config(), clock);
  CHECK(link.read().status() == Status::disconnected);
  REQUIRE(link.open() == Status::ok);
  CHECK(link.open() == Status::ok);
  CHECK(link.read().status() == Status::not_ready);
  controller.send(1, 0.5F);
  controller.send(2, 0.6F);
  CHECK(link.read().value().odometry.x == doctest::Approx(0.5F));
  CHECK(link.read().value().odometry.x == doctest::Approx(0.6F));
  CHECK(link.read().status() == Status::not_ready);

  touchline_gait gait{};
  gait.boot_id = 7;
  gait.sequence = 4;
  std::uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
  encode_gait_in_c(&gait, frame);
  controller.send(frame, 20);
  CHECK(link.read().status() == Status::not_ready);
  controller.send(frame + 20, sizeof frame - 20);
  CHECK(link.read().value().sequence == 4);
  CHECK(link.health().lost == 1);
  CHECK(link.health().received == 3);
  CHECK(link.health().open);
}

TEST_CASE("every byte value passes the line untouched") {
  ManualClock clock;
  Controller controller;
  SerialGaitLink link(controller.config(), clock);
  REQUIRE(link.open() == Status::ok);
  Rng rng(1);
  for (std::uint32_t i = 0; i < 200; ++i) {
    touchline_gait gait{};
    gait.boot_id = 0x11130D0AU;  // control characters: XON, XOFF, CR, LF
    gait.sequence = i;
    gait.x_m = rng.uniform(-100.0F, 100.0F);
    gait.y_m = rng.uniform(-100.0F, 100.0F);
    std::uint8_t frame[TOUCHLINE_GAIT_FRAME_BYTES];
    encode_gait_in_c(&gait, frame);
    controller.send(frame, sizeof frame);
    const auto sample = link.read();
    REQUIRE(sample.ok());
    CHECK(sample.value().odometry.x == doctest::Approx(gait.x_m).epsilon(1e-4));
  }
  CHECK(link.health().corrupt == 0);
}

TEST_CASE("noise is counted and cannot hold the loop") {
  ManualClock clock;
  Controller controller;
  SerialGaitLink link(controller.config(), clock);
  REQUIRE(link.open() == Status::ok);
  controller.send("\0", 1);
  Rng rng(2);
  std::vector<std::uint8_t> noise(3000);
  for (auto& byte : noise) byte = static_cast<std::uint8_t>(rng.next_u32());
  controller.send(noise.data(), noise.size());
  for (int i = 0; i < 10; ++i) CHECK(link.read().status() == Status::not_ready);
  CHECK(link.health().corrupt > 5);
  CHECK(link.health().received == 0);
  controller.send("\0", 1);
  controller.send(9);
  CHECK(link.read().value().sequence == 9);
}

TEST_CASE("a silent link says whether bytes arrive; a wrong baud rate is no silence of the line") {
  ManualClock clock;
  Controller controller;
  SerialGaitLink link(controller.config(), clock);
  REQUIRE(link.open() == Status::ok);
  clock.advance(one_second);
  CHECK(link.read().status() == Status::not_ready);
  CHECK(std::string(link.silence()) == "no bytes arrive");
  controller.send(std::string(1000, 'U').c_str(), 1000);
  CHECK(link.read().status() == Status::not_ready);
  CHECK(std::string(link.silence()).find("bytes arrive, but no frame: compare gait.baud") == 0);
  CHECK(link.health().corrupt > 0);
  CHECK(link.health().last_error == Status::corrupt);
  clock.advance(one_second);
  controller.send("\0", 1);
  controller.send(1);
  CHECK(link.read().ok());
  CHECK(std::string(link.silence()) == "no bytes arrive");
}

TEST_CASE("a line that is hung up is disconnected; opened anew it goes on, and no handle is left") {
  const int before = open_descriptors();
  {
    ManualClock clock;
    Controller controller;
    SerialGaitLink link(controller.config(), clock);
    REQUIRE(link.open() == Status::ok);
    controller.send(1);
    CHECK(link.read().ok());
    controller.hang_up();
    CHECK(link.read().status() == Status::disconnected);
    CHECK_FALSE(link.health().open);
    CHECK(link.open() == Status::disconnected);
    CHECK(std::string_view(link.problem()).find("/dev/pts") != std::string_view::npos);
  }
  CHECK(open_descriptors() == before);
}

TEST_CASE("what was sent while the port was closed is not read with a false time") {
  ManualClock clock;
  Controller controller;
  SerialGaitLink link(controller.config(), clock);
  REQUIRE(link.open() == Status::ok);
  controller.send(1);
  link.close();
  REQUIRE(link.open() == Status::ok);
  CHECK(link.read().status() == Status::not_ready);
  controller.send(5);
  CHECK(link.read().value().sequence == 5);
  CHECK(link.health().opened == 2);
}

TEST_CASE("what is no serial port, or has no such rate, is refused and closed") {
  const int before = open_descriptors();
  ManualClock clock;
  SerialGaitLink file({"/dev/null", 115200, 0}, clock);
  CHECK(file.open() == Status::device_error);
  Controller controller;
  SerialGaitLinkConfig config = controller.config();
  config.baud = 12345;
  SerialGaitLink link(config, clock);
  CHECK(link.open() == Status::invalid_argument);
  SerialGaitLink missing({"/dev/no-such-port", 115200, 0}, clock);
  CHECK(missing.open() == Status::disconnected);
  CHECK(open_descriptors() == before + 1);  // the controller's own
  CHECK(is_known_baud(1000000));
  CHECK_FALSE(is_known_baud(0));
}

}  // namespace
}  // namespace touchline
