// glocal reference: writes docs/parameters.md.
#include "config/reference.hpp"

#include <fmt/format.h>

#include "app/commands.hpp"
#include "app/standard_streams.hpp"

namespace glocal::app {

void add_reference(CLI::App& app, Context& context) {
  app.add_subcommand("reference", "Write the reference of all parameters, in Markdown.")
      ->callback([&context] { answer(parameter_reference(context.catalog)); });
}

}  // namespace glocal::app
