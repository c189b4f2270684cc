// Recordings whose messages come in chunks, perhaps out of order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <queue>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "sources/bags/recording_file.hpp"

namespace glocal::bags {

/// A piece of the file with messages.
struct ChunkSpan {
  std::uint64_t offset = 0;   ///< Of its first byte in the file.
  std::uint64_t size = 0;     ///< Bytes in the file.
  std::int64_t first_ns = 0;  ///< Stamp of its earliest message, as the file says it.
};

/// A message in a chunk.
struct ChunkEntry {
  std::int64_t stamp_ns = 0;
  std::size_t connection = 0;
  std::size_t offset = 0, size = 0;  ///< In the chunk's bytes.
};

/// A chunk, unpacked.
struct Chunk {
  std::string bytes;
  std::vector<ChunkEntry> entries;  ///< As they lie in the chunk.
};

/// Reads chunks in order of their first stamps, and the messages of those that overlap in order of theirs. At
/// most 1 GiB of chunks is held at a time.
class ChunkedFile : public RecordingFile {
 public:
  void rewind(const std::vector<bool>& wanted) override;
  [[nodiscard]] std::optional<FileMessage> next() override;
  [[nodiscard]] double share_read() const override;

 protected:
  ChunkedFile(const std::filesystem::path& file, Reading reading)
      : file_(file), reading_(std::move(reading)) {}

  /// Goes through the records from `at` on, and ends where one is damaged: `note` takes it in, and returns
  /// where the next one is, or none behind the last. Returns the offset behind what is whole. Throws
  /// ConfigError if that is no chunk.
  std::uint64_t go_through_records(std::uint64_t at,
                                   const std::function<std::optional<std::uint64_t>(std::uint64_t)>& note);

  /// The chunk, unpacked and read. Throws ConfigError if it is damaged.
  [[nodiscard]] virtual Chunk load(const ChunkSpan& span) = 0;
  /// The same; none for one that is damaged, which is told.
  [[nodiscard]] std::optional<Chunk> load_if_whole(const ChunkSpan& span);

  /// Of bytes of an unpacked chunk.
  [[nodiscard]] Place place_in(const ChunkSpan& span, std::size_t at) const {
    return {file_.name(), at, span.offset};
  }

  FileBytes file_;
  Reading reading_;
  std::vector<ChunkSpan> chunks_;
  std::string spare_;  ///< Memory of a chunk that is over, for the next one.

 private:
  struct OpenChunk {
    ChunkSpan span;
    Chunk chunk;
    std::size_t next = 0;
    [[nodiscard]] const ChunkEntry& entry() const { return chunk.entries[next]; }
  };
  /// Whose next message comes later; of equal ones that which lies behind.
  struct IsLater {
    bool operator()(const std::shared_ptr<OpenChunk>& a, const std::shared_ptr<OpenChunk>& b) const {
      const std::int64_t at = a->entry().stamp_ns, bt = b->entry().stamp_ns;
      return at != bt ? at > bt : a->span.offset > b->span.offset;
    }
  };

  void open_next_chunk();
  void step_over_last();
  /// At the end of the file.
  void tell_damaged_chunks() const;

  std::vector<bool> wanted_;
  std::set<std::uint64_t> damaged_;  ///< Offsets of chunks.
  std::size_t next_chunk_ = 0;
  std::uint64_t open_bytes_ = 0;
  std::priority_queue<std::shared_ptr<OpenChunk>, std::vector<std::shared_ptr<OpenChunk>>, IsLater> open_;
  std::shared_ptr<OpenChunk> last_;  ///< Whose message was given out last; not in the heap.
};

}  // namespace glocal::bags
