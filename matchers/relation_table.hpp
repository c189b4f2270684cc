// The hash table of the paper's relations: from a relation to the draw that had it (eq. 1).
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "matchers/triangle.hpp"

namespace glocal {

/// Entries of 8 bytes: the quantised relation, compared on look-up (a hash collision is not a relation
/// collision), and the number of the draw. Of two draws that meet in one slot the later number stays,
/// whatever the order of insertion, so that threads may insert together and the result is still determined.
/// Filling it anew does not need to clear it: numbers go on counting, and entries below the current fill's
/// first number count as empty. Timed by bench_hashing.
class RelationTable {
 public:
  static constexpr unsigned number_bits = 64 - relation_bits;

  /// 2^bits slots.
  explicit RelationTable(unsigned bits) : shift_(64 - bits), slots_(std::size_t{1} << bits, 0) {}

  /// Starts a new fill of at most `draws` insertions numbered from the returned value; what was inserted
  /// before is gone.
  [[nodiscard]] std::uint64_t begin_fill(std::uint64_t draws);

  void prefetch(Relation relation) const { __builtin_prefetch(&slots_[slot(relation)]); }

  /// Thread-safe among insertions.
  void insert(Relation relation, std::uint64_t number) {
    const std::atomic_ref<std::uint64_t> entry(slots_[slot(relation)]);
    const std::uint64_t mine = number << relation_bits | relation;
    std::uint64_t there = entry.load(std::memory_order_relaxed);
    while (there < mine && !entry.compare_exchange_weak(there, mine, std::memory_order_relaxed)) {
    }
  }
  /// The same where one thread alone inserts, in rising order of numbers: the last one written stays.
  void append(Relation relation, std::uint64_t number) {
    slots_[slot(relation)] = number << relation_bits | relation;
  }

  static constexpr std::uint64_t none = 0;

  /// The number of a draw with this relation in the current fill, or none.
  [[nodiscard]] std::uint64_t find(Relation relation) const {
    const std::uint64_t entry = slots_[slot(relation)];
    const std::uint64_t number = entry >> relation_bits;
    return number >= first_ && (entry & relation_mask) == relation ? number : none;
  }

  [[nodiscard]] std::size_t memory_bytes() const { return slots_.size() * sizeof(std::uint64_t); }

 private:
  static constexpr std::uint64_t relation_mask = (std::uint64_t{1} << relation_bits) - 1;

  [[nodiscard]] std::size_t slot(Relation relation) const {
    return static_cast<std::size_t>(std::uint64_t{relation} * 0x9e3779b97f4a7c15ULL >> shift_);
  }

  unsigned shift_;
  std::uint64_t first_ = 1;  ///< Number 0 (none) marks slots that were never used.
  std::uint64_t end_ = 1;
  std::vector<std::uint64_t> slots_;
};

}  // namespace glocal
