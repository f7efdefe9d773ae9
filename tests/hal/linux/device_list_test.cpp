// SPDX-License-Identifier: Apache-2.0
// What `touchline devices` lists, against fakes of both libraries.
#include "hal/linux/device_list.h"

#include <doctest/doctest.h>

#include "tests/support/fake_hidapi.h"
#include "tests/support/fake_v4l2.h"

namespace touchline {
namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("cameras are listed with path, name and formats, and closed again") {
  fake::reset_v4l2();
  fake::v4l2().devices = {{"/dev/video2", "Lens: Top"}};
  const std::string text = list_cameras();
  CHECK(contains(text, "  /dev/video2  \"Lens: Top\"\n"));
  CHECK(contains(text, "    fake:"));
  CHECK_FALSE(contains(text, "(converted)"));
  fake::v4l2().emulated = true;
  CHECK(contains(list_cameras(), "fake (converted):"));
  fake::v4l2().capabilities = 0x04000000;  // streams, but captures nothing: a metadata node
  CHECK(list_cameras().empty());
  fake::v4l2().present = false;
  CHECK(list_cameras().empty());
  CHECK(fake::v4l2().open_handles == 0);
  fake::reset_v4l2();
}

TEST_CASE("HID devices are listed with the name that the config wants, and the list is freed") {
  fake::reset_hidapi();
  CHECK(list_hid_devices() == "  1209:0001:A1  /dev/hidraw0  Maker IMU\n");
  CHECK(fake::hidapi().open_lists == 0);
  fake::hidapi().present = false;
  CHECK(list_hid_devices().empty());
  fake::hidapi().fail_init = true;
  CHECK(list_hid_devices().empty());
}

}  // namespace
}  // namespace touchline
