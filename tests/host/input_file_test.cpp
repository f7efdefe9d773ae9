// SPDX-License-Identifier: Apache-2.0
// Files that a user names by mistake: pipes, devices, folders, huge files, and reads that fail.
#include "platform/host/input_file.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include <sys/stat.h>

#include "platform/host/dataset.h"
#include "platform/host/toml_file.h"
#include "tests/host/temp_folder.h"

namespace touchline::host {

TEST_CASE("a pipe, a device and a folder are refused before they are opened") {
  const TempFolder folder;
  const auto pipe = folder.path() / "pipe.png";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  TomlLines lines;
  for (const auto& path : {pipe, std::filesystem::path("/dev/zero"), std::filesystem::path("/dev/null")}) {
    CAPTURE(path.string());
    const std::string image = error_of([&] { (void)read_image(path); });
    CHECK(contains(image, path.string() + ": is a device or a pipe, not a file; give a PNG or JPEG file"));
    const std::string toml = error_of([&] { (void)read_toml(path, "name a TOML file", lines); });
    CHECK(contains(toml, path.string() + ": is a device or a pipe, not a file; name a TOML file"));
  }
  CHECK(contains(error_of([&] { (void)read_image(folder.path()); }), ": is a folder, not a file"));
}

TEST_CASE("a huge file is refused by its size, and one that is no image by its first bytes") {
  const TempFolder folder;
  const auto movie = folder.write("movie.mp4", "\x89PNG\r\n");
  std::filesystem::resize_file(movie, std::uintmax_t{12} << 30);  // sparse: takes no room
  CHECK(contains(error_of([&] { (void)read_image(movie); }), "movie.mp4: has 12884901888 bytes, more than"));
  const auto text = folder.write("text.png", std::string(1 << 20, 'x'));
  InputFile kind{"image", "remedy", std::size_t{1} << 30};
  std::size_t seen = 0;
  kind.first_bytes = [&seen](std::string_view bytes) {
    seen = bytes.size();
    throw HostError("no");
  };
  CHECK(error_of([&] { (void)read_whole_file(text, kind); }) == "no");
  CHECK(seen == 16);
  kind.first_bytes = {};
  CHECK(read_whole_file(text, kind) == std::string(1 << 20, 'x'));
  CHECK(read_whole_file(folder.write("empty", ""), kind).empty());
}

TEST_CASE("a read that fails is no short file") {
  InputFile kind{"file", "remedy", 1000};
  // The system refuses to read this file at its start.
  if (std::filesystem::exists("/proc/self/mem")) {
    CHECK(contains(error_of([&] { (void)read_whole_file("/proc/self/mem", kind); }), "cannot be read to its end"));
  }
}

TEST_CASE("frames.jsonl that is a folder or a pipe says so") {
  const TempFolder folder;
  folder.write("dataset.toml",
               "field = \"small-2026\"\n[camera]\nwidth = 64\nheight = 48\nmodel = \"equidistant\"\nfocal_px = 20\n"
               "max_theta_deg = 90\n[mount]\nheight_m = 0.5\n");
  std::filesystem::create_directories(folder.path() / "frames.jsonl");
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path()); }), "frames.jsonl: is a folder, not a file"));
  std::filesystem::remove(folder.path() / "frames.jsonl");
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path()); }), "frames.jsonl: no such file"));
  REQUIRE(::mkfifo((folder.path() / "frames.jsonl").c_str(), 0600) == 0);
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path()); }), "frames.jsonl: is a device or a pipe"));
}

}  // namespace touchline::host
