// SPDX-License-Identifier: Apache-2.0
// "192.168.0.5:7777" or "[fe80::1%wlan0]:7777" as a socket's address. Numbers only: a name would have to be looked up,
// and that waits for a server.
#pragma once

#include <string>
#include <string_view>

#include <netinet/in.h>
#include <sys/socket.h>

namespace touchline::sbc {

class UdpAddress {
 public:
  [[nodiscard]] int family() const { return address_.ss_family; }
  [[nodiscard]] const sockaddr* get() const { return reinterpret_cast<const sockaddr*>(&address_); }
  [[nodiscard]] socklen_t size() const { return size_; }
  /// Of an IPv6 address: the network interface behind '%'; else empty.
  [[nodiscard]] const std::string& interface() const { return interface_; }
  /// Looks the interface up, which may have come, gone or changed its number (a stick was plugged). False, with errno,
  /// while there is none of that name.
  bool find_interface();

 private:
  friend std::string parse_udp_address(const std::string& text, UdpAddress& out);
  sockaddr_storage address_{};
  socklen_t size_ = 0;
  std::string interface_;
};

/// Empty when `text` is a numeric address with a port, else what is wrong with it. Whether the interface is there is
/// not asked.
std::string parse_udp_address(const std::string& text, UdpAddress& out);

}  // namespace touchline::sbc
