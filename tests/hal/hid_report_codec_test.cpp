// SPDX-License-Identifier: Apache-2.0
// HID reports by layout: both ready layouts, every number type, every truncation and every wrong byte.
#include "hal/hid_report_codec.h"

#include <doctest/doctest.h>

#include <bit>
#include <limits>
#include <vector>

#include "hal/crc32.h"
#include "platform/core/geometry.h"
#include "platform/core/rng.h"

namespace touchline {
namespace {

using Report = std::vector<std::uint8_t>;

void put16(Report& report, std::size_t offset, int value) {
  report[offset] = static_cast<std::uint8_t>(value & 0xFF);
  report[offset + 1] = static_cast<std::uint8_t>((value >> 8) & 0xFF);
}
void put32(Report& report, std::size_t offset, std::uint32_t value, bool big_endian = false) {
  for (std::size_t i = 0; i < 4; ++i) {
    report[offset + (big_endian ? 3 - i : i)] = static_cast<std::uint8_t>(value >> (8 * i));
  }
}

Report vendor_report(int yaw = 12345, int roll = -200, int pitch = 300, int rate = -1500) {
  Report report(16, 0);
  report[0] = 1;
  report[1] = 42;
  put16(report, 2, yaw);
  put16(report, 4, roll);
  put16(report, 6, pitch);
  put16(report, 8, rate);
  report[10] = 1;
  put32(report, 12, crc32(std::span(report).first(12)));
  return report;
}

TEST_CASE("the vendor report, byte by byte") {
  const auto result = decode_hid_report(vendor_report_layout(), vendor_report());
  REQUIRE(result.ok());
  CHECK(result.value().sequence == 42);
  const ImuSample& sample = result.value().sample;
  CHECK(sample.yaw == doctest::Approx(1.2345F));
  CHECK(sample.has_tilt);
  CHECK(sample.roll == doctest::Approx(-0.02F));
  CHECK(sample.pitch == doctest::Approx(0.03F));
  CHECK(sample.has_yaw_rate);
  CHECK(sample.yaw_rate == doctest::Approx(-1.5F));
}

TEST_CASE("every truncation and every single wrong byte of the vendor report is refused") {
  const Report good = vendor_report();
  for (std::size_t size = 0; size < good.size(); ++size) {
    CHECK(decode_hid_report(vendor_report_layout(), std::span(good).first(size)).status() == Status::corrupt);
  }
  int accepted = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    for (int value = 0; value < 256; ++value) {
      Report bad = good;
      bad[i] = static_cast<std::uint8_t>(value);
      accepted += bad != good && decode_hid_report(vendor_report_layout(), bad).ok() ? 1 : 0;
    }
  }
  CHECK(accepted == 0);
}

TEST_CASE("a report of another id, or one that is not valid yet, is nothing and no fault") {
  Report report = vendor_report();
  report[0] = 2;
  CHECK(decode_hid_report(vendor_report_layout(), report).status() == Status::not_ready);
  report = vendor_report();
  report[10] = 0;
  put32(report, 12, crc32(std::span(report).first(12)));
  CHECK(decode_hid_report(vendor_report_layout(), report).status() == Status::not_ready);
}

TEST_CASE("numbers of each type, order, unit and sign") {
  HidReportLayout layout;  // no report id, no fixed length
  layout.yaw = {true, 1, HidNumber::float32, false, 1.0F, AngleUnit::degree, true};
  layout.roll = {true, 5, HidNumber::int32, true, 1e-6F};
  layout.pitch = {true, 9, HidNumber::int16, true, 0.01F, AngleUnit::degree};
  REQUIRE(layout_error(layout) == nullptr);
  Report report(11, 0);
  put32(report, 1, std::bit_cast<std::uint32_t>(90.0F));
  put32(report, 5, static_cast<std::uint32_t>(-250000), true);
  report[9] = 0x03;
  report[10] = 0xE8;  // 1000: 10 degrees
  const auto result = decode_hid_report(layout, report);
  REQUIRE(result.ok());
  CHECK(result.value().sample.yaw == doctest::Approx(-math::half_pi));
  CHECK(result.value().sample.roll == doctest::Approx(-0.25F));
  CHECK(result.value().sample.pitch == doctest::Approx(radians(10.0F)));
  CHECK_FALSE(result.value().sample.has_yaw_rate);
  CHECK(decode_hid_report(layout, std::span(report).first(10)).status() == Status::corrupt);
  report.push_back(0);  // longer reports hold all fields as well
  CHECK(decode_hid_report(layout, report).ok());
  put32(report, 1, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::quiet_NaN()));
  CHECK(decode_hid_report(layout, report).status() == Status::corrupt);
  put32(report, 1, std::bit_cast<std::uint32_t>(4000.0F));
  CHECK(decode_hid_report(layout, report).status() == Status::corrupt);
}

