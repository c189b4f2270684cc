// Results that can be read, also of runs that shards have not ended yet.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"

namespace glocal::app {

/// Folders as they were given. In the place of one that shards have not filled yet stands a temporary one,
/// into which what they have done so far is put together; it is gone with this object.
class ResultsAtHand {
 public:
  /// Throws as merge_shards() does.
  explicit ResultsAtHand(const std::vector<std::string>& folders);
  ~ResultsAtHand();
  ResultsAtHand(const ResultsAtHand&) = delete;
  ResultsAtHand& operator=(const ResultsAtHand&) = delete;

  [[nodiscard]] const std::vector<std::string>& folders() const { return folders_; }

 private:
  [[nodiscard]] std::filesystem::path put_together(const std::filesystem::path& shared);

  std::vector<std::string> folders_;
  std::filesystem::path temporary_;  ///< Empty if there is none.
};

/// The runs of an experiment that were left in one folder, but for their steps, which are most of them.
/// Throws ConfigError as read_runs() does.
[[nodiscard]] std::vector<NamedRun> read_sweep(const std::string& folder);

}  // namespace glocal::app
