// SPDX-License-Identifier: Apache-2.0
// The command line as a user meets it: help, JSON lines, annotated pictures, and one clear line with status 2 for every
// kind of bad input.
#include "platform/host/command_line.h"

#include <algorithm>
#include <sstream>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/host/temp_folder.h"

namespace touchline::host {
namespace {

struct Run {
  int status = -1;
  std::string out;
  std::string err;
};

Run run(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv{"touchline"};
  for (const auto& a : arguments) argv.push_back(a.c_str());
  std::ostringstream out;
  std::ostringstream err;
  Run result;
  result.status = touchline_main(static_cast<int>(argv.size()), argv.data(), out, err);
  result.out = out.str();
  result.err = err.str();
  return result;
}

const char* const toml = R"(
name = "tiny"
field = "acyut-5x3"
[camera]
width = 320
height = 240
model = "equidistant"
focal_px = 100.0
max_theta_deg = 92.5
[mount]
height_m = 0.58
pitch_deg = 30.0
)";

/// One frame of a plain carpet: nothing to be seen, so there is no pose.
void write_tiny(const TempFolder& folder, const std::string& settings = toml,
                const std::string& lines = "{\"image\": \"images/0.png\", \"t_s\": 0.5, \"imu_yaw_deg\": 3}\n") {
  folder.write("dataset.toml", settings);
  folder.write("frames.jsonl", lines);
  folder.write("images/x", "");
  RgbImage carpet(320, 240);
  for (std::size_t i = 1; i < carpet.rgb.size(); i += 3) carpet.rgb[i] = 120;
  write_png(folder.path() / "images/0.png", carpet);
}

/// Status 2, nothing but one line of complaint, and no trace of where in the program it happened.
void check_refused(const Run& result, const std::string& part) {
  CAPTURE(result.err);
  CHECK(result.status == 2);
  CHECK(contains(result.err, part));
  CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
  CHECK(result.err.starts_with("touchline: "));
  CHECK_FALSE(contains(result.err, ".cpp"));
}

TEST_CASE("every command has a help with an example, and help is no error") {
  for (const char* command : {"evaluate", "locate", "accept", "simulate", "demo", "memory"}) {
    CAPTURE(command);
    const Run result = run({command, "--help"});
    CHECK(result.status == 0);
    CHECK(contains(result.out, std::string("Example: touchline ") + command));
    CHECK(contains(result.out, "Exit status"));
    CHECK(contains(run({}).out, command));
  }
}

TEST_CASE("accept's help says how long it takes") {
  CHECK(contains(run({"accept", "--help"}).out, "about five minutes"));
}

TEST_CASE("version and help in the words that people try first") {
  CHECK(run({"--version"}).status == 0);
  CHECK(run({"--version"}).out.starts_with("touchline 0."));
  CHECK(run({"help"}).out == run({"--help"}).out);
  CHECK(run({"help", "evaluate"}).out == run({"evaluate", "--help"}).out);
  CHECK(run({"help", "evaluate"}).status == 0);
  CHECK(run({"help", "--help"}).out == run({"--help"}).out);
  CHECK(run({"help", "help"}).out == run({"--help"}).out);
}

TEST_CASE("a command that there is not is the same error when help about it is asked for") {
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"lokate"}, {"help", "lokate"}, {"lokate", "--help"}, {"help", "lokate", "--help"}}) {
    const Run result = run(words);
    check_refused(result, "touchline: lokate: no such command; did you mean locate?");
    CHECK(result.out.empty());
  }
  check_refused(run({"help", "fly"}), "fly: no such command; there are evaluate, locate");
}

TEST_CASE("bad usage is status 2, in one line of the program's own") {
  check_refused(run({"evaluate"}), "evaluate DATASET is required; see touchline evaluate --help");
  check_refused(run({"locate", "x.png"}), "locate --camera is required");
  check_refused(run({"evaluate", "x", "--work", "100x100"}), "evaluate --work 100x100: write 320x240 or 640x480");
  check_refused(run({"evaluate", "x", "--model", "fuller"}), "write full or paper; did you mean full?");
  check_refused(run({"evaluate", "x", "--sed", "1"}), "evaluate --sed: no such option; did you mean --seed?");
  check_refused(run({"locate", "x.png", "--camra", "c.toml"}),
                "locate --camra: no such option; did you mean --camera?");
  check_refused(run({"evaluate", "x", "--seed"}), "evaluate --seed: its value is missing");
  check_refused(run({"evaluate", "x", "--seed", "1", "--seed", "2"}), "--seed: is given more than once");
  check_refused(run({"memory", "3"}), "memory 3: one argument too many");
  check_refused(run({"fly"}), "fly: no such command; there are evaluate, locate");
  check_refused(run({"evaluat", "x"}), "evaluat: no such command; did you mean evaluate?");
  check_refused(run({"--json"}), "--json: no option of the program; options stand after the command");
}

