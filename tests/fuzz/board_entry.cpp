// An entry of the leaderboard.
#include "evaluation/leaderboard/board_entry.hpp"

#include "fuzz/harness.hpp"

extern "C" int fuzz_board_entry(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto file = fuzz::write("mine.json", fuzz::text_of(data, size));
  return fuzz::answer([&] {
    const BoardEntry entry = read_entry(file);
    const BoardCounts counts = counts_of(entry);
    fuzz::must_hold(counts.right + counts.wrong <= counts.starts, "more starts ended than there are");
    const auto again = fuzz::write("again.json", to_text(entry));
    fuzz::must_hold(to_text(read_entry(again)) == to_text(entry), "what is written reads otherwise");
  });
}
