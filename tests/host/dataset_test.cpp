// SPDX-License-Identifier: Apache-2.0
// Data-set folders: every key is read, and every mistake names file, line, key and remedy.
#include "platform/host/dataset.h"

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "platform/host/key_reader.h"
#include "tests/host/temp_folder.h"

namespace touchline::host {
namespace {

const std::string good_toml = R"(
name = "tiny"
protocol = "sequence"
field = "acyut-5x3"
[camera]
width = 64
height = 48
model = "equidistant"
focal_px = 20.0
cx = 32.5
cy = 24.0
max_theta_deg = 80.0
[mount]
x_m = 0.01
y_m = -0.02
height_m = 0.58
yaw_deg = 5.0
pitch_deg = 30.0
roll_deg = -2.0
[imu]
goal_yaw_deg = 10.0
)";
const std::string good_line = R"({"image": "images/a.png", "t_s": 0.5, "mount": {"pitch_deg": 31.0}, )"
                              R"("odometry": {"dx_m": 0.1, "dy_m": -0.2, "dtheta_deg": 90}, "imu_yaw_deg": -175, )"
                              R"("truth": {"x_m": -1.2, "y_m": 0.4, "theta_deg": 190, "kidnap": true}})";

void write_set(const TempFolder& folder, const std::string& toml, const std::string& lines) {
  folder.write("dataset.toml", toml);
  folder.write("frames.jsonl", lines);
}
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}
std::string toml_error(const std::string& from, const std::string& to) {
  const TempFolder folder;
  write_set(folder, replaced(good_toml, from, to), good_line + "\n");
  return error_of([&] { (void)read_dataset(folder.path()); });
}
std::string line_error(const std::string& from, const std::string& to) {
  const TempFolder folder;
  write_set(folder, good_toml, "{\"image\": \"images/0.png\", \"t_s\": 0.0}\n" + replaced(good_line, from, to) + "\n");
  return error_of([&] { (void)read_dataset(folder.path()); });
}

TEST_CASE("every key is read, a frame overrides single keys, and missing keys say so") {
  const TempFolder folder;
  write_set(
      folder, good_toml,
      good_line + "\n\n" + R"({"image": "b.jpg", "camera": {"model": "equisolid", "max_theta_deg": 70}})" + "\r\n");
  const DataSet set = read_dataset(folder.path());
  CHECK(set.name == "tiny");
  CHECK(set.protocol == Protocol::sequence);
  CHECK(set.field_name == "acyut-5x3");
  CHECK(set.field.length == doctest::Approx(4.9));
  CHECK(set.warnings.empty());
  REQUIRE(set.frames.size() == 2);

  const DataFrame& a = set.frames[0];
  CHECK(a.path == folder.path() / "images/a.png");
  CHECK(a.line == 1);
  CHECK(a.has_time);
  CHECK(a.time_s == 0.5);
  CHECK(a.camera.width == 64);
  CHECK(a.camera.lens.cx == 32.5F);
  CHECK(a.camera.mount.x == 0.01F);
  CHECK(a.camera.mount.y == -0.02F);
  CHECK(a.camera.mount.height == 0.58F);
  CHECK(degrees(a.camera.mount.yaw) == doctest::Approx(5.0));
  CHECK(degrees(a.camera.mount.pitch) == doctest::Approx(31.0));
  CHECK(degrees(a.camera.mount.roll) == doctest::Approx(-2.0));
  REQUIRE(a.has_odometry);
  CHECK(a.odometry.y == -0.2F);
  CHECK(degrees(a.odometry.theta) == doctest::Approx(90.0));
  REQUIRE(a.has_yaw);
  CHECK(degrees(a.yaw) == doctest::Approx(175.0));  // -175 - 10, wrapped
  REQUIRE(a.has_truth);
  CHECK(degrees(a.truth.theta) == doctest::Approx(-170.0));
  CHECK(a.kidnap);

  const DataFrame& b = set.frames[1];
  CHECK(b.line == 3);
  CHECK(b.camera.lens.model == LensModel::equisolid);
  CHECK(degrees(b.camera.lens.max_theta) == doctest::Approx(70.0));
  CHECK(b.camera.lens.focal_px == 20.0F);
  CHECK(degrees(b.camera.mount.pitch) == doctest::Approx(30.0));
  CHECK_FALSE(b.has_time);
  CHECK_FALSE(b.has_odometry);
  CHECK_FALSE(b.has_yaw);
  CHECK_FALSE(b.has_truth);
}

