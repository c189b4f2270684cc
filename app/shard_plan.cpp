#include "app/shard_plan.hpp"

#include <fmt/format.h>

#include "app/child_process.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/results_folder.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

void check_free(const std::filesystem::path& folder) {
  if (is_results_folder(folder))
    throw ConfigError(folder,
                      "output: the folder has results of a run without shards; choose another one with "
                      "--out");
}

}  // namespace

std::optional<Manifest> planned_shards(std::vector<Variant>& variants, const std::string& file,
                                       const std::filesystem::path& shared, Context& context) {
  const std::vector<std::filesystem::path>& plugins = context.plugins.loaded();
  if (is_shared_folder(shared)) {
    FileHashes hashes;
    const Manifest here = sketch_of(variants, file, plugins, context.catalog, hashes);
    Manifest there = read_manifest(shared);
    if (auto faults = differences(there, here, variants, context.catalog, shared); !faults.empty())
      throw ConfigError(std::move(faults));
    if (!has_more_variants(there, here)) return there;
  } else {
    check_free(shared);
    // Reports would take these for what the shards have come to, and merging would refuse them at the end.
    for (const Variant& variant : variants) check_free(shared / variant.name);
  }
  // What is loaded to find out leaves threads behind, with which this process could have no children.
  const ChildEnd end = run_in_child([&] {
    ExperimentLoader loader(context.catalog, warn);
    write_manifest(shared, plan(variants, file, plugins, loader));
    return 0;
  });
  if (!end.exit_code)
    throw RunError(fmt::format("the process that loads maps and drives has ended too soon: {}", end.cause));
  context.exit_code = *end.exit_code;
  if (context.exit_code != 0) return std::nullopt;
  return read_manifest(shared);
}

}  // namespace glocal::app