TEST_CASE("numbers are finite, whole where they count something, and within their range") {
  for (const char* value : {"nan", "-nan", "inf", "1e999", "1", "3601", "", "5x", "0x10"}) {
    check_refused(run({"demo", "--seconds", value}), "write a number from 2 to 3600");
  }
  for (const char* value : {"-1", "1.5", "", "x", "99999999999999999999"}) {
    check_refused(run({"demo", "--seed", value}), "demo --seed");
  }
  check_refused(run({"evaluate", "x", "--particles", "9"}), "--particles 9: write a whole number from 10 to 1000");
  check_refused(run({"simulate", "x", "--fps", "nan"}), "simulate --fps nan");
  check_refused(run({"simulate", "x", "--jpeg", "101"}), "from 0 to 100");
  check_refused(run({"accept", "x", "--poses", "0"}), "accept --poses 0");
  check_refused(run({"run", "x", "--frames", "-1"}), "run --frames -1");
}

TEST_CASE("options that are empty, or have no meaning beside the others, are not taken silently") {
  check_refused(run({"evaluate", "x", "--frames", ""}), "evaluate --frames \"\": is empty");
  check_refused(run({"evaluate", ""}), "evaluate DATASET \"\": is empty");
  check_refused(run({"demo", "--output", ""}), "is empty");
  for (const char* option : {"--kidnap", "--seconds", "--fps"}) {
    check_refused(run({"simulate", "x", "--kind", "poses", option, "5"}), "is about a walk");
  }
  check_refused(run({"simulate", "x", "--count", "5"}), "is about single pictures");
  check_refused(run({"simulate", "x", "--seconds", "5", "--kidnap", "6"}), "after the walk's end");
  check_refused(run({"accept", "x", "--rewrite"}), "name it by --figures");
  check_refused(run({"accept", "x", "--no-simulator", "--walks", "3"}), "is about the simulator");
}

TEST_CASE("output to a full device is an error") {
  const TempFolder folder;
  write_tiny(folder);
  const std::string path = folder.path().string();
  const std::vector<std::vector<std::string>> commands{{"memory"},
                                                       {"--help"},
                                                       {"evaluate", path},
                                                       {"evaluate", path, "--json"},
                                                       {"locate", "--camera", path, path + "/images/0.png"}};
  for (const auto& command : commands) {
    CAPTURE(command.front());
    std::vector<const char*> argv{"touchline"};
    for (const auto& a : command) argv.push_back(a.c_str());
    std::ofstream full("/dev/full");
    std::ostringstream err;
    CHECK(touchline_main(static_cast<int>(argv.size()), argv.data(), full, err) == 2);
    CHECK(contains(err.str(), "touchline: standard output: could not be written to its end"));
  }
}

TEST_CASE("accept finds what would fail at the end before it runs anything") {
  const TempFolder folder;
  const std::string path = folder.path().string();
  check_refused(run({"accept", path, "--figures", path + "/missing.json"}), "missing.json: no such file");
  folder.write("broken.json", "{\"figures\": 3}");
  check_refused(run({"accept", path, "--figures", path + "/broken.json"}), "not a file of figures");
  check_refused(run({"accept", "--no-simulator"}), "nothing is left to judge");
  check_refused(run({"accept", path, "--output", path + "/none/x.json"}), "none/x.json: cannot be written");
  check_refused(run({"accept", path, "--output", path + "/x.json"}),
                "holds none of the data sets that are judged: render-table2, render-hard, render-walk, real-kidsize");
  CHECK_FALSE(std::filesystem::exists(path + "/x.json"));
}

