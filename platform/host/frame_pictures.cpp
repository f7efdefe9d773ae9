// SPDX-License-Identifier: Apache-2.0
#include "platform/host/frame_pictures.h"

#include <map>
#include <optional>
#include <set>

#include <sys/stat.h>

#include "platform/host/evaluate.h"
#include "platform/host/host_error.h"

namespace touchline::host {
namespace {

namespace fs = std::filesystem;

/// A file or folder by what it is, whatever path, symbolic or hard link leads to it.
using Identity = std::pair<dev_t, ino_t>;
std::optional<Identity> identity_of(const fs::path& path) {
  struct stat about {};
  if (::stat(path.c_str(), &about) != 0) return std::nullopt;
  return Identity{about.st_dev, about.st_ino};
}

fs::path folder_of(const fs::path& image) { return image.has_parent_path() ? image.parent_path() : fs::path("."); }

/// The images of all sets and their folders, with a path to tell.
std::map<Identity, fs::path> inputs_of(const std::vector<DataSet>& sets) {
  std::map<Identity, fs::path> inputs;
  const auto add = [&inputs](const fs::path& path) {
    if (const auto identity = identity_of(path)) inputs.emplace(*identity, path);
  };
  for (const auto& set : sets) {
    for (const auto& frame : set.frames) {
      add(frame.path);
      add(folder_of(frame.path));
    }
  }
  return inputs;
}

constexpr const char* remedy = "; choose another --frames folder, e.g. --frames annotated";

}  // namespace

fs::path picture_folder(const std::string& frames_out, const std::string& set_name) {
  return fs::path(frames_out) / folder_name(set_name);
}

std::vector<std::string> picture_names(const std::vector<DataFrame>& frames) {
  std::set<std::string> taken;
  std::vector<std::string> names;
  names.reserve(frames.size());
  for (const auto& frame : frames) {
    const std::string stem = frame.path.stem().string();
    std::string name = stem;
    for (int number = 2; !taken.insert(name).second; ++number) name = stem + "-" + std::to_string(number);
    names.push_back(name + ".png");
  }
  return names;
}

void refuse_to_overwrite(const std::vector<DataSet>& sets, const std::string& frames_out) {
  if (frames_out.empty()) return;
  const auto inputs = inputs_of(sets);
  for (const auto& set : sets) {
    const fs::path folder = picture_folder(frames_out, set.name);
    const auto here = identity_of(folder);
    if (here && inputs.contains(*here)) {
      throw HostError("--frames " + frames_out + ": the annotated pictures of " + set.name + " would go into " +
                      folder.string() + ", among the images that are read" + remedy);
    }
    for (const auto& name : picture_names(set.frames)) {
      const auto file = identity_of(folder / name);
      const auto found = file ? inputs.find(*file) : inputs.end();
      if (found == inputs.end()) continue;
      throw HostError("--frames " + frames_out + ": " + (folder / name).string() + " would be written over the image " +
                      found->second.string() + remedy);
    }
  }
}

}  // namespace touchline::host
