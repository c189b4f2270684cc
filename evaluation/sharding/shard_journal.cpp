#include "evaluation/sharding/shard_journal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/results/valid_text.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

[[noreturn]] void fail_to_write(const fs::path& file, const std::error_code& error) {
  throw RunError(
      fmt::format("{}: cannot write: {}; finished trials are kept: give the same command again when the "
                  "cause is mended",
                  file.string(), reason_of(error)));
}

std::error_code last_error() {
  return {errno, std::generic_category()};
}

void check_written(const fs::path& file, const std::error_code& error) {
  if (error) fail_to_write(file, error);
}

std::uint64_t hexadecimal(std::string_view digits) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, 16);
  if (error != std::errc() || end != digits.data() + digits.size())
    throw std::invalid_argument("no hexadecimal number");
  return value;
}

/// Two hexadecimal digits a byte: local maps of plugins need not be text.
std::string hexadecimal_text(const std::string& bytes) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    text += digits[byte / 16];
    text += digits[byte % 16];
  }
  return text;
}

std::string bytes_of(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes += static_cast<char>(hexadecimal(std::string_view(text).substr(i, 2)));
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

ShardJournal::ShardJournal(const fs::path& folder, const Shard& shard, int jobs)
    : file_(folder / unique_name(shard)) {
  std::vector<fs::path> changed;
  check_written(file_, make_folders(folder, changed));
  fd_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644);
  if (fd_ < 0) fail_to_write(file_, last_error());
  changed.push_back(folder);
  for (const fs::path& above : changed) check_written(file_, sync_to_disk(above));
  const Json json = {{"shard", shard.number},
                     {"of", shard.of},
                     {"host", valid_utf8(host_name())},
                     {"process", ::getpid()},
                     {"jobs", jobs}};
  add_line(journal_words::shard, json.dump(), false);
}

ShardJournal::~ShardJournal() {
  if (fd_ >= 0) ::close(fd_);
}

void ShardJournal::add_variant(const std::string& identity, const Json& description) {
  add_line(journal_words::variant,
           identity + " " + description.dump(-1, ' ', false, Json::error_handler_t::replace), true);
}

void ShardJournal::begin(const TrialId& id, const Json& start) {
  add_line(journal_words::begin, to_string(id) + " " + start.dump(), false);
}

void ShardJournal::finish(const TrialId& id, double ms, const TrialOutput& output) {
  add_line(journal_words::trial,
           fmt::format("{} {:.0f} {} {}", to_string(id), ms, to_string(output.entry.figures.outcome),
                       output_text(output)),
           true);
}

void ShardJournal::add_crash(const TrialId& id, const Crash& crash) {
  const Json json = {{"signal", crash.signal}, {"where", valid_utf8(crash.where)}};
  add_line(journal_words::crash, to_string(id) + " " + json.dump(), true);
}

void ShardJournal::drop_torn_line() {
  constexpr std::size_t piece = 1 << 16;
  const std::uintmax_t size = fs::file_size(file_);
  std::uintmax_t end = size;  // Behind the last whole line.
  std::string text;
  for (bool found = false; !found && end > 0;) {
    text.resize(std::min<std::uintmax_t>(piece, end));
    if (::pread(fd_, text.data(), text.size(), static_cast<off_t>(end - text.size())) < 0)
      fail_to_write(file_, last_error());
    const std::size_t last = text.rfind('\n');
    found = last != std::string::npos;
    end = end - text.size() + (found ? last + 1 : 0);
  }
  if (end < size && ::ftruncate(fd_, static_cast<off_t>(end)) != 0) fail_to_write(file_, last_error());
}

void ShardJournal::touch() const {
  // Where this fails, writing will, too, and tell.
  static_cast<void>(::futimens(fd_, nullptr));
}

void ShardJournal::close() {
  fs::path name = file_;
  name.replace_extension();  // Without .part.
  std::error_code error = ::fsync(fd_) != 0 ? last_error() : std::error_code();
  if (!error) fs::rename(file_, name, error);
  if (!error) error = sync_to_disk(name.parent_path());
  check_written(file_, error);
  ::close(fd_);
  fd_ = -1;
  file_ = std::move(name);
}

void ShardJournal::add_line(std::string_view word, const std::string& text, bool for_good) {
  const std::string content = fmt::format("{} {}", word, text);
  const std::string line = fmt::format("{} {}\n", checksum(content), content);
  const std::lock_guard lock(mutex_);
  check_written(file_, write_all(fd_, line));
  if (for_good && ::fdatasync(fd_) != 0) fail_to_write(file_, last_error());
}

std::string output_text(const TrialOutput& output) {
  Json json = to_json(output.entry);
  Json files = Json::array();
  for (const auto& [name, content] : output.files) {
    const bool is_text = valid_utf8(content) == content;
    files.push_back({name, is_text ? "text" : "bytes", is_text ? content : hexadecimal_text(content)});
  }
  json["files"] = Json::object();
  json["contents"] = std::move(files);
  return json.dump();
}

TrialOutput output_of(const std::string& text) {
  const Json json = parse_json(text);
  TrialOutput output{entry_of(json), {}};
  for (const Json& file : json.at("contents")) {
    const std::string content = file.at(2);
    output.files.emplace_back(name_inside(file.at(0)), file.at(1) == "bytes" ? bytes_of(content) : content);
  }
  return output;
}

}  // namespace glocal