TEST_CASE("evaluate --json prints one line a frame with the documented keys, then the summary") {
  const TempFolder folder;
  write_tiny(folder);
  const Run result = run({"evaluate", folder.path().string(), "--json"});
  CAPTURE(result.err);
  REQUIRE(result.status == 0);
  std::istringstream lines(result.out);
  std::string line;
  REQUIRE(std::getline(lines, line));
  const auto frame = nlohmann::json::parse(line);
  CHECK(frame.at("image") == "images/0.png");
  CHECK(frame.at("t_s") == 0.5);
  CHECK(frame.at("pose").is_null());
  CHECK(frame.at("std").is_null());
  CHECK(frame.at("mirror").is_null());
  CHECK(frame.at("confidence").is_number());
  CHECK(frame.at("junctions").empty());
  CHECK(frame.at("posts").empty());
  for (const char* stage :
       {"average", "green", "roi", "candidates", "line_mask", "thinning", "digestion", "graph", "localize"}) {
    CHECK(frame.at("us").at(stage).is_number());
  }
  CHECK_FALSE(frame.contains("error"));  // no truth, no error
  REQUIRE(std::getline(lines, line));
  const auto summary = nlohmann::json::parse(line).at("summary");
  CHECK(summary.at("frames") == 1);
  CHECK(summary.at("with_truth") == 0);
  CHECK(summary.at("sets").at(0).at("name") == "tiny");
  CHECK_FALSE(std::getline(lines, line));
}

TEST_CASE("the table says the same for people, and --frames writes a picture of each frame") {
  const TempFolder folder;
  write_tiny(folder);
  const auto pictures = folder.path() / "out";
  const Run result = run({"evaluate", folder.path().string(), "--frames", pictures.string(), "--model", "paper"});
  REQUIRE(result.status == 0);
  CHECK(contains(result.out, "no pose"));
  CHECK(contains(result.out, "poses: 0 of 1 frames"));
  CHECK(read_image(pictures / "tiny" / "0.png").width == 620);
}

TEST_CASE("locate takes mount and yaw from options, else from frames.jsonl, else from dataset.toml") {
  const TempFolder folder;
  write_tiny(folder);
  RgbImage other(320, 240);
  write_png(folder.path() / "images/other.png", other);
  const std::string path = folder.path().string();
  const auto locate = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"locate", "--camera", path};
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  };
  const std::string listed = path + "/images/0.png";
  const std::string unlisted = path + "/images/other.png";
  CHECK(contains(locate({listed}).out, "1 of 1 images have a line in frames.jsonl"));
  CHECK(contains(locate({listed}).out, "yaw given"));
  CHECK(contains(locate({listed, "--no-yaw"}).out, "yaw not used"));
  CHECK(contains(locate({unlisted}).out, "no yaw"));
  CHECK(contains(locate({unlisted, "--yaw-deg", "12"}).out, "yaw given"));
  CHECK(contains(locate({listed, unlisted}).out, "yaw given for 1 of them"));
  CHECK(contains(locate({unlisted, "--json"}).out, "\"yaw\":false"));
  CHECK(contains(locate({listed, "--json"}).out, "\"yaw\":true"));
  check_refused(locate({listed, "--no-yaw", "--yaw-deg", "1"}), "--yaw-deg: is not used with --no-yaw");
  check_refused(locate({listed, "--height-m", "0"}), "locate --height-m 0: write a number from 0.01 to 10");
  check_refused(locate({listed, "--pitch-deg", "nan"}), "locate --pitch-deg nan");
  // A camera file without the height: the line has it, and the option.
  std::string no_height = toml;
  no_height.replace(no_height.find("height_m = 0.58"), 15, "");
  write_tiny(folder, no_height, "{\"image\": \"images/0.png\", \"mount\": {\"height_m\": 0.5}}\n");
  CHECK(locate({listed}).status == 0);
  check_refused(locate({unlisted}), "[mount] height_m: is missing; add it, or give --height-m");
  CHECK(locate({unlisted, "--height-m", "0.5"}).status == 0);
}

