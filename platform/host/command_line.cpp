// SPDX-License-Identifier: Apache-2.0
// The arguments of `touchline`, and what happens with the outcome of a command.
#include "platform/host/command_line.h"

#include <algorithm>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "platform/host/command_simulate.h"
#include "platform/host/demo.h"
#include "platform/host/host_error.h"
#include "platform/host/options.h"
#include "platform/host/robot_commands.h"

namespace touchline::host {
namespace {

const std::vector<std::string> field_presets{"acyut-5x3", "kidsize-9x6", "small-2026", "middle-2026"};
const std::vector<std::string> cameras{"fisheye-185", "fisheye-185-qvga", "fisheye-140", "fisheye-140-kb"};

/// What evaluate and locate have in common.
void add_chain_options(CLI::App& app, EvaluateOptions& options) {
  ChainOptions& chain = options.chain;
  add_choice(
      app, "--landmarks", {"lines", "goalposts", "both"}, 0,
      [&chain](std::size_t i) {
        constexpr Landmarks kinds[] = {Landmarks::lines, Landmarks::goalposts, Landmarks::both};
        chain.landmarks = kinds[i];
      },
      "what localization may use");
  add_choice(
      app, "--model", {"full", "paper"}, 0,
      [&chain](std::size_t i) { chain.model = i == 0 ? LocModel::full : LocModel::paper; },
      "full: all the picture has; paper: the paper's method alone");
  add_choice(
      app, "--work", {"320x240", "640x480"}, 0,
      [&chain](std::size_t i) {
        chain.work_width = i == 0 ? 320 : 640;
        chain.work_height = i == 0 ? 240 : 480;
      },
      "working size of the vision chain");
  add_whole(app, "--particles", chain.particles, 10, max_particles, "particles of the filter");
  add_whole(app, "--seed", options.seed, "seed of the filter's random numbers");
  app.add_flag_callback(
      "--no-yaw", [&options] { options.use_yaw = false; },
      "do not use the IMU's yaw: the half of the field stays open");
  add_text(app, "--frames", options.frames_out, "write an annotated PNG per frame into this folder");
}

constexpr const char* exit_text = "\nExit status: 0 done, 1 a figure or check missed its mark, 2 bad input or usage.";

struct Commands {
  EvaluateCommand evaluate;
  LocateCommand locate;
  AcceptCommand accept;
  SimulateCommand simulate;
  DemoCommand demo;
  RobotCommand robot;
};

CLI::App& add_command(CLI::App& app, const std::string& name, const std::string& what, const std::string& example) {
  auto* sub = app.add_subcommand(name, what);
  sub->footer("Example: touchline " + example + exit_text);
  return *sub;
}

void add_evaluate(CLI::App& app, EvaluateCommand& command) {
  CLI::App& sub = add_command(app, "evaluate", "localize every frame of data sets and judge the poses",
                              "evaluate my-recording --frames out");
  add_texts(sub, "DATASET", command.folders, "folders with dataset.toml, frames.jsonl and images");
  sub.add_flag("--json", command.json, "one JSON line per frame, then the summary, on standard output");
  add_chain_options(sub, command.options);
}

void add_locate(CLI::App& app, LocateCommand& command) {
  CLI::App& sub = add_command(app, "locate", "localize single images, each from nothing",
                              "locate --camera my-robot/dataset.toml --pitch-deg 31.5 --yaw-deg 12 picture.png");
  add_text(sub, "--camera", command.camera,
           "dataset.toml with camera, mount and field, or its folder; images that frames.jsonl beside it lists are "
           "taken with their line's mount and yaw")
      ->required();
  add_texts(sub, "IMAGE", command.images, "PNG or JPEG files");
  add_number(sub, "--height-m", command.height_m, 0.01, 10.0, "the camera's height above the carpet");
  add_number(sub, "--pitch-deg", command.pitch_deg, -360.0, 360.0, "the camera's pitch, > 0 looks down");
  add_number(sub, "--roll-deg", command.roll_deg, -360.0, 360.0, "the camera's roll, > 0 lowers the right side");
  add_number(sub, "--yaw-deg", command.yaw_deg, -36000.0, 36000.0,
             "what the IMU reads, as imu_yaw_deg; without a yaw the half of the field stays open");
  sub.add_flag("--json", command.json, "one JSON line per image, then the summary, on standard output");
  add_chain_options(sub, command.options);
}

void add_accept(CLI::App& app, AcceptCommand& command) {
  CLI::App& sub = add_command(app, "accept", "the acceptance figures beside their targets",
                              "accept data --figures tests/accept/figures.json");
  add_text(sub, "FOLDER", command.folder,
           "holds render-table2, render-hard, render-walk, real-kidsize; without it, the simulator's rows alone");
  add_text(sub, "--figures", command.figures, "fail where a figure is worse than in this file");
  sub.add_flag("--rewrite", command.rewrite, "write that file anew instead");
  add_text(sub, "--output", command.output, "write the figures of this run as JSON");
  sub.add_flag_callback(
      "--no-simulator", [&command] { command.simulator = false; }, "leave the simulator's rows out");
  add_whole(sub, "--poses", command.runs.poses, 1, 100000, "single poses in the simulator");
  add_whole(sub, "--walks", command.runs.walks, 1, 1000, "walks in the simulator, each field");
  add_whole(sub, "--threads", command.runs.threads, 1, 64, "runs of the simulator at the same time");
  sub.footer(
      "It takes about five minutes, most of them for the simulator's rows; with --no-simulator a few seconds.\n" +
      sub.get_footer());
}

void add_simulate(CLI::App& app, SimulateCommand& command) {
  CLI::App& sub = add_command(app, "simulate", "write simulated frames with exact truth as a data set",
                              "simulate my-walk --seconds 20 --kidnap 10 --jpeg 92");
  add_text(sub, "OUT", command.out, "folder to create")->required();
  add_choice(sub, "--kind", command.kind, {"walk", "poses"},
             "walk: one run with odometry; poses: single pictures, each from nothing");
  add_choice(sub, "--field", command.field, field_presets, "a preset");
  add_choice(sub, "--camera", command.camera, cameras, "a lens and its picture size");
  add_whole(sub, "--seed", command.seed, "seed of everything");
  add_number(sub, "--seconds", command.seconds, 0.1, 3600.0, "length of a walk");
  add_number(sub, "--fps", command.frames_per_second, 5.0, 100.0, "frames a second of a walk");
  add_whole(sub, "--count", command.count, 1, 100000, "single pictures");
  sub.add_flag_callback(
      "--no-yaw", [&command] { command.yaw = false; }, "a robot without an IMU");
  add_number(sub, "--kidnap", command.kidnap_at_s, -1.0, 3600.0, "seconds into the walk; < 0: none");
  add_whole(sub, "--jpeg", command.jpeg_quality, 0, 100, "JPEG quality; 0: PNG");
}

void add_demo(CLI::App& app, DemoCommand& command) {
  CLI::App& sub =
      add_command(app, "demo", "a simulated robot walks, is kidnapped in the middle, and finds its place again",
                  "demo --output demo --seed 7");
  add_text(sub, "--output", command.output, "folder for stages.png, field.png and summary.json");
  add_number(sub, "--seconds", command.seconds, 2.0, 3600.0, "simulated seconds");
  add_whole(sub, "--seed", command.seed, "seed of everything");
}

void add_robot(CLI::App& app, RobotCommand& command) {
  CLI::App& run = add_command(app, "run", "the robot daemon: frames, odometry and yaw in, a JSON line per pose out",
                              "run /etc/touchline/robot.toml");
  add_text(run, "FILE", command.file, "the robot's TOML file")->required();
  add_whole(run, "--frames", command.frames, "end after so many frames; 0: run until SIGTERM");
  CLI::App& check = add_command(app, "check", "says what is wrong with the robot's TOML file; opens no device",
                                "check /etc/touchline/robot.toml");
  add_text(check, "FILE", command.file, "the robot's TOML file")->required();
  add_command(app, "devices", "cameras, HID devices, serial ports and GPIO chips that are plugged in", "devices");
}

/// Options that would be taken without a word, but change nothing beside the others.
void refuse_meaningless(CLI::App& app, const Commands& commands) {
  CLI::App& simulate = *app.get_subcommand("simulate");
  if (commands.simulate.kind == "poses") {
    for (const char* option : {"--seconds", "--fps", "--kidnap"}) {
      refuse_option(simulate, option, "is about a walk; leave it out, or choose --kind walk");
    }
  } else {
    refuse_option(simulate, "--count", "is about single pictures; give --seconds, or choose --kind poses");
    if (commands.simulate.kidnap_at_s > commands.simulate.seconds) {
      refuse_option(simulate, "--kidnap", "would be after the walk's end; make --seconds longer");
    }
  }
  if (!commands.locate.options.use_yaw) {
    refuse_option(*app.get_subcommand("locate"), "--yaw-deg", "is not used with --no-yaw; leave one of the two out");
  }
  CLI::App& accept = *app.get_subcommand("accept");
  if (commands.accept.figures.empty()) {
    refuse_option(accept, "--rewrite", "needs to know which file; name it by --figures");
  }
  for (const char* option : {"--poses", "--walks", "--threads"}) {
    if (commands.accept.simulator) break;
    refuse_option(accept, option, "is about the simulator; leave it or --no-simulator out");
  }
}

/// Errors of writing show when the stream is emptied, at the latest.
void check_written(std::ostream& out) {
  if (out.flush()) return;
  throw HostError("standard output: could not be written to its end; check the space left where it goes");
}

/// One line a mistake: check finds several.
void print_error(const std::string& text, std::ostream& err) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) err << "touchline: " << line << "\n";
}

