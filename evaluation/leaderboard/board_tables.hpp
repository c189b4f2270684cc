// Tables of the leaderboard.
#pragma once

#include <string>
#include <vector>

#include "evaluation/leaderboard/board_entry.hpp"
#include "evaluation/results/report_blocks.hpp"

namespace glocal {

struct BoardTable {
  bool by_case = false;
  std::vector<std::string> cases = {};  ///< Only these; empty: all.
};

/// A line for each method, or for each case and method, best first: by right starts less wrong ones. With a
/// second table where trials are whole drives, beside what others have published.
[[nodiscard]] Report board_tables(const Suite& suite, const std::vector<BoardEntry>& entries,
                                  const BoardTable& table);

/// The success that is kept at each level of disturbances, and wrong starts: a line for each method, best
/// first, then one for each kind and method. Throws ConfigError where the suite has no disturbances.
[[nodiscard]] Report kinds_table(const Suite& suite, const std::vector<BoardEntry>& entries);

/// All methods on all suites: wrong and right of all starts.
[[nodiscard]] Report board_overview(const std::vector<std::string>& suites,
                                    const std::vector<BoardEntry>& entries);

}  // namespace glocal
