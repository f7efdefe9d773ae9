// SPDX-License-Identifier: Apache-2.0
// How much stack the chain takes from frame to pose: a thread runs on a stack that was painted beforehand, and what has
// lost its paint was used. The thread's own start is taken off by a run that does nothing.
#include <doctest/doctest.h>
#include <pthread.h>
#include <sys/mman.h>

#include <array>
#include <memory>
#include <vector>

#include "loc/localizer.h"
#include "platform/core/rng.h"
#include "platform/processor/fastest_kernels.h"
#include "tests/support/drawn_field.h"
#include "tests/support/kernel_tables.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

namespace {

using namespace touchline;

constexpr int width = 752;
constexpr int height = 480;
constexpr std::size_t stack_bytes = 1 << 20;
constexpr std::uint8_t paint = 0xA5;

struct Chain {
  Field field;
  Lens lens;
  PipelineStorage<> storage;
  Pipeline pipeline{storage.memory()};
  Localizer localizer;
  std::vector<std::vector<std::uint8_t>> frames;
  CameraPose camera{.height = 0.58F, .pitch = radians(32.0F)};
  Status worst = Status::ok;
  VisionResult vision;
  PoseEstimate estimate;

  Chain(const Kernels& kernels, const LocKernels& loc_kernels) {
    REQUIRE(Field::create(*field_preset("small-2026"), field) == Status::ok);
    LensParameters parameters;
    parameters.focal_px = 232.9F;
    parameters.cx = 376.0F;
    parameters.cy = 240.0F;
    parameters.max_theta = radians(92.5F);
    REQUIRE(Lens::create(parameters, lens) == Status::ok);
    VisionConfig config;
    config.kernels = kernels;
    tell_vision(field.dimensions(), config);
    REQUIRE(pipeline.configure(config, lens) == Status::ok);
    LocalizerConfig loc;
    loc.landmarks = Landmarks::both;
    loc.kernels = loc_kernels;
    REQUIRE(localizer.configure(loc, field) == Status::ok);
    (void)localizer.reset({}, 1);
    const GroundProjection projection(lens, camera);
    for (int i = 0; i < 4; ++i) {
      frames.emplace_back(static_cast<std::size_t>(width * height * 3));
      test::draw_field(field, projection,
                       {-2.0F + 0.5F * static_cast<float>(i), 0.4F, radians(40.0F * static_cast<float>(i))}, width,
                       height, frames.back());
    }
    Rng rng(3);  // noise: many candidates, long lists
    frames.emplace_back(static_cast<std::size_t>(width * height * 3));
    for (std::uint8_t& byte : frames.back()) byte = static_cast<std::uint8_t>(rng.next_u32());
  }

  void run() {
    for (int i = 0; i < 12; ++i) {
      const double time_s = i / 12.0;
      const FrameView image{PixelFormat::rgb24, frames[static_cast<std::size_t>(i) % frames.size()].data(), width,
                            height, width * 3};
      const Status seen = pipeline.process({image, time_s, camera, Pose2{}}, vision);
      LocalizerInput input;
      input.time_s = time_s;
      input.has_yaw = i % 3 == 0;
      input.yaw = 0.3F;
      const Status located = localizer.update(input, vision, estimate);
      if (seen != Status::ok || located != Status::ok) worst = Status::invalid_argument;
    }
  }
};

/// Bytes of stack that a thread takes that runs `chain`, or nothing.
std::size_t stack_of(Chain* chain) {
  void* stack = mmap(nullptr, stack_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  REQUIRE(stack != MAP_FAILED);
  auto* bytes = static_cast<std::uint8_t*>(stack);
  std::fill_n(bytes, stack_bytes, paint);
  pthread_attr_t attributes;
  REQUIRE(pthread_attr_init(&attributes) == 0);
  REQUIRE(pthread_attr_setstack(&attributes, stack, stack_bytes) == 0);
  pthread_t thread;
  const auto entry = [](void* argument) -> void* {
    if (argument != nullptr) static_cast<Chain*>(argument)->run();
    return nullptr;
  };
  REQUIRE(pthread_create(&thread, &attributes, entry, chain) == 0);
  REQUIRE(pthread_join(thread, nullptr) == 0);
  pthread_attr_destroy(&attributes);
  std::size_t untouched = 0;
  while (untouched < stack_bytes && bytes[untouched] == paint) ++untouched;
  munmap(stack, stack_bytes);
  return stack_bytes - untouched;
}

void check_stack(const Kernels& kernels, const LocKernels& loc_kernels) {
  const auto chain = std::make_unique<Chain>(kernels, loc_kernels);
  const std::size_t empty = stack_of(nullptr);
  const std::size_t used = stack_of(chain.get());
  REQUIRE(chain->worst == Status::ok);
  REQUIRE(used > empty);
  MESSAGE("stack of the whole chain, ", doctest::String(kernels.name), " kernels: ", used, " bytes, ", empty,
          " of them the thread's own");
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__)
  CHECK(used <= 32 * 1024);
#endif
}

}  // namespace

TEST_CASE("the chain from frame to pose fits a stack of 32 KiB") {
  check_stack(portable_kernels(), portable_loc_kernels());
  check_stack(word_kernels(), scalar_loc_kernels());
  for (const Kernels& kernels : test::runnable_tables()) check_stack(kernels, fastest_loc_kernels());
}