int run(const CLI::App& app, Commands& commands, std::ostream& out, std::ostream& err) {
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

int parse_and_run(CLI::App& app, int argc, const char* const* argv, Commands& commands, std::ostream& out,
                  std::ostream& err) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& help) {
    return app.exit(help, out, err);
  }
  refuse_meaningless(app, commands);
  return run(app, commands, out, err);
}

bool is_command(const CLI::App& app, const std::string& word) {
  const auto commands = app.get_subcommands({});
  return std::any_of(commands.begin(), commands.end(), [&](const CLI::App* sub) { return sub->get_name() == word; });
}

/// "help COMMAND" is "COMMAND --help". A word in the command's place that is none stands alone, for a --help behind it
/// would hide the mistake.
std::vector<const char*> understood(const CLI::App& app, int argc, const char* const* argv) {
  std::vector<const char*> words(argv, argv + argc);
  bool help = false;
  while (words.size() >= 2 && std::string(words[1]) == "help") {
    help = true;
    words.erase(words.begin() + 1);
  }
  const std::string first = words.size() < 2 ? "--help" : words[1];
  const bool option = first.starts_with("-");
  if (!option && !is_command(app, first)) {
    words.resize(2);
  } else if (help) {
    words.insert(words.begin() + (option ? 1 : 2), "--help");
  }
  return words;
}

}  // namespace

