// SPDX-License-Identifier: Apache-2.0
#include "hal/hid_report_codec.h"

#include "hal/byte_reader.h"
#include "hal/crc32.h"
#include "platform/core/elementary.h"
#include "platform/core/geometry.h"

namespace touchline {
namespace {

using Bytes = std::span<const std::uint8_t>;

std::size_t width(HidNumber number) { return number == HidNumber::int16 ? 2 : 4; }
std::size_t end_of(const HidField& field) { return field.present ? field.offset + width(field.number) : 0; }

float raw_value(const HidField& field, Bytes report) {
  switch (field.number) {
    case HidNumber::int16: return static_cast<float>(read_i16(report, field.offset, field.big_endian));
    case HidNumber::int32: return static_cast<float>(read_i32(report, field.offset, field.big_endian));
    case HidNumber::float32: return read_f32(report, field.offset, field.big_endian);
  }
  return 0.0F;
}

float value_of(const HidField& field, Bytes report) {
  const float value = raw_value(field, report) * field.scale;
  const float in_radians = field.unit == AngleUnit::degree ? radians(value) : value;
  return field.inverted ? -in_radians : in_radians;
}

std::size_t bytes_needed(const HidReportLayout& layout) {
  std::size_t needed = layout.report_id != 0 ? 1 : 0;
  const auto include = [&](std::size_t end) { needed = end > needed ? end : needed; };
  for (const HidField& field : layout.q) include(layout.quaternion ? end_of(field) : 0);
  for (const HidField* field : {&layout.yaw, &layout.roll, &layout.pitch, &layout.yaw_rate}) include(end_of(*field));
  if (layout.has_sequence) include(std::size_t{layout.sequence_offset} + 1);
  if (layout.has_valid_bit) include(std::size_t{layout.valid_offset} + 1);
  return needed + (layout.has_crc32 ? 4 : 0);
}

Vec3 axis(SensorAxis which) {
  switch (which) {
    case SensorAxis::plus_x: return {1, 0, 0};
    case SensorAxis::minus_x: return {-1, 0, 0};
    case SensorAxis::plus_y: return {0, 1, 0};
    case SensorAxis::minus_y: return {0, -1, 0};
    case SensorAxis::plus_z: return {0, 0, 1};
    case SensorAxis::minus_z: return {0, 0, -1};
  }
  return {1, 0, 0};
}

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The rotation matrix of a unit quaternion (Kuipers 1999, section 5.14).
Mat3 rotation_of(float x, float y, float z, float w) {
  Mat3 r;
  r.m[0][0] = 1 - 2 * (y * y + z * z), r.m[0][1] = 2 * (x * y - z * w), r.m[0][2] = 2 * (x * z + y * w);
  r.m[1][0] = 2 * (x * y + z * w), r.m[1][1] = 1 - 2 * (x * x + z * z), r.m[1][2] = 2 * (y * z - x * w);
  r.m[2][0] = 2 * (x * z - y * w), r.m[2][1] = 2 * (y * z + x * w), r.m[2][2] = 1 - 2 * (x * x + y * y);
  return r;
}

/// The torso's yaw, pitch and roll from where its forward, left and up axes point in the world.
bool angles_from_quaternion(const HidReportLayout& layout, Bytes report, ImuSample& sample) {
  float q[4];
  for (std::size_t i = 0; i < 4; ++i) q[i] = value_of(layout.q[i], report);
  const float length = math::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0.95F && length < 1.05F)) return false;
  const Mat3 world_from_sensor = rotation_of(q[0] / length, q[1] / length, q[2] / length, q[3] / length);
  const Vec3 forward = multiply(world_from_sensor, axis(layout.forward));
  const Vec3 up = multiply(world_from_sensor, axis(layout.up));
  const Vec3 left = cross(up, forward);
  sample.yaw = math::atan2(forward.y, forward.x);
  sample.pitch = math::asin(-forward.z);
  sample.roll = math::atan2(left.z, up.z);
  sample.has_tilt = true;
  return true;
}

