// SPDX-License-Identifier: Apache-2.0
// Reads TOML by toml++ and turns the tree into a JSON value.
#include "platform/host/toml_file.h"

#include <sstream>

#include <toml++/toml.h>
#include <nlohmann/json.hpp>

#include "platform/host/host_error.h"
#include "platform/host/input_file.h"

namespace touchline::host {
namespace {

constexpr std::size_t most_bytes = std::size_t{4} << 20;  // written by hand: a few KiB

// NOLINTNEXTLINE(misc-no-recursion): a tree, as deep as the file is nested; toml++ bounds that
nlohmann::json to_json(const toml::node& node, const std::string& name, TomlLines& lines) {
  if (node.source().begin.line > 0) lines.emplace(name, static_cast<int>(node.source().begin.line));
  if (const auto* table = node.as_table()) {
    auto out = nlohmann::json::object();
    for (const auto& [key, value] : *table) {
      const std::string word(key.str());
      std::string path = name;
      path.append(name.empty() ? "" : ".").append(word);
      out[word] = to_json(value, path, lines);
    }
    return out;
  }
  if (const auto* array = node.as_array()) {
    auto out = nlohmann::json::array();
    for (const auto& value : *array) out.push_back(to_json(value, name, lines));
    return out;
  }
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* number = node.as_floating_point()) return number->get();
  if (const auto* truth = node.as_boolean()) return truth->get();
  std::ostringstream date;  // or a time: no type of JSON, and no text either
  node.visit([&date](const auto& value) { date << value; });
  const std::string text = date.str();
  return nlohmann::json::binary({text.begin(), text.end()});
}

}  // namespace

nlohmann::json read_toml(const std::filesystem::path& path, const std::string& remedy, TomlLines& lines) {
  const std::string text = read_whole_file(path, {"file", remedy, most_bytes});
  try {
    auto root = to_json(toml::parse(text, path.string()), "", lines);
    lines.erase("");
    return root;
  } catch (const toml::parse_error& error) {
    throw HostError(path.string() + ":" + std::to_string(error.source().begin.line) +
                    ": not valid TOML: " + std::string(error.description()) + "; correct that line");
  }
}

}  // namespace touchline::host