int touchline_main(int argc, const char* const* argv, std::ostream& out, std::ostream& err, bool terminal) {
  CLI::App app{"touchline tells a humanoid soccer robot where it stands.", "touchline"};
  app.require_subcommand(0, 1);
  app.footer(std::string("Each command has its own --help with an example.") + exit_text);
  app.set_version_flag("--version", "touchline " TOUCHLINE_VERSION, "the program's version");
  Commands commands;
  commands.demo.live = terminal;
  add_evaluate(app, commands.evaluate);
  add_locate(app, commands.locate);
  add_accept(app, commands.accept);
  add_simulate(app, commands.simulate);
  add_demo(app, commands.demo);
  add_command(app, "memory", "what the chain's state takes, struct by struct", "memory");
  add_robot(app, commands.robot);
  try {
    const std::vector<const char*> words = understood(app, argc, argv);
    const int status = parse_and_run(app, static_cast<int>(words.size()), words.data(), commands, out, err);
    check_written(out);
    return status;
  } catch (const CLI::ParseError& error) {
    err << "touchline: " << usage_error(app, error) << "\n";
  } catch (const HostError& error) {
    out << std::flush;
    print_error(error.what(), err);
  } catch (const std::exception& error) {  // the heap is full, a file system error
    err << "touchline: " << error.what() << "\n";
  }
  return exit_bad_input;
}

}  // namespace touchline::host
