// SPDX-License-Identifier: Apache-2.0
// What the stages work in and leave to nobody: in one place, one stage after the other. Every stage writes there before
// it reads; what it finds there is of no meaning to it (tests/vision/stage_work_test.cpp). The node graph alone goes on
// where digestion ended: with the index and the labels of GraphWork.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "vision/graph_storage.h"
#include "vision/image/bit_image.h"
#include "vision/image/blobs.h"
#include "vision/image/canny.h"
#include "vision/image/hull.h"
#include "vision/image/subsample.h"
#include "vision/image/thinning.h"
#include "vision/junctions.h"
#include "vision/short_pieces.h"

namespace touchline {

template <int W, int H, int FrameWidth>
union StageWork {
  struct Roi {
    BlobStorage<W> search{};
    std::array<Blob, 64> blobs{};  // pieces of green, largest first kept: the field, boards, chairs, clothes
    std::array<GridPoint, static_cast<std::size_t>(max_hull_points(H)) + 1> hull{};
  };
  struct Masks {
    BitImage<W, H> scratch{};
    union {
      CannyStorage<W> canny;
      ThinningStorage<W, H> thinning;  // what it deletes is in `scratch`
    };
    constexpr Masks() : canny() {}
  };
  struct FeatureSearch {
    FeatureWork work{};
    std::array<std::uint8_t, GraphCapacity<W, H>::edges> edge_done{};
  };

  SubsampleRows<FrameWidth, W> average;
  Roi roi;
  Masks masks;  // of candidates, line mask, thinning, line points
  PieceStorage<W, H> pieces;
  GraphWork<W, H> graph;
  FeatureSearch features;  // of junctions and posts

  constexpr StageWork() : average() {}
};

}  // namespace touchline
