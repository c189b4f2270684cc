// glocal schema: a JSON schema of experiment files, for editors.
#include "config/schema.hpp"

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/standard_streams.hpp"

namespace glocal::app {

void add_schema(CLI::App& app, Context& context) {
  app.add_subcommand("schema", "Write a JSON schema of experiment files, for editors.")->callback([&context] {
    answer("{}\n", experiment_schema(context.catalog).dump(2));
  });
}

}  // namespace glocal::app
