#include "evaluation/results/run_results.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "evaluation/results/json_text.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/results/writers.hpp"

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

/// What a run of one machine has crashed in: the last word is the last process's.
JournalEntry crashed_entry(std::size_t trial, const Json& start, const std::vector<Crash>& crashes) {
  const Crash& last = crashes.back();
  const std::string why = fmt::format("crashed ({}){}{}, in each of {} processes", last.signal,
                                      last.where.empty() ? "" : " in ", last.where, crashes.size());
  return {trial, {.outcome = Outcome::failed}, failed_trial_line(trial, start, why), ""};
}

}  // namespace

std::vector<std::size_t> JournaledTrials::missing() const {
  std::vector<std::size_t> missing;
  for (std::size_t trial = 0; trial < samples_.size(); ++trial) {
    if (!scan_.finished().contains(id(trial)) && !scan_.is_given_up(id(trial))) missing.push_back(trial);
  }
  return missing;
}

void JournaledTrials::tell_processes(Json& provenance) const {
  std::set<std::size_t> journals;
  for (std::size_t trial = 0; trial < samples_.size(); ++trial) {
    const auto finished = scan_.finished().find(id(trial));
    if (finished != scan_.finished().end()) journals.insert(finished->second.entry.journal);
  }
  std::set<std::string> hosts = {provenance.at("host")}, processors = {provenance.at("cpu")};
  std::set<std::size_t> jobs = {provenance.at("jobs")}, threads = {provenance.at("threads")};
  for (const std::size_t journal : journals) {
    hosts.insert(scan_.journals()[journal].host);
    jobs.insert(scan_.journals()[journal].jobs);
  }
  const auto descriptions = scan_.variants().find(variant_);
  if (descriptions != scan_.variants().end()) {
    for (const JournalScan::Place& place : descriptions->second) {
      if (!journals.contains(place.journal)) continue;
      const Json of_process = parse_json(scan_.text_at(place)).at("provenance");
      processors.insert(of_process.at("cpu"));
      threads.insert(whole_number(of_process, "threads"));
    }
  }
  const auto the_only = [](const std::set<std::size_t>& numbers) {
    return numbers.size() == 1 ? *numbers.begin() : 0;
  };
  provenance["host"] = fmt::format("{}", fmt::join(hosts, ", "));
  provenance["cpu"] = fmt::format("{}", fmt::join(processors, ", "));
  provenance["threads"] = the_only(threads);
  provenance["jobs"] = the_only(jobs);
}

std::optional<JournalEntry> JournaledTrials::take(std::size_t trial, OutputFolder& folder) const {
  const TrialId of_trial = id(trial);
  if (const auto finished = scan_.finished().find(of_trial); finished != scan_.finished().end()) {
    JournalEntry entry = entry_of(parse_json(scan_.text_at(finished->second.entry)));
    if (entry.trial != trial)
      throw std::invalid_argument(fmt::format("trial {} is where trial {} belongs", entry.trial, trial));
    for (const JournalScan::Place& file : finished->second.files) {
      const auto [name, content] = file_of_line(scan_.text_at(file));
      folder.write(name, content);
    }
    return entry;
  }
  const auto start = scan_.begun().find(of_trial);
  if (!scan_.is_given_up(of_trial) || start == scan_.begun().end()) return std::nullopt;
  return crashed_entry(trial, parse_json(scan_.text_at(start->second)), scan_.crashes().at(of_trial));
}

void write_origin(OutputFolder& folder, const Json& description) {
  folder.write("effective.yaml", description.at("effective").get<std::string>());
  folder.write("provenance.json", json_text(description.at("provenance"), 2) + "\n");
}

Json put_together(OutputFolder& folder, const Json& description, const JournaledTrials& trials,
                  bool complete) {
  Summary sum;
  LineFile trial_lines(folder, "trials.jsonl");
  std::optional<LineFile> step_lines;
  if (description.at("steps")) step_lines.emplace(folder, "steps.jsonl");
  for (std::size_t trial = 0; trial < trials.count(); ++trial) {
    const auto entry = trials.take(trial, folder);
    if (!entry) continue;
    trial_lines.add(entry->trial_line);
    if (step_lines) step_lines->add(entry->step_lines);
    sum.add(entry->figures);
  }
  trial_lines.flush();
  if (step_lines) step_lines->flush();
  Json summary = sum.to_json(description, complete);
  // It comes last: a later run takes its word that all is there.
  folder.sync();
  folder.write("summary.json", summary.dump(2) + "\n");
  folder.sync();
  return summary;
}

}  // namespace glocal
