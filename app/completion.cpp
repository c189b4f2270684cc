// glocal completion, and glocal complete, which its scripts call.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>
#include <string_view>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "app/embedded_files.hpp"
#include "app/standard_streams.hpp"
#include "config/builtin_parts.hpp"
#include "config/experiment_params.hpp"
#include "config/field_docs.hpp"

namespace glocal::app {
namespace {

struct Candidate {
  std::string text;  ///< Of the whole word.
  std::string doc = {};
};

struct Completion {
  std::vector<Candidate> candidates;
  bool files = false;  ///< Any file or folder may stand there.
};

/// What stands before the word that is to be completed.
struct Place {
  const CLI::App* command;
  const CLI::Option* waiting = nullptr;  ///< An option whose value comes next.
  std::size_t positionals = 0;           ///< That are there already.
  bool are_options_over = false;         ///< After "--".
};

const CLI::Option* option_named(std::string_view name, const CLI::App& app, const CLI::App& command) {
  for (const CLI::App* owner : {&command, &app}) {
    for (const CLI::Option* option : owner->get_options()) {
      if (option->check_name(std::string(name))) return option;
    }
  }
  return nullptr;
}

const CLI::App* subcommand_named(const std::string& name, const CLI::App& command) {
  for (const CLI::App* sub : subcommands_of(command)) {
    if (sub->get_name() == name) return sub;
  }
  return nullptr;
}

Place place_after(const std::vector<std::string>& words, const CLI::App& app) {
  Place place{&app};
  int still_wanted = 0;
  for (std::size_t i = 0; i + 1 < words.size(); ++i) {
    const std::string& word = words[i];
    if (still_wanted > 0) {
      if (--still_wanted == 0) place.waiting = nullptr;
    } else if (!place.are_options_over && word == "--") {
      place.are_options_over = true;
    } else if (!place.are_options_over && word.size() > 1 && word.front() == '-') {
      const CLI::Option* option = option_named(word, app, *place.command);
      if (option == nullptr || option->get_items_expected_min() == 0) continue;
      place.waiting = option;
      still_wanted = option->get_items_expected_min();
    } else if (const CLI::App* sub = subcommand_named(word, *place.command); sub != nullptr) {
      place.command = sub;
      place.positionals = 0;
    } else {
      ++place.positionals;
    }
  }
  return place;
}

std::vector<Candidate> strategies(const Catalog& catalog) {
  std::vector<Candidate> found;
  for (const RegistryBase* registry : catalog.registries()) {
    for (const StrategyInfo* info : registry->all()) found.push_back({info->name, info->doc});
  }
  return found;
}

std::vector<Candidate> kinds(const Catalog& catalog) {
  std::vector<Candidate> found;
  for (const RegistryBase* registry : catalog.registries()) found.push_back({registry->kind()});
  return found;
}

std::vector<Candidate> parts_built_in(PartKind kind) {
  std::vector<Candidate> found;
  for (const BuiltinPart& part : builtin_parts(kind)) found.push_back({part.name, part.about});
  return found;
}

/// "localizer." of "localizer.mat": the parts of a path that are whole.
std::string whole_parts(const std::string& typed) {
  return typed.substr(0, typed.rfind('.') + 1);
}

std::vector<PathPart> next_parts(const std::string& whole, const Catalog& catalog) {
  ExperimentFileParams experiment(catalog);
  return parts_after(experiment, std::string_view(whole).substr(0, whole.empty() ? 0 : whole.size() - 1));
}

std::vector<Candidate> parts_of_experiments(const std::string& typed, const Catalog& catalog) {
  std::vector<Candidate> found;
  const std::string whole = whole_parts(typed);
  if (whole.empty()) found.push_back({"experiment", "The keys of an experiment file."});
  for (const PathPart& part : next_parts(whole, catalog)) found.push_back({whole + part.name, part.doc});
  return found;
}

std::vector<Candidate> subcommands(const CLI::App& command) {
  std::vector<Candidate> found;
  for (const CLI::App* sub : shown_subcommands(command))
    found.push_back({sub->get_name(), sub->get_description()});
  return found;
}

/// "localizer.matcher=ran": values of what the path leads to, as far as there are so many.
std::vector<Candidate> values_at(const std::string& path, const Catalog& catalog) {
  ExperimentFileParams experiment(catalog);
  const std::optional<PathEnd> end = find_path(experiment, path);
  std::vector<Candidate> found;
  if (!end || end->strategy != nullptr) return found;
  const auto add = [&](const std::string& value, const std::string& doc = {}) {
    found.push_back({path + "=" + value, doc});
  };
  if (end->field.type == FieldType::boolean) {
    add("true");
    add("false");
  }
  for (const auto& choice : end->field.info.choices) add(std::string(choice));
  if (end->field.registry != nullptr) {
    for (const StrategyInfo* info : end->field.registry->all()) add(info->name, info->doc);
  }
  return found;
}

/// Of --set: the next part of a path, or a value.
std::vector<Candidate> changes(const std::string& typed, const Catalog& catalog) {
  if (const std::size_t at = typed.find('='); at != std::string::npos)
    return values_at(typed.substr(0, at), catalog);
  const std::string whole = whole_parts(typed);
  std::vector<Candidate> found;
  for (const PathPart& part : next_parts(whole, catalog)) {
    if (part.has_value) found.push_back({whole + part.name + "=", part.doc});
    if (part.is_followed) found.push_back({whole + part.name + ".", part.doc});
  }
  return found;
}

/// "{pgm,png}" at the end of the type of an option whose values are known.
std::vector<Candidate> choices_of(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  const std::size_t begin = type.find('{');
  std::vector<Candidate> found;
  if (begin == std::string::npos || type.back() != '}') return found;
  for (const std::string& choice : CLI::detail::split(type.substr(begin + 1, type.size() - begin - 2), ','))
    found.push_back({choice});
  return found;
}

bool is_number(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type.starts_with("INT") || type.starts_with("UINT") || type.starts_with("FLOAT");
}

template <class... Lists>
std::vector<Candidate> together(std::vector<Candidate> first, const Lists&... others) {
  (first.insert(first.end(), others.begin(), others.end()), ...);
  return first;
}

/// What may be the value of an option, which may also be a positional one.
Completion values_of(const CLI::Option& option, const std::string& typed, const CLI::App& command,
                     const CLI::App& app, const Catalog& catalog) {
  const std::string name = option.get_name();
  if (name == "--set") return {changes(typed, catalog)};
  if (name == "TOPIC")
    return {together(subcommands(app), parts_of_experiments(typed, catalog), strategies(catalog))};
  if (name == "--case") return {parts_built_in(PartKind::the_case), true};
  if (name == "--method" && command.get_name() != "register") return {parts_built_in(PartKind::method), true};
  if (name == "KIND") return {kinds(catalog)};
  if (name == "NAME" && command.get_name() == "contract") return {strategies(catalog)};
  if (name == "NAME" && command.get_name() == "describe")
    return {together(parts_of_experiments(typed, catalog), strategies(catalog))};
  if (auto choices = choices_of(option); !choices.empty()) return {std::move(choices)};
  if (is_number(option)) return {};
  return {{}, true};
}

/// The options of a command, and those of the program that it takes, too.
std::vector<Candidate> options_of(const CLI::App& command, const CLI::App& app) {
  std::vector<Candidate> found;
  const auto add = [&](const CLI::Option& option) {
    for (const std::string& name : option.get_lnames())
      found.push_back({"--" + name, option.get_description()});
  };
  for (const CLI::Option* option : command.get_options()) add(*option);
  if (command.get_option_no_throw("--plugin") == nullptr) add(*app.get_option("--plugin"));
  return found;
}

const CLI::Option* positional(std::size_t number, const CLI::App& command) {
  const CLI::Option* last = nullptr;
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    last = option;
    if (number-- == 0) return option;
  }
  // A list takes all that follow.
  return last != nullptr && last->get_items_expected_max() > 1 ? last : nullptr;
}

Completion unfiltered(const Place& place, const std::string& typed, const CLI::App& app,
                      const Catalog& catalog) {
  const CLI::App& command = *place.command;
  if (place.waiting != nullptr) return values_of(*place.waiting, typed, command, app, catalog);
  if (!place.are_options_over && typed.starts_with("--") && typed.find('=') != std::string::npos) {
    const std::string name = typed.substr(0, typed.find('='));
    const CLI::Option* option = option_named(name, app, command);
    if (option == nullptr) return {};
    Completion values = values_of(*option, typed.substr(name.size() + 1), command, app, catalog);
    for (Candidate& candidate : values.candidates) candidate.text = name + "=" + candidate.text;
    return values;
  }
  if (!place.are_options_over && typed.starts_with("-")) return {options_of(command, app)};
  if (place.positionals == 0) {
    if (auto found = subcommands(command); !found.empty()) return {std::move(found)};
  }
  const CLI::Option* next = positional(place.positionals, command);
  return next == nullptr ? Completion{} : values_of(*next, typed, command, app, catalog);
}

/// For the last of these words, which follow the program's name. An empty one has not been begun.
Completion complete(const std::vector<std::string>& words, const CLI::App& app, const Catalog& catalog) {
  const std::string typed = words.empty() ? "" : words.back();
  Completion completion = unfiltered(place_after(words, app), typed, app, catalog);
  std::erase_if(completion.candidates,
                [&](const Candidate& candidate) { return !candidate.text.starts_with(typed); });
  return completion;
}

void print_completion(const std::vector<std::string>& words, const CLI::App& app, const Catalog& catalog) {
  const Completion completion = complete(words, app, catalog);
  for (const Candidate& candidate : completion.candidates) answer("{}\t{}\n", candidate.text, candidate.doc);
  if (completion.files) answer(":files\n");
}

}  // namespace

void add_completion(CLI::App& app, Context& context) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand(
      "completion",
      "Write a script with which a shell completes what is typed: source <(glocal completion bash).");
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  command->callback([shell] { answer(embedded_file("glocal." + *shell)); });

  auto words = std::make_shared<std::vector<std::string>>();
  CLI::App* answers =
      app.add_subcommand("complete", "Say what may be typed next; for the scripts of completion.")->group("");
  answers->add_option("WORDS", *words, "Behind the program's name, as far as they are typed");
  answers->callback([words, &app, &context] { print_completion(*words, app, context.catalog); });
}

}  // namespace glocal::app
