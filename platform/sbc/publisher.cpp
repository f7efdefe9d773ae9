// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/publisher.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "platform/host/host_error.h"

namespace touchline::sbc {

Publisher::Publisher(int descriptor, const std::vector<std::string>& udp) : writer_(descriptor) {
  for (const std::string& text : udp) {
    Target target;
    target.text = "udp " + text;
    const std::string wrong = parse_udp_address(text, target.address);
    if (!wrong.empty()) throw host::HostError("output.udp: " + wrong);
    target.descriptor = ::socket(target.address.family(), SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (target.descriptor < 0) throw host::HostError("output.udp: no socket for " + text + ": " + std::strerror(errno));
    const int on = 1;  // an address that ends in .255 is meant
    ::setsockopt(target.descriptor, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    targets_.push_back(target);
  }
}

Publisher::~Publisher() {
  for (const Target& target : targets_) ::close(target.descriptor);
}

void Publisher::note(const char* where, int error) {
  last_error_ = error;
  const char* why = error == EAGAIN ? "its reader is too slow" : error == EPIPE ? "nobody reads it any more" : nullptr;
  std::snprintf(problem_.data(), problem_.size(), "%s: %s", where, why != nullptr ? why : std::strerror(error));
}

bool Publisher::publish(std::string_view line) {
  bool all = true;
  const int error = writer_.write(line);
  if (error != 0) {
    ++lines_lost_;
    line_error_ = error;
    note("standard output", error);
    all = false;
  }
  for (Target& target : targets_) {
    if (target.address.find_interface() && ::sendto(target.descriptor, line.data(), line.size(), MSG_NOSIGNAL,
                                                    target.address.get(), target.address.size()) >= 0) {
      continue;
    }
    note(target.text.c_str(), errno);
    all = false;
  }
  if (!all) ++dropped_;
  return all;
}

}  // namespace touchline::sbc
