// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/publisher.h"

#include <netdb.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "platform/host/host_error.h"

namespace touchline::sbc {
namespace {

using AddressList = std::unique_ptr<addrinfo, decltype(&freeaddrinfo)>;

/// Null when the text is no numeric address with a port. Names are not looked up: that would wait for a server.
AddressList resolve(const std::string& text) {
  AddressList none(nullptr, &freeaddrinfo);
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0 || colon + 1 == text.size()) return none;
  std::string host = text.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  const std::string port = text.substr(colon + 1);
  if (port.find_first_not_of("0123456789") != std::string::npos || port.size() > 5 || std::stoi(port) < 1 ||
      std::stoi(port) > 65535) {
    return none;
  }
  addrinfo hints{};
  hints.ai_socktype = SOCK_DGRAM;
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return none;
  return {found, &freeaddrinfo};
}

}  // namespace

std::string udp_address_error(const std::string& address) {
  if (resolve(address) != nullptr) return {};
  return "\"" + address + "\" is no address; write numbers, like \"192.168.0.5:7777\" or \"[fe80::1]:7777\"";
}

Publisher::Publisher(int descriptor, const std::vector<std::string>& udp) : descriptor_(descriptor) {
  for (const std::string& text : udp) {
    const AddressList address = resolve(text);
    if (address == nullptr) throw host::HostError("output.udp: " + udp_address_error(text));
    Target target;
    target.descriptor = ::socket(address->ai_family, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (target.descriptor < 0) throw host::HostError("output.udp: no socket for " + text + ": " + std::strerror(errno));
    const int on = 1;  // an address that ends in .255 is meant
    ::setsockopt(target.descriptor, SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
    std::memcpy(&target.address, address->ai_addr, address->ai_addrlen);
    target.size = address->ai_addrlen;
    targets_.push_back(target);
  }
}

Publisher::~Publisher() {
  for (const Target& target : targets_) ::close(target.descriptor);
}

/// A pipe that is ready takes 4096 bytes undivided, so that this does not wait.
bool Publisher::write_line(std::string_view line) {
  pollfd ready{descriptor_, POLLOUT, 0};
  const int count = ::poll(&ready, 1, 0);
  if (count == 0) {
    last_error_ = EAGAIN;
    return false;
  }
  const ssize_t written = ::write(descriptor_, line.data(), line.size());
  if (written == static_cast<ssize_t>(line.size())) return true;
  last_error_ = written < 0 ? errno : ENOSPC;
  closed_ = written < 0 && errno == EPIPE;
  return false;
}

bool Publisher::publish(std::string_view line) {
  bool all = true;
  if (descriptor_ >= 0 && !closed_) all = write_line(line);
  for (const Target& target : targets_) {
    const auto* address = reinterpret_cast<const sockaddr*>(&target.address);
    if (::sendto(target.descriptor, line.data(), line.size(), MSG_NOSIGNAL, address, target.size) >= 0) continue;
    last_error_ = errno;
    all = false;
  }
  if (!all) ++dropped_;
  return all;
}

}  // namespace touchline::sbc
