// What the page of the leaderboard shows.
#pragma once

#include <vector>

#include "evaluation/leaderboard/board_entry.hpp"
#include "evaluation/leaderboard/board_history.hpp"
#include "report/page.hpp"

namespace glocal {

/// What methods have come to on a suite.
struct SuiteBoard {
  Suite suite;
  std::vector<BoardEntry> entries;  ///< Each with all starts of the suite, in its order.
};

/// All starts of all entries, their counts with 95 % intervals, and of the history the lines of these
/// entries. Methods come best first: by right starts less wrong ones.
[[nodiscard]] PageData board_page(const std::vector<SuiteBoard>& boards, const std::vector<Renewal>& history);

}  // namespace glocal