bool angles_from_fields(const HidReportLayout& layout, Bytes report, ImuSample& sample) {
  sample.yaw = value_of(layout.yaw, report);
  sample.has_tilt = layout.roll.present && layout.pitch.present;
  if (sample.has_tilt) {
    sample.roll = value_of(layout.roll, report);
    sample.pitch = value_of(layout.pitch, report);
  }
  // Devices count 0 to 360 or -180 to 180 degrees; a hair more is rounding.
  const bool valid = math::abs(sample.yaw) < 6.30F && math::abs(sample.roll) < 3.15F && math::abs(sample.pitch) < 3.15F;
  if (!valid) return false;  // NaN ends here too
  sample.yaw = wrap_angle(sample.yaw);
  return true;
}

HidField field(std::uint8_t offset, float scale) { return {true, offset, HidNumber::int16, false, scale}; }

}  // namespace

HidReportLayout vendor_report_layout() {
  HidReportLayout layout;
  layout.report_id = 1;
  layout.length = 16;
  layout.yaw = field(2, 1e-4F);
  layout.roll = field(4, 1e-4F);
  layout.pitch = field(6, 1e-4F);
  layout.yaw_rate = field(8, 1e-3F);
  layout.has_sequence = true;
  layout.sequence_offset = 1;
  layout.has_valid_bit = true;
  layout.valid_offset = 10;
  layout.has_crc32 = true;
  return layout;
}

HidReportLayout sensor_page_layout(std::uint8_t report_id) {
  HidReportLayout layout;
  layout.report_id = report_id;
  layout.quaternion = true;
  for (std::uint8_t i = 0; i < 4; ++i) layout.q[i] = field(static_cast<std::uint8_t>(3 + 2 * i), 1e-4F);
  // Selectors count from 1 in the order of the usages: reporting "no events, all events", power "undefined, D0 full".
  layout.start_report = {report_id, 1, 2, 2};
  layout.start_report_size = 4;
  return layout;
}

const char* layout_error(const HidReportLayout& layout) {
  const std::size_t needed = bytes_needed(layout);
  if (!layout.quaternion && !layout.yaw.present) return "the report has neither yaw nor a quaternion";
  if (layout.roll.present != layout.pitch.present) return "roll and pitch come together or not at all";
  if (needed > max_hid_report_bytes) return "a field lies past byte 63, the longest report";
  if (layout.length != 0 && layout.length < needed) return "a field lies past the report's length";
  if (layout.length > max_hid_report_bytes) return "a report has at most 64 bytes";
  if (layout.start_report_size > layout.start_report.size()) return "the start report has at most 16 bytes";
  for (const HidField& part : layout.q) {
    if (layout.quaternion && !part.present) return "the quaternion needs all of x, y, z and w";
  }
  if (layout.quaternion && math::abs(dot(axis(layout.forward), axis(layout.up))) > 0.5F) {
    return "forward and up are the same axis of the sensor";
  }
  return nullptr;
}

Result<HidReport> decode_hid_report(const HidReportLayout& layout, Bytes report) {
  if (report.empty()) return Status::corrupt;
  if (layout.report_id != 0 && report[0] != layout.report_id) return Status::not_ready;
  if (layout.length != 0 ? report.size() != layout.length : report.size() < bytes_needed(layout))
    return Status::corrupt;
  const std::size_t body = report.size() - (layout.has_crc32 ? 4 : 0);
  if (layout.has_crc32 && crc32(report.first(body)) != read_unsigned(report, body, 4)) return Status::corrupt;
  if (layout.has_valid_bit && (report[layout.valid_offset] & 1) == 0) return Status::not_ready;
  HidReport decoded;
  ImuSample& sample = decoded.sample;
  const bool valid =
      layout.quaternion ? angles_from_quaternion(layout, report, sample) : angles_from_fields(layout, report, sample);
  if (!valid) return Status::corrupt;
  sample.has_yaw_rate = layout.yaw_rate.present;
  if (sample.has_yaw_rate) sample.yaw_rate = value_of(layout.yaw_rate, report);
  if (!math::is_finite(sample.yaw_rate)) return Status::corrupt;
  if (layout.has_sequence) decoded.sequence = report[layout.sequence_offset];
  return decoded;
}

float YawUnwrapper::unwrap(float yaw) {
  last_ = started_ ? last_ + angle_difference(yaw, last_) : yaw;
  started_ = true;
  return last_;
}

}  // namespace touchline