TEST_CASE("lens coefficients reach their model") {
  const TempFolder folder;
  write_set(folder,
            replaced(good_toml, "\"equidistant\"", "\"kannala_brandt\"\nk1 = 0.01\nk2 = 0.002\nk3 = 0.0\nk4 = 0.0"),
            "{\"image\": \"a.png\"}\n");
  const DataSet set = read_dataset(folder.path());
  CHECK(set.camera.lens.model == LensModel::kannala_brandt);
  CHECK(set.camera.lens.k[0] == 0.01F);
  CHECK(set.camera.lens.k[1] == 0.002F);
  CHECK(contains(toml_error("\"equidistant\"", "\"kannala_brandt\""), "[camera] k1: is missing"));
  CHECK(contains(toml_error("\"equidistant\"", "\"barrel\""), "[camera] alpha: is missing"));
  CHECK(contains(toml_error("\"equidistant\"", "\"polynomial\""), "[camera] a: is missing"));
  CHECK(contains(toml_error("\"equidistant\"", "\"polynomial\"\na = [0, 1, nan]"), "[camera] a: holds NaN"));
  const std::string folded =
      toml_error("\"equidistant\"", "\"kannala_brandt\"\nk1 = -1.0\nk2 = 0.0\nk3 = 0.0\nk4 = 0.0");
  CHECK(contains(folded, "[camera] model: these lens parameters do not fit"));
}

TEST_CASE("a free field is read; unknown keys are told with the nearest right one") {
  const TempFolder folder;
  const std::string field =
      "\n[field]\nlength = 6.0\nwidth = 4.0\nline_width = 0.05\ncircle_radius = 0.6\ngoal_area_depth = 0.6\n"
      "goal_area_width = 2.2\ngoal_width = 1.6\ngoal_height = 1.0\npost_diameter = 0.1\nborder = 0.5\npenalty_mrk = "
      "1.0\n";
  const std::string without = replaced(good_toml, "field = \"acyut-5x3\"", "");
  write_set(folder, without + field, "{\"image\": \"a.png\"}\n");
  const DataSet set = read_dataset(folder.path());
  CHECK(set.field.length == 6.0F);
  CHECK(set.field.goal_area_width == 2.2F);
  CHECK(set.field.penalty_area_depth == 0.0F);
  CHECK(set.field.penalty_mark == 0.0F);
  REQUIRE(set.warnings.size() == 1);
  CHECK(contains(set.warnings[0], "[field] penalty_mrk: unknown key; did you mean penalty_mark?"));
  write_set(folder, without + replaced(field, "goal_area_width = 2.2", "goal_area_width = 5.0"),
            "{\"image\": \"a.png\"}\n");
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path()); }), "[field] goal_area_width: does not fit"));
}

TEST_CASE("mistakes in dataset.toml name file, key and remedy") {
  CHECK(contains(toml_error("height_m = 0.58", "height_m = -0.58"),
                 "dataset.toml:16: [mount] height_m: is -0.58, outside 0.01 to 10"));
  CHECK(contains(toml_error("height_m = 0.58", "height_m = -0.58"), "height above the carpet in metres"));
  CHECK(contains(toml_error("height_m = 0.58", ""), "[mount] height_m: is missing"));
  CHECK(contains(toml_error("pitch_deg = 30.0", "pitch_deg = nan"), "[mount] pitch_deg: is NaN"));
  CHECK(contains(toml_error("focal_px = 20.0", "focal_px = \"20\""), "[camera] focal_px: is \"20\", not a number"));
  CHECK(contains(toml_error("focal_px = 20.0", ""), "[camera] focal_px: is missing"));
  CHECK(contains(toml_error("width = 64", "width = 64.5"), "[camera] width: is 64.5, not a whole number"));
  CHECK(contains(toml_error("width = 64", "width = 64000"), "outside 16 to 1280"));
  const std::string model = toml_error("equidistant", "equidistent");
  CHECK(contains(model, "[camera] model: \"equidistent\" is not known; known are equidistant, equisolid"));
  CHECK(contains(model, "did you mean equidistant?"));
  CHECK(contains(toml_error("acyut-5x3", "acyut-5x4"), "did you mean acyut-5x3?"));
  CHECK(contains(toml_error("\"sequence\"", "\"sequenze\""), "did you mean sequence?"));
  CHECK(contains(toml_error("field = \"acyut-5x3\"", "field = 3"), "dataset.toml:4: field: is 3"));
  CHECK(contains(toml_error("field = \"acyut-5x3\"", ""), "field: is missing; name a preset"));
  CHECK(contains(toml_error("width = 64", "width = = 64"), "dataset.toml:6: not valid TOML"));
}

