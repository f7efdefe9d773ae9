// SPDX-License-Identifier: Apache-2.0
// Any HID report by both ready layouts and one of the input's own: no crash, and angles that are let through are
// angles.
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include "hal/hid_report_codec.h"
#include "platform/core/elementary.h"

namespace {

touchline::HidReportLayout own_layout(const std::uint8_t* bytes) {
  using namespace touchline;
  HidReportLayout layout;
  layout.report_id = bytes[0];
  layout.length = bytes[1];
  HidField* const fields[] = {&layout.yaw, &layout.roll, &layout.pitch, &layout.yaw_rate};
  for (int i = 0; i < 4; ++i) {
    const std::uint8_t b = bytes[2 + i];
    *fields[i] = {(b & 1) != 0, bytes[6 + i], static_cast<HidNumber>((b >> 1) % 3),
                  (b & 8) != 0, 1e-3F,        (b & 16) != 0 ? AngleUnit::degree : AngleUnit::radian,
                  (b & 32) != 0};
  }
  layout.has_crc32 = (bytes[10] & 1) != 0;
  layout.has_sequence = (bytes[10] & 2) != 0;
  layout.sequence_offset = bytes[11];
  return layout;
}

void check(const touchline::HidReportLayout& layout, std::span<const std::uint8_t> report) {
  using namespace touchline;
  if (layout_error(layout) != nullptr) return;
  const auto decoded = decode_hid_report(layout, report);
  if (!decoded.ok()) return;
  const ImuSample& sample = decoded.value().sample;
  if (!(math::abs(sample.yaw) <= 3.15F) || !(math::abs(sample.roll) <= 3.15F) || !(math::abs(sample.pitch) <= 3.15F))
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> all(data, size);
  check(touchline::vendor_report_layout(), all);
  check(touchline::sensor_page_layout(), all);
  if (size > 12) check(own_layout(data), all.subspan(12));
  return 0;
}
