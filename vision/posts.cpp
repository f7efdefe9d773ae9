// SPDX-License-Identifier: Apache-2.0
#include "vision/posts.h"

#include <bit>

#include "platform/core/atan2_lanes.h"
#include "vision/image/bit_ops.h"
#include "vision/pixel_rays.h"

namespace touchline {
namespace {

constexpr float bin_width = math::two_pi / static_cast<float>(post_bins);
constexpr float level_height = radians(2.0F);
constexpr float lowest = radians(88.0F);         // depression of level 0
constexpr float min_depression = radians(4.0F);  // 8 m away for a camera of 0.58 m
// A post ends 1.0 m up and more; what is seen of it must go up this high, or leave the picture.
constexpr float min_height_m = 0.7F;
constexpr float min_cut_height_m = 0.3F;  // of one whose top is outside the picture
constexpr float narrowest = 0.5F;         // of the width that the distance says
constexpr float widest = 1.6F;
constexpr float width_slack_px = 1.5F;
constexpr int max_level_step = 3;  // of the foot, from one azimuth to the next
constexpr float sigma_px = 1.5F;   // working pixels of the foot: colour is known at half the resolution
constexpr float sigma_tilt = radians(0.5F);

struct Column {
  int first = -1;  // level of the foot
  int last = -1;
};

/// Rays of some pixels, side by side for vectors, and what follows from them.
struct RayBatch {
  static constexpr int most = 64;
  int count = 0;
  float x[most], y[most], z[most];
  float depression[most];
  int level[most], bin[most];

  void add(const Vec3& ray) {
    x[count] = ray.x;
    y[count] = ray.y;
    z[count] = ray.z;
    ++count;
  }
  void measure() {
    for (int i = 0; i < count; ++i) {
      depression[i] = math::atan2_lane(-z[i], math::hypot(x[i], y[i]));
      level[i] = static_cast<int>((lowest - depression[i]) / level_height);
      bin[i] = static_cast<int>((math::atan2_lane(y[i], x[i]) + math::pi) / bin_width);
    }
  }
};

class PostFinder {
 public:
  PostFinder(const WorkRays& rays, const FieldView& field, const PostParameters& parameters, PostWork& work,
             StaticVector<PostObservation, max_posts>& posts)
      : rays_(rays), field_(field), parameters_(parameters), work_(work), posts_(posts) {}

  void sort(ConstBitView colour);
  void group();

 private:
  void take(RayBatch& batch);
  void fill_gaps();
  static std::size_t bin(int i) { return static_cast<std::size_t>(i % post_bins); }
  [[nodiscard]] Column column(int i);
  /// Depression of the lower end of a level.
  [[nodiscard]] static float level_bottom(int level) { return lowest - static_cast<float>(level) * level_height; }
  /// Its tangent. Azimuths beside each other begin and end at the same few levels.
  [[nodiscard]] float slope(int level) {
    float& known = slopes_[static_cast<std::size_t>(level)];
    if (known == 0.0F) known = math::tan(math::min(level_bottom(level), radians(80.0F)));
    return known;
  }
  [[nodiscard]] bool leaves_picture(int i, float distance, float reached) const;
  void judge(int first, int last);
  [[nodiscard]] bool stands_on_carpet(float azimuth, float front) const;
  [[nodiscard]] float height() const { return rays_.projection().pose().height; }

  const WorkRays& rays_;
  const FieldView& field_;
  const PostParameters& parameters_;
  PostWork& work_;
  StaticVector<PostObservation, max_posts>& posts_;
  std::array<float, post_levels + 1> slopes_{};  // 0: not known yet
};

/// Every pixel of the colour to its azimuth and elevation.
void PostFinder::sort(ConstBitView colour) {
  work_.levels.fill(0);
  work_.depression.fill(-2.0F);
  PixelRays rays(rays_);
  RayBatch batch;
  for_each_set_bit(colour, [&](int x, int y) {
    Vec3 ray;
    if (!rays.ray({static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)}, ray)) return;
    batch.add(ray);
    if (batch.count == RayBatch::most) take(batch);
  });
  take(batch);
  fill_gaps();
}

void PostFinder::take(RayBatch& batch) {
  batch.measure();
  for (int i = 0; i < batch.count; ++i) {
    const int level = batch.level[i];
    if (level < 0 || level >= post_levels) continue;
    const std::size_t b = bin(batch.bin[i]);
    work_.levels[b] |= std::uint64_t{1} << level;
    work_.depression[b] = math::max(work_.depression[b], batch.depression[i]);
  }
  batch.count = 0;
}

/// Closes the gaps that come from pixels wider than a bin and levels finer than pixels.
void PostFinder::fill_gaps() {
  auto& levels = work_.levels;
  const std::uint64_t first = levels.front();
  std::uint64_t before = levels.back();
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const std::uint64_t own = levels[i];
    const std::uint64_t both = own | (before & (i + 1 < levels.size() ? levels[i + 1] : first));
    levels[i] = both | ((both << 1) & (both >> 1));
    before = own;
  }
}

/// The unbroken run from the lowest pixel of a bin upwards.
Column PostFinder::column(int i) {
  const std::uint64_t levels = work_.levels[bin(i)];
  if (levels == 0) return {};
  Column c;
  c.first = std::countr_zero(levels);
  c.last = c.first + std::countr_one(levels >> c.first) - 1;
  if (level_bottom(c.first) < min_depression) return {};
  const float distance = height() / slope(c.first);
  const float reached = level_bottom(c.last + 1) > radians(-80.0F) ? height() - distance * slope(c.last + 1) : 10.0F;
  if (reached < min_cut_height_m) return {};
  if (reached < min_height_m && !leaves_picture(i, distance, reached)) return {};
  return c;
}

