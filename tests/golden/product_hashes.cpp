// SPDX-License-Identifier: Apache-2.0
#include "tests/golden/product_hashes.h"

#include <bit>

#include "platform/core/hash.h"

namespace touchline::test {
namespace {

class Hasher {
 public:
  template <typename Integer>
  void add(Integer value) {
    auto bits = static_cast<std::uint64_t>(value);
    std::uint8_t bytes[8];
    for (std::uint8_t& byte : bytes) {
      byte = static_cast<std::uint8_t>(bits & 0xFFU);
      bits >>= 8U;
    }
    hash_ = hash_bytes(bytes, sizeof bytes, hash_);
  }
  void add(bool value) { add(value ? 1U : 0U); }
  // -0 and 0 are the same value and compare equal, so they hash alike too.
  void add(float value) { add(std::bit_cast<std::uint32_t>(value == 0.0F ? 0.0F : value)); }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value == 0.0 ? 0.0 : value)); }
  void add(const PixelPoint& p) { add_all(p.u, p.v); }
  void add(const GroundPoint& p) { add_all(p.x, p.y); }
  void add(const Vec3& v) { add_all(v.x, v.y, v.z); }
  void add(const Sym2& s) { add_all(s.xx, s.xy, s.yy); }
  void add(const GridPoint& p) { add_all(p.x, p.y); }
  void add(const Pose2& p) { add_all(p.x, p.y, p.theta); }
  template <typename... Values>
  void add_all(const Values&... values) {
    (add(values), ...);
  }
  [[nodiscard]] std::uint64_t value() const { return hash_; }

 private:
  std::uint64_t hash_ = hash_seed;
};

void add_plane(Hasher& hasher, ImageView<const std::uint8_t> plane) {
  hasher.add_all(plane.width, plane.height);
  for (int y = 0; y < plane.height; ++y) {
    for (int x = 0; x < plane.width; ++x) hasher.add(plane.at(x, y));
  }
}

std::uint64_t hash_mean(const ConstYuv420View& mean) {
  Hasher hasher;
  add_plane(hasher, mean.y);
  add_plane(hasher, mean.cb);
  add_plane(hasher, mean.cr);
  return hasher.value();
}

std::uint64_t hash_mask(const ConstBitView& mask) {
  Hasher hasher;
  hasher.add_all(mask.width, mask.height);
  for (int y = 0; y < mask.height; ++y) {
    for (int word = 0; word < words_for(mask.width); ++word) hasher.add(mask.row(y)[word]);
  }
  return hasher.value();
}

std::uint64_t hash_hull(std::span<const GridPoint> hull) {
  Hasher hasher;
  for (const GridPoint& p : hull) hasher.add(p);
  return hasher.value();
}

std::uint64_t hash_widths(const LineWidthView& widths) {
  Hasher hasher;
  hasher.add_all(widths.width, widths.height);
  for (int y = 0; y < widths.height; ++y) {
    for (int x = 0; x < widths.width; ++x) hasher.add_all(widths.at(x, y).across_row, widths.at(x, y).across_column);
  }
  return hasher.value();
}

std::uint64_t hash_nodes(std::span<const MajorNode> nodes) {
  Hasher hasher;
  for (const MajorNode& node : nodes) hasher.add_all(node.at, node.weight);
  return hasher.value();
}

std::uint64_t hash_graph(const NodeGraphView& graph) {
  Hasher hasher;
  for (const GraphNode& node : graph.nodes) {
    hasher.add_all(node.at, node.degree);
    for (int i = 0; i < node.degree; ++i) hasher.add(node.edge[i]);
  }
  for (const GraphEdge& edge : graph.edges) {
    hasher.add_all(edge.node_a, edge.node_b, std::uint32_t{edge.point_count});
    for (const GridPoint& p : graph.polyline(edge)) hasher.add(p);
  }
  return hasher.value();
}

std::uint64_t hash_junctions(const Features& features) {
  Hasher hasher;
  for (const Junction& j : features.junctions) {
    hasher.add_all(static_cast<int>(j.type), j.pixel, j.ground, j.covariance, j.branches, j.confidence);
    for (int i = 0; i < j.branches; ++i) hasher.add(j.direction[static_cast<std::size_t>(i)]);
  }
  return hasher.value();
}

std::uint64_t hash_rejections(const Features& features) {
  Hasher hasher;
  for (const RejectedJunction& r : features.rejections) {
    hasher.add_all(r.pixel, r.branches, static_cast<int>(r.reason));
  }
  return hasher.value();
}

std::uint64_t hash_circle(const Features& features) {
  Hasher hasher;
  hasher.add(features.has_circle);
  if (features.has_circle) {
    const CircleObservation& c = features.circle;
    hasher.add_all(c.centre, c.covariance, c.has_half_line, c.half_line_direction, c.arc, c.confidence);
  }
  return hasher.value();
}

std::uint64_t hash_posts(const Features& features) {
  Hasher hasher;
  for (const PostObservation& p : features.posts) hasher.add_all(p.pixel, p.ground, p.covariance, p.confidence);
  return hasher.value();
}

std::uint64_t hash_line_points(const Features& features) {
  Hasher hasher;
  for (const LinePoint& p : features.line_points) {
    hasher.add_all(p.pixel, p.ground, p.dir_x, p.dir_y, p.length, p.sigma);
  }
  return hasher.value();
}

}  // namespace

ProductHashes hash_products(const VisionResult& result) {
  const Features& features = *result.features;
  ProductHashes hashes;
  hashes.push_back({"mean", hash_mean(result.mean)});
  hashes.push_back({"green", hash_mask(result.green)});
  hashes.push_back({"field", hash_mask(result.field)});
  hashes.push_back({"hull", hash_hull(result.hull)});
  hashes.push_back({"roi", hash_mask(result.roi)});
  hashes.push_back({"line_widths", hash_widths(result.line_widths)});
  hashes.push_back({"candidates", hash_mask(result.candidates)});
  hashes.push_back({"line_mask", hash_mask(result.line_mask)});
  hashes.push_back({"skeleton", hash_mask(result.skeleton)});
  hashes.push_back({"major_nodes", hash_nodes(result.major_nodes)});
  hashes.push_back({"graph", hash_graph(result.graph)});
  hashes.push_back({"junctions", hash_junctions(features)});
  hashes.push_back({"rejections", hash_rejections(features)});
  hashes.push_back({"circle", hash_circle(features)});
  hashes.push_back({"posts", hash_posts(features)});
  hashes.push_back({"line_points", hash_line_points(features)});
  return hashes;
}

std::uint64_t hash_estimate(const PoseEstimate& estimate) {
  Hasher hasher;
  hasher.add(estimate.valid);
  if (!estimate.valid) return hasher.value();
  const PoseCovariance& c = estimate.covariance;
  hasher.add_all(estimate.pose, c.xx, c.xy, c.yy, c.xt, c.yt, c.tt, estimate.confidence, estimate.settled,
                 estimate.has_mirror);
  if (estimate.has_mirror) hasher.add_all(estimate.mirror, estimate.mirror_confidence);
  hasher.add_all(estimate.explained, estimate.pitch_error, estimate.roll_error, estimate.yaw_drift);
  return hasher.value();
}

}  // namespace touchline::test
