// SPDX-License-Identifier: Apache-2.0
// The robot's file: its example is complete and good, and every mistake is told with file, line, key and remedy.
#include "platform/sbc/robot_file.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <sstream>

#include "platform/host/host_error.h"
#include "platform/processor/fastest_kernels.h"
#include "tests/host/temp_folder.h"

namespace touchline::sbc {
namespace {

std::string read_text(const std::string& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

/// The error that a file of this text gives; empty when it is good.
std::string error_of(const std::string& text) {
  const host::TempFolder temp;
  const auto path = temp.write("robot.toml", text);
  try {
    (void)read_robot_file(path);
    return {};
  } catch (const host::HostError& error) {
    const std::string message = error.what();
    CHECK(message.find(path.string()) == 0);  // the file comes first
    return message.substr(path.string().size());
  }
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST_CASE("the example is good, names every key, and holds the defaults") {
  const std::string path = std::string(TOUCHLINE_SOURCE_DIR) + "/platform/sbc/robot.toml";
  std::vector<std::string> keys;
  const RobotFile example = read_robot_file(path, &keys);
  const std::string text = read_text(path);
  for (const std::string& key : keys) {
    const std::string name = key.substr(key.rfind('.') + 1);
    INFO(doctest::String(key.c_str()));
    CHECK((contains(text, name + " = ") || contains(text, "[" + name + "]")));
  }
  const host::TempFolder temp;
  const RobotFile empty = read_robot_file(temp.write("robot.toml", ""));
  CHECK(example.camera.width == empty.camera.width);
  CHECK(example.camera.rate_hz == empty.camera.rate_hz);
  CHECK(example.robot.vision.kernels.name == fastest_kernels().name);
  CHECK(example.robot.lens.focal_px == empty.robot.lens.focal_px);
  CHECK(example.robot.lens.cx == empty.robot.lens.cx);
  CHECK(example.robot.lens.max_theta == empty.robot.lens.max_theta);
  CHECK(example.robot.field.length == empty.robot.field.length);
  CHECK(example.robot.field.penalty_mark == empty.robot.field.penalty_mark);
  CHECK(example.robot.mount.height == empty.robot.mount.height);
  CHECK(example.robot.mount.neck.z == empty.robot.mount.neck.z);
  CHECK(example.robot.vision.green.hue_low == empty.robot.vision.green.hue_low);
  CHECK(example.robot.vision.green.value_low == empty.robot.vision.green.value_low);
  CHECK(example.robot.vision.yellow_post.hue_high == empty.robot.vision.yellow_post.hue_high);
  CHECK(example.robot.vision.spur_px == empty.robot.vision.spur_px);
  CHECK(example.robot.vision.digestion_radius_px == empty.robot.vision.digestion_radius_px);
  CHECK(example.robot.localizer.particles == empty.robot.localizer.particles);
  CHECK(example.robot.localizer.confident == doctest::Approx(empty.robot.localizer.confident));
  CHECK(example.robot.localizer.motion.theta_per_metre ==
        doctest::Approx(empty.robot.localizer.motion.theta_per_metre).epsilon(0.01));
  CHECK(example.robot.localizer.yaw_sigma == doctest::Approx(empty.robot.localizer.yaw_sigma));
  CHECK(example.robot.prior.sigma_theta == doctest::Approx(empty.robot.prior.sigma_theta));
  CHECK(example.robot.camera_stall == empty.robot.camera_stall);
  CHECK(example.robot.gait_stale == empty.robot.gait_stale);
  CHECK(example.robot.unknown_turn == doctest::Approx(empty.robot.unknown_turn));
  CHECK(example.gait.transport == empty.gait.transport);
  CHECK(example.button.debounce == empty.button.debounce);
  CHECK(example.imu.layout.length == empty.imu.layout.length);
  CHECK(example.realtime.lock_memory == empty.realtime.lock_memory);
  CHECK_FALSE(empty.robot.goal_yaw_known);
  CHECK(empty.output.udp.empty());
}

TEST_CASE("the first mistake of each table is told, and every unknown key") {
  const std::string text = error_of("[mount]\nheight_m = -1\n[vision]\nfifo_depth = 4.5\n[imx]\na = 1\n[gaitt]\n");
  CHECK(contains(text, ":2: [mount] height_m: is -1"));
  CHECK(contains(text, ":4: [vision] fifo_depth: is 4.5; write a whole number from 1 to 4"));
  CHECK(contains(text, "imx: unknown table"));
  CHECK(contains(text, "gaitt: unknown table"));
  CHECK(std::count(text.begin(), text.end(), '\n') == 3);
}

TEST_CASE("lens, mount and field that are the defaults are named, for no robot has them by accident") {
  const host::TempFolder temp;
  const auto assumed = [&](const std::string& text) {
    std::string all;
    for (const auto& sentence : read_robot_file(temp.write("robot.toml", text)).notes) all += sentence + "\n";
    return all;
  };
  const std::string empty = assumed("");
  CHECK(contains(empty, "[lens] is the default, a plain lens with model = \"rectilinear\" and focal_px = 320"));
  CHECK(contains(empty, "[mount] is the default, height_m = 0.5 and pitch_deg = 0"));
  CHECK(contains(empty, "[field] is the default, preset = \"small-2026\""));
  CHECK_FALSE(contains(assumed("[lens]\nfocal_px = 300\n"), "[lens]"));
  CHECK_FALSE(contains(assumed("[mount]\nheight_m = 0.58\n"), "[mount]"));
  CHECK_FALSE(contains(assumed("[field]\npreset = \"small-2026\"\n"), "[field]"));
  CHECK(assumed("[lens]\nfocal_px = 300\n[mount]\npitch_deg = 30\n[field]\npreset = \"kidsize-9x6\"\n").empty());
  const std::string copied = assumed(read_text(std::string(TOUCHLINE_SOURCE_DIR) + "/platform/sbc/robot.toml"));
  CHECK(contains(copied, "[lens]"));  // the example, not yet edited
  CHECK(contains(copied, "[mount]"));
}

TEST_CASE("an unknown key is told with its line and the nearest right one") {
  CHECK(contains(error_of("[camera]\nwith_px = 640\n"), ":2: [camera] with_px: unknown key; did you mean width_px?"));
  CHECK(contains(error_of("\n\n[camra]\n"), ":3: camra: unknown table; did you mean camera?"));
  CHECK(contains(error_of("[realtime]\nxyzzy = 1\n"), "known are lock_memory, priority, cpu"));
  CHECK(contains(error_of("[localization]\nprior = { kind = \"pose\", x = 1 }\n"),
                 ":2: [localization.prior] x: unknown key"));
}

TEST_CASE("wrong types are told") {
  CHECK(contains(error_of("[camera]\nwidth_px = \"640\"\n"),
                 ":2: [camera] width_px: is \"640\", not a number; write a number from 16 to 1280"));
  CHECK(contains(error_of("[camera]\nwidth_px = 640.5\n"), "write a whole number"));
  CHECK(contains(error_of("[camera]\ndevice = 0\n"), ":2: [camera] device: is 0, not a text in quotes"));
  CHECK(contains(error_of("[mount]\nfixed_head = 1\n"), "write true or false"));
  CHECK(contains(error_of("camera = 1\n"), "write a table, [camera]"));
  CHECK(contains(error_of("[output]\nudp = \"127.0.0.1:1\"\n"), "write a list of texts"));
  CHECK(contains(error_of("[output]\nudp = [1]\n"), "write texts in quotes"));
  CHECK(contains(error_of("[lens]\na = 1\n"), "write a list of 1 to 8 numbers"));
  CHECK(contains(error_of("[lens]\na = [1, \"a\", 3, 4]\n"), "write finite numbers"));
  CHECK(contains(error_of("[vision]\nbody_mask_px = [1]\n"), "list of lists"));
}

TEST_CASE("impossible values are told with the range") {
  CHECK(contains(error_of("[mount]\nheight_m = -0.5\n"),
                 ":2: [mount] height_m: is -0.5, outside 0.01 to 10; give the camera's height"));
  CHECK(contains(error_of("[mount]\nheight_m = nan\n"), "[mount] height_m: is NaN"));
  CHECK(contains(error_of("[camera]\nwidth_px = 641\n"), "odd"));
  CHECK(contains(error_of("[camera]\nwidth_px = 99999999999\n"), "outside 16 to 1280"));
  CHECK(contains(error_of("[camera]\nexposure = \"fixed\"\n"), "[camera] exposure_100us: is missing"));
  CHECK(contains(error_of("[camera]\nbackend = \"replay\"\n"), "replay_folder: is missing"));
  CHECK(contains(error_of("[imu]\nbackend = \"replay\"\n"), "camera is not replayed"));
  CHECK(contains(error_of("[gait]\nbackend = \"replay\"\n"), "camera is not replayed"));
  CHECK(contains(error_of("[gait]\nbaud = 12345\n"), "no rate of a serial port"));
  CHECK(contains(error_of("[imu]\nbackend = \"hidapi\"\ndevice = \"mouse\"\n"), ":3: [imu] device: is no name"));
  CHECK(contains(error_of("[imu]\nbackend = \"hidapi\"\nprofile = \"custom\"\n"), "neither yaw nor a quaternion"));
  CHECK(contains(error_of("[imu]\nstart_report = [256]\n"), "no byte"));
  CHECK(contains(error_of("[panel]\nbackend = \"gpiod\"\n"), "led_line are both missing"));
  CHECK(contains(error_of("[lens]\nmodel = \"kannala_brandt\"\n"), "[lens] k1: is missing"));
  CHECK(contains(error_of("[lens]\nmax_theta_deg = 181\n"), "outside 1 to 180"));
  CHECK(contains(error_of("field = \"small\"\n"), ":1: field: \"small\" is not known"));
  CHECK(contains(error_of("[vision]\ngreen_erode_px = 4\n"), "is even"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [1, 2, 3]\n"), "has 3 entries; write 6 numbers"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [1, 2, 3, 4, 5, 256]\n"), "outside 0 to 255"));
  CHECK(contains(error_of("[vision]\nbody_mask_px = [[1, 2, 3]]\n"), "polygon of 3 numbers"));
  CHECK(
      contains(error_of("[vision]\nbody_mask_px = [[1, 2, 3, 4, 1e12, 6]]\n"), "is 1000000000000, outside -10000 to"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [1, 180, 3, 4, 5, 6]\n"), "hue counts 0 to 179"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [1, 20, 30, 4, 5, 6]\n"), "low bound above the high one"));
  CHECK(contains(error_of("[lens]\nmodel = \"fisheye\"\n"), "is not known; known are"));
  CHECK(contains(error_of("[lens]\nmodel = \"equidistance\"\n"), "did you mean equidistant?"));
  CHECK(contains(error_of("[field]\nlength_m = 0.0\n"), ":2: [field] length_m: does not fit the rest of the field"));
  CHECK(contains(error_of("[field]\nlength = 0.0\n"), ":2: [field] length: does not fit the rest of the field"));
  CHECK(contains(error_of("[field]\nwidth = 6.0\nwidth_m = 7.0\n"), ":3: [field] width_m: says the same as width"));
  CHECK(contains(error_of("[lens]\ncx = 6.0\ncx_px = 7.0\n"), ":3: [lens] cx_px: says the same as cx"));
}

TEST_CASE("settings that nothing can do with are told") {
  CHECK(contains(error_of("[camera]\nexposure_100us = 80\n"),
                 ":2: [camera] exposure_100us: is not used; set exposure = \"fixed\", or leave it out"));
  CHECK(contains(error_of("[camera]\ngain = \"auto\"\ngain_value = 3\n"), ":3: [camera] gain_value: is not used"));
  CHECK(contains(error_of("[camera]\nwhite_balance_kelvin = 4000\n"), "[camera] white_balance_kelvin: is not used"));
  CHECK(contains(error_of("[camera]\nexposure = \"fixed\"\nexposure_100us = 0\n"), "exposure_100us: is 0; a fixed"));
  CHECK(error_of("[camera]\ngain = \"fixed\"\n").empty());  // 0 is a gain
  CHECK(contains(error_of("[panel]\nbackend = \"gpiod\"\nbutton_line = 4\nled_line = 4\n"),
                 ":4: [panel] led_line: is the"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [28, 95, 255, 40, 12, 255]\n"), "low bound above the high one"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [28, 95, 40, 255, 200, 12]\n"), "low bound above the high one"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [95, 28, 40, 255, 12, 255]\n"), "low bound above the high one"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [28, 200, 40, 255, 12, 255]\n"), "hue above 179"));
  CHECK(contains(error_of("[vision]\ngreen_hsv = [28.5, 95, 40, 255, 12, 255]\n"), "no whole one"));
  CHECK(error_of("[vision]\nyellow_post_hsv = [170, 10, 110, 255, 60, 255]\n").empty());  // over zero
  CHECK(contains(error_of("[camera]\ndevice = \"\"\n"), ":2: [camera] device: is empty"));
  CHECK(contains(error_of("[gait]\nbackend = \"serial\"\ndevice = \"\"\n"), ":3: [gait] device: is empty"));
  CHECK(contains(error_of("[panel]\nbackend = \"gpiod\"\nchip = \"\"\nled_line = 1\n"), ":3: [panel] chip: is empty"));
  CHECK(contains(error_of("[lens]\nmax_theta_deg = 95\n"), ":2: [lens] max_theta_deg: is 90 or more"));
  CHECK(contains(error_of("[lens]\nmodel = \"equidistant\"\nk1 = 0.1\n"),
                 ":3: [lens] k1: is of model = \"kannala_brandt\", but another one is set"));
  CHECK(contains(error_of("[lens]\nalpha = 1e-6\n"), "[lens] alpha: is of model = \"barrel\""));
  CHECK(contains(error_of("[lens]\nb = [0.0, 0.9]\n"), "[lens] b: is of model = \"polynomial\""));
  CHECK(contains(error_of("[lens]\ncx_px = 9000\n"), ":2: [lens] cx_px: is far outside the picture, which is 640"));
  CHECK(contains(error_of("[lens]\ncy = -900\n"), ":2: [lens] cy: is far outside the picture, which is 480"));
  CHECK(contains(error_of("[imu]\nprofile = \"custom\"\nreport_id = 3\nyaw = {}\n"),
                 "[imu.yaw] offset: is 0, where the"));
  CHECK(error_of("[imu]\nprofile = \"custom\"\nyaw = {}\n").empty());  // no report id
  CHECK(contains(error_of("[camera]\ndevice = 1979-05-27\n"), "[camera] device: is 1979-05-27, not a text"));
  CHECK(contains(error_of("[mount]\nheight_m = -inf\n"), "height_m: is -infinity"));
  CHECK(contains(error_of("[output]\nudp = [\"127.0.0.1:1\",\n\"::1:5000\"]\n"),
                 ":2: [output] udp: \"::1:5000\" does not"));
  const std::string replay = "[camera]\nbackend = \"replay\"\nreplay_folder = \"" + std::string(TOUCHLINE_SOURCE_DIR) +
                             "/fixtures/sim-walk\"\n";
  CHECK(contains(error_of(replay + "[gait]\nbackend = \"serial\"\n"),
                 ":5: [gait] backend: is \"serial\", but the camera is"));
  CHECK(contains(error_of(replay + "[imu]\nbackend = \"hidapi\"\n"),
                 ":5: [imu] backend: is \"hidapi\", but the camera is"));
}

