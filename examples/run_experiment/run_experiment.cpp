// Runs an experiment file, as `glocal run` does, and prints a line for each of its variants: how many of its
// trials were right, wrong and undecided. Arguments: the file, and the folder for the results.
#include <exception>
#include <glocal/builtin.hpp>
#include <glocal/error.hpp>
#include <glocal/run_experiment.hpp>
#include <iostream>

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::cerr << "usage: run_experiment FILE OUT\n";
    return 2;
  }
  glocal::Catalog catalog;
  glocal::register_builtin_strategies(catalog);

  glocal::RunObserver observer;
  observer.begin = [](const glocal::VariantBegin& variant) {
    std::cerr << variant.folder.string() << ": " << variant.trials << " trials\n";
  };
  observer.trial = [](const glocal::TrialEnd& trial) {
    std::cerr << "trial " << trial.trial << ": " << glocal::to_string(trial.outcome) << " after "
              << trial.steps << " steps\n";
  };
  observer.warn = [](const std::string& text) { std::cerr << "warning: " << text << '\n'; };

  const glocal::RunResult result = glocal::run_experiment(argv[1], {}, catalog, {.out = argv[2]}, observer);
  for (const glocal::VariantResult& variant : result.variants) {
    std::cout << (variant.name.empty() ? "experiment" : variant.name) << ": " << variant.right << " right, "
              << variant.wrong << " wrong, " << variant.undecided << " undecided\n";
  }
} catch (const glocal::ConfigError& e) {
  std::cerr << e.what() << '\n';
  return 2;
} catch (const std::exception& e) {
  std::cerr << e.what() << '\n';
  return 1;
}
