// SPDX-License-Identifier: Apache-2.0
// The tables of the robot's devices: camera, lens, mount, IMU, gait link, panel.
#include <sstream>

#include "platform/host/chain_tables.h"
#include "platform/host/dataset.h"
#include "platform/sbc/goal_yaw_file.h"
#include "platform/sbc/robot_file_tables.h"

namespace touchline::sbc {
namespace {

/// `low` is the least that a fixed one may be.
CameraControl read_control(KeyReader& table, const char* mode_key, const char* value_key, int low, int high) {
  using Mode = CameraControl::Mode;
  constexpr Mode modes[] = {Mode::leave, Mode::automatic, Mode::fixed};
  CameraControl control;
  control.mode = modes[table.choice(mode_key, {"leave", "auto", "fixed"}, 0)];
  const bool has_value = table.has(value_key);
  control.value = table.integer(value_key, 0, high, 0);
  if (control.mode == Mode::fixed && control.value < low) {
    table.fail(value_key, std::string(has_value ? "is 0" : "is missing") + "; a fixed control needs its value");
  }
  if (control.mode != Mode::fixed && control.value != 0) {
    table.fail(value_key, std::string("is not used; set ") + mode_key + " = \"fixed\", or leave it out");
  }
  return control;
}

/// A name that is used cannot be empty.
std::string read_name(KeyReader& table, const char* key, const std::string& fallback, bool used) {
  std::string name = table.text(key, fallback);
  if (used && name.empty()) table.fail(key, "is empty; see `touchline devices` for what is plugged in");
  return name;
}

/// Of a coefficient, as the example has it: nothing but 0, and 1 for the linear term of b.
bool is_default(const char* key, const std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] != (std::string_view(key) == "b" && i == 1 ? 1.0 : 0.0)) return false;
  }
  return true;
}

/// Coefficients that stand in the file, but belong to another model than the one that is set.
void refuse_unused_coefficients(KeyReader& table, LensModel model) {
  for (const host::LensKeyOwner& owner : host::lens_key_owners) {
    if (model == owner.model || !table.has(owner.key)) continue;
    const bool list = owner.model == LensModel::polynomial;
    const auto values = list ? table.numbers(owner.key, 1, 8) : std::vector{table.number(owner.key, -1e9, 1e9, 0.0)};
    if (is_default(owner.key, values)) continue;
    table.fail(owner.key, std::string("is of model = \"") + owner.name +
                              "\", but another one is set; set that model, or leave the key out");
  }
}

/// What the lens's own check cannot know: the size of the picture, and what stands in the file.
void check_lens(KeyReader& table, const RobotFile& file) {
  const LensParameters& lens = file.robot.lens;
  const auto far = [](float centre, int size) {
    const auto side = static_cast<float>(size);
    return centre < -side || centre > 2.0F * side;
  };
  if (far(lens.cx, file.camera.width)) {
    table.fail(table.either("cx_px", "cx"), "is far outside the picture, which is " +
                                                std::to_string(file.camera.width) +
                                                " pixels wide; check it against the lens's calibration");
  }
  if (far(lens.cy, file.camera.height)) {
    table.fail(table.either("cy_px", "cy"), "is far outside the picture, which is " +
                                                std::to_string(file.camera.height) +
                                                " pixels high; check it against the lens's calibration");
  }
  const bool pinhole =
      lens.model == LensModel::rectilinear || lens.model == LensModel::barrel || lens.model == LensModel::polynomial;
  if (pinhole && table.number("max_theta_deg", 1.0, 180.0, 1.0) >= 90.0) {
    table.fail("max_theta_deg",
               "is 90 or more, which a lens of this model never sees; choose less, or the model of a "
               "fish-eye lens");
  }
  refuse_unused_coefficients(table, lens.model);
}

