// SPDX-License-Identifier: Apache-2.0
// Writes simulated frames as a data set: dataset.toml, frames.jsonl, images/NNN.png and expected/NNN.json.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include "platform/host/dataset.h"
#include "platform/host/sim/expected_landmarks.h"

namespace touchline::sim {

struct DataSetHead {
  std::string name;
  host::Protocol protocol = host::Protocol::independent;
  std::string field_name;  // a preset's name; empty: the dimensions are written out
  FieldDimensions field;
  SimCameraModel camera;
  CameraPose mount;       // at rest
  float goal_yaw = 0.0F;  // radians
  int jpeg_quality = 0;   // 0: PNG
};

class DataSetWriter {
 public:
  /// Creates the folder and writes dataset.toml. Throws host::HostError when the folder exists and is not empty, or
  /// cannot be written; or when the field is not valid.
  DataSetWriter(const std::filesystem::path& folder, const DataSetHead& head);
  /// Adds one frame, with the landmarks that it truly shows.
  void add(const SimFrame& frame, const Scene& scene, const Lens& lens);
  [[nodiscard]] int frames() const { return count_; }

 private:
  void write_head() const;
  void write_image(const SimFrame& frame, const std::string& name) const;
  void write_expected(const SimFrame& frame, const Scene& scene, const Lens& lens, const std::string& number,
                      const std::string& image) const;

  std::filesystem::path folder_;
  DataSetHead head_;
  Field field_;
  std::ofstream lines_;
  int count_ = 0;
};

}  // namespace touchline::sim
