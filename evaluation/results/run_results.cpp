#include "evaluation/results/run_results.hpp"

#include <fmt/format.h>

#include "glocal/error.hpp"

namespace glocal {
namespace {

/// Lines that go to a file of the folder in large pieces.
class LineFile {
 public:
  LineFile(OutputFolder& folder, const char* name) : folder_(folder), name_(name) {
    folder_.write(name_, "");
  }

  void add(const std::string& lines) {
    constexpr std::size_t piece = 1 << 20;
    waiting_ += lines;
    if (waiting_.size() > piece) flush();
  }

  void flush() {
    if (!waiting_.empty()) folder_.append(name_, waiting_);
    waiting_.clear();
  }

 private:
  OutputFolder& folder_;
  const char* name_;
  std::string waiting_;
};

}  // namespace

Summary put_together(OutputFolder& folder, bool has_steps, std::size_t trials,
                     const std::function<std::optional<JournalEntry>(std::size_t trial)>& entry_of) {
  Summary summary;
  LineFile trial_lines(folder, "trials.jsonl");
  std::optional<LineFile> step_lines;
  if (has_steps) step_lines.emplace(folder, "steps.jsonl");
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const auto entry = entry_of(trial);
    if (!entry) continue;
    trial_lines.add(entry->trial_line);
    if (step_lines) step_lines->add(entry->step_lines);
    summary.add(entry->figures);
  }
  trial_lines.flush();
  if (step_lines) step_lines->flush();
  return summary;
}

RunResults::RunResults(OutputFolder& folder, const OutputConfig& config, std::size_t trials,
                       const std::function<void(const std::string&)>& warn)
    : folder_(folder), config_(config), trials_(trials), collector_(config) {
  for (std::size_t trial = 0; trial < trials; ++trial) take_up(trial, warn);
}

void RunResults::take_up(std::size_t trial, const std::function<void(const std::string&)>& warn) {
  try {
    if (read_entry(folder_.unfinished(), trial)) return;
  } catch (const RunError& damage) {
    warn(fmt::format("{}; trial {} runs again", damage.what(), trial));
    std::error_code ignored;
    std::filesystem::remove(folder_.unfinished() / entry_name(trial), ignored);
  }
  to_run_.push_back(trial);
}

void RunResults::finish(const TrialRecord& trial) {
  TrialOutput output = collector_.finish(trial);
  for (const auto& [name, content] : output.files) {
    folder_.write(name, content);
    output.entry.files[name] = checksum(content);
  }
  write_entry(folder_, output.entry);
  folder_.keep_unfinished();
}

Summary RunResults::put_together() {
  return glocal::put_together(folder_, config_.steps, trials_,
                              [&](std::size_t trial) { return read_entry(folder_.unfinished(), trial); });
}

}  // namespace glocal
