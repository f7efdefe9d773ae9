// SPDX-License-Identifier: Apache-2.0
// The arguments of `touchline` (CLI11, in this file alone).
#include "platform/host/command_line.h"

#include <map>
#include <ostream>
#include <sstream>

#include <CLI/CLI.hpp>

#include "platform/host/command_simulate.h"
#include "platform/host/demo.h"
#include "platform/host/host_error.h"
#include "platform/host/robot_commands.h"

namespace touchline::host {
namespace {

const std::map<std::string, LocModel> models{{"full", LocModel::full}, {"paper", LocModel::paper}};
const std::map<std::string, Landmarks> landmark_kinds{
    {"lines", Landmarks::lines}, {"goalposts", Landmarks::goalposts}, {"both", Landmarks::both}};

struct WorkSize {
  std::string text = "320x240";
  void apply(ChainOptions& chain) const {
    chain.work_width = text == "640x480" ? 640 : 320;
    chain.work_height = text == "640x480" ? 480 : 240;
  }
};

void add_chain_options(CLI::App& app, EvaluateOptions& options, WorkSize& work) {
  app.add_option("--landmarks", options.chain.landmarks, "what localization may use")
      ->transform(CLI::CheckedTransformer(landmark_kinds))
      ->type_name("lines|goalposts|both")
      ->default_str("lines");
  app.add_option("--model", options.chain.model, "full: all the picture has; paper: the paper's method alone")
      ->transform(CLI::CheckedTransformer(models))
      ->type_name("full|paper")
      ->default_str("full");
  app.add_option("--work", work.text, "working size of the vision chain")
      ->check(CLI::IsMember({"320x240", "640x480"}))
      ->type_name("320x240|640x480")
      ->capture_default_str();
  app.add_option("--particles", options.chain.particles, "particles of the filter")
      ->check(CLI::Range(10, max_particles))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "seed of the filter's random numbers")->capture_default_str();
  app.add_flag("!--no-yaw", options.use_yaw, "do not use the IMU's yaw: the half of the field stays open");
  app.add_option("--frames", options.frames_out, "write an annotated PNG per frame into this folder");
}

constexpr const char* exit_text = "\nExit status: 0 done, 1 a figure or check missed its mark, 2 bad input or usage.";

struct Commands {
  EvaluateCommand evaluate;
  LocateCommand locate;
  AcceptCommand accept;
  SimulateCommand simulate;
  DemoCommand demo;
  RobotCommand robot;
  WorkSize work;
};

void add_evaluate(CLI::App& app, Commands& commands) {
  auto* sub = app.add_subcommand("evaluate", "localize every frame of data sets and judge the poses");
  sub->add_option("DATASET", commands.evaluate.folders, "folders with dataset.toml, frames.jsonl and images")
      ->required();
  sub->add_flag("--json", commands.evaluate.json, "one JSON line per frame, then the summary, on standard output");
  add_chain_options(*sub, commands.evaluate.options, commands.work);
  sub->footer(std::string("Example: touchline evaluate my-recording --frames out") + exit_text);
}

void add_locate(CLI::App& app, Commands& commands) {
  auto* sub = app.add_subcommand("locate", "localize single images, each from nothing");
  sub->add_option("--camera", commands.locate.camera, "dataset.toml with camera, mount and field")->required();
  sub->add_option("IMAGE", commands.locate.images, "PNG or JPEG files")->required();
  sub->add_flag("--json", commands.locate.json, "one JSON line per image, then the summary, on standard output");
  add_chain_options(*sub, commands.locate.options, commands.work);
  sub->footer(std::string("Example: touchline locate --camera my-recording/dataset.toml my-recording/images/000.png") +
              exit_text);
}

void add_accept(CLI::App& app, Commands& commands) {
  AcceptCommand& command = commands.accept;
  auto* sub = app.add_subcommand("accept", "the acceptance figures beside their targets");
  sub->add_option("FOLDER", command.folder, "holds render-table2, render-hard, render-walk, real-kidsize")->required();
  sub->add_option("--figures", command.figures, "fail where a figure is worse than in this file");
  sub->add_flag("--rewrite", command.rewrite, "write that file anew instead");
  sub->add_option("--output", command.output, "write the figures of this run as JSON");
  sub->add_flag("!--no-simulator", command.simulator, "leave the simulator's rows out");
  sub->add_option("--poses", command.runs.poses, "single poses in the simulator")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  sub->add_option("--walks", command.runs.walks, "walks in the simulator, each field")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  sub->add_option("--threads", command.runs.threads, "runs at the same time")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  sub->footer(std::string("Example: touchline accept data --figures tests/accept/figures.json") + exit_text);
}

void add_simulate(CLI::App& app, Commands& commands) {
  SimulateCommand& command = commands.simulate;
  auto* sub = app.add_subcommand("simulate", "write simulated frames with exact truth as a data set");
  sub->add_option("OUT", command.out, "folder to create")->required();
  sub->add_option("--kind", command.kind, "walk: one run with odometry; poses: single pictures, each from nothing")
      ->check(CLI::IsMember({"walk", "poses"}))
      ->type_name("walk|poses")
      ->capture_default_str();
  sub->add_option("--field", command.field, "a preset")->capture_default_str();
  sub->add_option("--camera", command.camera, "fisheye-185, fisheye-185-qvga, fisheye-140 or fisheye-140-kb")
      ->capture_default_str();
  sub->add_option("--seed", command.seed, "seed of everything")->capture_default_str();
  sub->add_option("--seconds", command.seconds, "length of a walk")
      ->check(CLI::Range(0.1, 3600.0))
      ->capture_default_str();
  sub->add_option("--fps", command.frames_per_second, "frames a second of a walk")
      ->check(CLI::Range(5.0, 100.0))
      ->capture_default_str();
  sub->add_option("--count", command.count, "single pictures")->check(CLI::Range(1, 100000))->capture_default_str();
  sub->add_flag("!--no-yaw", command.yaw, "a robot without an IMU");
  sub->add_option("--kidnap", command.kidnap_at_s, "seconds into the walk; < 0: none")->capture_default_str();
  sub->add_option("--jpeg", command.jpeg_quality, "JPEG quality 1 to 100; 0: PNG")
      ->check(CLI::Range(0, 100))
      ->capture_default_str();
  sub->footer(std::string("Example: touchline simulate my-walk --seconds 20 --kidnap 10 --jpeg 92") + exit_text);
}

void add_demo(CLI::App& app, Commands& commands) {
  DemoCommand& command = commands.demo;
  auto* sub =
      app.add_subcommand("demo", "a simulated robot walks, is kidnapped in the middle, and finds its place again");
  sub->add_option("--output", command.output, "folder for stages.png, field.png and summary.json")
      ->capture_default_str();
  sub->add_option("--seconds", command.seconds, "simulated seconds")
      ->check(CLI::Range(2.0, 3600.0))
      ->capture_default_str();
  sub->add_option("--seed", command.seed, "seed of everything")->capture_default_str();
  sub->footer(std::string("Example: touchline demo --output demo --seed 7") + exit_text);
}

void add_memory(CLI::App& app) {
  auto* sub = app.add_subcommand("memory", "what the chain's state takes, struct by struct");
  sub->footer(std::string("Example: touchline memory") + exit_text);
}

void add_robot(CLI::App& app, Commands& commands) {
  RobotCommand& command = commands.robot;
  auto* run = app.add_subcommand("run", "the robot daemon: frames, odometry and yaw in, a JSON line per pose out");
  run->add_option("FILE", command.file, "the robot's TOML file")->required();
  run->add_option("--frames", command.frames, "end after so many frames; 0: run until SIGTERM")->capture_default_str();
  run->footer(std::string("Example: touchline run /etc/touchline/robot.toml") + exit_text);
  auto* check = app.add_subcommand("check", "says what is wrong with the robot's TOML file; opens no device");
  check->add_option("FILE", command.file, "the robot's TOML file")->required();
  check->footer(std::string("Example: touchline check /etc/touchline/robot.toml") + exit_text);
  auto* devices =
      app.add_subcommand("devices", "cameras, HID devices, serial ports and GPIO chips that are plugged in");
  devices->footer(std::string("Example: touchline devices") + exit_text);
}

int run(const CLI::App& app, Commands& commands, std::ostream& out, std::ostream& err) {
  commands.work.apply(commands.evaluate.options.chain);
  commands.work.apply(commands.locate.options.chain);
  if (app.got_subcommand("evaluate")) return run_evaluate(commands.evaluate, out, err);
  if (app.got_subcommand("locate")) return run_locate(commands.locate, out, err);
  if (app.got_subcommand("accept")) return run_accept(commands.accept, out, err);
  if (app.got_subcommand("simulate")) return run_simulate(commands.simulate, out);
  if (app.got_subcommand("demo")) return run_demo(commands.demo, out);
  if (app.got_subcommand("memory")) return run_memory(out);
  if (app.got_subcommand("run")) return run_robot(commands.robot, out, err);
  if (app.got_subcommand("check")) return check_robot(commands.robot, out);
  if (app.got_subcommand("devices")) return list_devices(out);
  out << app.help();
  return exit_ok;
}

}  // namespace

int touchline_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err, bool terminal) {
  CLI::App app{"touchline tells a humanoid soccer robot where it stands.", "touchline"};
  app.require_subcommand(0, 1);
  app.footer(std::string("Each command has its own --help with an example.") + exit_text);
  Commands commands;
  commands.demo.live = terminal;
  add_evaluate(app, commands);
  add_locate(app, commands);
  add_accept(app, commands);
  add_simulate(app, commands);
  add_demo(app, commands);
  add_memory(app);
  add_robot(app, commands);
  try {
    app.parse(argc, argv);
    return run(app, commands, out, err);
  } catch (const CLI::ParseError& error) {
    return app.exit(error, out, err) == 0 ? exit_ok : exit_bad_input;
  } catch (const HostError& error) {
    out << std::flush;
    err << "touchline: " << error.what() << "\n";
  } catch (const std::exception& error) {  // the heap is full, a file system error
    err << "touchline: " << error.what() << "\n";
  }
  return exit_bad_input;
}

}  // namespace touchline::host
