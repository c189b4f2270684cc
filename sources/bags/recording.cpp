#include "sources/bags/recording.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "glocal/error.hpp"
#include "sources/bags/bag_folder.hpp"
#include "sources/bags/recording_file.hpp"
#include "sources/bags/unpacked.hpp"

namespace glocal::bags {

namespace fs = std::filesystem;

struct Recording::Part {
  std::unique_ptr<RecordingFile> file;
  Reading reading;
  std::vector<std::size_t> connections;  ///< Index in the recording of each of the file's.
  std::optional<FileMessage> message;    ///< The next one.
};

std::string normal_type(std::string_view type) {
  std::string normal(type);
  const std::size_t at = normal.find("/msg/");
  if (at != std::string::npos) normal.erase(at, 4);
  return normal;
}

void Reading::note_damage(const ConfigError& error, const std::string& outcome) const {
  if (damage == Damage::refused) throw error;
  const Fault& fault = error.faults().front();
  note(fmt::format("{}: {}; {}", fault.file, fault.message, outcome));
}

namespace {

std::unique_ptr<RecordingFile> open_file(const fs::path& file, const Reading& reading) {
  const FileBytes bytes(file);
  const std::string_view beginning = bytes.peek(0);
  if (is_ros1_bag(beginning)) return open_ros1_bag(file, reading);
  if (is_mcap(beginning)) return open_mcap(file, reading);
  if (is_sqlite(beginning)) return open_sqlite_bag(file, reading);
  if (is_zstd(beginning))
    bytes.refuse(0, fmt::format("is compressed as a whole; unpack it: zstd -d {}", file.string()));
  bytes.refuse(0, beginning.empty()
                      ? "the file is empty; get a fresh copy"
                      : "begins like no recording; bags of ROS 1 (.bag) and ROS 2 (.db3) and MCAP can "
                        "be read, and compressed files after unpacking");
}

}  // namespace

bool is_recording(const fs::path& path) {
  if (fs::is_directory(path)) return is_bag_folder(path);
  const FileBytes bytes(path);
  const std::string_view beginning = bytes.peek(0);
  return is_ros1_bag(beginning) || is_mcap(beginning) || is_sqlite(beginning);
}

Recording::Recording(const fs::path& path, Damage damage)
    : connections_(std::make_unique<std::vector<Connection>>()),
      warnings_(std::make_unique<std::vector<std::string>>()) {
  if (!fs::is_directory(path)) {
    open(path, damage);
  } else {
    const BagFolder folder = read_bag_folder(path);
    *warnings_ = folder.warnings;
    announced_ = folder.messages;
    metadata_of_ = path.string();
    inputs_.insert(path);
    for (const fs::path& file : folder.files) open(file, damage);
  }
  rewind();
}

Recording::~Recording() = default;
Recording::Recording(Recording&&) noexcept = default;
Recording& Recording::operator=(Recording&&) noexcept = default;

void Recording::warn_once(std::vector<std::string>& warnings, const std::string& text) {
  if (std::ranges::find(warnings, text) == warnings.end()) warnings.push_back(text);
}

void Recording::open(const fs::path& file, Damage damage) {
  const auto note = [warnings = warnings_.get()](const std::string& text) { warn_once(*warnings, text); };
  auto part = std::make_unique<Part>();
  part->reading = {note, damage};
  part->file = open_file(file, part->reading);
  format_ = part->file->format();
  for (const Connection& connection : part->file->connections()) {
    // Files of one recording have the same connections.
    const auto known = parts_.empty() ? connections_->end()
                                      : std::find(connections_->begin(), connections_->end(), connection);
    part->connections.push_back(static_cast<std::size_t>(known - connections_->begin()));
    if (known == connections_->end()) connections_->push_back(connection);
  }
  parts_.push_back(std::move(part));
  inputs_.insert(file);
}

void Recording::rewind(const std::optional<std::set<std::string>>& topics) {
  last_ = nullptr;
  for (const auto& part : parts_) {
    std::vector<bool> wanted;
    for (const Connection& connection : part->file->connections())
      wanted.push_back(!topics || topics->contains(connection.topic));
    part->file->rewind(wanted);
    part->message.reset();
  }
  is_begun_ = false;
  messages_read_ = 0;
  damaged_ = 0;
  messages_announced_ = 0;
  for (const auto& [topic, messages] : announced_)
    messages_announced_ += !topics || topics->contains(topic) ? messages : 0;
}

void Recording::compare_counts() {
  if (announced_.empty() || messages_read_ == messages_announced_) return;
  warn_once(*warnings_,
            fmt::format("{}: metadata.yaml announces {} messages of the topics that were read, and the files "
                        "have {}; a part may be missing or cut off",
                        metadata_of_, messages_announced_, messages_read_));
}

double Recording::share_read() const {
  double shares = 0.0;
  for (const auto& part : parts_) shares += part->file->share_read();
  return shares / static_cast<double>(parts_.size());
}

bool Recording::find_next() {
  // Files are first read here, not when the recording is opened or rewound.
  for (const auto& part : parts_) {
    if (!is_begun_ || part.get() == last_) part->message = part->file->next();
  }
  is_begun_ = true;
  last_ = nullptr;
  for (const auto& part : parts_) {
    if (part->message && (last_ == nullptr || part->message->stamp_ns < last_->message->stamp_ns))
      last_ = part.get();
  }
  return last_ != nullptr;
}

bool Recording::unpack(const FileMessage& message) {
  try {
    unpacked_ = unpacked_message(message.bytes, message.place);
    return true;
  } catch (const ConfigError& error) {
    if (damaged_++ == 0)
      last_->reading.note_damage(error, "this message is left out, as are others that are damaged");
    if (!first_damage_) first_damage_ = error;
    return false;
  }
}

void Recording::tell_damaged_messages() {
  if (damaged_ == 0) return;
  // Where nothing is whole nothing can be read.
  if (!is_any_whole_) throw ConfigError(*first_damage_);
  if (damaged_ > 1)
    warn_once(*warnings_, fmt::format("{}: {} messages are damaged and left out",
                                      first_damage_->faults().front().file, damaged_));
}

std::optional<RecordedMessage> Recording::next() {
  while (find_next()) {
    constexpr std::uint64_t seldom = 64;
    if (++messages_read_ % seldom == 0) progress_(share_read());
    const FileMessage& message = *last_->message;
    const Connection& connection = (*connections_)[last_->connections[message.connection]];
    const bool is_packed = connection.encoding == "cdr" && is_zstd(message.bytes);
    if (is_packed && !unpack(message)) continue;
    is_any_whole_ = true;
    return RecordedMessage{&connection, message.stamp_ns, is_packed ? unpacked_ : message.bytes,
                           message.place};
  }
  tell_damaged_messages();
  compare_counts();
  progress_(1.0);
  return std::nullopt;
}

}  // namespace glocal::bags
