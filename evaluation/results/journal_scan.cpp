#include "evaluation/results/journal_scan.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/number_text.hpp"
#include "evaluation/results/provenance.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

/// Writers touch their files twice a minute.
constexpr std::chrono::seconds longest_silence{120};

[[noreturn]] void fail_to_read(const fs::path& file, const std::error_code& error = last_error()) {
  throw RunError(fmt::format("{}: cannot read: {}", file.string(), error.message()));
}

/// Now, by the clock of the file system that has the folder: machines need not agree.
fs::file_time_type now_at(const fs::path& folder) {
  const fs::path probe = folder / fmt::format(".now-{}-{}", host_name(), ::getpid());
  std::error_code error;
  { const std::ofstream made(probe); }
  const fs::file_time_type now = fs::last_write_time(probe, error);
  fs::remove(probe, error);
  return error ? fs::file_time_type::clock::now() : now;
}

/// Takes the next word off a text.
std::string_view next_word(std::string_view& text) {
  const std::size_t end = text.find(' ');
  if (end == std::string_view::npos) throw std::invalid_argument("a word is missing");
  const std::string_view word = text.substr(0, end);
  text.remove_prefix(end + 1);
  return word;
}

template <class Number>
Number expect_number(std::string_view word) {
  const auto number = number_of<Number>(word);
  if (!number) throw std::invalid_argument("no number");
  return *number;
}

/// Where the index of a closed journal is.
fs::path index_of(fs::path journal) {
  return journal.replace_extension(".index");
}

}  // namespace

JournalScan::JournalScan(fs::path folder, std::function<void(const std::string&)> warn, Closed closed)
    : folder_(std::move(folder)), warn_(std::move(warn)), closed_(closed) {
  update();
}

void JournalScan::update() {
  find_journals();
  for (std::size_t i = 0; i < journals_.size(); ++i) read(i);
}

std::size_t JournalScan::count_live() const {
  return static_cast<std::size_t>(std::ranges::count(journals_, true, &Journal::is_live));
}

bool JournalScan::is_given_up(const TrialId& id) const {
  const auto crashes = crashes_.find(id);
  return !finished_.contains(id) && crashes != crashes_.end() && crashes->second.size() >= most_crashes;
}

