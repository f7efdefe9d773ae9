// SPDX-License-Identifier: Apache-2.0
// libgpiod 1.x as far as the backend uses it.
#include <gpiod.h>

#include <cerrno>

#include "tests/support/fake_gpiod.h"

struct gpiod_chip {
  int unused;
};
struct gpiod_line {
  unsigned offset;
};
struct gpiod_chip_iter {
  bool done;
};

using touchline::fake::gpiod;

namespace {

gpiod_chip the_chip;
gpiod_line the_lines[8];
gpiod_chip_iter the_iterator;

int request(gpiod_line* line, int flags, bool output) {
  auto& fake = gpiod();
  if (fake.busy) return errno = EBUSY, -1;
  if ((flags & GPIOD_LINE_REQUEST_FLAG_BIAS_PULL_UP) != 0 && !fake.has_pull_up) return errno = EINVAL, -1;
  fake.requested[line->offset] = true;
  fake.output[line->offset] = output;
  fake.active_low[line->offset] = (flags & GPIOD_LINE_REQUEST_FLAG_ACTIVE_LOW) != 0;
  return 0;
}

}  // namespace

extern "C" {

gpiod_chip* gpiod_chip_open_lookup(const char* name) {
  auto& fake = gpiod();
  if (!fake.present || (fake.path != name && fake.label != name)) return errno = ENOENT, nullptr;
  ++fake.open_chips;
  return &the_chip;
}
void gpiod_chip_close(gpiod_chip*) { --gpiod().open_chips; }
gpiod_line* gpiod_chip_get_line(gpiod_chip*, unsigned offset) {
  if (static_cast<int>(offset) >= gpiod().line_count) return errno = EINVAL, nullptr;
  the_lines[offset].offset = offset;
  return &the_lines[offset];
}
int gpiod_line_request_input_flags(gpiod_line* line, const char*, int flags) { return request(line, flags, false); }
int gpiod_line_request_output_flags(gpiod_line* line, const char*, int flags, int value) {
  const int result = request(line, flags, true);
  if (result == 0) gpiod().level[line->offset] = value;
  return result;
}
void gpiod_line_release(gpiod_line* line) { gpiod().requested[line->offset] = false; }
int gpiod_line_get_value(gpiod_line* line) {
  if (!gpiod().present) return errno = ENODEV, -1;
  return gpiod().level[line->offset];
}
int gpiod_line_set_value(gpiod_line* line, int value) {
  if (!gpiod().present) return errno = ENODEV, -1;
  gpiod().level[line->offset] = value;
  return 0;
}
gpiod_chip_iter* gpiod_chip_iter_new(void) {
  the_iterator.done = !gpiod().present;
  return &the_iterator;
}
void gpiod_chip_iter_free(gpiod_chip_iter*) {}
gpiod_chip* gpiod_chip_iter_next(gpiod_chip_iter* iterator) {
  if (iterator->done) return nullptr;
  iterator->done = true;
  return &the_chip;
}
const char* gpiod_chip_name(gpiod_chip*) { return "gpiochip0"; }
const char* gpiod_chip_label(gpiod_chip*) { return gpiod().label.c_str(); }
unsigned gpiod_chip_num_lines(gpiod_chip*) { return static_cast<unsigned>(gpiod().line_count); }
}
