// SPDX-License-Identifier: Apache-2.0
// The file of figures: what is worse is told, what is better or equal is not.
#include "platform/host/figures.h"

#include <limits>
#include <sstream>

#include <doctest/doctest.h>

#include "tests/host/temp_folder.h"

namespace touchline::host {
namespace {

Figures two(double distance, double share) {
  return {{"distance", distance, true, 0.10, 0.02, "m"}, {"share", share, false, 90.0, std::nullopt, "%"}};
}

TEST_CASE("worse figures are named, in both directions") {
  const TempFolder folder;
  const auto file = folder.path() / "figures.json";
  write_figures(file, two(0.05, 95.0));
  std::ostringstream out;
  CHECK(worse_than_file(file, two(0.05, 95.0), out).empty());
  CHECK(worse_than_file(file, two(0.04, 96.0), out).empty());
  CHECK(out.str().empty());
  const auto worse = worse_than_file(file, two(0.051, 94.0), out);
  REQUIRE(worse.size() == 2);
  CHECK(worse[0] == "distance: 0.051 m, was 0.050 m");
  CHECK(worse[1] == "share: 94.00 %, was 95.00 %");
}

TEST_CASE("a lost figure is worse than any; a figure that was never there cannot be worse") {
  const TempFolder folder;
  const auto file = folder.path() / "figures.json";
  const double none = std::numeric_limits<double>::infinity();
  write_figures(file, two(0.05, 95.0));
  std::ostringstream out;
  CHECK(worse_than_file(file, two(none, 95.0), out).size() == 1);
  CHECK(worse_than_file(file, {two(0.05, 95.0)[0]}, out).empty());
  CHECK(contains(out.str(), "not run: share"));
  write_figures(file, two(none, 95.0));
  CHECK(worse_than_file(file, two(none, 95.0), out).empty());
}

TEST_CASE("the table shows value, must, aim and what was missed") {
  std::ostringstream out;
  print_figures(out, two(0.05, 80.0));
  CHECK(contains(out.str(), "<= 0.100 m"));
  CHECK(contains(out.str(), "aim missed"));
  CHECK(contains(out.str(), "MUST MISSED"));
  CHECK_FALSE(all_musts_met(two(0.05, 80.0)));
  CHECK(all_musts_met(two(0.05, 90.0)));
}

TEST_CASE("a missing or broken file says what to do") {
  const TempFolder folder;
  std::ostringstream out;
  CHECK(contains(error_of([&] { (void)worse_than_file(folder.path() / "no.json", {}, out); }), "--rewrite"));
  const auto broken = folder.write("broken.json", "{");
  CHECK(contains(error_of([&] { (void)worse_than_file(broken, {}, out); }), "not a file of figures"));
}

}  // namespace
}  // namespace touchline::host