/// Whether what lies right above a height at a distance is outside the lens or the picture.
bool PostFinder::leaves_picture(int i, float distance, float reached) const {
  const CameraPose& pose = rays_.projection().pose();
  const float azimuth = wrap_angle((static_cast<float>(i) + 0.5F) * bin_width - math::pi);
  const float above = reached + 2.5F * level_height * distance;
  WorkPoint w;
  const GroundPoint p{pose.x + distance * math::cos(azimuth), pose.y + distance * math::sin(azimuth)};
  if (!rays_.work_point(p, above, w) || !(w.u >= 1.0F && w.v >= 1.0F)) return true;
  return w.u >= static_cast<float>(rays_.work_width() - 1) || w.v >= static_cast<float>(rays_.work_height() - 1);
}

/// Azimuths beside each other whose columns begin at about the same level.
void PostFinder::group() {
  int start = 0;
  while (start < post_bins && column(start).first >= 0) ++start;  // begin where there is none
  int first = -1;
  Column before;
  for (int n = 0; n <= post_bins; ++n) {
    const int i = start + n;
    const Column c = column(i);
    const int step = c.first - before.first;
    const bool goes_on = c.first >= 0 && first >= 0 && step <= max_level_step && step >= -max_level_step;
    if (first >= 0 && !goes_on) {
      judge(first, i - 1);
      first = -1;
    }
    if (c.first >= 0 && first < 0) first = i;
    before = c;
  }
}

void PostFinder::judge(int first, int last) {
  float foot = -2.0F;
  int level = post_levels;
  for (int i = first; i <= last; ++i) {
    foot = math::max(foot, work_.depression[bin(i)]);
    const Column c = column(i);
    if (c.first < level) level = c.first;
  }
  foot += 0.5F * rays_.radians_per_pixel();  // the lower edge of the pixel
  if (!(foot > min_depression)) return;
  const float radius = 0.5F * parameters_.diameter_m;
  const float front = height() / math::tan(math::min(foot, radians(85.0F)));
  const float distance = front + radius;
  if (distance > parameters_.max_range_m) return;
  // Half a metre of the post above its foot tells azimuth and width.
  const float upper = math::atan2(height() - 0.5F, distance);
  int top = static_cast<int>((lowest - upper) / level_height);
  if (top >= post_levels) top = post_levels - 1;
  float sum = 0.0F, weights = 0.0F;
  for (int i = first; i <= last; ++i) {
    const std::uint64_t levels = work_.levels[bin(i)];
    float w = 0.0F;
    for (int k = level; k <= top; ++k) w += ((levels >> k) & 1U) != 0 ? 1.0F : 0.0F;
    sum += w * (static_cast<float>(i) + 0.5F);
    weights += w;
  }
  if (!(weights > 0.0F)) return;
  const float azimuth = wrap_angle(sum / weights * bin_width - math::pi);
  const float width = weights / static_cast<float>(top - level + 1) * bin_width;
  const float expected = 2.0F * math::asin(math::min(radius / distance, 0.9F));
  const float slack = width_slack_px * rays_.radians_per_pixel() / math::cos(math::min(foot, radians(80.0F)));
  if (width < narrowest * expected - slack || width > widest * expected + slack) return;
  if (!stands_on_carpet(azimuth, front)) return;
  const CameraPose& pose = rays_.projection().pose();
  PostObservation post;
  post.ground = {pose.x + distance * math::cos(azimuth), pose.y + distance * math::sin(azimuth)};
  if (!rays_.projection().pixel(post.ground, post.pixel)) return;
  const float camera_px = rays_.radians_per_pixel() * rays_.projection().lens().parameters().focal_px;
  post.covariance = rays_.projection().ground_covariance(post.pixel, sigma_px * camera_px, sigma_tilt);
  const float fit = width < expected ? width / expected : expected / width;
  post.confidence = math::clamp(0.5F + 0.5F * fit - 0.1F * distance, 0.1F, 1.0F);
  posts_.push_back(post);
}

/// Carpet or line is seen right before the foot: the foot is not hidden, and it stands on the field.
bool PostFinder::stands_on_carpet(float azimuth, float front) const {
  const CameraPose& pose = rays_.projection().pose();
  int seen = 0;
  for (int k = 0; k < 3; ++k) {
    const float px = (front * front + height() * height()) / height() * rays_.radians_per_pixel();
    const float d = front - px * (1.5F + static_cast<float>(k));
    WorkPoint w;
    if (!(d > 0.0F)) return false;
    if (!rays_.work_point({pose.x + d * math::cos(azimuth), pose.y + d * math::sin(azimuth)}, 0.0F, w)) return false;
    if (!(w.u >= 0.0F && w.v >= 0.0F)) return false;
    const int x = static_cast<int>(w.u);
    const int y = static_cast<int>(w.v);
    seen += field_.green.get(x, y) || field_.lines.get(x, y) ? 1 : 0;
  }
  return seen >= 2;
}

}  // namespace

int find_posts(ConstBitView colour, const WorkRays& rays, const FieldView& field, const PostParameters& parameters,
               PostWork& work, StaticVector<PostObservation, max_posts>& posts) {
  posts.clear();
  PostFinder finder(rays, field, parameters, work, posts);
  finder.sort(colour);
  finder.group();
  return static_cast<int>(posts.dropped());
}

}  // namespace touchline
