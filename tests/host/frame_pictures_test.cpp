// SPDX-License-Identifier: Apache-2.0
// Where --frames writes: one file a frame, and never over what was read.
#include "platform/host/frame_pictures.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "platform/host/command_line.h"
#include "tests/host/temp_folder.h"

namespace touchline::host {
namespace {

DataSet set_of(const std::filesystem::path& folder, const std::string& name, const std::vector<std::string>& images) {
  DataSet set;
  set.folder = folder;
  set.name = name;
  for (const auto& image : images) {
    DataFrame frame;
    frame.image = image;
    frame.path = folder / image;
    set.frames.push_back(frame);
  }
  return set;
}

std::string refusal(const DataSet& set, const std::filesystem::path& out) {
  return error_of([&] { refuse_to_overwrite({set}, out.string()); });
}

}  // namespace

TEST_CASE("every frame has a picture's name of its own") {
  const DataSet set = set_of("x", "x", {"a/000.jpg", "a/000-2.jpg", "b/000.jpg", "b/000-2.jpg", "c/000.jpg"});
  const auto names = picture_names(set.frames);
  CHECK(names[0] == "000.png");
  CHECK(names[1] == "000-2.png");
  CHECK(std::set<std::string>(names.begin(), names.end()).size() == 5);
}

TEST_CASE("pictures never go over the images or among them, by whatever path") {
  const TempFolder folder;
  folder.write("my/images/0.png", "x");
  const DataSet set = set_of(folder.path() / "my", "images", {"images/0.png"});
  CHECK(contains(refusal(set, folder.path() / "my"), "would go into"));
  CHECK(contains(refusal(set, folder.path() / "my"), "choose another --frames folder"));
  CHECK(contains(refusal(set, folder.path() / "my/../my/./"), "among the images that are read"));
  std::filesystem::create_directory_symlink(folder.path() / "my", folder.path() / "link");
  CHECK(contains(refusal(set, folder.path() / "link"), "among the images that are read"));
  CHECK(refusal(set, folder.path() / "out").empty());
  CHECK(refusal(set, "").empty());
  // An earlier run's place, where a link leads back to the image.
  folder.write("out/images/other", "");
  std::filesystem::create_hard_link(folder.path() / "my/images/0.png", folder.path() / "out/images/0.png");
  CHECK(contains(refusal(set, folder.path() / "out"), "would be written over the image"));
}

TEST_CASE("locate and evaluate refuse before the first picture is written") {
  const TempFolder folder;
  folder.write("my/dataset.toml",
               "name = \"my\"\nfield = \"small-2026\"\n[camera]\nwidth = 320\nheight = 240\nmodel = \"equidistant\"\n"
               "focal_px = 100\nmax_theta_deg = 90\n[mount]\nheight_m = 0.5\n");
  const auto image = folder.path() / "my/0.png";
  write_png(image, test_picture(320, 240));
  folder.write("my/frames.jsonl", "{\"image\": \"0.png\"}\n");
  const std::string before = folder.read("my/0.png");
  const std::string set = (folder.path() / "my").string();
  const std::string out = folder.path().string();
  for (const auto& command : {std::vector<std::string>{"locate", "--camera", set, image.string(), "--frames", out},
                              std::vector<std::string>{"evaluate", set, "--frames", out}}) {
    std::vector<const char*> argv{"touchline"};
    for (const auto& word : command) argv.push_back(word.c_str());
    std::ostringstream output;
    std::ostringstream errors;
    CHECK(touchline_main(static_cast<int>(argv.size()), argv.data(), output, errors) == 2);
    CHECK(contains(errors.str(), "among the images that are read; choose another --frames folder"));
    CHECK(folder.read("my/0.png") == before);
  }
}

}  // namespace touchline::host
