// Strategies from outside, for every subcommand.
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/python_plugins.hpp"

namespace glocal::app {

void add_plugins(CLI::App& app, Context& context) {
  context.plugins.hand_over(".py", load_python_plugin);
  constexpr const char* about = "Load a plugin's strategies, a shared object or a Python file (repeatable)";
  auto files = std::make_shared<std::vector<std::string>>();
  app.add_option("--plugin", *files, about)->allow_extra_args(false);
  const auto add = [files](const std::vector<std::string>& more) {
    files->insert(files->end(), more.begin(), more.end());
  };
  for (CLI::App* command : app.get_subcommands([](const CLI::App* /*any*/) { return true; })) {
    command->fallthrough();
    // The option itself is the program's, whose help alone would tell of it.
    command->footer(
        "Besides, --plugin FILE (repeatable) loads strategies: a shared object or a Python file.");
    // Those below a command have one of their own: falling through, they would take its other options, too.
    for (CLI::App* below : command->get_subcommands({}))
      below->add_option_function<std::vector<std::string>>("--plugin", add, about)->allow_extra_args(false);
  }
  app.parse_complete_callback([files, &context] {
    if (const char* folders = std::getenv("GLOCAL_PLUGIN_PATH")) context.plugins.load_folders(folders);
    for (const std::string& file : *files) context.plugins.load(file);
  });
}

}  // namespace glocal::app