std::string shown(float value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

/// What the data set knows: size, lens, mount and field. Keys of the file come before it.
void adopt_dataset(RobotFile& file) {
  const host::DataSet set = host::read_dataset(file.replay_folder);
  file.camera.width = set.camera.width;
  file.camera.height = set.camera.height;
  file.camera.format = PixelFormat::rgb24;
  file.robot.lens = set.camera.lens;
  file.robot.field = set.field;
  CameraMount& mount = file.robot.mount;
  mount.x = set.camera.mount.x;
  mount.y = set.camera.mount.y;
  mount.height = set.camera.mount.height;
  mount.yaw = set.camera.mount.yaw;
  mount.pitch = set.camera.mount.pitch;
  mount.roll = set.camera.mount.roll;
  file.robot.goal_yaw_known = true;  // a data set's yaw counts from the goal's
  file.imu_backend = ImuBackend::replay;
  file.gait_backend = GaitBackend::replay;
}

HidField read_hid_field(KeyReader& parent, const char* key, bool present, bool numbered) {
  KeyReader table = parent.inner(key);
  HidField field;
  field.present = present;
  field.offset = static_cast<std::uint8_t>(table.integer("offset", 0, 63, 0));
  if (present && numbered && field.offset == 0) {
    table.fail("offset", "is 0, where the report id is (it is 0 when left out, too); say where the number begins");
  }
  constexpr HidNumber types[] = {HidNumber::int16, HidNumber::int32, HidNumber::float32};
  field.number = types[table.choice("type", {"int16", "int32", "float32"}, 0)];
  field.big_endian = table.flag("big_endian", false);
  field.scale = table.real("scale", -1e9, 1e9, 1.0F);
  field.unit = table.choice("unit", {"rad", "deg"}, 0) == 1 ? AngleUnit::degree : AngleUnit::radian;
  field.inverted = table.flag("inverted", false);
  table.finish();
  return field;
}

void read_custom_layout(KeyReader& table, HidReportLayout& layout) {
  layout.report_id = static_cast<std::uint8_t>(table.integer("report_id", 0, 255, layout.report_id));
  layout.length = static_cast<std::uint8_t>(table.integer("report_length", 0, 64, layout.length));
  for (const auto& [key, field] : {std::pair{"yaw", &layout.yaw}, std::pair{"roll", &layout.roll},
                                   std::pair{"pitch", &layout.pitch}, std::pair{"yaw_rate", &layout.yaw_rate}}) {
    const bool given = table.has(key);
    const HidField read = read_hid_field(table, key, given, layout.report_id != 0);
    if (given) *field = read;
  }
  const float scale = table.real("quaternion_scale", 1e-9, 1e9, 1e-4F);
  for (HidField& part : layout.q) part.scale = scale;
  const std::vector<std::string> axes{"+x", "-x", "+y", "-y", "+z", "-z"};
  layout.forward =
      static_cast<SensorAxis>(table.choice("forward_axis", axes, static_cast<std::size_t>(layout.forward)));
  layout.up = static_cast<SensorAxis>(table.choice("up_axis", axes, static_cast<std::size_t>(layout.up)));
  const bool has_start = table.has("start_report");
  const std::vector<double> start = table.numbers("start_report", 0, layout.start_report.size());
  if (!has_start) return;
  layout.start_report_size = static_cast<std::uint8_t>(start.size());
  for (std::size_t i = 0; i < start.size(); ++i) {
    if (start[i] < 0.0 || start[i] > 255.0)
      table.fail("start_report", "holds a number that is no byte; write 0 to 255");
    layout.start_report[i] = static_cast<std::uint8_t>(start[i]);
  }
}

}  // namespace

void read_camera(KeyReader table, RobotFile& file, const std::filesystem::path& folder) {
  V4l2CameraConfig& camera = file.camera;
  file.camera_backend =
      table.choice("backend", {"v4l2", "replay"}, 0) == 1 ? CameraBackend::replay : CameraBackend::v4l2;
  const std::string replay = table.text("replay_folder", "");
  file.replay_loops = table.integer("replay_loops", 1, 1000000, 1);
  if (file.camera_backend == CameraBackend::replay) {
    if (replay.empty()) table.fail("replay_folder", "is missing; name the data set to play");
    file.replay_folder = std::filesystem::path(replay).is_absolute() ? std::filesystem::path(replay) : folder / replay;
    adopt_dataset(file);
  }
  camera.device = read_name(table, "device", camera.device, file.camera_backend == CameraBackend::v4l2);
  camera.input = table.integer("input", -1, 63, camera.input);
  camera.width = table.integer("width_px", 16, max_frame_width, camera.width);
  camera.height = table.integer("height_px", 16, max_frame_height, camera.height);
  constexpr PixelFormat formats[] = {PixelFormat::yuyv, PixelFormat::rgb24, PixelFormat::bgr24, PixelFormat::rgb565};
  const std::size_t own = file.camera_backend == CameraBackend::replay ? 1 : 0;
  camera.format = formats[table.choice("format", {"yuyv", "rgb24", "bgr24", "rgb565"}, own)];
  camera.rate_hz = table.number("rate_hz", 0.0, 500.0, camera.rate_hz);
  camera.exposure = read_control(table, "exposure", "exposure_100us", 1, 100000);
  camera.gain = read_control(table, "gain", "gain_value", 0, 100000);
  camera.white_balance = read_control(table, "white_balance", "white_balance_kelvin", 1, 20000);
  RobotConfig& robot = file.robot;
  robot.camera_delay = table.milliseconds("delay_ms", -100.0, 1000.0, robot.camera_delay);
  robot.camera_stall = table.milliseconds("stall_ms", 100.0, 60000.0, robot.camera_stall);
  robot.black_below = static_cast<std::uint8_t>(table.integer("black_below", 0, 255, robot.black_below));
  if (camera.format == PixelFormat::yuyv && camera.width % 2 != 0)
    table.fail("width_px", "is odd; YUYV has pixels in pairs");
  robot.vision.frame_width = camera.width;
  robot.vision.frame_height = camera.height;
  table.finish();
}

