// How often entries of the leaderboard were renewed, and whether that has changed anything.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "evaluation/leaderboard/board_entry.hpp"

namespace glocal {

/// A line of history.jsonl: what an entry came to when it was written.
struct Renewal {
  std::string date, revision, suite, method;
  BoardCounts counts;
};
[[nodiscard]] Renewal renewal_of(const BoardEntry& entry);

/// JSON on a line, with its end.
[[nodiscard]] std::string to_line(const Renewal& renewal);
/// All lines; none where there is no file. Throws ConfigError with every line that is not as to_line() writes
/// it.
[[nodiscard]] std::vector<Renewal> read_history(const std::filesystem::path& file);

/// From one renewal to the next: how likely a difference no smaller would be if nothing had changed.
struct RenewalStep {
  double p_right = 1.0, p_wrong = 1.0;
};
/// The steps between a method's renewals on a suite, one fewer than these. By Fisher's exact test, after Holm
/// over all of them: a history has counts alone, so that the same starts are taken for others, and less is
/// found than paired_text() finds.
[[nodiscard]] std::vector<RenewalStep> steps_between(const std::vector<Renewal>& renewals);

}  // namespace glocal
