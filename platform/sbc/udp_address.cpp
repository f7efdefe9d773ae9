// SPDX-License-Identifier: Apache-2.0
#include "platform/sbc/udp_address.h"

#include <arpa/inet.h>
#include <net/if.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>

namespace touchline::sbc {
namespace {

std::optional<std::uint16_t> parse_port(const std::string& text) {
  if (text.empty() || text.size() > 5 || text.find_first_not_of("0123456789") != std::string::npos) return {};
  const int port = std::stoi(text);
  if (port < 1 || port > 65535) return {};
  return static_cast<std::uint16_t>(port);
}

bool needs_interface(const in6_addr& address) {
  return IN6_IS_ADDR_LINKLOCAL(&address) || IN6_IS_ADDR_MC_LINKLOCAL(&address);
}

}  // namespace

bool UdpAddress::find_interface() {
  if (interface_.empty()) return true;
  unsigned index = if_nametoindex(interface_.c_str());
  if (index == 0 && interface_.find_first_not_of("0123456789") == std::string::npos) {
    index = static_cast<unsigned>(std::strtoul(interface_.c_str(), nullptr, 10));
  }
  if (index == 0) {
    errno = ENODEV;
    return false;
  }
  reinterpret_cast<sockaddr_in6*>(&address_)->sin6_scope_id = index;
  return true;
}

std::string parse_udp_address(const std::string& text, UdpAddress& out) {
  std::string no_address =
      "\"" + text + "\" is no address; write numbers and a port, like \"192.168.0.5:7777\" or \"[fd00::5]:7777\"";
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos || colon == 0) return no_address;
  const auto port = parse_port(text.substr(colon + 1));
  if (!port) return no_address;
  std::string host = text.substr(0, colon);
  if (host.find(':') == std::string::npos) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(*port);
    if (inet_pton(AF_INET, host.c_str(), &address.sin_addr) != 1) return no_address;
    std::memcpy(&out.address_, &address, sizeof address);
    out.size_ = sizeof address;
    out.interface_.clear();
    return {};
  }
  if (!host.starts_with('[') || !host.ends_with(']')) {
    return "\"" + text +
           "\" does not tell address from port; write an IPv6 address in brackets, like \"[fd00::5]:7777\"";
  }
  host = host.substr(1, host.size() - 2);
  const std::size_t percent = host.find('%');
  out.interface_ = percent == std::string::npos ? std::string() : host.substr(percent + 1);
  sockaddr_in6 address{};
  address.sin6_family = AF_INET6;
  address.sin6_port = htons(*port);
  if (inet_pton(AF_INET6, host.substr(0, percent).c_str(), &address.sin6_addr) != 1) return no_address;
  if (percent != std::string::npos && (out.interface_.empty() || out.interface_.size() >= IF_NAMESIZE)) {
    return "\"" + text + "\" names no network interface behind '%'; see `ip link`";
  }
  if (percent == std::string::npos && needs_interface(address.sin6_addr)) {
    return "\"" + text + "\" is an address of one link; say which, like \"[fe80::1%wlan0]:7777\" (see `ip link`)";
  }
  std::memcpy(&out.address_, &address, sizeof address);
  out.size_ = sizeof address;
  return {};
}

}  // namespace touchline::sbc
