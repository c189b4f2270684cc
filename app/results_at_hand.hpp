// Results that can be read, also of runs that shards have not ended yet.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"

namespace glocal::app {

/// Folders of results. What shards have done so far of one that they have not filled yet is put together in a
/// temporary folder, which is gone with this object.
class ResultsAtHand {
 public:
  /// Throws as merge_shards() does.
  explicit ResultsAtHand(const std::vector<std::string>& folders);
  ~ResultsAtHand();
  ResultsAtHand(const ResultsAtHand&) = delete;
  ResultsAtHand& operator=(const ResultsAtHand&) = delete;

  /// As read_runs() does. The folders that runs tell are those that were given.
  [[nodiscard]] std::vector<NamedRun> read(
      const std::function<StoredRun(const std::filesystem::path&)>& read_one) const;

 private:
  ResultsAtHand() = default;
  [[nodiscard]] std::filesystem::path put_together(const std::filesystem::path& shared);

  std::vector<std::string> folders_;                                 ///< To read.
  std::map<std::filesystem::path, std::filesystem::path> given_as_;  ///< Of those that are temporary.
  std::filesystem::path temporary_;                                  ///< Empty if there is none.
};

/// The runs of an experiment that were left in one folder, but for their steps, which are most of them.
/// Throws ConfigError as read_runs() does.
[[nodiscard]] std::vector<NamedRun> read_sweep(const std::string& folder);

}  // namespace glocal::app
