// SPDX-License-Identifier: Apache-2.0
// The IMU backend against a fake of hidapi.
#include "hal/linux/hid_imu.h"

#include <doctest/doctest.h>

#include <string_view>

#include "hal/crc32.h"
#include "hal/mock/manual_clock.h"
#include "platform/core/geometry.h"
#include "tests/support/fake_hidapi.h"

namespace touchline {
namespace {

std::vector<std::uint8_t> report(std::uint8_t sequence, float yaw) {
  std::vector<std::uint8_t> bytes(16, 0);
  const auto raw = static_cast<std::uint16_t>(static_cast<int>(wrap_angle(yaw) * 1e4F));
  bytes[0] = 1;
  bytes[1] = sequence;
  bytes[2] = static_cast<std::uint8_t>(raw & 0xFFU);
  bytes[3] = static_cast<std::uint8_t>(raw >> 8);
  bytes[10] = 1;
  const std::uint32_t crc = crc32(std::span(bytes).first(12));
  for (std::size_t i = 0; i < 4; ++i) bytes[12 + i] = static_cast<std::uint8_t>(crc >> (8 * i));
  return bytes;
}

struct Bench {
  Bench() { fake::reset_hidapi(); }
  fake::Hidapi& device = fake::hidapi();
  ManualClock clock{10 * one_second};
  HidImuConfig config{"1209:0001", vendor_report_layout()};
};

TEST_CASE("reports become samples with an unwrapped yaw, one after the other") {
  Bench bench;
  HidImu imu(bench.config, bench.clock);
  CHECK(imu.read().status() == Status::disconnected);
  REQUIRE(imu.open() == Status::ok);
  CHECK(imu.open() == Status::ok);
  CHECK(imu.read().status() == Status::not_ready);
  for (std::uint8_t i = 0; i < 70; ++i) {  // past pi
    bench.device.reports.push_back(report(i, 0.1F * static_cast<float>(i)));
    bench.clock.advance(10 * one_millisecond);
    const auto sample = imu.read();
    REQUIRE(sample.ok());
    CHECK(sample.value().yaw == doctest::Approx(0.1F * static_cast<float>(i)).epsilon(0.001));
    CHECK(sample.value().time == bench.clock.now());
  }
  CHECK(imu.health().received == 70);
  CHECK(imu.health().lost == 0);
  imu.close();
  imu.close();
  CHECK(bench.device.open_handles == 0);
}

TEST_CASE("reports that waited get times one period apart") {
  Bench bench;
  HidImu imu(bench.config, bench.clock);
  REQUIRE(imu.open() == Status::ok);
  for (std::uint8_t i = 0; i < 20; ++i) {
    bench.clock.advance(10 * one_millisecond);
    bench.device.reports.push_back(report(i, 0.0F));
    REQUIRE(imu.read().ok());
  }
  bench.clock.advance(30 * one_millisecond);
  for (std::uint8_t i = 20; i < 23; ++i) bench.device.reports.push_back(report(i, 0.0F));
  CHECK(imu.read().value().time == bench.clock.now() - 20 * one_millisecond);
  CHECK(imu.read().value().time == bench.clock.now() - 10 * one_millisecond);
  CHECK(imu.read().value().time == bench.clock.now());
  CHECK(imu.read().status() == Status::not_ready);
}

TEST_CASE("lost, doubled and garbled reports are counted and not used") {
  Bench bench;
  HidImu imu(bench.config, bench.clock);
  REQUIRE(imu.open() == Status::ok);
  bench.device.reports = {report(250, 0.1F), report(250, 0.1F), report(3, 0.2F)};
  bench.device.reports.push_back({1, 2, 3});
  auto garbled = report(4, 0.3F);
  garbled[3] ^= 0x10;
  bench.device.reports.push_back(garbled);
  bench.device.reports.push_back({2, 0, 0});  // a report of another kind
  CHECK(imu.read().ok());
  CHECK(imu.read().ok());
  CHECK(imu.read().status() == Status::not_ready);
  CHECK(imu.health().received == 2);
  CHECK(imu.health().stale == 1);
  CHECK(imu.health().lost == 8);
  CHECK(imu.health().corrupt == 2);
}

TEST_CASE("the device is found by vendor and product, by serial, or by path") {
  for (const char* name : {"1209:0001", "1209:1", "1209:0001:A1", "/dev/hidraw0"}) {
    Bench bench;
    bench.config.device = name;
    HidImu imu(bench.config, bench.clock);
    CHECK(imu.open() == Status::ok);
  }
  for (const char* name : {"1209:0002", "1209:0001:B2", "/dev/hidraw7"}) {
    Bench bench;
    bench.config.device = name;
    HidImu imu(bench.config, bench.clock);
    CHECK(imu.open() == Status::disconnected);
    CHECK(std::string_view(imu.problem()).find(name) != std::string_view::npos);
  }
  for (const char* name : {"", "1209", "1209:", "xyz:1", "12345:1", "1209:0001 "}) {
    CHECK(hid_device_error(name) != nullptr);
    Bench bench;
    bench.config.device = name;
    HidImu imu(bench.config, bench.clock);
    CHECK(imu.open() == Status::invalid_argument);
  }
}

TEST_CASE("the sensor page's start report is sent before reading") {
  Bench bench;
  bench.config.layout = sensor_page_layout(5);
  HidImu imu(bench.config, bench.clock);
  REQUIRE(imu.open() == Status::ok);
  REQUIRE(bench.device.features.size() == 1);
  CHECK(bench.device.features[0] == std::vector<std::uint8_t>{5, 1, 2, 2});
}

TEST_CASE("each call that fails while opening leaves nothing open") {
  Bench bench;
  bench.config.layout = sensor_page_layout();
  HidImu imu(bench.config, bench.clock);
  bench.device.fail_init = true;
  CHECK(imu.open() == Status::device_error);
  bench.device.fail_init = false;
  bench.device.fail_feature = true;
  CHECK(imu.open() == Status::unsupported);
  bench.device.fail_feature = false;
  bench.device.fail_nonblocking = true;
  CHECK(imu.open() == Status::device_error);
  bench.device.fail_nonblocking = false;
  CHECK(bench.device.open_handles == 0);
  CHECK(imu.open() == Status::ok);
  HidImuConfig broken = bench.config;
  broken.layout = HidReportLayout{};
  HidImu other(broken, bench.clock);
  CHECK(other.open() == Status::invalid_argument);
}

TEST_CASE("an unplugged IMU is disconnected and comes back by open()") {
  Bench bench;
  HidImu imu(bench.config, bench.clock);
  REQUIRE(imu.open() == Status::ok);
  bench.device.reports.push_back(report(1, 0.5F));
  CHECK(imu.read().ok());
  bench.device.present = false;
  CHECK(imu.read().status() == Status::disconnected);
  CHECK(bench.device.open_handles == 0);
  CHECK(imu.open() == Status::disconnected);
  bench.device.present = true;
  REQUIRE(imu.open() == Status::ok);
  bench.device.reports.push_back(report(77, 0.6F));
  CHECK(imu.read().ok());
  CHECK(imu.health().lost == 0);  // a gap while it was away is no loss on the line
  CHECK(imu.health().opened == 2);
}

}  // namespace
}  // namespace touchline