TEST_CASE("coefficients that are left out are 0, but for the first") {
  const host::TempFolder temp;
  const RobotFile file = read_robot_file(temp.write("robot.toml", "[lens]\nmodel = \"kannala_brandt\"\nk1 = 0.01\n"));
  CHECK(file.robot.lens.k[0] == 0.01F);
  CHECK(file.robot.lens.k[1] == 0.0F);
}

TEST_CASE("a key in a wrong table is told its own, and names are those of the example, each once") {
  CHECK(contains(error_of("[lens]\nwidth_px = 640\n"), ":2: [lens] width_px: unknown key; it belongs to [camera]"));
  for (const char* key : {"model", "focal_px", "cx", "cy", "cx_px", "cy_px", "max_theta_deg", "alpha", "a", "b", "k1",
                          "k2", "k3", "k4"}) {
    const std::string name = key;
    CHECK(contains(error_of("[camera]\n" + name + " = 1\n"),
                   ":2: [camera] " + name + ": unknown key; it belongs to [lens]"));
  }
  CHECK(contains(error_of("particles = 100\n"), ":1: particles: unknown key; it belongs to [localization]"));
  CHECK(contains(error_of("[vision]\nstale_ms = 100\n"), "it belongs to [imu], [gait]"));
  CHECK(contains(error_of("[field]\nline_width_ = 0.05\n"), "did you mean line_width_m?"));
  CHECK(contains(error_of("[field]\nlenght = 9\n"), "did you mean length_m?"));
  const std::string known = error_of("xyzzyxyzzy = 1\n");
  CHECK(contains(known, "known are camera, field, lens, mount"));
}

