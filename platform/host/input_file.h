// SPDX-License-Identifier: Apache-2.0
// Files that a user names: read whole, and only where they are files. A device or a pipe has no end and may never
// answer; a failed read must not pass for a short file.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace touchline::host {

struct InputFile {
  std::string what;            // "image": a missing one is "no such image"
  std::string remedy;          // for a file that is missing or of another kind
  std::size_t most_bytes = 0;  // more is a file of another kind, too
  /// Sees the first bytes (at most 16) before the rest is read; throws HostError for a file of another kind.
  std::function<void(std::string_view)> first_bytes = {};
};

/// Throws HostError: missing, a folder, a device or pipe, too large, not to be opened, or not read to its end.
std::string read_whole_file(const std::filesystem::path& path, const InputFile& kind);

}  // namespace touchline::host
