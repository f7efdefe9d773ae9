// SPDX-License-Identifier: Apache-2.0
#include "vision/stage.h"

namespace touchline {

const char* to_string(Stage stage) {
  switch (stage) {
    case Stage::average: return "average";
    case Stage::green: return "green";
    case Stage::roi: return "roi";
    case Stage::candidates: return "candidates";
    case Stage::line_mask: return "line_mask";
    case Stage::thinning: return "thinning";
    case Stage::digestion: return "digestion";
    case Stage::graph: return "graph";
    case Stage::junctions: return "junctions";
    case Stage::posts: return "posts";
    case Stage::line_points: return "line_points";
    case Stage::localize: return "localize";
    case Stage::count: break;
  }
  return "unknown stage";
}

}  // namespace touchline
