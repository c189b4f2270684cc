// What robots have recorded, in their own formats: ROS 1 bags, ROS 2 bags (SQLite) and MCAP.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "sources/bags/file_bytes.hpp"

namespace glocal::bags {

/// A stream of messages of one type.
struct Connection {
  std::string topic;
  std::string type;        ///< As `sensor_msgs/LaserScan`, in ROS 1 and 2 alike.
  std::string encoding;    ///< Of its messages: ros1, cdr, or another one, which is not decoded (json …).
  std::string definition;  ///< Of the type, as the file has it; perhaps empty.

  friend bool operator==(const Connection&, const Connection&) = default;
};

/// A message as it was recorded.
struct RecordedMessage {
  const Connection* connection = nullptr;  ///< Of the recording, and valid as long as it is.
  std::int64_t stamp_ns = 0;  ///< When it was received, ns since 1970 (or the simulation's start).
  std::string_view bytes;     ///< Serialized; valid until the next message is read.
  Place place;                ///< Of the bytes, for what is said of them.
};

/// Whether a path is that of a Recording: a file that begins as one, or is_bag_folder().
/// Throws ConfigError if it can be read neither as a file nor as a folder.
[[nodiscard]] bool is_recording(const std::filesystem::path& path);

/// `sensor_msgs/msg/LaserScan` is `sensor_msgs/LaserScan`.
[[nodiscard]] std::string normal_type(std::string_view type);

struct FileMessage;

/// What becomes of a recording that is damaged behind something whole.
enum class Damage {
  passed_over,  ///< What is whole is read, with a warning that says where the damage begins, and how much it
                ///< is.
  refused,      ///< ConfigError.
};
[[nodiscard]] inline Damage damage_if(bool strict) {
  return strict ? Damage::refused : Damage::passed_over;
}

/// A recording, message by message. Memory holds the chunks that overlap in time, up to 1 GiB (more are
/// refused), and 32 bytes for each chunk of the file.
class Recording {
 public:
  /// Opens a file, whose format its content tells, or a folder of ROS 2 (.db3 or .mcap files that are read as
  /// one; see read_bag_folder()). Messages that are compressed one by one (zstd) are unpacked. Throws
  /// ConfigError with file, byte, rule and fix for what is no recording, is of version 1, is encrypted or
  /// damaged from its beginning on; behind that `damage` says what to do.
  explicit Recording(const std::filesystem::path& path, Damage damage = Damage::passed_over);
  ~Recording();
  Recording(Recording&&) noexcept;
  Recording& operator=(Recording&&) noexcept;

  /// "ROS 1 bag 2.0", "ROS 2 bag (SQLite)" or "MCAP".
  [[nodiscard]] const std::string& format() const { return format_; }
  /// The files that are read as one recording, and the folder if one was named.
  [[nodiscard]] const std::set<std::filesystem::path>& inputs() const { return inputs_; }
  /// All that the recording names; several may have the same topic.
  [[nodiscard]] const std::vector<Connection>& connections() const { return *connections_; }
  /// Goes to the start; from there on only messages of these topics are read, or of all.
  void rewind(const std::optional<std::set<std::string>>& topics = std::nullopt);
  /// The next message in order of receipt; none at the end. Throws ConfigError for damage that is refused,
  /// and where nothing is whole.
  [[nodiscard]] std::optional<RecordedMessage> next();
  /// Takes the share that has been read since the last rewind(): now and then, and 1 at the end.
  void tell_progress(std::function<void(double)> progress) { progress_ = std::move(progress); }
  /// What its user should be told, a sentence each; may grow while messages are read.
  [[nodiscard]] const std::vector<std::string>& warnings() const { return *warnings_; }

 private:
  struct Part;

  static void warn_once(std::vector<std::string>& warnings, const std::string& text);
  void open(const std::filesystem::path& file, Damage damage);
  /// Goes to the next message; false at the end.
  bool find_next();
  /// Unpacks a message that was compressed by itself; false if it is damaged and left out.
  bool unpack(const FileMessage& message);
  void tell_damaged_messages();
  /// With what metadata.yaml says, once all was read.
  void compare_counts();
  [[nodiscard]] double share_read() const;

  std::string format_;
  std::set<std::filesystem::path> inputs_;
  // Others point to these, also after a move.
  std::unique_ptr<std::vector<Connection>> connections_;
  std::unique_ptr<std::vector<std::string>> warnings_;
  std::vector<std::unique_ptr<Part>> parts_;
  Part* last_ = nullptr;                            ///< Whose message was given out last.
  bool is_begun_ = false;                           ///< Whether each part has its next message.
  std::string unpacked_;                            ///< The last message, if it was compressed by itself.
  std::uint64_t damaged_ = 0;                       ///< Messages since the last rewind().
  std::optional<ConfigError> first_damage_;         ///< Of a message.
  bool is_any_whole_ = false;                       ///< Whether a message was given out.
  std::map<std::string, std::uint64_t> announced_;  ///< Messages by topic; empty if nobody says it.
  std::string metadata_of_;                         ///< The folder whose metadata.yaml says it.
  std::function<void(double)> progress_ = [](double) {};
  std::uint64_t messages_announced_ = 0, messages_read_ = 0;  ///< Of the topics that are read.
};

}  // namespace glocal::bags
