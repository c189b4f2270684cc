// glocal manual: manual pages, made of what --help says.
#include <fmt/format.h>

#include <cctype>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "app/command_line.hpp"
#include "app/commands.hpp"
#include "evaluation/results/output_folder.hpp"
#include "version.hpp"

namespace glocal::app {
namespace {

/// As roff prints it: no hyphens where minus signs are meant, and no line that it takes for a request.
std::string roff(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      if ((c == '.' || c == '\'') && (escaped.empty() || escaped.back() == '\n')) escaped += "\\&";
      escaped += c;
    }
  }
  return escaped;
}

std::string bold(std::string_view text) {
  return "\\fB" + roff(text) + "\\fR";
}

std::string italic(std::string_view text) {
  return "\\fI" + roff(text) + "\\fR";
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

/// "glocal map build", as "glocal-map-build" if `separator` is '-'.
std::string full_name(const CLI::App& command, char separator) {
  const CLI::App* parent = command.get_parent();
  return parent == nullptr ? command.get_name()
                           : full_name(*parent, separator) + separator + command.get_name();
}

std::string synopsis(const CLI::App& command) {
  std::string text = ".SH SYNOPSIS\n" + bold(full_name(command, ' ')) + " [" + italic("OPTIONS") + "]";
  for (const CLI::Option* option : command.get_options()) {
    if (!option->get_positional()) continue;
    const std::string name =
        italic(option->get_name()) + (option->get_items_expected_max() > 1 ? " ..." : "");
    text += option->get_required() ? " " + name : " [" + name + "]";
  }
  if (!shown_subcommands(command).empty()) text += " " + italic("COMMAND") + " ...";
  return text + "\n";
}

/// The arguments of a command, or its options.
std::string options_section(const CLI::App& command, bool are_positional) {
  std::string text;
  const CLI::Formatter formatter;
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_positional() != are_positional) continue;
    text += ".TP\n" + bold(option->get_name(are_positional, true)) +
            italic(formatter.make_option_opts(option)) + "\n" + roff(option->get_description()) + "\n";
  }
  if (text.empty()) return "";
  return (are_positional ? ".SH ARGUMENTS\n" : ".SH OPTIONS\n") + text;
}

std::string subcommands_section(const CLI::App& command) {
  std::string text;
  for (const CLI::App* sub : shown_subcommands(command))
    text += ".TP\n" + bold(full_name(*sub, '-')) + "(1)\n" + roff(sub->get_description()) + "\n";
  return text.empty() ? "" : ".SH COMMANDS\n" + text;
}

constexpr const char* common_sections = R"(.SH EXIT STATUS
.TP
.B 0
All is done.
.TP
.B 1
It failed while it ran.
.TP
.B 2
The usage or an input is wrong; nothing was written.
.TP
.B 3
It was interrupted, or a part of the results is missing.
.SH ENVIRONMENT
.TP
.B GLOCAL_PLUGIN_PATH
Folders, with colons between them, whose plugins are always loaded.
.TP
.B GLOCAL_DATASETS
The folder that paths are in which begin with
.BR data: .
.TP
.B GLOCAL_PYTHON
The Python that runs plugins in Python.
)";

std::string see_also(const CLI::App& command) {
  if (command.get_parent() == nullptr) return "";
  return ".SH SEE ALSO\n.BR " + roff(full_name(*command.get_parent(), '-')) + " (1)\n";
}

std::string page_of(const CLI::App& command) {
  const std::string name = full_name(command, '-');
  std::string text = fmt::format(".TH {} 1 \"\" \"glocal {}\" \"glocal\"\n", roff(upper(name)), version);
  text += ".SH NAME\n" + roff(name) + " \\- " + roff(command.get_description()) + "\n";
  text += synopsis(command);
  text += options_section(command, true) + options_section(command, false);
  if (!command.get_footer().empty()) text += ".PP\n" + roff(command.get_footer()) + "\n";
  return text + subcommands_section(command) + common_sections + see_also(command);
}

void add_pages(const CLI::App& command, OutputFolder& folder) {
  folder.append(full_name(command, '-') + ".1", page_of(command));
  for (const CLI::App* sub : shown_subcommands(command)) add_pages(*sub, folder);
}

}  // namespace

void add_manual(CLI::App& app, Context& /*context*/) {
  auto folder = std::make_shared<std::string>();
  CLI::App* command =
      app.add_subcommand("manual", "Write the manual pages, one for each command.")->group("");
  command->add_option("DIR", *folder, "Folder for the pages")->required();
  command->callback([folder, &app] {
    OutputFolder pages(*folder, false);
    add_pages(app, pages);
    pages.commit();
  });
}

}  // namespace glocal::app
