// SPDX-License-Identifier: Apache-2.0
// A written data set reads back as what was simulated.
#include "platform/host/sim/data_set_writer.h"

#include <doctest/doctest.h>

#include <cmath>
#include <sstream>

#include "platform/host/command_simulate.h"
#include "platform/host/host_error.h"
#include "platform/host/image_file.h"
#include "tests/host/sim/sim_fixture.h"

using namespace touchline;
using namespace touchline::sim;

namespace {

/// A folder of this test's own, gone afterwards.
struct Folder {
  std::filesystem::path path;
  explicit Folder(const char* name) : path(std::filesystem::temp_directory_path() / name) {
    std::filesystem::remove_all(path);
  }
  ~Folder() { std::filesystem::remove_all(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
};

}  // namespace

TEST_CASE("data set: a simulated walk reads back") {
  const Folder folder("touchline_test_sim_walk");
  WalkScenarioOptions o = acceptance_walk(small_field(), *camera_model("fisheye-140-kb"), 4);
  o.kidnap_at_s = 0.2;
  WalkScenario walk(o);
  REQUIRE(walk.ready());
  DataSetHead head;
  head.name = "walk";
  head.protocol = host::Protocol::sequence;
  head.field = small_field();
  head.camera = o.camera;
  head.mount = o.walk.camera;
  head.goal_yaw = radians(20.0F);
  std::vector<SimFrame> frames;
  std::vector<std::uint8_t> last;
  {
    DataSetWriter writer(folder.path, head);
    for (int i = 0; i < 4; ++i) {
      frames.push_back(walk.next());
      writer.add(frames.back(), walk.scene(), walk.lens());
      last.assign(frames.back().image.data, frames.back().image.data + 640 * 480 * 3);
    }
  }
  const host::DataSet set = host::read_dataset(folder.path);
  CHECK(set.name == "walk");
  CHECK(set.warnings.empty());
  CHECK(set.field.length == doctest::Approx(4.9F));
  REQUIRE(set.frames.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) {
    const host::DataFrame& f = set.frames[i];
    CHECK(f.camera.lens.model == LensModel::kannala_brandt);
    CHECK(f.camera.lens.k[0] == doctest::Approx(-0.02F));
    CHECK(f.camera.mount.pitch == doctest::Approx(frames[i].mount.pitch));
    CHECK(f.truth.x == doctest::Approx(frames[i].truth.x).epsilon(1e-4));
    CHECK(std::abs(angle_difference(f.yaw, frames[i].yaw)) < 1e-5F);
    CHECK(f.kidnap == frames[i].kidnapped);
    CHECK(f.odometry.x == doctest::Approx(frames[i].odometry.x).epsilon(0.01));
  }
  CHECK(host::read_frame_image(set.frames[3]).rgb == last);
  CHECK_THROWS_AS(DataSetWriter(folder.path, head), host::HostError);
}

TEST_CASE("landmarks: expected ones lie in the picture where the drawing is white, unless occluded") {
  PoseScenarioOptions o;
  o.field = small_field();
  o.camera = *camera_model("fisheye-185");
  o.seed = 12;
  o.frames_per_scene = 4;
  PoseScenario scenario(o);
  Field field;
  REQUIRE(Field::create(o.field, field) == Status::ok);
  int junctions = 0;
  int bright = 0;
  int hidden = 0;
  for (int i = 0; i < 12; ++i) {
    const SimFrame& f = scenario.frame(i);
    for (const ExpectedLandmark& mark : expected_landmarks(field, scenario.scene(), scenario.lens(), f)) {
      CHECK(mark.range < 4.0F);
      const float straight = std::hypot(mark.world.x - f.truth.x, mark.world.y - f.truth.y);
      CHECK(mark.range == doctest::Approx(straight));
      hidden += mark.occluded ? 1 : 0;
      if (mark.type == "G" || mark.type == "P" || mark.occluded || mark.range > 1.5F) continue;
      junctions += 1;
      const auto* p =
          f.image.data + static_cast<int>(mark.px.v) * f.image.stride_bytes + static_cast<int>(mark.px.u) * 3;
      bright += p[0] * 10 > p[1] * 7 ? 1 : 0;  // paint is grey, carpet has little red
    }
  }
  CHECK(junctions > 10);
  CHECK(bright >= junctions - junctions / 8);
  CHECK(hidden > 0);
}

TEST_CASE("simulate: the command writes poses, and names what is wrong") {
  const Folder folder("touchline_test_sim_command");
  host::SimulateCommand command;
  command.out = folder.path.string();
  command.kind = "poses";
  command.count = 2;
  std::ostringstream out;
  CHECK(host::run_simulate(command, out) == 0);
  CHECK(host::read_dataset(folder.path).frames.size() == 2);
  CHECK(std::filesystem::exists(folder.path / "expected" / "001.json"));
  command.field = "nowhere";
  CHECK_THROWS_WITH_AS(host::run_simulate(command, out), doctest::Contains("--field nowhere"), host::HostError);
  command.field = "small-2026";
  command.camera = "pinhole";
  CHECK_THROWS_WITH_AS(host::run_simulate(command, out), doctest::Contains("--camera pinhole"), host::HostError);
  command.camera = "fisheye-140";
  CHECK_THROWS_WITH_AS(host::run_simulate(command, out), doctest::Contains("not empty"), host::HostError);
  command.kind = "swim";
  CHECK_THROWS_AS(host::run_simulate(command, out), host::HostError);
}
