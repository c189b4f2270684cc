#include "app/results_arguments.hpp"

#include <set>

#include "evaluation/results/results_folder.hpp"

namespace glocal::app {

namespace fs = std::filesystem;

void for_each_results_folder(const std::vector<std::string>& paths, FaultCollector& faults,
                             const std::function<void(const fs::path&)>& work) {
  std::set<fs::path> seen;
  const auto hand_over = [&](const fs::path& folder) {
    if (!seen.insert(fs::canonical(folder)).second)
      throw ConfigError({{folder.string(), 0, 0, "is named twice; name each folder of results once"}});
    work(folder);
  };
  for (const std::string& path : paths) {
    faults.collect([&] {
      for (const fs::path& folder : results_folders(path)) faults.collect([&] { hand_over(folder); });
    });
  }
}

}  // namespace glocal::app
