// SPDX-License-Identifier: Apache-2.0
#include "hal/linux/device_list.h"

#include <fcntl.h>
#include <hidapi/hidapi.h>
#include <libv4l2.h>
#include <linux/videodev2.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <sstream>
#include <vector>

namespace touchline {
namespace {

constexpr std::uint32_t max_entries = 64;  // of formats and sizes; a driver that never says "no more" is cut here

void write_sizes(std::ostream& out, int descriptor, std::uint32_t format) {
  for (std::uint32_t index = 0; index < max_entries; ++index) {
    v4l2_frmsizeenum size{};
    size.index = index;
    size.pixel_format = format;
    if (v4l2_ioctl(descriptor, VIDIOC_ENUM_FRAMESIZES, &size) != 0) return;
    if (size.type == V4L2_FRMSIZE_TYPE_DISCRETE) {
      out << " " << size.discrete.width << "x" << size.discrete.height;
      continue;
    }
    const v4l2_frmsize_stepwise& step = size.stepwise;
    out << " any from " << step.min_width << "x" << step.min_height << " to " << step.max_width << "x"
        << step.max_height;
    return;
  }
}

void write_formats(std::ostream& out, int descriptor) {
  for (std::uint32_t index = 0; index < max_entries; ++index) {
    v4l2_fmtdesc format{};
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    format.index = index;
    if (v4l2_ioctl(descriptor, VIDIOC_ENUM_FMT, &format) != 0) return;
    const bool converted = (format.flags & V4L2_FMT_FLAG_EMULATED) != 0;
    out << "    " << reinterpret_cast<const char*>(format.description) << (converted ? " (converted)" : "") << ":";
    write_sizes(out, descriptor, format.pixelformat);
    out << "\n";
  }
}

std::string narrow(const wchar_t* text) {
  std::string result;
  for (; text != nullptr && *text != 0; ++text) result += *text >= 32 && *text < 127 ? static_cast<char>(*text) : '?';
  return result;
}

}  // namespace

std::string list_cameras() {
  std::ostringstream out;
  for (std::uint32_t node = 0; node < max_entries; ++node) {
    const std::string path = "/dev/video" + std::to_string(node);
    const int descriptor = v4l2_open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    v4l2_capability capability{};
    if (v4l2_ioctl(descriptor, VIDIOC_QUERYCAP, &capability) == 0) {
      const bool own = (capability.capabilities & V4L2_CAP_DEVICE_CAPS) != 0;
      const std::uint32_t caps = own ? capability.device_caps : capability.capabilities;
      if ((caps & V4L2_CAP_VIDEO_CAPTURE) != 0) {
        out << "  " << path << "  \"" << reinterpret_cast<const char*>(capability.card) << "\"\n";
        write_formats(out, descriptor);
      }
    }
    v4l2_close(descriptor);
  }
  return out.str();
}

std::string list_hid_devices() {
  std::ostringstream out;
  if (hid_init() != 0) return {};
  hid_device_info* const all = hid_enumerate(0, 0);
  for (const hid_device_info* device = all; device != nullptr; device = device->next) {
    char name[16];
    std::snprintf(name, sizeof name, "%04x:%04x", device->vendor_id, device->product_id);
    const std::string serial = narrow(device->serial_number);
    out << "  " << name << (serial.empty() ? "" : ":") << serial << "  " << device->path << "  "
        << narrow(device->manufacturer_string) << " " << narrow(device->product_string) << "\n";
  }
  hid_free_enumeration(all);
  return out.str();
}

std::string list_serial_ports() {
  std::vector<std::string> stable;
  std::vector<std::string> plain;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator("/dev/serial/by-id", ignored)) {
    stable.push_back(entry.path().string());
  }
  for (const auto& entry : std::filesystem::directory_iterator("/dev", ignored)) {
    const std::string name = entry.path().filename().string();
    for (const char* kind : {"ttyUSB", "ttyACM", "ttyAMA", "ttyS", "ttyTHS"}) {
      if (name.starts_with(kind)) plain.push_back(entry.path().string());
    }
  }
  std::sort(stable.begin(), stable.end());
  std::sort(plain.begin(), plain.end());
  std::ostringstream out;
  for (const std::string& port : stable) out << "  " << port << "\n";
  for (const std::string& port : plain) out << "  " << port << "\n";
  return out.str();
}

}  // namespace touchline
