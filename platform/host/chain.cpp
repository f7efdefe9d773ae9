// SPDX-License-Identifier: Apache-2.0
// Pipeline and localizer with their memory on the heap.
#include "platform/host/chain.h"

#include <string>

#include "platform/host/host_error.h"
#include "platform/processor/fastest_kernels.h"
#include "vision/pipeline.h"
#include "vision/pipeline_storage.h"

namespace touchline::host {
namespace {

constexpr int fifo_depth = 4;  // as in the paper

bool same(const CameraSetup& a, const CameraSetup& b) {
  const LensParameters& p = a.lens;
  const LensParameters& q = b.lens;
  return a.width == b.width && a.height == b.height && p.model == q.model && p.focal_px == q.focal_px && p.cx == q.cx &&
         p.cy == q.cy && p.max_theta == q.max_theta && p.k == q.k && p.alpha == q.alpha && p.a == q.a && p.b == q.b;
}

[[noreturn]] void refused(const char* what, const char* part, Status status) {
  throw HostError(std::string(part) + " refuses its configuration" + (what != nullptr ? std::string(": ") + what : "") +
                  " (" + touchline::to_string(status) + "); check the data set's camera and field");
}

/// Storage of one of the sizes that are offered.
struct AnyStorage {
  virtual ~AnyStorage() = default;
  virtual PipelineMemory memory() = 0;
};
template <int W, int H>
struct SizedStorage final : AnyStorage {
  PipelineStorage<W, H, fifo_depth> storage;
  PipelineMemory memory() override { return storage.memory(); }
};

std::unique_ptr<AnyStorage> make_storage(const ChainOptions& options) {
  if (options.work_width == 320 && options.work_height == 240) return std::make_unique<SizedStorage<320, 240>>();
  if (options.work_width == 640 && options.work_height == 480) return std::make_unique<SizedStorage<640, 480>>();
  throw HostError("working size " + std::to_string(options.work_width) + "x" + std::to_string(options.work_height) +
                  " is not offered; choose 320x240 or 640x480");
}

}  // namespace

struct Chain::Parts {
  explicit Parts(const ChainOptions& chain_options)
      : options(chain_options), storage(make_storage(chain_options)), pipeline(storage->memory()) {}

  ChainOptions options;
  std::unique_ptr<AnyStorage> storage;
  Pipeline pipeline;
  Localizer localizer;
  CameraSetup camera;  // that the pipeline is configured for
  VisionResult vision;
};

Chain::Chain(const ChainOptions& options, const FieldDimensions& dimensions)
    : parts_(std::make_unique<Parts>(options)) {
  const char* what = nullptr;
  Field field;
  if (const Status status = Field::create(dimensions, field, &what); status != Status::ok)
    refused(what, "the field", status);
  LocalizerConfig config;
  config.kernels = fastest_loc_kernels();
  config.model = options.model;
  config.landmarks = options.landmarks;
  config.particles = options.particles;
  const Status status = parts_->localizer.configure(config, field, &what);
  if (status != Status::ok) refused(what, "localization", status);
}
Chain::~Chain() = default;

void Chain::forget(std::uint64_t seed) {
  parts_->pipeline.reset();
  (void)parts_->localizer.reset(Prior{}, seed);
}

const VisionResult& Chain::see(const FrameView& image, double time_s, const CameraSetup& camera, const Pose2& odometry,
                               StageObserver* observer) {
  const char* what = nullptr;
  if (!same(camera, parts_->camera)) {
    if (camera.width < parts_->options.work_width || camera.height < parts_->options.work_height) {
      throw HostError("images of " + std::to_string(camera.width) + "x" + std::to_string(camera.height) +
                      " are smaller than the working size " + std::to_string(parts_->options.work_width) + "x" +
                      std::to_string(parts_->options.work_height) + "; choose a smaller --work or larger images");
    }
    VisionConfig config;
    config.frame_width = camera.width;
    config.frame_height = camera.height;
    config.work_width = parts_->options.work_width;
    config.work_height = parts_->options.work_height;
    config.fifo_depth = fifo_depth;
    tell_vision(field().dimensions(), config);
    config.kernels = fastest_kernels();
    Lens lens;
    Status status = Lens::create(camera.lens, lens, &what);
    if (status != Status::ok) refused(what, "the lens", status);
    status = parts_->pipeline.configure(config, lens, &what);
    if (status != Status::ok) refused(what, "vision", status);
    parts_->camera = camera;
  }
  FrameInput input;
  input.image = image;
  input.time_s = time_s;
  input.camera = camera.mount;
  input.odometry = odometry;
  const Status status = parts_->pipeline.process(input, parts_->vision, observer);
  if (status != Status::ok) throw FrameError(std::string("vision refuses a frame: ") + touchline::to_string(status));
  return parts_->vision;
}

PoseEstimate Chain::locate(const LocalizerInput& input, StageObserver* observer) {
  PoseEstimate estimate;
  const Status status = parts_->localizer.update(input, parts_->vision, estimate, observer);
  if (status != Status::ok)
    throw FrameError(std::string("localization refuses a frame: ") + touchline::to_string(status));
  return estimate;
}

const VisionResult& Chain::vision() const { return parts_->vision; }
const Field& Chain::field() const { return parts_->localizer.field(); }

std::vector<Pose2> Chain::particles() {
  const ParticleView view = parts_->localizer.particles();
  std::vector<Pose2> out;
  out.reserve(static_cast<std::size_t>(view.count));
  for (int i = 0; i < view.count; ++i) out.push_back(view.pose(i));
  return out;
}

}  // namespace touchline::host