TEST_CASE("a key or table that is misspelt is named, also where it is the reason of an error") {
  const std::string table = toml_error("[camera]", "[kamera]");
  CHECK(contains(table, "dataset.toml: camera: is missing; write [camera]"));
  CHECK(contains(table, "dataset.toml:5: kamera: unknown table; did you mean camera?"));
  CHECK(contains(toml_error("[mount]", "[munt]"), "munt: unknown table; did you mean mount?"));
  const std::string key = toml_error("focal_px", "focal_pix");
  CHECK(contains(key, "[camera] focal_px: is missing"));
  CHECK(contains(key, "did you mean it by focal_pix?"));
}

TEST_CASE("an unknown key is told once, with a count") {
  const TempFolder folder;
  const std::string line = R"({"image": "a.png", "mount": {"pich_deg": 1}})";
  write_set(folder, replaced(good_toml, "roll_deg", "rol_deg"), line + "\n" + line + "\n" + line + "\n");
  const DataSet set = read_dataset(folder.path());
  REQUIRE(set.warnings.size() == 2);
  CHECK(contains(set.warnings[0], "[mount] rol_deg: unknown key; did you mean roll_deg? (not used)"));
  CHECK(contains(
      set.warnings[1],
      "frames.jsonl:1: [mount] pich_deg: unknown key; did you mean pitch_deg? (not used; 2 more lines have it)"));
}

TEST_CASE("mistakes in frames.jsonl name the line too") {
  CHECK(contains(line_error("\"pitch_deg\": 31.0", "\"height_m\": -1"),
                 "frames.jsonl:2: [mount] height_m: is -1, outside"));
  CHECK(contains(line_error("\"pitch_deg\": 31.0", "\"pitch_deg\": NaN"), "frames.jsonl:2: not valid JSON"));
  CHECK(
      contains(line_error("\"imu_yaw_deg\": -175", "\"imu_yaw_deg\": null"), ":2: imu_yaw_deg: is null, not a number"));
  CHECK(contains(line_error("-0.2", "1e999"), ":2: "));
  CHECK(contains(line_error("{\"image\"", "{\"image"), ":2: not valid JSON"));
  CHECK(contains(line_error("\"image\": \"images/a.png\",", ""), ":2: image: is missing"));
  CHECK(contains(line_error("\"t_s\": 0.5", "\"t_s\": -0.5"), "put the frames in the order of time"));
  CHECK(contains(line_error("\"dx_m\": 0.1", "\"dx\": 0.1"), "frames.jsonl:2: [odometry] dx_m: is missing"));
  CHECK(contains(line_error(good_line, "[1, 2]"), "frames.jsonl:2: expected keys and values here, found [1,2]"));
}

TEST_CASE("folders that are no data set say what is missing") {
  const TempFolder folder;
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path()); }), "the folder is empty"));
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path() / "none"); }), "no such folder"));
  folder.write("dataset.toml", good_toml);
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path() / "dataset.toml"); }), "not a folder"));
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path()); }), "frames.jsonl: no such file"));
  folder.write("frames.jsonl", "\n");
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path()); }), "holds no frame"));
  CHECK(read_dataset_toml(folder.path() / "dataset.toml").camera.width == 64);
}

TEST_CASE("an image that is missing or of another size is an error") {
  const TempFolder folder;
  write_set(folder, good_toml, good_line + "\n");
  const DataSet set = read_dataset(folder.path());
  CHECK(contains(error_of([&] { (void)read_frame_image(set.frames[0]); }), "images/a.png: no such image"));
  folder.write("images/x", "");
  write_png(folder.path() / "images/a.png", test_picture(64, 47));
  CHECK(contains(error_of([&] { (void)read_frame_image(set.frames[0]); }), "is 64x47, but"));
  write_png(folder.path() / "images/a.png", test_picture(64, 48));
  CHECK(read_frame_image(set.frames[0]).width == 64);
}

}  // namespace
TEST_CASE("a dimension that does not fit says its limit, by the name that the file has for it") {
  const auto error = [](const std::string& table) {
    return toml_error("field = \"acyut-5x3\"", "field = { " + table + " }");
  };
  CHECK(contains(error("preset = \"small-2026\", line_width = 0.5"),
                 "[field] line_width: does not fit the rest of the field: it is 0.5, but must be from 0.01 to 0.3"));
  CHECK(contains(error("preset = \"small-2026\", line_width_m = 0.5"), "[field] line_width_m: does not fit"));
  CHECK(contains(error("preset = \"small-2026\", penalty_area_depth = 0"),
                 "or 0 together with penalty_area_width, which is 4;"));
  CHECK(
      contains(error("preset = \"small-2026\", width = 2.5"),
               "[field] goal_area_width: does not fit the rest of the field: it is 3 in the preset, but must be above "
               "0 and below 2.5 (width)"));
  CHECK(contains(error("preset = \"small-2026\", penalty_area_width = 2"), "above 3 (goal_area_width) and below 6"));
}

