// SPDX-License-Identifier: Apache-2.0
// Precision and recall of the reported junctions.
#include "platform/host/junction_score.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "platform/host/host_error.h"
#include "platform/host/input_file.h"

namespace touchline::host {
namespace {

using nlohmann::json;

constexpr std::size_t most_expected_bytes = std::size_t{16} << 20;

std::optional<JunctionType> type_of(const std::string& name) {
  if (name == "X") return JunctionType::x;
  if (name == "T") return JunctionType::t;
  if (name == "L") return JunctionType::l;
  return std::nullopt;  // penalty marks and goal posts
}

float pixels_between(PixelPoint a, PixelPoint b) { return std::hypot(a.u - b.u, a.v - b.v); }

std::vector<ExpectedLandmark> parse(const json& root) {
  std::vector<ExpectedLandmark> out;
  for (const auto& entry : root.at("landmarks")) {
    const auto type = type_of(entry.at("type").get<std::string>());
    if (!type) continue;
    const auto& px = entry.at("px");
    out.push_back({*type,
                   {px.at(0).get<float>(), px.at(1).get<float>()},
                   entry.at("range_m").get<float>(),
                   entry.at("occluded").get<bool>()});
  }
  return out;
}

JunctionCount& of(JunctionScore& score, JunctionType type) { return score[static_cast<std::size_t>(type)]; }

}  // namespace

std::optional<std::vector<ExpectedLandmark>> read_expected(const std::filesystem::path& image) {
  const auto folder = image.parent_path().parent_path() / "expected";
  const auto file = folder / (image.stem().string() + ".json");
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) return std::nullopt;
  std::string text;
  try {
    text = read_whole_file(file, {"file", "correct or remove it", most_expected_bytes});
  } catch (const HostError& error) {
    throw FrameError(error.what());
  }
  try {
    return parse(json::parse(text));
  } catch (const json::exception& error) {
    throw FrameError(file.string() + ": not a list of expected landmarks: " + error.what() +
                     "; correct or remove the file");
  }
}

JunctionCount& JunctionCount::operator+=(const JunctionCount& other) {
  to_find += other.to_find;
  found += other.found;
  right += other.right;
  wrong += other.wrong;
  return *this;
}

JunctionScore& operator+=(JunctionScore& sum, const JunctionScore& other) {
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += other[i];
  return sum;
}

JunctionScore score_junctions(std::span<const ExpectedLandmark> expected, std::span<const Junction> reported) {
  JunctionScore score{};
  for (const auto& landmark : expected) {
    if (landmark.occluded || landmark.range_m > junction_range_m) continue;
    ++of(score, landmark.type).to_find;
    for (const auto& junction : reported) {
      if (junction.type != landmark.type || pixels_between(junction.pixel, landmark.pixel) > junction_radius_px)
        continue;
      ++of(score, landmark.type).found;
      break;
    }
  }
  for (const auto& junction : reported) {
    if (std::hypot(junction.ground.x, junction.ground.y) > junction_range_m) continue;
    bool at_visible = false;
    bool at_hidden = false;
    for (const auto& landmark : expected) {
      if (junction.type != landmark.type || pixels_between(junction.pixel, landmark.pixel) > junction_radius_px)
        continue;
      (landmark.occluded ? at_hidden : at_visible) = true;
    }
    if (at_visible) {
      ++of(score, junction.type).right;
    } else if (!at_hidden) {
      ++of(score, junction.type).wrong;
    }
  }
  return score;
}

}  // namespace touchline::host
