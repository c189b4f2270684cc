// The hash table of the paper's relations: from a relation to the draw that had it (eq. 1 and 2).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "matchers/common/triangle.hpp"

namespace glocal::ransam {

/// Draws of one side with draws of the other side that had the same relation.
struct PartnerBatch {
  std::size_t size = 0;
  std::array<std::uint32_t, RelationBatch::capacity> numbers;   ///< Of the draws that were looked up.
  std::array<std::uint32_t, RelationBatch::capacity> partners;  ///< Of those in the table.
};

/// Entries of 8 bytes: the quantised relation, compared on look-up (a hash collision is not a relation
/// collision), and the number of the draw. Of two draws that meet in one slot the later one stays. Filling it
/// anew does not need to clear it: numbers go on counting over all fills, and entries from before the current
/// one count as empty. Relations come in batches, so that slots can be asked for ahead of use. Timed by
/// bench_hashing.
class RelationTable {
 public:
  static constexpr unsigned number_bits = 64 - relation_bits;

  /// 2^bits slots; fewer than 2^32.
  explicit RelationTable(unsigned bits) : bits_(bits), slots_(std::size_t{1} << bits, 0) {}

  /// Forgets everything; at most `draws` draws follow, numbered from 0.
  void begin_fill(std::uint64_t draws);

  /// Puts in relations and their draws, which rise from call to call. With several `shares`, only those that
  /// fall into that share of the slots: threads may fill different shares at the same time, and once each
  /// share has been given all batches, the table is as if it had been filled as a whole.
  void fill(const RelationBatch& batch, std::size_t share = 0, std::size_t shares = 1);

  /// Looks the relations of a batch up. Replaces what is in `found`.
  void find(const RelationBatch& batch, PartnerBatch& found) const;

  [[nodiscard]] std::size_t memory_bytes() const { return slots_.size() * sizeof(std::uint64_t); }

 private:
  unsigned bits_;
  std::uint64_t first_ = 1;  ///< Number of this fill's draw 0. Slots never used hold 0.
  std::uint64_t end_ = 1;
  std::vector<std::uint64_t> slots_;
};

}  // namespace glocal::ransam
