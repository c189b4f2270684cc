// glocal contract: whether a strategy keeps what its kind promises.
#include "glocal/contract.hpp"

#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/standard_streams.hpp"
#include "config/strategy_names.hpp"

namespace glocal::app {
namespace {

struct ContractOptions {
  std::string kind, name;
  ExperimentOptions parameters;  ///< Of these: only --set.
};

void try_out(const ContractOptions& options, Context& context) {
  const StrategyChoice choice =
      chosen_strategy(options.kind, options.name, options.parameters.overrides(), context.catalog);
  const std::vector<std::string> broken = broken_promises(options.kind, choice, context.catalog);
  for (const std::string& sentence : broken)
    say("{} {}: breaks its contract: {}\n", options.kind, options.name, sentence);
  context.exit_code = broken.empty() ? 0 : 1;
  if (broken.empty()) answer("{} {}: keeps its contract\n", options.kind, options.name);
}

}  // namespace

void add_contract(CLI::App& app, Context& context) {
  auto options = std::make_shared<ContractOptions>();
  CLI::App* command = app.add_subcommand(
      "contract", "Try out in a small room whether a strategy keeps what its kind promises.");
  command->add_option("KIND", options->kind, "matcher, local_mapper, ... (see glocal list)")->required();
  command->add_option("NAME", options->name, "Name of the strategy")->required();
  options->parameters.add_set_to(*command, "Change a parameter of it: share=0.9 (repeatable)");
  command->callback([options, &context] { try_out(*options, context); });
}

}  // namespace glocal::app