TEST_CASE("locate's options come before the files") {
  const std::string folder = std::string(TOUCHLINE_FIXTURES) + "/sim-poses";
  const auto frame = [&](std::vector<std::string> more) {
    std::vector<std::string> all{"locate", "--json", "--camera", folder + "/dataset.toml", folder + "/images/000.png"};
    all.insert(all.end(), more.begin(), more.end());
    const std::string lines = run(all).out;
    return nlohmann::json::parse(lines.substr(0, lines.find('\n')));
  };
  const auto by_line = frame({});
  CHECK(by_line.at("error").at("m").get<double>() < 0.10);      // the line has the truth, too
  CHECK_FALSE(frame({"--height-m", "1.2"}).contains("error"));  // by hand: it is another mount's truth
  CHECK_FALSE(frame({"--yaw-deg", "12"}).contains("error"));
  const Run table = run({"locate", "--camera", folder, folder + "/images/000.png", "--pitch-deg", "50"});
  CHECK(contains(table.out, "but --pitch-deg is as you gave it, and poses are not held against a truth"));
  CHECK_FALSE(contains(table.out, "truth are taken from there"));
  CHECK(frame({"--height-m", "1.2"}).at("pose") != by_line.at("pose"));
  CHECK(frame({"--pitch-deg", "50"}).at("pose") != by_line.at("pose"));
  CHECK(frame({"--roll-deg", "20"}).at("pose") != by_line.at("pose"));
}

TEST_CASE("a frame that cannot be used is told, the others are evaluated, and the status is 2") {
  const TempFolder folder;
  write_tiny(folder, toml,
             "{\"image\": \"images/0.png\"}\n{\"image\": \"images/none.png\"}\n{\"image\": \"images/0.png\"}\n");
  const Run table = run({"evaluate", folder.path().string()});
  CHECK(table.status == 2);
  CHECK(contains(table.out, "images/none.png      could not be used"));
  CHECK(contains(table.out, "poses: 0 of 3 frames"));
  CHECK(contains(table.out, "could not be used: 1 of 3 frames"));
  CHECK(contains(table.err, "images/none.png: no such image"));
  CHECK(contains(table.err, "tiny: no frame has a pose; check the lens"));
  const Run lines = run({"evaluate", folder.path().string(), "--json"});
  CHECK(lines.status == 2);
  CHECK(std::count(lines.out.begin(), lines.out.end(), '\n') == 4);
  CHECK(contains(lines.out, "{\"set\":\"tiny\",\"image\":\"images/none.png\",\"t_s\":null,\"failure\":"));
  CHECK(contains(lines.out, "\"frames\":3,\"failed\":1,"));
}

TEST_CASE("an image's name may hold bytes that are no UTF-8") {
  const TempFolder folder;
  write_tiny(folder);
  const Run lines = run({"locate", "--camera", folder.path().string(), "--json", "\xFF.png"});
  check_refused(lines, ".png: no such image");
  CHECK(std::count(lines.out.begin(), lines.out.end(), '\n') == 2);
  CHECK(nlohmann::json::accept(lines.out.substr(0, lines.out.find('\n'))));
}

TEST_CASE("where nothing counts there is a dash, not a perfect figure") {
  const TempFolder folder;
  write_tiny(folder, "protocol = \"sequence\"\n" + std::string(toml),
             "{\"image\": \"images/0.png\", \"truth\": {\"x_m\": 0, \"y_m\": 0, \"theta_deg\": 0}}\n");
  const Run table = run({"evaluate", folder.path().string()});
  CHECK(contains(table.out, "RMSE - over 0 frames"));
  CHECK(contains(table.out, "error: median - -"));
  CHECK(contains(run({"evaluate", folder.path().string(), "--json"}).out, "\"rmse_m\":null"));
}

TEST_CASE("images smaller than the working size are told without a table") {
  const TempFolder folder;
  write_tiny(folder);
  const Run result = run({"evaluate", folder.path().string(), "--work", "640x480"});
  check_refused(result, "images of 320x240 are smaller than the working size 640x480");
  CHECK(result.out.empty());
}

TEST_CASE("two sets of one name are told apart, in lines and in folders") {
  const TempFolder first;
  const TempFolder second;
  write_tiny(first);
  write_tiny(second, toml, "{\"image\": \"images/0.png\"}\n{\"image\": \"other/0.png\"}\n");
  std::filesystem::create_directories(second.path() / "other");
  std::filesystem::copy(second.path() / "images/0.png", second.path() / "other/0.png");
  const auto out = first.path() / "out";
  const Run result =
      run({"evaluate", first.path().string(), second.path().string(), "--json", "--frames", out.string()});
  REQUIRE(result.status == 0);
  CHECK(contains(result.out, "{\"set\":\"tiny\","));
  CHECK(contains(result.out, "{\"set\":\"tiny-2\","));
  CHECK(contains(result.out, "{\"name\":\"tiny-2\","));
  CHECK(read_image(out / "tiny/0.png").width == 620);
  CHECK(read_image(out / "tiny-2/0.png").width == 620);
  CHECK(read_image(out / "tiny-2/0-2.png").width == 620);  // and two images of one name
}