/// In the order of their names, so that of a trial that was run twice each reader takes the same output.
void JournalScan::find_journals() {
  std::map<std::string, bool> found;  // Whether it is closed, by the name it has then.
  std::error_code error;
  for (fs::directory_iterator entry(folder_, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (name.ends_with(journal_end)) found[name] = true;
    if (name.ends_with(unfinished_journal_end)) found.try_emplace(fs::path(name).stem(), false);
  }
  if (error && error != std::errc::no_such_file_or_directory) fail_to_read(folder_, error);
  if (found.empty()) return;
  const fs::file_time_type now = now_at(folder_);
  for (const auto& [name, is_closed] : found) {
    const auto [known, is_new] = known_.try_emplace(name, journals_.size());
    if (is_new) journals_.emplace_back();
    Journal& journal = journals_[known->second];
    journal.is_closed = is_closed;
    const std::string_view end = is_closed ? journal_end : unfinished_journal_end;
    journal.file = folder_ / fs::path(name).replace_extension(end);
    const fs::file_time_type touched = fs::last_write_time(journal.file, error);
    journal.is_live = !is_closed && !error && now - touched < longest_silence;
  }
}

void JournalScan::read(std::size_t journal) {
  constexpr std::size_t piece = 1 << 22;
  if (closed_ == Closed::indexed && journals_[journal].read == 0 && take_index(journal)) return;
  const int descriptor = descriptor_of(journal);
  std::string text;  // From the first byte that is not read yet.
  std::uint64_t at = journals_[journal].read;
  for (std::size_t size = text.size();; size = text.size()) {
    text.resize(size + piece);
    const ssize_t n = ::pread(descriptor, text.data() + size, piece, static_cast<off_t>(at + size));
    if (n < 0) fail_to_read(journals_[journal].file);
    text.resize(size + static_cast<std::size_t>(n));
    std::size_t begin = 0;
    for (std::size_t end = text.find('\n', size); end != std::string::npos; end = text.find('\n', begin)) {
      take_line(journal, at + begin, std::string_view(text).substr(begin, end - begin));
      begin = end + 1;
    }
    text.erase(0, begin);
    at += begin;
    if (n == 0) break;
  }
  journals_[journal].read = at;
  if (journals_[journal].is_closed) update_index(journals_[journal]);
}

/// False if there is no index that is as its journal: what was changed since is read. Times of files go by
/// ticks, so one of the same tick may have been changed after it.
bool JournalScan::take_index(std::size_t journal) {
  const fs::path& file = journals_[journal].file;
  const fs::path index = index_of(file);
  std::error_code error;
  const fs::file_time_type written = fs::last_write_time(index, error);
  if (error || !journals_[journal].is_closed || written <= fs::last_write_time(file, error)) return false;
  const std::string text = content_of(index);
  const auto content = checked_content(text);
  if (!content) return false;
  std::istringstream lines{std::string(*content)};
  for (std::string line; std::getline(lines, line);) take_content(journal, std::nullopt, line);
  journals_[journal].read = fs::file_size(file);
  return true;
}

void JournalScan::update_index(Journal& journal) {
  std::string& text = journal.index;
  const fs::path index = index_of(journal.file);
  std::error_code ignored;
  if (journal.is_damaged) fs::remove(index, ignored);
  if (closed_ == Closed::indexed && !journal.is_damaged && !text.empty()) {
    try {
      write_file(index, checksum(text) + " " + text);
    } catch (const RunError&) {
      // Whoever may not write here reads all again next time.
    }
  }
  text.clear();
}

void JournalScan::take_line(std::size_t journal, std::uint64_t offset, std::string_view line) {
  try {
    const auto content = checked_content(line);
    if (!content) throw std::invalid_argument("its checksum is another one");
    take_content(journal, offset + (line.size() - content->size()), *content);
  } catch (const std::exception& damage) {
    journals_[journal].is_damaged = true;
    warn_(fmt::format("{}: byte {}: the line is damaged ({}); what it told is run again",
                      journals_[journal].file.string(), offset, reason(damage)));
  }
}

/// A line of a journal, or one of its index, which has no offset: it has places in the journal where the
/// former has what is there.
void JournalScan::take_content(std::size_t journal, std::optional<std::uint64_t> offset,
                               std::string_view content) {
  std::string_view rest = content;
  std::optional<Place> placed;
  const auto place = [&] {
    if (!offset)
      return Place{journal, expect_number<std::uint64_t>(next_word(rest)),
                   expect_number<std::uint64_t>(rest)};
    placed = Place{journal, *offset + (content.size() - rest.size()), rest.size()};
    return *placed;
  };
  const std::string_view word = next_word(rest);
  if (word == journal_words::shard) {
    const nlohmann::ordered_json json = parse_json(std::string(rest));
    journals_[journal].host = json.at("host");
    journals_[journal].jobs = whole_number(json, "jobs");
  } else if (word == journal_words::variant) {
    const std::string identity(next_word(rest));
    variants_[identity].push_back(place());
  } else if (word == journal_words::begin) {
    const TrialId id = trial_id_of(next_word(rest));
    const Place at = place();
    // Who was killed may have begun it, too.
    const auto begun = begun_.find(id);
    const bool is_known = begun != begun_.end() && journals_[begun->second.journal].is_live;
    if (!finished_.contains(id) && (journals_[journal].is_live || !is_known)) begun_[id] = at;
  } else if (word == journal_words::file) {
    const TrialId id = trial_id_of(next_word(rest));
    const Place at = place();
    if (!finished_.contains(id)) files_[id].push_back(at);
  } else if (word == journal_words::trial) {
    const TrialId id = trial_id_of(next_word(rest));
    const auto ms = expect_number<double>(next_word(rest));
    const Outcome outcome = outcome_of(std::string(next_word(rest)));
    const auto files = expect_number<std::size_t>(next_word(rest));
    Finished finished{place(), ms, outcome, std::move(files_[id])};
    files_.erase(id);
    // A process that was ended before has left some in a journal of its own.
    std::erase_if(finished.files, [&](const Place& file) { return file.journal != journal; });
    if (!finished_.contains(id) && finished.files.size() != files)
      throw std::invalid_argument("a file of the trial is missing");
    finished_.try_emplace(id, std::move(finished));
    begun_.erase(id);
  } else if (word == journal_words::crash) {
    const TrialId id = trial_id_of(next_word(rest));
    const nlohmann::ordered_json json = parse_json(std::string(rest));
    crashes_[id].push_back({json.at("signal"), json.at("where")});
  } else {
    throw std::invalid_argument(fmt::format("there is no word '{}'", word));
  }
  if (placed) {
    content.remove_suffix(rest.size());
    journals_[journal].index += fmt::format("{}{} {}\n", content, placed->offset, placed->size);
  } else if (offset) {
    journals_[journal].index += fmt::format("{}\n", content);
  }
}

std::string JournalScan::text_at(const Place& place) const {
  std::string text(place.size, '\0');
  const ssize_t n =
      ::pread(descriptor_of(place.journal), text.data(), text.size(), static_cast<off_t>(place.offset));
  if (n < 0) fail_to_read(journals_[place.journal].file);
  if (static_cast<std::size_t>(n) != place.size)
    throw RunError(fmt::format("{}: was cut off at byte {} since it was read; give the same command again",
                               journals_[place.journal].file.string(), place.offset));
  return text;
}

/// Opening costs more than reading, and there may be more files than a process can hold open.
int JournalScan::descriptor_of(std::size_t journal) const {
  constexpr std::size_t most_open = 256;
  const auto known = open_.find(journal);
  if (known != open_.end()) return known->second.get();
  if (open_.size() >= most_open) open_.clear();
  // The writer may have closed it since: it has its other name then.
  fs::path file = journals_[journal].file;
  Descriptor descriptor(file, O_RDONLY);
  if (descriptor.get() < 0 && errno == ENOENT && !journals_[journal].is_closed)
    descriptor = Descriptor(file.replace_extension(), O_RDONLY);
  if (descriptor.get() < 0) fail_to_read(journals_[journal].file);
  return (open_[journal] = std::move(descriptor)).get();
}

}  // namespace glocal