TEST_CASE("poses that go nowhere are noted") {
  const host::TempFolder temp;
  const auto notes = read_robot_file(temp.write("robot.toml", "[output]\nstdout = false\n")).notes;
  CHECK(std::find(notes.begin(), notes.end(), "[output] stdout = false and no udp: the poses go nowhere") !=
        notes.end());
}

TEST_CASE("lengths are taken by the names of the robot's file and by those of a data set") {
  const host::TempFolder temp;
  const RobotFile own = read_robot_file(temp.write("own.toml", "[field]\nlength_m = 8.5\n[lens]\ncx_px = 311.0\n"));
  const RobotFile set = read_robot_file(temp.write("set.toml", "[field]\nlength = 8.5\n[lens]\ncx = 311.0\n"));
  CHECK(own.robot.field.length == 8.5F);
  CHECK(set.robot.field.length == 8.5F);
  CHECK(own.robot.lens.cx == 311.0F);
  CHECK(set.robot.lens.cx == 311.0F);
}

TEST_CASE("what is no TOML, no file, or a folder is told") {
  CHECK(contains(error_of("[camera\nwidth_px = 1\n"), ":1: not valid TOML"));
  CHECK_THROWS_AS((void)read_robot_file("/no/such/robot.toml"), host::HostError);
  CHECK_THROWS_AS((void)read_robot_file("/tmp"), host::HostError);
}

