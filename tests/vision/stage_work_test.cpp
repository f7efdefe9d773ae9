// SPDX-License-Identifier: Apache-2.0
// The stages share the memory that they work in: what one leaves there must be of no meaning to the next.
#include "vision/stage_work.h"

#include <doctest/doctest.h>

#include <cstring>
#include <memory>
#include <span>

#include "platform/core/elementary.h"
#include "tests/golden/product_hashes.h"
#include "tests/vision/painted_field.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

using namespace touchline;
using namespace touchline::test;

namespace {

/// Writes all over the working memory before every stage but the graph, which goes on where digestion ended.
class Scribbler final : public StageObserver {
 public:
  Scribbler(const PipelineMemory& memory, unsigned char byte) : memory_(memory), byte_(byte) {}

 private:
  template <typename T>
  void scribble(std::span<T> memory) const {
    std::memset(static_cast<void*>(memory.data()), byte_, memory.size_bytes());
  }
  void do_begin(Stage stage) override {
    if (stage == Stage::graph) return;
    const PipelineMemory& m = memory_;
    scribble(m.masks[static_cast<std::size_t>(MaskId::scratch)]);
    scribble(m.subsample.column_sums);
    scribble(m.subsample.unpacked);
    scribble(m.subsample.work_rows);
    scribble(m.blob_search.runs);
    scribble(m.blob_search.open);
    scribble(m.blobs);
    scribble(m.hull_scratch);
    scribble(m.canny.rows);
    scribble(m.thinning.columns);
    scribble(m.thinning.marks);
    scribble(m.pieces.runs);
    scribble(m.pieces.pieces);
    scribble(m.pieces.corners);
    scribble(m.pieces.stack);
    scribble(m.graph.index.pixels);
    scribble(m.graph.index.pixels_before);
    scribble(m.graph.digestion.live);
    scribble(m.graph.digestion.parent);
    scribble(m.graph.digestion.weight);
    scribble(m.graph.graph.open);
    scribble(m.graph.graph.cluster);
    scribble(m.graph.graph.stack);
    scribble(m.graph.graph.first_pixel);
    scribble(m.graph.graph.expanded);
    scribble(std::span(m.feature_work, 1));
    scribble(m.edge_done);
  }
  void do_end(Stage /*stage*/) override {}

  PipelineMemory memory_;
  unsigned char byte_;
};

/// The middle of a field: the half line, the circle in pieces, and a line across.
Scene circle_and_lines() {
  Scene scene;
  scene.noise = 5.0F;
  scene.carpet_radius = 3.5F;
  scene.stripes = {{{1.6F, -2.5F}, {1.6F, 2.5F}}, {{0.3F, 1.6F}, {2.8F, 1.6F}}};
  constexpr int pieces = 32;
  const auto rim = [](int i) {
    const float angle = math::two_pi * static_cast<float>(i) / pieces;
    return GroundPoint{1.6F + 0.75F * math::cos(angle), 0.75F * math::sin(angle)};
  };
  for (int i = 0; i < pieces; ++i) scene.stripes.push_back({rim(i), rim(i + 1)});
  return scene;
}

struct Chain {
  std::unique_ptr<PipelineStorage<320, 240, 4>> storage = std::make_unique<PipelineStorage<320, 240, 4>>();
  Pipeline pipeline{storage->memory()};
  VisionResult result;

  Chain() {
    VisionConfig config;
    config.line_width_m = 0.10F;
    REQUIRE(pipeline.configure(config, paper_lens()) == Status::ok);
  }
  void run(const Picture& picture, StageObserver* observer) {
    REQUIRE(pipeline.process({picture.view(), 0.0, usual_pose(), {}}, result, observer) == Status::ok);
  }
};

}  // namespace

TEST_CASE("no stage reads what another has left in the working memory") {
  const Picture picture = paint(circle_and_lines(), GroundProjection(paper_lens(), usual_pose()));
  Chain clean;
  for (int shot = 0; shot < 2; ++shot) clean.run(picture, nullptr);
  REQUIRE(clean.result.features->junctions.size() > 0);
  REQUIRE(clean.result.features->has_circle);
  const ProductHashes expected = hash_products(clean.result);
  for (const unsigned char byte : {std::uint8_t{0xFF}, std::uint8_t{0xA5}}) {
    Chain dirty;
    Scribbler scribbler(dirty.storage->memory(), byte);
    for (int shot = 0; shot < 2; ++shot) dirty.run(picture, &scribbler);
    const ProductHashes found = hash_products(dirty.result);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) {
      CAPTURE(expected[i].name);
      CHECK(found[i].hash == expected[i].hash);
    }
  }
}

TEST_CASE("the working memory is as large as the largest stage needs, not as all of them") {
  using Work = StageWork<320, 240, 752>;
  CHECK(sizeof(Work) < sizeof(Work::graph) + sizeof(Work::features));
  CHECK(sizeof(Work) >= sizeof(Work::graph));
}
