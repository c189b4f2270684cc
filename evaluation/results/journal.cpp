#include "evaluation/results/journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <libdeflate.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "evaluation/results/json_text.hpp"
#include "evaluation/results/number_text.hpp"
#include "evaluation/results/provenance.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void check_kept(const std::error_code& error, const fs::path& file) {
  if (error)
    throw RunError(
        fmt::format("{}: cannot write: {}; finished trials are kept: give the same command again when the "
                    "cause is mended",
                    file.string(), reason_of(error)));
}

std::uint64_t hexadecimal(std::string_view digits) {
  const auto value = number_of<std::uint64_t>(digits, 16);
  if (!value) throw std::invalid_argument("no hexadecimal number");
  return *value;
}

/// Any bytes, without the end of a line.
std::string in_one_line(std::string_view bytes) {
  std::string text;
  text.reserve(bytes.size() + bytes.size() / 64);
  for (const char c : bytes) {
    if (c == '\n' || c == '\\') text += '\\';
    text += c == '\n' ? 'n' : c;
  }
  return text;
}

std::string out_of_one_line(std::string_view text) {
  std::string bytes;
  bytes.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool is_escaped = text[i] == '\\' && ++i < text.size();
    bytes += is_escaped && text[i] == 'n' ? '\n' : text.at(i);
  }
  return bytes;
}

/// The name of a file of a trial. Throws std::invalid_argument if it leads out of the results.
std::string name_inside(std::string name) {
  const fs::path path(name);
  const bool leads_out = std::find(path.begin(), path.end(), "..") != path.end();
  if (path.is_absolute() || leads_out || !path.has_parent_path())
    throw std::invalid_argument("no file of a trial: " + name);
  return name;
}

/// What may stand in a file name.
std::string in_file_name(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) == 0 && c != '-'; }, '-');
  return text;
}

/// Names tell apart what several processes of several machines write, one after the other or at once.
std::string unique_name(const Shard& shard) {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format("shard-{:04}-of-{:04}_{}_{}_{:x}{}", shard.number, shard.of, in_file_name(host_name()),
                     ::getpid(), std::chrono::duration_cast<std::chrono::nanoseconds>(now).count(),
                     unfinished_journal_end);
}

}  // namespace

std::string to_string(const TrialId& id) {
  return fmt::format("{:016x}{:016x}", id.high, id.low);
}

TrialId trial_id_of(std::string_view text) {
  if (text.size() != 32) throw std::invalid_argument("no identity of a trial");
  return {hexadecimal(text.substr(0, 16)), hexadecimal(text.substr(16))};
}

TrialId trial_id(const std::string& variant, std::size_t trial, std::size_t sample) {
  const std::string hash = sha256_of_text(fmt::format("{}/{}/{}", variant, trial, sample));
  return trial_id_of(std::string_view(hash).substr(0, 32));
}

std::string checksum(std::string_view bytes) {
  return fmt::format("{:08x}", libdeflate_crc32(0, bytes.data(), bytes.size()));
}

std::optional<std::string_view> checked_content(std::string_view text) {
  const std::string_view content = text.substr(std::min(text.size(), std::size_t{9}));
  if (content.empty() || !text.starts_with(checksum(content) + " ")) return std::nullopt;
  return content;
}

std::pair<std::string, std::string> file_of_line(std::string_view text) {
  std::string content = out_of_one_line(text);
  const std::size_t end = content.find('\0');
  if (end == std::string::npos) throw std::invalid_argument("a file has no name");
  std::string name = name_inside(content.substr(0, end));
  content.erase(0, end + 1);
  return {std::move(name), std::move(content)};
}

Journal::Journal(const fs::path& folder, const Shard& shard, int jobs) : file_(folder / unique_name(shard)) {
  std::vector<fs::path> changed;
  check_kept(make_folders(folder, changed), file_);
  out_ = Descriptor(file_, O_WRONLY | O_CREAT | O_EXCL | O_APPEND);
  if (out_.get() < 0) check_kept(last_error(), file_);
  changed.push_back(folder);
  for (const fs::path& above : changed) check_kept(sync_to_disk(above), file_);
  const Json json = {{"shard", shard.number},
                     {"of", shard.of},
                     {"host", valid_utf8(host_name())},
                     {"process", ::getpid()},
                     {"jobs", jobs}};
  add_line(journal_words::shard, json.dump(), false);
}

void Journal::add_variant(const std::string& identity, const Json& description) {
  add_line(journal_words::variant, identity + " " + json_text(description), true);
}

void Journal::begin(const TrialId& id, const Json& start) {
  add_line(journal_words::begin, to_string(id) + " " + start.dump(), false);
}

void Journal::finish(const TrialId& id, double ms, const TrialOutput& output) {
  const std::string of_trial = to_string(id);
  for (const auto& [name, content] : output.files) {
    std::string file = name;
    file += '\0';
    file += content;
    add_line(journal_words::file, fmt::format("{} {}", of_trial, in_one_line(file)), false);
  }
  add_line(journal_words::trial,
           fmt::format("{} {:.0f} {} {} {}", of_trial, ms, to_string(output.entry.figures.outcome),
                       output.files.size(), to_json(output.entry).dump()),
           true);
}

void Journal::add_crash(const TrialId& id, const Crash& crash) {
  const Json json = {{"signal", crash.signal}, {"where", valid_utf8(crash.where)}};
  add_line(journal_words::crash, to_string(id) + " " + json.dump(), true);
}

void Journal::touch() const {
  // Where this fails, writing will, too, and tell.
  static_cast<void>(::futimens(out_.get(), nullptr));
}

void Journal::close() {
  fs::path name = file_;
  name.replace_extension();  // Without .part.
  std::error_code error = ::fsync(out_.get()) != 0 ? last_error() : std::error_code();
  if (!error) fs::rename(file_, name, error);
  if (!error) error = sync_to_disk(name.parent_path());
  check_kept(error, file_);
  out_ = {};
  file_ = std::move(name);
}

void Journal::add_line(std::string_view word, std::string_view text, bool for_good) {
  constexpr std::size_t head = 9;  // Checksum and space.
  std::string line = fmt::format("{:{}}{} {}", "", head, word, text);
  line.replace(0, head - 1, checksum(std::string_view(line).substr(head)));
  line += '\n';
  const std::lock_guard lock(mutex_);
  const off_t before = ::lseek(out_.get(), 0, SEEK_END);
  if (const auto error = write_all(out_.get(), line)) {
    // Other threads may still have something to say, which must not stand behind half a line.
    static_cast<void>(::ftruncate(out_.get(), before) == 0);
    check_kept(error, file_);
  }
  if (for_good && ::fdatasync(out_.get()) != 0) check_kept(last_error(), file_);
}

}  // namespace glocal
