// SPDX-License-Identifier: Apache-2.0
// What is plugged in, as text for `touchline devices`; each empty when there is none. (GPIO chips: gpio_lines.h.)
#pragma once

#include <string>

namespace touchline {

/// Path, name and the formats with their sizes.
std::string list_cameras();
/// vendor:product:serial, path, maker and product of each HID device.
std::string list_hid_devices();
/// Names of serial ports, the stable ones first.
std::string list_serial_ports();

}  // namespace touchline
