// What readers of one format each have in common.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

}  // namespace glocal::bags