TEST_CASE("a missing key is found in the misspelt one") {
  CHECK(contains(toml_error("focal_px = 20.0", "focal = 20.0"),
                 "[camera] focal_px: is missing; give the focal length in camera pixels; did you mean it by focal?"));
  CHECK(contains(toml_error("height_m = 0.58", "height = 0.58"), "did you mean it by height?"));
}

TEST_CASE("lens keys of another model, and a principal point outside of the picture, are told") {
  const TempFolder folder;
  write_set(folder, replaced(good_toml, "cx = 32.5", "cx = -5\nk1 = 0.1"),
            "{\"image\": \"a.png\"}\n{\"image\": \"b.png\"}\n");
  const DataSet set = read_dataset(folder.path());
  REQUIRE(set.warnings.size() == 2);
  CHECK(contains(set.warnings[0], "[camera] k1: belongs to the model kannala_brandt and is not used"));
  CHECK(contains(set.warnings[1], "[camera] cx: is -5.0, outside of the picture of 64x48 pixels; check it"));
  CHECK(contains(toml_error("cx = 32.5", "cx_px = -160"),
                 "[camera] cx_px: is -160.0, outside of the picture of 64x48 pixels, and so far that the lens sees"));
}

TEST_CASE("a set without a name has its folder's, by whatever path it is given") {
  const TempFolder folder;
  write_set(folder, replaced(good_toml, "name = ", "# name = "), "{\"image\": \"a.png\"}\n");
  const std::string name = folder.path().filename().string();
  CHECK(read_dataset(folder.path()).name == name);
  CHECK(read_dataset(folder.path() / "").name == name);
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const std::string here = read_dataset(".").name;
  const std::string file = read_dataset_toml("dataset.toml").name;
  std::filesystem::current_path(before);
  CHECK(here == name);
  CHECK(file == name);
  write_set(folder, "name = \"\"\n" + replaced(good_toml, "name = ", "# name = "), "{\"image\": \"a.png\"}\n");
  CHECK(read_dataset(folder.path()).name == name);
}

TEST_CASE("the order of time holds over a line without a time") {
  const TempFolder folder;
  write_set(folder, good_toml,
            "{\"image\": \"a.png\", \"t_s\": 5}\n{\"image\": \"b.png\"}\n{\"image\": \"c.png\", \"t_s\": 1}\n");
  CHECK(contains(error_of([&] { (void)read_dataset(folder.path()); }), "frames.jsonl:3: t_s: is smaller"));
}

TEST_CASE("texts hold no NUL, known keys are told once, and the beginning of a word is enough") {
  CHECK(contains(line_error("images/a.png", "images/a.png\\u0000.txt"), "with a NUL in it"));
  const nlohmann::json table = {{"exposure", 3}, {"zzzzzzzzzzzz", 1}};
  KeyReader keys(table, {"f", 0, nullptr}, "camera");
  (void)keys.integer("gain", 0, 9, 1);
  (void)keys.integer("gain", 0, 9, 1);
  (void)keys.find("exposure");
  CHECK(contains(error_of([&] { keys.finish(); }), "unknown key; known are gain, exposure"));
  CHECK_FALSE(contains(error_of([&] { keys.finish(); }), "gain, gain"));
  CHECK(nearest_word("--part", {"--paper", "--port", "--particles"}) == "--particles");
  const nlohmann::json half = {{"fifo_depth", 4.5}};
  KeyReader vision(half, {"f", 0, nullptr}, "vision");
  CHECK(contains(error_of([&] { (void)vision.integer("fifo_depth", 1, 4, 4); }), "write a whole number from 1 to 4"));
  CHECK(contains(error_of([&] { (void)vision.integer("fifo_depth", 1, 4, "count"); }), "not a whole number; count"));
}

}  // namespace touchline::host
