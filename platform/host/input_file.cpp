// SPDX-License-Identifier: Apache-2.0
#include "platform/host/input_file.h"

#include <fstream>

#include "platform/host/host_error.h"

namespace touchline::host {
namespace {

namespace fs = std::filesystem;

/// Before anything is opened: to open a pipe may take for ever.
void check_kind(const fs::path& path, const InputFile& kind) {
  std::error_code failed;
  const fs::file_status status = fs::status(path, failed);
  if (status.type() == fs::file_type::not_found) {
    throw HostError(path.string() + ": no such " + kind.what + "; " + kind.remedy);
  }
  if (failed) throw HostError(path.string() + ": cannot be opened; check its permissions and those of its folder");
  if (fs::is_directory(status)) throw HostError(path.string() + ": is a folder, not a file; " + kind.remedy);
  if (!fs::is_regular_file(status)) {
    throw HostError(path.string() + ": is a device or a pipe, not a file; " + kind.remedy);
  }
  const std::uintmax_t size = fs::file_size(path, failed);
  if (!failed && size > kind.most_bytes) {
    throw HostError(path.string() + ": has " + std::to_string(size) + " bytes, more than " +
                    std::to_string(kind.most_bytes) + "; " + kind.remedy);
  }
}

}  // namespace

std::string read_whole_file(const fs::path& path, const InputFile& kind) {
  check_kind(path, kind);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw HostError(path.string() + ": cannot be opened; check its permissions");
  std::string bytes(16, '\0');
  in.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(in.gcount()));
  if (kind.first_bytes) kind.first_bytes(bytes);
  std::string block(std::size_t{1} << 16, '\0');
  while (in && bytes.size() <= kind.most_bytes) {  // files in /proc tell no size
    in.read(block.data(), static_cast<std::streamsize>(block.size()));
    bytes.append(block, 0, static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad() || !in.eof()) {
    throw HostError(path.string() + ": cannot be read to its end; check the disk, and that it is a usual file");
  }
  return bytes;
}

}  // namespace touchline::host
