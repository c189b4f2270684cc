#include "sources/bags/chunked_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "glocal/error.hpp"

namespace glocal::bags {

void ChunkedFile::rewind(const std::vector<bool>& wanted) {
  wanted_ = wanted;
  next_chunk_ = 0;
  open_bytes_ = 0;
  open_ = {};
  last_ = nullptr;
  std::ranges::stable_sort(chunks_, {}, &ChunkSpan::first_ns);
}

std::optional<FileMessage> ChunkedFile::next() {
  step_over_last();
  // What is not open yet has nothing earlier than the first stamp of the next chunk.
  while (next_chunk_ < chunks_.size() &&
         (open_.empty() || chunks_[next_chunk_].first_ns <= open_.top()->entry().stamp_ns))
    open_next_chunk();
  if (open_.empty()) {
    tell_damaged_chunks();
    return std::nullopt;
  }
  last_ = open_.top();
  open_.pop();
  const ChunkEntry& entry = last_->entry();
  return FileMessage{entry.connection, entry.stamp_ns,
                     std::string_view(last_->chunk.bytes).substr(entry.offset, entry.size),
                     place_in(last_->span, entry.offset)};
}

double ChunkedFile::share_read() const {
  if (chunks_.empty()) return 1.0;
  return static_cast<double>(next_chunk_) / static_cast<double>(chunks_.size());
}

void ChunkedFile::step_over_last() {
  if (!last_) return;
  if (++last_->next < last_->chunk.entries.size()) {
    open_.push(std::move(last_));
  } else {
    open_bytes_ -= last_->chunk.bytes.size();
    spare_ = std::move(last_->chunk.bytes);
  }
  last_ = nullptr;
}

std::optional<Chunk> ChunkedFile::load_if_whole(const ChunkSpan& span) {
  try {
    return load(span);
  } catch (const ConfigError& error) {
    damaged_.insert(span.offset);
    // Where nothing is whole nothing can be read.
    if (damaged_.size() == chunks_.size()) throw;
    if (damaged_.size() == 1)
      reading_.note_damage(error, "this chunk is left out, as are others that are damaged");
    return std::nullopt;
  }
}

void ChunkedFile::tell_damaged_chunks() const {
  if (damaged_.size() > 1)
    reading_.note(fmt::format("{}: {} of {} chunks are damaged and left out, the first at byte {}",
                              file_.name(), damaged_.size(), chunks_.size(), *damaged_.begin()));
}

std::uint64_t ChunkedFile::go_through_records(
    std::uint64_t at, const std::function<std::optional<std::uint64_t>(std::uint64_t)>& note) {
  const std::uint64_t begin = at;
  try {
    while (at < file_.size()) {
      const auto next = note(at);
      if (!next) return at;
      at = *next;
    }
  } catch (const ConfigError& error) {
    if (at == begin || chunks_.empty()) throw;
    reading_.note_damage(error,
                         fmt::format("what comes before it is read: {} of {} bytes", at, file_.size()));
  }
  return at;
}

void ChunkedFile::open_next_chunk() {
  constexpr std::uint64_t most_open = 1ULL << 30U;
  const ChunkSpan& span = chunks_[next_chunk_++];
  auto chunk = load_if_whole(span);
  if (!chunk) return;
  auto open = std::make_shared<OpenChunk>(OpenChunk{span, std::move(*chunk), 0});
  auto& entries = open->chunk.entries;
  const auto is_outside = [&](const ChunkEntry& e) { return e.stamp_ns < span.first_ns; };
  if (std::ranges::any_of(entries, is_outside))
    reading_.note(fmt::format(
        "{}: byte {}: the chunk has messages before the time that the file says it begins at; they "
        "may come out of order",
        file_.name(), span.offset));
  std::erase_if(entries, [&](const ChunkEntry& e) { return !wanted_[e.connection]; });
  if (entries.empty()) return;
  std::ranges::stable_sort(entries, {}, &ChunkEntry::stamp_ns);
  open_bytes_ += open->chunk.bytes.size();
  if (open_bytes_ > most_open)
    file_.refuse(span.offset,
                 "more than 1 GiB of chunks overlap in time; write the recording anew, in order of "
                 "time");
  open_.push(std::move(open));
}

}  // namespace glocal::bags
