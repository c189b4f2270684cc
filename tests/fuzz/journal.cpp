// An entry of a journal. Whatever is wrong with it, the trial runs again: nothing is thrown.
#include "evaluation/results/journal.hpp"

#include "fuzz/harness.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto file = fuzz::write(std::string(journal_folder) + "/trial_0000.json", fuzz::text_of(data, size));
  const auto entry = read_entry(file.parent_path().parent_path(), 0);
  fuzz::must_hold(!entry || entry->trial == 0, "the entry is of another trial");
  return 0;
}
