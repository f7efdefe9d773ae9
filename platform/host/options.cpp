// SPDX-License-Identifier: Apache-2.0
// The options of the command line, checked in one place.
#include "platform/host/options.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "platform/host/host_error.h"
#include "platform/host/key_reader.h"

namespace touchline::host {
namespace {

[[noreturn]] void refuse(const CLI::App& app, const std::string& name, const std::string& value,
                         const std::string& remedy) {
  throw HostError(app.get_name() + " " + name + " " + (value.empty() ? "\"\"" : value) + ": " + remedy);
}

std::string in_words(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

/// The whole text as a number; nothing when it is none, or too large for the type.
template <typename Number>
std::optional<Number> parsed(const std::string& text) {
  Number value{};
  const char* const end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end) return std::nullopt;
  return value;
}

std::string list_of(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += (text.empty() ? "" : &word == &words.back() ? " or " : ", ") + word;
  return text;
}

CLI::Option* add_checked(CLI::App& app, const std::string& name, const std::string& type, const std::string& help,
                         const std::function<void(const std::string&)>& take) {
  return app.add_option_function<std::string>(name, take, help)->option_text(type);
}

double checked_number(const CLI::App& app, const std::string& name, const std::string& text, double low, double high) {
  const auto value = parsed<double>(text);
  if (!value || !std::isfinite(*value) || *value < low || *value > high) {
    refuse(app, name, text, "write a number from " + in_words(low) + " to " + in_words(high));
  }
  return *value;
}

/// "2 to 3600", and the default where there is one.
std::string with_range(const std::string& help, const std::string& low, const std::string& high,
                       const std::string& initial) {
  return help + "; " + low + " to " + high + (initial.empty() ? "" : " [" + initial + "]");
}

const CLI::App& parsed_command(const CLI::App& app) {
  const auto commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

std::vector<std::string> names_of_options(const CLI::App& app) {
  std::vector<std::string> names;
  for (const auto* option : app.get_options([](const CLI::Option* o) { return o->nonpositional(); })) {
    names.push_back(option->get_name());
  }
  return names;
}

bool has_unknown_option(const CLI::App& command) {
  const std::vector<std::string> left = command.remaining();
  return std::any_of(left.begin(), left.end(), [](const std::string& word) { return word.starts_with("-"); });
}

/// An argument that nobody wants: a word in a command's place, or an option that the command has not.
std::string unexpected_argument(const CLI::App& app) {
  const CLI::App& command = parsed_command(app);
  const bool top = &command == &app || !app.remaining().empty();
  const std::vector<std::string> left = top ? app.remaining() : command.remaining();
  const std::string word = left.empty() ? std::string("an argument") : left.front();
  std::vector<std::string> known;
  if (top) {
    for (const auto* sub : app.get_subcommands({})) known.push_back(sub->get_name());
  } else {
    known = names_of_options(command);
  }
  const std::string near = nearest_word(word.substr(0, word.find('=')), known);
  const std::string which = near.empty() ? std::string() : "; did you mean " + near + "?";
  if (!top) {
    const char* what = word.starts_with("-") ? ": no such option" : ": one argument too many";
    return command.get_name() + " " + word + what + which + "; see touchline " + command.get_name() + " --help";
  }
  if (word.starts_with("-")) return word + ": no option of the program; options stand after the command";
  return word + ": no such command" + (near.empty() ? "; there are " + list_of(known) : which);
}

}  // namespace

void add_number(CLI::App& app, const std::string& name, double& to, double low, double high, const std::string& help) {
  add_checked(
      app, name, "NUMBER", with_range(help, in_words(low), in_words(high), in_words(to)),
      [&app, &to, name, low, high](const std::string& text) { to = checked_number(app, name, text, low, high); });
}

void add_number(CLI::App& app, const std::string& name, std::optional<double>& to, double low, double high,
                const std::string& help) {
  add_checked(
      app, name, "NUMBER", with_range(help, in_words(low), in_words(high), ""),
      [&app, &to, name, low, high](const std::string& text) { to = checked_number(app, name, text, low, high); });
}

void add_whole(CLI::App& app, const std::string& name, int& to, int low, int high, const std::string& help) {
  const auto take = [&app, &to, name, low, high](const std::string& text) {
    const auto value = parsed<int>(text);
    if (!value || *value < low || *value > high) {
      refuse(app, name, text, "write a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    }
    to = *value;
  };
  add_checked(app, name, "COUNT", with_range(help, std::to_string(low), std::to_string(high), std::to_string(to)),
              take);
}

void add_whole(CLI::App& app, const std::string& name, std::uint64_t& to, const std::string& help) {
  const auto take = [&app, &to, name](const std::string& text) {
    const auto value = parsed<std::uint64_t>(text);
    if (!value) {
      refuse(app, name, text,
             "write a whole number from 0 to " + std::to_string(std::numeric_limits<std::uint64_t>::max()));
    }
    to = *value;
  };
  add_checked(app, name, "COUNT", help + " [" + std::to_string(to) + "]", take);
}

CLI::Option* add_text(CLI::App& app, const std::string& name, std::string& to, const std::string& help) {
  const auto take = [&app, &to, name](const std::string& text) {
    if (text.empty()) refuse(app, name, text, "is empty; write a name, or leave the option out");
    to = text;
  };
  return add_checked(app, name, "NAME", help + (to.empty() ? "" : " [" + to + "]"), take);
}

void add_texts(CLI::App& app, const std::string& name, std::vector<std::string>& to, const std::string& help) {
  const auto take = [&app, &to, name](const std::vector<std::string>& texts) {
    for (const auto& text : texts) {
      if (text.empty()) refuse(app, name, text, "is empty; write a name");
    }
    to = texts;
  };
  app.add_option_function<std::vector<std::string>>(name, take, help)->required()->option_text("...");
}

void add_choice(CLI::App& app, const std::string& name, const std::vector<std::string>& known, std::size_t initial,
                const std::function<void(std::size_t)>& take, const std::string& help) {
  const auto find = [&app, name, known, take](const std::string& text) {
    for (std::size_t i = 0; i < known.size(); ++i) {
      if (known[i] == text) return take(i);
    }
    const std::string near = nearest_word(text, known);
    refuse(app, name, text, "write " + list_of(known) + (near.empty() ? "" : "; did you mean " + near + "?"));
  };
  add_checked(app, name, "WORD", help + "; " + list_of(known) + " [" + known[initial] + "]", find);
}

void add_choice(CLI::App& app, const std::string& name, std::string& to, const std::vector<std::string>& known,
                const std::string& help) {
  std::size_t initial = 0;
  while (initial + 1 < known.size() && known[initial] != to) ++initial;
  add_choice(
      app, name, known, initial, [&to, known](std::size_t i) { to = known[i]; }, help);
}

void refuse_option(const CLI::App& app, const std::string& name, const std::string& why) {
  if (app.count(name) > 0) throw HostError(app.get_name() + " " + name + ": " + why);
}

std::string usage_error(const CLI::App& app, const CLI::ParseError& error) {
  const CLI::App& command = parsed_command(app);
  // What is missing may be there, misspelt: that is said first.
  const bool misspelt = dynamic_cast<const CLI::RequiredError*>(&error) != nullptr && has_unknown_option(command);
  if (misspelt || dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) return unexpected_argument(app);
  std::string what = error.what();
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr) {
    const std::string option = what.substr(0, what.find(':'));
    what =
        option + (what.find("missing") != std::string::npos ? ": its value is missing" : ": is given more than once");
  }
  const std::string name = &command == &app ? std::string() : command.get_name() + " ";
  return name + what + "; see touchline " + name + "--help";
}

}  // namespace touchline::host
