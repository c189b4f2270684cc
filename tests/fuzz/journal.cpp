// An entry of a journal, behind its checksum.
#include "evaluation/results/journal.hpp"

#include "fuzz/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const std::string text = fuzz::text_of(data, size);
  const auto file = fuzz::write(entry_name(0), checksum(text) + " " + text);
  return fuzz::answer([&] {
    const auto entry = read_entry(file.parent_path().parent_path(), 0);
    fuzz::must_hold(entry && entry->trial == 0, "the entry is of another trial");
  });
}
