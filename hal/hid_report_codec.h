// SPDX-License-Identifier: Apache-2.0
// From a HID input report to an orientation, by a layout that the config gives. Bytes in, angles out: no device, no
// clock. Two layouts are ready; others name the places of their numbers.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/imu.h"
#include "platform/core/result.h"

namespace touchline {

enum class HidNumber : std::uint8_t { int16, int32, float32 };
enum class AngleUnit : std::uint8_t { radian, degree };  // of rates: per second

/// One number of a report. value = raw * scale, in `unit`, with the sign turned if `inverted`.
struct HidField {
  bool present = false;
  std::uint8_t offset = 0;  // of its first byte in the report, the report id counted as byte 0 where there is one
  HidNumber number = HidNumber::int16;
  bool big_endian = false;
  float scale = 1.0F;
  AngleUnit unit = AngleUnit::radian;
  bool inverted = false;
};

/// Which axis of the sensor points in a direction of the torso.
enum class SensorAxis : std::uint8_t { plus_x, minus_x, plus_y, minus_y, plus_z, minus_z };

inline constexpr std::size_t max_hid_report_bytes = 64;  // a full-speed interrupt transfer

struct HidReportLayout {
  std::uint8_t report_id = 0;  // 0: the device does not number its reports
  std::uint8_t length = 0;     // of the report with its id; 0: any that holds all fields
  HidField yaw;                // required, or the quaternion
  HidField roll, pitch, yaw_rate;

  bool quaternion = false;                  // x, y, z, w in place of the angles: world_from_sensor, world's z up
  std::array<HidField, 4> q{};              // x, y, z, w
  SensorAxis forward = SensorAxis::plus_x;  // the sensor's axis that points where the robot looks
  SensorAxis up = SensorAxis::plus_z;       // the sensor's axis that points up

  bool has_sequence = false;  // one byte that grows by one with each report
  std::uint8_t sequence_offset = 0;
  bool has_valid_bit = false;  // bit 0 of this byte: the orientation may be used
  std::uint8_t valid_offset = 0;
  bool has_crc32 = false;  // the last four bytes: CRC-32, little-endian, of all bytes before them

  /// Bytes that put the device in operation, sent as a feature report before reading; the first is the report id.
  std::array<std::uint8_t, 16> start_report{};
  std::uint8_t start_report_size = 0;  // 0: none is needed
};

/// The report for people who build their own IMU, 16 bytes, little-endian:
///   byte  type  meaning
///    0    u8    report id: 1
///    1    u8    sequence: grows by one with each report, wraps
///    2    i16   yaw: 1e-4 rad, -31416 to 31416, counter-clockwise seen from above
///    4    i16   roll: 1e-4 rad, positive lowers the right side
///    6    i16   pitch: 1e-4 rad, positive bows forward
///    8    i16   yaw rate: 1e-3 rad/s, counter-clockwise
///   10    u8    bit 0: the orientation is valid (the filter has settled); other bits 0
///   11    u8    0
///   12    u32   CRC-32 (IEEE 802.3) of bytes 0 to 11
HidReportLayout vendor_report_layout();

/// The HID sensor usage page (20h), Device Orientation (8Ah), as its common descriptor lays it out:
///   byte 0 report id, 1 sensor state, 2 sensor event, 3 i16 x, 5 i16 y, 7 i16 z, 9 i16 w
/// with the numbers in units of 1e-4 (unit exponent -4). Where the descriptor says another exponent, set the scales.
/// The start report sets reporting state "all events" and power state "full power" (report id, connection, reporting,
/// power).
HidReportLayout sensor_page_layout(std::uint8_t report_id = 1);

/// Null when the layout can be used, else what is wrong with it, in words for the config's author.
const char* layout_error(const HidReportLayout& layout);

struct HidReport {
  ImuSample sample;           // `time` is not set; yaw in (-pi, pi], not unwrapped
  std::uint8_t sequence = 0;  // void without has_sequence
};

/// not_ready: a report of another id, or not valid yet. corrupt: length, CRC-32 or a value is wrong (not finite, an
/// angle past a full turn, a tilt past half a turn, a quaternion whose length is not 1 within 5 %).
[[nodiscard]] Result<HidReport> decode_hid_report(const HidReportLayout& layout, std::span<const std::uint8_t> report);

/// Makes one curve of angles that wrap at pi.
class YawUnwrapper {
 public:
  float unwrap(float yaw);

 private:
  bool started_ = false;
  float last_ = 0.0F;  // unwrapped
};

}  // namespace touchline
