// SPDX-License-Identifier: Apache-2.0
#include "vision/image/frame_fifo.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

using namespace touchline;

namespace {

constexpr int w = 149, h = 5;  // two whole parts of 64 columns, and a rest
constexpr std::size_t chroma = std::size_t{(w + 1) / 2} * ((h + 1) / 2);
using Picture = Yuv420Image<w, h>;

struct Fifo {
  std::vector<std::unique_ptr<Picture>> storage;
  std::vector<Yuv420View> views;
  FrameFifo fifo;
  explicit Fifo(int depth) : storage(make(depth)), views(view(storage)), fifo(views) {}
  static std::vector<std::unique_ptr<Picture>> make(int depth) {
    std::vector<std::unique_ptr<Picture>> made;
    for (int i = 0; i < depth; ++i) made.push_back(std::make_unique<Picture>());
    return made;
  }
  static std::vector<Yuv420View> view(const std::vector<std::unique_ptr<Picture>>& storage) {
    std::vector<Yuv420View> views;
    for (const auto& picture : storage) views.push_back(picture->view());
    return views;
  }
  void push(const Picture& picture) {
    const Yuv420View slot = fifo.next_slot();
    std::copy(picture.y.samples.begin(), picture.y.samples.end(), slot.y.data);
    std::copy(picture.cb.samples.begin(), picture.cb.samples.end(), slot.cb.data);
    std::copy(picture.cr.samples.begin(), picture.cr.samples.end(), slot.cr.data);
    fifo.push();
  }
};

Picture random_picture(std::mt19937& random) {
  Picture picture;
  for (auto& v : picture.y.samples) v = static_cast<std::uint8_t>(random());
  for (auto& v : picture.cb.samples) v = static_cast<std::uint8_t>(random() | 0xF0U);  // near full scale too
  for (auto& v : picture.cr.samples) v = static_cast<std::uint8_t>(random());
  return picture;
}

}  // namespace

TEST_CASE("the mean is over the still frames, whichever they are, for every depth") {
  std::mt19937 random(1);
  for (int depth = 1; depth <= max_fifo_depth; ++depth) {
    Fifo held(depth);
    std::vector<Picture> history;
    for (int frame = 0; frame < 2 * depth + 1; ++frame) {
      history.insert(history.begin(), random_picture(random));
      held.push(history[0]);
      CHECK(held.fifo.size() == std::min(frame + 1, depth));
      bool still[max_fifo_depth];
      for (bool& s : still) s = random() % 3 != 0;
      const ConstYuv420View mean = held.fifo.mean_of_still(still);
      int count = 0;
      for (int i = 0; i < held.fifo.size(); ++i) count += i == 0 || still[i] ? 1 : 0;
      CHECK(held.fifo.frames_in_mean() == count);
      const auto expected = [&](auto&& sample) {
        int sum = count / 2;
        for (int i = 0; i < held.fifo.size(); ++i) {
          if (i == 0 || still[i]) sum += sample(history[static_cast<std::size_t>(i)]);
        }
        return sum / count;
      };
      for (std::size_t i = 0; i < w * h; ++i) {
        REQUIRE(mean.y.data[i] == expected([&](const Picture& p) { return p.y.samples[i]; }));
      }
      for (std::size_t i = 0; i < chroma; ++i) {
        REQUIRE(mean.cb.data[i] == expected([&](const Picture& p) { return p.cb.samples[i]; }));
        REQUIRE(mean.cr.data[i] == expected([&](const Picture& p) { return p.cr.samples[i]; }));
      }
    }
  }
}

TEST_CASE("one frame is its own mean, without a copy; depth one is nothing else") {
  std::mt19937 random(2);
  Picture slot;
  const Yuv420View slots[] = {slot.view()};
  FrameFifo fifo(slots);
  const Picture picture = random_picture(random);
  for (int i = 0; i < 3; ++i) {
    CHECK(fifo.next_slot().y.data == slot.y.samples.data());
    slot = picture;
    fifo.push();
    CHECK(fifo.mean_of_still({}).y.data == slot.y.samples.data());
    CHECK(fifo.frames_in_mean() == 1);
  }
}

TEST_CASE("reset empties; frames without a mark are left out") {
  std::mt19937 random(3);
  Fifo held(3);
  held.push(random_picture(random));
  held.push(random_picture(random));
  held.fifo.reset();
  CHECK(held.fifo.size() == 0);
  held.push(random_picture(random));
  const bool all[] = {true, true, true};
  static_cast<void>(held.fifo.mean_of_still(all));
  CHECK(held.fifo.frames_in_mean() == 1);
  held.push(random_picture(random));
  static_cast<void>(held.fifo.mean_of_still({}));
  CHECK(held.fifo.frames_in_mean() == 1);
  static_cast<void>(held.fifo.mean_of_still(all));
  CHECK(held.fifo.frames_in_mean() == 2);
}
