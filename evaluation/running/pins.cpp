#include "evaluation/running/pins.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "glocal/error.hpp"

namespace glocal {

std::map<std::string, std::string> input_hashes(const Suite& suite,
                                                const std::set<std::filesystem::path>& inputs,
                                                FileHashes& hashes) {
  constexpr std::size_t many = 3;
  std::map<std::filesystem::path, std::vector<std::filesystem::path>> folders;
  for (const std::filesystem::path& input : inputs) {
    // What is read of a folder is among the files.
    if (!std::filesystem::is_directory(input)) folders[input.parent_path()].push_back(input);
  }
  std::map<std::string, std::string> named;
  for (const auto& [folder, files] : folders) {
    std::string all;
    for (const std::filesystem::path& file : files) {
      if (files.size() < many) named[input_name(suite, file)] = hashes.of(file);
      if (files.size() >= many) all += fmt::format("{} {}\n", file.filename().string(), hashes.of(file));
    }
    if (files.size() >= many) named[input_name(suite, folder) + "/"] = sha256_of_text(all);
  }
  return named;
}

void check_pins(const Variant& variant, const LoadedExperiment& loaded, FileHashes& hashes) {
  if (!variant.suite || !variant.suite->is_pinned) return;
  const Suite& suite = *variant.suite;
  constexpr const char* way_out = "bring it back, or make another version of the suite";
  std::vector<Fault> faults;
  for (const auto& [name, hash] : input_hashes(suite, loaded.inputs, hashes)) {
    const auto pinned = suite.inputs.find(name);
    if (pinned != suite.inputs.end() && pinned->second == hash) continue;
    faults.push_back({name, 0, 0,
                      fmt::format("is not the input of {}: its SHA-256 is {}, and {} is pinned in {}; {}",
                                  suite.id(), hash, pinned == suite.inputs.end() ? "none" : pinned->second,
                                  suite.file.string(), way_out)});
  }
  const std::size_t starts = suite.find_case(variant.case_name)->starts;
  if (faults.empty() && starts != loaded.all_starts)
    faults.push_back(
        {suite.file.string(), 0, 0,
         fmt::format("the case {} has {} starts with seed {}, and {} are pinned; {}", variant.case_name,
                     loaded.all_starts, variant.experiment.seed, starts, way_out)});
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

}  // namespace glocal
