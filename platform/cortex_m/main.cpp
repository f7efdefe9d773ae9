// SPDX-License-Identifier: Apache-2.0
// The program of a microcontroller: plays the recording in flash, and says what that took.
#include <memory>
#include <new>

#include "platform/cortex_m/board.h"
#include "platform/cortex_m/playback.h"
#include "platform/cortex_m/text.h"

namespace {

// Constructed at run time, so that flash holds no image of the initial values.
alignas(touchline::board::Chain) std::byte chain_memory[sizeof(touchline::board::Chain)];

}  // namespace

extern "C" int run_program();
extern "C" int run_program() {
  using namespace touchline::board;
  auto* chain = new (static_cast<void*>(chain_memory)) Chain;
  const bool played = play(recording_in_flash, *chain);
  print(Text().add(recording_in_flash.frames.size()).add(" frames\n").c_str());
  print(Text().add("state_bytes ").add(sizeof(Chain) - frame_bytes).add("\n").c_str());
  if (stack_used() != 0) {
    print(Text().add("stack_bytes ").add(stack_used()).add("\n").c_str());
    if (stack_used() >= stack_size()) {
      print("the stack ran over its end\n");
      return 1;
    }
  }
  return played ? 0 : 1;
}