TEST_CASE("a custom IMU layout is read") {
  const host::TempFolder temp;
  const RobotFile file = read_robot_file(temp.write("robot.toml", R"([imu]
backend = "hidapi"
device = "/dev/hidraw3"
profile = "custom"
report_id = 7
report_length = 0
yaw = { offset = 3, type = "float32", big_endian = true, scale = 2.0, unit = "deg", inverted = true }
goal_yaw_deg = 90
)"));
  const HidReportLayout& layout = file.imu.layout;
  CHECK(layout.report_id == 7);
  CHECK(layout.yaw.present);
  CHECK(layout.yaw.offset == 3);
  CHECK(layout.yaw.number == HidNumber::float32);
  CHECK(layout.yaw.big_endian);
  CHECK(layout.yaw.unit == AngleUnit::degree);
  CHECK(layout.yaw.inverted);
  CHECK_FALSE(layout.roll.present);
  CHECK(file.robot.goal_yaw_known);
  CHECK(file.robot.goal_yaw == doctest::Approx(math::half_pi));
}

TEST_CASE("a replayed set brings camera, lens, mount and field along") {
  const RobotFile file = read_robot_file(std::string(TOUCHLINE_SOURCE_DIR) + "/fixtures/robot-replay.toml");
  CHECK(file.camera_backend == CameraBackend::replay);
  CHECK(file.imu_backend == ImuBackend::replay);
  CHECK(file.robot.vision.frame_width == 376);
  CHECK(file.robot.lens.model == LensModel::equidistant);
  CHECK(file.robot.field.length == doctest::Approx(4.9F));
  CHECK(file.robot.vision.line_width_m == file.robot.field.line_width);
  CHECK(file.robot.goal_yaw_known);
}

}  // namespace
}  // namespace touchline::sbc
