// SPDX-License-Identifier: Apache-2.0
// libgpiod 2.x as far as the backend uses it.
#include <gpiod.h>

#include <cerrno>
#include <vector>

#include "tests/support/fake_gpiod.h"

struct gpiod_chip {
  int unused = 0;
};
struct gpiod_chip_info {
  int unused = 0;
};
struct gpiod_line_settings {
  bool output = false, pull_up = false, active_low = false;
  int value = 0;
};
struct gpiod_line_config {
  std::vector<unsigned> offsets;
  gpiod_line_settings settings;
};
struct gpiod_request_config {
  int unused = 0;
};
struct gpiod_line_request {
  std::vector<unsigned> offsets;
};

using touchline::fake::gpiod;

namespace {

gpiod_chip the_chip;

template <typename T>
T* make() {
  if (gpiod().fail_allocation) return errno = ENOMEM, nullptr;
  ++gpiod().open_objects;
  return new T();
}
template <typename T>
void destroy(T* object) {
  --gpiod().open_objects;
  delete object;
}

}  // namespace

extern "C" {

bool gpiod_is_gpiochip_device(const char* path) { return gpiod().present && gpiod().path == path; }
gpiod_chip* gpiod_chip_open(const char* path) {
  if (!gpiod_is_gpiochip_device(path)) return errno = ENOENT, nullptr;
  ++gpiod().open_chips;
  return &the_chip;
}
void gpiod_chip_close(gpiod_chip*) { --gpiod().open_chips; }
gpiod_chip_info* gpiod_chip_get_info(gpiod_chip*) { return make<gpiod_chip_info>(); }
void gpiod_chip_info_free(gpiod_chip_info* info) { destroy(info); }
const char* gpiod_chip_info_get_label(gpiod_chip_info*) { return gpiod().label.c_str(); }
size_t gpiod_chip_info_get_num_lines(gpiod_chip_info*) { return static_cast<size_t>(gpiod().line_count); }
gpiod_line_settings* gpiod_line_settings_new(void) { return make<gpiod_line_settings>(); }
void gpiod_line_settings_free(gpiod_line_settings* settings) { destroy(settings); }
int gpiod_line_settings_set_direction(gpiod_line_settings* settings, gpiod_line_direction direction) {
  settings->output = direction == GPIOD_LINE_DIRECTION_OUTPUT;
  return 0;
}
int gpiod_line_settings_set_bias(gpiod_line_settings* settings, gpiod_line_bias bias) {
  settings->pull_up = bias == GPIOD_LINE_BIAS_PULL_UP;
  return 0;
}
void gpiod_line_settings_set_active_low(gpiod_line_settings* settings, bool active_low) {
  settings->active_low = active_low;
}
int gpiod_line_settings_set_output_value(gpiod_line_settings* settings, gpiod_line_value value) {
  settings->value = value;
  return 0;
}
gpiod_line_config* gpiod_line_config_new(void) { return make<gpiod_line_config>(); }
void gpiod_line_config_free(gpiod_line_config* config) { destroy(config); }
int gpiod_line_config_add_line_settings(gpiod_line_config* config, const unsigned int* offsets, size_t count,
                                        gpiod_line_settings* settings) {
  config->offsets.assign(offsets, offsets + count);
  config->settings = *settings;
  return 0;
}
gpiod_request_config* gpiod_request_config_new(void) { return make<gpiod_request_config>(); }
void gpiod_request_config_free(gpiod_request_config* config) { destroy(config); }
void gpiod_request_config_set_consumer(gpiod_request_config*, const char*) {}
gpiod_line_request* gpiod_chip_request_lines(gpiod_chip*, gpiod_request_config*, gpiod_line_config* lines) {
  auto& fake = gpiod();
  if (fake.busy) return errno = EBUSY, nullptr;
  if (lines->settings.pull_up && !fake.has_pull_up) return errno = EINVAL, nullptr;
  for (const unsigned offset : lines->offsets) {
    if (static_cast<int>(offset) >= fake.line_count) return errno = EINVAL, nullptr;
    fake.requested[offset] = true;
    fake.output[offset] = lines->settings.output;
    fake.active_low[offset] = lines->settings.active_low;
    if (lines->settings.output) fake.level[offset] = lines->settings.value;
  }
  auto* request = make<gpiod_line_request>();
  request->offsets = lines->offsets;
  return request;
}
void gpiod_line_request_release(gpiod_line_request* request) {
  for (const unsigned offset : request->offsets) gpiod().requested[offset] = false;
  destroy(request);
}
gpiod_line_value gpiod_line_request_get_value(gpiod_line_request*, unsigned int offset) {
  if (!gpiod().present) return errno = ENODEV, GPIOD_LINE_VALUE_ERROR;
  return gpiod().level[offset] != 0 ? GPIOD_LINE_VALUE_ACTIVE : GPIOD_LINE_VALUE_INACTIVE;
}
int gpiod_line_request_set_value(gpiod_line_request*, unsigned int offset, gpiod_line_value value) {
  if (!gpiod().present) return errno = ENODEV, -1;
  gpiod().level[offset] = value;
  return 0;
}
}