TEST_CASE("locate needs no frames.jsonl") {
  const TempFolder folder;
  write_tiny(folder);
  std::filesystem::remove(folder.path() / "frames.jsonl");
  const std::string camera = (folder.path() / "dataset.toml").string();
  const std::string image = (folder.path() / "images/0.png").string();
  CHECK(run({"locate", "--camera", camera, image}).status == 0);
  check_refused(run({"locate", "--camera", camera, image, "--work", "640x480", "--json"}),
                "smaller than the working size 640x480");
  check_refused(run({"locate", "--camera", camera, image + "x"}), "no such image");
  check_refused(run({"locate", "--camera", image, image}), "not valid TOML");
  CHECK(run({"locate", "--camera", folder.path().string(), image}).status == 0);  // the folder will do
}

TEST_CASE("every kind of bad input is one clear line and status 2") {
  const TempFolder folder;
  const std::string path = folder.path().string();
  check_refused(run({"evaluate", path}), "the folder is empty");
  check_refused(run({"evaluate", path + "/none"}), "no such folder");
  check_refused(run({"accept", path + "/none"}), "no such folder");
  const auto changed = [](const std::string& from, const std::string& to) {
    std::string text = toml;
    return text.replace(text.find(from), from.size(), to);
  };
  write_tiny(folder, changed("0.58", "-0.58"));
  check_refused(run({"evaluate", path}), "[mount] height_m: is -0.58");
  write_tiny(folder, changed("30.0", "nan"));
  check_refused(run({"evaluate", path}), "[mount] pitch_deg: is NaN");
  write_tiny(folder, changed("equidistant", "fisheye"));
  check_refused(run({"evaluate", path}), "[camera] model: \"fisheye\" is not known; known are equidistant");
  write_tiny(folder, toml, "{\"image\": \"images/0.png\"\n");
  check_refused(run({"evaluate", path}), "frames.jsonl:1: not valid JSON");
  write_tiny(folder, toml, "{\"image\": \"images/9.png\"}\n");
  const Run missing = run({"evaluate", path, "--json"});
  check_refused(missing, "images/9.png: no such image");
  write_tiny(folder, changed("width = 320", "width = 300"));
  check_refused(run({"evaluate", path, "--json"}), "the image is 320x240, but");
  write_tiny(folder);
  const std::string whole = folder.read("images/0.png");
  folder.write("images/0.png", whole.substr(0, whole.size() / 2));
  check_refused(run({"evaluate", path, "--json"}), "images/0.png: this PNG cannot be read");
}

TEST_CASE("demo: the robot is kidnapped and found again; stages, field and figures are written") {
  const TempFolder folder;
  const std::string output = (folder.path() / "demo").string();
  const Run result = run({"demo", "--seconds", "4", "--output", output});
  CAPTURE(result.out);
  CHECK(result.status == 0);
  CHECK(contains(result.out, "truth"));
  CHECK(contains(result.out, "picked up and put down elsewhere"));
  const auto summary = nlohmann::json::parse(folder.read("demo/summary.json"));
  CHECK(summary.at("frames") == 49);  // 12 a second, both ends
  CHECK(summary.at("back_s").size() == 1);
  CHECK(summary.at("rmse_m").get<double>() < 0.10);
  CHECK(read_image(folder.path() / "demo/field.png").width > 500);
  std::ifstream stages(folder.path() / "demo/stages.png", std::ios::binary);  // larger than a camera's image
  CHECK(stages.seekg(0, std::ios::end).tellg() > 100000);
}

TEST_CASE("memory prints the budget, in parts that add up to the whole") {
  const Run result = run({"memory"});
  CHECK(result.status == 0);
  std::istringstream lines(result.out);
  long parts = 0;
  long wholes = 0;
  int states = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t unit = line.find(" bytes");
    if (unit == std::string::npos) continue;
    const long bytes = std::stol(line.substr(line.rfind(' ', unit - 1)));
    CHECK(bytes > 0);
    if (contains(line, "vision and localization")) {
      CHECK(wholes == bytes);
      CHECK(parts == bytes);
      parts = wholes = 0;
      ++states;
    } else {
      (contains(line, "whole state") ? wholes : parts) += bytes;
    }
  }
  CHECK(states == 3);
}

}  // namespace
}  // namespace touchline::host