void read_lens(KeyReader table, RobotFile& file) {
  LensParameters& lens = file.robot.lens;
  const bool replayed = file.camera_backend == CameraBackend::replay;
  if (!replayed) {  // a plain lens of 90 degrees across, until the robot's is known
    lens.focal_px = static_cast<float>(file.camera.width) * 0.5F;
    lens.cx = static_cast<float>(file.camera.width) * 0.5F;
    lens.cy = static_cast<float>(file.camera.height) * 0.5F;
    lens.max_theta = radians(70.0F);
    lens.model = LensModel::rectilinear;
  }
  const LensParameters plain = lens;
  host::read_lens(table, true, lens);
  check_lens(table, file);
  table.finish();
  if (!replayed && lens.model == plain.model && lens.focal_px == plain.focal_px && lens.cx == plain.cx &&
      lens.cy == plain.cy && lens.max_theta == plain.max_theta) {
    file.notes.push_back("[lens] is the default, a plain lens with model = \"rectilinear\" and focal_px = " +
                         shown(lens.focal_px) + "; calibrate yours");
  }
}

void read_mount(KeyReader table, RobotFile& file) {
  CameraMount& mount = file.robot.mount;
  const CameraMount rest{};
  CameraPose camera{mount.x, mount.y, mount.height, mount.yaw, mount.pitch, mount.roll};
  host::read_mount(table, true, camera);
  mount.x = camera.x;
  mount.y = camera.y;
  mount.height = camera.height;
  mount.yaw = camera.yaw;
  mount.pitch = camera.pitch;
  mount.roll = camera.roll;
  mount.neck.x = table.real("neck_x_m", -2.0, 2.0, mount.neck.x);
  mount.neck.y = table.real("neck_y_m", -2.0, 2.0, mount.neck.y);
  mount.neck.z = table.real("neck_height_m", 0.0, 3.0, mount.neck.z);
  mount.tilt_pivot.x = table.real("pivot_x_m", -2.0, 2.0, mount.tilt_pivot.x);
  mount.tilt_pivot.y = table.real("pivot_y_m", -2.0, 2.0, mount.tilt_pivot.y);
  mount.tilt_pivot.z = table.real("pivot_height_m", 0.0, 3.0, mount.tilt_pivot.z);
  file.robot.fixed_head = table.flag("fixed_head", file.robot.fixed_head);
  table.finish();
  if (file.camera_backend != CameraBackend::replay && mount.height == rest.height && mount.pitch == rest.pitch &&
      mount.roll == rest.roll && mount.yaw == rest.yaw && mount.x == rest.x && mount.y == rest.y) {
    file.notes.push_back("[mount] is the default, height_m = " + shown(mount.height) +
                         " and pitch_deg = 0; measure yours");
  }
}

void read_imu(KeyReader table, RobotFile& file) {
  constexpr ImuBackend backends[] = {ImuBackend::none, ImuBackend::hidapi, ImuBackend::replay};
  file.imu_backend =
      backends[table.choice("backend", {"none", "hidapi", "replay"}, static_cast<std::size_t>(file.imu_backend))];
  file.imu.device = table.text("device", "1209:0001");
  const std::size_t profile = table.choice("profile", {"vendor", "sensor_page", "custom"}, 0);
  HidReportLayout& layout = file.imu.layout;
  layout = profile == 0 ? vendor_report_layout() : profile == 1 ? sensor_page_layout() : HidReportLayout{};
  read_custom_layout(table, layout);
  RobotConfig& robot = file.robot;
  robot.goal_yaw_known = table.has("goal_yaw_deg") || robot.goal_yaw_known;
  robot.goal_yaw = table.angle("goal_yaw_deg", -36000.0, 36000.0, robot.goal_yaw);
  file.imu_keeps_zero = table.flag("keeps_zero", file.imu_keeps_zero);
  robot.imu_stale = table.milliseconds("stale_ms", 10.0, 10000.0, robot.imu_stale);
  robot.has_imu = file.imu_backend != ImuBackend::none;
  if (file.imu_backend == ImuBackend::hidapi) {
    if (const char* error = hid_device_error(file.imu.device))
      table.fail("device", std::string("is no name: ") + error);
    if (const char* error = layout_error(layout)) table.fail("profile", std::string("cannot be read: ") + error);
  }
  if (file.imu_backend == ImuBackend::hidapi && file.camera_backend == CameraBackend::replay) {
    table.fail(
        "backend",
        "is \"hidapi\", but the camera is replayed, and that by a clock of its own; write \"replay\" or \"none\"");
  }
  if (file.imu_backend == ImuBackend::replay && file.camera_backend != CameraBackend::replay) {
    table.fail("backend", "is \"replay\", but the camera is not replayed; set camera.backend as well");
  }
  table.finish();
}

