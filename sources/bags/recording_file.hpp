// What readers of one format each have in common, and how each opens a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/error.hpp"
#include "sources/bags/file_bytes.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::bags {

/// Takes a sentence for the user.
using Note = std::function<void(const std::string&)>;

/// How a file is read.
struct Reading {
  Note note;
  Damage damage = Damage::passed_over;

  /// Notes damage behind something whole, and what becomes of it; throws it where it is refused.
  void note_damage(const ConfigError& error, const std::string& outcome) const;
};

/// A message of one file.
struct FileMessage {
  std::size_t connection = 0;  ///< Index into connections().
  std::int64_t stamp_ns = 0;
  std::string_view bytes;  ///< Valid until the next message is read.
  Place place;
};

/// One file of a recording.
class RecordingFile {
 public:
  RecordingFile() = default;
  virtual ~RecordingFile() = default;
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;

  [[nodiscard]] virtual const char* format() const = 0;
  /// Complete once the file is open.
  [[nodiscard]] const std::vector<Connection>& connections() const { return connections_; }
  /// Goes to the start; from there on only messages of these connections are read.
  virtual void rewind(const std::vector<bool>& wanted) = 0;
  /// The next message in order of receipt; none at the end.
  [[nodiscard]] virtual std::optional<FileMessage> next() = 0;
  /// How much of the file has been read since the last rewind(), in [0, 1].
  [[nodiscard]] virtual double share_read() const = 0;

 protected:
  std::vector<Connection> connections_;
};

/// Whether a file that begins so is a bag of ROS 1, of whatever version.
[[nodiscard]] bool is_ros1_bag(std::string_view beginning);
[[nodiscard]] bool is_mcap(std::string_view beginning);
[[nodiscard]] bool is_sqlite(std::string_view beginning);

/// Opens a ROS 1 bag, version 2.0 (wiki.ros.org/Bags/Format/2.0), indexed or not; chunks are uncompressed,
/// bz2 or lz4. See Recording.
[[nodiscard]] std::unique_ptr<RecordingFile> open_ros1_bag(const std::filesystem::path& file,
                                                           const Reading& reading);

/// Opens an MCAP recording, version 0 of the format (mcap.dev/spec), with summary or without, in chunks
/// (uncompressed, lz4, zstd) or not. Chunks' CRC-32 are checked where they are given. See Recording.
[[nodiscard]] std::unique_ptr<RecordingFile> open_mcap(const std::filesystem::path& file,
                                                       const Reading& reading);

/// Opens a ROS 2 bag in SQLite (.db3; rosbag2_storage_sqlite3: tables `topics` and `messages`), read-only.
/// See Recording.
[[nodiscard]] std::unique_ptr<RecordingFile> open_sqlite_bag(const std::filesystem::path& file,
                                                             const Reading& reading);

}  // namespace glocal::bags