TEST_CASE("a yaw of 0 to 360 degrees is brought to (-pi, pi]") {
  HidReportLayout layout;
  layout.yaw = {true, 0, HidNumber::int16, false, 0.01F, AngleUnit::degree};
  Report report(2, 0);
  put16(report, 0, 27000);
  CHECK(decode_hid_report(layout, report).value().sample.yaw == doctest::Approx(-math::half_pi));
}

/// The sensor page's report of a torso whose rotation is Rz(yaw) Ry(pitch) Rx(roll).
Report sensor_report(float yaw, float pitch, float roll) {
  const float cy = math::cos(yaw / 2), sy = math::sin(yaw / 2), cp = math::cos(pitch / 2), sp = math::sin(pitch / 2);
  const float cr = math::cos(roll / 2), sr = math::sin(roll / 2);
  const float q[4] = {sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
                      cr * cp * cy + sr * sp * sy};
  Report report(11, 0);
  report[0] = 1;
  for (std::size_t i = 0; i < 4; ++i) put16(report, 3 + 2 * i, static_cast<int>(q[i] * 10000.0F));
  return report;
}

TEST_CASE("the sensor page's quaternion gives the torso's angles") {
  Rng rng(5);
  for (int i = 0; i < 200; ++i) {
    const float yaw = rng.uniform(-3.1F, 3.1F), pitch = rng.uniform(-1.2F, 1.2F), roll = rng.uniform(-3.0F, 3.0F);
    const auto result = decode_hid_report(sensor_page_layout(), sensor_report(yaw, pitch, roll));
    REQUIRE(result.ok());
    CHECK(math::abs(angle_difference(result.value().sample.yaw, yaw)) < 2e-3F);
    CHECK(math::abs(angle_difference(result.value().sample.pitch, pitch)) < 2e-3F);
    CHECK(math::abs(angle_difference(result.value().sample.roll, roll)) < 2e-3F);
  }
}

TEST_CASE("a sensor that is mounted turned says the torso's angles") {
  HidReportLayout layout = sensor_page_layout();
  layout.forward = SensorAxis::plus_y;  // the sensor's y looks forward: its x looks right, it is turned by -90 degrees
  const auto result = decode_hid_report(layout, sensor_report(-math::half_pi, 0.0F, 0.0F));
  REQUIRE(result.ok());
  CHECK(result.value().sample.yaw == doctest::Approx(0.0F).epsilon(0.001));
  layout.up = SensorAxis::minus_y;
  CHECK(layout_error(layout) != nullptr);
}

TEST_CASE("a quaternion that has lost a byte is no unit quaternion, and random reports give finite angles or none") {
  Report report = sensor_report(0.3F, 0.0F, 0.0F);
  report[10] = 0;
  CHECK(decode_hid_report(sensor_page_layout(), report).status() == Status::corrupt);
  Rng rng(9);
  for (int i = 0; i < 20000; ++i) {
    for (std::uint8_t& byte : report) byte = static_cast<std::uint8_t>(rng.next_u32());
    report[0] = 1;
    const auto result = decode_hid_report(sensor_page_layout(), report);
    if (!result.ok()) continue;
    CHECK(math::abs(result.value().sample.yaw) <= math::pi);
    CHECK(math::abs(result.value().sample.pitch) <= math::half_pi + 1e-6F);
  }
}

TEST_CASE("a layout that cannot work says why") {
  HidReportLayout layout;
  CHECK(layout_error(layout) != nullptr);  // no yaw
  layout = vendor_report_layout();
  CHECK(layout_error(layout) == nullptr);
  layout.length = 14;
  CHECK(layout_error(layout) != nullptr);
  layout = vendor_report_layout();
  layout.roll.present = false;
  CHECK(layout_error(layout) != nullptr);
  layout = vendor_report_layout();
  layout.length = 0;
  layout.yaw.offset = 250;
  CHECK(layout_error(layout) != nullptr);
  layout = sensor_page_layout();
  CHECK(layout_error(layout) == nullptr);
  layout.q[2].present = false;
  CHECK(layout_error(layout) != nullptr);
}

TEST_CASE("unwrapping goes on over full turns both ways") {
  YawUnwrapper unwrapper;
  float yaw = 0.0F;
  for (int i = 0; i < 100; ++i) {
    yaw += 0.5F;
    CHECK(unwrapper.unwrap(wrap_angle(yaw)) == doctest::Approx(yaw));
  }
  for (int i = 0; i < 200; ++i) {
    yaw -= 0.5F;
    CHECK(unwrapper.unwrap(wrap_angle(yaw)) == doctest::Approx(yaw));
  }
}

}  // namespace
}  // namespace touchline
