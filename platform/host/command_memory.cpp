// SPDX-License-Identifier: Apache-2.0
// `touchline memory`: the sizes of the structs that hold all state. Nothing else is allocated after start-up.
#include <cstdio>
#include <ostream>

#include "loc/localizer.h"
#include "platform/host/command_line.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

namespace touchline::host {
namespace {

void row(std::ostream& out, const char* name, std::size_t bytes) {
  char text[120];
  std::snprintf(text, sizeof text, "  %-44s %9zu bytes %8.1f KiB\n", name, bytes, static_cast<double>(bytes) / 1024.0);
  out << text;
}

template <int W, int H, int Depth>
void chain_rows(std::ostream& out, const char* title) {
  constexpr std::size_t vision = sizeof(PipelineStorage<W, H, Depth>) + sizeof(Pipeline);
  // The budget is kept by pipeline_storage.h and tests/gates/budget.txt; this is what a small board must have.
  static_assert(W != 320 || Depth != 4 || vision + sizeof(Localizer) <= 1024 * 1024);
  static_assert(W != 320 || Depth != 1 || vision + sizeof(Localizer) <= 640 * 1024);
  using Work = StageWork<W, H, max_frame_width>;
  constexpr std::size_t fifo = sizeof(Yuv420Image<W, H>) * std::size_t{Depth};
  constexpr std::size_t masks = sizeof(BitImage<W, H>) * stored_mask_count;
  constexpr std::size_t tables = (sizeof(Vec3) * static_cast<std::size_t>(ray_columns(W) * ray_rows(H))) +
                                 sizeof(LineWidth) * static_cast<std::size_t>((ray_columns(W) - 1) * (ray_rows(H) - 1));
  constexpr std::size_t named = fifo + masks + sizeof(GraphProducts<W, H>) + sizeof(Features) + sizeof(Work) + tables;
  constexpr std::size_t particles = sizeof(ParticleStorage<max_particles>) + sizeof(ResamplingStorage<max_particles>);
  constexpr std::size_t loc_named = particles + sizeof(DistanceField) + sizeof(FeatureManager);
  out << title << "\n";
  row(out, "vision: FIFO, and the mean in it", fifo);
  row(out, "vision: masks", masks);
  row(out, "vision: node graph", sizeof(GraphProducts<W, H>));
  row(out, "vision: features", sizeof(Features));
  row(out, "vision: rays of the lens, line widths", tables);
  row(out, "vision: what one stage at a time works in", sizeof(Work));
  row(out, "vision: hull, lens, configuration, the rest", vision - named);
  row(out, "vision, whole state", vision);
  row(out, "localization: particles, and to resample them", particles);
  row(out, "localization: distances to the field's lines", sizeof(DistanceField));
  row(out, "localization: feature manager", sizeof(FeatureManager));
  row(out, "localization: observation, modes, the rest", sizeof(Localizer) - loc_named);
  row(out, "localization, whole state", sizeof(Localizer));
  row(out, "vision and localization", vision + sizeof(Localizer));
}

}  // namespace

int run_memory(std::ostream& out) {
  out << "All memory of the chain; nothing is allocated after start-up.\n";
  chain_rows<320, 240, 4>(out, "320x240, FIFO of 4 frames (default)");
  chain_rows<320, 240, 1>(out, "320x240, FIFO of 1 frame");
  chain_rows<640, 480, 4>(out, "640x480, FIFO of 4 frames");
  return exit_ok;
}

}  // namespace touchline::host
