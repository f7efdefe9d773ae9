// SPDX-License-Identifier: Apache-2.0
// PNG and JPEG files: what was written comes back, and every cut or foreign file is an error that says so.
#include "platform/host/image_file.h"

#include <doctest/doctest.h>

#include "tests/host/temp_folder.h"

namespace touchline::host {
namespace {

std::span<const std::uint8_t> bytes(const std::string& text, std::size_t count) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), count};
}

TEST_CASE("a PNG comes back bit for bit") {
  const TempFolder folder;
  const RgbImage picture = test_picture(33, 17);
  write_png(folder.path() / "a.png", picture);
  const RgbImage read = read_image(folder.path() / "a.png");
  CHECK(read.width == 33);
  CHECK(read.height == 17);
  CHECK(read.rgb == picture.rgb);
}

TEST_CASE("a PNG that is cut off anywhere is an error") {
  const TempFolder folder;
  write_png(folder.path() / "a.png", test_picture(40, 30));
  const std::string whole = folder.read("a.png");
  // The last chunk (12 bytes) holds no pixels: libpng does not miss it.
  for (std::size_t size = 0; size + 12 < whole.size(); size += 37) {
    CAPTURE(size);
    CHECK_FALSE(error_of([&] { (void)decode_image(bytes(whole, size), "cut.png"); }).empty());
  }
  const std::string half = error_of([&] { (void)decode_image(bytes(whole, whole.size() / 2), "cut.png"); });
  CHECK(contains(half, "cut.png: this PNG cannot be read"));
}

TEST_CASE("a PNG with a flipped byte among its pixels is an error") {
  const TempFolder folder;
  write_png(folder.path() / "a.png", test_picture(40, 30));
  std::string whole = folder.read("a.png");
  whole[whole.size() / 2] = static_cast<char>(whole[whole.size() / 2] ^ 0x10);
  CHECK_FALSE(error_of([&] { (void)decode_image(bytes(whole, whole.size()), "x.png"); }).empty());
}

TEST_CASE("what is missing, empty, foreign or too large is told apart") {
  const TempFolder folder;
  CHECK(contains(error_of([&] { (void)read_image(folder.path() / "none.png"); }), "no such image"));
  CHECK(contains(error_of([&] { (void)read_image(folder.path()); }), "a folder"));
  CHECK(contains(error_of([&] { (void)read_image(folder.write("empty.png", "")); }), "empty"));
  CHECK(contains(error_of([&] { (void)read_image(folder.write("t.png", "hello")); }), "neither a PNG nor a JPEG"));
  write_png(folder.path() / "wide.png", RgbImage(1281, 4));
  CHECK(contains(error_of([&] { (void)read_image(folder.path() / "wide.png"); }), "1281x4"));
  CHECK(contains(error_of([&] { write_png(folder.path() / "no" / "such.png", RgbImage(2, 2)); }), "cannot be written"));
}

TEST_CASE("a JPEG comes back in size and colour, and cut off it is an error and no half picture") {
  const TempFolder folder;
  RgbImage picture(64, 48);
  for (std::size_t i = 0; i < picture.rgb.size(); i += 3) picture.rgb[i] = 200;
  write_jpeg(folder.path() / "a.jpg", picture, 95);
  const RgbImage read = read_image(folder.path() / "a.jpg");
  CHECK(read.width == 64);
  CHECK(read.height == 48);
  CHECK(std::abs(read.at(20, 20)[0] - 200) < 8);
  CHECK(read.at(20, 20)[1] < 8);
  const std::string whole = folder.read("a.jpg");
  for (std::size_t size = 3; size + 2 < whole.size(); size += 23) {  // the last two bytes are the end marker
    CAPTURE(size);
    CHECK(contains(error_of([&] { (void)decode_image(bytes(whole, size), "cut.jpg"); }), "cut.jpg: this JPEG cannot"));
  }
}

}  // namespace
}  // namespace touchline::host
