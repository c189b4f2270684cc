// The leaderboard's history.
#include "evaluation/leaderboard/board_history.hpp"

#include "fuzz/harness.hpp"

extern "C" int fuzz_board_history(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto file = fuzz::write("history.jsonl", fuzz::text_of(data, size));
  return fuzz::answer([&] {
    const std::vector<Renewal> renewals = read_history(file);
    std::string text;
    for (const Renewal& renewal : renewals) text += to_line(renewal);
    fuzz::must_hold(read_history(fuzz::write("again.jsonl", text)).size() == renewals.size(),
                    "what is written reads otherwise");
    for (const auto& [p_right, p_wrong] : steps_between(renewals))
      fuzz::must_hold(p_right >= 0.0 && p_right <= 1.0 && p_wrong >= 0.0 && p_wrong <= 1.0,
                      "a p is no probability");
  });
}
