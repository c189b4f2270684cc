#include "evaluation/results/run_results.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "evaluation/results/summary.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

using Json = nlohmann::ordered_json;

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

std::vector<std::size_t> missing_trials(const OutputFolder& folder, std::size_t trials,
                                        const std::function<void(const std::string&)>& warn) {
  std::vector<std::size_t> missing;
  for (std::size_t trial = 0; trial < trials; ++trial) {
    try {
      if (read_entry(folder.unfinished(), trial)) continue;
    } catch (const RunError& damage) {
      warn(fmt::format("{}; trial {} runs again", damage.what(), trial));
      std::error_code ignored;
      std::filesystem::remove(folder.unfinished() / entry_name(trial), ignored);
    }
    missing.push_back(trial);
  }
  return missing;
}

void keep_trial(OutputFolder& folder, TrialOutput output) {
  for (const auto& [name, content] : output.files) {
    folder.write(name, content);
    output.entry.files[name] = checksum(content);
  }
  write_entry(folder, output.entry);
  folder.keep_unfinished();
}

void write_origin(OutputFolder& folder, const Json& description) {
  folder.write("effective.yaml", description.at("effective").get<std::string>());
  // Names of files need not be UTF-8.
  folder.write("provenance.json",
               description.at("provenance").dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Json put_together(OutputFolder& folder, const Json& description, std::size_t trials, bool complete,
                  const std::function<std::optional<JournalEntry>(std::size_t trial)>& entry_of) {
  Summary sum;
  LineFile trial_lines(folder, "trials.jsonl");
  std::optional<LineFile> step_lines;
  if (description.at("steps")) step_lines.emplace(folder, "steps.jsonl");
  for (std::size_t trial = 0; trial < trials; ++trial) {
    const auto entry = entry_of(trial);
    if (!entry) continue;
    trial_lines.add(entry->trial_line);
    if (step_lines) step_lines->add(entry->step_lines);
    sum.add(entry->figures);
  }
  trial_lines.flush();
  if (step_lines) step_lines->flush();
  Json summary = sum.to_json(description, complete);
  // It comes last: a later run takes its word that all is there.
  folder.write_for_good("summary.json", summary.dump(2) + "\n");
  return summary;
}

}  // namespace glocal
