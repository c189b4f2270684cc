#include "matchers/ransam/relation_table.hpp"

#include <algorithm>
#include <bit>

namespace glocal::ransam {
namespace {

/// Multiplicative hashing (Knuth): the upper bits of the product with 2^64 divided by the golden ratio.
std::uint32_t slot_of(Relation relation, unsigned bits) {
  return static_cast<std::uint32_t>(relation * 0x9e3779b97f4a7c15ULL >> (64 - bits));
}

}  // namespace

void RelationTable::begin_fill(std::uint64_t draws) {
  if (end_ + draws >= std::uint64_t{1} << number_bits) {
    std::fill(slots_.begin(), slots_.end(), 0);
    end_ = 1;
  }
  first_ = end_;
  end_ += draws;
}

void RelationTable::fill(const RelationBatch& batch, std::size_t share, std::size_t shares) {
  const auto entry_of = [&](std::size_t i) {
    return (first_ + batch.numbers[i]) << relation_bits | batch.relations[i];
  };
  if (shares == 1) {
    for (std::size_t i = 0; i < batch.size; ++i) slots_[slot_of(batch.relations[i], bits_)] = entry_of(i);
    return;
  }
  const auto begin_of = [&](std::size_t which) {
    return static_cast<std::uint32_t>((which << bits_) / shares);
  };
  const std::uint32_t begin = begin_of(share);
  const std::uint32_t width = begin_of(share + 1) - begin;
  std::array<std::uint32_t, RelationBatch::capacity> slots;
  std::array<std::uint64_t, RelationBatch::capacity> entries;
  std::size_t size = 0;
  for (std::size_t i = 0; i < batch.size; ++i) {
    slots[size] = slot_of(batch.relations[i], bits_);
    entries[size] = entry_of(i);
    size += std::size_t{slots[size] - begin < width};  // no branch, which would be guessed wrong
  }
  for (std::size_t k = 0; k < size; ++k) slots_[slots[k]] = entries[k];
}

void RelationTable::find(const RelationBatch& batch, PartnerBatch& found) const {
  std::array<std::uint32_t, RelationBatch::capacity> slots;
  for (std::size_t i = 0; i < batch.size; ++i) {
    slots[i] = slot_of(batch.relations[i], bits_);
    __builtin_prefetch(&slots_[slots[i]]);
  }
  const std::uint64_t first = first_, draws = end_ - first_;
  const std::uint64_t* const entries = slots_.data();
  std::size_t size = 0;
  for (std::size_t i = 0; i < batch.size; ++i) {
    // Far too large if the relations differ, and if the entry is of a fill before.
    const std::uint64_t draw = std::rotr(entries[slots[i]] ^ batch.relations[i], relation_bits) - first;
    found.numbers[size] = batch.numbers[i];
    found.partners[size] = static_cast<std::uint32_t>(draw);
    size += std::size_t{draw < draws};  // no branch, which would be guessed wrong
  }
  found.size = size;
}

}  // namespace glocal::ransam