void read_gait(KeyReader table, RobotFile& file) {
  constexpr GaitBackend backends[] = {GaitBackend::none, GaitBackend::serial, GaitBackend::replay};
  file.gait_backend =
      backends[table.choice("backend", {"none", "serial", "replay"}, static_cast<std::size_t>(file.gait_backend))];
  file.gait.device = read_name(table, "device", file.gait.device, file.gait_backend == GaitBackend::serial);
  file.gait.baud = table.integer("baud", 1, 4000000, file.gait.baud);
  if (!is_known_baud(file.gait.baud)) table.fail("baud", "is no rate of a serial port; try 115200, 460800 or 1000000");
  file.gait.transport = table.milliseconds("transport_ms", 0.0, 1000.0, file.gait.transport);
  RobotConfig& robot = file.robot;
  robot.gait_stale = table.milliseconds("stale_ms", 10.0, 10000.0, robot.gait_stale);
  robot.motion_limits.speed = table.real("max_speed_mps", 0.1, 20.0, robot.motion_limits.speed);
  robot.motion_limits.turn_rate = table.angle("max_turn_deg_per_s", 10.0, 3600.0, robot.motion_limits.turn_rate);
  robot.unknown_speed = table.real("unknown_speed_mps", 0.0, 5.0, robot.unknown_speed);
  robot.unknown_turn = table.angle("unknown_turn_deg_per_s", 0.0, 360.0, robot.unknown_turn);
  robot.has_gait = file.gait_backend != GaitBackend::none;
  if (file.gait_backend == GaitBackend::serial && file.camera_backend == CameraBackend::replay) {
    table.fail(
        "backend",
        "is \"serial\", but the camera is replayed, and that by a clock of its own; write \"replay\" or \"none\"");
  }
  if (file.gait_backend == GaitBackend::replay && file.camera_backend != CameraBackend::replay) {
    table.fail("backend", "is \"replay\", but the camera is not replayed; set camera.backend as well");
  }
  table.finish();
}

void read_panel(KeyReader table, RobotFile& file, const std::filesystem::path& folder) {
  GpioLinesConfig& panel = file.panel;
  file.panel_backend = table.choice("backend", {"none", "gpiod"}, 0) == 1 ? PanelBackend::gpiod : PanelBackend::none;
  panel.chip = read_name(table, "chip", panel.chip, file.panel_backend == PanelBackend::gpiod);
  panel.button_line = table.integer("button_line", -1, 1023, panel.button_line);
  panel.button_active_low = table.flag("button_active_low", panel.button_active_low);
  panel.button_pull_up = table.flag("button_pull_up", panel.button_pull_up);
  panel.led_line = table.integer("led_line", -1, 1023, panel.led_line);
  panel.led_active_low = table.flag("led_active_low", panel.led_active_low);
  file.button.debounce = table.milliseconds("debounce_ms", 0.0, 1000.0, file.button.debounce);
  file.button.long_press = table.milliseconds("long_press_ms", 100.0, 10000.0, file.button.long_press);
  file.goal_yaw_file = goal_yaw_path(table.text("state_file", ""), folder);
  file.robot.has_panel = file.panel_backend != PanelBackend::none;
  if (file.robot.has_panel && panel.button_line < 0 && panel.led_line < 0) {
    table.fail("button_line", "and led_line are both missing; give one, or set backend = \"none\"");
  }
  if (panel.button_line >= 0 && panel.button_line == panel.led_line) {
    table.fail("led_line", "is the button's line, too; a line is one of the two");
  }
  table.finish();
}

}  // namespace touchline::sbc
